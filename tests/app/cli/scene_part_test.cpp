#include "app/cli/scene_part.h"

#include <memory>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"

namespace nearfit::test::scene_part_test {
namespace {

// A report knew of the meshes that a URDF file names, and all other commands replaced them without a word.
TEST(ScenePart, FilesOfPartsIncludeThoseThatADocumentNames) {
  const PartGeometryPtr box = solidGeometryOf(boxMesh({1.0, 1.0, 1.0}));
  const auto named = [&box](const char* file, std::shared_ptr<const CompanionFiles> companions) {
    PartGeometry geometry = *box;
    geometry.file = file;
    geometry.companions = std::move(companions);
    return std::make_shared<const PartGeometry>(std::move(geometry));
  };
  Scene scene;
  scene.add(partOf(named("/models/plate.stl", nullptr), "Plate"));
  scene.add(partOf(named("/models/arm.urdf",
                         std::make_shared<const CompanionFiles>(CompanionFiles{{"/models/link.stl", ""}})),
                   "Arm"));
  EXPECT_THAT(cli::partFiles(scene),
              ::testing::UnorderedElementsAre("/models/plate.stl", "/models/arm.urdf", "/models/link.stl"));
}

TEST(ScenePart, PatternsMeanPartsThatAreThere) {
  Scene scene;
  scene.add(partOf(solidGeometryOf(boxMesh({1.0, 1.0, 1.0})), "Bolt M4"));
  EXPECT_TRUE(cli::isNameOfPart(scene, "Bolt M4"));
  EXPECT_TRUE(cli::isNameOfPart(scene, "Bolt*"));
  EXPECT_FALSE(cli::isNameOfPart(scene, "Nut*"));
}

}  // namespace
}  // namespace nearfit::test::scene_part_test
