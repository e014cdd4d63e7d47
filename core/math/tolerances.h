#pragma once

namespace nearfit {

/// Two directions that differ by less count as one [rad]. Far above the rounding of a pose (1e-15) and of
/// normals of all but the thinnest slivers, far below what a mesh in single precision can mean (1e-7).
constexpr double kAngularTolerance = 1e-10;

/// Two lengths that differ by less, as a fraction of the scene's size, count as one. Some thousand roundings
/// of coordinates of that size.
constexpr double kLengthTolerance = 1e-12;

/// Rounding of a difference of two points, as a fraction of the scene's size: what a direction between two
/// points at a distance d can be wrong by is this over d.
constexpr double kPointRounding = 4e-16;

/// Minima whose points lie closer than this many tolerances are the same one, found by two neighbouring
/// features that both claim it at their common boundary.
constexpr double kMergeFactor = 8.0;

}  // namespace nearfit
