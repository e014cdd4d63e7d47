#pragma once

#include <cstdint>
#include <filesystem>

#include "core/report/clearance_map.h"

namespace nearfit {

/// Writes a map as PLY, atomically: binary, little endian, its surfaces as one mesh in the world frame where they were
/// measured. Only triangles with a corner within the range are written: the rest of a large part may be most of it.
/// Returns the size of the file [bytes].
///
/// A vertex has `x y z` (double, in the unit given), `nx ny nz` (float), `red green blue` (uchar, as in the view; beyond
/// the range the colour of its part), `distance` (double, in that unit too; `nan` beyond the range) and `part` (uint:
/// the place of its part among the `part` comments of the header, from 0). The header names the unit, and a comment of
/// its own that of `distance`. Along sharp edges there are vertices for either side.
/// @param scene          Gives names and colours.
/// @param metresPerUnit  Unit of coordinates and distances [m].
/// Throws FileError; UsageError (invalid unit, nothing within the range, more vertices than the format can count);
/// Cancelled, which keeps the old file. Blocking.
std::uint64_t exportClearanceMap(const ClearanceMap& map, const Scene& scene, double metresPerUnit,
                                 const std::filesystem::path& file, const ProgressCallback& progress = {});

}  // namespace nearfit
