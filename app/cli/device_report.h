#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "app/cli/ticked_device.h"
#include "device/interface/haptic_device.h"

namespace nearfit::cli {

/// Result of one step of a device's test.
struct TestStep {
  enum class Result { Passed, Failed, Skipped };
  std::string name;
  Result result = Result::Passed;
  std::string text;
};

/// Returns "pass", "fail" or "skip".
const char* resultName(TestStep::Result result);

/// A motion that the owner of a device is asked for, in the device's frame: x to the right, y away, z up.
struct AskedMotion {
  const char* name;
  const char* request;  ///< What to do with the handle, as a sentence without a full stop.
  glm::dvec3 axis;      ///< Unit; the direction, or the axis of a right-handed turn.
  bool isTurn = false;
};

/// Returns the motions to ask for: right, away and up, and a turn about each of these axes if the device senses turning.
std::vector<AskedMotion> askedMotions(int sensedAxes);

/// Judges what the handle did when asked for a motion. Failed if it went another way than asked: an axis of the device
/// is exchanged or reversed. Skipped if it moved too little to tell.
/// @param way  Translation [m], or rotation vector [rad], since the request.
TestStep judgeMotion(const AskedMotion& asked, const glm::dvec3& way);

/// Motion from which judgeMotion() can tell the way [m], [rad].
inline constexpr double kClearWay = 0.02, kClearTurn = 0.35;
/// Max share of a motion across the direction asked for: no hand moves straight.
inline constexpr double kMaxAcross = 0.7;

/// Asks for each motion in turn and waits for it, up to 15 s. Prints the requests to stdout. Ends with a failed step if
/// the device is lost.
std::vector<TestStep> askForMotions(TickedDevice& ticked);

struct MeasuredNoise {
  TestStep step;
  double rms = 0.0;  ///< Of the handle's place [m].
};

/// Watches a handle that nobody touches, for a second: noise of its place, and age of a pose when it is read. Failed if
/// the noise is more than contact can bear.
MeasuredNoise measureNoise(TickedDevice& ticked);

/// Writes what a test found as a JSON file to send in: the device's name (with its maker's driver where that says its
/// version), limits and steps, the program's and system's version; no serial number, no name of user or computer. Throws FileError.
void writeDeviceReport(const std::filesystem::path& file, const DeviceInfo& info,
                       const std::vector<TestStep>& steps);

}  // namespace nearfit::cli
