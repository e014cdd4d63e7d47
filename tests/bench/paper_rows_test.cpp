#include "tests/bench/paper_rows.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/places.h"

namespace nearfit::bench::paper_rows_test {
namespace {

/// The rows whose meshes are on this machine: all or none.
std::vector<PaperRow> rowsWithMeshes() {
  if (!std::filesystem::exists(test::sharedFolder() / "models/public/paper_counts")) return {};
  std::vector<PaperRow> rows(paperRows().begin(), paperRows().end());
  rows.push_back(scanRow());
  return rows;
}

TEST(PaperRows, AreThoseThatThePaperPrints) {
  // Appendix A: model, scene, number of LMDs, rate.
  const std::vector<std::array<double, 4>> printed{{512, 6302, 3, 176},   {512, 6302, 1, 1506},
                                                   {512, 6302, 10, 121},  {128, 2204, 2, 337},
                                                   {5648, 23578, 2, 181}, {512, 12802, 2, 318}};
  ASSERT_EQ(paperRows().size(), printed.size());
  for (std::size_t i = 0; i < printed.size(); ++i) {
    const PaperRow& row = paperRows()[i];
    EXPECT_EQ(row.name, std::string(1, "abcdef"[i]));
    EXPECT_EQ(static_cast<double>(row.partTriangles), printed[i][0]);
    EXPECT_EQ(static_cast<double>(row.sceneTriangles), printed[i][1]);
    ASSERT_TRUE(row.printed.has_value());
    EXPECT_EQ(static_cast<double>(row.printed->minima), printed[i][2]);
    EXPECT_EQ(std::floor(row.printed->rate), printed[i][3]);
  }
}

TEST(PaperRows, HaveMeshesOfThePrintedCounts) {
  for (const PaperRow& row : rowsWithMeshes()) {
    const BenchScene meshes = paperScene(row, test::sharedFolder());
    EXPECT_EQ(meshes.scene.triangles().size(), row.sceneTriangles) << row.name;
    EXPECT_EQ(meshes.part.triangles().size(), row.partTriangles) << row.name;
    EXPECT_NEAR(meshes.size(), 1.0, 1e-9) << row.name;
  }
}

TEST(PaperRows, HavePosesWithThePrintedCountByThePapersRuleAndAGap) {
  for (const PaperRow& row : rowsWithMeshes()) {
    const BenchScene meshes = paperScene(row, test::sharedFolder());
    const PaperHierarchy scene(meshes.scene, PaperRule::NormalSpans),
        part(meshes.part, PaperRule::NormalSpans);
    PaperQuery query(scene, part);
    const double cutoff = row.cutoffFraction * meshes.size();
    const auto found = query.find(row.pose, cutoff);
    if (row.printed) {
      EXPECT_EQ(found.size(), row.printed->minima) << row.name;
    }
    EXPECT_FALSE(query.isTouching()) << row.name;
    ASSERT_FALSE(found.empty()) << row.name;
    EXPECT_GE(found.front().distance, kMinGap * cutoff) << row.name;
    // Within the stated region.
    const glm::dvec3 off = row.pose.applyToPoint(meshes.part.bounds().centre()) - row.regionCentre;
    for (int k = 0; k < 3; ++k)
      EXPECT_LE(std::abs(off[k]), row.regionHalf[k] + 1e-12) << row.name;
    EXPECT_LE(2.0 * std::acos(std::min(1.0, std::abs(row.pose.rotation.w))), row.maxTurn + 1e-9) << row.name;
  }
}

TEST(PaperRows, HaveThePoseThatTheSearchFinds) {
  for (const PaperRow& row : rowsWithMeshes()) {
    // The others take minutes: nearfit-bench paper --search prints all.
    if (row.name != "a" && row.name != "b" && row.name != "d" && row.name != "scan") continue;
    const std::optional<RigidTransform> found = searchPose(row, paperScene(row, test::sharedFolder()));
    ASSERT_TRUE(found.has_value()) << row.name;
    EXPECT_LT(glm::distance(found->translation, row.pose.translation), 1e-12) << row.name;
    EXPECT_LT(glm::length(found->rotation - row.pose.rotation), 1e-12) << row.name;
  }
}

TEST(PaperRows, SayWhichFileIsMissing) {
  for (const PaperRow& row : paperRows())
    EXPECT_THROW(paperScene(row, "/nowhere"), Error) << row.name;
}

}  // namespace
}  // namespace nearfit::bench::paper_rows_test
