#include "device/polhem/polhem_calibration.h"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "tests/support/places.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::polhem::polhem_calibration_test {
namespace {

using testing::HasSubstr;
using Json = nlohmann::json;

const std::filesystem::path kFolder = test::sourceFolder() / "resources/devices";

class PolhemCalibration : public testing::Test {
 protected:
  Json good = Json::parse(test::readBytes(kFolder / "polhem-1.json"));

  Calibration read(const Json& json) const { return readCalibration(folder_.write("c.json", json.dump())); }
  /// The error that the file gives.
  FileError errorOf(const Json& json) const {
    try {
      read(json);
    } catch (const FileError& error) {
      return error;
    }
    ADD_FAILURE() << "no error";
    return {"", ""};
  }
  /// That a value at a JSON pointer is refused, and where the message says it stands.
  void expectRefused(const std::string& pointer, const Json& value, const std::string& path) const {
    Json json = good;
    json[Json::json_pointer(pointer)] = value;
    EXPECT_THAT(errorOf(json).where(), HasSubstr(path)) << value;
  }

 private:
  test::TemporaryFolder folder_;
};

TEST_F(PolhemCalibration, TheFileOfTheWoodenHapticsIsWhatIsUsedWithoutOne) {
  EXPECT_EQ(readCalibration(kFolder / "woodenhaptics-2015.json"), Calibration{});
}

TEST_F(PolhemCalibration, EveryValueOfAFileIsRead) {
  const Calibration calibration = read(good);
  EXPECT_EQ(calibration.name, "Polhem 1");
  EXPECT_EQ(calibration.columnHeight, 0.058);
  EXPECT_EQ(calibration.lowerArm, 0.174);
  EXPECT_EQ(calibration.upperArm, 0.133);
  EXPECT_EQ(calibration.origin, glm::dvec3(0.140, 0.0, 0.100));
  EXPECT_EQ(calibration.joints[0].joint.gearRatio, 18.0);
  EXPECT_TRUE(calibration.joints[0].joint.isReversed);
  EXPECT_EQ(calibration.joints[2].joint.restAngle, degrees(90));
  EXPECT_EQ(calibration.joints[2].torqueConstant, 0.0538);
  EXPECT_TRUE(calibration.hasGimbal);
  EXPECT_EQ(calibration.gimbal[0].encoder, 5);
  EXPECT_FALSE(calibration.gimbal[1].isReversed);
  EXPECT_EQ(calibration.gimbal[2].countsPerTurn, 1024.0);
  EXPECT_EQ(calibration.maxForce, 5.0);
}

TEST_F(PolhemCalibration, WrongValuesAreNamedByTheirPlace) {
  expectRefused("/format", "something", "format");
  expectRefused("/version", 2, "version");
  expectRefused("/lengths/lowerArm", 0.0, "lengths.lowerArm");
  expectRefused("/lengths/upperArm", -0.1, "lengths.upperArm");
  expectRefused("/lengths/column", 3.0, "lengths.column");
  expectRefused("/origin", Json::array({1, 2}), "origin");
  expectRefused("/joints/0/encoder", 6, "joints[0].encoder");
  expectRefused("/joints/0/encoder", 1.5, "joints[0].encoder");
  expectRefused("/joints/1/countsPerTurn", 0, "joints[1].countsPerTurn");
  expectRefused("/joints/2/gearRatio", 0, "joints[2].gearRatio");
  expectRefused("/joints/2/reversed", 1, "joints[2].reversed");
  expectRefused("/joints/0/torqueConstant", 0.0, "joints[0].torqueConstant");
  expectRefused("/joints/0/maxCurrent", 2.5, "joints[0].maxCurrent");
  expectRefused("/joints/0/maxCurrent", -1.0, "joints[0].maxCurrent");
  expectRefused("/joints/1/rangeDegrees", Json::array({100, -80}), "joints[1].rangeDegrees");
  expectRefused("/joints/1/restDegrees", 101, "joints[1].restDegrees");
  expectRefused("/gimbal", Json::array({1}), "gimbal");
  expectRefused("/maxForce", "five", "maxForce");
  expectRefused("/mass", -1, "mass");
  expectRefused("/damping", 1000, "damping");
  expectRefused("/inertia", nullptr, "inertia");
}

TEST_F(PolhemCalibration, AMissingValueIsNamed) {
  good["joints"][1].erase("gearRatio");
  EXPECT_THAT(errorOf(good).where(), HasSubstr("joints[1].gearRatio"));
}

TEST_F(PolhemCalibration, TwoJointsCannotShareAnEncoder) {
  good["gimbal"][1]["encoder"] = 2;
  const FileError error = errorOf(good);
  EXPECT_THAT(error.where(), HasSubstr("gimbal[1].encoder"));
  EXPECT_THAT(error.problem(), HasSubstr("another joint"));
}

TEST_F(PolhemCalibration, MoreCountsThanSixteenBitsHoldAreRefused) {
  // 100 of 360 degrees, 18 turns a turn, 2000 counts each: 10000; 7 times that is too much.
  good["joints"][0]["countsPerTurn"] = 14000;
  EXPECT_THAT(errorOf(good).problem(), HasSubstr("70000 counts"));
}

TEST_F(PolhemCalibration, LimitsAreThoseOfTheFile) {
  good["maxForce"] = 4.0;
  good["mass"] = 0.3;
  const DeviceLimits limits = limitsOf(read(good));
  EXPECT_EQ(limits.maxForce, 4.0);
  EXPECT_EQ(limits.maxTorque, 0.0);
  EXPECT_EQ(limits.forceSlew, 800.0);
  EXPECT_EQ(limits.leastMass, 0.3);
  EXPECT_EQ(limits.damping, 0.5);
}

}  // namespace
}  // namespace nearfit::polhem::polhem_calibration_test
