#pragma once

namespace nearfit {

/// Stiffness and damping in force between hand and part.
struct CouplingState {
  double stiffness = 0.0, damping = 0.0;                      ///< [N/m], [N s/m]
  double rotationalStiffness = 0.0, rotationalDamping = 0.0;  ///< [N m/rad], [N m s/rad]
  bool isHeldToBound = false;                                 ///< Less than was wished, for stability.
};

}  // namespace nearfit
