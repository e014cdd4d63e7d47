#include "core/mesh/exact_surface.h"

#include <cstddef>

namespace nearfit {

void turnFaces(std::span<ExactSurface> faces, std::span<const double> agreement) noexcept {
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (agreement[i] >= 0.0) continue;
    ExactSurface& surface = faces[i];
    if (surface.kind == SurfaceKind::Plane)
      surface.direction = -surface.direction;
    else
      surface.isHollow = !surface.isHollow;
  }
}

}  // namespace nearfit
