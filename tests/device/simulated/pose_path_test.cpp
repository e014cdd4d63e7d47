#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "core/base/error.h"
#include "device/simulated/simulated_device.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::pose_path_test {
namespace {

using testing::HasSubstr;

class PosePath : public testing::Test {
 protected:
  std::vector<RigidTransform> read(const std::string& content) const {
    return readPosePath(folder_.write("path.csv", content));
  }
  /// What readPosePath says about a file that it refuses; empty when it takes it.
  std::string refusal(const std::string& content) const {
    try {
      read(content);
    } catch (const FileError& e) {
      return e.what();
    }
    return {};
  }

  test::TemporaryFolder folder_;
};

TEST_F(PosePath, ColumnsAreTranslationThenQuaternionWithItsRealPartFirst) {
  const std::vector<RigidTransform> path = read("1,2.5,-3e-3,0.5,0.5,-0.5,0.5\n0,0,0,1,0,0,0\n");
  ASSERT_EQ(path.size(), 2U);
  EXPECT_EQ(path[0].translation, glm::dvec3(1.0, 2.5, -3e-3));
  EXPECT_EQ(path[0].rotation, glm::dquat(0.5, 0.5, -0.5, 0.5));
  EXPECT_EQ(path[1].rotation, glm::dquat(1.0, 0.0, 0.0, 0.0));
}

TEST_F(PosePath, CommentsBlankLinesBlanksHeaderAndForeignLineEndsAreTaken) {
  EXPECT_EQ(read("\xEF\xBB\xBF# a comment\r\n\r\ntx,ty,tz,qw,qx,qy,qz\r\n"
                 " 1 ,\t+2, 3 , 1,0,0,0 \r\n#1,2\r\n   # indented\r\n4,5,6,1,0,0,0")
                .size(),
            2U);
}

TEST_F(PosePath, QuaternionsNearUnitLengthAreNormalised) {
  const std::vector<RigidTransform> path = read("0,0,0,1.0005,0,0,0\n0,0,0,0.7071,0.7071,0,0\n");
  EXPECT_EQ(path[0].rotation.w, 1.0);
  EXPECT_NEAR(path[1].rotation.w, std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(path[1].rotation.x, std::sqrt(0.5), 1e-15);
}

TEST_F(PosePath, AWordIsNamedWithItsLineAndColumn) {
  const std::string message = refusal("# comment\n0,0,0,1,0,0,0\n0,0,zero,1,0,0,0\n");
  EXPECT_THAT(message, HasSubstr("path.csv:3:"));
  EXPECT_THAT(message, HasSubstr("column 3: \"zero\" is not a number"));
  EXPECT_THAT(message, HasSubstr("tx,ty,tz,qw,qx,qy,qz"));
}

TEST_F(PosePath, NumbersOfOtherLocalesAndWithTailsAreRefused) {
  EXPECT_THAT(refusal("0,0,0,1,0,0,0\n0,0,0,1,0,0,1.0m\n"), HasSubstr(":2: column 7"));
  EXPECT_THAT(refusal("0,0,0,1,0,0,0\n0,0,,1,0,0,0\n"), HasSubstr(":2: column 3: \"\" is not a number"));
  EXPECT_THAT(refusal("0,0,0,1,0,0,0\n0,0,0x10,1,0,0,0\n"), HasSubstr("not a number"));
  EXPECT_THAT(refusal("0,0,0,1,0,0,0\n0,0,+-1,1,0,0,0\n"), HasSubstr("not a number"));
}

TEST_F(PosePath, InfinityOverflowAndNotANumberAreRefused) {
  for (const char* const bad : {"inf", "-inf", "nan", "1e999"}) {
    EXPECT_THAT(refusal("0,0,0,1,0,0,0\n" + std::string(bad) + ",0,0,1,0,0,0\n"), HasSubstr(":2: column 1"))
        << bad;
  }
}

TEST_F(PosePath, PositionsThatCanOnlyBeAWrongUnitAreRefused) {
  EXPECT_THAT(refusal("0,1e9,0,1,0,0,0\n0,0,-1.1e9,1,0,0,0\n"), HasSubstr(":2: column 3"));
}

TEST_F(PosePath, NumbersTooSmallForADoubleAreZero) {
  EXPECT_EQ(read("1e-999,0,0,1,0,0,0\n").at(0).translation.x, 0.0);
}

TEST_F(PosePath, AWrongNumberOfColumnsIsCounted) {
  EXPECT_THAT(refusal("0,0,0,1,0,0\n"), HasSubstr(":1: 6 values instead of 7"));
  EXPECT_THAT(refusal("0,0,0,1,0,0,0,0\n"), HasSubstr(":1: 8 values instead of 7"));
  EXPECT_THAT(refusal("0 0 0 1 0 0 0\n"), HasSubstr(":1: 1 values instead of 7"));
}

TEST_F(PosePath, NamesInQuotesAreAHeaderAndNumbersInQuotesAreNot) {
  EXPECT_EQ(read("\"tx\",\"ty\",\"tz\",\"qw\",\"qx\",\"qy\",\"qz\"\n0,0,0,1,0,0,0\n").size(), 1U);
  EXPECT_THAT(refusal("\"5\",\"0\",\"0\",\"1\",\"0\",\"0\",\"0\"\n0,0,0,1,0,0,0\n"),
              HasSubstr(":1: column 1: \"\"5\"\" is not a number"));
  EXPECT_THAT(refusal("\"nan\",a,b,c,d,e,f\n0,0,0,1,0,0,0\n"), HasSubstr(":1: column 1"));
}

TEST_F(PosePath, ASecondHeaderIsNoHeader) {
  EXPECT_THAT(refusal("tx,ty,tz,qw,qx,qy,qz\ntx,ty,tz,qw,qx,qy,qz\n"), HasSubstr(":2: column 1"));
}

TEST_F(PosePath, QuaternionsOffUnitLengthAreRefused) {
  EXPECT_THAT(refusal("0,0,0,1.01,0,0,0\n"), HasSubstr(":1: the quaternion has length 1.01, not 1"));
  EXPECT_THAT(refusal("0,0,0,0,0,0,0\n"), HasSubstr("length 0"));
  EXPECT_THAT(refusal("0,0,0,1e300,1e300,0,0\n"), HasSubstr("not 1"));
}

TEST_F(PosePath, FilesWithoutPosesAreRefused) {
  EXPECT_THAT(refusal(""), HasSubstr("no poses"));
  EXPECT_THAT(refusal("# nothing\n\n"), HasSubstr("no poses"));
  EXPECT_THAT(refusal("tx,ty,tz,qw,qx,qy,qz\n"), HasSubstr("no poses"));
}

TEST_F(PosePath, AFileWithoutLineEndsIsRefusedEarly) {
  EXPECT_THAT(refusal("0,0,0,1,0,0,0\n" + std::string(1 << 20, '7')), HasSubstr(":2: the line is longer"));
  EXPECT_THAT(refusal("0,0,0,1,0,0,0\n" + std::string(4096, ' ')), HasSubstr(":2: the line is longer"));
  EXPECT_EQ(refusal("0,0,0,1,0,0,0\n" + std::string(4095, ' ')), "");
}

TEST_F(PosePath, ZeroBytesAreNoLineEnds) {
  EXPECT_THAT(refusal(std::string("0,0,0,1,0,0,0\0,9\n", 17)), HasSubstr(":1: "));
}

TEST_F(PosePath, MissingFilesAndFoldersAreNamed) {
  const std::filesystem::path missing = folder_.path() / "missing.csv";
  try {
    readPosePath(missing);
    FAIL() << "no error";
  } catch (const FileError& e) {
    EXPECT_THAT(e.what(), HasSubstr(missing.string()));
    EXPECT_THAT(e.what(), HasSubstr("there is no such file"));
  }
  try {
    readPosePath(folder_.path());
    FAIL() << "no error";
  } catch (const FileError& e) {
    EXPECT_THAT(e.what(), HasSubstr("it is a folder"));
  }
}

// A pipe without a writer waited for ever.
TEST_F(PosePath, PipesAndDevicesAreRefused) {
  const std::filesystem::path pipe = folder_.path() / "pipe.csv";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const std::filesystem::path& file : {pipe, std::filesystem::path("/dev/zero")}) {
    try {
      readPosePath(file);
      FAIL() << "no error";
    } catch (const FileError& e) {
      EXPECT_EQ(e.where(), file.string());
      EXPECT_THAT(e.problem(), HasSubstr("not a regular file"));
      EXPECT_FALSE(e.remedy().empty());
    }
  }
}

// Lines that begin in one block of the file and end in the next.
TEST_F(PosePath, LinesOfAllLengthsAreReadWhole) {
  std::string text;
  for (std::size_t i = 0; i < 4000; ++i)
    text += std::to_string(i) + ",0,0,1,0,0,0" + std::string(i, ' ') + "\n";
  const std::vector<RigidTransform> path = read(text);
  ASSERT_EQ(path.size(), 4000U);
  for (std::size_t i = 0; i < path.size(); ++i)
    ASSERT_EQ(path[i].translation.x, static_cast<double>(i));
  EXPECT_EQ(read(text.substr(0, text.size() - 1)).size(), 4000U) << "the last line may lack its end";
}

TEST_F(PosePath, ALongFileIsReadToItsLastLine) {
  const std::filesystem::path file = folder_.path() / "long.csv";
  constexpr int kRows = 300000;
  {
    std::ofstream out(file);
    for (int i = 0; i < kRows; ++i)
      out << i << ",0.123456789,0,1,0,0,0\n";
  }
  const std::vector<RigidTransform> path = readPosePath(file);
  ASSERT_EQ(path.size(), static_cast<std::size_t>(kRows));
  EXPECT_EQ(path.back().translation.x, kRows - 1);
}

}  // namespace
}  // namespace nearfit::pose_path_test
