#pragma once

#include <filesystem>
#include <vector>

#include "core/scene/scene.h"

namespace nearfit {

/// The files that the parts were read from, with those that these name: no output may replace one.
std::vector<std::filesystem::path> partFiles(const Scene& scene);

}  // namespace nearfit
