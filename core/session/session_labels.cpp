#include "core/session/session_labels.h"

#include <fmt/format.h>

namespace nearfit {

std::string nameOf(const Scene& scene, const SceneNodes& nodes) {
  const SceneNodes outer = outermost(scene, nodes);
  if (outer.groups.empty() && outer.parts.size() == 1) return scene.find(outer.parts.front())->name;
  if (outer.parts.empty() && outer.groups.size() == 1) return scene.findGroup(outer.groups.front())->name;
  const std::size_t parts = partsOf(scene, outer).size();
  return parts > 0 ? fmt::format("{} parts", parts) : fmt::format("{} groups", outer.groups.size());
}

}  // namespace nearfit
