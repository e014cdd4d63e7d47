#include "core/proximity/cache/tree_cache.h"

#include <atomic>
#include <chrono>
#include <limits>
#include <random>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/cached_meshes.h"
#include "tests/support/ended_process.h"
#include "tests/support/lmd_comparison.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/scoped_variable.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::tree_cache_test {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kNoLimit = std::uint64_t{1} << 40;

TreeCacheKey key(char digit, double metresPerUnit = 0.001) {
  return {std::string(64, digit), metresPerUnit};
}

/// A cache that keeps meshes of any size.
TreeCache cacheIn(const fs::path& folder, std::uint64_t maxBytes = kNoLimit) {
  return TreeCache({folder, maxBytes, 0});
}

void setUsed(const fs::path& file, std::chrono::hours ago) {
  fs::last_write_time(file, fs::file_time_type::clock::now() - ago);
}

TEST(TreeCache, WhatComesOutIsBitForBitWhatWentIn) {
  const test::TemporaryFolder folder;
  const TreeCache cache = cacheIn(folder.path());
  // Closed, open, and large enough for several blocks and chunks of every kind.
  for (const TriangleMesh& mesh : {test::starMesh(1, 1.0, 3, 0.3), test::squareMesh(1.0, 5),
                                   test::icosphereMesh(2.0, 6), test::boxMesh({1, 2, 3})}) {
    const CachedMesh cached = test::cachedMeshOf(mesh);
    // Either answer, whatever the mesh is.
    const CachedTree tree{NormalConeTree(mesh), mesh.triangles().size() % 3 == 0};
    ASSERT_TRUE(cache.store(key('a'), cached, &tree));
    const auto file = cache.find(key('a'));
    ASSERT_TRUE(file && file->hasTree());
    const auto read = file->mesh();
    ASSERT_TRUE(read);
    const auto readTree = file->tree(read->mesh);
    ASSERT_TRUE(readTree);
    EXPECT_TRUE(test::areSame(*read, cached));
    EXPECT_TRUE(test::areSame(readTree->tree, tree.tree));
    EXPECT_EQ(readTree->isSolid, tree.isSolid);
  }
}

TEST(TreeCache, HierarchiesReadFromItGiveTheSameMinimaAlsoWhenTheFileIsGone) {
  const test::TemporaryFolder folder;
  const TreeCache cache = cacheIn(folder.path());
  const test::BodyPair pair{"stars", test::starMesh(1, 1.0, 4, 0.3), test::starMesh(2, 1.0, 4, 0.3)};
  const CachedTree scene{NormalConeTree(pair.scene), true}, part{NormalConeTree(pair.part), true};
  cache.store(key('a'), test::cachedMeshOf(pair.scene), &scene);
  cache.store(key('b'), test::cachedMeshOf(pair.part), &part);
  const auto readScene = cache.find(key('a'))->tree(pair.scene),
             readPart = cache.find(key('b'))->tree(pair.part);
  ASSERT_TRUE(readScene && readPart);
  EXPECT_EQ(cache.clear().files, 2U);
  std::mt19937_64 random(7);
  std::size_t compared = 0;
  for (int i = 0; i < 50; ++i) {
    const RigidTransform pose = test::poseNearContact(pair, 0.1, random);
    const auto expected = test::allLmds(scene.tree, part.tree, pose, 0.1);
    const auto found = test::allLmds(readScene->tree, readPart->tree, pose, 0.1);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_EQ(found[k].scenePoint, expected[k].scenePoint);
      EXPECT_EQ(found[k].partPoint, expected[k].partPoint);
      EXPECT_EQ(found[k].distance, expected[k].distance);
    }
    compared += found.size();
  }
  EXPECT_GT(compared, 50U);
}

TEST(TreeCache, MeshAloneIsKeptUntilItsHierarchyComes) {
  const test::TemporaryFolder folder;
  const TreeCache cache = cacheIn(folder.path());
  const CachedMesh cached = test::cachedMeshOf(test::torusMesh(2, 0.5, 20, 10));
  ASSERT_TRUE(cache.store(key('a'), cached, nullptr));
  const auto meshOnly = cache.find(key('a'));
  ASSERT_TRUE(meshOnly && meshOnly->mesh());
  EXPECT_FALSE(meshOnly->hasTree());
  EXPECT_FALSE(meshOnly->tree(cached.mesh));
  const CachedTree tree{NormalConeTree(cached.mesh), true};
  ASSERT_TRUE(cache.store(key('a'), *meshOnly->mesh(), &tree));
  EXPECT_EQ(cache.usage().files, 1U);
  ASSERT_TRUE(cache.find(key('a'))->tree(cached.mesh));
  EXPECT_TRUE(test::areSame(*cache.find(key('a'))->mesh(), cached));
}

TEST(TreeCache, OtherContentAndOtherUnitAreNotFound) {
  const test::TemporaryFolder folder;
  const TreeCache cache = cacheIn(folder.path());
  cache.store(key('a'), test::cachedMeshOf(test::boxMesh({1, 1, 1})), nullptr);
  EXPECT_TRUE(cache.find(key('a')));
  EXPECT_FALSE(cache.find(key('b')));
  EXPECT_FALSE(cache.find(key('a', 1.0)));
  EXPECT_FALSE(cache.find({"", 1.0}));
  // A file under another's name is not taken for it.
  const fs::path kept = test::onlyFileIn(folder.path());
  cache.store(key('b'), test::cachedMeshOf(test::boxMesh({2, 2, 2})), nullptr);
  for (const auto& entry : fs::directory_iterator(folder.path())) {
    if (entry.path() != kept) fs::copy_file(kept, entry.path(), fs::copy_options::overwrite_existing);
  }
  EXPECT_FALSE(cache.find(key('b')));
}

TEST(TreeCache, SmallMeshesAreNotKept) {
  const test::TemporaryFolder folder;
  const TreeCache cache({folder.path(), kNoLimit, 100});
  EXPECT_FALSE(cache.store(key('a'), test::cachedMeshOf(test::squareMesh(1.0, 7)), nullptr));  // 98 faces
  EXPECT_TRUE(cache.store(key('a'), test::cachedMeshOf(test::squareMesh(1.0, 8)), nullptr));   // 128 faces
}

TEST(TreeCache, WhatWasNotUsedForLongestGoesFirst) {
  const test::TemporaryFolder folder;
  const CachedMesh mesh = test::cachedMeshOf(test::icosphereMesh(1.0, 3));
  const TreeCache unlimited = cacheIn(folder.path());
  unlimited.store(key('a'), mesh, nullptr);
  const fs::path a = test::onlyFileIn(folder.path());
  const std::uint64_t each = fs::file_size(a);
  unlimited.store(key('b'), mesh, nullptr);
  for (const auto& entry : fs::directory_iterator(folder.path()))
    setUsed(entry.path(), std::chrono::hours(entry.path() == a ? 5 : 4));
  // Using it makes it the younger of the two.
  EXPECT_TRUE(unlimited.find(key('a')));
  const TreeCache limited = cacheIn(folder.path(), 2 * each + each / 2);
  EXPECT_TRUE(limited.store(key('c'), mesh, nullptr));
  EXPECT_EQ(limited.usage().files, 2U);
  EXPECT_EQ(limited.usage().bytes, 2 * each);
  EXPECT_TRUE(limited.find(key('a')));
  EXPECT_FALSE(limited.find(key('b')));
  EXPECT_TRUE(limited.find(key('c')));
  // What is larger than all that is allowed pushes nothing out.
  EXPECT_FALSE(cacheIn(folder.path(), each - 1).store(key('d'), mesh, nullptr));
  EXPECT_EQ(limited.usage().files, 2U);
}

TEST(TreeCache, FolderIsLookedThroughOnlyWhereWhatWasWrittenMayNotFit) {
  const test::TemporaryFolder folder;
  const CachedMesh mesh = test::cachedMeshOf(test::icosphereMesh(1.0, 1));
  ASSERT_TRUE(cacheIn(folder.path()).store(key('A'), mesh, nullptr));
  const std::uint64_t each = fs::file_size(test::onlyFileIn(folder.path()));
  constexpr std::size_t kFiles = 40;
  const TreeCache cache = cacheIn(folder.path(), kFiles * each);
  ASSERT_TRUE(cache.store(key('A'), mesh, nullptr));
  // Another process fills the folder.
  const fs::path other =
      folder.write(std::string(64, 'f') + ".nearfit-tree", std::string(kFiles * each, 'x'));
  setUsed(other, std::chrono::hours(5));
  ASSERT_TRUE(cache.store(key('B'), mesh, nullptr));
  EXPECT_TRUE(fs::exists(other));
  for (std::size_t i = 2; i < 12; ++i)
    ASSERT_TRUE(cache.store(key(static_cast<char>('A' + i)), mesh, nullptr));
  EXPECT_FALSE(fs::exists(other));
  EXPECT_EQ(cache.usage().files, 12U);
  // By itself, it never exceeds its size.
  const TreeCache small = cacheIn(folder.path(), 9 * each);
  for (std::size_t i = 0; i < 24; ++i) {
    ASSERT_TRUE(small.store(key(static_cast<char>('A' + i)), mesh, nullptr));
    EXPECT_LE(small.usage().bytes, 9 * each) << i;
  }
}

TEST(TreeCache, WhatIsNotItsOwnIsNeitherCountedNorRemoved) {
  const test::TemporaryFolder folder;
  folder.write("letter.txt", "dear");
  folder.write("short.nearfit-tree", "dear");
  fs::create_directory(folder.path() / (std::string(64, 'a') + ".nearfit-tree"));
  const std::string killed = ".nearfit-" + std::to_string(test::endedProcess());
  folder.write(killed + "-2", "being written");
  const auto leave = [&] { setUsed(folder.write(killed + "-1", "given up"), std::chrono::hours(2)); };
  leave();
  const TreeCache cache = cacheIn(folder.path(), 100'000);
  cache.store(key('a'), test::cachedMeshOf(test::boxMesh({1, 1, 1})), nullptr);
  EXPECT_FALSE(fs::exists(folder.path() / (killed + "-1")));
  leave();
  EXPECT_EQ(cache.usage().files, 1U);
  EXPECT_EQ(cache.clear().files, 1U);
  EXPECT_EQ(cache.usage().files, 0U);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 4);
}

TEST(TreeCache, FolderThatCannotBeWrittenCostsNothingButTheSpeed) {
  const test::TemporaryFolder folder;
  const CachedMesh mesh = test::cachedMeshOf(test::boxMesh({1, 1, 1}));
  for (const fs::path& place : {fs::path("/proc/nearfit"), folder.write("file", "") / "below"}) {
    const TreeCache cache = cacheIn(place);
    EXPECT_FALSE(cache.store(key('a'), mesh, nullptr)) << place;
    EXPECT_FALSE(cache.find(key('a'))) << place;
    EXPECT_EQ(cache.usage().files, 0U) << place;
  }
  const TreeCache off(TreeCacheSettings{});
  EXPECT_FALSE(off.isOn());
  EXPECT_FALSE(off.store(key('a'), mesh, nullptr));
  EXPECT_FALSE(off.find(key('a')));
}

TEST(TreeCache, ThreadsThatWriteReadAndRemoveAtOnceSeeWholeMeshesOnly) {
  const test::TemporaryFolder folder;
  std::vector<CachedMesh> meshes;
  std::vector<CachedTree> trees;
  for (std::uint64_t i = 0; i < 3; ++i) {
    meshes.push_back(test::cachedMeshOf(test::starMesh(i, 1.0, 2, 0.2)));
    trees.push_back({NormalConeTree(meshes.back().mesh), true});
  }
  std::atomic<int> found{0}, wrong{0};
  const auto work = [&](unsigned seed) {
    const TreeCache cache = cacheIn(folder.path());
    std::minstd_rand random(seed);
    for (int i = 0; i < 60; ++i) {
      const std::size_t which = random() % 3;
      const TreeCacheKey name = key(static_cast<char>('a' + which));
      if (i % 20 == 19) cache.clear();
      if (i % 2 == 0) cache.store(name, meshes[which], &trees[which]);
      const auto file = cache.find(name);
      if (!file) continue;
      const auto mesh = file->mesh();
      const auto tree = mesh ? file->tree(mesh->mesh) : std::nullopt;
      ++found;
      if (!mesh || !tree || !test::areSame(*mesh, meshes[which]) ||
          !test::areSame(tree->tree, trees[which].tree))
        ++wrong;
    }
  };
  std::vector<std::thread> threads;
  for (unsigned seed = 1; seed <= 4; ++seed)
    threads.emplace_back(work, seed);
  for (std::thread& thread : threads)
    thread.join();
  EXPECT_GT(found, 60);
  EXPECT_EQ(wrong, 0);
}

TEST(TreeCacheSettings, SizesHaveUnits) {
  EXPECT_EQ(parseByteSize("0"), 0U);
  EXPECT_EQ(parseByteSize("1234"), 1234U);
  EXPECT_EQ(parseByteSize("3K"), 3072U);
  EXPECT_EQ(parseByteSize("2G"), 2147483648U);
  EXPECT_EQ(parseByteSize("16777215T"), 16777215ULL << 40);
  EXPECT_EQ(parseByteSize("1.5G"), 1610612736U);
  EXPECT_EQ(parseByteSize("4GB"), 4294967296U);
  EXPECT_EQ(parseByteSize("0.25MB"), 262144U);
  EXPECT_EQ(parseByteSize("12B"), 12U);
  EXPECT_EQ(parseByteSize("0.0001K"), 0U);
  EXPECT_EQ(parseByteSize("1.99999999999999999999K"), 2047U) << "never rounded up";
  EXPECT_EQ(parseByteSize("18446744073709551615"), std::numeric_limits<std::uint64_t>::max());
  for (const char* text : {"", "K", "-1", "2g", " 2", "2 G", "99999999T", "18446744073709551616", "1.5",
                           "1.5B", "1.G", ".5G", "1.5.5G", "1.5e3G", "1,5G", "4GBB", "4BG", "4GiB", "G4"})
    EXPECT_FALSE(parseByteSize(text)) << text;
}

TEST(TreeCacheSettings, FolderIsWhereXdgSaysUnlessNamedOrOff) {
  const test::ScopedVariable home("HOME", "/home/someone"), unnamed("NEARFIT_CACHE", std::nullopt);
  {
    const test::ScopedVariable xdg("XDG_CACHE_HOME", "/caches");
    EXPECT_EQ(treeCacheSettings().folder, "/caches/nearfit");
  }
  const test::ScopedVariable noXdg("XDG_CACHE_HOME", std::nullopt);
  EXPECT_EQ(treeCacheSettings().folder, "/home/someone/.cache/nearfit");
  {
    const test::ScopedVariable relative("XDG_CACHE_HOME", "relative");
    EXPECT_EQ(treeCacheSettings().folder, "/home/someone/.cache/nearfit");
  }
  const test::ScopedVariable noHome("HOME", std::nullopt);
  EXPECT_FALSE(TreeCache().isOn());
  const test::ScopedVariable named("NEARFIT_CACHE", "/elsewhere");
  EXPECT_EQ(treeCacheSettings().folder, "/elsewhere");
  const test::ScopedVariable off("NEARFIT_CACHE", "off");
  EXPECT_FALSE(TreeCache().isOn());
}

TEST(TreeCacheSettings, SizeThatMakesNoSenseCountsAsNotSaid) {
  const test::ScopedVariable size("NEARFIT_CACHE_SIZE", "100M");
  EXPECT_EQ(treeCacheSettings().maxBytes, 100U << 20U);
  const test::TemporaryFolder folder;
  const test::ScopedVariable on("NEARFIT_CACHE", folder.path().string());
  EXPECT_THAT(treeCacheWarnings(), testing::IsEmpty());
  const test::ScopedVariable senseless("NEARFIT_CACHE_SIZE", "much");
  EXPECT_EQ(treeCacheSettings().maxBytes, std::uint64_t{4} << 30);
  EXPECT_THAT(treeCacheWarnings(), testing::ElementsAre(testing::HasSubstr("\"much\" is not a size")));
  const test::ScopedVariable off("NEARFIT_CACHE", "off");
  EXPECT_THAT(treeCacheWarnings(), testing::IsEmpty());
}

}  // namespace
}  // namespace nearfit::tree_cache_test
