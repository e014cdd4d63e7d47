#include "app/cli/scene_part.h"

#include <fmt/format.h>

#include "core/base/error.h"

namespace nearfit::cli {

PartId chosenPart(const Scene& scene, const std::string& name) {
  if (name.empty()) {
    if (scene.movingGroup())
      throw UsageError("--part", "a group is in hand, not a part", "name one of the scene's parts");
    if (scene.movingPart()) return *scene.movingPart();
    throw UsageError("--part", "the scene has no moving part", "name one of its parts");
  }
  const Part* part = scene.findByName(name);
  if (part == nullptr)
    throw UsageError("--part", fmt::format("there is no part \"{}\"", name), "name a part of the scene");
  return part->id;
}

}  // namespace nearfit::cli
