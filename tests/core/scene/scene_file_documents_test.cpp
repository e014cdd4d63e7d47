#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/scene/document_parts.h"
#include "core/scene/scene_file.h"
#include "tests/support/cached_meshes.h"
#include "tests/support/documents.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::scene_file_documents_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A scene of the vise's document, the pins finer than the importer chooses, saved.
class SceneFileDocuments : public testing::Test {
 protected:
  static constexpr Tessellation kFine{1e-5, 0.1};

  SceneFileDocuments() {
    addTo(scene_, partsOfDocument(loadDocument(document_, 1.0), scene_));
    const PartGeometryPtr fine =
        loadPartGeometries(std::vector<MeshSource>{{document_, 1.0, {}, "pin", kFine}})[0].geometry;
    for (const Scene::PartPtr& each : std::vector(scene_.parts())) {
      if (each->geometry->shapeKey != "pin") continue;
      Part part = *each;
      part.geometry = fine;
      scene_.replace(part);
    }
    writeSceneFile(scene_, file_);
  }

  test::TemporaryFolder folder_;
  test::FakeImporter importer_;
  const std::filesystem::path document_ = folder_.write("vise.step", "the vise");
  const std::filesystem::path file_ = folder_.path() / "fit.nearfit";
  Scene scene_;
};

TEST_F(SceneFileDocuments, FileSaysShapesAndTheirTessellation) {
  const nlohmann::json json = nlohmann::json::parse(test::readBytes(file_));
  EXPECT_EQ(json["parts"][0]["mesh"], "vise.step");
  EXPECT_EQ(json["parts"][0]["metresPerUnit"], 1.0);
  EXPECT_EQ(json["parts"][0]["shape"], nlohmann::json({{"key", "body"}, {"chord", 0.0}, {"angle", 0.0}}));
  EXPECT_EQ(json["parts"][2]["shape"], nlohmann::json({{"key", "pin"}, {"chord", 1e-5}, {"angle", 0.1}}));
}

TEST_F(SceneFileDocuments, SceneComesBackWithOneRunForEachTessellation) {
  const int before = importer_.runs();
  const Scene read = readSceneFile(file_);
  EXPECT_LE(importer_.runs(), before + 2);
  ASSERT_EQ(read.parts().size(), 3U);
  EXPECT_EQ(read.groups().size(), scene_.groups().size());
  EXPECT_EQ(read.parts()[1]->geometry, read.parts()[2]->geometry);
  for (std::size_t i = 0; i < 3; ++i) {
    const PartGeometry &a = *scene_.parts()[i]->geometry, &b = *read.parts()[i]->geometry;
    EXPECT_EQ(a.shapeKey, b.shapeKey);
    EXPECT_EQ(a.tessellation, b.tessellation);
    EXPECT_EQ(a.mesh.triangles().size(), b.mesh.triangles().size());
    EXPECT_EQ(a.surfaces->faces.size(), b.surfaces->faces.size());
    EXPECT_EQ(read.parts()[i]->colour, scene_.parts()[i]->colour);
  }
}

TEST_F(SceneFileDocuments, RepairedShapesComeBackWithTheirTessellationAndFaces) {
  // The 50 facets of the fine pin are 0.63 mm wide: every other corner is merged with its neighbour.
  const MeshSource source{
      .file = document_, .shape = "pin", .tessellation = kFine, .repairs = {{RepairKind::Weld, 7e-4}}};
  Part part = *scene_.parts()[2];
  const std::size_t whole = part.geometry->mesh.triangles().size();
  part.geometry = loadPartGeometries(std::vector{source}).front().geometry;
  ASSERT_NE(part.geometry, nullptr);
  ASSERT_LT(part.geometry->mesh.triangles().size(), whole);
  scene_.replace(part);
  writeSceneFile(scene_, file_);
  const Scene read = readSceneFile(file_);
  const PartGeometry &saved = *part.geometry, &back = *read.parts()[2]->geometry;
  EXPECT_EQ(back.repairs, source.repairs);
  EXPECT_EQ(back.tessellation, kFine);
  EXPECT_TRUE(test::areSame(back.mesh, saved.mesh));
  ASSERT_EQ(back.surfaces->faceOfTriangle.size(), back.mesh.triangles().size());
  EXPECT_EQ(back.surfaces->faceOfTriangle, saved.surfaces->faceOfTriangle);
  EXPECT_EQ(read.parts()[1]->geometry->mesh.triangles().size(), whole) << "the other pin was not repaired";
}

TEST_F(SceneFileDocuments, ChangedDocumentIsTakenAndListedOnceWhereThatIsAskedFor) {
  folder_.write("vise.step", "the vise, changed");
  EXPECT_THROW(readSceneFile(file_), FileError);
  std::vector<std::filesystem::path> changed;
  const Scene read = readSceneFile(file_, {}, &changed);
  EXPECT_THAT(changed, ElementsAre(std::filesystem::canonical(document_)));
  EXPECT_EQ(read.parts().size(), 3U);
}

TEST_F(SceneFileDocuments, ShapeThatTheDocumentHasNoMoreIsToldByItsPart) {
  nlohmann::json json = nlohmann::json::parse(test::readBytes(file_));
  json["parts"][1]["shape"]["key"] = "nut";
  folder_.write("fit.nearfit", json.dump());
  try {
    readSceneFile(file_);
    FAIL();
  } catch (const FileError& e) {
    EXPECT_THAT(e.what(), HasSubstr("parts[1].mesh: "));
    EXPECT_THAT(e.what(), HasSubstr("no shape \"nut\""));
  }
}

}  // namespace
}  // namespace nearfit::scene_file_documents_test
