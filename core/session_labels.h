#pragma once

#include <string>

#include "core/scene/scene_tree.h"

namespace nearfit {

/// What undo calls nodes of a scene: the name of one, how many parts or groups they are else.
std::string nameOf(const Scene& scene, const SceneNodes& nodes);

}  // namespace nearfit
