#include <algorithm>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/scene/scene_file.h"
#include "core/servo/motion_recording.h"
#include "tests/bench/commands.h"
#include "tests/bench/pose_record.h"
#include "tests/support/mesh_files.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::bench::certify_command_test {
namespace {

using testing::HasSubstr;

/// A box of one metre at the origin, one that is hidden beside it, and a small one that moves along x.
class CertifyCommand : public testing::Test {
 protected:
  CertifyCommand() {
    folder.write("box.stl", test::stlBinary(test::boxMesh({1, 1, 1})));
    folder.write("small.stl", test::stlBinary(test::boxMesh({0.25, 0.25, 0.25})));
    Scene scene;
    scene.add(partFrom("box.stl", "Box", 0.0));
    Part hidden = partFrom("box.stl", "Hidden", 3.0);
    hidden.isVisible = false;
    scene.add(hidden);
    scene.add(partFrom("small.stl", "Small", 5.0));
    writeSceneFile(scene, folder.path() / "scene.nearfit");
  }

  Part partFrom(const char* file, const char* name, double x) const {
    Part part;
    part.name = name;
    part.geometry = loadPartGeometry(folder.path() / file, 1.0);
    part.worldFromPart.translation.x = x;
    return part;
  }

  /// The hand goes to the origin in ten steps, the proxy as far as `stop`; nearer than `releasedBefore` the
  /// box is said to be released.
  void record(double stop, double releasedBefore = 0.0) const {
    std::string text = std::string(motionHeader()) + "\n";
    for (int i = 0; i <= 10; ++i) {
      MotionRow row;
      row.handle.translation.x = 5.0 - 0.5 * i;
      row.proxy.translation.x = std::max(row.handle.translation.x, stop);
      row.overlapping = row.proxy.translation.x < releasedBefore ? 1 : 0;
      text += formatMotionRow(row) + "\n";
    }
    folder.write("record.csv", text);
  }

  void run(std::vector<std::string> more = {}) const {
    CLI::App program;
    addCertifyCommand(program);
    std::vector<std::string> arguments{"certify",  (folder.path() / "scene.nearfit").string(),
                                       "--part",   "Small",
                                       "--record", (folder.path() / "record.csv").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    std::ranges::reverse(arguments);
    program.parse(arguments);
  }

  std::string problem(std::vector<std::string> more = {}) const {
    try {
      run(std::move(more));
    } catch (const Error& error) {
      return error.problem();
    }
    return "";
  }

  test::TemporaryFolder folder;
};

TEST_F(CertifyCommand, PosesThatStayClearPassAndHiddenPartsDoNotCount) {
  record(0.626);
  EXPECT_EQ(problem(), "");
}

TEST_F(CertifyCommand, FirstPoseThatMeetsIsNamedByItsLine) {
  // Touches at 0.625, which row 10 (of 5 - 0.5 i, line 11) is the first to reach.
  record(0.625);
  EXPECT_THAT(problem(), HasSubstr("\"Small\" meets \"Box\" in line 11"));
  record(0.626);
  EXPECT_THAT(problem({"--pose", "handle"}), HasSubstr("in line 11"));
}

TEST_F(CertifyCommand, EveryLooksAtEachSoManyth) {
  record(0.0);
  EXPECT_THAT(problem({"--every", "5"}), HasSubstr("in line 12"));
}

TEST_F(CertifyCommand, RowsInWhichTheBoxWasReleasedAreLeftOutOrLookedAtAlone) {
  // The rows at 0.5 and 0, in lines 11 and 12, meet the box: both are said to be released, and then the last
  // alone.
  record(0.0, 0.6);
  EXPECT_EQ(problem({"--rows", "felt"}), "");
  EXPECT_THAT(problem({"--rows", "released"}), HasSubstr("in line 11"));
  EXPECT_THAT(problem(), HasSubstr("in line 11"));
  record(0.0, 0.1);
  EXPECT_THAT(problem({"--rows", "felt"}), HasSubstr("in line 11"));
  EXPECT_THAT(problem({"--rows", "released"}), HasSubstr("in line 12"));
}

TEST_F(CertifyCommand, WrongNamesAndDamagedRecordingsAreToldOf) {
  record(1.0);
  EXPECT_THROW(run({"--pose", "wrist"}), FileError);
  folder.write("record.csv", std::string(motionHeader()) + "\n1,2,3\n");
  EXPECT_THROW(run(), FileError);
  folder.write("record.csv", "");
  EXPECT_THROW(run(), FileError);
}

}  // namespace
}  // namespace nearfit::bench::certify_command_test
