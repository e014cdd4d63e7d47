#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "tests/bench/hand_path.h"
#include "tests/bench/query_method.h"

namespace nearfit::bench {

/// A hand's path for a scene. Distances come from Nearfit's cold query, whose answers the run then compares
/// with those of the other methods; `options`'s reach, start and range are filled in, its cutoff where it is
/// 0, and no turn where the scene says so.
std::vector<RigidTransform> makePath(const PreparedScene& scene, HandPathOptions options);

/// The bodies of a scene as a path asks for them.
PathBodies pathBodies(const BenchScene& scene);

/// CSV as readPosePath reads it: tx,ty,tz,qw,qx,qy,qz, each number the shortest that reads back the same.
/// Throws FileError.
void writePath(const std::filesystem::path& file, std::span<const RigidTransform> path);

}  // namespace nearfit::bench
