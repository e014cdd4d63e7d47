#pragma once

#include <cstdint>
#include <span>

#include "core/haptics/wrench.h"
#include "core/proximity/lmd.h"

namespace nearfit {

/// Force of a spring at a minimum of distance d.
enum class SpringLaw : std::uint8_t {
  Linear,   ///< f = k (cutoff - d): a spring whose rest length is the cutoff.
  Printed,  ///< f = k (cutoff - d) d, as printed in the paper; zero at contact. k in N/m^2.
};

/// Springs of the minima.
struct SpringParameters {
  double cutoff = 0.01;      ///< Rest length of each spring and range of the query [m]; > 0.
  double stiffness = 200.0;  ///< [N/m] (Linear), [N/m^2] (Printed); >= 0.
  double damping = 0.0;      ///< Along each minimum's direction [N s/m]; >= 0. Never pulls.
  SpringLaw law = SpringLaw::Linear;
  /// One spring for each area of contact, at its nearest minimum (mergeAreas()), instead of one for each minimum.
  bool onePerArea = false;
  bool operator==(const SpringParameters&) const = default;
};

/// Sum of the springs of all minima, on the moving part. Each minimum pushes along its direction u with its
/// spring's force less damping * (u . v), where v is the velocity of the part's point; one that would pull
/// contributes nothing.
///
/// @param lmds          Minima; points and directions in one frame F.
/// @param centreOfMass  Of the moving part, in F [m]. Torque is about it.
/// @param twist         Of the moving part relative to the scene, in F.
/// Minima at or beyond the cutoff, blocked and merged ones contribute nothing. NaN or infinity in any other input
/// propagates to the wrench. Real-time safe. O(minima). Source: Johnson & Willemsen 2003, 4.3; rest
/// length = cutoff. Deviates in the torque: that of the forces, where the paper prints it without their -k.
Wrench springWrench(std::span<const Lmd> lmds, const SpringParameters& parameters,
                    const glm::dvec3& centreOfMass, const Twist& twist) noexcept;

}  // namespace nearfit
