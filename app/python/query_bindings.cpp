#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "app/python/arrays.h"
#include "app/python/bindings.h"
#include "app/python/interrupts.h"
#include "core/base/error.h"

namespace nearfit::python {
namespace {

using namespace nb::literals;

/// Calls of fewer poses are not interrupted unless a pose may take long: they end soon, and asking takes time.
constexpr std::size_t kInterruptiblePoses = 32;

/// Minima at poses, as Python holds them.
struct Lmds {
  MinimaTable table;
  std::shared_ptr<const std::vector<std::string>> names;  ///< Of the other parts.
};

template <class Column>
auto columnView(const Lmds& lmds, const Column& column) {
  using T = typename Column::value_type;
  return viewOf<VectorView<T>>(column.data(), {column.size()}, nb::find(lmds));
}

VectorView<bool> flagsView(const Lmds& lmds, const std::vector<std::uint8_t>& flags) {
  return viewOf<VectorView<bool>>(flags.data(), {flags.size()}, nb::find(lmds));
}

TableView<double> pointsView(const Lmds& lmds, const std::vector<glm::dvec3>& points) {
  return viewOf<TableView<double>>(points.data(), {points.size(), 3}, nb::find(lmds));
}

TableView<std::uint8_t> featuresView(const Lmds& lmds) {
  static_assert(sizeof(std::array<FeatureKind, 2>) == 2);
  return viewOf<TableView<std::uint8_t>>(lmds.table.features.data(), {lmds.table.rows(), 2}, nb::find(lmds));
}

template <class T>
void takeRows(const std::vector<T>& from, std::size_t begin, std::size_t end, std::vector<T>& to) {
  to.assign(from.begin() + static_cast<std::ptrdiff_t>(begin),
            from.begin() + static_cast<std::ptrdiff_t>(end));
}

/// The minima at one pose.
Lmds lmdsAt(const Lmds& lmds, std::int64_t index) {
  const MinimaTable& all = lmds.table;
  const auto poses = static_cast<std::int64_t>(all.poses());
  const std::int64_t pose = index < 0 ? index + poses : index;
  if (pose < 0 || pose >= poses) throw nb::index_error("there is no such pose");
  const auto at = static_cast<std::size_t>(pose);
  const auto begin = static_cast<std::size_t>(all.offsets[at]),
             end = static_cast<std::size_t>(all.offsets[at + 1]);
  Lmds one{.table = {}, .names = lmds.names};
  MinimaTable& table = one.table;
  table.offsets.push_back(static_cast<std::int64_t>(end - begin));
  table.isComplete.push_back(all.isComplete[at]);
  takeRows(all.distances, begin, end, table.distances);
  takeRows(all.movingPoints, begin, end, table.movingPoints);
  takeRows(all.fixedPoints, begin, end, table.fixedPoints);
  takeRows(all.directions, begin, end, table.directions);
  takeRows(all.others, begin, end, table.others);
  takeRows(all.features, begin, end, table.features);
  takeRows(all.isRegion, begin, end, table.isRegion);
  takeRows(all.isBlocked, begin, end, table.isBlocked);
  takeRows(all.isMarginal, begin, end, table.isMarginal);
  return one;
}

std::string lmdsText(const Lmds& lmds) {
  return fmt::format("<nearfit.Lmds: {} minima at {} poses>", lmds.table.rows(), lmds.table.poses());
}

/// Returns call(queries, poses, options), run without the interpreter's lock.
template <class Ask>
auto ask(HeldScene& scene, const std::string& part, const ArrayLike& where, BatchOptions options,
         const Ask& call) {
  const std::shared_ptr<PartQueries> queries = scene.queries(part);
  const std::vector<RigidTransform> poses = posesOf(where);
  if (poses.size() < kInterruptiblePoses && !queries->arePosesSlow()) {
    const nb::gil_scoped_release unlocked;
    return call(*queries, std::span(poses), options);
  }
  return withoutLock([&](const ProgressCallback& progress) {
    options.progress = progress;
    return call(*queries, std::span(poses), options);
  });
}

using Poses = std::span<const RigidTransform>;

Lmds lmdsOf(HeldScene& scene, const std::string& part, const ArrayLike& poses, double cutoff, bool isTracked,
            std::size_t threads) {
  Lmds lmds;
  lmds.names = scene.queries(part)->sharedNames();
  lmds.table = ask(scene, part, poses, {.isTracked = isTracked, .threads = threads},
                   [cutoff](PartQueries& queries, Poses where, const BatchOptions& options) {
                     return queries.minima(where, cutoff, options);
                   });
  return lmds;
}

Vector distancesOf(HeldScene& scene, const std::string& part, const ArrayLike& poses, double cutoff,
                   std::size_t threads) {
  std::vector<double> distances =
      ask(scene, part, poses, {.threads = threads},
          [cutoff](PartQueries& queries, Poses where, const BatchOptions& options) {
            return queries.distances(where, cutoff, options);
          });
  const std::size_t count = distances.size();
  return arrayOf<Vector>(std::move(distances), {count});
}

Flags overlapsOf(HeldScene& scene, const std::string& part, const ArrayLike& poses, std::size_t threads) {
  std::vector<std::uint8_t> overlaps =
      ask(scene, part, poses, {.threads = threads},
          [](PartQueries& queries, Poses where, const BatchOptions& options) {
            return queries.overlaps(where, options);
          });
  const std::size_t count = overlaps.size();
  return arrayOf<Flags>(std::move(overlaps), {count});
}

SpringLaw lawNamed(const std::string& name) {
  if (name == "linear") return SpringLaw::Linear;
  if (name == "printed") return SpringLaw::Printed;
  throw UsageError("law", fmt::format("there is no law \"{}\"", name), "give linear or printed");
}

Table wrenchesOf(HeldScene& scene, const std::string& part, const ArrayLike& poses, double cutoff,
                 double stiffness, const std::string& law, bool onePerArea, bool isTracked,
                 std::size_t threads) {
  SpringParameters springs;
  springs.cutoff = cutoff;
  springs.stiffness = stiffness;
  springs.law = lawNamed(law);
  springs.onePerArea = onePerArea;
  std::vector<Wrench> wrenches =
      ask(scene, part, poses, {.isTracked = isTracked, .threads = threads},
          [&springs](PartQueries& queries, Poses where, const BatchOptions& options) {
            return queries.wrenches(where, springs, options);
          });
  static_assert(sizeof(Wrench) == 6 * sizeof(double));
  const std::size_t count = wrenches.size();
  return arrayOf<Table>(std::move(wrenches), {count, 6});
}

void bindLmds(nb::module_& module) {
  nb::class_<Lmds>(
      module, "Lmds",
      "Local minimum distances of a part at k poses, n in all, in the world frame. Those of pose i are rows "
      "offsets[i] to offsets[i + 1], nearest first. Arrays are read-only and show the memory of this object. "
      "len() is k; [i] gives those of one pose.")
      .def_prop_ro(
          "offsets", [](const Lmds& l) { return columnView(l, l.table.offsets); }, "(k + 1,) int64.")
      .def_prop_ro(
          "distances", [](const Lmds& l) { return columnView(l, l.table.distances); }, "(n,) float64 [m].")
      .def_prop_ro(
          "points_moving", [](const Lmds& l) { return pointsView(l, l.table.movingPoints); },
          "(n, 3) float64: on the part [m].")
      .def_prop_ro(
          "points_fixed", [](const Lmds& l) { return pointsView(l, l.table.fixedPoints); },
          "(n, 3) float64: on the other part [m].")
      .def_prop_ro(
          "normals", [](const Lmds& l) { return pointsView(l, l.table.directions); },
          "(n, 3) float64: unit, from the fixed point to the moving one.")
      .def_prop_ro(
          "parts", [](const Lmds& l) { return columnView(l, l.table.others); },
          "(n,) int32: the other part, as an index of part_names.")
      .def_prop_ro(
          "part_names", [](const Lmds& l) { return *l.names; }, "Names of the other parts.")
      .def_prop_ro("features", &featuresView,
                   "(n, 2) uint8: what carries the fixed and the moving point: 0 vertex, 1 edge, 2 face.")
      .def_prop_ro(
          "regions", [](const Lmds& l) { return flagsView(l, l.table.isRegion); },
          "(n,) bool: the pair stands for a flat set of equal minima; its points are at the centroid.")
      .def_prop_ro(
          "blocked", [](const Lmds& l) { return flagsView(l, l.table.isBlocked); },
          "(n,) bool: the segment passes through a surface. Such a minimum exerts no force.")
      .def_prop_ro(
          "marginal", [](const Lmds& l) { return flagsView(l, l.table.isMarginal); },
          "(n,) bool: double precision cannot decide that this is a minimum.")
      .def_prop_ro(
          "complete", [](const Lmds& l) { return flagsView(l, l.table.isComplete); },
          "(k,) bool: False where there are more than four million minima with one part.")
      .def("__len__", [](const Lmds& l) { return l.table.poses(); })
      .def("__getitem__", &lmdsAt, "index"_a)
      .def("__repr__", &lmdsText);
}

}  // namespace

void bindQueries(nb::module_& module) {
  bindLmds(module);
  module.def("lmds", &lmdsOf, "scene"_a, "part"_a, "poses"_a, "cutoff"_a, nb::kw_only(), "tracked"_a = false,
             "threads"_a = 0,
             "All local minimum distances between a part and all other visible parts, within a cutoff.\n\n"
             "poses: world from part, (4, 4) or (k, 4, 4), or (7,) or (k, 7) rows of tx ty tz [m] qw qx qy "
             "qz. cutoff: [m]. "
             "tracked: follow the part from pose to pose, which is faster along a path; the minima are the "
             "same. threads: max "
             "number; 0: all processors. Other threads of the interpreter run meanwhile.");
  module.def("distance", &distancesOf, "scene"_a, "part"_a, "poses"_a, nb::kw_only(),
             "cutoff"_a = std::numeric_limits<double>::infinity(), "threads"_a = 0,
             "(k,) float64: min distance of a part to any other visible part at each pose [m]; 0 where they "
             "meet, infinity "
             "beyond the cutoff [m]. poses, threads: as in lmds().");
  module.def("overlap", &overlapsOf, "scene"_a, "part"_a, "poses"_a, nb::kw_only(), "threads"_a = 0,
             "(k,) bool: True where the part has a point in common with another visible part, by exact "
             "predicates; parts that "
             "touch do. poses, threads: as in lmds().");
  module.def("wrench", &wrenchesOf, "scene"_a, "part"_a, "poses"_a, "cutoff"_a, "stiffness"_a, nb::kw_only(),
             "law"_a = "linear", "one_per_area"_a = false, "tracked"_a = false, "threads"_a = 0,
             "(k, 6) float64: force [N] and torque [N m] about the part's centre of mass, of a spring at "
             "each minimum within "
             "the cutoff [m], in the world frame.\n\n"
             "stiffness: [N/m]. law: linear, stiffness * (cutoff - distance), or printed, which has that "
             "times the distance "
             "and a stiffness in [N/m^2]. one_per_area: one spring for each area of contact. poses, tracked, "
             "threads: as in "
             "lmds().");
}

}  // namespace nearfit::python
