#pragma once

#include <memory>
#include <string>
#include <unordered_map>
#include <utility>

#include <nanobind/nanobind.h>

#include "core/batch/part_queries.h"
#include "core/scene/part_geometry.h"
#include "core/scene/scene.h"

/// The Python module `nearfit._nearfit`: thin bindings of core. Lengths in metres, angles in radians, poses world from part.
namespace nearfit::python {

namespace nb = nanobind;

/// A mesh as Python holds it; shared with the scenes that it is in.
struct Mesh {
  PartGeometryPtr geometry;
};

/// A scene as Python holds it, with what queries keep from call to call. The interpreter's lock guards it.
class HeldScene {
 public:
  HeldScene() = default;
  explicit HeldScene(Scene scene) : scene_(std::move(scene)) {}

  const Scene& scene() const noexcept { return scene_; }
  /// Replaces the scene, and forgets what was kept.
  void set(Scene scene);
  /// Moves a part, and forgets what was kept for others. Throws UsageError.
  void setPose(const std::string& name, const RigidTransform& worldFromPart);

  /// The part of that name. Throws UsageError if there is none.
  const Part& part(const std::string& name) const;
  /// Queries of the part of that name, made when first needed; without the interpreter's lock meanwhile. Throws UsageError
  /// if there is no such part.
  std::shared_ptr<PartQueries> queries(const std::string& name);

 private:
  Scene scene_;
  std::unordered_map<std::string, std::shared_ptr<PartQueries>> queries_;
};

void bindMesh(nb::module_& module);
void bindScene(nb::module_& module);
void bindQueries(nb::module_& module);
void bindClearance(nb::module_& module);
void bindPlacing(nb::module_& module);
void bindCertificates(nb::module_& module);
void bindExports(nb::module_& module);

}  // namespace nearfit::python
