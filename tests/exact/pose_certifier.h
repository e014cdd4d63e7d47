#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "core/math/rigid_transform.h"
#include "core/mesh/triangle_mesh.h"

namespace nearfit::test {

/// Verdicts on the poses of a way, and how many of them were reached without an argument from the pose before.
struct WayVerdicts {
  std::vector<char> meetings;  ///< One for each pose; 1 where the bodies meet.
  std::size_t tested = 0;      ///< Poses at which exact predicates looked at the triangles.
  std::size_t measured = 0;    ///< Poses at which the gap between the triangles was measured.
  std::size_t boxed = 0;       ///< Poses at which the boxes of the two bodies are apart.
};

/// Says of poses whether two bodies meet there, surfaces touching or one body's piece inside the other
/// (closed, oriented meshes contain), by exact predicates on the part's vertices rounded where
/// `sceneFromPart.applyToPoint` puts them. An independent check on what the program says of itself: shares
/// nothing with it but the meshes. Trees of boxes over both meshes make it fast enough for many poses.
class PoseCertifier {
 public:
  PoseCertifier(const TriangleMesh& scene, const TriangleMesh& part);
  ~PoseCertifier();
  PoseCertifier(PoseCertifier&&) noexcept;

  bool doMeet(const RigidTransform& sceneFromPart) const;
  /// No more than the distance of the surfaces, nor than `most`, by a gap that is found between each two
  /// triangles that are near: what it says is there, is [m]. 0 where they meet, or rounding could say so.
  double surfacesApart(const RigidTransform& sceneFromPart, double most) const;
  /// Decides all poses, on all processors, like doMeet for each. Poses that follow each other nearer than the
  /// bodies are apart (by surfacesApart or their boxes, and the motion of the corners of the part's box) cost
  /// next to nothing, so that every pose of a recording can be looked at.
  WayVerdicts along(std::span<const RigidTransform> sceneFromPart) const;
  /// The meetings of along().
  std::vector<char> meetings(std::span<const RigidTransform> sceneFromPart) const;

 private:
  class Follower;
  struct Bodies;
  std::unique_ptr<const Bodies> bodies_;
};

}  // namespace nearfit::test
