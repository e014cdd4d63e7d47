#pragma once

#include <array>
#include <cstdint>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/haptics/spring_law.h"

namespace nearfit {

enum class HapticMode : std::uint8_t {
  Proxy,    ///< The part follows the hand as far as the scene lets it; the hand is pulled towards the part.
  Springs,  ///< The part is where the hand is; each minimum pushes as a spring (SpringLaw says which).
};

/// How the part keeps out of the scene in the proxy mode.
struct ProxySettings {
  /// Distance at which contact holds [m]; > 0. Smaller shows the true gap better and lets the part slide
  /// less far in a tick.
  double margin = 1e-4;
  double friction = 0.0;  ///< Coulomb's coefficient; 0 is none.
  bool operator==(const ProxySettings&) const = default;
};

/// Spring and damper between hand and part in the proxy mode, as wished: what is felt is held to the bound
/// of stability (virtual_coupling.h).
struct CouplingSettings {
  /// As stiff as the device's bound allows; the numbers below are then not used.
  bool isAutomatic = true;
  double stiffness = 1000.0;         ///< [N/m]
  double damping = 0.0;              ///< [N s/m]
  double rotationalStiffness = 1.0;  ///< About the part's axis of most inertia [N m/rad].
  double rotationalDamping = 0.0;    ///< [N m s/rad]
  bool operator==(const CouplingSettings&) const = default;
};

/// Weight and inertia that are felt, on request.
struct WeightSettings {
  bool hasWeight = false;                  ///< The part hangs in the hand.
  bool hasInertia = false;                 ///< The part resists being accelerated (proxy mode).
  glm::dvec3 gravity{0.0, 0.0, -9.80665};  ///< World frame [m/s^2].
  bool operator==(const WeightSettings&) const = default;
};

/// How motion of a device becomes motion of the handle in the scene.
struct WorkspaceMapping {
  double scale = 1.0;                                ///< Of translation; > 0.
  glm::dquat orientationOffset{1.0, 0.0, 0.0, 0.0};  ///< Turns the device's frame into the world's; unit.
  std::array<bool, 3> translationLocks{};            ///< World axes along which the handle stays.
  std::array<bool, 3> rotationLocks{};               ///< World axes about which the handle stays.
  bool operator==(const WorkspaceMapping&) const = default;
};

/// What a user sets about feeling; belongs to a scene. Limits: haptic_limits.h.
struct HapticSettings {
  HapticMode mode = HapticMode::Proxy;
  SpringParameters springs;  ///< The cutoff counts in both modes.
  ProxySettings proxy;
  CouplingSettings coupling;
  WeightSettings weight;
  WorkspaceMapping mapping;
  bool operator==(const HapticSettings&) const = default;
};

}  // namespace nearfit
