#pragma once

#include "core/haptics/servo_snapshot.h"

namespace nearfit::ui {

/// True if the view looks the same with both snapshots.
bool looksTheSame(const ServoSnapshot& a, const ServoSnapshot& b);

}  // namespace nearfit::ui
