#pragma once

#include <filesystem>
#include <string>

#include "core/scene/scene.h"

// clang-format off
/// The placement export, JSON in UTF-8:
///
///     {
///       "placement": 1,                                    version of this format
///       "program": "Nearfit 0.1.0",
///       "date": "2026-01-31T12:00:00Z",                    UTC, ISO 8601
///       "units": {"length": "m", "volume": "m^3"},
///       "moving": "Peg",                                   a part's name, or null
///       "parts": [{
///         "name": "Peg",
///         "mesh": "/home/me/peg.stl",                      absolute
///         "sha256": "9f86d0...",                           of the mesh file's bytes
///         "metresPerUnit": 0.001,                          of the mesh file's coordinates
///         "visible": true,
///         "matrix": [[...], [...], [...], [0, 0, 0, 1]],   worldFromPart by rows; translation in the last column
///         "position": [0, 0, 0.05],                        worldFromPart
///         "quaternion": [1, 0, 0, 0]                       worldFromPart, w x y z, unit
///       }],
///       "clearance": {                                     null when there is no moving part
///         "cutoff": 0.01,                                  nothing farther than this is looked for
///         "distance": 0.002,                               the least of all below; null when nothing is that near
///         "mass": {"basis": "volume integrals",            or "oriented box"
///                  "volume": 1e-6, "centre": [0, 0, 0.05]},
///         "to": [{                                         each other visible part
///           "part": "Hole",
///           "distance": 0.002,                             null when nothing is within the cutoff
///           "complete": true,                              false when there are more minima than the search holds
///           "lmds": [{"distance": 0.002, "moving": [x, y, z], "other": [x, y, z],
///                     "features": ["face", "face"], "region": true, "blocked": false,
///                     "extent": {"dimension": 2, "measure": 4e-4, "axis": [x, y, z], "half": [0.02, 0.005]}}]
///         }]
///       }
///     }
///
/// All points, axes and poses are in the world frame; "features" are the moving part's, then the other's; a
/// region is a flat set of equal minima, for which its centroid stands, and has an "extent": area (dimension 2)
/// or length (1), and half lengths along an axis and across it. The way between the points of a blocked minimum
/// is barred by another part of either surface. The mass centre is in the world frame. Distances are between
/// surfaces. Numbers have as many digits as it takes to read the same double again.
// clang-format on
namespace nearfit {

/// @param worldFromMoving  Where the moving part is (it may be in hand, away from its pose in the scene).
/// Unused
///                         when the scene has no moving part. Throws UsageError when it is no pose
///                         (checkedPose).
/// The same program and scene give the same text but for the date.
std::string placementJson(const Scene& scene, const RigidTransform& worldFromMoving);

/// Writes placementJson atomically. Throws FileError.
void exportPlacement(const Scene& scene, const RigidTransform& worldFromMoving,
                     const std::filesystem::path& file);

}  // namespace nearfit
