#pragma once

#include <filesystem>

#include "core/scene/scene.h"

namespace nearfit {

/// Version of the scene file format that this program writes, and the only one it reads.
constexpr int kSceneFileVersion = 1;

/// Reads a `*.nearfit` file (JSON) and loads its meshes, each file once. Mesh paths are relative to the scene
/// file. Throws FileError (malformed, unknown version, missing or changed mesh), Cancelled.
Scene readSceneFile(const std::filesystem::path& file, const ProgressCallback& progress = {});

/// Writes atomically: a temporary file beside it, flushed to disk, then renamed. Throws FileError.
void writeSceneFile(const Scene& scene, const std::filesystem::path& file);

}  // namespace nearfit
