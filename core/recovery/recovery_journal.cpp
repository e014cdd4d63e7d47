#include "core/recovery/recovery_journal.h"

#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/files/input_file.h"
#include "core/files/sha256.h"
#include "core/scene/part_geometry.h"
#include "core/scene/scene_file.h"
#include "core/text/json_file.h"
#include "core/text/json_text.h"
#include "core/text/utf8.h"

namespace nearfit {
namespace {

namespace fs = std::filesystem;
using JournalJson = nlohmann::ordered_json;

/// Makes the mesh paths of a scene file absolute, so that the scene can be moved.
/// @tparam AnyJson  With keys in order or sorted.
template <class AnyJson>
void makePathsAbsolute(AnyJson& scene, const fs::path& folder) {
  for (AnyJson& part : scene.at("parts")) {
    AnyJson& mesh = part.at("mesh");
    mesh = normalisedPath(folder / mesh.template get<std::string>()).generic_string();
  }
}

/// Reads JSON, keeping the order of keys. Throws FileError, nlohmann::json::exception.
JournalJson readOrdered(const fs::path& file) {
  const std::vector<char> bytes = readWholeFile(file, {});
  return JournalJson::parse(bytes.begin(), bytes.end());
}

[[noreturn]] void failDamaged(const fs::path& journal) {
  throw FileError(journal.string(), "this recovery journal is damaged",
                  "open the scene as it was last saved");
}

/// Runs `work` on untrusted JSON; JSON exceptions become "damaged".
template <typename Work>
auto guarded(const fs::path& journal, Work work) {
  try {
    return work();
  } catch (const nlohmann::json::exception&) {
    failDamaged(journal);
  }
}

}  // namespace

std::string journalText(const Scene& scene, const JournalHead& head) {
  // Any folder will do: paths are made absolute below.
  const fs::path place = "/journal.nearfit";
  JournalJson json = JournalJson::parse(sceneFileText(scene, place));
  makePathsAbsolute(json, meshFolder(place));
  // The process that restores it may have another working directory.
  const std::string path = head.scene.empty() ? std::string() : normalisedPath(head.scene).string();
  if (!isUtf8(path)) {
    throw FileError(printableText(path), "the path of this scene file is not UTF-8",
                    "save it under another path");
  }
  const std::string sha256 = sha256OfBytes(prettyJson(json));
  json["recovery"] = {{"scene", path.empty() ? JournalJson() : JournalJson(path)},
                      {"changes", head.changes},
                      {"sha256", sha256}};
  return prettyJson(json);
}

JournalHead readJournalHead(const fs::path& journal) {
  return guarded(journal, [&] {
    JournalJson json = readOrdered(journal);
    const JournalJson recovery = json.at("recovery");
    json.erase("recovery");
    if (sha256OfBytes(prettyJson(json)) != recovery.at("sha256").get<std::string>()) failDamaged(journal);
    JournalHead head;
    if (!recovery.at("scene").is_null()) head.scene = recovery.at("scene").get<std::string>();
    head.changes = recovery.at("changes").get<std::size_t>();
    head.parts = json.at("parts").size();
    return head;
  });
}

bool isSaved(const fs::path& journal, const JournalHead& head) {
  if (head.scene.empty()) return false;
  try {
    // Sorted keys: the scene file may come from others, and finding a key among ordered ones takes O(n).
    JsonLimits limits;
    limits.maxBytes = kMaxSceneFileBytes;
    nlohmann::json kept = readJsonFile(journal, limits), saved = readJsonFile(head.scene, limits);
    kept.erase("recovery");
    makePathsAbsolute(kept, meshFolder(journal));
    makePathsAbsolute(saved, meshFolder(head.scene));
    return kept == saved;
  } catch (const FileError&) {
  } catch (const nlohmann::json::exception&) {
  }
  return false;  // The file is gone or not a scene: only the journal has the work.
}

}  // namespace nearfit
