#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "core/servo/servo_scene.h"

namespace nearfit::stress {

/// A scene to be hard on. Whether the part is kept where it began, on its side of a thin wall or linked with
/// a ring, no test of single poses can say: it may have gone through between two of them.
struct StressScene {
  std::shared_ptr<const ServoScene> scene;
  double margin = 0.0, cutoff = 0.0;  ///< [m]
  double size = 0.0;                  ///< How far a hand moves about, within and around the scene [m].
  RigidTransform lure;                ///< worldFromPart where it is narrowest: walks tend there.
  bool isEnergyBound = true;          ///< As EnergyLedger says.
  /// Of poses at which the part meets nothing: whether it is still on the side where it began. Empty: there
  /// are no sides.
  std::function<bool(const RigidTransform& worldFromPart)> isKept;
};

/// A scene that is made when it is wanted.
struct StressEntry {
  std::string name, description;
  std::function<StressScene()> make;
  /// What a tick of the hand takes with its checks, one pose in ten certified, of a processor [us]; about, on
  /// the machine of results/hand.csv. By it long runs share out ticks (tick_shares.h).
  double cost = kUsualCost;

  static constexpr double kUsualCost = 60.0;
};

/// All that are generated, and behind them those of the shared models where the folder is there.
std::vector<StressEntry> stressScenes(const std::filesystem::path& sharedFolder);
/// Those of the list with these names, all for none. Throws UsageError for a name that is not in it.
std::vector<StressEntry> chosenScenes(const std::vector<StressEntry>& all,
                                      const std::vector<std::string>& names);

struct PlacedBody {
  TriangleMesh mesh;
  RigidTransform worldFromBody{};
};

/// Bodies and a part with their true mass properties. The lure is `start`.
StressScene stressScene(const std::vector<PlacedBody>& bodies, const TriangleMesh& part,
                        const RigidTransform& start, double margin);

/// A cube over a floor whose top is z = 0.
constexpr double kCubeSide = 0.04;  ///< [m]
StressScene cubeOverFloor(const RigidTransform& start, double margin);

/// Not turned unless it is said how.
inline RigidTransform placedAt(const glm::dvec3& translation,
                               const glm::dquat& rotation = {1.0, 0.0, 0.0, 0.0}) {
  return {rotation, translation};
}

// By what is hard about them.
std::vector<StressEntry> narrowScenes();
std::vector<StressEntry> thinScenes();
std::vector<StressEntry> shapeScenes();
std::vector<StressEntry> scaleScenes();

/// Two rings of radius 0.4 `size`, one linked with the other: kept as long as they are. The saddles of their
/// insides touch.
/// @param worldFromScene  Where the scene's frame is.   @param offset  Of the meshes' vertices in it.
StressScene linkedRings(double size, double margin, const RigidTransform& worldFromScene = {},
                        const glm::dvec3& offset = glm::dvec3(0.0));

}  // namespace nearfit::stress
