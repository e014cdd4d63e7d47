#include "core/report/scene_mesh_files.h"

#include <cstdint>
#include <filesystem>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/scene/built_geometry.h"
#include "core/scene/scene_file.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::scene_mesh_files_test {
namespace {

PartGeometryPtr builtFrom(const TriangleMesh& mesh) {
  return builtGeometry({mesh.vertices().begin(), mesh.vertices().end()},
                       {mesh.triangles().begin(), mesh.triangles().end()});
}

TEST(BuiltGeometry, CornersGivenOnceForEachTriangleAreMerged) {
  const TriangleMesh box = test::boxMesh({1, 1, 1});
  std::vector<glm::dvec3> corners;
  std::vector<Triangle> triangles;
  for (const Triangle& t : box.triangles()) {
    const auto first = static_cast<std::uint32_t>(corners.size());
    for (const std::uint32_t vertex : t)
      corners.push_back(box.vertices()[vertex]);
    triangles.push_back({first, first + 1, first + 2});
  }
  const PartGeometryPtr built = builtGeometry(corners, triangles);
  EXPECT_EQ(built->mesh.vertices().size(), 8U);
  EXPECT_TRUE(built->mesh.topology().isClosed());
  EXPECT_NEAR(built->mass.volume, 1.0, 1e-12);
  EXPECT_TRUE(built->file.empty());
}

TEST(BuiltGeometry, AnIndexOutOfRangeIsRefused) {
  EXPECT_THROW(builtGeometry({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 3}}), Error);
}

TEST(SceneMeshFiles, ASavedSceneOfBuiltMeshesIsReadBackToTheBit) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "fit.nearfit";
  const PartGeometryPtr box = builtFrom(test::boxMesh({0.1, 0.7, 1.0 / 3.0}));
  Scene scene;
  scene.add(test::partOf(box, "One"));
  scene.add(test::partOf(box, "Two", {glm::dquat(1, 0, 0, 0), {1, 2, 3}}));
  const Scene named = withMeshFiles(scene, file);
  EXPECT_EQ(named.parts()[0]->geometry, named.parts()[1]->geometry);
  EXPECT_EQ(named.parts()[0]->geometry->file.parent_path().filename(), "fit_meshes");
  writeSceneFile(named, file);
  const Scene read = readSceneFile(file);
  ASSERT_EQ(read.parts().size(), 2U);
  const TriangleMesh &before = box->mesh, &after = read.parts()[0]->geometry->mesh;
  ASSERT_EQ(after.vertices().size(), before.vertices().size());
  for (std::size_t i = 0; i < before.vertices().size(); ++i)
    EXPECT_EQ(after.vertices()[i], before.vertices()[i]);
  ASSERT_EQ(after.triangles().size(), before.triangles().size());
  for (std::size_t i = 0; i < before.triangles().size(); ++i)
    EXPECT_EQ(after.triangles()[i], before.triangles()[i]);
  EXPECT_TRUE(std::filesystem::exists(named.parts()[0]->geometry->file));
}

}  // namespace
}  // namespace nearfit::scene_mesh_files_test
