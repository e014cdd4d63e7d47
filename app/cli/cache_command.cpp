#include <cstdlib>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/cli/commands.h"
#include "app/cli/output.h"
#include "core/base/error.h"
#include "core/proximity/cache/tree_cache.h"
#include "core/text/utf8.h"

namespace nearfit::cli {
namespace {

struct CacheOptions {
  bool isJson = false, isCleared = false;
};

/// Reports an invalid size here: loading only warns of one, so that it never fails because of it.
void checkSize() {
  const char* text = std::getenv("NEARFIT_CACHE_SIZE");
  if (text == nullptr || *text == '\0' || parseByteSize(text)) return;
  throw UsageError("NEARFIT_CACHE_SIZE", fmt::format("\"{}\" is not a size", printableText(text)),
                   "give a number of bytes, or a number followed by K, M, G or T, such as 1.5G");
}

std::string cacheText(const TreeCache& cache, const TreeCache::Usage& usage, bool isCleared) {
  if (!cache.isOn()) return "The cache is off.\n";
  return fmt::format(
      "  folder    {}\n"
      "  {}   {} mesh{}, {} bytes\n"
      "  limit     {} bytes\n",
      oneLine(cache.settings().folder.string()), isCleared ? "removed" : "holds  ", usage.files,
      usage.files == 1 ? "" : "es", usage.bytes, cache.settings().maxBytes);
}

std::string cacheJson(const TreeCache& cache, const TreeCache::Usage& usage, bool isCleared) {
  const std::string folder = cache.settings().folder.string();
  nlohmann::ordered_json json;
  json["on"] = cache.isOn();
  json["folder"] = isUtf8(folder) ? folder : printableText(folder);
  json[isCleared ? "removed" : "holds"] = {{"meshes", usage.files}, {"bytes", usage.bytes}};
  json["limit"] = cache.settings().maxBytes;
  return json.dump() + "\n";
}

void runCache(const CacheOptions& options) {
  checkSize();
  const TreeCache cache;
  TreeCache::Usage usage;
  if (cache.isOn()) usage = options.isCleared ? cache.clear() : cache.usage();
  print(options.isJson ? cacheJson(cache, usage, options.isCleared)
                       : cacheText(cache, usage, options.isCleared));
}

}  // namespace

void addCacheCommand(CLI::App& program) {
  const auto options = std::make_shared<CacheOptions>();
  CLI::App* command =
      program.add_subcommand("cache", "Shows or clears the cache of meshes and their hierarchies.");
  command->add_flag("--clear", options->isCleared, "Delete everything in the cache");
  command->add_flag("--json", options->isJson, "Print one JSON object");
  command->footer(fmt::format(
      "The cache holds mesh files of {} triangles or more and all shapes of CAD documents, with the data\n"
      "derived from them, by file content, unit and fineness, so that the next program that opens one need\n"
      "not read and build it again.\n"
      "Cached data is checked before it is used and rebuilt if anything is wrong: clearing the cache\n"
      "costs only time. When the limit is reached, the entries unused for longest are deleted.\n"
      "Only you can read what is kept. A folder that another user owns or can write to is not used.\n"
      "Environment:\n"
      "  NEARFIT_CACHE       Folder, or \"off\"; default: nearfit in XDG_CACHE_HOME or ~/.cache\n"
      "  NEARFIT_CACHE_SIZE  Limit in bytes, or with K, M, G or T (1.5G); default: 4G",
      kMinCachedTriangles));
  command->callback([options] { runCache(*options); });
}

}  // namespace nearfit::cli
