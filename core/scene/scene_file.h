#pragma once

#include <cstddef>
#include <filesystem>

#include "core/scene/scene.h"

/// The scene file `*.nearfit`, JSON in UTF-8:
///
///     {
///       "nearfit": 1,                                        version of this format
///       "units": {"length": "m", "force": "N", "time": "s"}, those and no others
///       "springs": {"cutoff": 0.01, "stiffness": 200, "damping": 0, "law": "linear"},   or "printed"
///       "moving": "Peg",                                     a part's name, or null
///       "parts": [{
///         "name": "Peg",                                     unique, not empty
///         "mesh": "meshes/peg.stl",                          from the scene file's folder, or from the root
///         "sha256": "9f86d0...",                             of the mesh file's bytes
///         "metresPerUnit": 0.001,                            of the mesh file's coordinates
///         "position": [0, 0, 0.05],                          worldFromPart [m]
///         "quaternion": [1, 0, 0, 0],                        worldFromPart, w x y z, unit
///         "colour": [0.62, 0.69, 0.76],                      sRGB, each 0 to 1
///         "visible": true,
///         "locked": false
///       }]
///     }
///
/// Every key is needed. Keys that this version does not know are ignored, and are gone when the scene is
/// saved. Numbers are written with as many digits as it takes to read the same double again.
namespace nearfit {

/// Version of the scene file format that this program writes, and the only one it reads.
constexpr int kSceneFileVersion = 1;
constexpr std::size_t kMaxSceneFileBytes = 8U << 20U;
constexpr std::size_t kMaxSceneFileParts = 10'000;

/// The folder that mesh paths in a scene file start from: its own, symbolic links resolved.
std::filesystem::path meshFolder(const std::filesystem::path& sceneFile);

/// Reads a scene file and loads its meshes, each file and unit once. Nothing that it says is trusted: each
/// message names the field (`parts[3].position`) or the line and column. All fields are checked before a mesh
/// is loaded. Throws FileError (malformed, unknown version, missing or changed mesh), Cancelled.
Scene readSceneFile(const std::filesystem::path& file, const ProgressCallback& progress = {});

/// Writes atomically: a temporary file beside it, flushed to disk, then renamed. Throws FileError.
void writeSceneFile(const Scene& scene, const std::filesystem::path& file);

}  // namespace nearfit
