#pragma once

#include "core/haptics/servo_snapshot.h"

namespace nearfit::ui {

/// Whether two snapshots give the same picture.
bool looksTheSame(const ServoSnapshot& a, const ServoSnapshot& b);

}  // namespace nearfit::ui
