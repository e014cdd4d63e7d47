#include "tests/bench/feel_cost.h"

#include <algorithm>
#include <utility>

#include "device/servo/servo_loop.h"
#include "tests/bench/feel_certified.h"
#include "tests/bench/feel_servo.h"
#include "tests/bench/units.h"

namespace nearfit::bench {
namespace {

/// Ticks with three quarters to five quarters of so many constraints count as having so many.
bool isAbout(std::uint32_t count, double wanted) {
  return count >= 0.75 * wanted && count <= 1.25 * wanted;
}

ServoParameters parametersOf(const CostCase& scene, HapticMode mode) {
  ServoParameters parameters;
  parameters.haptics.mode = mode;
  parameters.haptics.springs.cutoff = scene.cutoff;
  parameters.haptics.proxy.margin = scene.margin;
  return parameters;
}

void note(CostRun& run, const FeelServo& servo, const ServoSnapshot& snapshot) {
  run.tick.push_back(servo.tickTime());
  run.constraints.push_back(snapshot.constraintCount);
  run.contacts.push_back(snapshot.contactCount);
  run.subSteps.push_back(snapshot.subSteps);
  run.lateBodies.push_back(snapshot.lateBodies);
  run.shortened.push_back(snapshot.shortenedSteps);
  run.refused.push_back(snapshot.refusedSteps);
  if (servo.wasPreempted()) return;
  run.query.push_back(snapshot.queryTime);
  run.proxy.push_back(snapshot.proxyTime);
  if (isAbout(snapshot.constraintCount, 32.0)) run.proxyAt32.push_back(snapshot.proxyTime);
  if (isAbout(snapshot.constraintCount, 256.0)) run.proxyAt256.push_back(snapshot.proxyTime);
}

}  // namespace

CostRun runCost(const CostCase& scene, const CostOptions& options) {
  FeelServo proxy(scene.servoScene, parametersOf(scene, HapticMode::Proxy), ListArrival::InTime,
                  options.clock);
  FeelServo springs(scene.servoScene, parametersOf(scene, HapticMode::Springs), ListArrival::InTime,
                    options.clock);
  CostRun run;
  std::vector<RigidTransform> way;
  for (std::size_t begin = 0; begin < scene.path.size(); begin += options.block) {
    const std::size_t end = std::min(begin + options.block, scene.path.size());
    way.clear();
    for (std::size_t i = begin; i < end; ++i) {
      const ServoSnapshot& snapshot = proxy.tick(scene.path[i], ServoLoop::kPeriod);
      way.push_back(snapshot.proxy);
      run.poses.push_back(snapshot.proxy);
      if (i - begin >= options.warmUp) note(run, proxy, snapshot);
    }
    for (std::size_t i = 0; i < way.size(); ++i) {
      springs.tick(way[i], ServoLoop::kPeriod);
      if (i >= options.warmUp) run.springs.push_back(springs.tickTime());
    }
  }
  run.refresh = proxy.refreshTimes();
  return run;
}

std::vector<FeelRow> costRows(const CostCase& scene, const CostRun& run) {
  std::vector<FeelRow> rows;
  const auto add = [&](const char* quantity, const std::vector<double>& samples, double scale) {
    rows.push_back(feelRow("cost", scene.scene, scene.run, quantity, samples, scale));
  };
  add("tick [us]", run.tick, kMicro);
  add("query [us]", run.query, kMicro);
  add("proxy [us]", run.proxy, kMicro);
  if (!run.proxyAt32.empty()) add("proxy of 24 to 40 rows [us]", run.proxyAt32, kMicro);
  if (!run.proxyAt256.empty()) add("proxy of 192 to 320 rows [us]", run.proxyAt256, kMicro);
  add("springs' tick [us]", run.springs, kMicro);
  add("search beside [us]", run.refresh, kMicro);
  add("constraints", run.constraints, 1.0);
  add("contacts that hold", run.contacts, 1.0);
  std::vector<double> inContact;
  for (const double count : run.contacts)
    inContact.push_back(count > 0.0 ? 1.0 : 0.0);
  add("in contact", inContact, 1.0);
  add("sub-steps", run.subSteps, 1.0);
  add("late bodies", run.lateBodies, 1.0);
  add("shortened steps", run.shortened, 1.0);
  add("refused steps", run.refused, 1.0);
  if (!run.poses.empty())
    rows.push_back(certifiedRow("cost", scene.scene, scene.run, *scene.servoScene, run.poses));
  return rows;
}

}  // namespace nearfit::bench
