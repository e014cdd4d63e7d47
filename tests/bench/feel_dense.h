#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/haptics/wrench.h"
#include "core/servo/servo_scene.h"
#include "tests/bench/feel_motion.h"
#include "tests/bench/feel_report.h"

namespace nearfit::bench {

/// Two solids of flat faces in contact, which a hand presses and moves. Their faces can be cut as finely as
/// wanted: the solids, and so what is felt, stay the same.
struct DenseScene {
  std::string name, description;
  TriangleMesh scene, part;
  PressingMotion motion;
  std::uint32_t finest = 64;  ///< Edges are cut into at most so many pieces.
};

/// Block on a plate, edge on a flat, peg in its bore, chamfered peg that goes into its hole.
std::vector<DenseScene> denseScenes();

/// One walk of the hand.
struct DenseRun {
  std::size_t triangles = 0;  ///< Of both meshes.
  std::shared_ptr<const ServoScene> bodies;
  std::vector<RigidTransform> poses;  ///< Of the part, tick by tick.
  std::vector<Wrench> wrenches;       ///< On the hand, unclamped.
  std::vector<double> times;          ///< Of the ticks, on the processor [s].
  std::size_t held = 0;               ///< Ticks in contact.
  std::size_t truncated = 0;          ///< Ticks that ran out of lists or of work.
};

/// @param pieces  Of each edge; a power of two.   @param isUneven  Cut further at random places.
DenseRun runDense(const DenseScene& scene, std::uint32_t pieces, bool isUneven, std::size_t ticks);

/// Each fineness beside the coarsest: times and their ratio, and how far pose and wrench are off.
std::vector<FeelRow> denseRows(const DenseScene& scene, std::size_t ticks);

}  // namespace nearfit::bench
