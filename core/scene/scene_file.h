#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "core/scene/scene.h"

/// The scene file `*.nearfit`, JSON in UTF-8:
///
///     {
///       "nearfit": 4,                                        version of this format
///       "units": {"length": "m", "force": "N", "time": "s"}, those and no others
///       "haptics": {
///         "mode": "proxy",                                   or "springs": the part goes where the hand is
///         "springs": {"cutoff": 0.01, "stiffness": 200, "damping": 0, "law": "linear"},   or "printed"
///         "proxy": {"margin": 1e-4, "friction": 0},
///         "coupling": {"automatic": true,                    the rest is not used, but kept, while it is
///         true
///                      "stiffness": 1000, "damping": 0, "rotationalStiffness": 1, "rotationalDamping": 0},
///         "weight": {"weight": false, "inertia": false,      whether they are felt
///                    "gravity": [0, 0, -9.80665]},           world frame [m/s^2]
///         "mapping": {"scale": 1,
///                     "orientation": [1, 0, 0, 0],           worldFromDevice, w x y z, unit
///                     "translationLocks": [false, false, false],   along the world's x, y, z
///                     "rotationLocks": [false, false, false]}      about them
///       },
///       "moving": "Peg",                                     a part's name, or null
///       "groups": [{
///         "name": "Frame",                                   not empty
///         "group": null,                                     that it is in: which of the groups before it,
///         from 0 "locked": false
///       }],
///       "parts": [{
///         "name": "Peg",                                     unique, not empty
///         "mesh": "meshes/peg.stl",                          from the scene file's folder, or from the root
///         "sha256": "9f86d0...",                             of the mesh file's bytes
///         "metresPerUnit": 0.001,                            of the mesh file's coordinates
///         "position": [0, 0, 0.05],                          worldFromPart [m]
///         "quaternion": [1, 0, 0, 0],                        worldFromPart, w x y z, unit
///         "colour": [0.62, 0.69, 0.76],                      sRGB, each 0 to 1
///         "density": 1000,                                   [kg/m^3]
///         "opacity": 1,                                      0.05 to 1
///         "pivot": null,                                     or [x, y, z] that the gizmo turns it about, in
///                                                            its frame [m]; null: its centre of mass
///         "visible": true,
///         "locked": false,
///         "group": 0,                                        that it is in: which of the groups, from 0, or
///         null "wasVisible": null                                 true or false while parts are isolated:
///         whether it was
///                                                            visible before; null: it came since, or none
///                                                            are
///       }]
///     }
///
/// Every key is needed. Keys that this version does not know are ignored, and are gone when the scene is
/// saved. Numbers are written with as many digits as it takes to read the same double again. Meanings and
/// limits of the settings: haptic_settings.h, haptic_limits.h.
///
/// Older versions are still read. Version 3 and those before have no "pivot": there it is the centre of
/// mass. Version 2 has no
/// "groups", and its parts none of "opacity", "group" and "wasVisible": they are opaque and stand at the top.
/// Version 1 is like version 2, but: it has no "haptics" and no "density", and its "springs" stand where
/// "haptics" do. What it does not say is as in a new scene, the margin a hundredth of its cutoff.
namespace nearfit {

/// Version of the scene file format that this program writes, and the oldest that it reads.
constexpr int kSceneFileVersion = 4, kOldestSceneFileVersion = 1;
constexpr std::size_t kMaxSceneFileBytes = 8U << 20U;
constexpr std::size_t kMaxSceneFileParts = 10'000;

/// The folder that mesh paths in a scene file start from: its own, symbolic links resolved.
std::filesystem::path meshFolder(const std::filesystem::path& sceneFile);

/// Reads a scene file and loads its meshes, each file and unit once. Nothing that it says is trusted: each
/// message names the field (`parts[3].position`) or the line and column. All fields are checked before a mesh
/// is loaded.
/// @param changedMeshes  Where it is given, a mesh file that is another than the scene was made with is read
///                       as it is now, and listed here; else that is an error.
/// Throws FileError (malformed, unknown version, missing or changed mesh), Cancelled.
Scene readSceneFile(const std::filesystem::path& file, const ProgressCallback& progress = {},
                    std::vector<std::filesystem::path>* changedMeshes = nullptr);

/// The text of the scene in a file of that name; nothing is written. Throws FileError.
std::string sceneFileText(const Scene& scene, const std::filesystem::path& file);

/// Writes atomically: a temporary file beside it, flushed to disk, then renamed. Throws FileError.
void writeSceneFile(const Scene& scene, const std::filesystem::path& file);

}  // namespace nearfit
