#include "core/scene/part_geometry.h"

#include <cmath>
#include <fstream>
#include <numbers>
#include <span>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/files/sha256.h"
#include "tests/support/cached_meshes.h"
#include "tests/support/mesh_files.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/support/scoped_variable.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::part_geometry_test {
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

TEST(PartGeometry, HierarchyIsBuiltWhenFirstNeeded) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("ball.obj", test::objText(test::icosphereMesh(1, 3)));
  const PartGeometryPtr geometry = loadPartGeometry(file, 1.0);
  EXPECT_FALSE(geometry->hierarchy->isReady());
  EXPECT_FALSE(areHierarchiesReady(std::span(&geometry, 1)));
  EXPECT_TRUE(test::areSame(geometry->tree(), NormalConeTree(geometry->mesh)));
  EXPECT_TRUE(areHierarchiesReady(std::span(&geometry, 1)));
}

TEST(PartGeometry, ManyAreLoadedAtOnceEachWithItsOwnResult) {
  const test::TemporaryFolder folder;
  const auto ball = folder.write("ball.stl", test::stlBinary(test::icosphereMesh(1, 3)));
  const auto broken = folder.write("broken.off", "OFF\n1 1 0\n");
  double last = 0.0;
  const auto loaded = loadPartGeometries(std::vector<MeshSource>{{ball, 1.0, {}},
                                                                 {broken, 1.0, {}},
                                                                 {ball, 0.001, sha256OfFile(ball)},
                                                                 {ball, 0.001, std::string(64, '0')},
                                                                 {ball, -1.0, {}}},
                                         [&](double fraction) {
                                           EXPECT_GE(fraction, last);
                                           last = fraction;
                                           return true;
                                         });
  ASSERT_EQ(loaded.size(), 5U);
  EXPECT_NEAR(loaded[0].geometry->mesh.bounds().upper.z, 1.0, 1e-6);
  EXPECT_THROW(std::rethrow_exception(loaded[1].problem), FileError);
  EXPECT_NEAR(loaded[2].geometry->mesh.bounds().upper.z, 0.001, 1e-9);
  EXPECT_TRUE(loaded[3].geometry == nullptr && loaded[3].problem == nullptr);
  EXPECT_THROW(std::rethrow_exception(loaded[4].problem), UsageError);
  EXPECT_NEAR(last, 1.0, 1e-9);
  EXPECT_THROW(loadPartGeometries(std::vector<MeshSource>{{ball, 1.0, {}}}, [](double) { return false; }),
               Cancelled);
}

TEST(PartGeometry, HierarchiesOfManyArePreparedWithOneProgress) {
  std::vector<PartGeometryPtr> geometries;
  for (std::uint64_t i = 0; i < 5; ++i)
    geometries.push_back(test::freshGeometryOf(test::starMesh(i, 1.0, static_cast<std::uint32_t>(i), 0.2)));
  // Parts of one file share a geometry.
  geometries.insert(geometries.end(), 100, geometries.back());
  double last = 0.0;
  prepareHierarchies(geometries, [&](double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
    return true;
  });
  EXPECT_EQ(last, 1.0);
  EXPECT_TRUE(areHierarchiesReady(geometries));
  for (const PartGeometryPtr& geometry : std::span(geometries).first(5))
    EXPECT_TRUE(test::areSame(geometry->tree(), NormalConeTree(geometry->mesh)));
}

TEST(PartGeometry, StoppedPreparationLeavesWhatIsMissingForLater) {
  std::vector<PartGeometryPtr> geometries;
  for (std::uint64_t i = 0; i < 4; ++i)
    geometries.push_back(test::freshGeometryOf(test::starMesh(i, 1.0, 4, 0.2)));
  EXPECT_THROW(prepareHierarchies(geometries, [](double fraction) { return fraction < 0.4; }), Cancelled);
  EXPECT_FALSE(areHierarchiesReady(geometries));
  prepareHierarchies(geometries);
  for (const PartGeometryPtr& geometry : geometries)
    EXPECT_TRUE(test::areSame(geometry->tree(), NormalConeTree(geometry->mesh)));
}

/// A ball without its first face.
TriangleMesh openBall(std::uint32_t subdivisions) {
  const TriangleMesh ball = test::icosphereMesh(1.0, subdivisions);
  return {{ball.vertices().begin(), ball.vertices().end()},
          {ball.triangles().begin() + 1, ball.triangles().end()}};
}

TEST(PartGeometry, RepairsMadeLaterGiveWhatLoadingWithThemGives) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("open.obj", test::objText(openBall(2)));
  const PartGeometryPtr open = loadPartGeometry(file, 1.0);
  EXPECT_THAT(open->report.warnings, testing::Contains("3 edges are open (one face only)."));
  const MeshRepairs first{{RepairKind::FillHoles, 1.0}},
      second{{RepairKind::Orient}, {RepairKind::Weld, 1e-9}};
  const GeometryRepair filled = repairGeometry(*open, first);
  ASSERT_NE(filled.geometry, nullptr);
  EXPECT_EQ(filled.geometry->repairs, first);
  EXPECT_TRUE(filled.geometry->mesh.topology().isClosed());
  EXPECT_THAT(filled.geometry->report.warnings, testing::IsEmpty()) << "it is no longer open";
  EXPECT_EQ(filled.geometry->mass.basis, MassBasis::VolumeIntegrals);
  EXPECT_EQ(filled.steps.size(), 1U);
  EXPECT_TRUE(filled.change.after.volume);
  EXPECT_EQ(open->mesh.topology().openEdges, 3U) << "the original stays";
  EXPECT_EQ(repairGeometry(*filled.geometry, second).geometry, nullptr) << "there is nothing left to do";
  MeshSource source{.file = file, .repairs = first};
  const PartGeometryPtr loaded = loadPartGeometries(std::span(&source, 1)).front().geometry;
  ASSERT_NE(loaded, nullptr);
  EXPECT_TRUE(test::areSame(loaded->mesh, filled.geometry->mesh));
  EXPECT_EQ(loaded->sha256, open->sha256) << "that of the file";
}

TEST(PartGeometry, RepairsThatLeaveNothingFailWithTheNameOfTheFile) {
  const test::TemporaryFolder folder;
  MeshSource source{folder.write("ball.obj", test::objText(test::icosphereMesh(1.0, 1))), 1.0, {}};
  source.repairs = {{RepairKind::DropShells, 10.0}};
  const LoadedPart loaded = loadPartGeometries(std::span(&source, 1)).front();
  ASSERT_TRUE(loaded.problem);
  try {
    std::rethrow_exception(loaded.problem);
  } catch (const FileError& error) {
    EXPECT_THAT(error.what(),
                testing::AllOf(testing::HasSubstr("ball.obj"), testing::HasSubstr("leaves no face")));
  }
}

/// A mesh file large enough to be kept, and a cache of its own.
class CachedPartGeometry : public testing::Test {
 protected:
  PartGeometryPtr load() const { return loadPartGeometry(file_, 0.001); }

  test::TemporaryFolder folder_, cache_;
  const test::ScopedVariable variable_{"NEARFIT_CACHE", cache_.path().string()};
  const std::filesystem::path file_ =
      folder_.write("star.stl", test::stlBinary(test::starMesh(4, 1.0, 4, 0.3)));
};

void expectSame(const PartGeometry& a, const PartGeometry& b) {
  EXPECT_EQ(a.file, b.file);
  EXPECT_EQ(a.sha256, b.sha256);
  EXPECT_EQ(a.metresPerUnit, b.metresPerUnit);
  EXPECT_TRUE(test::areSame(CachedMesh{a.mesh, a.report, a.mass}, CachedMesh{b.mesh, b.report, b.mass}));
  EXPECT_TRUE(test::areSame(a.tree(), b.tree()));
}

TEST_F(CachedPartGeometry, SecondLoadReadsNoMeshAndBuildsNoHierarchy) {
  const PartGeometryPtr first = load();
  EXPECT_FALSE(TreeCache().find({first->sha256, 0.001})->hasTree());
  first->tree();
  EXPECT_FALSE(first->hierarchy->origin()->isFromCache);
  EXPECT_TRUE(TreeCache().find({first->sha256, 0.001})->hasTree());
  const PartGeometryPtr second = load();
  EXPECT_FALSE(second->hierarchy->isReady());
  expectSame(*second, *first);
  EXPECT_TRUE(second->hierarchy->origin()->isFromCache);
  EXPECT_EQ(loadPartGeometry(file_, 1.0)->mesh.bounds().upper, 1000.0 * first->mesh.bounds().upper);
}

TEST_F(CachedPartGeometry, RepairedMeshesAreKeptApartFromTheOthers) {
  const auto file = folder_.write("open.stl", test::stlBinary(openBall(4)));
  const MeshSource plain{file}, filled{.file = file, .repairs = {{RepairKind::FillHoles, 1.0}}},
      dropped{.file = file, .repairs = {{RepairKind::FillHoles, 1e-6}}};
  const std::vector<MeshSource> sources{plain, filled, dropped};
  for (int round = 0; round < 2; ++round) {
    const std::vector<LoadedPart> loaded = loadPartGeometries(sources);
    EXPECT_EQ(loaded[0].geometry->mesh.topology().openEdges, 3U) << round;
    EXPECT_EQ(loaded[1].geometry->mesh.topology().openEdges, 0U) << round;
    EXPECT_EQ(loaded[2].geometry->mesh.topology().openEdges, 3U) << round;
    loaded[1].geometry->tree();
  }
  EXPECT_EQ(TreeCache().usage().files, 3U);
}

TEST_F(CachedPartGeometry, HierarchyThatAnotherKeptMeanwhileIsTaken) {
  const PartGeometryPtr early = load(), other = load();
  other->tree();
  early->tree();
  EXPECT_TRUE(early->hierarchy->origin()->isFromCache);
}

TEST_F(CachedPartGeometry, DamagedFileIsMadeAnewWithoutAWord) {
  const PartGeometryPtr expected = load();
  expected->tree();
  const test::CacheImage image(test::onlyFileIn(cache_.path()));
  std::vector<std::size_t> places{8, 12, 100, image.bytes.size() - 100};
  for (std::size_t i = 0; i < kTreeCacheSections; ++i) {
    if (image.layout().bytes[i] > 0)
      places.push_back(image.layout().offsets[i] + image.layout().bytes[i] / 2);
  }
  for (const std::size_t place : places) {
    std::string bytes = image.bytes;
    bytes[place] = static_cast<char>(bytes[place] ^ 0x10);
    cache_.write(test::onlyFileIn(cache_.path()).filename(), bytes);
    expectSame(*load(), *expected);
    EXPECT_EQ(test::readBytes(test::onlyFileIn(cache_.path())), image.bytes) << place;
  }
  for (const std::size_t length : {std::size_t{0}, std::size_t{200}, image.bytes.size() / 2}) {
    cache_.write(test::onlyFileIn(cache_.path()).filename(), image.bytes.substr(0, length));
    expectSame(*load(), *expected);
    EXPECT_EQ(test::readBytes(test::onlyFileIn(cache_.path())), image.bytes) << length;
  }
}

TEST_F(CachedPartGeometry, ChangedMeshFileIsReadAnew) {
  load()->tree();
  folder_.write("star.stl", test::stlBinary(test::icosphereMesh(1.0, 4)));
  EXPECT_NEAR(load()->mass.volume, 4.0 / 3.0 * std::numbers::pi * 1e-9, 1e-11);
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
}  // namespace nearfit::part_geometry_test
