#pragma once

#include <memory>
#include <mutex>

#include "core/proximity/unsided_surface.h"

namespace nearfit {

/// The surface without sides of one mesh, made when it is first needed: only meshes that enclose nothing need
/// it, and what meets them. Any thread may ask; it waits for one that is making it.
class SurfaceOnDemand {
 public:
  std::shared_ptr<const UnsidedSurface> get(const TriangleMesh& mesh, const NormalConeTree& tree) {
    std::call_once(once_, [&] { surface_ = std::make_shared<const UnsidedSurface>(mesh, tree); });
    return surface_;
  }

 private:
  std::once_flag once_;
  std::shared_ptr<const UnsidedSurface> surface_;
};

}  // namespace nearfit
