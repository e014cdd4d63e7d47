#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/servo/motion_recording.h"
#include "tests/app/cli/plate_and_cube.h"
#include "tests/support/html_document.h"

namespace nearfit::test::report_command_test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Besides the plate with the cube 1 m above it, a path on which the cube comes down to 0.1 m, and its certificate.
class ReportCommand : public PlateAndCube {
 protected:
  ReportCommand() {
    MotionWriter writer(path("felt.csv"));
    for (int i = 0; i <= 20; ++i) {
      MotionRow row;
      row.time = 0.1 * i;
      row.proxy.translation = glm::dvec3(0.0, 0.0, 2.0 - 0.045 * i);
      row.handle = row.proxy;
      writer.write(row);
    }
    writer.finish();
    EXPECT_EQ(runCli({"path", path("felt.csv"), scene_, "-o", path("in.nfpath")}).exitCode, 0);
    EXPECT_EQ(runCli({"certify", path("in.nfpath"), scene_, "-o", path("in.nfcert"), "--separation", "0.05"})
                  .exitCode,
              0);
  }
  ProcessResult report(const std::string& scene, std::vector<std::string> options) {
    options.insert(options.begin(), {"report", scene, "-o", out_});
    return runCli(options);
  }
  HtmlElement page() { return htmlDocument(readBytes(out_)); }

  std::string out_ = path("fit.html");
};

TEST_F(ReportCommand, AReportOfAPathIsOneValidPageWithoutADisplay) {
  const auto result = report(scene_, {"--path", path("in.nfpath"), "--certificate", path("in.nfcert"),
                                      "--threshold", "1500 mm", "--author", "Ada & Grace"});
  EXPECT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_THAT(result.out,
              HasSubstr("Fits: of 1 pair none clashes; nearest are \"Plate\" and \"Cube\", 1000 mm apart. "
                        "The path is proven to keep 50 mm from all other parts.\n"));
  const HtmlElement html = page();
  EXPECT_EQ(elementsOf(html, "h1").front().text, "Fit report: fit");
  EXPECT_THAT(elementsOf(html, "header").front().text, HasSubstr("Ada & Grace"));
  EXPECT_THAT(elementWithId(html, "inputs").text, HasSubstr(path("plate.obj")));
  EXPECT_THAT(elementWithId(html, "path").text, HasSubstr("Proven anew"));
  EXPECT_EQ(elementsOf(elementWithId(html, "pairs"), "tr").size(), 2U);
}

TEST_F(ReportCommand, PicturesAreOfAsManyFindingsAsAreAskedFor) {
  const std::string row = path("row.nearfit");
  std::vector<std::string> make{"scene", "new", row, "--unit", "m"};
  for (int i = 0; i < 4; ++i)
    make.insert(make.end(), {"--part", "Cube " + std::to_string(i) + "=" + path("cube.obj") + "@" +
                                           std::to_string(1.125 * i) + ",0,0,1,0,0,0"});
  ASSERT_EQ(runCli(make).exitCode, 0);
  const auto pictured = [&](const std::vector<std::string>& options) {
    std::vector<std::string> all{"--threshold", "0.25"};
    all.insert(all.end(), options.begin(), options.end());
    const auto result = report(row, all);
    EXPECT_EQ(result.exitCode, 0) << result.err;
    return elementsOf(elementWithId(page(), "findings"), "h3").size();
  };
  EXPECT_EQ(pictured({}), 3U);
  EXPECT_EQ(pictured({"--pictures", "2"}), 2U);
  EXPECT_EQ(pictured({"--pictures", "0"}), 3U);
}

TEST_F(ReportCommand, AClashEndsWithThreeAndTheReportIsThere) {
  const std::string clashing = path("clash.nearfit");
  ASSERT_EQ(runCli({"scene", "new", clashing, "--unit", "m", "--part", "Plate=" + path("plate.obj"), "--part",
                    "Cube=" + path("cube.obj") + "@0,0,0.9,1,0,0,0"})
                .exitCode,
            0);
  const auto result = report(clashing, {});
  EXPECT_EQ(result.exitCode, 3) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_THAT(result.out, StartsWith("Does not fit: 1 of 1 pair clash"));
  EXPECT_THAT(elementWithId(page(), "pairs").text, HasSubstr("clash"));
}

TEST_F(ReportCommand, ACertificateOfAnotherSceneIsReportedAsRefusedAndEndsWithThree) {
  const std::string text = readBytes(scene_);
  std::ofstream(path("other.nearfit"), std::ios::binary) << text << "\n";
  const auto result = report(path("other.nearfit"), {"--certificate", path("in.nfcert")});
  EXPECT_EQ(result.exitCode, 3) << result.err;
  EXPECT_THAT(result.out, HasSubstr("The certificate of the path is refused."));
  EXPECT_THAT(elementWithId(page(), "path").text, HasSubstr("The certificate is refused: "));
}

TEST_F(ReportCommand, WhatMakesNoSenseIsToldAndNothingIsWritten) {
  const auto expectFailure = [&](const std::vector<std::string>& options, int exitCode,
                                 const std::string& problem) {
    const auto result = report(scene_, options);
    EXPECT_EQ(result.exitCode, exitCode) << result.out;
    EXPECT_THAT(result.err, HasSubstr(problem));
    EXPECT_FALSE(std::filesystem::exists(out_));
  };
  expectFailure({"--threshold", "-1"}, 2, "--threshold");
  expectFailure({"--pictures", "-1"}, 2, "--pictures");
  expectFailure({"--pictures", "few"}, 2, "--pictures");
  expectFailure({"--threshold", "1 kg"}, 2, "--threshold");
  expectFailure({"--path", path("felt.csv")}, 1, "it is not a path file");
  expectFailure({"--path", path("none.nfpath")}, 1, "none.nfpath");
  std::ofstream(path("changed.nfcert"), std::ios::binary) << readBytes(path("in.nfcert")) << "\n";
  expectFailure({"--certificate", path("changed.nfcert")}, 1, "changed.nfcert");
  EXPECT_EQ(runCli({"report", scene_}).exitCode, 2);
  EXPECT_EQ(runCli({"report", path("none.nearfit"), "-o", out_}).exitCode, 1);
  for (const std::string& input : {scene_, path("plate.obj"), path("in.nfpath"), path("in.nfcert")}) {
    const std::string before = readBytes(input);
    const auto result = runCli(
        {"report", scene_, "-o", input, "--path", path("in.nfpath"), "--certificate", path("in.nfcert")});
    EXPECT_EQ(result.exitCode, 2) << input;
    EXPECT_THAT(result.err, HasSubstr("is an input of this command"));
    EXPECT_EQ(readBytes(input), before);
  }
  EXPECT_EQ(runCli({"report", scene_, "-o", (folder_.path() / "none" / "fit.html").string()}).exitCode, 1);
}

}  // namespace
}  // namespace nearfit::test::report_command_test
