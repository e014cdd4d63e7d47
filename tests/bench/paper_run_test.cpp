#include "tests/bench/paper_run.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/bench/paper_hierarchy.h"
#include "tests/bench/query_method.h"

namespace nearfit::bench::paper_run_test {
namespace {

TEST(SweptBodies, AreClosedOfAboutTheTrianglesWantedAndOfUnitSize) {
  for (const SweptBody& body : sweptBodies()) {
    for (const std::size_t triangles : {512U, 8192U, 131072U}) {
      const BenchScene meshes = body.make(triangles);
      const std::size_t has = meshes.scene.triangles().size() + meshes.part.triangles().size();
      EXPECT_NEAR(static_cast<double>(has), static_cast<double>(triangles),
                  0.25 * static_cast<double>(triangles))
          << body.name;
      for (const TriangleMesh* mesh : {&meshes.scene, &meshes.part}) {
        EXPECT_TRUE(mesh->topology().isClosed()) << body.name;
        EXPECT_TRUE(mesh->topology().isOriented()) << body.name;
        EXPECT_EQ(mesh->topology().components, 1U) << body.name;
      }
      EXPECT_NEAR(meshes.size(), 1.0, 1e-9) << body.name;
    }
  }
}

TEST(SweptBodies, BeginApartAndWithinTheCutoffWhereTheyHaveAStart) {
  int starts = 0;
  for (const SweptBody& body : sweptBodies()) {
    for (const std::size_t triangles : {512U, 8192U}) {
      const BenchScene meshes = body.make(triangles);
      if (!meshes.start) continue;
      ++starts;
      const PaperHierarchy scene(meshes.scene, PaperRule::AllPairs), part(meshes.part, PaperRule::AllPairs);
      PaperQuery query(scene, part);
      EXPECT_FALSE(query.find(*meshes.start, kUsualCutoffFraction).empty()) << body.name;
      EXPECT_FALSE(query.isTouching()) << body.name;
    }
  }
  EXPECT_EQ(starts, 2);
}

TEST(Sweeps, GoFromTheLeastToTheGreatestOfTheIssue) {
  EXPECT_EQ(sweptCutoffs().front(), 0.005);
  EXPECT_EQ(sweptCutoffs().back(), 0.2);
  EXPECT_EQ(sweptTriangles().front(), 512U);
  EXPECT_EQ(sweptTriangles().back(), 1'000'000U);
  EXPECT_TRUE(std::is_sorted(sweptCutoffs().begin(), sweptCutoffs().end()));
  EXPECT_TRUE(std::is_sorted(sweptTriangles().begin(), sweptTriangles().end()));
}

TEST(Sweeps, HaveTimesAndCountsOfEachMethodAndLeaveThePapersOutWhereTold) {
  PaperRunOptions options;
  options.sweepPoses = 20;
  options.slowStride = 10;
  const auto methodsOf = [&](std::size_t maxPaperTriangles) {
    std::set<std::string> methods;
    for (const PaperFigure& f : trianglesFigures(sweptBodies()[1], 512, maxPaperTriangles, options)) {
      methods.insert(f.method);
      EXPECT_GT(f.samples, 0U) << f.method << " " << f.quantity;
      EXPECT_TRUE(std::isfinite(f.p50)) << f.method << " " << f.quantity;
      if (f.quantity == "minima") {
        EXPECT_GT(f.max, 0.0) << f.method;
      }
    }
    return methods;
  };
  const std::set<std::string> with = methodsOf(1000), without = methodsOf(100);
  for (const char* name : {"nearfit-cold", "nearfit-tracked"}) {
    EXPECT_TRUE(with.contains(name));
    EXPECT_TRUE(without.contains(name));
  }
  for (const char* name : {"paper-spans", "paper-cones"}) {
    EXPECT_TRUE(with.contains(name));
    EXPECT_FALSE(without.contains(name));
  }
}

TEST(Appendix, EachJudgedMethodPaysForWhatIsDoneBesideItToo) {
  const BenchScene meshes = sweptBodies()[1].make(512);
  PaperRow row = paperRows().front();
  row.pose = *meshes.start;
  row.cutoffFraction = kUsualCutoffFraction;
  PaperRunOptions options;
  options.poses = 20;
  options.slowStride = 10;
  const std::vector<PaperFigure> figures = appendixFigures(row, meshes, options);
  const auto figureOf = [&](const std::string& method, const std::string& quantity) {
    const auto found = std::find_if(figures.begin(), figures.end(), [&](const PaperFigure& f) {
      return f.method == method && f.quantity == quantity;
    });
    return found == figures.end() ? PaperFigure{} : *found;
  };
  std::set<std::string> names;
  for (const ErrorMethodEntry& entry : judgedMethods()) {
    names.insert(entry.name);
    const PaperFigure loop = figureOf(entry.name, "loop [us]"),
                      whole = figureOf(entry.name, "loop and search beside it [us]");
    EXPECT_GT(loop.samples, 0U) << entry.name;
    EXPECT_EQ(whole.samples, loop.samples) << entry.name;
    EXPECT_GE(whole.mean, loop.mean) << entry.name;
    EXPECT_EQ(figureOf(entry.name, "prepared in [s]").samples, 5U) << entry.name;
  }
  for (const char* name : {"exact cold", "exact tracked", "exact grouped", "paper spans", "paper cones"})
    EXPECT_TRUE(names.contains(name)) << name;
}

TEST(PaperFigures, SumUpAndKeepTheirHead) {
  const PaperFigure f =
      paperFigure({"cutoff", "a", "0.05"}, "exact", "query [us]", {1e-6, 3e-6, 2e-6, 4e-6}, 1e6);
  EXPECT_EQ(f.samples, 4U);
  EXPECT_NEAR(f.mean, 2.5, 1e-12);
  EXPECT_NEAR(f.p50, 2.0, 1e-12);
  EXPECT_NEAR(f.max, 4.0, 1e-12);
  EXPECT_EQ(paperFigureCsvLine(f), "cutoff,a,0.05,exact,query [us],4,2.5,2,4,4,4,4\n");
  const std::string header = paperFigureCsvHeader(), line = paperFigureCsvLine(f);
  EXPECT_EQ(std::count(header.begin(), header.end(), ','), std::count(line.begin(), line.end(), ','));
}

}  // namespace
}  // namespace nearfit::bench::paper_run_test
