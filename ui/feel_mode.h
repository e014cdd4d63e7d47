#pragma once

#include <QMetaType>
#include <QString>
#include <cstdint>

#include "core/haptics/haptic_settings.h"

class QComboBox;

namespace nearfit::ui {

/// Mode and law as one choice, as a user sees them.
enum class FeelMode : std::uint8_t { Proxy, LinearSprings, PrintedSprings };

FeelMode feelModeOf(const HapticSettings& settings) noexcept;

/// The settings in another mode. Between the laws the stiffness is converted so that the most a spring pushes
/// stays what it was (k c for the linear one, k c^2 / 4 as printed), within the limits.
HapticSettings withMode(const HapticSettings& settings, FeelMode mode) noexcept;

/// A sentence or two for someone who has to choose.
QString explanationOf(FeelMode mode);

/// Puts the modes into a box; their data is the FeelMode.
void addModes(QComboBox& box);
void showMode(QComboBox& box, FeelMode mode);

}  // namespace nearfit::ui

Q_DECLARE_METATYPE(nearfit::ui::FeelMode)
