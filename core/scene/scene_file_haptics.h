#pragma once

#include <nlohmann/json.hpp>

#include "core/haptics/haptic_settings.h"
#include "core/text/json_file.h"

/// Haptic settings of a scene file (format: scene_file.h); also used for feel presets.
namespace nearfit {

/// The value of the key "haptics".
nlohmann::ordered_json hapticsJson(const HapticSettings& settings);

/// @param field  A value in the format of hapticsJson().
/// Throws FileError naming the field that is missing or invalid.
HapticSettings readHaptics(const JsonField& field);

/// @param root  A scene file of version 1, which has only springs. Other settings are those of a new scene;
///              the margin is the default for the cutoff.
/// Throws like readHaptics().
HapticSettings readHapticsOfVersion1(const JsonField& root);

}  // namespace nearfit
