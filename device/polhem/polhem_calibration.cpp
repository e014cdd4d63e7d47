#include "device/polhem/polhem_calibration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <fmt/format.h>

#include "core/text/json_file.h"
#include "device/interface/haptic_device.h"
#include "device/polhem/polhem_protocol.h"

namespace nearfit::polhem {
namespace {

constexpr const char* kFormat = "nearfit-polhem-calibration";
constexpr JsonLimits kLimits{.maxBytes = 64U << 10U, .maxDepth = 8, .maxValues = 1000};
constexpr std::size_t kLongestName = 80;
/// Bounds on the lengths and offsets of a device held by a hand [m].
constexpr double kShortest = 0.01, kLongest = 1.0;

int integer(const JsonField& field, int lower, int upper) {
  const double value = field.numberWithin(lower, upper);
  if (value != std::floor(value)) field.fail("it is not a whole number");
  return static_cast<int>(value);
}

double angle(const JsonField& field) {
  return degrees(field.numberWithin(-360.0, 360.0));
}

/// Throws FileError if the joint's range needs more counts than 16 bits hold.
void requireCountable(const JsonField& field, const Joint& joint) {
  const double farthest = std::max(joint.upper - joint.restAngle, joint.restAngle - joint.lower);
  const double counts = farthest / (2.0 * std::numbers::pi) * joint.gearRatio * joint.countsPerTurn;
  if (counts < std::numeric_limits<std::int16_t>::max()) return;
  field.fail(fmt::format("its range extends {:.0f} counts from its rest, but the device counts only to {}",
                         counts, std::numeric_limits<std::int16_t>::max()),
             "check countsPerTurn, gearRatio and rangeDegrees");
}

Joint readJoint(const JsonField& field) {
  Joint joint;
  joint.encoder = integer(field.at("encoder"), 0, 5);
  joint.countsPerTurn = integer(field.at("countsPerTurn"), 4, 1'000'000);
  joint.gearRatio = field.at("gearRatio").numberWithin(0.1, 1000.0);
  joint.isReversed = field.at("reversed").isTrue();
  joint.restAngle = angle(field.at("restDegrees"));
  const JsonField range = field.at("rangeDegrees");
  range.requireSize(2);
  joint.lower = angle(range.at(0));
  joint.upper = angle(range.at(1));
  if (!(joint.lower < joint.upper)) range.fail("its first angle is not less than its second");
  if (joint.restAngle < joint.lower || joint.restAngle > joint.upper)
    field.at("restDegrees").fail("it is outside rangeDegrees", "give the joint's angle in the rest");
  requireCountable(field, joint);
  return joint;
}

DrivenJoint readDrivenJoint(const JsonField& field) {
  DrivenJoint driven;
  driven.joint = readJoint(field);
  driven.torqueConstant = field.at("torqueConstant").numberWithin(1e-4, 10.0);
  driven.maxCurrent = field.at("maxCurrent").numberWithin(0.0, 1e-3 * kMaxMilliamps);
  return driven;
}

void requireDistinctEncoders(const JsonField& root, const Calibration& calibration) {
  std::set<int> taken;
  const auto take = [&](const JsonField& field, const Joint& joint) {
    if (!taken.insert(joint.encoder).second)
      field.at("encoder").fail("another joint has this encoder", "number the encoders from 0 to 5");
  };
  for (std::size_t i = 0; i < calibration.joints.size(); ++i)
    take(root.at("joints").at(i), calibration.joints[i].joint);
  for (std::size_t i = 0; calibration.hasGimbal && i < calibration.gimbal.size(); ++i)
    take(root.at("gimbal").at(i), calibration.gimbal[i]);
}

void requireFormat(const JsonField& root) {
  if (root.at("format").text(kLongestName) != kFormat) {
    root.at("format").fail("this is not a calibration of a Polhem or WoodenHaptics",
                           fmt::format("give a file whose format is \"{}\"", kFormat));
  }
  if (root.at("version").number() != 1.0)
    root.at("version").fail("this version is not known", "install a newer Nearfit, or write version 1");
}

void readGeometry(const JsonField& root, Calibration& calibration) {
  const JsonField lengths = root.at("lengths");
  calibration.columnHeight = lengths.at("column").numberWithin(0.0, kLongest);
  calibration.lowerArm = lengths.at("lowerArm").numberWithin(kShortest, kLongest);
  calibration.upperArm = lengths.at("upperArm").numberWithin(kShortest, kLongest);
  const JsonField origin = root.at("origin");
  origin.requireSize(3);
  for (int axis = 0; axis < 3; ++axis)
    calibration.origin[axis] = origin.at(static_cast<std::size_t>(axis)).numberWithin(-kLongest, kLongest);
}

}  // namespace

Calibration readCalibration(const std::filesystem::path& file) {
  const nlohmann::json json = readJsonFile(file, kLimits);
  const JsonField root(json, file);
  requireFormat(root);
  Calibration calibration;
  calibration.name = root.at("name").text(kLongestName);
  readGeometry(root, calibration);
  const JsonField joints = root.at("joints");
  joints.requireSize(calibration.joints.size());
  for (std::size_t i = 0; i < calibration.joints.size(); ++i)
    calibration.joints[i] = readDrivenJoint(joints.at(i));
  const JsonField gimbal = root.at("gimbal");
  calibration.hasGimbal = gimbal.size() != 0;
  if (calibration.hasGimbal) gimbal.requireSize(calibration.gimbal.size());
  for (std::size_t i = 0; calibration.hasGimbal && i < calibration.gimbal.size(); ++i)
    calibration.gimbal[i] = readJoint(gimbal.at(i));
  requireDistinctEncoders(root, calibration);
  calibration.maxForce = root.at("maxForce").numberWithin(0.0, 50.0);
  calibration.damping = root.at("damping").numberWithin(0.0, 100.0);
  calibration.mass = root.at("mass").numberWithin(0.0, 10.0);
  calibration.rotationalDamping = root.at("rotationalDamping").numberWithin(0.0, 1.0);
  calibration.inertia = root.at("inertia").numberWithin(0.0, 1.0);
  return calibration;
}

DeviceLimits limitsOf(const Calibration& calibration) noexcept {
  DeviceLimits limits;
  limits.maxForce = calibration.maxForce;
  limits.maxTorque = 0.0;
  limitSlewByMax(limits);
  limits.damping = calibration.damping;
  limits.rotationalDamping = calibration.rotationalDamping;
  limits.leastMass = std::max(limits.leastMass, calibration.mass);
  limits.leastInertia = std::max(limits.leastInertia, calibration.inertia);
  return limits;
}

}  // namespace nearfit::polhem
