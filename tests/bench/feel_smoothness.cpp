#include "tests/bench/feel_smoothness.h"

#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "device/servo_loop.h"
#include "tests/bench/feel_servo.h"

namespace nearfit::bench {
namespace {

/// After the approach, until the ramps of the first contact have gone [s].
constexpr double kSettling = 0.2;

ServoParameters parametersOf(HapticMode mode, SpringLaw law, double cutoff, double margin) {
  ServoParameters parameters;
  parameters.haptics.mode = mode;
  parameters.haptics.springs.cutoff = cutoff;
  parameters.haptics.springs.law = law;
  parameters.haptics.proxy.margin = margin;
  return parameters;
}

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
  const auto servo = [&](HapticMode mode, SpringLaw law) {
    return FeelServo(scene.scene, parametersOf(mode, law, options.cutoff, options.margin),
                     ListArrival::AtOnce, BenchClock::Wall);
  };
  FeelServo proxy = servo(HapticMode::Proxy, SpringLaw::Linear);
  FeelServo spring = servo(HapticMode::Springs, SpringLaw::Linear);
  FeelServo printed = servo(HapticMode::Springs, SpringLaw::Printed);

  const double step = ServoLoop::kPeriod / static_cast<double>(refinement);
  const double period = held == Refinement::SamePeriod ? ServoLoop::kPeriod : step;
  const double begin = kApproachTime + kSettling;
  const auto ticks = static_cast<std::size_t>(std::llround((begin + options.seconds) / step));
  SmoothnessRun run;
  std::size_t kept = 0, inContact = 0;
  for (std::size_t i = 0; i <= ticks; ++i) {
    const double time = step * static_cast<double>(i);
    const ServoSnapshot& felt = proxy.tick(handAt(scene.motion, time), period);
    const Wrench& ofSpring = spring.tick(felt.proxy, period).unclampedWrench;
    const Wrench& ofPrinted = printed.tick(felt.proxy, period).unclampedWrench;
    if (time < begin) continue;
    run.changes[0].add(felt.unclampedWrench);
    run.changes[1].add(ofSpring);
    run.changes[2].add(ofPrinted);
    ++kept;
    inContact += felt.contactCount > 0 ? 1 : 0;
  }
  run.inContact = kept > 0 ? static_cast<double>(inContact) / static_cast<double>(kept) : 0.0;
  return run;
}

std::vector<FeelRow> smoothnessRows(const std::string& name, const FeelScene& scene,
                                    const SmoothnessOptions& options) {
  const SmoothnessRun plain = runSmoothness(scene, options, 1, Refinement::SamePeriod);
  const std::string times = fmt::format("x{}", options.refinement);
  std::vector<FeelRow> rows;
  rows.push_back(feelRow("smoothness", name, "proxy x1", "in contact", std::vector{plain.inContact}));
  for (const Refinement held : {Refinement::SamePeriod, Refinement::SameSpeed}) {
    const SmoothnessRun refined = runSmoothness(scene, options, options.refinement, held);
    for (std::size_t mode = 0; mode < SmoothnessRun::kModes.size(); ++mode) {
      const std::string of = SmoothnessRun::kModes[mode];
      const bool isSamePeriod = held == Refinement::SamePeriod;
      // Without damping the springs know nothing of time.
      if (!isSamePeriod && mode > 0) continue;
      const std::string run = of + " " + times + (isSamePeriod ? "" : " same speed");
      const Rows before = rowsOf(name, of + " x1", plain.changes[mode]);
      const Rows after = rowsOf(name, run, refined.changes[mode]);
      if (isSamePeriod) rows.insert(rows.end(), {before.size, before.force, before.torque});
      rows.insert(rows.end(), {after.force, after.torque, ratioRow(before.force, after.force, run),
                               ratioRow(before.torque, after.torque, run)});
    }
  }
  return rows;
}

}  // namespace nearfit::bench
