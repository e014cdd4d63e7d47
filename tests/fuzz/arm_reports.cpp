// What the arms of Polhem and of the Falcon send, whatever it is: places are finite and where the arms reach,
// currents within their limits.
#include <algorithm>
#include <cstdlib>
#include <vector>

#include "device/falcon/falcon_kinematics.h"
#include "device/falcon/falcon_protocol.h"
#include "device/polhem/polhem_calibration.h"
#include "device/polhem/polhem_kinematics.h"
#include "device/polhem/polhem_protocol.h"
#include "tests/fuzz/byte_source.h"
#include "tests/fuzz/fuzz_target.h"

namespace nearfit::fuzz {
namespace {

glm::dvec3 someForce(ByteSource& source) {
  return {source.number(), source.number(), source.number()};
}

void checkPolhem(ByteSource& source) {
  static const polhem::Calibration calibration;
  const polhem::Kinematics kinematics(calibration);
  const std::size_t size = source.flag() ? polhem::kPacketSize : source.below(80);
  std::vector<std::byte> packet(size);
  for (std::byte& byte : packet)
    byte = std::byte{source.byte()};
  const auto report = polhem::decode(packet);
  if (!report) return;
  std::array<std::int16_t, 6> rest{};
  for (std::int16_t& count : rest)
    count = source.raw<std::int16_t>();
  const polhem::Angles angles = kinematics.anglesOf(report->encoders, rest);
  const glm::dvec3 place = kinematics.positionOf(angles.arm);
  require(isFinite(place), "places are finite");
  require(isPose({kinematics.orientationOf(angles), place}), "orientations are unit");
  const glm::dvec3 force = someForce(source);
  for (const int milliamps : kinematics.milliampsFor(force, angles.arm))
    require(std::abs(milliamps) <= polhem::kMaxMilliamps, "currents are within their limit");
}

void checkFalcon(ByteSource& source) {
  falcon::FrameReader reader;
  glm::dvec3 last = falcon::kCentre;
  const glm::dvec3 force = someForce(source);
  while (!source.isEmpty()) {
    const auto report = reader.take(std::byte{source.byte()});
    if (!report) continue;
    const glm::dvec3 angles = falcon::anglesOf(report->encoders);
    require(isFinite(angles), "angles are finite");
    const auto place = falcon::forward(angles, last);
    if (!place) continue;
    require(isFinite(*place), "places are finite");
    const auto back = falcon::inverse(*place);
    require(back.has_value(), "a place that is reached is within reach");
    // Beyond their range thighs may stand as the inverse, with knees outwards, does not have them.
    for (int i = 0; i < 3 && falcon::isInRange(angles); ++i)
      require(std::abs((*back)[i] - angles[i]) < 1e-6, "there and back is the same");
    last = *place;
    for (const std::int16_t units : falcon::unitsFor(force, *place, angles))
      require(std::abs(units) <= falcon::kMaxUnits, "motors are within their limit");
  }
}

void run(std::span<const std::uint8_t> data) {
  ByteSource source(data.data(), data.size());
  if (source.flag())
    checkPolhem(source);
  else
    checkFalcon(source);
}

}  // namespace
}  // namespace nearfit::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  nearfit::fuzz::run({data, size});
  return 0;
}
