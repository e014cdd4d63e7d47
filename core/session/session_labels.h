#pragma once

#include <string>

#include "core/scene/scene_tree.h"

namespace nearfit {

/// How undo labels name nodes: the name of a single node, else the number of parts or groups.
std::string nameOf(const Scene& scene, const SceneNodes& nodes);

}  // namespace nearfit
