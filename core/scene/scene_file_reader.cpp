#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <optional>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/scene/scene_file.h"
#include "core/scene/scene_file_haptics.h"
#include "core/text/json_file.h"
#include "core/text/utf8.h"

namespace nearfit {
namespace {

namespace fs = std::filesystem;

/// Longest path to a mesh [bytes]: as Linux allows.
constexpr std::size_t kMaxPathBytes = 4095;

/// A part as the file says it, its mesh not loaded yet.
struct PartEntry {
  JsonField field;
  Part part;
  fs::path mesh;
  std::string sha256;
  double metresPerUnit;
};

/// Runs `check`, which throws UsageError, as a check of the field.
template <typename Check>
auto checked(const JsonField& field, Check check) {
  try {
    return check();
  } catch (const UsageError& e) {
    field.fail(e.problem(), e.remedy());
  }
}

template <std::size_t Count>
std::array<double, Count> numbers(const JsonField& field) {
  field.requireSize(Count);
  std::array<double, Count> values{};
  for (std::size_t i = 0; i < Count; ++i)
    values[i] = field.at(i).number();
  return values;
}

int readVersion(const JsonField& root) {
  if (!root.has("nearfit"))
    root.fail("it is no Nearfit scene: the key \"nearfit\" is missing", "open a *.nearfit file");
  const JsonField field = root.at("nearfit");
  const double version = field.number();
  for (int known = kOldestSceneFileVersion; known <= kSceneFileVersion; ++known) {
    if (version == known) return known;
  }
  field.fail(fmt::format("this is version {} of the scene format, and this program reads versions {} to {}",
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

RigidTransform readPose(const JsonField& field) {
  const auto [x, y, z] = numbers<3>(field.at("position"));
  const auto [qw, qx, qy, qz] = numbers<4>(field.at("quaternion"));
  const RigidTransform translation{{1, 0, 0, 0}, {x, y, z}}, rotation{{qw, qx, qy, qz}, {}};
  checked(field.at("position"), [&] { return checkedPose(translation); });
  return {checked(field.at("quaternion"), [&] { return checkedPose(rotation); }).rotation,
          translation.translation};
}

Colour readColour(const JsonField& field) {
  field.requireSize(3);
  const auto channel = [&](std::size_t i) { return static_cast<float>(field.at(i).numberWithin(0.0, 1.0)); };
  return {channel(0), channel(1), channel(2)};
}

std::string readSha256(const JsonField& field) {
  std::string digits = field.text(64);
  const bool isHash = digits.size() == 64 && std::all_of(digits.begin(), digits.end(), [](unsigned char c) {
                        return std::isxdigit(c) != 0;
                      });
  if (!isHash) field.fail("it is no SHA-256", "give 64 hexadecimal digits");
  std::transform(digits.begin(), digits.end(), digits.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return digits;
}

PartEntry readPart(const JsonField& field, const fs::path& folder, int version) {
  PartEntry entry{field, {}, {}, readSha256(field.at("sha256")), field.at("metresPerUnit").number()};
  checked(field.at("metresPerUnit"), [&] { checkMetresPerUnit(entry.metresPerUnit); });
  const std::string mesh = field.at("mesh").text(kMaxPathBytes);
  if (mesh.empty()) field.at("mesh").fail("it is empty", "give the path of the mesh file");
  entry.mesh = normalisedPath(folder / mesh);
  entry.part.name = field.at("name").text(kMaxPartNameBytes);
  checked(field.at("name"), [&] { checkPartName(entry.part.name); });
  entry.part.worldFromPart = readPose(field);
  entry.part.colour = readColour(field.at("colour"));
  if (version >= 2) {
    entry.part.density = field.at("density").number();
    checked(field.at("density"), [&] { checkDensity(entry.part.density); });
  }
  entry.part.isVisible = field.at("visible").isTrue();
  entry.part.isLocked = field.at("locked").isTrue();
  return entry;
}

std::vector<PartEntry> readParts(const JsonField& field, const fs::path& folder, int version) {
  const std::size_t count = field.size();
  if (count > kMaxSceneFileParts) field.fail(fmt::format("there are more than {} parts", kMaxSceneFileParts));
  std::vector<PartEntry> entries;
  std::map<std::string, std::size_t> indexOfName;
  for (std::size_t i = 0; i < count; ++i) {
    entries.push_back(readPart(field.at(i), folder, version));
    const auto [known, isNew] = indexOfName.emplace(entries.back().part.name, i);
    if (!isNew)
      field.at(i).at("name").fail(fmt::format("parts[{}] has the same name", known->second),
                                  "give each part its own");
  }
  return entries;
}

/// Index of the moving part among the entries.
std::optional<std::size_t> readMovingPart(const JsonField& field, const std::vector<PartEntry>& entries) {
  if (field.isNull()) return std::nullopt;
  const std::string name = field.text(kMaxPartNameBytes);
  const auto it =
      std::find_if(entries.begin(), entries.end(), [&](const PartEntry& e) { return e.part.name == name; });
  if (it == entries.end()) {
    field.fail(fmt::format("there is no part \"{}\"", printableText(name)), "name a part, or say null");
  }
  if (it->part.isLocked)
    field.fail("this part is locked and cannot be the moving part", "unlock it, or say null");
  return static_cast<std::size_t>(it - entries.begin());
}

/// Loads meshes, each file and unit once.
class GeometryLoader {
 public:
  /// Throws FileError when a mesh file is missing, Cancelled.
  GeometryLoader(const std::vector<PartEntry>& entries, const ProgressCallback& progress) {
    std::vector<MeshSource> sources;
    for (const PartEntry& entry : entries) {
      if (!indices_.emplace(keyOf(entry), sources.size()).second) continue;
      checkExists(entry);
      sources.push_back({entry.mesh, entry.metresPerUnit, entry.sha256});
    }
    loaded_ = loadPartGeometries(sources, progress);
  }

  PartGeometryPtr geometryOf(const PartEntry& entry) const {
    const LoadedPart& loaded = loaded_[indices_.at(keyOf(entry))];
    try {
      if (loaded.problem) std::rethrow_exception(loaded.problem);
    } catch (const Error& e) {
      entry.field.at("mesh").fail(e.where() + ": " + e.problem(), e.remedy());
    }
    if (!loaded.geometry || loaded.geometry->sha256 != entry.sha256) failChanged(entry);
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
        "put it back there, or make the scene anew with the mesh that you have");
  }

  [[noreturn]] static void failChanged(const PartEntry& entry) {
    entry.field.at("sha256").fail(
        fmt::format("the mesh file {} is not the one that the scene was made with (its SHA-256 differs)",
                    printableText(entry.mesh.string())),
        "put the old file back, or make the scene anew with the changed one");
  }

  std::map<Key, std::size_t> indices_;
  std::vector<LoadedPart> loaded_;
};

}  // namespace

fs::path meshFolder(const fs::path& sceneFile) {
  std::error_code failure;
  const fs::path absolute = fs::absolute(sceneFile, failure);
  const fs::path real = fs::weakly_canonical(absolute, failure);
  return (failure ? absolute : real).parent_path();
}

Scene readSceneFile(const fs::path& file, const ProgressCallback& progress) {
  JsonLimits limits;
  limits.maxBytes = kMaxSceneFileBytes;
  const nlohmann::json json = readJsonFile(file, limits);
  const JsonField root(json, file);
  const int version = readVersion(root);
  checkUnits(root.at("units"));
  Scene scene;
  scene.setHaptics(version >= 2 ? readHaptics(root.at("haptics")) : readHapticsOfVersion1(root));
  std::vector<PartEntry> entries = readParts(root.at("parts"), meshFolder(file), version);
  const std::optional<std::size_t> moving = readMovingPart(root.at("moving"), entries);
  const GeometryLoader loader(entries, progress);
  for (PartEntry& entry : entries) {
    entry.part.geometry = loader.geometryOf(entry);
    scene.add(std::move(entry.part));
  }
  if (moving) scene.setMovingPart(scene.parts()[*moving]->id);
  return scene;
}

}  // namespace nearfit
