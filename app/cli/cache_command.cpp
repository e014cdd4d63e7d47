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

/// Reports an invalid size here: loading ignores one, so that it never fails because of it.
void checkSize() {
  const char* text = std::getenv("NEARFIT_CACHE_SIZE");
  if (text == nullptr || *text == '\0' || parseByteSize(text)) return;
  throw UsageError("NEARFIT_CACHE_SIZE", fmt::format("\"{}\" is no size", printableText(text)),
                   "give a number of bytes, or one with K, M, G or T behind");
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
  CLI::App* command = program.add_subcommand(
      "cache", "Says where meshes with their hierarchies are kept, and how much; or removes them.");
  command->add_flag("--clear", options->isCleared, "Remove all that is kept");
  command->add_flag("--json", options->isJson, "Print one JSON object");
  command->footer(fmt::format(
      "A mesh of {} triangles or more is kept with what was derived from it, known by the content of its "
      "file\n"
      "and its unit, so that the next program that opens it need not read or build it again. What is kept "
      "is\n"
      "checked before it is used, and made anew when anything is wrong with it: clearing loses nothing but\n"
      "time. What was not used for longest goes when the limit is reached.\n"
      "Environment:\n"
      "  NEARFIT_CACHE       Folder of the cache, or \"off\"; without it, nearfit in XDG_CACHE_HOME or "
      "~/.cache\n"
      "  NEARFIT_CACHE_SIZE  Limit in bytes, or with K, M, G or T behind; without it, 4G",
      kMinCachedTriangles));
  command->callback([options] { runCache(*options); });
}

}  // namespace nearfit::cli
