#include "core/report/mesh_export.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/import/mesh_import.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/support/random_values.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::mesh_export_test {
namespace {

using testing::HasSubstr;

constexpr double kMillimetre = 1e-3;

/// Two parts that are turned and apart, a hidden one, and names that formats might stumble over.
class MeshExport : public ::testing::Test {
 protected:
  MeshExport() {
    test::RandomValues random(7);
    RigidTransform pose = random.pose().normalized();
    scene_.add(
        test::partOf(test::geometryOf(test::torusMesh(0.05, 0.02, 24, 12)), "Ring # 1 \xC3\xA9", pose));
    pose = random.pose().normalized();
    pose.translation.x += 2.0;
    moving_ = scene_.add(test::partOf(test::geometryOf(test::icosphereMesh(0.03, 2)), "Ball", pose));
    Part hidden = test::partOf(test::geometryOf(test::boxMesh(glm::dvec3(1.0))), "Hidden");
    hidden.isVisible = false;
    hidden_ = scene_.add(hidden);
    scene_.setMovingPart(moving_);
  }

  /// What the file holds, read by the importer as a user would open it.
  ImportedMesh exported(MeshFileKind kind, std::span<const PartId> only = {}) {
    file_ = folder_.path() / ("out." + std::string(extensionOf(kind)));
    size_ = exportMesh(chosenParts(scene_, only), kind, kMillimetre, file_);
    return importMesh(file_, {.metresPerUnit = kMillimetre, .weldTolerance = 0.0});
  }
  /// All corners of all visible parts, placed by a matrix.
  std::vector<glm::dvec3> expectedCorners() const {
    std::vector<glm::dvec3> corners;
    for (const Scene::PartPtr& part : scene_.parts()) {
      if (!part->isVisible) continue;
      const glm::dmat4 placed = part->worldFromPart.toMatrix();
      for (const Triangle& t : part->geometry->mesh.triangles()) {
        for (const std::uint32_t v : t)
          corners.emplace_back(placed * glm::dvec4(part->geometry->mesh.vertices()[v], 1.0));
      }
    }
    return corners;
  }
  void expectSame(const TriangleMesh& mesh, double tolerance) const {
    const std::vector<glm::dvec3> expected = expectedCorners();
    ASSERT_EQ(3 * mesh.triangles().size(), expected.size());
    double worst = 0.0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      // Triangles keep their order, and their corners theirs up to where each begins.
      const Triangle& t = mesh.triangles()[i / 3];
      double nearest = 1e9;
      for (std::size_t k = 0; k < 3; ++k)
        nearest = std::min(nearest, glm::distance(mesh.vertices()[t[k]], expected[i]));
      worst = std::max(worst, nearest);
    }
    EXPECT_LE(worst, tolerance);
  }

  test::TemporaryFolder folder_;
  Scene scene_;
  PartId moving_{}, hidden_{};
  std::filesystem::path file_;
  MeshExportSize size_;
};

TEST_F(MeshExport, BinaryStlIsReadBackToSinglePrecision) {
  const ImportedMesh read = exported(MeshFileKind::StlBinary);
  // Half a unit in the last place of a single at two metres, as millimetres.
  expectSame(read.mesh, 2.5e-7);
  EXPECT_TRUE(read.report.warnings.empty());
  EXPECT_EQ(read.mesh.topology().components, 2U);
  EXPECT_TRUE(read.mesh.topology().isClosed());
}

TEST_F(MeshExport, NormalsOfStlAreThoseOfItsTriangles) {
  exported(MeshFileKind::StlBinary);
  const std::string bytes = test::readBytes(file_);
  EXPECT_NE(bytes.substr(0, 5), "solid");
  for (std::size_t at = 84; at + 50 <= bytes.size(); at += 50) {
    float v[12];
    std::memcpy(v, bytes.data() + at, sizeof v);
    const glm::dvec3 n(v[0], v[1], v[2]), a(v[3], v[4], v[5]), b(v[6], v[7], v[8]), c(v[9], v[10], v[11]);
    EXPECT_NEAR(glm::dot(n, glm::normalize(glm::cross(b - a, c - a))), 1.0, 1e-3);
  }
}

TEST_F(MeshExport, ObjAndPlyAreReadBackToDoublePrecision) {
  for (const MeshFileKind kind : {MeshFileKind::Obj, MeshFileKind::Ply}) {
    const ImportedMesh read = exported(kind);
    expectSame(read.mesh, 1e-14);
    EXPECT_TRUE(read.report.warnings.empty());
    EXPECT_TRUE(read.mesh.topology().isClosed());
    EXPECT_TRUE(read.mesh.topology().isOriented());
  }
}

TEST_F(MeshExport, NamesArePreservedAsObjectsAndGroupsOfObj) {
  exported(MeshFileKind::Obj);
  const std::string text = test::readBytes(file_);
  EXPECT_THAT(text, HasSubstr("\no Ring # 1 \xC3\xA9\ng Ring_#_1_\xC3\xA9\nv "));
  EXPECT_THAT(text, HasSubstr("\no Ball\ng Ball\nv "));
  EXPECT_EQ(text.find("Hidden"), text.npos);
}

TEST_F(MeshExport, ThePartsThatAreChosenAreWrittenHiddenOnesToo) {
  const PartId only[] = {hidden_};
  const ImportedMesh read = exported(MeshFileKind::Obj, only);
  EXPECT_EQ(read.mesh.triangles().size(), 12U);
  EXPECT_NEAR(read.mesh.bounds().upper.x, 0.5, 1e-15);
  EXPECT_EQ(size_.parts, 1U);
}

TEST_F(MeshExport, TheSizeIsForetold) {
  for (const MeshFileKind kind : {MeshFileKind::StlBinary, MeshFileKind::Obj, MeshFileKind::Ply}) {
    const MeshExportSize told = meshExportSize(chosenParts(scene_, {}), kind);
    exported(kind);
    const auto bytes = static_cast<double>(std::filesystem::file_size(file_));
    EXPECT_EQ(size_.bytes, std::filesystem::file_size(file_));
    const double slack = kind == MeshFileKind::Obj   ? 0.25 * bytes
                         : kind == MeshFileKind::Ply ? 400.0  // Its header.
                                                     : 0.0;
    EXPECT_NEAR(static_cast<double>(told.bytes), bytes, slack) << extensionOf(kind);
    EXPECT_EQ(told.triangles, size_.triangles);
  }
}

TEST_F(MeshExport, TheMovingPartIsWrittenWhereItIsNow) {
  const RigidTransform now{{1.0, 0.0, 0.0, 0.0}, {0.0, 0.0, 9.0}};
  const Scene placed = placedScene(scene_, now);
  EXPECT_EQ(placed.find(moving_)->worldFromPart.translation.z, 9.0);
  EXPECT_NE(scene_.find(moving_)->worldFromPart.translation.z, 9.0) << "the scene itself stays";
  EXPECT_THROW(placedScene(scene_, {{2.0, 0.0, 0.0, 0.0}, {}}), UsageError);
}

TEST_F(MeshExport, RefusalsAndCancellingLeaveTheOldFile) {
  const std::filesystem::path file = folder_.write("out.stl", "old");
  EXPECT_THROW(exportMesh({}, MeshFileKind::StlBinary, 1.0, file), UsageError);
  EXPECT_THROW(exportMesh(chosenParts(scene_, {}), MeshFileKind::StlBinary, 0.0, file), UsageError);
  Scene large;
  large.add(test::partOf(test::geometryOf(test::icosphereMesh(1.0, 6)), "Large"));
  const auto stop = [](double) { return false; };
  EXPECT_THROW(exportMesh(chosenParts(large, {}), MeshFileKind::StlBinary, 1.0, file, stop), Cancelled);
  EXPECT_EQ(test::readBytes(file), "old");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 1);
  EXPECT_THROW(exportMesh(chosenParts(scene_, {}), MeshFileKind::Obj, 1.0, folder_.path() / "no" / "x.obj"),
               FileError);
}

}  // namespace
}  // namespace nearfit::mesh_export_test
