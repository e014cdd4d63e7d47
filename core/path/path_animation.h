#pragma once

#include <filesystem>
#include <string>

#include "core/path/assembly_path.h"
#include "core/scene/scene.h"

namespace nearfit {

/// A path as a glTF 2.0 animation in one binary file (.glb): meshes of the moving parts and of all other visible ones in
/// their colours, in metres, and a node that moves. glTF interpolates as the path does: that node has its origin at the
/// path's centre, with linear translation and spherical rotation; the moving parts are its children. A root node turns
/// z, which is up here, to y, which is up there. Time starts at 0.
///
/// Numbers are in single precision, as glTF has them; meshes are about the middle of their boxes. Poses whose times are
/// the same in single precision count once.
/// Throws UsageError as checkPath() and pathBodies(), or if the file would be larger than the format allows.
std::string pathGlb(const Scene& scene, const AssemblyPath& path);

/// Writes pathGlb() atomically. Throws FileError too.
void writePathGlb(const Scene& scene, const AssemblyPath& path, const std::filesystem::path& file);

}  // namespace nearfit
