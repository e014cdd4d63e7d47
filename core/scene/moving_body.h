#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "core/base/progress.h"
#include "core/math/aabb.h"
#include "core/math/rigid_transform.h"
#include "core/mesh/mass_properties.h"
#include "core/scene/joint_set.h"
#include "core/scene/part_geometry.h"
#include "core/scene/scene.h"

namespace nearfit {

/// A part of a moving group that can be felt, and where its features are in the searched mesh of the whole group.
struct BodyMember {
  PartId id{};
  std::uint32_t vertexEnd = 0, triangleEnd = 0;  ///< One past its last vertex and triangle.
  Aabb bounds;                                   ///< In the frame of the group's geometry [m].
};

/// Joined geometry of parts that move as one.
struct GroupBody {
  /// In the frame of the part that leads. Its parts share no vertices, so that they may touch and overlap. Its mass is
  /// not set: it depends on densities.
  PartGeometryPtr geometry;
  /// Ends of each part in geometry->tree().mesh(), in the order given; known once the hierarchy is.
  struct Ends {
    std::vector<std::uint32_t> vertices, triangles;
  };
  std::shared_ptr<const Ends> ends;
};

/// Joined geometries, made once for the same meshes in the same arrangement. Thread-safe.
class GroupBodies {
 public:
  /// A part of a group.
  struct Piece {
    PartGeometryPtr geometry;
    RigidTransform bodyFromPart;
    bool operator==(const Piece& other) const noexcept {
      return geometry == other.geometry && bodyFromPart == other.bodyFromPart;
    }
  };

  /// Joins the meshes; not yet their hierarchies. O(n log n). Throws Error if they are too large together.
  GroupBody get(const std::vector<Piece>& pieces);
  /// The same if it was made before; never waits for others that make one.
  std::optional<GroupBody> find(const std::vector<Piece>& pieces);

 private:
  /// One for now and one for before the last change: a step of undo and back.
  static constexpr std::size_t kMaxKept = 2;
  struct Kept {
    std::vector<Piece> pieces;
    GroupBody body;
  };

  std::mutex mutex_;
  std::deque<Kept> kept_;  ///< Used last first.
};

/// The one rigid body that the hand moves: the moving part, or the visible parts of the moving group.
struct MovingBody {
  PartId id{};               ///< The moving part; of a group the part that leads.
  PartGeometryPtr geometry;  ///< In that part's frame; its mass is that of the whole body.
  RigidTransform worldFromBody;
  double mass = 0.0;       ///< [kg]
  bool isVisible = false;  ///< A body that is not visible cannot be felt.
  /// The parts of a group that can be felt, in the order of their features; empty for a part alone. Known once the
  /// hierarchy is ready.
  std::vector<BodyMember> members;
};

/// Returns what the hand moves. Of a group with one visible part that leads it, this is that part; of one without
/// visible parts it is the part that leads. Builds the hierarchies of a group, which takes seconds for millions of
/// triangles; prepareToFeel() does so beforehand. Throws UsageError if nothing is in hand, Error if the group is too
/// large.
MovingBody movingBody(const Scene& scene);

/// Builds all hierarchies that the servo needs: of each part, and of the moving group. Blocking, like
/// prepareHierarchies(). Throws Cancelled, and Error if the group is too large.
void prepareToFeel(const Scene& scene, const ProgressCallback& progress = {});
/// True if movingBody() and the hierarchies of all parts are there at once.
bool isReadyToFeel(const Scene& scene);

/// Mass of what the hand moves, in the frame of the moving part: of a group that of its visible parts.
struct MovingMass {
  double mass = 0.0;          ///< [kg]
  MassProperties properties;  ///< At unit density, as for a body of even density.
};
/// O(n) in the parts. All zero if nothing is in hand.
MovingMass massOfMoving(const Scene& scene);
/// Diagonal of the box around what the hand moves, in the frame of the moving part [m]; 0 if there is nothing. O(n).
double sizeOfMoving(const Scene& scene);

/// worldFromPart of all parts that the hand moves.
using MovingPoses = std::map<PartId, RigidTransform>;
/// Where the parts are once the moving part has a pose: the others move rigidly along. Empty if nothing is in hand.
MovingPoses movedPoses(const Scene& scene, const RigidTransform& worldFromMoving);

/// The joints that hold what the hand moves: those of the moving part, or those that keep a part of the moving group on
/// another part or the world, in the frame of the part that leads. Joints within the group move along and hold nothing.
/// Throws UsageError if more than kMaxJointsPerPart hold a group.
JointSet jointsOfMoving(const Scene& scene);

}  // namespace nearfit
