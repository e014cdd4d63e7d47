#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/math/rigid_transform.h"
#include "core/mesh/triangle_mesh.h"

namespace nearfit::test {

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
  /// Of all poses, on all processors: by pose, 1 where they meet.
  std::vector<char> meetings(std::span<const RigidTransform> sceneFromPart) const;

 private:
  struct Bodies;
  std::unique_ptr<const Bodies> bodies_;
};

}  // namespace nearfit::test
