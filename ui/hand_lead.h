#pragma once

#include <QString>

#include "core/haptics/servo_snapshot.h"

namespace nearfit::ui {

/// How far the hand is ahead of the part.
struct HandLead {
  glm::dvec3 handCentre{0.0};  ///< Where the hand wants the part's centre of mass, in the world [m].
  double distance = 0.0;       ///< From the part's own [m].
  double angle = 0.0;          ///< [rad]
};

HandLead handLeadOf(const ServoSnapshot& snapshot) noexcept;

/// "3.10 mm", and with a turn that is worth a number "3.10 mm, 1.2°".
QString formatLead(const HandLead& lead);

}  // namespace nearfit::ui
