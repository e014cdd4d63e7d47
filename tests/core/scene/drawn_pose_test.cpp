#include "core/scene/drawn_pose.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/scene/document_load.h"
#include "tests/support/documents.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/support/refusal_of.h"
#include "tests/support/scoped_variable.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::drawn_pose_test {
namespace {

using ::testing::HasSubstr;

RigidTransform shifted(double x, double y, double z) {
  return {glm::dquat(1.0, 0.0, 0.0, 0.0), glm::dvec3(x, y, z)};
}

/// The vise, whose two pins are drawn at x = 0.1 m and y = -0.02 and 0.02 m (documents.h).
class DrawnPose : public testing::Test {
 protected:
  DrawnPose() {
    document_ = loadDocument(file_, 1.0);
    body_ = scene_.add(test::partOf(document_.shapes[0], "Body", shifted(1, 2, 3)));
    pin_ = scene_.add(test::partOf(document_.shapes[1], "Pin", shifted(0.1, 0.02, 0)));
  }

  test::TemporaryFolder folder_, cache_;
  const test::ScopedVariable variable_{"NEARFIT_CACHE", cache_.path().string()};
  const std::filesystem::path file_ = folder_.write("vise.step", "the vise");
  const test::FakeImporter importer_;
  LoadedDocument document_;
  Scene scene_;
  PartId body_{}, pin_{};
};

TEST_F(DrawnPose, OfAMeshFileItIsThatOfItsCoordinates) {
  const PartId cube =
      scene_.add(test::partOf(test::geometryOf(test::boxMesh({1, 1, 1})), "Cube", shifted(4, 5, 6)));
  const RigidTransform pose = drawnPose(scene_, cube);
  EXPECT_EQ(pose.translation, glm::dvec3(0.0));
  EXPECT_EQ(pose.rotation, glm::dquat(1.0, 0.0, 0.0, 0.0));
}

TEST_F(DrawnPose, OfADocumentsPartItIsWhereTheDocumentPlacesIt) {
  EXPECT_EQ(drawnPose(scene_, body_).translation, glm::dvec3(0.0));
}

TEST_F(DrawnPose, OfSeveralPlacesItIsTheOneThatIsFree) {
  const PartId other = scene_.add(test::partOf(document_.shapes[1], "Pin 2", shifted(0.5, 0.5, 0.5)));
  const glm::dvec3 drawn = drawnPose(scene_, other).translation;
  EXPECT_NEAR(glm::distance(drawn, glm::dvec3(0.1, -0.02, 0.0)), 0.0, 1e-12);
  EXPECT_NEAR(glm::distance(drawnPose(scene_, pin_).translation, glm::dvec3(0.1, 0.02, 0.0)), 0.0, 1e-12)
      << "it is there";
}

TEST_F(DrawnPose, SeveralFreePlacesAreRefused) {
  Part pin = scene_.get(pin_);
  pin.worldFromPart = shifted(0.5, 0.5, 0.5);
  scene_.replace(pin);
  EXPECT_THAT(test::refusalOf([&] { drawnPose(scene_, pin_); }), HasSubstr("2 free places"));
}

TEST_F(DrawnPose, ADocumentThatWasChangedIsRefused) {
  std::ofstream(file_) << "another vise";
  EXPECT_THROW(drawnPose(scene_, body_), FileError);
}

TEST_F(DrawnPose, APartWithoutAFileWasDrawnNowhere) {
  const PartId empty = scene_.add(test::partOf(nullptr, "Empty"));
  EXPECT_THAT(test::refusalOf([&] { drawnPose(scene_, empty); }), HasSubstr("drawn nowhere"));
}

}  // namespace
}  // namespace nearfit::drawn_pose_test
