// Calibration files of a WoodenHaptics or Polhem: what is read makes a device whose every count is a place
// and whose every current is within its limit, or there is a FileError.
#include <cstdlib>
#include <limits>
#include <set>

#include "core/base/error.h"
#include "device/polhem/polhem_calibration.h"
#include "device/polhem/polhem_kinematics.h"
#include "device/polhem/polhem_protocol.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::fuzz {
namespace {

using polhem::Calibration;

/// Counts in the rest and at both ends of what 16 bits hold.
constexpr std::array<std::int16_t, 5> kCounts{0, 1, -1, std::numeric_limits<std::int16_t>::min(),
                                              std::numeric_limits<std::int16_t>::max()};

void checkMotion(const Calibration& calibration) {
  const polhem::Kinematics kinematics(calibration);
  for (const std::int16_t count : kCounts) {
    std::array<std::int16_t, 6> encoders{};
    encoders.fill(count);
    const polhem::Angles angles = kinematics.anglesOf(encoders, {});
    require(isPose({kinematics.orientationOf(angles), kinematics.positionOf(angles.arm)}),
            "a count is a pose");
    const glm::dvec3 force(calibration.maxForce);
    for (const int milliamps : kinematics.milliampsFor(force, angles.arm))
      require(std::abs(milliamps) <= polhem::kMaxMilliamps, "currents are within their limit");
  }
}

void checkLimits(const Calibration& calibration) {
  const DeviceLimits limits = polhem::limitsOf(calibration);
  require(limits.maxForce >= 0.0 && limits.maxForce <= 50.0, "force is within what the file may ask for");
  require(limits.forceSlew >= 0.0 && limits.damping >= 0.0, "no limit is negative, or no number");
  require(limits.leastMass > 0.0 && limits.leastInertia > 0.0, "what moves has mass");
}

void checkEncoders(const Calibration& calibration) {
  std::multiset<int> encoders;
  for (const polhem::DrivenJoint& driven : calibration.joints)
    encoders.insert(driven.joint.encoder);
  for (std::size_t i = 0; calibration.hasGimbal && i < calibration.gimbal.size(); ++i)
    encoders.insert(calibration.gimbal[i].encoder);
  for (const int encoder : encoders)
    require(encoder >= 0 && encoder < 6 && encoders.count(encoder) == 1,
            "each joint has an encoder of its own");
}

void run(std::string_view text) {
  static const test::TemporaryFolder folder;
  const auto file = folder.write("calibration.json", text);
  requireReadOrRefused<FileError>([&] {
    const Calibration calibration = polhem::readCalibration(file);
    checkEncoders(calibration);
    checkLimits(calibration);
    checkMotion(calibration);
  });
}

}  // namespace
}  // namespace nearfit::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  nearfit::fuzz::run({reinterpret_cast<const char*>(data), size});
  return 0;
}
