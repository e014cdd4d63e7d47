#pragma once

#include <QString>

#include "core/servo/servo_snapshot.h"

namespace nearfit::ui {

/// How far the hand is ahead of the part.
struct HandLead {
  glm::dvec3 handCentre{0.0};  ///< Where the hand wants the part's centre of mass, in the world [m].
  double distance = 0.0;       ///< From there to the part's centre of mass [m].
  double angle = 0.0;          ///< Between both orientations [rad].
};

/// Returns the hand's lead in `snapshot`; zero in modes where part and hand coincide.
HandLead handLeadOf(const ServoSnapshot& snapshot) noexcept;

/// Formats the distance, in the user's unit, and any turn of at least 0.05°: "3.10 mm", "3.10 mm, 1.2°".
QString formatLead(const HandLead& lead);

}  // namespace nearfit::ui
