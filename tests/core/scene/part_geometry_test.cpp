#include "core/scene/part_geometry.h"

#include <cmath>
#include <fstream>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/files/sha256.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/mesh_text.h"
#include "tests/support/temporary_folder.h"

namespace nearfit {
namespace {

TEST(PartGeometry, BoxInMillimetresIsLoadedInMetresWithItsMassAndHierarchy) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("box.obj", test::objText(test::boxMesh({20, 30, 40}, {100, 0, 0})));
  const PartGeometryPtr geometry = loadPartGeometry(file, 0.001);
  EXPECT_EQ(geometry->file, std::filesystem::canonical(file));
  EXPECT_EQ(geometry->sha256, sha256OfFile(file));
  EXPECT_EQ(geometry->metresPerUnit, 0.001);
  EXPECT_EQ(geometry->mesh.triangles().size(), 12U);
  EXPECT_NEAR(geometry->mass.volume, 0.02 * 0.03 * 0.04, 1e-15);
  EXPECT_NEAR(geometry->mass.centre.x, 0.1, 1e-12);
  EXPECT_EQ(geometry->mass.basis, MassBasis::VolumeIntegrals);
  // All 8 corners, the 12 edges that are not diagonals of a face, and all triangles can carry a minimum.
  EXPECT_EQ(geometry->tree().keptFeatures().vertices, 8U);
  EXPECT_EQ(geometry->tree().keptFeatures().edges, 12U);
  EXPECT_EQ(geometry->tree().allFeatures().edges, 18U);
}

TEST(PartGeometry, UnitsOutOfRangeAreRefused) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("box.obj", test::objText(test::boxMesh({1, 1, 1})));
  for (const double unit : {0.0, -1.0, std::nan(""), 1e300, 1e-300}) {
    EXPECT_THROW(loadPartGeometry(file, unit), UsageError) << unit;
  }
}

TEST(PartGeometry, ProgressRisesToOneAndCanStopTheWork) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("ball.obj", test::objText(test::icosphereMesh(1, 3)));
  double last = 0.0;
  loadPartGeometry(file, 1.0, [&](double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
    return true;
  });
  EXPECT_EQ(last, 1.0);
  EXPECT_THROW(loadPartGeometry(file, 1.0, [](double) { return false; }), Cancelled);
}

TEST(PartGeometry, PathsToOneFileCompareEqual) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("a.obj", "");
  std::filesystem::create_directory(folder.path() / "sub");
  std::filesystem::create_directory_symlink(folder.path() / "sub", folder.path() / "link");
  EXPECT_EQ(normalisedPath(folder.path() / "sub" / ".." / "a.obj"), normalisedPath(file));
  EXPECT_EQ(normalisedPath(folder.path() / "link" / "b.obj"),
            normalisedPath(folder.path() / "sub" / "b.obj"));
  EXPECT_EQ(normalisedPath("a.obj"), std::filesystem::current_path() / "a.obj");
  EXPECT_NO_THROW(normalisedPath(std::string(100'000, 'a')));
}

}  // namespace
}  // namespace nearfit
