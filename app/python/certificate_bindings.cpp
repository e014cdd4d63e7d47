#include <filesystem>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "app/python/arrays.h"
#include "app/python/bindings.h"
#include "app/python/interrupts.h"
#include "core/base/error.h"
#include "core/path/path_certification.h"
#include "core/path/path_file.h"

namespace nearfit::python {
namespace {

using namespace nb::literals;
using Path = std::filesystem::path;

PathCertification certifyFiles(const Path& path, const Path& scene, const Path& certificate,
                               std::optional<double> separation) {
  return withoutLock([&](const ProgressCallback& progress) {
    return certifyPathFile({.path = path, .scene = scene, .certificate = certificate}, separation, progress);
  });
}

PathVerification verifyFiles(const Path& certificate, const std::optional<Path>& scene,
                             const std::optional<Path>& path, bool isWithoutPath) {
  if (path && isWithoutPath)
    throw UsageError("path", "it is given, and none is to be checked", "leave out path or without_path");
  return withoutLock([&](const ProgressCallback& progress) {
    return verifyCertificateFile({.certificate = certificate,
                                  .scene = scene.value_or(Path()),
                                  .path = path.value_or(Path()),
                                  .isWithoutPath = isWithoutPath},
                                 progress);
  });
}

void writePath(const Path& file, const std::vector<std::string>& parts, const ArrayLike& poses,
               const ArrayLike& times, const std::optional<ArrayLike>& centre) {
  const std::vector<RigidTransform> where = posesOf(poses);
  const Doubles when(times);
  if (when.values().size() != where.size())
    throw UsageError("times", fmt::format("there are {} for {} poses", when.values().size(), where.size()),
                     "give one for each pose");
  AssemblyPath path;
  path.parts = parts;
  for (std::size_t i = 0; i < where.size(); ++i)
    path.poses.push_back({.time = when.values()[i], .worldFromLead = where[i]});
  if (centre) {
    const Doubles point(*centre);
    if (point.values().size() != 3)
      throw UsageError("centre", fmt::format("it has {} numbers", point.values().size()), "give three");
    path.centre = {point.values()[0], point.values()[1], point.values()[2]};
  }
  checkPath(path, "path");
  writePathFile(path, file);
}

std::optional<double> placeOfTime(const PathCertification& found) {
  return found.unproven ? std::optional(found.unproven->time) : std::nullopt;
}

std::optional<double> distanceThere(const PathCertification& found) {
  return found.unproven ? std::optional(found.unproven->distance) : std::nullopt;
}

std::string certificationText(const PathCertification& found) {
  return fmt::format("<nearfit.Certification: {}, separation {} m>",
                     found.isFree() ? "free" : "not proven free", found.separation);
}

std::string verificationText(const PathVerification& found) {
  return fmt::format("<nearfit.Verification: {}>",
                     found.isProven() ? "verified" : "refused: " + found.problem);
}

}  // namespace

void bindCertificates(nb::module_& module) {
  nb::class_<PathCertification>(module, "Certification", "What certify() found.")
      .def_prop_ro("free", &PathCertification::isFree,
                   "True if the path is proven free; then there is a certificate.")
      .def_ro("separation", &PathCertification::separation, "Distance kept [m].")
      .def_ro("poses", &PathCertification::poses, "Number of poses of the path.")
      .def_ro("pairs", &PathCertification::pairs, "Number of pairs of parts that are proven apart.")
      .def_ro("stretches", &PathCertification::stretches, "Number of stretches that prove it.")
      .def_prop_ro("time", &placeOfTime, "Time of the first place that is not proven [s], or None.")
      .def_prop_ro("distance", &distanceThere, "Lower bound on the distance there [m], or None.")
      .def_prop_ro(
          "inside", [](const PathCertification& c) { return c.unproven && c.unproven->isInside; },
          "True if a part is in another one, or meets it, at the start of the path.")
      .def_ro("part", &PathCertification::part, "Name of the moving part there; empty if the path is free.")
      .def_ro("other", &PathCertification::other, "Name of the other part there; empty if the path is free.")
      .def("__bool__", &PathCertification::isFree)
      .def("__repr__", &certificationText);
  nb::class_<PathVerification>(module, "Verification", "What verify() found.")
      .def_prop_ro("verified", &PathVerification::isProven, "True if everything is proven anew.")
      .def_ro("problem", &PathVerification::problem, "Why it is refused; empty if it is verified.")
      .def_ro("separation", &PathVerification::separation, "Distance kept [m].")
      .def_ro("poses", &PathVerification::poses, "Number of poses of the path.")
      .def_ro("stretches", &PathVerification::stretches, "Number of stretches that were proven anew.")
      .def_ro("scene_file_hashed", &PathVerification::hasSceneHash,
              "The certificate has a hash of the scene file, not of meshes only.")
      .def_ro("path_file_checked", &PathVerification::isPathChecked, "A path file was compared.")
      .def("__bool__", &PathVerification::isProven)
      .def("__repr__", &verificationText);
  module.def("certify", &certifyFiles, "path_file"_a, "scene_file"_a, "certificate_file"_a, nb::kw_only(),
             "separation"_a = nb::none(),
             "Proves that everywhere on a path (*.nfpath), not only at its poses, what moves keeps a "
             "separation [m; default: a "
             "millionth of the part, at most 1 um] from all other visible parts, and writes a certificate "
             "(*.nfcert). A path "
             "that is not proven free is no error: the result says where.");
  module.def("verify", &verifyFiles, "certificate_file"_a, "scene_file"_a = nb::none(),
             "path_file"_a = nb::none(), nb::kw_only(), "without_path"_a = false,
             "Proves a certificate anew, by code that shares no search with what made it. Scene and path are "
             "by default the "
             "files that it names; without_path checks no path file. A certificate that is refused is no "
             "error: the result "
             "says why.");
  module.def("write_path", &writePath, "path_file"_a, "parts"_a, "poses"_a, "times"_a, nb::kw_only(),
             "centre"_a = nb::none(),
             "Writes a path file (*.nfpath). parts: names of those that move as one, the one that leads "
             "first. poses: world from "
             "that one, (k, 4, 4) or (k, 7). times: (k,) [s], increasing. centre: (3,), the point that moves "
             "straight between "
             "poses, in the frame of the part that leads [m]; default: its origin.");
}

}  // namespace nearfit::python
