#pragma once

#include <QString>
#include <filesystem>
#include <memory>
#include <optional>

#include "core/haptics/servo_tick.h"
#include "device/haptic_device.h"
#include "ui/servo_status.h"

namespace nearfit::desktop {

/// The file of a recorded hand whose id that is ("replay:FILE"); nothing for other devices.
std::optional<std::filesystem::path> recordingOf(const QString& device);

/// The device behind a choice of hand. The scripted hand takes the moving part to what is nearest to it and
/// slides it along: in the proxy mode it presses beyond contact, by the way that a few newtons take; springs,
/// which it could push through, it presses most of the way alone.
/// @param settings  Of the scene; the nearest is looked for within the cutoff.
std::unique_ptr<HapticDevice> makeHand(ui::Hand hand, const ServoScene& scene,
                                       const HapticSettings& settings);

}  // namespace nearfit::desktop
