#pragma once

#include <QMetaType>
#include <QString>
#include <cstdint>

#include "core/haptics/haptic_settings.h"

class QComboBox;

namespace nearfit::ui {

/// Haptic mode and spring law as the one choice that users see.
enum class FeelMode : std::uint8_t { Proxy, LinearSprings, PrintedSprings };

/// Returns the choice that `settings` amount to.
FeelMode feelModeOf(const HapticSettings& settings) noexcept;

/// Returns `settings` in another mode. Between spring laws it converts stiffness k so that a spring's max
/// force is kept (k c for Linear, k c^2 / 4 for Printed, c being the cutoff), within the limits.
HapticSettings withMode(const HapticSettings& settings, FeelMode mode) noexcept;

/// Returns one or two sentences that help the user choose.
QString explanationOf(FeelMode mode);

/// Adds all modes with explanations as tool tips; item data is the FeelMode.
void addModes(QComboBox& box);
/// Makes `mode` the current item of a box filled by addModes().
void showMode(QComboBox& box, FeelMode mode);

}  // namespace nearfit::ui

Q_DECLARE_METATYPE(nearfit::ui::FeelMode)
