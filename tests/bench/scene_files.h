#pragma once

#include <filesystem>

#include "core/scene/scene.h"
#include "tests/bench/many_parts.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::bench {

/// "part 1", "part 2" and so on; parts of one mesh share a geometry, whose hierarchy is not built yet.
Scene sceneOf(const ManyPartsScene& many);

/// Writes a scene and its meshes, each once, as OBJ with exact coordinates. Returns the scene file.
std::filesystem::path writeWithMeshes(const Scene& scene, const test::TemporaryFolder& folder);

}  // namespace nearfit::bench
