#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"
#include "core/proximity/lmd_query.h"
#include "core/proximity/unsided_surface.h"

namespace nearfit {

/// Two points of two surfaces that are near, and the way from one to the other.
struct SurfaceContact {
  glm::dvec3 scenePoint{0.0}, partPoint{0.0};  ///< In the frame of the scene's mesh [m].
  glm::dvec3 direction{0.0};                   ///< Unit, from the scene to the part.
  double distance = 0.0;                       ///< > 0 [m].
  std::uint32_t sceneTriangle = 0, partTriangle = 0;
};

struct SurfaceContacts {
  std::size_t count = 0;
  bool isComplete = false;  ///< Else there was more work than allowed, or more contacts than room.
  /// No two points of the surfaces are nearer than this [m]; `within` when there is nothing nearer, 0 where
  /// they pass through each other, and in the worst case.
  double lowerBound = 0.0;
  std::uint64_t nodePairs = 0, trianglePairs = 0;
};

/// Where two surfaces are near, nearest first: the minima of the distance between them whatever their sides,
/// and what is none only by a tilt of some degrees (kContactTilt). So a flat part that is a little tilted has
/// a contact at each of its corners, and a tessellated plane has none but straight across. What stands at one
/// place in one direction is there once.
///
/// @param scene, part    Not empty for there to be contacts.
/// @param sceneFromPart  Pose of `part` in the frame of `scene`'s mesh; unit quaternion, finite.
/// @param within         Distance that matters [m]; finite, > 0.
/// @param scratch        Preallocated work space, one per thread.
/// @param out            Caller's storage; keeps the nearest if it fills.
/// @param maxNodePairs   Bound on the work.
/// Real-time safe: no allocation, lock or throw. The conditions are those of minima (lmd_query.h) on tangent
/// cones, without the condition that a segment leaves on the outer side. Bad arguments give no contacts and a
/// lower bound of 0.
SurfaceContacts findSurfaceContacts(const UnsidedSurface& scene, const UnsidedSurface& part,
                                    const RigidTransform& sceneFromPart, double within, LmdScratch& scratch,
                                    std::span<SurfaceContact> out, std::uint64_t maxNodePairs) noexcept;

/// How far a surface may lean towards the other's point for a contact to count [rad]: what a part turns in
/// some ticks, and far less than what would make a contact oblique.
constexpr double kContactTilt = 0.035;

}  // namespace nearfit
