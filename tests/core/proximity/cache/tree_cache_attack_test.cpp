// What others, or the user by mistake, can do to a cache while programs use it: each attack ended a program,
// wrote where it should not, or was believed.
#include <chrono>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/base/error.h"
#include "core/proximity/cache/tree_cache.h"
#include "tests/support/cached_meshes.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/scoped_variable.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/unprivileged.h"

namespace nearfit::tree_cache_attack_test {
namespace {

namespace fs = std::filesystem;

constexpr fs::perms kOthers = fs::perms::group_all | fs::perms::others_all;
const TreeCacheKey kKey{std::string(64, 'a'), 0.001};

TreeCache cacheIn(const fs::path& folder) {
  return TreeCache({folder, std::uint64_t{1} << 40, 0});
}

/// A mesh with its hierarchy in a cache.
class TreeCacheAttack : public testing::Test {
 protected:
  TreeCacheAttack() {
    EXPECT_TRUE(cache_.store(kKey, mesh_, &tree_));
    entry_ = test::onlyFileIn(folder_.path());
  }

  /// Larger than what one checksum covers, so that several threads read it; made once for all tests.
  static const CachedMesh& sharedMesh() {
    static const CachedMesh mesh = test::cachedMeshOf(test::icosphereMesh(1.0, 6));
    return mesh;
  }
  static const CachedTree& sharedTree() {
    static const CachedTree tree{NormalConeTree(sharedMesh().mesh), true};
    return tree;
  }

  bool isTaken() const {
    const auto file = cache_.find(kKey);
    return file && file->mesh();
  }

  test::TemporaryFolder folder_;
  const CachedMesh& mesh_ = sharedMesh();
  const CachedTree& tree_ = sharedTree();
  TreeCache cache_ = cacheIn(folder_.path());
  fs::path entry_;
};

// Mapped in place, it ended the program by SIGBUS.
TEST_F(TreeCacheAttack, FileCutWhileItIsUsedChangesNothing) {
  const auto file = cache_.find(kKey);
  ASSERT_TRUE(file);
  const auto mesh = file->mesh();
  ASSERT_TRUE(mesh);
  const auto tree = file->tree(mesh->mesh);
  ASSERT_TRUE(tree);
  fs::resize_file(entry_, 0);
  EXPECT_TRUE(test::areSame(*mesh, mesh_));
  EXPECT_TRUE(test::areSame(tree->tree, tree_.tree));
}

TEST_F(TreeCacheAttack, FileCutBetweenOpeningAndReadingIsNotTaken) {
  const auto size = fs::file_size(entry_);
  const auto file = cache_.find(kKey);
  const auto mesh = file->mesh();
  ASSERT_TRUE(mesh);
  fs::resize_file(entry_, size - 1);
  EXPECT_TRUE(file->mesh()) << "the hierarchy is cut, not the mesh";
  EXPECT_FALSE(file->tree(mesh->mesh));
  fs::resize_file(entry_, sizeof(TreeCacheHeader));
  EXPECT_FALSE(file->mesh());
  fs::resize_file(entry_, 0);
  EXPECT_FALSE(file->mesh());
  EXPECT_FALSE(cache_.find(kKey));
}

TEST_F(TreeCacheAttack, FileWrittenOverWhileItIsUsedIsAsItWasReadOrNotTaken) {
  const auto file = cache_.find(kKey);
  const auto mesh = file->mesh();
  ASSERT_TRUE(mesh);
  const std::string garbage(fs::file_size(entry_), '\xEE');
  std::fstream(entry_, std::ios::binary | std::ios::in | std::ios::out) << garbage;
  EXPECT_TRUE(test::areSame(*mesh, mesh_));
  EXPECT_FALSE(file->tree(mesh->mesh));
  EXPECT_FALSE(file->mesh());
}

// Whoever could plant a link there had its target replaced.
TEST_F(TreeCacheAttack, LinkInTheCacheIsNeitherReadNorWrittenThroughNorTouched) {
  const test::TemporaryFolder elsewhere;
  const fs::path precious = elsewhere.write("precious", test::readBytes(entry_));
  fs::last_write_time(precious, fs::file_time_type::clock::now() - std::chrono::hours(5));
  const fs::file_time_type old = fs::last_write_time(precious);
  const std::string before = test::readBytes(precious);
  fs::remove(entry_);
  fs::create_symlink(precious, entry_);
  EXPECT_FALSE(cache_.find(kKey)) << "what it names would be right";
  EXPECT_TRUE(fs::last_write_time(precious) == old);
  EXPECT_EQ(cache_.usage().files, 0U);
  EXPECT_TRUE(cache_.store(kKey, mesh_, nullptr));
  EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(entry_)));
  EXPECT_TRUE(isTaken());
  EXPECT_EQ(test::readBytes(precious), before);
  EXPECT_TRUE(fs::last_write_time(precious) == old);
}

TEST_F(TreeCacheAttack, PipeInTheCacheIsNeitherWaitedForNorReplaced) {
  fs::remove(entry_);
  ASSERT_EQ(::mkfifo(entry_.c_str(), 0600), 0);
  EXPECT_FALSE(cache_.find(kKey));
  EXPECT_FALSE(cache_.store(kKey, mesh_, nullptr));
  EXPECT_TRUE(fs::is_fifo(entry_));
}

// Meshes that only their owner may read were kept for all to read.
TEST_F(TreeCacheAttack, FolderAndFilesAreTheUsersAlone) {
  EXPECT_EQ(fs::status(entry_).permissions() & kOthers, fs::perms::none);
  const fs::path fresh = folder_.path() / "some" / "cache";
  EXPECT_TRUE(cacheIn(fresh).store(kKey, mesh_, nullptr));
  EXPECT_EQ(fs::status(fresh).permissions(), fs::perms::owner_all);
  EXPECT_EQ(fs::status(test::onlyFileIn(fresh)).permissions() & kOthers, fs::perms::none);
  // What an earlier version made is closed where nobody named it, and so nobody else uses it.
  const test::ScopedVariable home("XDG_CACHE_HOME", folder_.path().string());
  const test::ScopedVariable unnamed("NEARFIT_CACHE", std::nullopt);
  const fs::path usual = folder_.path() / "nearfit";
  fs::create_directory(usual);
  ASSERT_EQ(::chmod(usual.c_str(), 0755), 0);
  TreeCacheSettings settings = treeCacheSettings();
  settings.leastTriangles = 0;
  EXPECT_TRUE(TreeCache(settings).store(kKey, mesh_, nullptr));
  EXPECT_EQ(fs::status(usual).permissions(), fs::perms::owner_all);
  ASSERT_EQ(::chmod(fresh.c_str(), 0755), 0);
  EXPECT_TRUE(cacheIn(fresh).store(kKey, mesh_, nullptr));
  EXPECT_EQ(fs::status(fresh).permissions() & kOthers,
            fs::perms::group_read | fs::perms::group_exec | fs::perms::others_read | fs::perms::others_exec)
      << "one that a user named stays as the user has it";
}

// A forged entry with right checksums changed a clearance without a word.
TEST_F(TreeCacheAttack, EntryThatOthersCouldHaveWrittenIsNotTakenAndIsReplaced) {
  ASSERT_TRUE(isTaken());
  ASSERT_EQ(::chmod(entry_.c_str(), 0666), 0);
  EXPECT_FALSE(cache_.find(kKey));
  EXPECT_TRUE(cache_.store(kKey, mesh_, nullptr));
  EXPECT_TRUE(isTaken());
  if (::chown(entry_.c_str(), 12345, static_cast<::gid_t>(-1)) != 0) return;  // Not an administrator.
  EXPECT_FALSE(cache_.find(kKey));
  EXPECT_TRUE(cache_.store(kKey, mesh_, nullptr));
  EXPECT_TRUE(isTaken());
}

TEST_F(TreeCacheAttack, FolderThatOthersCanWriteToIsNotUsedAndTheReasonIsTold) {
  const test::ScopedVariable named("NEARFIT_CACHE", folder_.path().string());
  EXPECT_THAT(treeCacheWarnings(), testing::IsEmpty());
  ASSERT_EQ(::chmod(folder_.path().c_str(), 0777), 0);
  EXPECT_FALSE(cache_.find(kKey));
  EXPECT_FALSE(cache_.store(kKey, mesh_, nullptr));
  EXPECT_THAT(cache_.distrust(), testing::HasSubstr("other users can write"));
  const std::vector<std::string> warnings = treeCacheWarnings();
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_THAT(warnings[0], testing::HasSubstr(folder_.path().string() + ": this cache is not used"));
  EXPECT_THAT(warnings[0], testing::HasSubstr("chmod 700"));
  EXPECT_THROW(cache_.usage(), FileError);
  EXPECT_THROW(cache_.clear(), FileError);
  ASSERT_EQ(::chmod(folder_.path().c_str(), 0700), 0);
  EXPECT_TRUE(isTaken());
  if (::chown(folder_.path().c_str(), 12345, static_cast<::gid_t>(-1)) != 0) return;  // Not an administrator.
  EXPECT_FALSE(cache_.find(kKey));
  EXPECT_FALSE(cache_.store(kKey, mesh_, nullptr));
}

// It was said to hold nothing.
TEST_F(TreeCacheAttack, FolderThatCannotBeReadIsAnError) {
  EXPECT_EQ(cacheIn(folder_.path() / "none").usage().files, 0U);
  EXPECT_THROW(cacheIn(entry_).usage(), FileError) << "a file is no folder";
  fs::create_symlink("loop", folder_.path() / "loop");
  EXPECT_THROW(cacheIn(folder_.path() / "loop").usage(), FileError);
  ASSERT_EQ(::chmod(folder_.path().c_str(), 0), 0);
  // An administrator may read everything, and so gives the folder away.
  const bool isRoot = ::geteuid() == 0;
  if (isRoot && ::chown(folder_.path().c_str(), test::Unprivileged::kNobody, static_cast<::gid_t>(-1)) != 0)
    return;
  {
    const test::Unprivileged user;
    if (user.isTaken()) {
      EXPECT_EQ(cache_.distrust(), "");
      EXPECT_THROW(cache_.usage(), FileError);
      EXPECT_THROW(cache_.clear(), FileError);
    }
  }
  ASSERT_EQ(::chmod(folder_.path().c_str(), 0700), 0);
}

}  // namespace
}  // namespace nearfit::tree_cache_attack_test
