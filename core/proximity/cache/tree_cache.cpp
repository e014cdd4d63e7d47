#include "core/proximity/cache/tree_cache.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <exception>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/files/sha256.h"
#include "core/files/user_folders.h"

namespace nearfit {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kEnding = ".nearfit-tree";
constexpr std::size_t kNameDigits = 64;
/// Prefix that AtomicFile gives to files not yet in place.
constexpr std::string_view kUnfinished = ".nearfit-";
/// An unfinished file this old has been abandoned.
constexpr std::chrono::hours kAbandoned{1};

struct Entry {
  fs::path path;
  std::uint64_t bytes;
  fs::file_time_type used;
};

/// True for the name of a cache file. Other things in the folder are never counted or removed.
bool isOurs(const std::string& name) {
  return name.size() == kNameDigits + kEnding.size() && name.ends_with(kEnding) &&
         std::all_of(name.begin(), name.begin() + kNameDigits,
                     [](unsigned char c) { return std::isxdigit(c) != 0; });
}

/// Lists the cache files in the folder, and unfinished files that were abandoned.
std::vector<Entry> entriesOf(const fs::path& folder) {
  std::vector<Entry> entries;
  std::error_code failure;
  for (fs::directory_iterator it(folder, failure), end; !failure && it != end; it.increment(failure)) {
    // Another process may remove the file meanwhile, so any of these calls can fail.
    std::error_code unknown;
    if (!fs::is_regular_file(it->symlink_status(unknown))) continue;
    const fs::file_time_type used = fs::last_write_time(it->path(), unknown);
    if (unknown) continue;
    const std::string name = it->path().filename().string();
    const bool isAbandoned =
        name.starts_with(kUnfinished) && used < fs::file_time_type::clock::now() - kAbandoned;
    const std::uintmax_t bytes = fs::file_size(it->path(), unknown);
    if (!unknown && (isOurs(name) || isAbandoned)) entries.push_back({it->path(), bytes, used});
  }
  return entries;
}

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

fs::path folderFromEnvironment() {
  const std::string own = variable("NEARFIT_CACHE");
  if (own == "off") return {};
  if (!own.empty()) return own;
  return userFolder(UserFiles::Cache);
}

}  // namespace

std::optional<std::uint64_t> parseByteSize(const std::string& text) {
  constexpr std::string_view kUnits = "KMGT";
  std::uint64_t number = 0;
  const char* end = text.data() + text.size();
  const auto [rest, failure] = std::from_chars(text.data(), end, number);
  if (failure != std::errc() || end - rest > 1) return std::nullopt;
  if (rest == end) return number;
  const std::size_t unit = kUnits.find(*rest);
  if (unit == std::string_view::npos) return std::nullopt;
  const int shift = 10 * static_cast<int>(unit + 1);
  if (number != 0 && std::countl_zero(number) < shift) return std::nullopt;
  return number << shift;
}

TreeCacheSettings treeCacheSettings() {
  TreeCacheSettings settings;
  settings.folder = folderFromEnvironment();
  settings.maxBytes = parseByteSize(variable("NEARFIT_CACHE_SIZE")).value_or(kDefaultTreeCacheBytes);
  return settings;
}

fs::path TreeCache::pathOf(const TreeCacheKey& key) const {
  const std::string content = fmt::format(
      "{} {:016x} {}", key.sha256, std::bit_cast<std::uint64_t>(key.metresPerUnit), treeCacheFingerprint());
  return settings_.folder / (sha256OfBytes(content) + std::string(kEnding));
}

std::optional<TreeCacheFile> TreeCache::find(const TreeCacheKey& key) const {
  if (!isOn()) return std::nullopt;
  const fs::path path = pathOf(key);
  std::optional<TreeCacheFile> file = TreeCacheFile::open(path, key);
  std::error_code notOurs;
  if (file) fs::last_write_time(path, fs::file_time_type::clock::now(), notOurs);
  return file;
}

bool TreeCache::store(const TreeCacheKey& key, const CachedMesh& mesh, const CachedTree* tree) const {
  if (!isOn() || mesh.mesh.triangles().size() < settings_.leastTriangles) return false;
  try {
    fs::create_directories(settings_.folder);
    const fs::path path = pathOf(key);
    if (writeTreeCacheFile(path, key, mesh, tree, settings_.maxBytes) == 0) return false;
    evict(path);
    return true;
  } catch (const std::exception&) {
    return false;  // Disk full, folder not writable, no memory: the next time takes as long as this time.
  }
}

void TreeCache::evict(const fs::path& newest) const {
  std::vector<Entry> entries = entriesOf(settings_.folder);
  std::uint64_t total = 0;
  for (const Entry& entry : entries)
    total += entry.bytes;
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.used < b.used; });
  for (const Entry& entry : entries) {
    if (total <= settings_.maxBytes) return;
    if (entry.path == newest) continue;
    std::error_code failure;
    if (fs::remove(entry.path, failure)) total -= entry.bytes;
  }
}

TreeCache::Usage TreeCache::usage() const {
  Usage usage;
  for (const Entry& entry : entriesOf(settings_.folder)) {
    ++usage.files;
    usage.bytes += entry.bytes;
  }
  return usage;
}

TreeCache::Usage TreeCache::clear() const {
  Usage removed;
  for (const Entry& entry : entriesOf(settings_.folder)) {
    std::error_code failure;
    fs::remove(entry.path, failure);
    if (failure) {
      throw FileError(entry.path.string(), "it cannot be removed: " + failure.message(),
                      "check the permissions of its folder");
    }
    ++removed.files;
    removed.bytes += entry.bytes;
  }
  return removed;
}

}  // namespace nearfit
