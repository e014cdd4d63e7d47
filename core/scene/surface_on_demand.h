#pragma once

#include <memory>
#include <mutex>

#include "core/proximity/solidity.h"
#include "core/proximity/unsided_surface.h"

namespace nearfit {

/// The surface without sides of one mesh, made when it is first needed: only meshes that enclose nothing need
/// it, and what meets them. Any thread may ask; it waits for one that is making it.
class SurfaceOnDemand {
 public:
  /// As isSolidThroughout, found out once.
  bool isSolid(const TriangleMesh& mesh) {
    std::call_once(solidOnce_, [&] { isSolid_ = isSolidThroughout(mesh); });
    return isSolid_;
  }
  /// What was found out about the mesh before; nothing where it is known already.
  void setSolid(bool isSolid) {
    std::call_once(solidOnce_, [&] { isSolid_ = isSolid; });
  }

  std::shared_ptr<const UnsidedSurface> get(const TriangleMesh& mesh, const NormalConeTree& tree) {
    std::call_once(once_, [&] { surface_ = std::make_shared<const UnsidedSurface>(mesh, tree); });
    return surface_;
  }

 private:
  std::once_flag solidOnce_, once_;
  bool isSolid_ = false;
  std::shared_ptr<const UnsidedSurface> surface_;
};

}  // namespace nearfit
