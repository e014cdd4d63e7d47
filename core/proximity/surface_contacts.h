#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"
#include "core/proximity/lmd_query.h"
#include "core/proximity/triangle_distance.h"
#include "core/proximity/unsided_surface.h"

namespace nearfit {

/// Two points of two surfaces that are near, and the way from one to the other.
struct SurfaceContact {
  glm::dvec3 scenePoint{0.0}, partPoint{0.0};  ///< In the frame of the scene's mesh [m].
  glm::dvec3 direction{0.0};                   ///< Unit, from the scene to the part.
  double distance = 0.0;                       ///< > 0 [m].
  std::uint32_t sceneTriangle = 0, partTriangle = 0;
};

/// A triangle of each of two surfaces.
struct TrianglePair {
  std::uint32_t scene = 0, part = 0;  ///< Of the faces of the hierarchies.
  double atLeast = 0.0;               ///< They are no nearer at the pose that they were listed for [m].
  bool isByPart = false;              ///< Whether the part's triangle told that.
  double known = 0.0;                 ///< The same of the pose that the list was tested for last [m].
  double gap = 0.0;                   ///< Of a test: they are no nearer there [m].
};

/// Pairs that were found to be near.
struct NearbyTriangles {
  std::size_t count = 0;  ///< Entries of the caller's storage that were filled.
  double within = 0.0;  ///< Every pair nearer than this is there [m]: what was asked for, or less when there
                        ///< was no room, or too much work.
  std::uint64_t work = 0;  ///< Pairs of nodes opened, and kWorkOfListing for each of triangles.
};

/// What the work on a pair of triangles counts as, in pairs of nodes that are opened, about.
constexpr std::uint64_t kWorkOfListing = 2, kWorkOfTest = 4, kWorkOfDistance = 16;
/// So many held pairs are passed over in the time of one pair of nodes.
constexpr std::size_t kPassedOver = 16;

/// The pairs of triangles of two surfaces that are near, in no order. When the part moves no point by more
/// than some way, those that come nearer than `within` less that way are among them.
///
/// @param sceneFromPart  Pose of `part` in the frame of `scene`'s mesh; unit quaternion. One that is not
///                       finite gives none, within 0.
/// @param within         [m]; finite, > 0.
/// @param scratch        Preallocated work space, one per thread.
/// @param maxWork        Bound on the work, never passed.
/// Real-time safe: no allocation, lock or throw.
NearbyTriangles findNearbyTriangles(const UnsidedSurface& scene, const UnsidedSurface& part,
                                    const RigidTransform& sceneFromPart, double within, LmdScratch& scratch,
                                    std::span<TrianglePair> out, std::uint64_t maxWork) noexcept;

/// Pairs of triangles that were listed for a pose, and how far that is from another.
struct HeldTriangles {
  std::span<TrianglePair> pairs;  ///< Written to: `known`, `gap`, `isByPart`.
  double within = 0.0;            ///< As NearbyTriangles says [m].
  double travel = 0.0;            ///< No point of the part is farther from where it was than this [m].
  /// Nor from where it was when the list was tested last [m]; `travel` where it was not.
  double travelSinceTest;
};

struct SurfaceContacts {
  std::size_t count = 0;
  /// Every contact nearer than this is there [m]: `within`, or less where not all pairs were listed or
  /// tested, or there are more contacts than room.
  double completeTo = 0.0;
  /// No two points of the surfaces are nearer than this [m]; `within` when there is nothing nearer, 0 where
  /// they pass through each other, and in the worst case.
  double lowerBound = 0.0;
  std::uint64_t work = 0;  ///< In pairs of nodes, about; never beyond the bound.
};

/// Where two surfaces are near, nearest first: the minima of the distance between them whatever their sides,
/// and what is none only by a tilt of some degrees (kContactTilt). So a flat part that is a little tilted has
/// a contact at each of its corners, and a tessellated plane has none but straight across. What stands at one
/// place in one direction is there once.
///
/// @param sceneFromPart  Pose of `part` in the frame of `scene`'s mesh; unit quaternion, finite.
/// @param within         Distance that matters [m]; finite, > 0.
/// @param held           From findNearbyTriangles for these surfaces.
/// @param out            Caller's storage; keeps the nearest if it fills.
/// @param maxWork        Bound on the work.
/// Real-time safe: no allocation, lock or throw. The conditions are those of minima (lmd_query.h) on tangent
/// cones, without the condition that a segment leaves on the outer side. Bad arguments give no contacts and a
/// lower bound of 0.
SurfaceContacts testTriangles(const UnsidedSurface& scene, const UnsidedSurface& part,
                              const RigidTransform& sceneFromPart, double within, const HeldTriangles& held,
                              std::span<SurfaceContact> out, std::uint64_t maxWork) noexcept;

/// How far a surface may lean towards the other's point for a contact to count [rad]: what a part turns in
/// some ticks, and far less than what would make a contact oblique.
constexpr double kContactTilt = 0.035;

}  // namespace nearfit
