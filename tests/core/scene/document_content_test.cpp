#include "core/scene/document_content.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "core/base/error.h"
#include "core/files/sha256.h"
#include "core/import/companion_files.h"
#include "tests/support/scoped_variable.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/trial_share.h"

namespace nearfit::document_content_test {
namespace {

namespace fs = std::filesystem;

/// A robot in a package, with a mesh, beside a file of somebody else; and a cache of its own.
class ContentOfADocument : public testing::Test {
 protected:
  ContentOfADocument() {
    fs::create_directories(folder_.path() / "arm" / "urdf");
    fs::create_directories(folder_.path() / "arm" / "meshes");
    folder_.write("arm/package.xml", "<package/>");
  }
  /// Keeps names in the cache without a look at them, as a cache that somebody has changed has them.
  void forge(const fs::path& document, const std::vector<std::string>& names) const {
    CadDocument forged;
    for (const std::string& name : names)
      forged.companions.push_back({name, std::string(64, 'a')});
    storeCompanionNames(document, {sha256OfFile(document), nullptr, "forged"}, forged);
  }
  std::optional<DocumentContent> found(const fs::path& document) const {
    return contentOnDisk(document, sha256OfFile(document), {});
  }

  test::TemporaryFolder folder_, cache_;
  const test::ScopedVariable variable_{"NEARFIT_CACHE", cache_.path().string()};
  const fs::path secret_ = folder_.write("secret.bin", "somebody else's");
  const fs::path gltf_ = folder_.write("arm.gltf", "{}");
};

TEST_F(ContentOfADocument, OfOneFileIsNamedByItsHash) {
  const fs::path step = folder_.write("vise.step", "the vise");
  ASSERT_TRUE(found(step));
  EXPECT_EQ(found(step)->name, sha256OfFile(step));
  EXPECT_FALSE(found(gltf_)) << "its companions are not known";
  forge(gltf_, {});
  ASSERT_TRUE(found(gltf_));
  EXPECT_EQ(found(gltf_)->name, sha256OfFile(gltf_));
}

TEST_F(ContentOfADocument, OfSeveralFilesIsNamedByAllOfThem) {
  folder_.write("first.bin", "1");
  const fs::path second = folder_.write("second.bin", "2");
  forge(gltf_, {"first.bin", "./second.bin"});
  const std::optional<DocumentContent> content = found(gltf_);
  ASSERT_TRUE(content);
  EXPECT_EQ(content->sha256, sha256OfFile(gltf_));
  ASSERT_EQ(content->companions->size(), 2U);
  EXPECT_EQ(content->companions->at(1).sha256, sha256OfFile(second));
  EXPECT_TRUE(fs::equivalent(content->companions->at(1).file, second));
  // The same bytes, in the other file each.
  folder_.write("first.bin", "2");
  folder_.write("second.bin", "1");
  ASSERT_TRUE(found(gltf_));
  EXPECT_NE(found(gltf_)->name, content->name);
  folder_.write("first.bin", "1");
  folder_.write("second.bin", "2");
  EXPECT_EQ(found(gltf_)->name, content->name);
}

TEST_F(ContentOfADocument, NamesOutsideOfTheFolderAreNotFollowed) {
  fs::create_directory(folder_.path() / "inner");
  const fs::path inner = folder_.write("inner/arm.gltf", "{ }");
  fs::create_symlink(secret_, folder_.path() / "inner" / "link.bin");
  folder_.write("inner/own.bin", "its own");
  forge(inner, {"own.bin"});
  EXPECT_TRUE(found(inner));
  for (const std::string& name :
       {std::string("../secret.bin"), std::string("../../../../../../../../etc/passwd"),
        std::string("/etc/passwd"), secret_.string(), std::string("link.bin"), std::string(),
        std::string("own.bin\n"), std::string("own.bin/../../secret.bin")}) {
    forge(inner, {"own.bin", name});
    EXPECT_FALSE(found(inner)) << name;
  }
}

TEST_F(ContentOfADocument, NamesOfAUrdfFileAreFoundAsTheImporterFindsThem) {
  const fs::path urdf = folder_.write("arm/urdf/arm.urdf", "<robot/>");
  const fs::path mesh = folder_.write("arm/meshes/cube.stl", "a cube");
  for (const std::string& name :
       {std::string("../meshes/cube.stl"), std::string("package://arm/meshes/cube.stl"),
        std::string("package://renamed/meshes/cube.stl")}) {
    forge(urdf, {name});
    const std::optional<DocumentContent> content = found(urdf);
    ASSERT_TRUE(content) << name;
    EXPECT_TRUE(fs::equivalent(content->companions->front().file, mesh)) << name;
  }
  for (const std::string& name :
       {std::string("../../secret.bin"), std::string("package://arm/../secret.bin"),
        std::string("package://arm//etc/passwd"), "file://" + secret_.string(), secret_.string()}) {
    forge(urdf, {name});
    EXPECT_FALSE(found(urdf)) << name;
  }
}

TEST_F(ContentOfADocument, PipesFoldersAndMissingFilesAreNoContent) {
  ASSERT_EQ(::mkfifo((folder_.path() / "pipe.bin").c_str(), 0600), 0);
  fs::create_directory(folder_.path() / "folder.bin");
  for (const char* name : {"pipe.bin", "folder.bin", "missing.bin"}) {
    forge(gltf_, {name});
    EXPECT_FALSE(found(gltf_)) << name;
  }
}

TEST_F(ContentOfADocument, AListOfTooManyNamesIsNotRead) {
  folder_.write("a", "1");
  std::vector<std::string> names(kMaxCompanions, "a");
  forge(gltf_, names);
  EXPECT_TRUE(found(gltf_)) << "as many as there may be";
  names.emplace_back("a");
  forge(gltf_, names);
  EXPECT_FALSE(found(gltf_));
  names.resize(1'000'000 / test::kTrialShare, "a");
  forge(gltf_, names);
  EXPECT_FALSE(found(gltf_));
}

TEST_F(ContentOfADocument, HashingCanBeStopped) {
  folder_.write("a.bin", std::string(100, 'a'));
  forge(gltf_, {"a.bin"});
  EXPECT_THROW(contentOnDisk(gltf_, sha256OfFile(gltf_), [](double) { throw Cancelled(); }), Cancelled);
}

}  // namespace
}  // namespace nearfit::document_content_test
