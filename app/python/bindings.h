#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

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
  /// Adds a part, forgets what was kept, and returns the part as the scene has it. Throws UsageError.
  const Part& add(Part added);
  /// Removes a part, and forgets what was kept. Throws UsageError.
  void remove(const std::string& name);
  /// Shows or hides a part, and forgets what was kept. Throws UsageError.
  void show(const std::string& name, bool isVisible);
  /// Moves a part, and forgets what was kept for others. Throws UsageError.
  void setPose(const std::string& name, const RigidTransform& worldFromPart);

  /// The part of that name. Throws UsageError if there is none.
  const Part& part(const std::string& name) const;
  /// Queries of the part of that name, made unless they are kept; without the interpreter's lock meanwhile. Those of the
  /// parts last asked about are kept. Throws UsageError if there is no such part.
  std::shared_ptr<PartQueries> queries(const std::string& name);

 private:
  struct KeptQueries {
    std::string part;
    std::shared_ptr<PartQueries> queries;
  };

  Scene scene_;
  std::vector<KeptQueries> kept_;  ///< The last ones asked for first.
};

void bindMesh(nb::module_& module);
void bindScene(nb::module_& module);
void bindQueries(nb::module_& module);
void bindClearance(nb::module_& module);
void bindPlacing(nb::module_& module);
void bindCertificates(nb::module_& module);
void bindExports(nb::module_& module);

}  // namespace nearfit::python
