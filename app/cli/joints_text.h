#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "core/scene/scene.h"

namespace nearfit::cli {

/// "Peg on axis of Hole, on".
std::string jointText(const Scene& scene, const Joint& joint);

/// A line for each joint, numbered from 1, and one for each part that they keep: how far it is off them.
std::string jointsText(const Scene& scene);
/// The same as an array of objects.
nlohmann::ordered_json jointsJson(const Scene& scene);

}  // namespace nearfit::cli
