#include "core/scene/document_parts.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/scene/scene_file.h"
#include "tests/support/documents.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"

namespace nearfit::document_parts_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A document of shapes that are all there.
LoadedDocument documentOf(std::vector<CadNode> nodes, std::size_t shapes = 1,
                          const char* file = "/cad/vise.step") {
  LoadedDocument document;
  document.file = file;
  document.nodes = std::move(nodes);
  for (std::size_t i = 0; i < shapes; ++i)
    document.shapes.push_back(test::freshGeometryOf(test::boxMesh(glm::dvec3(0.1))));
  return document;
}

/// The names of a part and of the groups around it, from the top.
std::string pathOf(const Scene& scene, const Part& part) {
  std::string path = part.name;
  for (const Group* g = part.group ? scene.findGroup(*part.group) : nullptr; g != nullptr;
       g = g->parent ? scene.findGroup(*g->parent) : nullptr)
    path.insert(0, g->name + "|");
  return path;
}

std::vector<std::string> pathsIn(const Scene& scene) {
  std::vector<std::string> paths;
  for (const Scene::PartPtr& part : scene.parts())
    paths.push_back(pathOf(scene, *part));
  return paths;
}

Scene sceneOf(const LoadedDocument& document) {
  Scene scene;
  addTo(scene, partsOfDocument(document, scene));
  return scene;
}

TEST(DocumentParts, AssembliesAreGroupsAndInstancesShareTheirGeometry) {
  const LoadedDocument vise = documentOf(test::viseDocument().nodes, 2);
  const Scene scene = sceneOf(vise);
  EXPECT_THAT(pathsIn(scene), ElementsAre("vise|body", "vise|jaws|pin", "vise|jaws|pin 2"));
  EXPECT_EQ(scene.groups().size(), 2U) << "an assembly without parts is left out";
  EXPECT_EQ(scene.parts()[0]->geometry, vise.shapes[0]);
  EXPECT_EQ(scene.parts()[1]->geometry, vise.shapes[1]);
  EXPECT_EQ(scene.parts()[2]->geometry, vise.shapes[1]);
}

TEST(DocumentParts, PlacementsAddUpFromTheTop) {
  const double half = std::sqrt(0.5);
  // A quarter turn about z takes x to y.
  const Scene scene =
      sceneOf(documentOf({test::assemblyNode("outer", -1, {{half, 0, 0, half}, {1.0, 0.0, 0.0}}),
                          test::assemblyNode("inner", 0, {{half, 0, 0, half}, {0.5, 0.0, 0.0}}),
                          test::instanceNode("part", 1, 0, {{1, 0, 0, 0}, {0.25, 0.0, 0.0}})}));
  const RigidTransform& pose = scene.parts()[0]->worldFromPart;
  EXPECT_NEAR(pose.translation.x, 1.0 - 0.25, 1e-15);
  EXPECT_NEAR(pose.translation.y, 0.5, 1e-15);
  EXPECT_NEAR(std::abs(pose.rotation.z), 1.0, 1e-15);
}

TEST(DocumentParts, ColourIsItsOwnOrThatOfTheNearestAssemblyOrOneForEachShape) {
  std::vector<CadNode> nodes{test::assemblyNode("a", -1),   test::instanceNode("b", 0, 0),
                             test::instanceNode("c", 0, 0), test::assemblyNode("d", -1),
                             test::instanceNode("e", 3, 0), test::instanceNode("f", 3, 1)};
  nodes[0].colour = CadColour{1.0F, 0.5F, 0.0F};
  nodes[2].colour = CadColour{0.0F, 0.0F, 1.0F};
  nodes.push_back(test::instanceNode("g", 3, 0));
  const Scene scene = sceneOf(documentOf(nodes, 2));
  const auto colourOf = [&](const char* name) { return scene.findByName(name)->colour; };
  EXPECT_EQ(colourOf("b"), (Colour{1.0F, 0.5F, 0.0F}));
  EXPECT_EQ(colourOf("c"), (Colour{0.0F, 0.0F, 1.0F}));
  EXPECT_EQ(colourOf("e"), colourOf("g"));
  EXPECT_FALSE(colourOf("e") == colourOf("f"));
}

TEST(DocumentParts, SeveralItemsAtTheTopGetAGroupWithTheFilesName) {
  EXPECT_THAT(pathsIn(sceneOf(documentOf({test::instanceNode("a", -1, 0), test::instanceNode("b", -1, 0)}))),
              ElementsAre("vise|a", "vise|b"));
  EXPECT_THAT(pathsIn(sceneOf(documentOf({test::instanceNode("a", -1, 0), test::assemblyNode("empty", -1)}))),
              ElementsAre("a"));
}

TEST(DocumentParts, UnnamedItemsGetTheFilesNameAndANumber) {
  EXPECT_THAT(pathsIn(sceneOf(documentOf(
                  {test::assemblyNode("", -1), test::instanceNode("", 0, 0), test::instanceNode("", 0, 0)}, 1,
                  "/cad/vise.step.gz"))),
              ElementsAre("vise 1|vise 2", "vise 1|vise 3"));
  EXPECT_THAT(pathsIn(sceneOf(documentOf({test::instanceNode("", -1, 0)}))), ElementsAre("vise"));
}

TEST(DocumentParts, TheOnlyPartGetsTheFilesNameIfItsOwnSaysNothing) {
  for (const char* name : {"Document", "1", "042", "Part", "SHAPE", "Solid", "Unnamed", "NONE"}) {
    EXPECT_THAT(pathsIn(sceneOf(documentOf({test::instanceNode(name, -1, 0)}))), ElementsAre("vise")) << name;
  }
  for (const char* name : {"Document 1", "1a", "Parts"})
    EXPECT_THAT(pathsIn(sceneOf(documentOf({test::instanceNode(name, -1, 0)}))), ElementsAre(name));
  EXPECT_THAT(pathsIn(sceneOf(documentOf({test::assemblyNode("jaws", -1), test::instanceNode("1", 0, 0)}))),
              ElementsAre("jaws|vise"));
  EXPECT_THAT(pathsIn(sceneOf(documentOf({test::instanceNode("1", -1, 0), test::instanceNode("2", -1, 0)}))),
              ElementsAre("vise|1", "vise|2"))
      << "numbers tell several parts apart";
}

TEST(DocumentParts, ItemThatIsBothAShapeAndAnAssemblyIsInItsOwnGroup) {
  EXPECT_THAT(
      pathsIn(sceneOf(documentOf({test::instanceNode("frame", -1, 0), test::instanceNode("bolt", 0, 0)}))),
      ElementsAre("frame|frame", "frame|bolt"));
}

TEST(DocumentParts, ShapeThatIsNotThereLeavesItsInstancesOut) {
  LoadedDocument document = documentOf(
      {test::assemblyNode("a", -1), test::instanceNode("b", 0, 0), test::instanceNode("c", 0, 1)}, 2);
  document.shapes[0] = nullptr;
  EXPECT_THAT(pathsIn(sceneOf(document)), ElementsAre("a|c"));
}

TEST(DocumentParts, AssembliesTooDeepForGroupsAreNamedWithTheirParts) {
  std::vector<CadNode> nodes;
  for (std::int32_t i = 0; i < 40; ++i)
    nodes.push_back(test::assemblyNode("g" + std::to_string(i), i - 1));
  nodes.push_back(test::instanceNode("part", 39, 0));
  nodes.push_back(test::instanceNode("beside", 33, 0));
  const Scene scene = sceneOf(documentOf(nodes));
  EXPECT_EQ(scene.groups().size(), kMaxGroupDepth);
  EXPECT_EQ(scene.parts()[0]->name, "g32 / g33 / g34 / g35 / g36 / g37 / g38 / g39 / part");
  EXPECT_EQ(scene.parts()[1]->name, "g32 / g33 / beside");
  EXPECT_EQ(scene.parts()[0]->group, scene.parts()[1]->group);
}

TEST(DocumentParts, LongNamesAreCutInTheOuterOnes) {
  std::vector<CadNode> nodes;
  for (std::int32_t i = 0; i < 40; ++i)
    nodes.push_back(test::assemblyNode(std::string(150, 'g'), i - 1));
  nodes.push_back(test::instanceNode(std::string(180, 'p'), 39, 0));
  const std::string name = sceneOf(documentOf(nodes)).parts()[0]->name;
  EXPECT_LE(name.size(), kMaxPartNameBytes);
  EXPECT_THAT(name, ::testing::EndsWith(" / " + std::string(180, 'p')));
}

TEST(DocumentParts, GroupsThatTheSceneCannotHoldAreNamedWithTheirParts) {
  Scene scene;
  for (std::size_t i = 0; i + 1 < kMaxGroups; ++i)
    scene.addGroup({{}, "g", {}, false});
  addTo(scene, partsOfDocument(documentOf(test::viseDocument().nodes, 2), scene));
  EXPECT_THAT(pathsIn(scene), ElementsAre("vise|body", "vise|jaws / pin", "vise|jaws / pin 2"));
}

TEST(DocumentParts, MorePartsThanASceneFileCanHoldAreRefused) {
  std::vector<CadNode> nodes{test::assemblyNode("wall", -1)};
  for (std::size_t i = 0; i <= kMaxSceneFileParts; ++i)
    nodes.push_back(test::instanceNode("brick", 0, 0));
  const LoadedDocument document = documentOf(nodes);
  try {
    partsOfDocument(document, {});
    FAIL();
  } catch (const FileError& e) {
    EXPECT_THAT(e.what(), HasSubstr("places 10001 parts"));
  }
}

TEST(DocumentParts, PlacementsThatAddUpBeyondReachAreRefused) {
  const RigidTransform far{{1, 0, 0, 0}, {0.9e9, 0.0, 0.0}};
  const LoadedDocument document =
      documentOf({test::assemblyNode("a", -1, far), test::instanceNode("b", 0, 0, far)});
  EXPECT_THROW(partsOfDocument(document, {}), FileError);
}

TEST(NewNodes, NamesThatAreTakenGetNumbersAndOnesBesideStay) {
  const LoadedDocument vise = documentOf(test::viseDocument().nodes, 2);
  Scene scene;
  NewNodes both = partsOfDocument(vise, scene);
  both.append(partsOfDocument(vise, scene));
  const SceneNodes top = addTo(scene, both);
  EXPECT_THAT(pathsIn(scene), ElementsAre("vise|body", "vise|jaws|pin", "vise|jaws|pin 2", "vise 2|body 2",
                                          "vise 2|jaws|pin 3", "vise 2|jaws|pin 4"));
  EXPECT_EQ(top.groups.size(), 2U);
  EXPECT_TRUE(top.parts.empty());
}

}  // namespace
}  // namespace nearfit::document_parts_test
