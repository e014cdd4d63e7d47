#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/haptics/wrench.h"
#include "tests/bench/feel_report.h"
#include "tests/bench/feel_scenes.h"

namespace nearfit::bench {

struct SmoothnessOptions {
  double seconds = 8.0;         ///< Of the hand's motion, after its approach.
  std::size_t refinement = 10;  ///< Ticks of the refined path to each of the plain one.
  double margin = 1e-4;         ///< Of the proxy [m].
  double cutoff = 1e-3;         ///< Rest length of the springs [m].
};

/// What is held while the path is refined.
enum class Refinement {
  /// The servo's period: the hand is so many times as slow. Stiffness, damping and filters are what they
  /// were.
  SamePeriod,
  /// The hand's speed: the period is so many times as short. The coupling's stiffness is that of 1 ms, as the
  /// bound never counts on less.
  SameSpeed,
};

/// From one wrench to the next.
struct WrenchChanges {
  std::vector<double> force, torque;  ///< [N], [N m]
  std::vector<double> size;           ///< Of the force itself [N].

  void add(const Wrench& wrench);

 private:
  Wrench last_;
  bool hasLast_ = false;
};

/// Of one path at one refinement, in each mode. "grouped" is "spring" with one spring for each area of contact.
struct SmoothnessRun {
  static constexpr std::array<const char*, 4> kModes{"proxy", "spring", "printed", "grouped"};
  std::array<WrenchChanges, kModes.size()> changes;
  /// Springs from one tick to the next, more or fewer: minima that are born or end, and with "grouped" also areas that
  /// part or merge.
  std::array<std::uint64_t, kModes.size()> births{};
  std::vector<RigidTransform> poses;  ///< Of the proxy's part, tick by tick, the approach too.
  double inContact = 0.0;             ///< Share of the ticks in which something holds the proxy.
  std::vector<double> subSteps;       ///< Of the proxy, in each tick.
  double turned = 0.0;                ///< All angles that its part turned by, added up [rad].
};

/// Runs the modes side by side along the hand's path. The approach is neither refined nor kept, the
/// direct modes run where the period is held. The wrench is that before limits and ramps, and in the direct modes without the bound of a
/// device: it is the law that is measured. There
/// the part is where the hand is, and springs mean nothing once it is inside: their hand takes the way that
/// the proxy's part took.
SmoothnessRun runSmoothness(const FeelScene& scene, const SmoothnessOptions& options, std::size_t refinement,
                            Refinement held);

/// Rows of the plain and the refined path, and of how many times less the refined one's changes are.
std::vector<FeelRow> smoothnessRows(const std::string& name, const FeelScene& scene,
                                    const SmoothnessOptions& options);

}  // namespace nearfit::bench
