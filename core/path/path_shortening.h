#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/path/assembly_path.h"
#include "core/path/path_certifier.h"

namespace nearfit {

/// A path through poses, with times at which no point moves faster than the radius of what moves in a second. Poses
/// that are the same follow each other once; turns too large for a path are halved.
/// @param frame   Parts and centre.
/// @param poses   worldFromLead; at least 2, of which two differ.
/// @param radius  Of what moves, about the centre [m]; > 0.
AssemblyPath timedPath(const AssemblyPath& frame, const std::vector<RigidTransform>& poses, double radius);

/// A shorter path between the same ends: leaves out poses, and replaces stretches between random places by single
/// motions, each only if it is proven free and shorter. Other motions stay as they are. Deterministic for a seed, apart
/// from the limit.
/// @param certifier  Of the same parts and centre.
/// @param isOver     True to stop with what was reached, also amid a proof. Asked by several threads, one at a time.
AssemblyPath shortenedPath(const AssemblyPath& path, const PathCertifier& certifier, std::uint64_t seed,
                           const std::function<bool()>& isOver);

}  // namespace nearfit
