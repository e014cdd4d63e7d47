#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "core/scene/scene_tree.h"

namespace nearfit {

/// Parts and groups to be added to a scene, together.
struct NewNodes {
  struct NewGroup {
    std::string name;
    std::optional<std::size_t> parent = {};  ///< Index of an earlier group; std::nullopt: the top level.
  };
  struct NewPart {
    PartGeometryPtr geometry;
    std::string name;
    RigidTransform worldFromPart = {};
    std::optional<Colour> colour = {};      ///< std::nullopt: the next of the palette, one for each geometry.
    std::optional<std::size_t> group = {};  ///< Index of a group.
  };
  std::vector<NewGroup> groups;
  std::vector<NewPart> parts;

  /// Adds all of `others` behind these.
  void append(NewNodes others);
};

/// Adds the nodes to the scene and returns those that are at the top level. Appends numbers to names of parts, and of
/// groups at the top level, that are taken. Throws UsageError, and leaves the scene in part changed, if a value is
/// invalid or a limit exceeded: give a copy.
SceneNodes addTo(Scene& scene, const NewNodes& nodes);

}  // namespace nearfit
