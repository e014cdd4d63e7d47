#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace nearfit {

/// A group or a part in an exported assembly.
struct AssemblyNode {
  std::int32_t parent = -1;  ///< Index of a group before it; -1 at the top level.
  std::string name;
  Scene::PartPtr part;         ///< Null for a group, whose frame is the world's.
  std::int32_t geometry = -1;  ///< Index into AssemblyTree::geometries; -1 for a group.
};

/// Parts of a scene with the groups around them, as formats of assemblies take them.
struct AssemblyTree {
  std::vector<AssemblyNode> nodes;          ///< Groups before their members.
  std::vector<PartGeometryPtr> geometries;  ///< Each once, however many parts have it.
  std::vector<std::uint32_t> uses;          ///< By geometry: number of its parts; 1 or more.
};

/// The tree of these parts, groups without any of them left out. Parts share a geometry also if it was loaded several
/// times. Throws UsageError if there are no parts.
/// @param parts  Of the scene, with geometry; see chosenParts().
AssemblyTree assemblyTree(const Scene& scene, std::span<const Scene::PartPtr> parts);

/// A name for the root of an assembly: the file's without its extension, as printable UTF-8; "assembly" if it is empty.
std::string assemblyName(const std::filesystem::path& file);

/// A name for a geometry: its shape's key, or its mesh file's name without its extension; printable UTF-8, not empty.
std::string geometryName(const PartGeometry& geometry);

}  // namespace nearfit
