#include "core/scene/mesh_unit.h"

#include <limits>
#include <vector>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/mesh_files.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::mesh_unit_test {
namespace {

TEST(MeshUnit, NamesAndNumbersOfMetresAreUnits) {
  EXPECT_EQ(parseMeshUnit("m", "unit"), 1.0);
  EXPECT_EQ(parseMeshUnit("cm", "unit"), 0.01);
  EXPECT_EQ(parseMeshUnit("mm", "unit"), 0.001);
  EXPECT_EQ(parseMeshUnit("um", "unit"), 1e-6);
  EXPECT_EQ(parseMeshUnit("in", "unit"), 0.0254);
  EXPECT_EQ(parseMeshUnit("ft", "unit"), 0.3048);
  EXPECT_EQ(parseMeshUnit("2.5e-3", "unit"), 0.0025);
  EXPECT_EQ(parseMeshUnit(" +0.5 ", "unit"), 0.5);
}

TEST(MeshUnit, WhatIsNoUnitIsRefusedWithItsPlace) {
  for (const char* text : {"", "mile", "mm2", "MM", "0", "-1", "nan", "inf", "1e99"})
    EXPECT_THROW((void)parseMeshUnit(text, "unit"), UsageError) << text;
  try {
    (void)parseMeshUnit("mile", "--unit");
    ADD_FAILURE() << "it was not refused";
  } catch (const UsageError& error) {
    EXPECT_EQ(error.where(), "--unit");
    EXPECT_THAT(error.problem(), testing::HasSubstr("\"mile\""));
    EXPECT_THAT(error.remedy(), testing::HasSubstr("mm"));
  }
}

constexpr double kHand = 0.19;

TEST(LikelyMeshUnit, IsThatWhoseSizeIsNearestToAHandAndMillimetresInDoubt) {
  EXPECT_EQ(likelyMeshUnit(53.0, kHand, kHand), 1e-3);
  EXPECT_EQ(likelyMeshUnit(15.0, kHand, kHand), 1e-3);
  EXPECT_EQ(likelyMeshUnit(3000.0, kHand, kHand), 1e-3);
  EXPECT_EQ(likelyMeshUnit(6.0, kHand, kHand), 0.0254);
  EXPECT_EQ(likelyMeshUnit(0.12, kHand, kHand), 1.0);
  EXPECT_EQ(likelyMeshUnit(150'000.0, kHand, kHand), 1e-6);
}

TEST(LikelyMeshUnit, FollowsThePartsThatAreThere) {
  // 6 mm among parts from 2 mm to 50 mm, and 6 m among parts of a building.
  EXPECT_EQ(likelyMeshUnit(6.0, 2e-3, 0.05), 1e-3);
  EXPECT_EQ(likelyMeshUnit(6.0, 3.0, 20.0), 1.0);
  EXPECT_EQ(likelyMeshUnit(53.0, 2e-5, 1e-4), 1e-6);
}

TEST(LikelyMeshUnit, IsMillimetresWhereThereIsNoSize) {
  for (const double size :
       {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    EXPECT_EQ(likelyMeshUnit(size, kHand, kHand), 1e-3) << size;
}

class ExtentOfMeshFiles : public testing::Test {
 protected:
  std::filesystem::path box(const char* name, const glm::dvec3& size, const glm::dvec3& centre) const {
    return folder_.write(name, test::objText(test::boxMesh(size, centre)));
  }
  test::TemporaryFolder folder_;
};

TEST_F(ExtentOfMeshFiles, OneFileHasItsOwnExtent) {
  const std::vector files{box("a.obj", {53, 16, 15}, {100, 0, 0})};
  const auto extent = extentOfMeshFiles(files);
  ASSERT_TRUE(extent);
  EXPECT_LT(glm::distance(*extent, {53, 16, 15}), 1e-12);
}

TEST_F(ExtentOfMeshFiles, SeveralFilesAreMeasuredTogetherAtTheirOwnCoordinates) {
  const std::vector files{box("a.obj", {2, 2, 2}, {0, 0, 0}), box("b.obj", {2, 4, 2}, {10, 0, 0})};
  const auto extent = extentOfMeshFiles(files);
  ASSERT_TRUE(extent);
  EXPECT_LT(glm::distance(*extent, {12, 4, 2}), 1e-12);
}

TEST_F(ExtentOfMeshFiles, FilesThatCannotBeReadAreLeftOut) {
  const std::filesystem::path bad = folder_.write("bad.off", "OFF\nnonsense\n");
  const std::vector some{bad, box("a.obj", {1, 2, 3}, {0, 0, 0}), folder_.path() / "missing.stl"};
  const auto extent = extentOfMeshFiles(some);
  ASSERT_TRUE(extent);
  EXPECT_LT(glm::distance(*extent, {1, 2, 3}), 1e-12);
  EXPECT_FALSE(extentOfMeshFiles(std::vector{bad}));
  EXPECT_FALSE(extentOfMeshFiles({}));
}

TEST(MeshUnit, UnitsAreNamedAsTheyAreGiven) {
  for (const char* name : {"m", "cm", "mm", "um", "in", "ft"})
    EXPECT_EQ(meshUnitText(parseMeshUnit(name, "--unit")), name);
  EXPECT_EQ(meshUnitText(0.5), "units of 0.5 m");
}

TEST_F(ExtentOfMeshFiles, MeasuringCanBeCancelled) {
  const std::vector files{box("a.obj", {1, 2, 3}, {0, 0, 0})};
  EXPECT_THROW((void)extentOfMeshFiles(files, [](double) { return false; }), Cancelled);
}

}  // namespace
}  // namespace nearfit::mesh_unit_test
