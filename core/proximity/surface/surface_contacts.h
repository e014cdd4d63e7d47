#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"
#include "core/proximity/query/lmd_query.h"
#include "core/proximity/query/pair_passage.h"
#include "core/proximity/query/triangle_distance.h"
#include "core/proximity/surface/unsided_surface.h"

namespace nearfit {

/// Two near points of two surfaces, and the direction between them.
struct SurfaceContact {
  glm::dvec3 scenePoint{0.0}, partPoint{0.0};         ///< In the frame of the scene's mesh [m].
  glm::dvec3 direction{0.0};                          ///< Unit, from the scene to the part.
  double distance = 0.0;                              ///< > 0 [m].
  std::uint32_t sceneTriangle = 0, partTriangle = 0;  ///< Of the meshes.
};

/// A triangle of each of two surfaces, with lower bounds on their distance.
struct TrianglePair {
  std::uint32_t scene = 0, part = 0;  ///< Indices in the hierarchies' faces().
  double atLeast = 0.0;               ///< Lower bound at the pose of the list [m].
  bool isByPart = false;              ///< True if the part's triangle gave that bound.
  double known = 0.0;                 ///< Lower bound at the pose of the latest test [m].
  double gap = 0.0;  ///< Bound that the latest test computed [m]; infinity if it passed the pair over.
  /// Unit, towards the part, in the scene's centred frame: along it the two were apart when they were tested last.
  /// Zero if none is known.
  glm::dvec3 direction{0.0};
};

/// Result of findNearbyTriangles.
struct NearbyTriangles {
  std::size_t count = 0;  ///< Number of filled entries of the caller's storage.
  /// Every pair nearer than this is there [m]: as requested, or less if room or work ran out.
  double within = 0.0;
  std::uint64_t work = 0;  ///< Pairs of nodes opened, plus kWorkOfListing per pair of triangles.
};

/// Approximate work on a pair of triangles, in pairs of nodes opened.
constexpr std::uint64_t kWorkOfListing = 2, kWorkOfTest = 6, kWorkOfDistance = 16;
/// Number of held pairs passed over in the time of opening one pair of nodes, and of those bounded by their direction.
constexpr std::size_t kPassedOver = 16, kBounded = 2;

/// Finds the pairs of triangles of two surfaces that are near, in no order. If no point of the part then
/// moves farther than t, they include all pairs nearer than `within` - t.
///
/// @param sceneFromPart  Pose of `part` in the frame of `scene`'s mesh; unit quaternion. One that is not
///                       finite gives none, within 0.
/// @param within         Max distance of a pair [m]; finite, > 0.
/// @param scratch        Preallocated work space, one per thread.
/// @param maxWork        Bound on the work, in pairs of nodes; never exceeded.
/// Real-time safe: no allocation, lock or throw.
NearbyTriangles findNearbyTriangles(const UnsidedSurface& scene, const UnsidedSurface& part,
                                    const RigidTransform& sceneFromPart, double within, LmdScratch& scratch,
                                    std::span<TrianglePair> out, std::uint64_t maxWork) noexcept;

/// Pairs of triangles listed for one pose, and bounds on the motion from there to another.
struct HeldTriangles {
  std::span<TrianglePair> pairs;  ///< The test updates all but the indices and `atLeast`.
  double within = 0.0;            ///< As in NearbyTriangles [m].
  double travel = 0.0;            ///< Max displacement of any point of the part since the list's pose [m].
  /// Max displacement since the latest test of the list [m]; `travel` if there was none.
  double travelSinceTest = 0.0;
};

/// Where two surfaces are near.
struct SurfaceContacts {
  std::size_t count = 0;  ///< Number of filled entries of the caller's storage.
  /// Every contact nearer than this is there [m]: `within`, or less if pairs were not listed, or room ran out.
  double completeTo = 0.0;
  /// Lower bound on the distance between the surfaces [m]: `within` if nothing is nearer, 0 where they pass
  /// through each other, and in the worst case.
  double lowerBound = 0.0;
  /// Lower bound on their distance anywhere on the way that was asked about [m], at most `enough`; not above 0 if
  /// nothing is known.
  double leastOnWay = 0.0;
};

/// Finds where two surfaces are near, nearest first: the minima of their distance regardless of their sides,
/// and places that fail to be minima only by a tilt of a few degrees (kContactTilt). So a slightly tilted
/// flat part has a contact at each corner, while a tessellated plane has contacts straight across only.
/// Contacts at one place in one direction count once.
///
/// A part moves in small steps. So a pair is tested only if neither the way since its last test nor the direction that
/// separated it then keeps it out of reach. The conditions are those of minima (lmd_query.h) on tangent cones, without
/// the condition that a segment leaves on the outer side. Real-time safe: no allocation, lock or throw.
class TriangleTests {
 public:
  struct Asked {
    const UnsidedSurface *scene = nullptr, *part = nullptr;
    RigidTransform sceneFromPart;  ///< Pose of `part` in the frame of `scene`'s mesh; unit quaternion.
    double within = 0.0;           ///< Max distance of a contact [m]; finite, > 0.
    HeldTriangles held;            ///< From findNearbyTriangles for these surfaces.
    /// The way that led there, if it is asked how near the surfaces come on it. The held pairs serve all of it.
    std::optional<PartWay> way{};
    double enough = 0.0;  ///< A distance on the way beyond this [m] is as good as any.
  };

  /// Starts tests at a pose; what earlier ones have not finished is left, see settle(). A pose or reach that is not
  /// valid gives no contacts and a lower bound of 0.
  /// @param out  Caller's storage; keeps the nearest if it fills.
  void begin(const Asked& asked, std::span<SurfaceContact> out) noexcept;
  /// Goes on until all is tested or the work is spent; false if it is.
  /// @param work  Work allowed, in pairs of nodes; the work done is subtracted, down to 0.
  bool goOn(std::uint64_t& work) noexcept;
  /// The result, once goOn() has returned true.
  const SurfaceContacts& result() const noexcept { return result_; }
  /// Brings the bounds of all pairs to the pose of tests that are given up, as if it had been tested.
  void settle() noexcept;

 private:
  enum class Stage : std::uint8_t { Contacts, Distance, Way, Done };

  Asked asked_;
  std::span<SurfaceContact> out_;
  std::size_t count_ = 0;  ///< Contacts so far.
  bool isFull_ = false;
  Stage stage_ = Stage::Done;
  std::size_t at_ = 0;  ///< Where the stage goes on.
  double least_ = 0.0;  ///< Of the distances found so far [m].
  SurfaceContacts result_;
};

/// Max tilt of a surface towards the other's point for a contact to count [rad]: what a part turns in a few
/// ticks, and far less than would make a contact oblique.
constexpr double kContactTilt = 0.035;

}  // namespace nearfit
