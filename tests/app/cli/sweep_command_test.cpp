#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/cli/plate_and_cube.h"

namespace nearfit::test::sweep_command_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Besides the plate and the cube, poses, and stand-ins for interpreters of Python, which are told apart from the real one
/// by what they print.
class SweepCommand : public PlateAndCube {
 protected:
  SweepCommand() { std::ofstream(path("poses.csv")) << "0,0,2,1,0,0,0\n"; }

  std::vector<std::string> arguments(const std::vector<std::string>& others) {
    std::vector<std::string> all{"sweep",    scene_, "--poses", path("poses.csv"), "--threshold", "1 mm",
                                 "--cutoff", "0.1",  "-o",      path("out")};
    all.insert(all.end(), others.begin(), others.end());
    return all;
  }
  /// An executable script of the shell.
  std::string script(const char* name, const std::string& text) {
    const std::string file = path(name);
    std::ofstream(file) << "#!/bin/sh\n" << text;
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
    return file;
  }
  /// Says yes to the question for packages, which is a program without arguments; then prints its arguments behind the
  /// program, a line each, and exits with 3.
  std::string printer() {
    return script("printer",
                  "[ $# = 2 ] && exit 0\n[ \"$1\" = -c ] || exit 4\nshift 2\nprintf '%s\\n' \"$@\"\n"
                  "echo \"safe $PYTHONSAFEPATH\" >&2\nexit 3\n");
  }
  /// A Python package nearfit in a folder, whose sweep prints its arguments behind a word.
  void package(const std::string& folder, const std::string& word) {
    std::filesystem::create_directories(folder + "/nearfit");
    std::ofstream(folder + "/nearfit/__init__.py") << "";
    std::ofstream(folder + "/nearfit/sweep.py")
        << "import sys\nif __name__ == '__main__': print('" << word << "', __spec__.name, sys.argv[-1])\n";
  }
};

TEST_F(SweepCommand, ArgumentsGoToThePackageAsTheyAreAndItsOutputAndExitCodeComeBack) {
  const auto result = runCli(arguments({"--parts", "Cube,$(touch x) `id`", "--part=-a; b", "--workers", "2",
                                        "--tolerance", "A=B=0.5mm", "--draws", "3", "--seed", "7",
                                        "--measures", "overlap", "--quiet", "--python", printer()}));
  EXPECT_EQ(result.exitCode, 3);
  EXPECT_EQ(result.err, "safe 1\n");
  EXPECT_THAT(
      linesOf(result.out),
      ElementsAre("--parts=Cube,$(touch x) `id`", "--poses=" + path("poses.csv"), "--threshold=0.001",
                  "--cutoff=0.1", "--out=" + path("out"), "--draws=3", "--seed=7", "--part=-a; b",
                  "--tolerance=A=B=0.0005", "--measures=overlap", "--workers=2", "--quiet", "--", scene_));
}

TEST_F(SweepCommand, AnOptionThatIsNotGivenIsLeftToThePackage) {
  const auto result = runCli(arguments({"--parts", "Cube", "--python", printer()}));
  for (const char* option : {"--workers", "--scheduler", "--measures", "--quiet", "--tolerance", "--part="})
    EXPECT_THAT(result.out, ::testing::Not(HasSubstr(option)));
}

TEST_F(SweepCommand, AMissingPackageIsToldWithTheRemedy) {
  const auto result = runCli(arguments({"--parts", "Cube", "--python", script("bare", "exit 77\n")}));
  EXPECT_EQ(result.exitCode, 1);
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, HasSubstr("pip install '.[sweep]' in the folder of nearfit's sources"));
  EXPECT_EQ(linesOf(result.err).size(), 1U);
  EXPECT_FALSE(std::filesystem::exists(path("out")));
}

TEST_F(SweepCommand, TheRealInterpreterWithoutItsPackagesIsToldToo) {
  // Isolated and without site packages: it finds Python's own alone.
  const std::string bare = script("isolated", "exec python3 -I -S \"$@\"\n");
  const auto result = runCli(arguments({"--parts", "Cube", "--python", bare}));
  EXPECT_EQ(result.exitCode, 1);
  EXPECT_THAT(result.err, HasSubstr("pip install '.[sweep]' in the folder of nearfit's sources"));
}

TEST_F(SweepCommand, TheWorkingFolderHoldsNoPackages) {
  package(path("here"), "here");
  package(path("installed"), "installed");
  for (const char* name : {"numpy", "pyarrow", "distributed"})
    std::ofstream(path("installed") + "/" + name + ".py") << "";
  // Before Python 3.11 there is no PYTHONSAFEPATH.
  const auto old = [&](const char* name, const std::string& packages) {
    return script(name, "cd '" + path("here") + "' || exit 9\nunset PYTHONSAFEPATH\nexport PYTHONPATH='" +
                            packages + "'\nexec python3 -S \"$@\"\n");
  };
  const auto found = runCli(arguments({"--parts", "Cube", "--python", old("old", path("installed"))}));
  EXPECT_EQ(found.exitCode, 0) << found.err;
  EXPECT_EQ(found.out, "installed nearfit.sweep " + scene_ + "\n");
  std::filesystem::remove_all(path("installed") + "/nearfit");
  const auto missing = runCli(arguments({"--parts", "Cube", "--python", old("bare", path("installed"))}));
  EXPECT_EQ(missing.exitCode, 1);
  EXPECT_THAT(missing.err, HasSubstr("pip install '.[sweep]' in the folder of nearfit's sources"));
}

TEST_F(SweepCommand, AProgramThatIsNoInterpreterIsToldSo) {
  const auto expect = [&](const std::string& python, const char* problem) {
    const auto result = runCli(arguments({"--parts", "Cube", "--python", python}));
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_THAT(result.err, HasSubstr(problem));
    EXPECT_THAT(result.err, HasSubstr("--python"));
  };
  expect(path("none"), "it cannot be started");
  expect(path("poses.csv"), "it cannot be started");
  expect(script("odd", "exit 5\n"), "it does not run a Python program");
  expect(script("killed", "kill -9 $$\n"), "it does not run a Python program");
}

TEST_F(SweepCommand, WrongUsageIsToldBeforePythonStarts) {
  const std::string python = path("none");
  const auto expect = [&](const std::vector<std::string>& options, const char* problem) {
    std::vector<std::string> all = arguments(options);
    all.insert(all.end(), {"--python", python});
    const auto result = runCli(all);
    EXPECT_EQ(result.exitCode, 2) << result.err;
    EXPECT_THAT(result.err, HasSubstr(problem));
  };
  expect({}, "--parts");
  expect({"--parts", "Cube", "--workers", "-1"}, "--workers");
  expect({"--parts", "Cube", "--workers", "two"}, "--workers");
  expect({"--parts", "Cube", "--draws", "0"}, "--draws");
  expect({"--parts", "Cube", "--draws", "2"}, "--tolerance");
  expect({"--parts", "Cube", "--seed", "-1"}, "--seed");
  expect({"--parts", "Cube", "--tolerance", "Cube"}, "--tolerance");
  expect({"--parts", "Cube", "--tolerance", "Cube=1 kg"}, "--tolerance");
  expect({"--parts", "Cube", "--tolerance", "Cube=-1"}, "--tolerance");
  expect({"--parts", "Cube", "--scheduler", "tcp://a:1", "--workers", "1"}, "--scheduler");
  const auto expectLengths = [&](const std::string& threshold, const std::string& cutoff,
                                 const char* problem) {
    const auto result =
        runCli({"sweep", scene_, "--parts", "Cube", "--poses", path("poses.csv"), "--threshold", threshold,
                "--cutoff", cutoff, "-o", path("out"), "--python", python});
    EXPECT_EQ(result.exitCode, 2) << result.err;
    EXPECT_THAT(result.err, HasSubstr(problem));
  };
  expectLengths("-1", "1", "--threshold");
  expectLengths("1 kg", "1", "--threshold");
  expectLengths("0", "0", "--cutoff");
  expectLengths("0", "nan", "--cutoff");
  expectLengths("2", "1", "--threshold");
  EXPECT_EQ(runCli({"sweep", scene_}).exitCode, 2);
}

}  // namespace
}  // namespace nearfit::test::sweep_command_test
