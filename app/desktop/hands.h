#pragma once

#include <QString>
#include <filesystem>
#include <memory>
#include <optional>

#include "core/servo/servo_tick.h"
#include "device/interface/haptic_device.h"
#include "ui/model/servo_status.h"

namespace nearfit::desktop {

/// Returns the file of a recorded hand from its id ("replay:FILE"); std::nullopt for other devices.
std::optional<std::filesystem::path> recordingOf(const QString& device);

/// Creates the manual or the scripted hand. The scripted hand takes the moving part to the nearest other part
/// and slides it along. In the proxy mode it presses beyond contact, as far as a few newtons take; against
/// springs, which it could push through, it only closes most of the gap.
/// @param settings  Settings of the scene; the nearest part is searched within their cutoff.
std::unique_ptr<HapticDevice> makeHand(ui::Hand hand, const ServoScene& scene,
                                       const HapticSettings& settings);

}  // namespace nearfit::desktop
