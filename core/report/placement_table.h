#pragma once

#include <string>

#include "core/scene/scene.h"

namespace nearfit {

/// A pose as a 4x4 matrix in text, for the clipboard: four lines of four numbers with blanks between them, by
/// rows, the translation [m] in the last column, the last line `0 0 0 1`. It maps the part's coordinates to
/// the world's as columns do: world = M * (x, y, z, 1). Numbers have as many digits as it takes to read the
/// same double again.
std::string matrixText(const RigidTransform& worldFromPart);

/// Where each part is, as CSV (UTF-8, RFC 4180 but for line ends, which are a line feed): a header, then a
/// row a part.
///
/// `part` and `mesh` (the absolute path), `sha256` of the mesh file, `metres_per_unit` of its numbers,
/// `visible` and `moving` (0 or 1), `tx ty tz` [m] and `qw qx qy qz` of worldFromPart, and its matrix by rows
/// `m00 m01 ... m33`.
/// @param worldFromMoving  As placementJson has it.
std::string placementCsv(const Scene& scene, const RigidTransform& worldFromMoving);

}  // namespace nearfit
