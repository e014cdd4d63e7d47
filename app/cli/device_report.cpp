#include "app/cli/device_report.h"

#include <array>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <sys/utsname.h>

#include "app/cli/interrupt.h"
#include "app/cli/output.h"
#include "core/files/atomic_write.h"
#include "core/math/rotation_vector.h"
#include "device/interface/device_supervisor.h"
#include "device/thread/monotonic_clock.h"

namespace nearfit::cli {
namespace {

/// A format of its own, so that a later version may differ.
constexpr const char* kReportFormat = "nearfit-device-report";
constexpr int kReportVersion = 1;

constexpr double kMotionSeconds = 15.0, kNoiseSeconds = 1.0;
/// Coupling of some N/mm turns a tenth of a millimetre of noise into a tenth of a newton: felt as a hum [m].
constexpr double kMaxNoise = 1e-4;

glm::dvec3 wayBetween(const AskedMotion& asked, const RigidTransform& from, const RigidTransform& to) {
  return asked.isTurn ? rotationVector(to.rotation * glm::conjugate(from.rotation))
                      : to.translation - from.translation;
}

}  // namespace

const char* resultName(TestStep::Result result) {
  switch (result) {
    case TestStep::Result::Passed:
      return "pass";
    case TestStep::Result::Failed:
      return "fail";
    case TestStep::Result::Skipped:
      return "skip";
  }
  return "";
}

std::vector<AskedMotion> askedMotions(int sensedAxes) {
  std::vector<AskedMotion> asked = {{"axis x", "Push the handle to the right", {1.0, 0.0, 0.0}},
                                    {"axis y", "Push the handle away from you", {0.0, 1.0, 0.0}},
                                    {"axis z", "Lift the handle", {0.0, 0.0, 1.0}}};
  if (sensedAxes == 6) {
    asked.push_back({"turn x", "Tip the top of the handle towards you", {1.0, 0.0, 0.0}, true});
    asked.push_back({"turn y", "Tip the top of the handle to the right", {0.0, 1.0, 0.0}, true});
    asked.push_back({"turn z", "Turn the handle clockwise, as seen from above", {0.0, 0.0, -1.0}, true});
  }
  return asked;
}

TestStep judgeMotion(const AskedMotion& asked, const glm::dvec3& way) {
  const double size = glm::length(way), along = glm::dot(way, asked.axis);
  const std::string text =
      fmt::format("({:.3f}, {:.3f}, {:.3f}) {}", way.x, way.y, way.z, asked.isTurn ? "rad" : "m");
  if (!(size >= (asked.isTurn ? kClearTurn : kClearWay)))
    return {asked.name, TestStep::Result::Skipped, "it moved too little to tell: " + text};
  const bool isThatWay =
      std::sqrt(std::fmax(0.0, size * size - along * along)) <= kMaxAcross * size && along > 0.0;
  return {asked.name, isThatWay ? TestStep::Result::Passed : TestStep::Result::Failed,
          (isThatWay ? "it moved that way: " : "it moved another way: ") + text};
}

std::vector<TestStep> askForMotions(TickedDevice& ticked) {
  std::vector<TestStep> steps;
  for (const AskedMotion& asked : askedMotions(ticked.device().info().sensedAxes)) {
    print(fmt::format("{}, by {}, and hold it there.\n", asked.request,
                      asked.isTurn ? "an eighth of a turn" : "some 5 cm"));
    flushOutput();
    const RigidTransform from = ticked.handle().pose;
    const double clear = 2.0 * (asked.isTurn ? kClearTurn : kClearWay);
    const Nanoseconds begin = monotonicNow();
    glm::dvec3 way(0.0);
    while (toSeconds(monotonicNow() - begin) < kMotionSeconds && glm::length(way) < clear &&
           !InterruptGuard::isInterrupted()) {
      if (!ticked.tick()) {
        steps.push_back({asked.name, TestStep::Result::Failed, ticked.device().stateNote()});
        return steps;
      }
      way = wayBetween(asked, from, ticked.handle().pose);
    }
    steps.push_back(judgeMotion(asked, way));
  }
  return steps;
}

MeasuredNoise measureNoise(TickedDevice& ticked) {
  glm::dvec3 sum(0.0), sumOfSquares(0.0);
  LatencyHistogram ages;
  double count = 0.0;
  const glm::dvec3 origin = ticked.handle().pose.translation;
  const Nanoseconds begin = monotonicNow();
  while (toSeconds(monotonicNow() - begin) < kNoiseSeconds && !InterruptGuard::isInterrupted()) {
    if (!ticked.tick()) return {{"noise", TestStep::Result::Failed, ticked.device().stateNote()}};
    const glm::dvec3 at = ticked.handle().pose.translation - origin;
    sum += at;
    sumOfSquares += at * at;
    ages.record(ticked.handle().age);
    count += 1.0;
  }
  if (!(count > 0.0)) return {{"noise", TestStep::Result::Skipped, "no pose came"}};
  const glm::dvec3 mean = sum / count;
  const glm::dvec3 variance = glm::max(sumOfSquares / count - mean * mean, glm::dvec3(0.0));
  const double noise = std::sqrt(variance.x + variance.y + variance.z);
  return {{"noise", noise <= kMaxNoise ? TestStep::Result::Passed : TestStep::Result::Failed,
           fmt::format("{:.4f} mm rms at rest; a pose is {:.0f} us old when it is read (p99 {:.0f} us)",
                       1e3 * noise, 1e6 * ages.percentile(0.5), 1e6 * ages.percentile(0.99))},
          noise};
}

void writeDeviceReport(const std::filesystem::path& file, const DeviceInfo& info,
                       const std::vector<TestStep>& steps) {
  using Json = nlohmann::ordered_json;
  utsname system{};
  ::uname(&system);
  Json json{{"format", kReportFormat},
            {"version", kReportVersion},
            {"program", "nearfit-cli"},
            {"program_version", NEARFIT_VERSION},
            {"system", fmt::format("{} {} {}", system.sysname, system.release, system.machine)},
            {"device", info.name},
            {"senses_axes", info.sensedAxes},
            {"pushes_axes", info.forceAxes},
            {"rate_hz", info.reportPeriod > 0.0 ? 1.0 / info.reportPeriod : 0.0},
            {"limits",
             {{"force_n", info.limits.maxForce},
              {"torque_nm", info.limits.maxTorque},
              {"damping_nspm", info.limits.damping},
              {"rotational_damping_nms", info.limits.rotationalDamping},
              {"mass_kg", info.limits.leastMass},
              {"inertia_kgm2", info.limits.leastInertia},
              {"speed_mps", info.maxSpeed > 0.0 ? info.maxSpeed : SafetyLimits{}.faultSpeed}}},
            {"steps", Json::array()}};
  for (const TestStep& each : steps)
    json["steps"].push_back(
        {{"name", each.name}, {"result", resultName(each.result)}, {"text", oneLine(each.text)}});
  const std::string text = json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  atomicWrite(file, text);
}

}  // namespace nearfit::cli
