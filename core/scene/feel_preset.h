#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/haptics/haptic_settings.h"

namespace nearfit {

/// How contact is to feel, by a name: to be had again in any scene.
struct FeelPreset {
  std::string name;
  HapticSettings settings;
  /// Mode, law, friction, weight and inertia of the scene stay as they are, and the stiffness is that of the
  /// linear law, converted where another is in use (withLaw). So are the usual presets.
  bool isOfStiffnessAlone = false;
  bool operator==(const FeelPreset&) const = default;
};

constexpr std::size_t kMaxFeelPresetNameBytes = 80, kMaxFeelPresets = 200;

/// "Soft", "Medium" and "Stiff". The last is what a new scene has: as stiff as the device allows.
const std::array<FeelPreset, 3>& usualFeelPresets();

/// The settings with what a preset is about. What belongs to the scene (cutoff, margin, gravity) or to the
/// device's place beside it (mapping) stays. What a device cannot bear is not cut here: the coupling is held
/// to its bound where it is used (boundedCoupling).
HapticSettings withPreset(const HapticSettings& settings, const FeelPreset& preset) noexcept;

/// Whether the settings are what the preset makes of them, but for numbers that nobody feels in their mode.
bool isInForce(const FeelPreset& preset, const HapticSettings& settings) noexcept;

/// Throws UsageError when a preset's name is empty, too long or no text, or its settings are none
/// (checkHaptics).
void checkFeelPreset(const FeelPreset& preset);

/// A file of presets, as far as it could be read.
struct FeelPresetFile {
  std::vector<FeelPreset> presets;    ///< By names that are all different.
  std::vector<std::string> problems;  ///< One for each that was left out, with its place in the file.
};

/// Presets of a file that writeFeelPresets has written; what is damaged in it is left out. Throws FileError
/// when nothing of it can be read. A file that is not there has none.
FeelPresetFile readFeelPresets(const std::filesystem::path& file);

/// Replaces the file as one step. Throws FileError.
void writeFeelPresets(const std::filesystem::path& file, std::span<const FeelPreset> presets);

}  // namespace nearfit
