#pragma once

#include "core/servo/servo_snapshot.h"

namespace nearfit::ui {

/// True if the view looks the same with both snapshots.
bool looksTheSame(const ServoSnapshot& a, const ServoSnapshot& b);

}  // namespace nearfit::ui
