#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <system_error>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/scene/document_load.h"
#include "core/scene/scene_file.h"
#include "core/scene/scene_file_haptics.h"
#include "core/scene/scene_json.h"
#include "core/text/json_file.h"
#include "core/text/utf8.h"

namespace nearfit {
namespace {

namespace fs = std::filesystem;

/// A part as in the file, its mesh not loaded yet.
struct PartEntry {
  JsonField field;
  Part part;                         ///< `group` and `geometry` are not set.
  std::optional<std::size_t> group;  ///< Index into the groups.
  std::filesystem::path mesh;
  std::string sha256;
  double metresPerUnit;
  std::string shape = {};  ///< Of a CAD document; else empty.
  Tessellation tessellation = {};
  MeshRepairs repairs = {};
};

/// A group as in the file.
struct GroupEntry {
  Group group;                        ///< `parent` is not set.
  std::optional<std::size_t> parent;  ///< Index of an earlier group.
  bool isLockedAnyhow = false;        ///< True if it or a group that contains it is locked.
  std::size_t age = 0;                ///< Place among the groups from oldest to newest.
};

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

std::string readSha256(const JsonField& field) {
  std::string digits = field.text(64);
  const bool isHash = digits.size() == 64 && std::all_of(digits.begin(), digits.end(), [](unsigned char c) {
                        return std::isxdigit(c) != 0;
                      });
  if (!isHash) field.fail("it is not a SHA-256", "give 64 hexadecimal digits");
  std::transform(digits.begin(), digits.end(), digits.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return digits;
}

/// Index of a group, or std::nullopt for null.
std::optional<std::size_t> readGroupIndex(const JsonField& field, std::size_t count, const char* remedy) {
  if (field.isNull()) return std::nullopt;
  const double index = field.number();
  if (!(index >= 0.0 && index < static_cast<double>(count) && index == std::floor(index)))
    field.fail(fmt::format("{} is not the number of one of the {} groups", index, count), remedy);
  return static_cast<std::size_t>(index);
}

/// Reads what version 3 adds to version 2.
void readPlaceAndLook(const JsonField& field, std::size_t groupCount, PartEntry& entry) {
  entry.part.opacity = field.at("opacity").number();
  checkedAt(field.at("opacity"), [&] { checkOpacity(entry.part.opacity); });
  entry.group = readGroupIndex(field.at("group"), groupCount, "give the number of a group, from 0, or null");
  const JsonField wasVisible = field.at("wasVisible");
  if (!wasVisible.isNull()) entry.part.wasVisible = wasVisible.isTrue();
}

PartEntry readPart(const JsonField& field, std::size_t groupCount, const fs::path& folder, int version) {
  PartEntry entry{field, {}, {}, {}, readSha256(field.at("sha256")), field.at("metresPerUnit").number()};
  checkedAt(field.at("metresPerUnit"), [&] { checkMetresPerUnit(entry.metresPerUnit); });
  entry.mesh = readMeshPath(field.at("mesh"), folder);
  entry.part.name = field.at("name").text(kMaxPartNameBytes);
  checkedAt(field.at("name"), [&] { checkPartName(entry.part.name); });
  entry.part.worldFromPart = readPose(field);
  entry.part.colour = readColour(field.at("colour"));
  if (version >= 2) {
    entry.part.density = field.at("density").number();
    checkedAt(field.at("density"), [&] { checkDensity(entry.part.density); });
  }
  entry.part.isVisible = field.at("visible").isTrue();
  entry.part.isLocked = field.at("locked").isTrue();
  if (version >= 3) readPlaceAndLook(field, groupCount, entry);
  if (version >= 4) entry.part.pivot = readPivot(field.at("pivot"));
  if (version >= 6) {
    ShapeOfFile shape = readShape(field.at("shape"), entry.mesh);
    entry.shape = std::move(shape.key);
    entry.tessellation = shape.tessellation;
    entry.repairs = readRepairs(field.at("repairs"));
  }
  return entry;
}

/// Reads the field "age" of each group, or of none.
/// @param field  The array "groups".
void readAges(const JsonField& field, std::vector<GroupEntry>& entries) {
  const bool hasAges = !entries.empty() && field.at(0).has("age");
  std::vector<bool> isTaken(entries.size());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    entries[i].age = i;
    if (!hasAges) continue;
    const JsonField place = field.at(i).at("age");
    const double age = place.number();
    if (!(age >= 0.0 && age < static_cast<double>(entries.size()) && age == std::floor(age)) ||
        isTaken[static_cast<std::size_t>(age)]) {
      place.fail(fmt::format("{} is not a place of its own among the {} groups", age, entries.size()),
                 "number the groups from 0 by age, or leave all ages out");
    }
    entries[i].age = static_cast<std::size_t>(age);
    isTaken[entries[i].age] = true;
  }
}

/// @param field  The array "groups".
std::vector<GroupEntry> readGroups(const JsonField& field) {
  const std::size_t count = field.size();
  if (count > kMaxGroups) field.fail(fmt::format("there are more than {} groups", kMaxGroups));
  std::vector<GroupEntry> entries(count);
  std::vector<std::size_t> depths(count, 1);
  for (std::size_t i = 0; i < count; ++i) {
    const JsonField place = field.at(i).at("group");
    GroupEntry& entry = entries[i];
    entry.group.name = field.at(i).at("name").text(kMaxGroupNameBytes);
    checkedAt(field.at(i).at("name"), [&] { checkGroupName(entry.group.name); });
    entry.group.isLocked = entry.isLockedAnyhow = field.at(i).at("locked").isTrue();
    entry.parent = readGroupIndex(place, i, "give the number of an earlier group, from 0, or null");
    if (!entry.parent) continue;
    depths[i] = depths[*entry.parent] + 1;
    if (depths[i] > kMaxGroupDepth)
      place.fail(fmt::format("groups are nested more than {} deep", kMaxGroupDepth),
                 "move it to a higher level");
    entry.isLockedAnyhow = entry.isLockedAnyhow || entries[*entry.parent].isLockedAnyhow;
  }
  readAges(field, entries);
  return entries;
}

/// @param field   The array "parts".
/// @param folder  Start of relative mesh paths.
std::vector<PartEntry> readParts(const JsonField& field, const std::vector<GroupEntry>& groups,
                                 const fs::path& folder, int version) {
  const std::size_t count = field.size();
  if (count > kMaxSceneFileParts) field.fail(fmt::format("there are more than {} parts", kMaxSceneFileParts));
  std::vector<PartEntry> entries;
  std::map<std::string, std::size_t> indexOfName;
  for (std::size_t i = 0; i < count; ++i) {
    entries.push_back(readPart(field.at(i), groups.size(), folder, version));
    const auto [known, isNew] = indexOfName.emplace(entries.back().part.name, i);
    if (!isNew)
      field.at(i).at("name").fail(fmt::format("parts[{}] has the same name", known->second),
                                  "give each part its own name");
  }
  return entries;
}

/// Reads the field "moving": index of the moving part in `entries`.
std::optional<std::size_t> readMovingPart(const JsonField& field, const std::vector<PartEntry>& entries,
                                          const std::vector<GroupEntry>& groups) {
  if (field.isNull()) return std::nullopt;
  const std::string name = field.text(kMaxPartNameBytes);
  const auto it =
      std::find_if(entries.begin(), entries.end(), [&](const PartEntry& e) { return e.part.name == name; });
  if (it == entries.end()) {
    field.fail(fmt::format("there is no part \"{}\"", printableText(name)), "name a part, or give null");
  }
  if (it->part.isLocked || (it->group && groups[*it->group].isLockedAnyhow))
    field.fail("this part is locked and cannot be the moving part", "unlock it, or give null");
  return static_cast<std::size_t>(it - entries.begin());
}

/// True if a group is another one, or in it at any depth.
bool isWithin(std::optional<std::size_t> group, std::size_t ancestor, const std::vector<GroupEntry>& groups) {
  while (group && *group != ancestor)
    group = groups[*group].parent;
  return group.has_value();
}

/// Reads the field "movingGroup": index of the moving group.
/// @param hasMovingPart  The file names a moving part too.
std::optional<std::size_t> readMovingGroup(const JsonField& field, const std::vector<PartEntry>& entries,
                                           const std::vector<GroupEntry>& groups, bool hasMovingPart) {
  const std::optional<std::size_t> index =
      readGroupIndex(field, groups.size(), "give the number of a group, from 0, or null");
  if (!index) return index;
  if (hasMovingPart) field.fail("a part is in hand too", "give null here, or for \"moving\"");
  bool isEmpty = true, isLocked = groups[*index].isLockedAnyhow;
  for (std::size_t i = 0; i < groups.size(); ++i)
    isLocked = isLocked || (groups[i].group.isLocked && isWithin(i, *index, groups));
  for (const PartEntry& entry : entries) {
    if (!isWithin(entry.group, *index, groups)) continue;
    isEmpty = false;
    isLocked = isLocked || entry.part.isLocked;
  }
  if (isEmpty) field.fail("this group has no parts that could be moved", "give another group, or null");
  if (isLocked)
    field.fail("this group, or something in it, is locked and cannot be moved", "unlock it, or give null");
  return index;
}

/// A joint as in the file.
struct JointEntry {
  JsonField field;
  Joint joint;  ///< `part` and `base` are not set.
  std::size_t part;
  std::optional<std::size_t> base;  ///< Indices of parts.
};

/// @param field  The array "joints".
std::vector<JointEntry> readJoints(const JsonField& field, const std::vector<PartEntry>& parts) {
  const std::size_t count = field.size();
  if (count > kMaxJoints) field.fail(fmt::format("there are more than {} joints", kMaxJoints));
  std::map<std::string, std::size_t> indexOfName;
  for (std::size_t i = 0; count > 0 && i < parts.size(); ++i)
    indexOfName.emplace(parts[i].part.name, i);
  const auto indexAt = [&](const JsonField& name, const char* remedy) {
    const std::string text = name.text(kMaxPartNameBytes);
    const auto it = indexOfName.find(text);
    if (it == indexOfName.end())
      name.fail(fmt::format("there is no part \"{}\"", printableText(text)), remedy);
    return it->second;
  };
  std::vector<JointEntry> entries;
  std::map<std::size_t, std::size_t> countOfPart;
  for (std::size_t i = 0; i < count; ++i) {
    const JsonField each = field.at(i), base = each.at("base");
    Joint joint;
    joint.kind = readJointKind(each.at("kind"));
    joint.onPart = readJointFeature(each.at("onPart"), joint.kind);
    joint.onBase = readJointFeature(each.at("onBase"), joint.kind);
    joint.isOn = each.at("on").isTrue();
    JointEntry entry{each, joint, indexAt(each.at("part"), "name a part"), {}};
    if (!base.isNull()) entry.base = indexAt(base, "name a part, or give null for the world");
    if (entry.base == entry.part) base.fail("a part cannot be kept on itself", "name another part");
    if (++countOfPart[entry.part] > kMaxJointsPerPart)
      each.at("part").fail(fmt::format("the part has more than {} joints", kMaxJointsPerPart));
    entries.push_back(std::move(entry));
  }
  return entries;
}

/// Parts must not be locked yet.
void addJoints(Scene& scene, const std::vector<JointEntry>& entries) {
  const std::vector<Scene::PartPtr> parts = scene.parts();
  for (const JointEntry& entry : entries) {
    Joint joint = entry.joint;
    joint.part = parts[entry.part]->id;
    if (entry.base) joint.base = parts[*entry.base]->id;
    checkedAt(entry.field, [&] { scene.addJoint(joint); });
  }
}

/// A record of a pair as in the file.
struct RecordEntry {
  PairRecord record;        ///< `pair` is not set.
  std::size_t part, other;  ///< Indices of parts.
};

/// @param first  The part must come after this one.
std::size_t readPartIndex(const JsonField& field, std::size_t count, std::optional<std::size_t> first = {}) {
  const double index = field.number();
  const double least = first ? static_cast<double>(*first) + 1.0 : 0.0;
  if (!(index >= least && index < static_cast<double>(count) && index == std::floor(index)))
    field.fail(fmt::format("{} is not the number of one of the {} parts{}", index, count,
                           first ? " after the other" : ""),
               "give the number of a part, from 0");
  return static_cast<std::size_t>(index);
}

RecordEntry readPairRecord(const JsonField& field, std::size_t partCount) {
  RecordEntry entry{{}, readPartIndex(field.at("part"), partCount), 0};
  entry.other = readPartIndex(field.at("other"), partCount, entry.part);
  entry.record = readFinding(field);
  return entry;
}

/// @param field  The array "pairRecords".
std::vector<RecordEntry> readPairRecords(const JsonField& field, std::size_t partCount) {
  const std::size_t count = field.size();
  if (count > kMaxPairRecords) field.fail(fmt::format("there are more than {} findings", kMaxPairRecords));
  std::vector<RecordEntry> entries;
  std::set<std::pair<std::size_t, std::size_t>> known;
  for (std::size_t i = 0; i < count; ++i) {
    entries.push_back(readPairRecord(field.at(i), partCount));
    if (!known.emplace(entries.back().part, entries.back().other).second)
      field.at(i).fail("there is an earlier finding of these parts", "keep one");
  }
  return entries;
}

void setPairRecords(Scene& scene, const std::vector<RecordEntry>& entries) {
  std::vector<PairRecord> records;
  for (const RecordEntry& entry : entries) {
    records.push_back(entry.record);
    records.back().pair = {scene.parts()[entry.part]->id, scene.parts()[entry.other]->id};
  }
  scene.setPairRecords(std::move(records));
}

/// Loads meshes, each file, unit, shape and tessellation once for the same repairs.
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
      sources.push_back({entry.mesh, entry.metresPerUnit, changed != nullptr ? std::string() : entry.sha256,
                         entry.shape, entry.tessellation, entry.repairs});
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
    if (listed_.insert(entry.mesh).second) changed_->push_back(entry.mesh);
    return loaded.geometry;
  }

 private:
  using Key = std::tuple<fs::path, double, std::string, double, double, std::string>;
  static Key keyOf(const PartEntry& entry) {
    return {entry.mesh,
            entry.metresPerUnit,
            entry.shape,
            entry.tessellation.chord,
            entry.tessellation.angle,
            textOf(entry.repairs)};
  }

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
  std::set<fs::path> listed_;  ///< In changed_.
  std::map<Key, std::size_t> indices_;
  std::vector<LoadedPart> loaded_;
};

/// Unlocks the parts that have joints, so that these can be added, and returns their indices.
std::vector<std::size_t> unlockForJoints(std::vector<PartEntry>& parts,
                                         const std::vector<JointEntry>& joints) {
  std::vector<std::size_t> unlocked;
  for (const JointEntry& entry : joints) {
    if (std::exchange(parts[entry.part].part.isLocked, false)) unlocked.push_back(entry.part);
  }
  return unlocked;
}

void lockParts(Scene& scene, const std::vector<std::size_t>& indices) {
  for (const std::size_t index : indices) {
    Part part = *scene.parts()[index];
    part.isLocked = true;
    scene.replace(std::move(part));
  }
}

/// Adds the groups, oldest first, and returns the ID of each entry. Unlocked for now, so that members can be added.
std::vector<GroupId> addGroups(Scene& scene, const std::vector<GroupEntry>& entries) {
  std::vector<std::size_t> byAge(entries.size());
  for (std::size_t i = 0; i < entries.size(); ++i)
    byAge[entries[i].age] = i;
  std::vector<Group> groups;
  std::vector<std::optional<std::size_t>> parents;
  for (const std::size_t i : byAge) {
    groups.push_back(entries[i].group);
    groups.back().isLocked = false;
    parents.push_back(entries[i].parent ? std::optional(entries[*entries[i].parent].age) : std::nullopt);
  }
  const std::vector<GroupId> added = scene.addGroups(std::move(groups), parents);
  std::vector<GroupId> ids;
  for (const GroupEntry& entry : entries)
    ids.push_back(added[entry.age]);
  return ids;
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
  std::optional<std::size_t> movingGroup;
  if (version >= 6)
    movingGroup = readMovingGroup(root.at("movingGroup"), entries, groups, moving.has_value());
  const std::vector<JointEntry> joints =
      version >= 5 ? readJoints(root.at("joints"), entries) : std::vector<JointEntry>();
  if (version >= 7) scene.setPairRules(readPairRules(root.at("pairRules")));
  const std::vector<RecordEntry> records =
      version >= 7 ? readPairRecords(root.at("pairRecords"), entries.size()) : std::vector<RecordEntry>();
  const std::vector<std::size_t> lockedLater = unlockForJoints(entries, joints);
  GeometryLoader loader(entries, progress, changedMeshes);
  const std::vector<GroupId> ids = addGroups(scene, groups);
  std::vector<Part> parts;
  parts.reserve(entries.size());
  for (PartEntry& entry : entries) {
    entry.part.geometry = loader.geometryOf(entry);
    if (entry.group) entry.part.group = ids[*entry.group];
    parts.push_back(std::move(entry.part));
  }
  scene.addAll(std::move(parts));
  addJoints(scene, joints);
  setPairRecords(scene, records);
  lockParts(scene, lockedLater);
  if (moving) scene.setMovingPart(scene.parts()[*moving]->id);
  if (movingGroup) scene.setMovingGroup(ids[*movingGroup]);
  lockGroups(scene, groups, ids);
  return scene;
}

}  // namespace nearfit
