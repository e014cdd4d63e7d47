#pragma once

#include <memory>
#include <mutex>

#include "core/proximity/surface/solidity.h"
#include "core/proximity/surface/unsided_surface.h"

namespace nearfit {

/// Solidity and unsided surface of one mesh, each determined when first needed. Only meshes that enclose
/// nothing, and parts near them, need the surface. Thread-safe: one thread builds, others wait for it.
class SurfaceOnDemand {
 public:
  /// isSolidThroughout() of `mesh`, computed once.
  bool isSolid(const TriangleMesh& mesh) {
    std::call_once(solidOnce_, [&] { isSolid_ = isSolidThroughout(mesh); });
    return isSolid_;
  }
  /// Supplies the result in advance, such as from the cache; no-op if already known.
  void setSolid(bool isSolid) {
    std::call_once(solidOnce_, [&] { isSolid_ = isSolid; });
  }

  /// The unsided surface of `mesh`, which must be the same mesh in each call.
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
