#include "core/report/assembly_tree.h"

#include <map>
#include <set>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/scene/scene_tree.h"
#include "core/text/utf8.h"

namespace nearfit {
namespace {

/// Equal for geometries with the same mesh and colours, which a scene may have loaded one by one.
std::string identityOf(const PartGeometry& geometry) {
  if (geometry.sha256.empty()) return fmt::format("{}", static_cast<const void*>(&geometry));
  return fmt::format("{}\n{}\n{}\n{}\n{} {}\n{}", geometry.file.string(), geometry.sha256,
                     geometry.metresPerUnit, geometry.shapeKey, geometry.effectiveTessellation.chord,
                     geometry.effectiveTessellation.angle, textOf(geometry.repairs));
}

std::set<GroupId> groupsAround(const Scene& scene, std::span<const Scene::PartPtr> parts) {
  std::set<GroupId> groups;
  for (const Scene::PartPtr& part : parts) {
    for (std::optional<GroupId> at = part->group; at && groups.insert(*at).second;
         at = scene.findGroup(*at)->parent) {
    }
  }
  return groups;
}

std::string printableName(const std::filesystem::path& stem, const char* otherwise) {
  const std::string name = stem.string();
  if (name.empty()) return otherwise;
  return isPrintableUtf8(name) ? name : printableText(name);
}

}  // namespace

AssemblyTree assemblyTree(const Scene& scene, std::span<const Scene::PartPtr> parts) {
  if (parts.empty()) throw UsageError("export", "there is nothing to write", "select parts, or show some");
  AssemblyTree tree;
  const std::set<GroupId> groups = groupsAround(scene, parts);
  std::map<GroupId, std::int32_t> nodeOf;
  const auto nodeAt = [&](std::optional<GroupId> group) { return group ? nodeOf.at(*group) : -1; };
  visitGroups(scene, [&](const Group& group, std::size_t) {
    if (!groups.contains(group.id)) return;
    nodeOf.emplace(group.id, static_cast<std::int32_t>(tree.nodes.size()));
    tree.nodes.push_back({nodeAt(group.parent), group.name, nullptr, -1});
  });
  std::map<std::string, std::int32_t> known;
  for (const Scene::PartPtr& part : parts) {
    const auto [at, isNew] =
        known.emplace(identityOf(*part->geometry), static_cast<std::int32_t>(tree.geometries.size()));
    if (isNew) {
      tree.geometries.push_back(part->geometry);
      tree.uses.push_back(0);
    }
    ++tree.uses[static_cast<std::size_t>(at->second)];
    tree.nodes.push_back({nodeAt(part->group), part->name, part, at->second});
  }
  return tree;
}

std::string assemblyName(const std::filesystem::path& file) {
  return printableName(file.stem(), "assembly");
}

std::string geometryName(const PartGeometry& geometry) {
  return geometry.shapeKey.empty() ? printableName(geometry.file.stem(), "mesh") : geometry.shapeKey;
}

}  // namespace nearfit
