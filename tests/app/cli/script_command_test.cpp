#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/cli/commands.h"
#include "core/base/error.h"
#include "core/scene/document_load.h"
#include "core/scene/scene_file.h"
#include "tests/app/cli/plate_and_cube.h"
#include "tests/support/documents.h"

namespace nearfit::test::script_command_test {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

class ScriptCommand : public PlateAndCube {
 protected:
  std::string write(const std::string& commands, const char* head = "{\"nearfitScript\": 1}") {
    return folder_.write("session.jsonl", std::string(head) + "\n" + commands).string();
  }
  std::string out_ = path("out.nearfit");
};

TEST_F(ScriptCommand, CommandsLeadToAScene) {
  const std::string script = write(
      R"({"do": "add", "files": [{"mesh": "cube.obj", "metresPerUnit": 0.001}], "parts": [{"name": "Small", "file": 0}]})"
      "\n"
      R"({"do": "opacity", "parts": ["Small"], "opacity": 0.30000000000000004})"
      "\n");
  const auto result = runCli({"script", script, "-o", out_});
  EXPECT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(result.err, "");
  const Scene scene = readSceneFile(out_);
  ASSERT_EQ(scene.parts().size(), 1U);
  EXPECT_EQ(scene.parts()[0]->name, "Small");
  EXPECT_EQ(scene.parts()[0]->opacity, 0.1 + 0.2);
}

TEST_F(ScriptCommand, StartsFromTheSceneThatIsNamed) {
  const std::string script = write(R"({"do": "delete", "parts": ["Plate"]})"
                                   "\n",
                                   R"({"nearfitScript": 1, "scene": "fit.nearfit"})");
  const auto result = runCli({"script", script, "-o", out_});
  EXPECT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(readSceneFile(out_).parts().size(), 1U);
  // The option goes before what the script says.
  const std::string empty = write(R"({"do": "delete", "parts": ["Plate"]})"
                                  "\n");
  EXPECT_EQ(runCli({"script", empty, "-o", out_}).exitCode, 1);
  EXPECT_EQ(runCli({"script", empty, "--scene", scene_, "-o", out_}).exitCode, 0);
}

TEST_F(ScriptCommand, ALineThatFailsIsNamedAndNothingIsWritten) {
  const std::string script = write(R"({"do": "endIsolation"})"
                                   "\n"
                                   R"({"do": "delete", "parts": ["Nobody"]})"
                                   "\n");
  const auto result = runCli({"script", script, "-o", out_});
  EXPECT_EQ(result.exitCode, 1);
  EXPECT_THAT(result.err, HasSubstr("session.jsonl:3: parts[0]: there is no part \"Nobody\""));
  EXPECT_FALSE(fs::exists(out_));
}

TEST_F(ScriptCommand, WrongUseIsRefused) {
  const std::string script = write("");
  EXPECT_EQ(runCli({"script"}).exitCode, 2);
  EXPECT_EQ(runCli({"script", script}).exitCode, 2);
  EXPECT_EQ(runCli({"script", script, "-o", script}).exitCode, 2);
  EXPECT_EQ(runCli({"script", script, "--scene", scene_, "-o", scene_}).exitCode, 2);
  EXPECT_EQ(runCli({"script", path("none.jsonl"), "-o", out_}).exitCode, 1);
  EXPECT_EQ(runCli({"script", script, "-o", folder_.path().string()}).exitCode, 1);
}

/// The command with these arguments, in this process.
void runHere(const std::vector<std::string>& arguments) {
  CLI::App program;
  cli::addScriptCommand(program);
  std::vector<const char*> texts{"nearfit-cli"};
  for (const std::string& each : arguments)
    texts.push_back(each.c_str());
  program.parse(static_cast<int>(texts.size()), texts.data());
}

/// Ctrl+C waited for a whole line, such as a document that loads for minutes, and for the scene to start from.
TEST_F(ScriptCommand, AnInterruptEndsItWhileADocumentLoads) {
  const std::string add =
      R"({"do": "add", "files": [{"mesh": "vise.step", "metresPerUnit": 1, "shape": {"key": "pin", "chord": 0, "angle": 0}}], "parts": [{"name": "Pin", "file": 0}]})"
      "\n";
  folder_.write("vise.step", "a vise");
  {
    const FakeImporter importer;
    runHere({"script", write(add), "-o", path("start.nearfit")});
  }
  ASSERT_TRUE(fs::exists(path("start.nearfit")));
  folder_.write("vise.step", "a vise that was exported again");
  int runs = 0;
  const ScopedDocumentImporter interrupted(
      [&runs](const fs::path&, const DocumentOptions&, const ProgressCallback& progress) -> CadDocument {
        ++runs;
        std::raise(SIGINT);
        if (progress && !progress(0.5)) throw Cancelled();
        throw FileError("vise.step", "it was read to its end", "stop at the interrupt");
      });
  EXPECT_THROW(runHere({"script", write(add), "-o", out_}), Cancelled);
  EXPECT_EQ(runs, 1);
  const std::string fromStart = write("", R"({"nearfitScript": 1, "scene": "start.nearfit"})");
  EXPECT_THROW(runHere({"script", fromStart, "-o", out_}), Cancelled);
  EXPECT_EQ(runs, 2);
  EXPECT_FALSE(fs::exists(out_));
}

TEST_F(ScriptCommand, AMeshThatTheScriptReadsIsNotReplaced) {
  const std::string script = write(
      R"({"do": "add", "files": [{"mesh": "cube.obj", "metresPerUnit": 0.001}], "parts": [{"name": "Small", "file": 0}]})"
      "\n");
  const auto size = fs::file_size(path("cube.obj"));
  EXPECT_EQ(runCli({"script", script, "-o", path("cube.obj")}).exitCode, 2);
  EXPECT_EQ(fs::file_size(path("cube.obj")), size);
}

}  // namespace
}  // namespace nearfit::test::script_command_test
