#pragma once

#include <filesystem>
#include <string>

#include "core/scene/scene.h"

namespace nearfit {

/// Where every part is, as JSON: version, date, units; for each part name, mesh path and SHA-256, 4x4 row-major
/// matrix, position and quaternion; for the moving part the least distance and the LMDs to each other visible
/// part within the scene's cutoff. The same program and scene give the same text but for the date.
/// @param worldFromMoving  Where the moving part is (it may be in hand, away from its pose in the scene).
std::string placementJson(const Scene& scene, const RigidTransform& worldFromMoving);

/// Writes placementJson atomically. Throws FileError.
void exportPlacement(const Scene& scene, const RigidTransform& worldFromMoving, const std::filesystem::path& file);

}  // namespace nearfit
