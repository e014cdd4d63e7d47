#pragma once

namespace nearfit {

/// Directions that differ by less than this count as equal [rad]. Far above the rounding of a pose
/// (1e-15) and of the normals of all but the thinnest slivers; far below what a single-precision mesh can
/// express (1e-7).
constexpr double kAngularTolerance = 1e-10;

/// Faces and edges that are parallel to within this touch in a flat region [rad]. Faces drawn parallel stay
/// parallel to about this in single precision (coordinates rounded by 6e-8 of the mesh's size, over faces
/// some fifteenth of it), and so do typed poses. The error that this allows is below the mesh's own.
constexpr double kFlatTolerance = 1e-6;

/// Pieces of a flat region at most this far apart are connected, as a fraction of the smaller body's size.
/// Rounding can open such gaps between faces that were drawn in one plane without shared vertices.
constexpr double kFlatGap = 2e-7;

/// Max difference between directions within one flat region [rad]. Directions at its rim differ by this much
/// where edges cross at a small angle.
constexpr double kRegionDirection = 1e-3;

/// Lengths that differ by less than this fraction of the scene's size count as equal. Some thousand roundings
/// of coordinates of that size.
constexpr double kLengthTolerance = 1e-12;

/// Max error of a computed distance, as a fraction of the scene's size; reached over the thinnest slivers.
constexpr double kDistanceTolerance = 1e-11;

/// Rounding of the difference of two points, as a fraction of the scene's size. The direction between two
/// points is uncertain by this over their distance.
constexpr double kPointRounding = 4e-16;

/// Up to this many sizes from the origin, double precision loses nothing that matters. Beyond, the relative
/// pose of two bodies is computed in extended precision.
constexpr double kNearOrigin = 100.0;

/// Minima whose points are closer than this many tolerances are the same one: two neighbouring features both
/// claim it at their common boundary.
constexpr double kMergeFactor = 8.0;

}  // namespace nearfit
