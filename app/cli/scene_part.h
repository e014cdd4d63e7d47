#pragma once

#include <string>

#include "core/scene/part_files.h"
#include "core/scene/scene.h"

namespace nearfit::cli {

/// The part with the name given by --part; without a name, the moving part. Throws UsageError if there is none.
PartId chosenPart(const Scene& scene, const std::string& name);

/// The group with the name given by --group. Throws UsageError, naming the scene file, unless there is exactly one.
GroupId namedGroup(const Scene& scene, const std::string& name, const std::string& sceneFile);

/// The scene with the part or group given by --part or --group in hand; without either, as it is. Throws UsageError as the
/// others, if both are given, or if nothing is in hand then.
Scene withInHand(Scene scene, const std::string& part, const std::string& group,
                 const std::string& sceneFile);

/// True if the name of a part matches the pattern.
bool isNameOfPart(const Scene& scene, const std::string& pattern);

using nearfit::partFiles;

}  // namespace nearfit::cli
