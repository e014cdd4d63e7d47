#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "app/import/solid_bodies.h"

namespace nearfit::importer {

/// Indices of bodies that share faces or edges, into which OpenCASCADE writes their triangles: one after the other, on one
/// thread at a time.
using BodyGroup = std::vector<std::size_t>;

/// The order in which bodies are meshed.
struct MeshingPlan {
  std::vector<BodyGroup> large;  ///< One at a time: each has faces enough for all threads.
  std::vector<BodyGroup> small;  ///< Each on one thread, several at a time. Most faces first.
};

/// Plans the meshing of bodies: faces of one body are often too few to keep all threads at work.
/// @param threads  That mesh; at least 1.
MeshingPlan planMeshing(std::span<const Body* const> bodies, std::size_t threads);

}  // namespace nearfit::importer
