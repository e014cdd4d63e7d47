#pragma once

#include <string>

#include "core/scene/scene.h"

namespace nearfit::cli {

/// The part with the name given by --part; without a name, the moving part. Throws UsageError if there is none.
PartId chosenPart(const Scene& scene, const std::string& name);

}  // namespace nearfit::cli
