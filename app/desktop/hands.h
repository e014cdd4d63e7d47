#pragma once

#include <memory>

#include "core/haptics/servo_tick.h"
#include "device/haptic_device.h"
#include "ui/servo_status.h"

namespace nearfit::desktop {

/// The device behind a choice of hand. The scripted hand pushes the moving part towards what is nearest to
/// it, most of the way there, and slides it along.
/// @param cutoff  Range in which the nearest is looked for [m].
std::unique_ptr<HapticDevice> makeHand(ui::Hand hand, const ServoScene& scene, double cutoff);

}  // namespace nearfit::desktop
