#include <cstdint>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/cached_meshes.h"
#include "tests/support/mesh_files.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/run_process.h"
#include "tests/support/scoped_variable.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::test::cache_command_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using Json = nlohmann::json;

/// Two spheres of 5,120 triangles, large enough to be kept, and a cache of their own.
class CacheCommand : public ::testing::Test {
 protected:
  static Json jsonOf(const std::vector<std::string>& arguments) {
    const ProcessResult result = runCli(arguments);
    EXPECT_EQ(result.exitCode, 0) << result.err;
    EXPECT_EQ(result.err, "");
    return Json::parse(result.out);
  }
  /// What is found of the two, without the time that it took.
  Json minima() const {
    Json json = jsonOf({"lmd", "--unit", "m", ball_, bump_, "--cutoff", "0.5", "--pose", "2.3,0,0,1,0,0,0"});
    json.erase("query_us");
    return json;
  }

  TemporaryFolder folder_, cache_;
  ScopedVariable variable_{"NEARFIT_CACHE", (cache_.path() / "new").string()};
  std::string ball_ = folder_.write("ball.stl", stlBinary(icosphereMesh(1, 4))).string();
  std::string bump_ = folder_.write("bump.stl", stlBinary(starMesh(1, 1.0, 4, 0.2))).string();
};

TEST_F(CacheCommand, SaysWhatIsKeptAndRemovesIt) {
  EXPECT_EQ(jsonOf({"cache", "--json"})["holds"]["meshes"], 0);
  EXPECT_EQ(jsonOf({"info", "--unit", "m", "--json", ball_})["hierarchy"]["from"], "building");
  const fs::path kept = onlyFileIn(cache_.path() / "new");
  const Json usage = jsonOf({"cache", "--json"});
  EXPECT_EQ(usage["on"], true);
  EXPECT_EQ(usage["folder"], kept.parent_path().string());
  EXPECT_EQ(usage["holds"]["meshes"], 1);
  EXPECT_EQ(usage["holds"]["bytes"], fs::file_size(kept));
  EXPECT_EQ(usage["limit"], std::uint64_t{4} << 30);
  EXPECT_EQ(jsonOf({"info", "--unit", "m", "--json", ball_})["hierarchy"]["from"], "cache");
  EXPECT_THAT(runCli({"info", "--unit", "m", ball_}).out, HasSubstr("hierarchy   from the cache in "));
  EXPECT_THAT(runCli({"cache"}).out, HasSubstr("1 mesh, "));
  EXPECT_EQ(jsonOf({"cache", "--clear", "--json"})["removed"]["meshes"], 1);
  EXPECT_FALSE(fs::exists(kept));
  EXPECT_EQ(jsonOf({"info", "--unit", "m", "--json", ball_})["hierarchy"]["from"], "building");
}

TEST_F(CacheCommand, MinimaFromTheCacheAreThoseOfBuilding) {
  Json built;
  {
    const ScopedVariable off("NEARFIT_CACHE", "off");
    built = minima();
    EXPECT_EQ(runCli({"cache"}).out, "The cache is off.\n");
  }
  EXPECT_GT(built["lmds"].size(), 0U);
  EXPECT_EQ(minima(), built);
  EXPECT_EQ(jsonOf({"cache", "--json"})["holds"]["meshes"], 2);
  EXPECT_EQ(minima(), built);
}

TEST_F(CacheCommand, ProcessesThatFillItAtOnceDisturbNoOne) {
  const Json expected = minima();
  fs::remove_all(cache_.path() / "new");
  std::vector<Json> found(6);
  std::vector<std::thread> threads;
  for (Json& json : found)
    threads.emplace_back([&] { json = minima(); });
  for (std::thread& thread : threads)
    thread.join();
  for (const Json& json : found)
    EXPECT_EQ(json, expected);
  // Nothing half written is left.
  EXPECT_EQ(jsonOf({"cache", "--json"})["holds"]["meshes"], 2);
  EXPECT_EQ(std::distance(fs::directory_iterator(cache_.path() / "new"), fs::directory_iterator()), 2);
}

TEST_F(CacheCommand, FolderThatCannotBeWrittenIsNoError) {
  const Json expected = minima();
  const ScopedVariable nowhere("NEARFIT_CACHE", "/proc/nearfit");
  EXPECT_EQ(minima(), expected);
  EXPECT_EQ(jsonOf({"cache", "--json"})["holds"]["meshes"], 0);
}

TEST_F(CacheCommand, LimitBoundsItAndOneThatMakesNoSenseIsSaid) {
  runCli({"info", "--unit", "m", ball_});
  const std::uint64_t each = jsonOf({"cache", "--json"})["holds"]["bytes"];
  const ScopedVariable limit("NEARFIT_CACHE_SIZE", std::to_string(each + each / 2));
  minima();
  EXPECT_EQ(jsonOf({"cache", "--json"})["holds"]["meshes"], 1);
  const ScopedVariable senseless("NEARFIT_CACHE_SIZE", "plenty");
  const ProcessResult result = runCli({"cache"});
  EXPECT_EQ(result.exitCode, 2);
  EXPECT_THAT(result.err, HasSubstr("NEARFIT_CACHE_SIZE: \"plenty\" is not a size"));
  const ProcessResult info = runCli({"info", "--unit", "m", ball_});
  EXPECT_EQ(info.exitCode, 0);
  EXPECT_THAT(info.err, HasSubstr("warning: NEARFIT_CACHE_SIZE: \"plenty\" is not a size"));
}

// Both were ignored without a word.
TEST_F(CacheCommand, LimitMayHaveAFractionAndAUnit) {
  const std::vector<std::pair<std::string, std::uint64_t>> sizes{{"1.5G", 1610612736}, {"4GB", 4294967296}};
  for (const auto& [text, bytes] : sizes) {
    const ScopedVariable limit("NEARFIT_CACHE_SIZE", text);
    EXPECT_EQ(jsonOf({"cache", "--json"})["limit"], bytes);
    EXPECT_EQ(runCli({"info", "--unit", "m", ball_}).err, "");
  }
}

// It was said to hold 0 meshes.
TEST_F(CacheCommand, FolderThatCannotBeReadIsAnError) {
  const ScopedVariable file("NEARFIT_CACHE", ball_);
  for (const std::string option : {"", "--json", "--clear"}) {
    std::vector<std::string> arguments{"cache"};
    if (!option.empty()) arguments.push_back(option);
    const ProcessResult result = runCli(arguments);
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, HasSubstr(ball_ + ": the cache cannot be read"));
  }
  EXPECT_EQ(runCli({"info", "--unit", "m", ball_}).exitCode, 0) << "loading does without it";
}

TEST_F(CacheCommand, FolderThatOthersCanWriteToIsNotUsedAndThatIsSaid) {
  const fs::path folder = cache_.path() / "new";
  runCli({"info", "--unit", "m", ball_});
  ASSERT_EQ(fs::status(folder).permissions(), fs::perms::owner_all);
  fs::permissions(folder, fs::perms::all);
  const ProcessResult shown = runCli({"cache"});
  EXPECT_EQ(shown.exitCode, 1);
  EXPECT_THAT(shown.err, HasSubstr(folder.string() + ": this cache is not used"));
  const ProcessResult info = runCli({"info", "--unit", "m", "--json", ball_});
  EXPECT_EQ(info.exitCode, 0);
  EXPECT_EQ(Json::parse(info.out)["hierarchy"]["from"], "building");
  EXPECT_THAT(info.err, HasSubstr("warning: " + folder.string() + ": this cache is not used, since other "));
  EXPECT_EQ(linesOf(info.err).size(), 1U);
}

}  // namespace
}  // namespace nearfit::test::cache_command_test
