#include "core/report/assembly_tree.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/report/mesh_export.h"
#include "tests/core/report/assembly_fixture.h"

namespace nearfit::assembly_tree_test {
namespace {

TEST(AssemblyTree, GroupsComeBeforeTheirMembersAndEmptyOnesAreLeftOut) {
  const test::AssemblyScene model;
  const AssemblyTree tree = assemblyTree(model.scene, chosenParts(model.scene, {}));
  std::vector<std::string> names;
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    names.push_back(tree.nodes[i].name);
    EXPECT_LT(tree.nodes[i].parent, static_cast<std::int32_t>(i));
    EXPECT_EQ(tree.nodes[i].part == nullptr, tree.nodes[i].geometry < 0);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"Outer <1>", "Inner", "Ring", test::kHostileName, "Third ring",
                                             "Box", "Square"}));
  EXPECT_EQ(tree.nodes[1].parent, 0);
  EXPECT_EQ(tree.nodes[2].parent, 1);
  EXPECT_EQ(tree.nodes[3].parent, -1);
}

TEST(AssemblyTree, AGeometryThatWasLoadedTwiceIsOneAndEqualOriginsOfOtherMeshesAreTwo) {
  Scene scene;
  scene.add(test::partOf(test::solidGeometryOf(test::boxMesh(glm::dvec3(1.0))), "A"));
  scene.add(test::partOf(test::solidGeometryOf(test::boxMesh(glm::dvec3(1.0))), "B"));
  scene.add(test::partOf(test::solidGeometryOf(test::boxMesh(glm::dvec3(2.0))), "C"));
  const AssemblyTree tree = assemblyTree(scene, chosenParts(scene, {}));
  ASSERT_EQ(tree.geometries.size(), 2U);
  EXPECT_EQ(tree.uses, (std::vector<std::uint32_t>{2, 1}));
  EXPECT_EQ(tree.nodes[0].geometry, tree.nodes[1].geometry);
  EXPECT_NE(tree.nodes[0].geometry, tree.nodes[2].geometry);
}

TEST(AssemblyTree, WithoutPartsThereIsNone) {
  EXPECT_THROW(assemblyTree({}, {}), UsageError);
}

TEST(AssemblyTree, NamesAreThoseOfFilesAsPrintableText) {
  EXPECT_EQ(assemblyName("/home/me/fit one.step"), "fit one");
  EXPECT_EQ(assemblyName("\xFF.step"), "\\xff");
  PartGeometry geometry;
  geometry.file = "/home/me/peg.stl";
  EXPECT_EQ(geometryName(geometry), "peg");
  geometry.shapeKey = "bolt/2";
  EXPECT_EQ(geometryName(geometry), "bolt/2");
}

}  // namespace
}  // namespace nearfit::assembly_tree_test
