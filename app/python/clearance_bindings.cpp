#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "app/python/arrays.h"
#include "app/python/bindings.h"
#include "app/python/interrupts.h"
#include "core/verdict/scene_check.h"

namespace nearfit::python {
namespace {

using namespace nb::literals;

/// A finding of a check with the names of its parts.
struct Finding {
  std::string part, other;
  PairFinding found;
};

Vector pointArray(const glm::dvec3& point) {
  return arrayOf<Vector>(std::vector<double>{point.x, point.y, point.z}, {3});
}

std::optional<double> volumeOf(const Finding& finding) {
  return finding.found.clash ? finding.found.clash->volume : std::nullopt;
}

/// One row for each minimum: distance, point on the part, point on the other.
Table minimaOf(const Finding& finding) {
  std::vector<double> numbers;
  for (const FoundMinimum& minimum : finding.found.minima) {
    const auto& [p, q] = std::pair(minimum.partPoint, minimum.otherPoint);
    numbers.insert(numbers.end(), {minimum.distance, p.x, p.y, p.z, q.x, q.y, q.z});
  }
  return arrayOf<Table>(std::move(numbers), {finding.found.minima.size(), 7});
}

std::string findingText(const Finding& finding) {
  return fmt::format("<nearfit.Finding: \"{}\" and \"{}\": {}, {} m>", finding.part, finding.other,
                     wordOf(finding.found.verdict), finding.found.distance);
}

std::vector<Finding> clearanceOf(const HeldScene& held, std::optional<double> threshold,
                                 std::size_t maxMinima, bool hasDepths) {
  const Scene scene = held.scene();
  const SceneCheck check = withoutLock([&](const ProgressCallback& progress) {
    SceneCheckRequest request = sceneCheckRequest(scene, threshold.value_or(scene.haptics().springs.cutoff));
    request.rules = scene.pairRules();
    request.maxMinima = maxMinima;
    request.hasDepths = hasDepths;
    return checkScene(request, progress);
  });
  std::vector<Finding> findings;
  for (const PairFinding& found : check.findings)
    findings.push_back({scene.get(found.pair.part).name, scene.get(found.pair.other).name, found});
  return findings;
}

}  // namespace

void bindClearance(nb::module_& module) {
  nb::class_<Finding>(module, "Finding", "How two parts are to each other, in the world frame.")
      .def_ro("part", &Finding::part, "Name of the older part.")
      .def_ro("other", &Finding::other, "Name of the other one.")
      .def_prop_ro(
          "pair", [](const Finding& f) { return nb::make_tuple(f.part, f.other); }, "Both names.")
      .def_prop_ro(
          "verdict", [](const Finding& f) { return wordOf(f.found.verdict); },
          "near, touching, clash or contained; exact.")
      .def_prop_ro(
          "distance", [](const Finding& f) { return f.found.distance; },
          "Min distance of the surfaces [m]; 0 if they meet.")
      .def_prop_ro(
          "point_part", [](const Finding& f) { return pointArray(f.found.partPoint); },
          nb::rv_policy::automatic, "(3,) float64: nearest point on the first part [m].")
      .def_prop_ro(
          "point_other", [](const Finding& f) { return pointArray(f.found.otherPoint); },
          nb::rv_policy::automatic, "(3,) float64: nearest point on the other part [m].")
      .def_prop_ro("minima", &minimaOf, nb::rv_policy::automatic,
                   "(n, 7) float64: minima below the threshold, nearest first: distance, point on the first "
                   "part, point on "
                   "the other [m].")
      .def_prop_ro(
          "every_minimum", [](const Finding& f) { return f.found.isEveryMinimum; },
          "False if there are more minima than were kept.")
      .def_prop_ro(
          "depth", [](const Finding& f) { return f.found.depth(); },
          "Length of the least translation known to free them [m], or None.")
      .def_prop_ro("volume", &volumeOf, "Volume that they share [m^3], or None.")
      .def_prop_ro(
          "allowed_by", [](const Finding& f) { return f.found.allowedBy; },
          "Index of the scene's rule that allows it, or None.")
      .def_prop_ro(
          "forbidden", [](const Finding& f) { return f.found.isForbidden(); },
          "True for a clash, or a part inside another one, that no rule allows.")
      .def("__repr__", &findingText);
  module.def("clearance", &clearanceOf, "scene"_a, "threshold"_a = nb::none(), nb::kw_only(),
             "max_minima"_a = SceneCheckRequest{}.maxMinima, "depths"_a = true,
             "Checks all pairs of visible parts by the scene's rules, as nearfit-cli clearance --all, and "
             "returns a Finding "
             "for each pair that is no farther apart than the threshold [m; default: the scene's cutoff].\n\n"
             "max_minima: kept of a pair, the nearest; 0: all. depths: find how deep clashes are, which "
             "takes most of the "
             "time.");
}

}  // namespace nearfit::python
