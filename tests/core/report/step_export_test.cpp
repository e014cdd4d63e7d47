// What nearfit-export is asked for; what it makes of it: tests/app/export.
#include "core/report/step_export.h"

#include <memory>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/report/mesh_export.h"
#include "tests/core/report/assembly_fixture.h"
#include "tests/support/scoped_variable.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::step_export_test {
namespace {

StepRequest requestOf(const Scene& scene) {
  return stepRequest(scene, chosenParts(scene, {}), StepSchema::Ap214, "fit");
}

TEST(StepExport, ProductsHaveTheNamesOfTheirOnlyPartsOrOfTheirGeometry) {
  const test::AssemblyScene model;
  const StepRequest request = requestOf(model.scene);
  ASSERT_EQ(request.document.shapes.size(), 3U);
  EXPECT_EQ(request.document.shapes[1].key, "Box");
  EXPECT_EQ(request.document.shapes[2].key, "Square");
  std::set<std::string> keys;
  for (const CadShape& shape : request.document.shapes)
    EXPECT_TRUE(keys.insert(shape.key).second);
  EXPECT_EQ(request.document.nodes.size(), 7U);
}

TEST(StepExport, SourcesAreThoseOfExactUnrepairedShapes) {
  PartGeometry exact = *test::solidGeometryOf(test::boxMesh(glm::dvec3(1.0)));
  exact.file = "/tmp/a.STEP.gz";
  exact.sha256 = std::string(64, 'a');
  exact.shapeKey = "box";
  exact.isExact = true;
  const auto sourceOf = [](const PartGeometry& geometry) {
    Scene scene;
    scene.add(test::partOf(std::make_shared<const PartGeometry>(geometry), "Box"));
    return requestOf(scene).sources.at(0);
  };
  const auto source = sourceOf(exact);
  ASSERT_TRUE(source);
  EXPECT_EQ(source->key, "box");
  EXPECT_EQ(source->file, "/tmp/a.STEP.gz");
  PartGeometry repaired = exact;
  repaired.repairs = {{RepairKind::Orient, 0.0}};
  EXPECT_FALSE(sourceOf(repaired));
  PartGeometry robot = exact;
  robot.file = "/tmp/a.urdf";
  EXPECT_FALSE(sourceOf(robot)) << "its solids come from no CAD file";
  PartGeometry triangles = exact;
  triangles.isExact = false;
  EXPECT_FALSE(sourceOf(triangles));
}

TEST(StepExport, GroupsNestedTooDeepAreLeftOutAndTheirPartsStay) {
  Scene scene;
  std::optional<GroupId> group;
  for (std::size_t i = 0; i < kMaxGroupDepth; ++i)
    group = scene.addGroup({{}, "Group " + std::to_string(i), group, false});
  Part part = test::partOf(test::solidGeometryOf(test::boxMesh(glm::dvec3(1.0))), "Box");
  part.group = group;
  scene.add(part);
  const CadDocument document = requestOf(scene).document;
  EXPECT_NO_THROW(checkDocument(document));
  EXPECT_EQ(document.nodes.size(), kMaxDocumentDepth);
  EXPECT_EQ(document.nodes.back().name, "Box");
}

TEST(StepExport, WithoutItsProgramItSaysWhatIsMissingAndKeepsTheOldFile) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.write("fit.step", "old");
  const test::ScopedVariable program("NEARFIT_EXPORT", (folder.path() / "missing").string().c_str());
  const test::AssemblyScene model;
  try {
    exportStep(model.scene, chosenParts(model.scene, {}), StepSchema::Ap214, file);
    ADD_FAILURE() << "did not fail";
  } catch (const FileError& error) {
    EXPECT_THAT(error.problem(), testing::HasSubstr("writes CAD files"));
  }
  EXPECT_THROW(exportStep(model.scene, {}, StepSchema::Ap214, file), UsageError);
  EXPECT_EQ(test::readBytes(file), "old");
}

}  // namespace
}  // namespace nearfit::step_export_test
