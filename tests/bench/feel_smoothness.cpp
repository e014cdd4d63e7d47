#include "tests/bench/feel_smoothness.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/haptics/virtual_coupling.h"
#include "device/servo/servo_loop.h"
#include "tests/bench/feel_certified.h"
#include "tests/bench/feel_servo.h"

namespace nearfit::bench {
namespace {

/// After the approach, until what it left in the filters has gone [s].
constexpr double kSettling = 0.2;
/// So many ticks of the refined way after the hand has become slower, or ticks shorter, that change is out of
/// the filters of velocity.
constexpr std::size_t kSettlingTicks = 50;
constexpr std::size_t kModes = SmoothnessRun::kModes.size();

double marginOf(const FeelScene& scene, const SmoothnessOptions& options) {
  return scene.margin.value_or(options.margin);
}

ServoParameters proxyParameters(double cutoff, double margin) {
  ServoParameters parameters;
  parameters.haptics.springs.cutoff = cutoff;
  parameters.haptics.proxy.margin = margin;
  return parameters;
}

ServoParameters springParameters(SpringLaw law, bool onePerArea, double cutoff) {
  ServoParameters parameters;
  parameters.haptics.mode = HapticMode::Springs;
  parameters.haptics.springs.cutoff = cutoff;
  parameters.haptics.springs.law = law;
  parameters.haptics.springs.onePerArea = onePerArea;
  // A device that bears any stiffness.
  constexpr double kAnyDamping = 1e6;
  parameters.limits.damping = parameters.limits.rotationalDamping = kAnyDamping;
  return parameters;
}

/// The modes along one way.
class ModesAbreast {
 public:
  ModesAbreast(const FeelScene& scene, const SmoothnessOptions& options, bool withDirect)
      : motion_(scene.motion), withDirect_(withDirect) {
    const double margin = marginOf(scene, options);
    const std::array<ServoParameters, kModes> parameters{
        proxyParameters(options.cutoff, margin), springParameters(SpringLaw::Linear, false, options.cutoff),
        springParameters(SpringLaw::Printed, false, options.cutoff),
        springParameters(SpringLaw::Linear, true, options.cutoff)};
    for (const ServoParameters& p : parameters)
      servos_.push_back(std::make_unique<FeelServo>(scene.scene, p, ListArrival::AtOnce, BenchClock::Wall));
  }

  /// What the proxy mode shows.
  const ServoSnapshot& tick(double time, double period) {
    const ServoSnapshot& felt = servos_[0]->tick(handAt(motion_, time), period);
    felt_[0] = felt.unclampedWrench;
    for (std::size_t mode = 1; withDirect_ && mode < servos_.size(); ++mode) {
      const ServoSnapshot& direct = servos_[mode]->tick(felt.proxy, period);
      felt_[mode] = direct.unclampedWrench;
      lastSprings_[mode] = std::exchange(springs_[mode], direct.areaCount);
    }
    return felt;
  }

  void leaveOutDirect() noexcept { withDirect_ = false; }

  void keep(SmoothnessRun& run) const {
    for (std::size_t mode = 0; mode < (withDirect_ ? servos_.size() : 1); ++mode) {
      const std::uint32_t now = springs_[mode], before = lastSprings_[mode];
      run.births[mode] += run.changes[mode].size.empty() ? 0 : std::max(now, before) - std::min(now, before);
      run.changes[mode].add(felt_[mode]);
    }
  }

 private:
  const PressingMotion& motion_;
  bool withDirect_;
  std::vector<std::unique_ptr<FeelServo>> servos_;
  std::array<Wrench, kModes> felt_;
  std::array<std::uint32_t, kModes> springs_{}, lastSprings_{};
};

double ratioOf(double plain, double refined) {
  return refined > 0.0 ? plain / refined : 0.0;
}

/// How many times less the refined path's changes are.
FeelRow ratioRow(const FeelRow& plain, const FeelRow& refined, const std::string& run) {
  FeelRow row = refined;
  row.run = run;
  row.quantity = plain.quantity.substr(0, plain.quantity.find(" [")) + " ratio";
  row.mean = ratioOf(plain.mean, refined.mean);
  row.p50 = ratioOf(plain.p50, refined.p50);
  row.p99 = ratioOf(plain.p99, refined.p99);
  row.p999 = ratioOf(plain.p999, refined.p999);
  row.max = ratioOf(plain.max, refined.max);
  return row;
}

/// How the proxy's part went along.
void addMotion(std::vector<FeelRow>& rows, const std::string& scene, const std::string& run,
               const SmoothnessRun& result) {
  rows.push_back(feelRow("smoothness", scene, run, "sub-steps", result.subSteps));
  rows.push_back(feelRow("smoothness", scene, run, "turned [rad]", std::vector{result.turned}));
}

struct Rows {
  FeelRow force, torque, size;
};

Rows rowsOf(const std::string& scene, const std::string& run, const WrenchChanges& changes) {
  return {feelRow("smoothness", scene, run, "force change [N]", changes.force),
          feelRow("smoothness", scene, run, "torque change [mN m]", changes.torque, 1e3),
          feelRow("smoothness", scene, run, "force [N]", changes.size)};
}

}  // namespace

void WrenchChanges::add(const Wrench& wrench) {
  if (hasLast_) {
    force.push_back(glm::distance(wrench.force, last_.force));
    torque.push_back(glm::distance(wrench.torque, last_.torque));
  }
  size.push_back(glm::length(wrench.force));
  last_ = wrench;
  hasLast_ = true;
}

SmoothnessRun runSmoothness(const FeelScene& scene, const SmoothnessOptions& options, std::size_t refinement,
                            Refinement held) {
  ModesAbreast servos(scene, options, held == Refinement::SamePeriod);
  const double begin = kApproachTime + kSettling;
  const auto approach = static_cast<std::size_t>(std::llround(begin / ServoLoop::kPeriod));
  SmoothnessRun run;
  for (std::size_t i = 0; i < approach; ++i)
    run.poses.push_back(servos.tick(ServoLoop::kPeriod * static_cast<double>(i), ServoLoop::kPeriod).proxy);

  const double step = ServoLoop::kPeriod / static_cast<double>(refinement);
  const double period = held == Refinement::SamePeriod ? ServoLoop::kPeriod : step;
  const double seconds = std::min(options.seconds, scene.mostSeconds);
  const auto ticks = static_cast<std::size_t>(std::llround(seconds / step));
  const double springTicks = scene.mostSpringSeconds / step;
  std::size_t inContact = 0;
  std::optional<glm::dquat> last;
  for (std::size_t i = 0; i <= ticks; ++i) {
    if (static_cast<double>(i) > springTicks) servos.leaveOutDirect();
    const ServoSnapshot& felt = servos.tick(begin + step * static_cast<double>(i), period);
    // The same stretch of the way, however fine its ticks.
    if (i >= kSettlingTicks * refinement / options.refinement) servos.keep(run);
    inContact += felt.contactCount > 0 ? 1 : 0;
    run.subSteps.push_back(felt.subSteps);
    run.turned += glm::length(turnBetween(last.value_or(felt.proxy.rotation), felt.proxy.rotation));
    last = felt.proxy.rotation;
    run.poses.push_back(felt.proxy);
  }
  run.inContact = static_cast<double>(inContact) / static_cast<double>(ticks + 1);
  return run;
}

std::vector<FeelRow> smoothnessRows(const std::string& name, const FeelScene& scene,
                                    const SmoothnessOptions& options) {
  const SmoothnessRun plain = runSmoothness(scene, options, 1, Refinement::SamePeriod);
  const std::string times = fmt::format("x{}", options.refinement);
  std::vector<FeelRow> rows;
  rows.push_back(feelRow("smoothness", name, "proxy x1", "in contact", std::vector{plain.inContact}));
  rows.push_back(certifiedRow("smoothness", name, "proxy x1", *scene.scene, plain.poses));
  addMotion(rows, name, "proxy x1", plain);
  for (const Refinement held : {Refinement::SamePeriod, Refinement::SameSpeed}) {
    const SmoothnessRun refined = runSmoothness(scene, options, options.refinement, held);
    const bool isSamePeriod = held == Refinement::SamePeriod;
    const std::string refinedRun = "proxy " + times + (isSamePeriod ? "" : " same speed");
    rows.push_back(certifiedRow("smoothness", name, refinedRun, *scene.scene, refined.poses));
    addMotion(rows, name, refinedRun, refined);
    for (std::size_t mode = 0; mode < SmoothnessRun::kModes.size(); ++mode) {
      const std::string of = SmoothnessRun::kModes[mode];
      // Without damping the springs know nothing of time.
      if (!isSamePeriod && mode > 0) continue;
      const std::string run = fmt::format("{} {}{}", of, times, isSamePeriod ? "" : " same speed");
      const Rows before = rowsOf(name, of + " x1", plain.changes[mode]);
      const Rows after = rowsOf(name, run, refined.changes[mode]);
      if (isSamePeriod) rows.insert(rows.end(), {before.size, before.force, before.torque});
      if (mode > 0) {
        rows.push_back(feelRow("smoothness", name, of + " x1", "springs born or ended",
                               std::vector{static_cast<double>(plain.births[mode])}));
        rows.push_back(feelRow("smoothness", name, run, "springs born or ended",
                               std::vector{static_cast<double>(refined.births[mode])}));
      }
      rows.insert(rows.end(), {after.force, after.torque, ratioRow(before.force, after.force, run),
                               ratioRow(before.torque, after.torque, run)});
    }
  }
  return rows;
}

}  // namespace nearfit::bench
