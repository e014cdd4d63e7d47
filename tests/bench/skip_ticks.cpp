#include <algorithm>

#include <fmt/format.h>

#include "core/servo/servo_tick.h"
#include "tests/bench/near_pair.h"
#include "tests/bench/scene_path.h"
#include "tests/bench/selection.h"
#include "tests/bench/skips.h"
#include "tests/bench/statistics.h"
#include "tests/bench/tick_run.h"

namespace nearfit::bench {
namespace {

/// A hand that stops so often along its path, and stands so many ticks for each in which it moves.
constexpr std::size_t kStops = 20, kStandingTicks = 5;

using Alter = std::function<void(TrackedScene&)>;

SkipRow rowOf(const std::string& skip, const std::string& where, std::vector<TickRun> runs) {
  SkipRow row{skip, where, "tick", {}, {}, {}};
  row.with = {std::move(runs[0].tickTimes), 0, std::move(runs[0].digests)};
  row.without = {std::move(runs[1].tickTimes), 0, std::move(runs[1].digests)};
  return row;
}

/// Ticks with what another thread has found as it is, and altered.
std::vector<TickRun> bothRuns(const std::shared_ptr<const ServoScene>& scene, HapticMode mode,
                              std::span<const RigidTransform> path, double cutoff, const Alter& alter,
                              const SkipOptions& options) {
  const std::vector<TickScene> lanes{{"with", scene, mode, {}}, {"without", scene, mode, alter}};
  return runTicks(lanes, path, cutoff, options.run);
}

/// Every part is looked at, those that cannot be near without a list.
void lookAtAll(TrackedScene& tracked) {
  std::vector<TrackedScene::Near> all(tracked.scene->bodies.size());
  for (std::uint32_t i = 0; i < all.size(); ++i)
    all[i].body = i;
  for (const TrackedScene::Near& entry : tracked.near)
    all[entry.body] = entry;
  tracked.near = std::move(all);
  tracked.serial = 0;
}

void forgetLists(TrackedScene& tracked) {
  for (TrackedScene::Near& entry : tracked.near)
    entry.list = entry.contacts = nullptr;
  tracked.serial = 0;
}

void forgetTicks(TrackedScene& tracked) {
  tracked.serial = 0;
}

SkipRow measureBroadPhase(const SceneEntry& entry, const SkipOptions& options) {
  const PreparedScene prepared(entry.make(), kUsualCutoffFraction);
  const std::vector<RigidTransform> path = makePath(prepared, options.path);
  const std::shared_ptr<const ServoScene> scene = NearPair(prepared, path).sceneWith(options.farParts);
  std::vector<TickRun> runs = bothRuns(scene, HapticMode::Springs, path, prepared.cutoff, lookAtAll, options);
  const std::size_t near = runs[0].mostNear;
  SkipRow row = rowOf("broad-phase", entry.name, std::move(runs));
  row.remark = fmt::format("{} of {} parts a tick", options.farParts + 1 - near, options.farParts + 1);
  return row;
}

SkipRow measureLists(const SceneEntry& entry, const SkipOptions& options) {
  const PreparedScene prepared(entry.make(), kUsualCutoffFraction);
  const std::vector<RigidTransform> path = makePath(prepared, options.path);
  const std::shared_ptr<const ServoScene> scene = NearPair(prepared, path).sceneWith(0);
  std::vector<TickRun> runs =
      bothRuns(scene, HapticMode::Springs, path, prepared.cutoff, forgetLists, options);
  const std::vector<double> searches = runs[0].refreshTimes;
  const std::size_t ticks = runs[0].digests.size(), late = runs[0].lateTicks;
  SkipRow row = rowOf("lists", entry.name, std::move(runs));
  row.remark = fmt::format("the search in {} of {} ticks", ticks - late, ticks);
  if (!searches.empty()) {
    row.remark += fmt::format("; instead {} searches in another thread of {:.0f} us each", searches.size(),
                              1e6 * SampleSummary(searches).percentile(0.5));
  }
  return row;
}

SkipRow measureStillTicks(const SceneEntry& entry, HapticMode mode, const SkipOptions& options) {
  const PreparedScene prepared(entry.make(), kUsualCutoffFraction);
  const std::vector<RigidTransform> moving = makePath(prepared, options.path);
  std::vector<RigidTransform> path;
  const std::size_t apart = std::max<std::size_t>(1, moving.size() / kStops);
  for (std::size_t i = 0; i < moving.size(); ++i) {
    const bool isStop = (i + 1) % apart == 0;
    path.insert(path.end(), isStop ? 1 + kStandingTicks * apart : 1, moving[i]);
  }
  const std::shared_ptr<const ServoScene> scene = NearPair(prepared, moving).sceneWith(0);
  const std::string where = entry.name + (mode == HapticMode::Springs ? " springs" : " proxy");
  SkipRow row =
      rowOf("still-ticks", where, bothRuns(scene, mode, path, prepared.cutoff, forgetTicks, options));
  row.remark = fmt::format("the minima of the {} of {} ticks in which the part stands and no list arrives",
                           path.size() - moving.size(), path.size());
  return row;
}

}  // namespace

std::vector<SkipEntry> tickSkips() {
  return {{"broad-phase", "Parts out of reach are not looked at",
           [](const SkipOptions& options) {
             std::vector<SkipRow> rows;
             for (const SceneEntry& entry : chosen(generatedScenes(), {"gear-disc"}, "scene"))
               rows.push_back(measureBroadPhase(entry, options));
             return rows;
           }},
          {"still-ticks", "A tick in which nothing has moved or changed uses what the last one found",
           [](const SkipOptions& options) {
             std::vector<SkipRow> rows;
             for (const SceneEntry& entry :
                  chosen(generatedScenes(), {"gear-disc", "crankshaft-gear"}, "scene")) {
               for (const HapticMode mode : {HapticMode::Springs, HapticMode::Proxy})
                 rows.push_back(measureStillTicks(entry, mode, options));
             }
             return rows;
           }},
          {"lists", "Pairs of features that can carry a minimum are listed beside the servo",
           [](const SkipOptions& options) {
             std::vector<SkipRow> rows;
             for (const SceneEntry& entry :
                  chosen(generatedScenes(), {"gear-disc", "crankshaft-gear", "teapot-spring"}, "scene"))
               rows.push_back(measureLists(entry, options));
             return rows;
           }}};
}

}  // namespace nearfit::bench
