#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "core/scene/scene.h"

/// The scene file `*.nearfit`, JSON in UTF-8:
///
///     {
///       "nearfit": 7,                                        format version
///       "units": {"length": "m", "force": "N", "time": "s"}, always these
///       "haptics": {
///         "mode": "proxy",                                   or "springs": the part is at the handle
///         "springs": {"cutoff": 0.01, "stiffness": 200, "damping": 0,
///                     "law": "linear",                       or "printed"
///                     "onePerArea": true},                   optional, false if not there: a spring for each area of contact
///         "proxy": {"margin": 1e-4, "friction": 0},
///         "coupling": {"automatic": true,                    if true, the numbers below are kept but unused
///                      "stiffness": 1000, "damping": 0, "rotationalStiffness": 1, "rotationalDamping": 0},
///         "weight": {"weight": false, "inertia": false,      whether they can be felt
///                    "gravity": [0, 0, -9.80665]},           world frame [m/s^2]
///         "mapping": {"scale": 1,
///                     "orientation": [1, 0, 0, 0],           worldFromDevice, w x y z, unit
///                     "translationLocks": [false, false, false],   along the world's x, y, z
///                     "rotationLocks": [false, false, false]}      about the world's x, y, z
///       },
///       "moving": "Peg",                                     name of the moving part, or null
///       "movingGroup": null,                                 index of the moving group; "moving" is null then
///       "groups": [{
///         "name": "Frame",                                   not empty
///         "group": null,                                     parent: index of an earlier group, or null
///         "locked": false,
///         "age": 0                                           optional, for all groups or none: place from the oldest
///                                                            to the newest; as in the file if not there
///       }],
///       "parts": [{
///         "name": "Peg",                                     unique, not empty
///         "mesh": "meshes/peg.stl",                          absolute, or from the scene file's folder
///         "sha256": "9f86d0...",                             of the mesh file's bytes
///         "metresPerUnit": 0.001,                            of the mesh file's coordinates; 1 for a CAD document that
///                                                            stores its unit
///         "shape": {"key": "0:1:1:2",                        of a CAD document: which of its shapes, and the
///                   "chord": 0, "angle": 0},                 tessellation that was asked for [m, rad], 0 if it is
///                                                            chosen from the shape's size; null for a mesh file
///         "repairs": [{                                      made to the mesh after it is read, in this order
///           "kind": "weld",                                  or "stitch", "clean", "orient", "fillHoles",
///                                                            "dropShells": see mesh_repair.h
///           "size": 1e-5                                     [m]; 0 for "clean" and "orient"
///         }],
///         "position": [0, 0, 0.05],                          worldFromPart [m]
///         "quaternion": [1, 0, 0, 0],                        worldFromPart, w x y z, unit
///         "colour": [0.62, 0.69, 0.76],                      sRGB, each 0 to 1
///         "density": 1000,                                   [kg/m^3]
///         "opacity": 1,                                      0.05 to 1
///         "pivot": null,                                     [x, y, z] in the part's frame [m], or null for
///                                                            the centre of mass
///         "visible": true,
///         "locked": false,
///         "group": 0,                                        index of the part's group, or null
///         "wasVisible": null                                 during isolation: visibility before it; null
///                                                            otherwise, and for parts added since
///       }],
///       "joints": [{
///         "kind": "axis",                                    or "plane", "point"
///         "part": "Peg",                                     name of the part that is kept
///         "base": "Hole",                                    name of the part that it is kept on, or null for
///                                                            the world
///         "onPart": {"point": [0, 0, 0],                     in the part's frame [m]
///                    "direction": [0, 0, 1]},                unit; an outward normal for "plane"; not for "point"
///         "onBase": {"point": [0, 0, 0],                     the same in the base's frame
///                    "direction": [0, 0, 1]},
///         "on": true
///       }],
///       "pairRules": [{                                      for checks of the scene
///         "kind": "pressFit",                                or "leaveOut", "sameGroup", "touching": see pair_rule.h
///         "part": "Bolt*",                                   patterns for the names of the two parts:
///         "other": "Plate",                                  see name_pattern.h; "*" for "sameGroup"
///         "interference": 2e-5                               [m]; 0 for the others
///       }],
///       "pairRecords": [{                                    what the last check found, see pair_record.h
///         "part": 0,                                         indices of the two parts, in ascending order
///         "other": 3,
///         "verdict": "clash",                                or "clear", "near", "touching", "contained"
///         "distance": 0,                                     [m]
///         "depth": 1.5e-5,                                   [m], or null
///         "state": "accepted",                               or "new", "fixed"
///         "reason": "pressed in"                             why it is accepted
///       }]
///     }
///
/// All keys but those marked as optional are required. Unknown keys are ignored, and lost when the scene is saved. Numbers have enough
/// digits to read back as the same double. For the meaning and limits of the settings see haptic_settings.h
/// and haptic_limits.h.
///
/// Older versions can still be read:
/// - Version 6 has no "pairRules" and no "pairRecords".
/// - Version 5 also has no "shape" (all files are mesh files), no "repairs" and no "movingGroup": a part is in hand, or none.
/// - Version 4 also has no "joints".
/// - Version 3 also has no "pivot": parts turn about their centre of mass.
/// - Version 2 also has no "groups", and parts have no "opacity", "group" and "wasVisible": they are opaque
///   and at the top level.
/// - Version 1 also has no "haptics" and no "density"; "springs" is at the top level. Missing settings are
///   those of a new scene, except the margin, which is a hundredth of the cutoff.
namespace nearfit {

/// Version that this program writes, and oldest version that it reads.
constexpr int kSceneFileVersion = 7, kOldestSceneFileVersion = 1;
/// Limits on the size of a scene file [bytes], which leaves room for the largest number of parts, and on that number.
constexpr std::size_t kMaxSceneFileBytes = 16U << 20U;
constexpr std::size_t kMaxSceneFileParts = 10'000;

/// Folder that relative mesh paths start from: the scene file's own, with symbolic links resolved.
std::filesystem::path meshFolder(const std::filesystem::path& sceneFile);

/// Reads a scene file and loads its meshes, each file, unit, shape and tessellation once for the same repairs. Checks
/// every field before loading any mesh; error messages name the field (`parts[3].position`) or the line and column.
/// @param changedMeshes  If not null, mesh files whose SHA-256 differs from the scene's are loaded as they
///                       are now and listed here. If null, such a file is an error.
/// Throws FileError (malformed, unknown version, missing or changed mesh), Cancelled.
Scene readSceneFile(const std::filesystem::path& file, const ProgressCallback& progress = {},
                    std::vector<std::filesystem::path>* changedMeshes = nullptr);

/// Text of the scene, with mesh paths relative to the folder of `file`, which is not written. Throws
/// FileError if a path is not UTF-8.
std::string sceneFileText(const Scene& scene, const std::filesystem::path& file);

/// Writes the scene atomically: a temporary file beside the target, flushed to disk, then renamed.
/// Throws FileError.
void writeSceneFile(const Scene& scene, const std::filesystem::path& file);

}  // namespace nearfit
