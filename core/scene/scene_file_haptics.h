#pragma once

#include <nlohmann/json.hpp>

#include "core/haptics/haptic_settings.h"
#include "core/text/json_file.h"

/// The haptic settings of a scene file (scene_file.h has the format); for its reader and writer alone.
namespace nearfit {

nlohmann::ordered_json hapticsJson(const HapticSettings& settings);

/// @param field  What hapticsJson writes. Throws FileError naming the field that is missing or wrong.
HapticSettings readHaptics(const JsonField& field);

/// @param root  A scene file of version 1, which knows springs alone: all else is as for a new scene, the
///              margin what suits the cutoff. Throws as readHaptics.
HapticSettings readHapticsOfVersion1(const JsonField& root);

}  // namespace nearfit
