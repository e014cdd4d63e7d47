#include <cmath>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "core/proximity/cache/tree_cache.h"
#include "tests/support/cached_meshes.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::cached_shape_test {
namespace {

using Section = TreeCacheSection;

const TreeCacheKey kKey{std::string(64, 'a'), 1.0};

/// A box with a surface of each kind, which it has not in truth, in a cache file.
class CachedShapes : public testing::Test {
 protected:
  CachedShapes() {
    SurfaceFaces surfaces;
    for (int kind = 0; kind < 6; ++kind) {
      ExactSurface surface;
      surface.kind = static_cast<SurfaceKind>(kind);
      surface.point = {0.1 * kind, -1e-17, 3.0};
      surface.direction = {0.6, 0.0, 0.8};
      surface.radius = 0.01 + kind;
      surface.minorRadius = 0.001;
      surface.halfAngle = 0.3;
      surface.isHollow = kind % 2 == 1;
      surfaces.faces.push_back(surface);
    }
    for (std::uint32_t i = 0; i < 12; ++i)
      surfaces.faceOfTriangle.push_back(i / 2);
    mesh_.shape.emplace();
    mesh_.shape->surfaces = std::make_shared<const SurfaceFaces>(surfaces);
    mesh_.shape->faceColours.resize(6);
    mesh_.shape->faceColours[2] = std::array<float, 3>{0.1F, 0.2F, 1.0F};
    mesh_.shape->chord = 1e-4;
    mesh_.shape->angle = 0.3;
    mesh_.shape->exactVolume = 0.123;
    mesh_.shape->isExact = true;
    mesh_.shape->statedUnit = 0.0254;
    write();
  }

  void write() const { writeTreeCacheFile(file_, kKey, mesh_, nullptr, kDefaultTreeCacheBytes); }
  std::optional<CachedMesh> read() const {
    const std::optional<TreeCacheFile> file = TreeCacheFile::open(file_, kKey);
    return file ? file->mesh() : std::nullopt;
  }
  /// True if the file is taken after this was done to it, its checksums made right.
  bool isTakenAfter(const std::function<void(test::CacheImage&)>& damage) const {
    test::CacheImage image(file_);
    const std::string before = image.bytes;
    damage(image);
    image.seal();
    folder_.write("shape", image.bytes);
    const bool isTaken = read().has_value();
    folder_.write("shape", before);
    return isTaken;
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "shape";
  CachedMesh mesh_ = test::cachedMeshOf(test::boxMesh({1, 2, 3}));
};

TEST_F(CachedShapes, WhatComesOutIsWhatWentIn) {
  const std::optional<CachedMesh> cached = read();
  ASSERT_TRUE(cached && cached->shape);
  EXPECT_TRUE(test::areSame(*cached, mesh_));
  const CachedShape &a = *cached->shape, &b = *mesh_.shape;
  EXPECT_EQ(a.chord, b.chord);
  EXPECT_EQ(a.angle, b.angle);
  EXPECT_EQ(a.exactVolume, b.exactVolume);
  EXPECT_EQ(a.isExact, b.isExact);
  EXPECT_EQ(a.statedUnit, b.statedUnit);
  EXPECT_EQ(a.faceColours, b.faceColours);
  EXPECT_EQ(a.surfaces->faceOfTriangle, b.surfaces->faceOfTriangle);
  ASSERT_EQ(a.surfaces->faces.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_EQ(a.surfaces->faces[i], b.surfaces->faces[i]) << i;
}

TEST_F(CachedShapes, ShapeWithoutFacesAndMeshFileAreToldApart) {
  mesh_.shape->surfaces = nullptr;
  mesh_.shape->faceColours.clear();
  write();
  ASSERT_TRUE(read() && read()->shape);
  EXPECT_EQ(read()->shape->surfaces, nullptr);
  mesh_.shape.reset();
  write();
  ASSERT_TRUE(read());
  EXPECT_FALSE(read()->shape);
}

TEST_F(CachedShapes, NumbersThatAreNoneAreFoundWhateverTheChecksumsSay) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(isTakenAfter([](test::CacheImage&) {}));
  for (std::size_t number = 0; number < 3; ++number) {
    EXPECT_FALSE(isTakenAfter([&](auto& image) { image.set(Section::ShapeFacts, 8 * number, nan); }))
        << number;
    EXPECT_FALSE(isTakenAfter([&](auto& image) { image.set(Section::ShapeFacts, 8 * number, -1.0); }))
        << number;
  }
  EXPECT_FALSE(isTakenAfter([](auto& image) { image.set(Section::ShapeFacts, 24, std::uint64_t{2}); }));
  for (const double unit : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_FALSE(isTakenAfter([unit](auto& image) { image.set(Section::ShapeFacts, 32, unit); })) << unit;
  for (std::size_t number = 0; number < 9; ++number)
    EXPECT_FALSE(isTakenAfter([&](auto& image) { image.set(Section::ShapeFaces, 80 + 8 * number, nan); }))
        << number;
  EXPECT_FALSE(isTakenAfter([](auto& image) { image.set(Section::ShapeFaces, 72, std::uint32_t{6}); }));
  EXPECT_FALSE(isTakenAfter([](auto& image) { image.set(Section::ShapeFaces, 76, std::uint32_t{2}); }));
  EXPECT_FALSE(isTakenAfter([](auto& image) { image.set(Section::FaceColours, 0, 1.5F); }));
  EXPECT_FALSE(isTakenAfter([](auto& image) { image.set(Section::FaceColours, 12, std::uint32_t{2}); }));
  EXPECT_FALSE(isTakenAfter([](auto& image) { image.set(Section::FaceOfTriangle, 20, std::uint32_t{6}); }));
}

TEST(CachedText, ComesBackAsItWasAndDamagedNotAtAll) {
  const test::TemporaryFolder folder;
  TreeCacheSettings settings;
  settings.folder = folder.path() / "cache";
  const TreeCache cache(settings);
  const std::string text = "a tree\nof names";
  EXPECT_FALSE(cache.findText(kKey));
  EXPECT_TRUE(cache.storeText(kKey, text));
  EXPECT_EQ(cache.findText(kKey), text);
  EXPECT_FALSE(cache.findText({kKey.sha256, 0.001}));
  EXPECT_EQ(cache.usage().files, 0U) << "it is no mesh";
  EXPECT_GT(cache.usage().bytes, text.size());
  const auto file = std::filesystem::directory_iterator(settings.folder)->path();
  const std::string bytes = test::readBytes(file);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x01);
    folder.write("cache" / file.filename(), damaged);
    EXPECT_FALSE(cache.findText(kKey)) << i;
    folder.write("cache" / file.filename(), bytes.substr(0, i));
    EXPECT_FALSE(cache.findText(kKey)) << i;
  }
  cache.clear();
  EXPECT_TRUE(std::filesystem::is_empty(settings.folder));
  EXPECT_FALSE(cache.storeText(kKey, std::string(kMaxCachedTextBytes + 1, 'x')));
}

}  // namespace
}  // namespace nearfit::cached_shape_test
