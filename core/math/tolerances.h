#pragma once

namespace nearfit {

/// Two directions that differ by less count as one [rad]. Far above the rounding of a pose (1e-15) and of
/// normals of all but the thinnest slivers, far below what a mesh in single precision can mean (1e-7).
constexpr double kAngularTolerance = 1e-10;

/// Faces and edges that are parallel to this touch in a flat region [rad]: what single precision leaves of
/// the parallelism of faces that were drawn parallel (coordinates rounded by 6e-8 of the mesh's size, over
/// faces some fifteenth of it), and of poses that were typed. The error that this allows is below the mesh's
/// own.
constexpr double kFlatTolerance = 1e-6;

/// Pieces of flat regions that are no farther apart than this fraction of the smaller body are connected:
/// what that rounding can open between faces that were drawn in one plane without sharing vertices.
constexpr double kFlatGap = 2e-7;

/// How far directions may differ within what counts as one flat region [rad]: those of points at its rim do
/// where edges cross at a small angle.
constexpr double kRegionDirection = 1e-3;

/// Two lengths that differ by less, as a fraction of the scene's size, count as one. Some thousand roundings
/// of coordinates of that size.
constexpr double kLengthTolerance = 1e-12;

/// What a distance that is found may be off by at most, as a fraction of the scene's size: over the thinnest
/// slivers.
constexpr double kDistanceTolerance = 1e-11;

/// Rounding of a difference of two points, as a fraction of the scene's size: what a direction between two
/// points at a distance d can be wrong by is this over d.
constexpr double kPointRounding = 4e-16;

/// Coordinates up to this many sizes from the origin lose nothing in double precision that matters; poses of
/// bodies beyond are made relative to them in extended precision.
constexpr double kNearOrigin = 100.0;

/// Minima whose points lie closer than this many tolerances are the same one, found by two neighbouring
/// features that both claim it at their common boundary.
constexpr double kMergeFactor = 8.0;

}  // namespace nearfit
