#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "core/proximity/surface/surface_contacts.h"

namespace nearfit::test {

/// Tests listed pairs of triangles at a pose, in one go. See TriangleTests.
inline SurfaceContacts testTriangles(const UnsidedSurface& scene, const UnsidedSurface& part,
                                     const RigidTransform& sceneFromPart, double within,
                                     const HeldTriangles& held, std::span<SurfaceContact> out) {
  TriangleTests tests;
  tests.begin(
      {.scene = &scene, .part = &part, .sceneFromPart = sceneFromPart, .within = within, .held = held}, out);
  std::uint64_t work = std::numeric_limits<std::uint64_t>::max();
  tests.goOn(work);
  return tests.result();
}

}  // namespace nearfit::test
