#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/haptics/haptic_settings.h"

namespace nearfit {

/// A named set of settings for how contact feels, usable in any scene.
struct FeelPreset {
  std::string name;
  HapticSettings settings;
  /// If true, the preset sets stiffness and coupling alone: the scene keeps its mode, law, choice of springs, friction, weight
  /// and inertia. The stiffness is that of the linear law and is converted for another law (withLaw). True
  /// for the usual presets.
  bool isOfStiffnessAlone = false;
  bool operator==(const FeelPreset&) const = default;
};

/// Limits on a preset's name [bytes of UTF-8] and on the number of presets in a file.
constexpr std::size_t kMaxFeelPresetNameBytes = 80, kMaxFeelPresets = 200;

/// The built-in presets "Soft", "Medium" and "Stiff". A new scene has "Stiff": as stiff as the device allows.
const std::array<FeelPreset, 3>& usualFeelPresets();

/// Returns `settings` with the preset applied. Keeps what belongs to the scene (cutoff, margin, gravity) or
/// to the device's place (mapping). Does not limit the coupling to what a device can render;
/// boundedCoupling() does so where it is used.
HapticSettings withPreset(const HapticSettings& settings, const FeelPreset& preset) noexcept;

/// True if applying the preset would not change how the settings feel. Ignores settings unused in their mode.
bool isInForce(const FeelPreset& preset, const HapticSettings& settings) noexcept;

/// Throws UsageError if the name is empty, too long or not printable UTF-8, or the settings are
/// invalid (checkHaptics).
void checkFeelPreset(const FeelPreset& preset);

/// The presets of a file, as far as it could be read.
struct FeelPresetFile {
  std::vector<FeelPreset> presets;    ///< Names are unique.
  std::vector<std::string> problems;  ///< One for each preset skipped, with its place in the file.
};

/// Reads a file written by writeFeelPresets(). Skips damaged presets. A missing file holds no presets. Throws
/// FileError if the file cannot be read at all or has another format or version.
FeelPresetFile readFeelPresets(const std::filesystem::path& file);

/// Writes the presets atomically; creates the folder if missing. Throws FileError.
void writeFeelPresets(const std::filesystem::path& file, std::span<const FeelPreset> presets);

}  // namespace nearfit
