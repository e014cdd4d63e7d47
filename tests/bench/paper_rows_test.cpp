#include "tests/bench/paper_rows.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
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
  return {paperRows().begin(), paperRows().end()};
}

TEST(PaperRows, AreThoseThatThePaperPrints) {
  // Appendix A: model, scene, number of LMDs, rate.
  const std::vector<std::array<double, 4>> printed{{512, 6302, 3, 176},   {512, 6302, 1, 1506},
                                                   {512, 6302, 10, 121},  {128, 2204, 2, 337},
                                                   {5648, 23578, 2, 181}, {512, 12802, 2, 318}};
  ASSERT_EQ(paperRows().size(), printed.size());
  for (std::size_t i = 0; i < printed.size(); ++i) {
    const PaperRow& row = paperRows()[i];
    EXPECT_EQ(row.letter, "abcdef"[i]);
    EXPECT_EQ(static_cast<double>(row.partTriangles), printed[i][0]);
    EXPECT_EQ(static_cast<double>(row.sceneTriangles), printed[i][1]);
    EXPECT_EQ(static_cast<double>(row.printedMinima), printed[i][2]);
    EXPECT_EQ(std::floor(row.printedRate), printed[i][3]);
  }
}

TEST(PaperRows, HaveMeshesOfThePrintedCounts) {
  for (const PaperRow& row : rowsWithMeshes()) {
    const BenchScene meshes = paperScene(row, test::sharedFolder());
    EXPECT_EQ(meshes.scene.triangles().size(), row.sceneTriangles) << row.letter;
    EXPECT_EQ(meshes.part.triangles().size(), row.partTriangles) << row.letter;
    EXPECT_NEAR(meshes.size(), 1.0, 1e-9) << row.letter;
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
    EXPECT_EQ(found.size(), row.printedMinima) << row.letter;
    EXPECT_FALSE(query.isTouching()) << row.letter;
    ASSERT_FALSE(found.empty()) << row.letter;
    EXPECT_GE(found.front().distance, kMinGap * cutoff) << row.letter;
    // Within the stated region.
    const glm::dvec3 off = row.pose.applyToPoint(meshes.part.bounds().centre()) - row.regionCentre;
    for (int k = 0; k < 3; ++k)
      EXPECT_LE(std::abs(off[k]), row.regionHalf[k] + 1e-12) << row.letter;
    EXPECT_LE(2.0 * std::acos(std::min(1.0, std::abs(row.pose.rotation.w))), row.maxTurn + 1e-9)
        << row.letter;
  }
}

TEST(PaperRows, HaveThePoseThatTheSearchFinds) {
  for (const PaperRow& row : rowsWithMeshes()) {
    // The others take minutes: nearfit-bench paper --search prints all.
    if (row.letter != 'a' && row.letter != 'b' && row.letter != 'd') continue;
    const std::optional<RigidTransform> found = searchPose(row, paperScene(row, test::sharedFolder()));
    ASSERT_TRUE(found.has_value()) << row.letter;
    EXPECT_LT(glm::distance(found->translation, row.pose.translation), 1e-12) << row.letter;
    EXPECT_LT(glm::length(found->rotation - row.pose.rotation), 1e-12) << row.letter;
  }
}

TEST(PaperRows, SayWhichFileIsMissing) {
  for (const PaperRow& row : paperRows())
    EXPECT_THROW(paperScene(row, "/nowhere"), Error) << row.letter;
}

}  // namespace
}  // namespace nearfit::bench::paper_rows_test
