#pragma once

#include <cstdint>
#include <span>

#include "core/haptics/wrench.h"
#include "core/proximity/lmd.h"

namespace nearfit {

enum class SpringLaw : std::uint8_t {
  Linear,   ///< f = k (cutoff - d): each minimum is a spring whose rest length is the cutoff.
  Printed,  ///< f = k (cutoff - d) d, as the paper prints it; falls to zero at contact. k in N/m^2.
};

struct SpringParameters {
  double cutoff = 0.01;      ///< Rest length of each spring and range of the query [m]; > 0.
  double stiffness = 200.0;  ///< [N/m] (Linear), [N/m^2] (Printed); >= 0.
  double damping = 0.0;      ///< Along each minimum's direction [N s/m]; >= 0; never pulls.
  SpringLaw law = SpringLaw::Linear;
  bool operator==(const SpringParameters&) const = default;
};

/// Sum of the springs of all minima on the moving part: at each minimum the spring's push along its direction
/// u, less damping * (u . v) with v the velocity of the part's point; a minimum that would pull gives
/// nothing.
///
/// @param lmds          Minima; points and directions in one frame F.
/// @param centreOfMass  Of the moving part, in F [m]. Torque is about it.
/// @param twist         Of the moving part relative to the scene, in F.
/// Minima at the cutoff or beyond, and blocked ones, give nothing. NaN or infinity in any input that counts
/// comes out in the wrench. Real-time safe. Source: Johnson & Willemsen 2003, 4.3; rest length = cutoff.
Wrench springWrench(std::span<const Lmd> lmds, const SpringParameters& parameters,
                    const glm::dvec3& centreOfMass, const Twist& twist) noexcept;

}  // namespace nearfit
