#pragma once

#include <array>
#include <cstdint>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/haptics/spring_law.h"

namespace nearfit {

/// Source of the force that the hand feels.
enum class HapticMode : std::uint8_t {
  Proxy,    ///< The part follows the hand as far as the scene allows; a coupling pulls the hand to the part.
  Springs,  ///< The part is where the hand is; each minimum pushes like a spring (see SpringLaw).
};

/// Contact in the proxy mode.
struct ProxySettings {
  /// Clearance kept in contact [m]; > 0. A smaller one shows the true gap better, but the part slides less
  /// far in a tick.
  double margin = 1e-4;
  double friction = 0.0;  ///< Coulomb's coefficient; >= 0, 0 for none.
  bool operator==(const ProxySettings&) const = default;
};

/// Spring and damper between handle and part in the proxy mode, as requested. What is rendered is limited to
/// the stability bound (virtual_coupling.h).
struct CouplingSettings {
  /// True: as stiff as the device's bound allows, and the values below are ignored.
  bool isAutomatic = true;
  double stiffness = 1000.0;         ///< [N/m]
  double damping = 0.0;              ///< [N s/m]
  double rotationalStiffness = 1.0;  ///< About the part's axis of max inertia [N m/rad].
  double rotationalDamping = 0.0;    ///< [N m s/rad]
  bool operator==(const CouplingSettings&) const = default;
};

/// Weight and inertia of the part that the hand feels on request.
struct WeightSettings {
  bool hasWeight = false;                  ///< The hand carries the part's weight.
  bool hasInertia = false;                 ///< The part resists acceleration (proxy mode only).
  glm::dvec3 gravity{0.0, 0.0, -9.80665};  ///< World frame [m/s^2].
  bool operator==(const WeightSettings&) const = default;
};

/// Maps motion of the device to motion of the handle in the scene.
struct WorkspaceMapping {
  double scale = 1.0;                                ///< Scale of translation; > 0.
  glm::dquat orientationOffset{1.0, 0.0, 0.0, 0.0};  ///< Rotates the device's frame into the world; unit.
  std::array<bool, 3> translationLocks{};            ///< World axes along which the handle does not move.
  std::array<bool, 3> rotationLocks{};               ///< World axes about which the handle does not turn.
  bool operator==(const WorkspaceMapping&) const = default;
};

/// All haptic settings of a user; stored with the scene. Limits: haptic_limits.h.
struct HapticSettings {
  HapticMode mode = HapticMode::Proxy;
  SpringParameters springs;  ///< The cutoff applies in both modes.
  ProxySettings proxy;
  CouplingSettings coupling;
  WeightSettings weight;
  WorkspaceMapping mapping;
  bool operator==(const HapticSettings&) const = default;
};

}  // namespace nearfit
