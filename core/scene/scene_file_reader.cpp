#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/scene/scene_file.h"
#include "core/scene/scene_file_haptics.h"
#include "core/scene/scene_file_parts.h"
#include "core/text/json_file.h"
#include "core/text/utf8.h"

namespace nearfit {
namespace {

namespace fs = std::filesystem;

int readVersion(const JsonField& root) {
  if (!root.has("nearfit"))
    root.fail("it is not a Nearfit scene: the key \"nearfit\" is missing", "open a *.nearfit file");
  const JsonField field = root.at("nearfit");
  const double version = field.number();
  for (int known = kOldestSceneFileVersion; known <= kSceneFileVersion; ++known) {
    if (version == known) return known;
  }
  field.fail(fmt::format("this is version {} of the scene format, but this program reads versions {} to {}",
                         version, kOldestSceneFileVersion, kSceneFileVersion),
             version > kSceneFileVersion ? "open it with a newer Nearfit"
                                         : "save it again with the Nearfit that made it");
}

void checkUnits(const JsonField& units) {
  constexpr std::array<std::array<const char*, 2>, 3> kUnits{
      {{"length", "m"}, {"force", "N"}, {"time", "s"}}};
  for (const auto& [quantity, unit] : kUnits) {
    const JsonField field = units.at(quantity);
    if (field.text(16) != unit) field.fail("this unit is not known", fmt::format("give values in {}", unit));
  }
}

/// Loads meshes, each file and unit once.
class GeometryLoader {
 public:
  /// @param changed  Receives the files whose SHA-256 differs from the scene's; if null, such files fail.
  /// Throws FileError if a mesh file is missing; Cancelled.
  GeometryLoader(const std::vector<PartEntry>& entries, const ProgressCallback& progress,
                 std::vector<fs::path>* changed)
      : changed_(changed) {
    std::vector<MeshSource> sources;
    for (const PartEntry& entry : entries) {
      if (!indices_.emplace(keyOf(entry), sources.size()).second) continue;
      checkExists(entry);
      sources.push_back({entry.mesh, entry.metresPerUnit, changed != nullptr ? std::string() : entry.sha256});
    }
    loaded_ = loadPartGeometries(sources, progress);
  }

  PartGeometryPtr geometryOf(const PartEntry& entry) {
    const LoadedPart& loaded = loaded_[indices_.at(keyOf(entry))];
    try {
      if (loaded.problem) std::rethrow_exception(loaded.problem);
    } catch (const Error& e) {
      entry.field.at("mesh").fail(e.where() + ": " + e.problem(), e.remedy());
    }
    if (loaded.geometry && loaded.geometry->sha256 == entry.sha256) return loaded.geometry;
    // Geometry is null only if the required SHA-256 differs.
    if (changed_ == nullptr || !loaded.geometry) failChanged(entry);
    if (std::ranges::find(*changed_, entry.mesh) == changed_->end()) changed_->push_back(entry.mesh);
    return loaded.geometry;
  }

 private:
  using Key = std::pair<fs::path, double>;
  static Key keyOf(const PartEntry& entry) { return {entry.mesh, entry.metresPerUnit}; }

  static void checkExists(const PartEntry& entry) {
    std::error_code failure;
    if (fs::exists(entry.mesh, failure)) return;
    entry.field.at("mesh").fail(
        fmt::format("the mesh file {} is missing", printableText(entry.mesh.string())),
        "put it back, or make the scene again with another mesh");
  }

  [[noreturn]] static void failChanged(const PartEntry& entry) {
    entry.field.at("sha256").fail(
        fmt::format("the mesh file {} has changed since the scene was saved (its SHA-256 differs)",
                    printableText(entry.mesh.string())),
        "put the old file back, or accept the new mesh: open the scene in the desktop application and save "
        "it");
  }

  std::vector<fs::path>* changed_;
  std::map<Key, std::size_t> indices_;
  std::vector<LoadedPart> loaded_;
};

/// Unlocked for now, so that its members can be added.
Group placed(const GroupEntry& entry, const std::vector<GroupId>& ids) {
  Group group = entry.group;
  group.isLocked = false;
  if (entry.parent) group.parent = ids[*entry.parent];
  return group;
}

void lockGroups(Scene& scene, const std::vector<GroupEntry>& entries, const std::vector<GroupId>& ids) {
  for (std::size_t i = 0; i < ids.size(); ++i) {
    Group group = *scene.findGroup(ids[i]);
    group.isLocked = entries[i].group.isLocked;
    scene.replaceGroup(std::move(group));
  }
}

}  // namespace

fs::path meshFolder(const fs::path& sceneFile) {
  std::error_code failure;
  const fs::path absolute = fs::absolute(sceneFile, failure);
  const fs::path real = fs::weakly_canonical(absolute, failure);
  return (failure ? absolute : real).parent_path();
}

Scene readSceneFile(const fs::path& file, const ProgressCallback& progress,
                    std::vector<fs::path>* changedMeshes) {
  JsonLimits limits;
  limits.maxBytes = kMaxSceneFileBytes;
  const nlohmann::json json = readJsonFile(file, limits);
  const JsonField root(json, file);
  const int version = readVersion(root);
  checkUnits(root.at("units"));
  Scene scene;
  scene.setHaptics(version >= 2 ? readHaptics(root.at("haptics")) : readHapticsOfVersion1(root));
  const std::vector<GroupEntry> groups =
      version >= 3 ? readGroups(root.at("groups")) : std::vector<GroupEntry>();
  std::vector<PartEntry> entries = readParts(root.at("parts"), groups, meshFolder(file), version);
  const std::optional<std::size_t> moving = readMovingPart(root.at("moving"), entries, groups);
  GeometryLoader loader(entries, progress, changedMeshes);
  std::vector<GroupId> ids;
  for (const GroupEntry& entry : groups)
    ids.push_back(scene.addGroup(placed(entry, ids)));
  for (PartEntry& entry : entries) {
    entry.part.geometry = loader.geometryOf(entry);
    if (entry.group) entry.part.group = ids[*entry.group];
    scene.add(std::move(entry.part));
  }
  if (moving) scene.setMovingPart(scene.parts()[*moving]->id);
  lockGroups(scene, groups, ids);
  return scene;
}

}  // namespace nearfit
