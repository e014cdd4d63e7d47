// Ways in which an importer fails, by shell scripts that stand in for it.
#include "core/import/import_process.h"

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/base/error.h"
#include "core/import/document_file.h"
#include "core/import/document_import.h"
#include "tests/support/eventually.h"
#include "tests/support/scoped_variable.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::import_process_test {
namespace {

namespace fs = std::filesystem;
using test::ScopedVariable;
using testing::HasSubstr;

class ImportProcess : public testing::Test {
 protected:
  /// A program that runs these lines of shell.
  fs::path script(const std::string& lines) const {
    const fs::path file = folder_.write("importer", "#!/bin/sh\n" + lines + "\n");
    fs::permissions(file, fs::perms::owner_all);
    return file;
  }
  std::vector<std::byte> run(const std::string& lines, const ProgressCallback& progress = {},
                             double silence = 20.0) const {
    return runImporter(script(lines), document_, {"--chord", "0"}, {silence}, progress);
  }
  FileError failure(const std::string& lines, double silence = 20.0) const {
    try {
      run(lines, {}, silence);
    } catch (const FileError& error) {
      EXPECT_FALSE(error.remedy().empty());
      return error;
    }
    ADD_FAILURE() << "did not fail: " << lines;
    return {"", "", ""};
  }

  /// Waits until the process whose number is in a file has ended.
  static void expectEnd(const fs::path& file) {
    ::pid_t child = 0;
    std::ifstream(file) >> child;
    ASSERT_GT(child, 0);
    // It is no child of this process: its end is seen when the system has cleared it away, or left it without a group.
    const auto hasEnded = [&] {
      std::ifstream status("/proc/" + std::to_string(child) + "/stat");
      std::string number, name, state;
      return !(status >> number >> name >> state) || state == "Z";
    };
    EXPECT_TRUE(test::eventually(hasEnded));
  }

  test::TemporaryFolder folder_;
  fs::path document_ = folder_.write("part.step", "ISO-10303-21;");
};

TEST_F(ImportProcess, TheResultIsWhatItWroteToItsThirdDescriptor) {
  const std::vector<std::byte> result = run("printf 'result' >&3");
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(result.data()), result.size()), "result");
}

TEST_F(ImportProcess, ItGetsTheFileAndTheOptionsAndNoOtherDescriptors) {
  run("echo \"$@\" > '" + (folder_.path() / "arguments").string() + "'; ls /proc/self/fd | tr '\\n' ' ' > '" +
      (folder_.path() / "open").string() + "'");
  EXPECT_EQ(test::readBytes(folder_.path() / "arguments"),
            "--result 3 --messages 4 --chord 0 -- " + document_.string() + "\n");
  // Those of the shell, and the folder that ls reads.
  EXPECT_EQ(test::readBytes(folder_.path() / "open"), "0 1 2 3 4 5 ");
}

TEST_F(ImportProcess, ItIsAskedForItsVersionAndThatOfOpenCascade) {
  const auto versionBy = [&](const std::string& lines) {
    const ScopedVariable chosen("NEARFIT_IMPORT", script(lines).string());
    return importerVersion();
  };
  EXPECT_EQ(versionBy("[ \"$*\" = --version ] && printf 'it 9.8\\nOpenCASCADE 7.6.5\\nsandbox: x\\n'"),
            "it 9.8, OpenCASCADE 7.6.5");
  EXPECT_THROW(versionBy("exit 0"), FileError);
  EXPECT_THROW(versionBy("printf 'it 9.8\\nsomething else\\n'"), FileError);
  EXPECT_THROW(versionBy("printf 'it 9.8\\nOpenCASCADE 7.6.5\\n'; exit 1"), FileError);
  EXPECT_THROW(versionBy("kill -SEGV $$"), FileError);
  const ScopedVariable none("NEARFIT_IMPORT", (folder_.path() / "none").string());
  EXPECT_THROW(importerVersion(), FileError);
}

TEST_F(ImportProcess, AnExporterGetsItsRequestAndNoOtherDescriptors) {
  const std::string request(100'000, 'r');
  const std::vector<std::byte> result =
      runExporter(script("cat <&5 >&3; echo \"$@\" > '" + (folder_.path() / "arguments").string() +
                         "'; ls /proc/self/fd | tr '\\n' ' ' > '" + (folder_.path() / "open").string() + "'"),
                  folder_.path() / "out.step", std::as_bytes(std::span(request)), {20.0}, {});
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(result.data()), result.size()), request);
  EXPECT_EQ(test::readBytes(folder_.path() / "arguments"), "\n");
  EXPECT_EQ(test::readBytes(folder_.path() / "open"), "0 1 2 3 4 5 6 ");
}

TEST_F(ImportProcess, WhatAnExporterFailsAtIsCalledAnExport) {
  try {
    runExporter(script("kill -SEGV $$"), folder_.path() / "out.step", {}, {20.0}, {});
    ADD_FAILURE() << "did not fail";
  } catch (const FileError& error) {
    EXPECT_EQ(error.where(), (folder_.path() / "out.step").string());
    EXPECT_THAT(error.problem(), HasSubstr("its export crashed (signal 11)"));
    EXPECT_THAT(error.remedy(), HasSubstr("export fewer parts"));
  }
}

TEST_F(ImportProcess, ProgressIsPassedOnAndNeverFalls) {
  std::vector<double> seen;
  run("for p in 0.25 0.1 nan 7 hello; do printf 'progress\\t%s\\n' $p >&4; sleep 0.1; done",
      [&](double fraction) {
        seen.push_back(fraction);
        return true;
      });
  EXPECT_TRUE(std::ranges::is_sorted(seen));
  EXPECT_THAT(seen, testing::Contains(0.25));
  EXPECT_EQ(seen.back(), 1.0);
}

TEST_F(ImportProcess, ItsOwnAccountOfAFailureIsTold) {
  const FileError error =
      failure("printf 'failure\\tpart.step:7\\tit is round\\tmake it square\\n' >&4; exit 1");
  EXPECT_EQ(error.where(), "part.step:7");
  EXPECT_EQ(error.problem(), "it is round");
  EXPECT_EQ(error.remedy(), "make it square");
}

TEST_F(ImportProcess, WhatItSaysIsShownWithoutControlCharactersAndNotWithoutEnd) {
  const FileError error = failure("printf 'failure\\t\\t\\033[31m%05000d\\tx\\n' 0 >&4; exit 1");
  EXPECT_EQ(error.where(), document_.string());
  EXPECT_THAT(error.problem(), HasSubstr("\\x1b"));
  EXPECT_LT(error.problem().size(), 1100U);
}

TEST_F(ImportProcess, AFailureWithoutAnAccountNamesFileAndCode) {
  const FileError error = failure("exit 7");
  EXPECT_EQ(error.where(), document_.string());
  EXPECT_THAT(error.problem(), HasSubstr("exit code 7"));
}

TEST_F(ImportProcess, ACrashEndsTheImporterAlone) {
  EXPECT_THAT(failure("kill -SEGV $$").problem(), HasSubstr("crashed (signal 11)"));
  EXPECT_THAT(failure("kill -XCPU $$").problem(), HasSubstr("processor time"));
}

TEST_F(ImportProcess, MemoryThatRunsOutIsSaid) {
  EXPECT_THAT(failure("exit 3").problem(), HasSubstr("more memory"));
  EXPECT_THAT(failure("kill -KILL $$").problem(), HasSubstr("memory"));
}

TEST_F(ImportProcess, OneThatHangsIsEnded) {
  EXPECT_THAT(failure("sleep 1000", 0.3).problem(), HasSubstr("no progress"));
}

TEST_F(ImportProcess, OneThatClosesItsPipeAndHangsIsEndedToo) {
  EXPECT_THAT(failure("exec 4>&-; sleep 1000", 0.3).problem(), HasSubstr("no progress"));
}

TEST_F(ImportProcess, OneThatRepeatsItselfMakesNoProgress) {
  EXPECT_THAT(failure("while true; do printf 'progress\\t0.5\\n' >&4; sleep 0.01; done", 0.5).problem(),
              HasSubstr("no progress"));
}

TEST_F(ImportProcess, OneThatWritesWithoutEndIsCancelledAndTakesNoMemory) {
  int calls = 0;
  EXPECT_THROW(run("while true; do printf '%01000d' 0 >&4; done", [&](double) { return ++calls < 50; }),
               Cancelled);
}

TEST_F(ImportProcess, CancelKillsItAndWhatItStarted) {
  const fs::path file = folder_.path() / "child";
  const std::string lines = "sleep 1000 & echo $! > '" + file.string() + "'; wait";
  EXPECT_THROW(run(lines, [&](double) { return !fs::exists(file) || fs::file_size(file) == 0; }), Cancelled);
  expectEnd(file);
}

TEST_F(ImportProcess, WhatItLeavesRunningIsEnded) {
  const fs::path file = folder_.path() / "child";
  run("sleep 1000 & echo $! > '" + file.string() + "'");
  expectEnd(file);
}

TEST_F(ImportProcess, AResultThatIsNoDocumentIsRefused) {
  const fs::path program = script("printf 'anything' >&3");
  const ScopedVariable chosen("NEARFIT_IMPORT", program.string());
  try {
    importDocument(document_, {});
    ADD_FAILURE() << "was read";
  } catch (const FileError& error) {
    EXPECT_EQ(error.where(), document_.string());
    EXPECT_THAT(error.problem(), HasSubstr("damaged"));
  }
}

TEST_F(ImportProcess, AFileThatIsNotThereIsSaidBeforeAnythingIsStarted) {
  const ScopedVariable chosen("NEARFIT_IMPORT", (folder_.path() / "none").string());
  try {
    importDocument(folder_.path() / "absent.step", {});
    ADD_FAILURE() << "was read";
  } catch (const FileError& error) {
    EXPECT_THAT(error.problem(), HasSubstr("no such file"));
  }
}

TEST_F(ImportProcess, AMissingImporterIsSaid) {
  const ScopedVariable chosen("NEARFIT_IMPORT", (folder_.path() / "none").string());
  try {
    importProgram();
    ADD_FAILURE() << "was found";
  } catch (const FileError& error) {
    EXPECT_THAT(error.problem(), HasSubstr("is missing"));
  }
}

TEST_F(ImportProcess, AnImporterThatOthersCanWriteToIsNotStarted) {
  const fs::path program = script("exit 0");
  fs::permissions(program, fs::perms::all);
  const ScopedVariable chosen("NEARFIT_IMPORT", program.string());
  EXPECT_THROW(importProgram(), FileError);
}

TEST_F(ImportProcess, WithoutAChoiceItLiesBesideTheRunningProgram) {
  const ScopedVariable none("NEARFIT_IMPORT", std::nullopt);
  const fs::path folder = fs::read_symlink("/proc/self/exe").parent_path();
  try {
    EXPECT_EQ(importProgram(), folder / "nearfit-import");
  } catch (const FileError& error) {
    // A build of this test alone.
    EXPECT_EQ(error.where(), (folder / "nearfit-import").string());
  }
}

}  // namespace
}  // namespace nearfit::import_process_test
