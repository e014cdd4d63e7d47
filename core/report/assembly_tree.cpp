#include "core/report/assembly_tree.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/scene/scene_tree.h"
#include "core/text/utf8.h"

namespace nearfit {
namespace {

/// Where a geometry came from. A scene may have loaded one several times.
std::string originOf(const PartGeometry& geometry) {
  return fmt::format("{}\n{}\n{}\n{}\n{} {}\n{}", geometry.file.string(), geometry.sha256,
                     geometry.metresPerUnit, geometry.shapeKey, geometry.effectiveTessellation.chord,
                     geometry.effectiveTessellation.angle, textOf(geometry.repairs));
}

/// True if geometries of one origin are the same: a file may have changed between two loads.
bool isSameGeometry(const PartGeometry& a, const PartGeometry& b) {
  return &a == &b ||
         (a.faceColours == b.faceColours &&
          (a.mesh.sharesArraysOf(b.mesh) || (std::ranges::equal(a.mesh.vertices(), b.mesh.vertices()) &&
                                             std::ranges::equal(a.mesh.triangles(), b.mesh.triangles()))));
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

/// Lists geometries, each once.
class GeometryList {
 public:
  explicit GeometryList(AssemblyTree& tree) : tree_(tree) {}

  /// Counts a use too.
  std::int32_t indexOf(const PartGeometryPtr& geometry) {
    const auto [at, isNew] = byPointer_.try_emplace(geometry.get(), -1);
    if (isNew) at->second = find(geometry);
    ++tree_.uses[static_cast<std::size_t>(at->second)];
    return at->second;
  }

 private:
  std::int32_t find(const PartGeometryPtr& geometry) {
    std::vector<std::int32_t>& candidates = byOrigin_[originOf(*geometry)];
    for (const std::int32_t known : candidates)
      if (isSameGeometry(*tree_.geometries[static_cast<std::size_t>(known)], *geometry)) return known;
    candidates.push_back(static_cast<std::int32_t>(tree_.geometries.size()));
    tree_.geometries.push_back(geometry);
    tree_.uses.push_back(0);
    return candidates.back();
  }

  AssemblyTree& tree_;
  std::map<const PartGeometry*, std::int32_t> byPointer_;
  std::map<std::string, std::vector<std::int32_t>> byOrigin_;
};

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
  GeometryList geometries(tree);
  for (const Scene::PartPtr& part : parts)
    tree.nodes.push_back({nodeAt(part->group), part->name, part, geometries.indexOf(part->geometry)});
  return tree;
}

std::string assemblyName(const std::filesystem::path& file) {
  return printableName(file.stem(), "assembly");
}

std::string geometryName(const PartGeometry& geometry) {
  return geometry.shapeKey.empty() ? printableName(geometry.file.stem(), "mesh") : geometry.shapeKey;
}

}  // namespace nearfit
