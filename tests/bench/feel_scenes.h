#pragma once

#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "core/servo/servo_scene.h"
#include "tests/bench/feel_motion.h"

namespace nearfit::bench {

/// A part in conforming contact with another, and a hand that presses and moves it there.
struct FeelScene {
  std::shared_ptr<const ServoScene> scene;
  PressingMotion motion;
  double size = 0.0;  ///< The larger body's diagonal [m].

  /// Of the proxy, where what the options say is more than the parts' play allows [m].
  std::optional<double> margin;
  /// Where ticks take milliseconds: the most of the hand's motion that is walked, and of it with springs [s].
  double mostSeconds = std::numeric_limits<double>::infinity();
  double mostSpringSeconds = std::numeric_limits<double>::infinity();
};

/// A scene that is made when it is wanted.
struct FeelEntry {
  std::string name, description;
  std::function<FeelScene()> make;
};

/// Of generated meshes: a cylinder in a tube, a box in a square hole, two toothed wheels in mesh.
std::vector<FeelEntry> generatedFeelScenes();

/// Round and rectangular peg in their holes, nut on bolt, two gears in mesh, from the folder of shared
/// models; empty where it is not there.
std::vector<FeelEntry> sharedFeelScenes(const std::filesystem::path& folder);

/// Two bodies with their true mass properties, `part` in hand. @param start  worldFromPart.
std::shared_ptr<const ServoScene> solidScene(const TriangleMesh& scene, const TriangleMesh& part,
                                             const RigidTransform& start);

}  // namespace nearfit::bench
