#include "core/scene/document_content.h"

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/files/sha256.h"
#include "core/import/companion_files.h"
#include "core/import/mesh_file_check.h"
#include "core/proximity/cache/tree_cache.h"
#include "core/text/json_file.h"

namespace nearfit {
namespace {

namespace fs = std::filesystem;

/// Key of the names of companions, which the file alone decides.
TreeCacheKey companionsKeyOf(const std::string& sha256) {
  return {sha256OfBytes(sha256 + " companions"), 1.0};
}

/// Nothing in the text is trusted.
std::optional<std::vector<std::string>> readCompanionNames(std::string_view text, const fs::path& file) {
  try {
    JsonLimits limits;
    limits.maxBytes = kMaxCachedTextBytes;
    // Each name, and the brackets around them.
    limits.maxValues = kMaxCompanions + 2;
    const nlohmann::json json = readJsonText(text, file, limits);
    const JsonField field(json, file);
    std::vector<std::string> names;
    for (std::size_t i = 0; i < field.size(); ++i) {
      names.push_back(field.at(i).text(kMaxCompanionNameBytes));
      if (!isCompanionName(names.back())) return std::nullopt;
    }
    return names;
  } catch (const FileError&) {
    return std::nullopt;
  }
}

DocumentContent contentOfAll(const std::string& sha256, std::span<const std::string> names,
                             CompanionFiles files) {
  if (files.empty()) return {sha256, nullptr, sha256};
  std::string all = sha256;
  for (std::size_t i = 0; i < files.size(); ++i)
    all += fmt::format("\n{} {}", files[i].sha256, names[i]);
  return {sha256, std::make_shared<const CompanionFiles>(std::move(files)), sha256OfBytes(all)};
}

std::vector<std::string> companionNamesOf(const CadDocument& document) {
  std::vector<std::string> names;
  for (const CadCompanion& companion : document.companions)
    names.push_back(companion.name);
  return names;
}

}  // namespace

std::optional<DocumentContent> contentOnDisk(const fs::path& file, const std::string& sha256,
                                             const std::function<void(double fraction)>& onProgress) {
  if (!mayHaveCompanions(file)) return contentOfAll(sha256, {}, {});
  const std::optional<std::string> text = TreeCache().findText(companionsKeyOf(sha256));
  const std::optional<std::vector<std::string>> names = text ? readCompanionNames(*text, file) : std::nullopt;
  if (!names) return std::nullopt;
  const CompanionFinder finder(file, *names);
  CompanionFiles files;
  try {
    for (const std::string& name : *names) {
      const FoundFile found = finder.find(name);
      if (!found.problem.empty()) return std::nullopt;
      checkMeshFile(found.path);
      const auto onBlock = [&, done = static_cast<double>(files.size())](double fraction) {
        if (onProgress) onProgress((done + fraction) / static_cast<double>(names->size()));
      };
      files.push_back({found.path, sha256OfFile(found.path, onBlock)});
    }
  } catch (const FileError&) {
    // The importer says what is wrong with it.
    return std::nullopt;
  }
  return contentOfAll(sha256, *names, std::move(files));
}

DocumentContent contentOf(const fs::path& file, const CadDocument& imported) {
  const DocumentContent unknown{imported.sha256, nullptr, {}};
  if (!imported.areCompanionsKnown || imported.companions.size() > kMaxCompanions) return unknown;
  const std::vector<std::string> names = companionNamesOf(imported);
  const CompanionFinder finder(file, names);
  CompanionFiles files;
  for (const CadCompanion& companion : imported.companions) {
    FoundFile found = finder.find(companion.name);
    if (!isCompanionName(companion.name) || !found.problem.empty()) return unknown;
    files.push_back({std::move(found.path), companion.sha256});
  }
  return contentOfAll(imported.sha256, names, std::move(files));
}

void storeCompanionNames(const fs::path& file, const DocumentContent& content, const CadDocument& imported) {
  if (!mayHaveCompanions(file) || content.name.empty()) return;
  TreeCache().storeText(companionsKeyOf(content.sha256), nlohmann::json(companionNamesOf(imported)).dump());
}

}  // namespace nearfit
