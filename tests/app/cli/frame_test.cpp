#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/places.h"
#include "tests/support/run_process.h"

namespace nearfit::test::frame_test {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;
using ::testing::StartsWith;

const std::vector<std::vector<std::string>> kCommands = {{},
                                                         {"info"},
                                                         {"lmd"},
                                                         {"scene"},
                                                         {"scene", "new"},
                                                         {"scene", "keep"},
                                                         {"place"},
                                                         {"scene", "release"},
                                                         {"scene", "refine"}};

TEST(CliFrame, EveryCommandHasHelp) {
  for (std::vector<std::string> command : kCommands) {
    for (const char* flag : {"--help", "-h"}) {
      command.push_back(flag);
      const ProcessResult result = runCli(command);
      command.pop_back();
      EXPECT_EQ(result.exitCode, 0);
      EXPECT_THAT(result.out, HasSubstr("Usage: nearfit-cli"));
      EXPECT_EQ(result.err, "");
    }
  }
}

TEST(CliFrame, VersionIsTold) {
  const ProcessResult result = runCli({"--version"});
  EXPECT_EQ(result.exitCode, 0);
  EXPECT_THAT(result.out, MatchesRegex("nearfit-cli [0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

TEST(CliFrame, WrongUsageGivesExitCode2AndOneLine) {
  const std::vector<std::vector<std::string>> wrong = {{},
                                                       {"frobnicate"},
                                                       {"--frobnicate"},
                                                       {"info"},
                                                       {"info", "--frobnicate", "a.stl"},
                                                       {"scene"},
                                                       {"scene", "old"},
                                                       {"lmd", "a.stl"},
                                                       {"info", "a.stl", "--unit", "parsec"},
                                                       {"lmd\n\x1B[31m"}};
  for (const std::vector<std::string>& arguments : wrong) {
    const ProcessResult result = runCli(arguments);
    EXPECT_EQ(result.exitCode, 2) << ::testing::PrintToString(arguments);
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(linesOf(result.err).size(), 1U) << result.err;
    EXPECT_THAT(result.err, StartsWith("nearfit-cli: "));
    EXPECT_THAT(result.err, Not(HasSubstr("\x1B")));
  }
}

TEST(CliFrame, UnknownCommandIsNamed) {
  EXPECT_THAT(runCli({"frobnicate"}).err, HasSubstr("\"frobnicate\""));
}

TEST(CliFrame, OutputThatDoesNotArriveIsAnError) {
  ProcessOptions full, closed;
  full.stdoutPath = "/dev/full";
  closed.isStdoutClosed = true;
  for (const ProcessOptions& options : {full, closed}) {
    for (const char* flag : {"--help", "--version"}) {
      const ProcessResult result = runCli({flag}, options);
      EXPECT_EQ(result.exitCode, 1);
      EXPECT_EQ(linesOf(result.err).size(), 1U) << result.err;
      EXPECT_THAT(result.err, StartsWith("nearfit-cli: standard output: it cannot be written: "));
    }
  }
}

TEST(CliFrame, StartsWithoutQtVtkOrOpenCascade) {
  const ProcessResult result = runProcess({"ldd", test::builtPath("nearfit-cli")});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("libstdc++"));
  EXPECT_THAT(result.out, Not(ContainsRegex("lib(Qt|vtk|TK[A-Z]|X11|GL)")));
}

}  // namespace
}  // namespace nearfit::test::frame_test
