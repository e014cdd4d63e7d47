#include "core/report/clearance_map_export.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/import/mesh_import.h"
#include "core/report/clearance_colours.h"
#include "core/report/scene_export.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/support/ply_values.h"
#include "tests/support/random_values.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::clearance_map_export_test {
namespace {

/// Two blocks, turned as one, the upper 2 mm over the lower.
class ClearanceMapExport : public ::testing::Test {
 protected:
  ClearanceMapExport() {
    turn_ = test::RandomValues(5).pose().normalized();
    lower_ =
        scene_.add(test::partOf(test::geometryOf(test::boxMesh({0.06, 0.06, 0.01})), "Lower one", turn_));
    Part upper = test::partOf(test::geometryOf(test::boxMesh({0.04, 0.04, 0.01})), "Upper",
                              turn_ * RigidTransform{{1, 0, 0, 0}, {0.0, 0.0, 0.012}});
    upper.colour = {0.2F, 0.4F, 0.6F};
    upper_ = scene_.add(upper);
    scene_.setMovingPart(upper_);
    map_ = ClearanceMapper().map(clearanceMapRequest(scene_, upper_, 0.005, true));
  }

  /// The least distance in a file, in its unit.
  static double leastIn(const test::PlyValues& read) {
    double least = std::numeric_limits<double>::infinity();
    for (const double distance : read.vertex.at("distance"))
      if (!std::isnan(distance)) least = std::min(least, distance);
    return least;
  }

  test::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_.path() / "map.ply";
  Scene scene_;
  RigidTransform turn_;
  PartId lower_{}, upper_{};
  ClearanceMap map_;
};

TEST_F(ClearanceMapExport, GeometryIsReadBackByTheImporter) {
  const std::uint64_t bytes = exportClearanceMap(map_, scene_, 1e-3, file_);
  EXPECT_EQ(bytes, std::filesystem::file_size(file_));
  const ImportedMesh read = importMesh(file_, {.metresPerUnit = 1e-3});
  std::size_t triangles = 0;
  for (const MappedSurface& mapped : map_.surfaces)
    for (const Triangle& t : mapped.surface->triangles)
      triangles += std::ranges::all_of(t, [&](auto i) { return std::isnan(mapped.distances[i]); }) ? 0 : 1;
  EXPECT_EQ(read.mesh.triangles().size(), triangles);
  EXPECT_EQ(read.mesh.topology().components, 2U);
  // The upper one's face, the lower edges of its sides and the near part of the lower one are welded along sharp edges.
  EXPECT_EQ(read.report.degenerateFaces + read.report.duplicateFaces, 0U);
  // Each vertex is on the blocks, in the world.
  for (const glm::dvec3& p : read.mesh.vertices()) {
    const glm::dvec3 q = turn_.inverse().applyToPoint(p);
    const bool isOnLower =
        std::abs(std::max({std::abs(q.x) - 0.03, std::abs(q.y) - 0.03, std::abs(q.z) - 0.005})) < 1e-12;
    const bool isOnUpper =
        std::abs(std::max({std::abs(q.x) - 0.02, std::abs(q.y) - 0.02, std::abs(q.z - 0.012) - 0.005})) <
        1e-12;
    ASSERT_TRUE(isOnLower || isOnUpper);
  }
}

TEST_F(ClearanceMapExport, ValuesAreReadBackByAnotherParser) {
  exportClearanceMap(map_, scene_, 1e-3, file_);
  const test::PlyValues read = test::readPlyValues(file_);
  EXPECT_THAT(read.comments, testing::Contains("part Upper"));
  EXPECT_THAT(read.comments, testing::Contains("part Lower one"));
  ASSERT_LT(read.vertex.at("x").size(), map_.samples());
  std::size_t near = 0, beyond = 0;
  for (std::size_t i = 0; i < read.vertex.at("x").size(); ++i) {
    const glm::dvec3 p =
        1e-3 * glm::dvec3(read.vertex.at("x")[i], read.vertex.at("y")[i], read.vertex.at("z")[i]);
    const glm::dvec3 q = turn_.inverse().applyToPoint(p);
    const double distance = 1e-3 * read.vertex.at("distance")[i], part = read.vertex.at("part")[i];
    // The least distance of upright blocks, by hand: over the upper's sides, straight down; over the lower's top, to the
    // upper's face or its rim.
    const double x = std::max(0.0, std::abs(q.x) - 0.02), y = std::max(0.0, std::abs(q.y) - 0.02);
    const double expected =
        part == 0.0 ? q.z - 0.005 : std::hypot(std::hypot(x, y), 0.007 - std::min(q.z, 0.007));
    const Colour own = scene_.get(map_.surfaces.at(static_cast<std::size_t>(part)).part).colour;
    if (std::isnan(distance)) {
      ++beyond;
      EXPECT_GT(expected, map_.range - 1e-12);
      EXPECT_EQ(read.vertex.at("red")[i], std::round(255.0F * own.r));
      continue;
    }
    ++near;
    EXPECT_NEAR(distance, expected, 1e-12);
    const Colour colour = clearanceColour(distance, map_.range);
    // To a step: the distance was rounded by its unit.
    EXPECT_NEAR(read.vertex.at("red")[i], std::round(255.0F * colour.r), 1.0);
    EXPECT_NEAR(read.vertex.at("blue")[i], std::round(255.0F * colour.b), 1.0);
    const double length =
        std::hypot(read.vertex.at("nx")[i], read.vertex.at("ny")[i], read.vertex.at("nz")[i]);
    EXPECT_NEAR(length, 1.0, 1e-6);
  }
  std::size_t withDistance = 0;
  for (const MappedSurface& mapped : map_.surfaces)
    withDistance += static_cast<std::size_t>(
        std::ranges::count_if(mapped.distances, [](double d) { return !std::isnan(d); }));
  EXPECT_EQ(near, withDistance) << "nothing near is left out";
  EXPECT_GT(near, 1'000U);
  EXPECT_GT(beyond, 20U);
  for (const auto& corners : read.faces) {
    ASSERT_EQ(corners.size(), 3U);
    for (const std::size_t corner : corners)
      ASSERT_LT(corner, read.vertex.at("x").size());
    const auto isBeyond = [&](std::size_t corner) { return std::isnan(read.vertex.at("distance")[corner]); };
    EXPECT_FALSE(std::ranges::all_of(corners, isBeyond)) << "beyond the range";
  }
}

TEST_F(ClearanceMapExport, DistancesAreInTheUnitOfTheCoordinatesAndTheHeaderNamesIt) {
  const std::pair<double, const char*> units[] = {
      {1e-3, "mm, nan beyond 5"}, {1.0, "m, nan beyond 0.005"}, {0.5, "units of 0.5 m, nan beyond 0.01"}};
  for (const auto& [metres, words] : units) {
    exportClearanceMap(map_, scene_, metres, file_);
    const test::PlyValues read = test::readPlyValues(file_);
    EXPECT_NEAR(metres * leastIn(read), 0.002, 1e-12) << words;
    EXPECT_THAT(read.comments, testing::Contains(std::string("distance in ") + words));
    EXPECT_THAT(read.comments.front(), testing::HasSubstr("x, y, z and distance in "));
  }
}

TEST_F(ClearanceMapExport, RefusalsAndCancellingLeaveTheOldFile) {
  folder_.write("map.ply", "old");
  EXPECT_THROW(exportClearanceMap(map_, scene_, 0.0, file_), UsageError);
  EXPECT_THROW(exportClearanceMap(map_, scene_, 1.0, file_, [](double) { return false; }), Cancelled);
  EXPECT_EQ(test::readBytes(file_), "old");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 1);
}

TEST_F(ClearanceMapExport, AMapWithNothingNearIsRefused) {
  const ClearanceMap none = ClearanceMapper().map(clearanceMapRequest(scene_, upper_, 0.001, true));
  EXPECT_THROW(exportClearanceMap(none, scene_, 1e-3, file_), UsageError);
  EXPECT_FALSE(std::filesystem::exists(file_));
}

TEST_F(ClearanceMapExport, TheExportOfScenesWritesMapAndHistogramWhereTheMovingPartIsNow) {
  // A millimetre higher than in the scene.
  const RigidTransform now = turn_ * RigidTransform{{1, 0, 0, 0}, {0.0, 0.0, 0.013}};
  SceneExport what;
  what.kind = ExportKind::ClearanceMapPly;
  what.map.range = 0.005;
  exportScene(scene_, now, what, file_);
  const test::PlyValues read = test::readPlyValues(file_);
  const double least = leastIn(read);
  EXPECT_NEAR(1e-3 * least, 0.003, 1e-12);
  EXPECT_EQ(extensionOf(ExportKind::ClearanceMapPly), "ply");
  EXPECT_EQ(exportKindOf("x.ply"), ExportKind::MeshPly) << "a suffix alone means a mesh";

  what.kind = ExportKind::ClearanceHistogramCsv;
  exportScene(scene_, now, what, folder_.path() / "h.csv");
  EXPECT_TRUE(test::readBytes(folder_.path() / "h.csv").starts_with("from [m],to [m],area [m^2],share\n"));
  Scene none = scene_;
  none.setMovingPart(std::nullopt);
  EXPECT_THROW(exportScene(none, {}, what, file_), UsageError) << "of which part?";
  what.map.subject = {lower_};
  exportScene(none, {}, what, file_);
}

}  // namespace
}  // namespace nearfit::clearance_map_export_test
