#pragma once

#include <filesystem>

#include "core/scene/scene.h"

namespace nearfit {

/// The scene with a file for each mesh that has none (builtGeometry()), so that it can be saved: written as PLY in metres, in
/// double precision, to a folder beside the scene file, `fit_meshes` for `fit.nearfit`, under the first digits of
/// meshSha256(). A mesh that is there already is written again. Parts of one mesh share its file.
/// Throws FileError.
Scene withMeshFiles(const Scene& scene, const std::filesystem::path& sceneFile);

}  // namespace nearfit
