#include "tests/bench/import_row.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace nearfit::bench::import_row_test {
namespace {

constexpr DocumentCounts kCounts{2, 10, 400, 2000};

ImportRun runOf(double seconds, bool isFromCache) {
  return {seconds,
          0.5 * seconds,
          isFromCache,
          kCounts,
          400'000,
          isFromCache ? 0U : 200'000U,
          isFromCache ? 0U : 250'000U};
}

OccRun occOf(double seconds) {
  return {"7.6.3", 0.5 * seconds, 0.25 * seconds, 0.25 * seconds, kCounts, 3'000'000};
}

ImportSamples samplesOf() {
  return {"vise",
          {1.5, 0.3, 1.5, 400.0},
          {runOf(1.0, false), runOf(3.0, false), runOf(2.0, false)},
          {runOf(0.1, true), runOf(0.2, true), runOf(0.3, true)},
          {occOf(1.0), occOf(1.0), occOf(2.0)}};
}

ImportFigure figureNamed(const ImportSamples& samples, const std::string& name) {
  const std::vector<ImportFigure> figures = figuresOf(samples);
  const auto found =
      std::ranges::find_if(figures, [&](const ImportFigure& figure) { return figure.name == name; });
  EXPECT_NE(found, figures.end()) << name;
  return found != figures.end() ? *found : ImportFigure{};
}

TEST(ImportFigures, TimesHaveMedianMaxAndTheirGoals) {
  const ImportFigure fresh = figureNamed(samplesOf(), "file to ready to feel");
  EXPECT_EQ(fresh.document, "vise");
  EXPECT_EQ(fresh.runs, 3U);
  EXPECT_EQ(fresh.median, 2.0);
  EXPECT_EQ(fresh.max, 3.0);
  EXPECT_EQ(fresh.goal, 1.5);
  EXPECT_FALSE(fresh.isMet());
  const ImportFigure cached = figureNamed(samplesOf(), "cache to ready to feel");
  EXPECT_EQ(cached.median, 0.2);
  EXPECT_TRUE(cached.isMet());
}

TEST(ImportFigures, ARatioIsThatOfTheRunsOfOneTurn) {
  const ImportFigure ratio = figureNamed(samplesOf(), "ratio to OpenCASCADE");
  // 1, 3 and 1.
  EXPECT_EQ(ratio.median, 1.0);
  EXPECT_EQ(ratio.max, 3.0);
  EXPECT_TRUE(ratio.isMet());
}

TEST(ImportFigures, MemoryIsThatOfBothProcessesForEachTriangleOfTheScene) {
  const ImportFigure all = figureNamed(samplesOf(), "memory in all a triangle");
  EXPECT_EQ(all.unit, "B");
  // The import and what there was beside it then: more than 400,000 bytes later.
  EXPECT_EQ(all.median, 225.0);
  EXPECT_TRUE(all.isMet());
  EXPECT_EQ(figureNamed(samplesOf(), "memory of nearfit-import").median, 0.2);
  EXPECT_EQ(figureNamed(samplesOf(), "memory of Nearfit").median, 0.4);
  EXPECT_EQ(figureNamed(samplesOf(), "memory of OpenCASCADE").median, 3.0);
}

TEST(ImportFigures, WithoutOpenCascadeNothingIsComparedWithIt) {
  ImportSamples samples = samplesOf();
  samples.occ.clear();
  for (const ImportFigure& figure : figuresOf(samples))
    EXPECT_EQ(figure.name.find("OpenCASCADE"), std::string::npos) << figure.name;
}

TEST(ImportCsv, HasAColumnForEachNumberTheGoalAndWhetherItIsMet) {
  EXPECT_EQ(importCsvHeader(),
            "document,shapes,instances,triangles,placed_triangles,figure,unit,runs,median,max,goal,met\n");
  ImportFigure figure{"vise", "file to ready to feel", "s", kCounts, 3, 1.25, 2.0, 1.5};
  EXPECT_EQ(importCsvLine(figure), "vise,2,10,400,2000,file to ready to feel,s,3,1.2500,2.0000,1.5,yes\n");
  figure.goal = 1.0;
  EXPECT_EQ(importCsvLine(figure), "vise,2,10,400,2000,file to ready to feel,s,3,1.2500,2.0000,1,no\n");
  figure.goal = 0.0;
  EXPECT_EQ(importCsvLine(figure), "vise,2,10,400,2000,file to ready to feel,s,3,1.2500,2.0000,,\n");
}

TEST(ImportCsv, LinesHaveAsManyFieldsAsTheHeader) {
  const auto fields = [](const std::string& line) { return std::ranges::count(line, ',') + 1; };
  const auto columns = fields(importCsvHeader());
  for (const ImportFigure& figure : figuresOf(samplesOf()))
    EXPECT_EQ(fields(importCsvLine(figure)), columns) << figure.name;
}

TEST(ImportTable, AMissedGoalIsPlain) {
  EXPECT_NE(importTableLine(figureNamed(samplesOf(), "file to ready to feel")).find("  NO\n"),
            std::string::npos);
  EXPECT_NE(importTableLine(figureNamed(samplesOf(), "cache to ready to feel")).find("  yes\n"),
            std::string::npos);
}

TEST(ImportProblems, SoundRunsHaveNone) {
  EXPECT_TRUE(problemsOf(samplesOf()).empty());
}

TEST(ImportProblems, RunsThatTookTheOtherWayAreVoid) {
  ImportSamples samples = samplesOf();
  samples.fresh[1].isFromCache = true;
  ASSERT_EQ(problemsOf(samples).size(), 1U);
  EXPECT_NE(problemsOf(samples)[0].find("empty cache"), std::string::npos);
  samples = samplesOf();
  samples.cached[2].isFromCache = false;
  ASSERT_EQ(problemsOf(samples).size(), 1U);
  EXPECT_NE(problemsOf(samples)[0].find("imported again"), std::string::npos);
}

TEST(ImportProblems, OtherCountsAreVoid) {
  ImportSamples samples = samplesOf();
  samples.cached[0].counts.triangles += 1;
  EXPECT_EQ(problemsOf(samples).size(), 1U);
  // A few triangles less are those that collapse.
  samples = samplesOf();
  samples.occ[0].counts.placedTriangles += 50;
  EXPECT_TRUE(problemsOf(samples).empty());
  samples.occ[0].counts.placedTriangles += 1000;
  EXPECT_EQ(problemsOf(samples).size(), 1U);
  samples = samplesOf();
  samples.occ[1].counts.instances -= 1;
  EXPECT_EQ(problemsOf(samples).size(), 1U);
}

}  // namespace
}  // namespace nearfit::bench::import_row_test
