#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include "app/python/arrays.h"
#include "app/python/bindings.h"
#include "app/python/interrupts.h"
#include "core/base/error.h"
#include "core/scene/haptic_limits.h"
#include "core/servo/motion_recording.h"
#include "core/servo/path_run.h"
#include "core/servo/start_apart.h"

namespace nearfit::python {
namespace {

using namespace nb::literals;

/// Period of the servo [s].
constexpr double kServoPeriod = 1e-3;

/// Rows of a placement, one for each tick.
struct Placement {
  std::vector<MotionRow> rows;
};

template <class T, class Of>
std::vector<T> eachRow(const Placement& placement, const Of& of) {
  std::vector<T> values;
  values.reserve(placement.rows.size());
  for (const MotionRow& row : placement.rows)
    values.push_back(of(row));
  return values;
}

std::vector<RigidTransform> proxiesOf(const Placement& placement) {
  return eachRow<RigidTransform>(placement, [](const MotionRow& row) { return row.proxy; });
}

Vector timesOf(const Placement& placement) {
  return arrayOf<Vector>(eachRow<double>(placement, [](const MotionRow& row) { return row.time; }),
                         {placement.rows.size()});
}

Vector distancesOfTicks(const Placement& placement) {
  return arrayOf<Vector>(eachRow<double>(placement, [](const MotionRow& row) { return row.distance; }),
                         {placement.rows.size()});
}

Table wrenchesOfTicks(const Placement& placement) {
  return arrayOf<Table>(eachRow<Wrench>(placement, [](const MotionRow& row) { return row.wrench; }),
                        {placement.rows.size(), 6});
}

using Counts = nb::ndarray<nb::numpy, std::uint32_t, nb::ndim<1>>;

Counts countsOf(const Placement& placement, std::uint32_t MotionRow::* count) {
  return arrayOf<Counts>(
      eachRow<std::uint32_t>(placement, [count](const MotionRow& row) { return row.*count; }),
      {placement.rows.size()});
}

Flags clampedTicks(const Placement& placement) {
  return arrayOf<Flags>(
      eachRow<std::uint8_t>(placement,
                            [](const MotionRow& row) -> std::uint8_t { return row.isClamped ? 1 : 0; }),
      {placement.rows.size()});
}

void writePlacement(const Placement& placement, const std::filesystem::path& file) {
  withoutLock([&](const ProgressCallback&) {
    MotionWriter writer(file);
    for (const MotionRow& row : placement.rows)
      writer.write(row);
    writer.finish();
  });
}

/// Settings that a call replaces; those not given stay the scene's.
struct GivenSettings {
  const std::optional<std::string>& mode;
  std::optional<double> cutoff, stiffness, margin, friction;
};

HapticSettings settingsOf(const Scene& scene, const GivenSettings& given) {
  HapticSettings settings = scene.haptics();
  if (given.mode) {
    if (*given.mode != "proxy" && *given.mode != "springs")
      throw UsageError("mode", fmt::format("there is no mode \"{}\"", *given.mode), "give proxy or springs");
    settings.mode = *given.mode == "proxy" ? HapticMode::Proxy : HapticMode::Springs;
  }
  settings.springs.cutoff = given.cutoff.value_or(settings.springs.cutoff);
  settings.springs.stiffness = given.stiffness.value_or(settings.springs.stiffness);
  settings.proxy.margin = given.margin.value_or(settings.proxy.margin);
  settings.proxy.friction = given.friction.value_or(settings.proxy.friction);
  checkHaptics(settings);
  return settings;
}

Placement placed(const Scene& given, PartId part, const std::vector<RigidTransform>& path,
                 const HapticSettings& settings, const ProgressCallback& progress) {
  if (path.empty()) throw UsageError("path", "it has no poses", "give at least one");
  const Scene scene = withInHandAt(given, part, path.front(), "scene");
  ServoParameters parameters;
  parameters.haptics = settings;
  std::unique_ptr<ServoScene> servoScene = makeServoScene(scene);
  if (settings.mode == HapticMode::Proxy) startApart(*servoScene);
  Placement placement;
  placement.rows.reserve(path.size());
  runAlongPath(std::move(servoScene), parameters, path, kServoPeriod, [&](const PathTick& tick) {
    placement.rows.push_back(motionRow(tick.snapshot));
    if (!progress(static_cast<double>(placement.rows.size()) / static_cast<double>(path.size())))
      throw Cancelled();
    return true;
  });
  for (const MotionRow& row : placement.rows) {
    if (row.fault != ServoFault::None) throw Error("servo", faultReason(row.fault));
  }
  return placement;
}

Placement placeAlong(const HeldScene& held, const std::string& part, const ArrayLike& path,
                     const std::optional<std::string>& mode, std::optional<double> cutoff,
                     std::optional<double> stiffness, std::optional<double> margin,
                     std::optional<double> friction) {
  const PartId id = held.part(part).id;
  const std::vector<RigidTransform> poses = posesOf(path);
  const Scene scene = held.scene();
  const HapticSettings settings = settingsOf(scene, {mode, cutoff, stiffness, margin, friction});
  return withoutLock(
      [&](const ProgressCallback& progress) { return placed(scene, id, poses, settings, progress); });
}

std::string placementText(const Placement& placement) {
  return fmt::format("<nearfit.Placement of {} ticks>", placement.rows.size());
}

}  // namespace

void bindPlacing(nb::module_& module) {
  nb::class_<Placement>(
      module, "Placement",
      "Record of a part that was led along a path: k ticks of 1 ms, in the world frame. len() is k.")
      .def_prop_ro("times", &timesOf, nb::rv_policy::automatic, "(k,) float64 [s].")
      .def_prop_ro(
          "poses", [](const Placement& p) { return matricesOf(proxiesOf(p)); }, nb::rv_policy::automatic,
          "(k, 4, 4) float64: where the part is, world from part.")
      .def_prop_ro(
          "proxies", [](const Placement& p) { return rowsOf(proxiesOf(p)); }, nb::rv_policy::automatic,
          "(k, 7) float64: the same as tx ty tz [m] qw qx qy qz, as in a recording, to the last bit.")
      .def_prop_ro(
          "handles",
          [](const Placement& p) {
            return rowsOf(eachRow<RigidTransform>(p, [](const MotionRow& row) { return row.handle; }));
          },
          nb::rv_policy::automatic, "(k, 7) float64: where the hand wants it.")
      .def_prop_ro(
          "wrenches", &wrenchesOfTicks, nb::rv_policy::automatic,
          "(k, 6) float64: force [N] and torque [N m] about the part's centre of mass, as sent to a device.")
      .def_prop_ro("distances", &distancesOfTicks, nb::rv_policy::automatic,
                   "(k,) float64: min distance [m]; infinity if nothing is within the cutoff.")
      .def_prop_ro(
          "lmds", [](const Placement& p) { return countsOf(p, &MotionRow::lmds); }, nb::rv_policy::automatic,
          "(k,) uint32: number of minima within the cutoff.")
      .def_prop_ro(
          "contacts", [](const Placement& p) { return countsOf(p, &MotionRow::contacts); },
          nb::rv_policy::automatic, "(k,) uint32: minima that held the part.")
      .def_prop_ro(
          "overlapping", [](const Placement& p) { return countsOf(p, &MotionRow::overlapping); },
          nb::rv_policy::automatic, "(k,) uint32: parts that it overlaps, which it does not feel.")
      .def_prop_ro("clamped", &clampedTicks, nb::rv_policy::automatic, "(k,) bool: a limit cut the wrench.")
      .def("write_csv", &writePlacement, "path"_a, "Writes the recording as nearfit-cli place --record does.")
      .def("__len__", [](const Placement& p) { return p.rows.size(); })
      .def("__repr__", &placementText);
  module.def("place", &placeAlong, "scene"_a, "part"_a, "path"_a, nb::kw_only(), "mode"_a = nb::none(),
             "cutoff"_a = nb::none(), "stiffness"_a = nb::none(), "margin"_a = nb::none(),
             "friction"_a = nb::none(),
             "Leads a part along a path, a pose each tick of 1 ms, as fast as possible: what nearfit-cli "
             "place --fast does. In "
             "the proxy mode the part follows as far as the scene allows. The scene does not change.\n\n"
             "path: poses of the hand, world from part, (k, 4, 4) or (k, 7); the part starts at the first. "
             "mode: proxy or "
             "springs. cutoff, margin: [m]. stiffness: of springs [N/m]. Settings that are not given are the "
             "scene's.");
}

}  // namespace nearfit::python
