#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/haptics/wrench.h"
#include "core/math/rigid_transform.h"
#include "core/mesh/triangle_mesh.h"
#include "core/servo/servo_scene.h"
#include "tests/bench/feel_report.h"

namespace nearfit::bench {

/// A part that a still hand presses against another until it rests, both solids of known shape, and where it
/// rests by the formulas of the solids.
struct RestScene {
  std::string name, description;
  std::function<TriangleMesh(std::uint32_t fineness)> scene{}, part{};
  RigidTransform start, hand, rest{};
  /// How far the surfaces of the two meshes are from those of their solids, summed: by the sagittas [m].
  std::function<double(const TriangleMesh& scene, const TriangleMesh& part)> meshDifference{};
};

/// Ball in a bowl, cylinder lying on a floor, peg in a tube, box on a slab, ring on a peg.
std::vector<RestScene> restScenes();

/// Where a part came to rest, and what the hand then feels.
struct RestResult {
  std::uint32_t fineness = 0;
  std::size_t triangles = 0;    ///< Of both meshes.
  std::size_t ticks = 0;        ///< Until it moved no more, to the last bit.
  bool isResting = false;       ///< It did.
  double meshDifference = 0.0;  ///< [m]
  RigidTransform pose;
  Wrench wrench;  ///< On the hand, of a spring of kStiffness and what belongs to it in the part's metric.
  /// In the part's metric of mass, where a turn by w counts as |gyration w| [m]: from the pose by the
  /// formulas, and from the hand.
  double fromFormula = 0.0, fromHand = 0.0;
  glm::dvec3 gyration{0.0};  ///< Of the part [m].
  std::shared_ptr<const ServoScene> bodies;
  std::vector<RigidTransform> poses;  ///< Of the part, tick by tick.
};

inline constexpr double kRestStiffness = 1000.0;  ///< [N/m]
inline constexpr double kRestMargin = 1e-4;       ///< Of the proxy [m].
/// How far the proxy's clearance may be off the margin: a hundredth of it for each direction (proxy.cpp) [m].
inline constexpr double kRestSag = 0.03 * kRestMargin;
inline constexpr double kRestPress = 0.02;  ///< How far the hand is beyond where the part rests [m].

RestResult restOf(const RestScene& scene, std::uint32_t fineness);

/// By how much a resting pose may be off in the metric: see feel_tessellation.cpp [m].
double restBound(double meshDifference);

/// How much torque there may be where the hand and the part of the solids are not turned against each other,
/// on a part of these gyrations: see feel_tessellation.cpp [N m]. Infinity where the bound of the pose lets
/// the part turn half round.
double restTorqueBound(double meshDifference, const glm::dvec3& gyration);

/// At each fineness, 1, 2, 4 and 8: four times the triangles each.
std::vector<FeelRow> tessellationRows(const RestScene& scene, std::span<const std::uint32_t> finenesses);

}  // namespace nearfit::bench
