#pragma once

#include <string>

#include "core/scene/scene.h"

namespace nearfit {

/// A pose as a 4x4 matrix in text, for the clipboard: four lines of four numbers separated by blanks, row by
/// row, with the translation [m] in the last column. The last line is `0 0 0 1`. Coordinates are columns:
/// world = M * (x, y, z, 1). Numbers have the fewest digits that read back as the same double.
std::string matrixText(const RigidTransform& worldFromPart);

/// Poses of all parts as CSV (UTF-8, RFC 4180 except that lines end in a line feed): a header, then
/// one row per part.
///
/// Columns: `part`, `mesh` (absolute path), `sha256` of the mesh file, `metres_per_unit` of its numbers,
/// `visible` and `moving` (0 or 1), `tx ty tz` [m] and `qw qx qy qz` of worldFromPart, and its matrix row by
/// row, `m00 m01 ... m33`.
/// @param worldFromMoving  As for placementJson().
std::string placementCsv(const Scene& scene, const RigidTransform& worldFromMoving);

}  // namespace nearfit
