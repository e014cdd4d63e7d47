#pragma once

#include <filesystem>
#include <string>

#include "core/scene/scene.h"

// clang-format off
/// The placement export, JSON in UTF-8:
///
///     {
///       "placement": 1,                                    format version
///       "program": "Nearfit 0.1.0",
///       "date": "2026-01-31T12:00:00Z",                    UTC, ISO 8601
///       "units": {"length": "m", "volume": "m^3"},
///       "moving": "Peg",                                   name of the moving part, or null; of a moving group that
///                                                          of the part that leads
///       "movingGroup": {"name": "Gripper", "parts": ["Peg", "Jaw"]},   or null if no group is in hand
///       "parts": [{
///         "name": "Peg",
///         "mesh": "/home/me/peg.stl",                      absolute
///         "sha256": "9f86d0...",                           of the mesh file's bytes
///         "shape": "0:1:1:2",                              of a CAD document only: key of the shape
///         "metresPerUnit": 0.001,                          of the mesh file's coordinates
///         "visible": true,
///         "matrix": [[...], [...], [...], [0, 0, 0, 1]],   worldFromPart by rows; last column: translation
///         "position": [0, 0, 0.05],                        worldFromPart
///         "quaternion": [1, 0, 0, 0]                       worldFromPart, w x y z, unit
///       }],
///       "clearance": {                                     null if there is no moving part
///         "cutoff": 0.01,                                  range of the search
///         "distance": 0.002,                               min of all below; null if all exceed the cutoff
///         "mass": {"basis": "volume integrals",            or "oriented box"
///                  "volume": 1e-6, "centre": [0, 0, 0.05]},
///         "to": [{                                         each other visible part, not of the moving group
///           "part": "Hole",
///           "distance": 0.002,                             null if nothing is within the cutoff
///           "complete": true,                              false if the search could not hold all minima
///           "lmds": [{"distance": 0.002, "moving": [x, y, z], "other": [x, y, z],
///                     "part": "Peg",                       of the moving group; missing for a part alone
///                     "features": ["face", "face"], "region": true, "blocked": false, "marginal": false,
///                     "extent": {"dimension": 2, "measure": 4e-4, "axis": [x, y, z],
///                                "half": [0.02, 0.005]}}]
///         }]
///       }
///     }
///
/// All points, axes, poses and the centre of mass are in the world frame. Distances are between surfaces.
/// "features" are the moving part's, then the other's. A region is a flat set of equal minima, represented by
/// its centroid. Its "extent" is its area (dimension 2) or length (1), and half lengths along an axis and
/// across it. A minimum is blocked if the segment between its points passes through a surface; it is marginal
/// if double precision cannot decide that it is a minimum. Numbers have the fewest digits that read back as
/// the same double.
// clang-format on
namespace nearfit {

/// Returns the placement export. It is deterministic except for the date. Blocking: builds
/// missing hierarchies.
/// @param worldFromMoving  Present pose of the moving part, which may be in the hand, away from its pose in
///                         the scene. Unused if there is no moving part.
/// Throws UsageError if the pose is invalid (checkedPose).
std::string placementJson(const Scene& scene, const RigidTransform& worldFromMoving);

/// Writes placementJson() atomically. Throws like placementJson(); FileError.
void exportPlacement(const Scene& scene, const RigidTransform& worldFromMoving,
                     const std::filesystem::path& file);

}  // namespace nearfit
