#include "core/proximity/cache/tree_cache.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <exception>
#include <map>
#include <mutex>
#include <span>
#include <system_error>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "core/files/checksum.h"
#include "core/files/input_file.h"
#include "core/files/ownership.h"
#include "core/files/sha256.h"
#include "core/files/user_folders.h"

namespace nearfit {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kTreeEnding = ".nearfit-tree", kTextEnding = ".nearfit-text";
/// A checksum, in hexadecimal digits, and a line break before a text.
constexpr std::size_t kChecksumBytes = 17;
constexpr std::size_t kNameDigits = 64;
constexpr const char* kTrustRemedy =
    "make it yours alone (chown, chmod 700), or name another folder in NEARFIT_CACHE";

struct Entry {
  fs::path path;
  std::uint64_t bytes;
  fs::file_time_type used;
};

/// True for the name of a cache file. Other things in the folder are never counted or removed.
bool isOurs(const std::string& name) {
  const auto endsIn = [&](std::string_view ending) {
    return name.size() == kNameDigits + ending.size() && name.ends_with(ending);
  };
  return (endsIn(kTreeEnding) || endsIn(kTextEnding)) &&
         std::all_of(name.begin(), name.begin() + kNameDigits,
                     [](unsigned char c) { return std::isxdigit(c) != 0; });
}

bool isTree(const fs::path& file) {
  return file.extension() == kTreeEnding;
}

/// Lists the cache files in the folder; none if it does not exist. Throws FileError if it cannot be read.
std::vector<Entry> entriesOf(const fs::path& folder) {
  std::vector<Entry> entries;
  std::error_code failure;
  if (fs::status(folder, failure).type() == fs::file_type::not_found) return entries;
  failure.clear();
  for (fs::directory_iterator it(folder, failure), end; !failure && it != end; it.increment(failure)) {
    // Another process may remove the file meanwhile, so any of these calls can fail.
    std::error_code unknown;
    if (!isOurs(it->path().filename().string()) || !fs::is_regular_file(it->symlink_status(unknown)))
      continue;
    const fs::file_time_type used = fs::last_write_time(it->path(), unknown);
    if (unknown) continue;
    const std::uintmax_t bytes = fs::file_size(it->path(), unknown);
    if (!unknown) entries.push_back({it->path(), bytes, used});
  }
  if (failure) {
    throw FileError(folder.string(), "the cache cannot be read: " + failure.message(),
                    "change its permissions, or name another folder in NEARFIT_CACHE");
  }
  return entries;
}

/// Closes the folder that no user has named or linked to others, as earlier versions did not.
void closeDefaultFolder(const fs::path& folder) {
  std::error_code ignored;
  if (folder == userFolder(UserFiles::Cache) && !fs::is_symlink(folder, ignored))
    fs::permissions(folder, fs::perms::owner_all, ignored);
}

/// Bytes that this process may write to a folder before it lists it again: listing takes as long as the folder has files,
/// and an assembly writes hundreds.
struct Room {
  std::uint64_t maxBytes = 0, bytes = 0;
};
/// Share of the free bytes that one process may write: several may fill a folder at once.
constexpr std::uint64_t kRoomShare = 4;

std::mutex roomMutex;
std::map<fs::path, Room> roomOf;  ///< By folder; guarded by the mutex.

/// True if a file of so many bytes fits, whatever else is in the folder.
bool takeRoom(const TreeCacheSettings& settings, std::uint64_t bytes) {
  const std::lock_guard lock(roomMutex);
  const auto at = roomOf.find(settings.folder);
  if (at == roomOf.end() || at->second.maxBytes != settings.maxBytes || at->second.bytes < bytes)
    return false;
  at->second.bytes -= bytes;
  return true;
}

/// @param total  Bytes in the folder.
void setRoom(const TreeCacheSettings& settings, std::uint64_t total) {
  const std::lock_guard lock(roomMutex);
  const std::uint64_t left = settings.maxBytes - std::min(total, settings.maxBytes);
  roomOf[settings.folder] = {settings.maxBytes, left / kRoomShare};
}

std::string checksumLine(std::string_view text) {
  return fmt::format("{:016x}\n", checksumOf(std::as_bytes(std::span(text))));
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
  const char* const end = text.data() + text.size();
  std::uint64_t whole = 0;
  auto [rest, failure] = std::from_chars(text.data(), end, whole);
  if (failure != std::errc()) return std::nullopt;
  double fraction = 0.0;
  const bool hasFraction = rest != end && *rest == '.';
  if (hasFraction) {
    const auto read = std::from_chars(rest, end, fraction, std::chars_format::fixed);
    if (read.ec != std::errc()) return std::nullopt;
    rest = read.ptr;
  }
  const std::size_t unit = rest != end ? kUnits.find(*rest) : std::string_view::npos;
  const bool hasUnit = unit != std::string_view::npos;
  if (hasUnit) ++rest;
  if (rest != end && *rest == 'B') ++rest;
  if (rest != end || (hasFraction && !hasUnit)) return std::nullopt;
  const int shift = hasUnit ? 10 * static_cast<int>(unit + 1) : 0;
  if (whole != 0 && std::countl_zero(whole) < shift) return std::nullopt;
  const std::uint64_t one = std::uint64_t{1} << shift;
  // A fraction of many nines rounds to 1.
  const auto part = static_cast<std::uint64_t>(fraction * static_cast<double>(one));
  return (whole << shift) + std::min(part, one - 1);
}

TreeCacheSettings treeCacheSettings() {
  TreeCacheSettings settings;
  settings.folder = folderFromEnvironment();
  settings.maxBytes = parseByteSize(variable("NEARFIT_CACHE_SIZE")).value_or(kDefaultTreeCacheBytes);
  return settings;
}

std::vector<std::string> treeCacheWarnings() {
  std::vector<std::string> warnings;
  const TreeCache cache;
  if (!cache.isOn()) return warnings;
  const std::string size = variable("NEARFIT_CACHE_SIZE");
  if (!size.empty() && !parseByteSize(size)) {
    warnings.push_back(fmt::format(
        "NEARFIT_CACHE_SIZE: \"{}\" is not a size, so the limit is {} bytes; give a size such as 1.5G", size,
        kDefaultTreeCacheBytes));
  }
  if (const std::string why = cache.distrust(); !why.empty()) {
    warnings.push_back(fmt::format("{}: this cache is not used, since {}; {}",
                                   cache.settings().folder.string(), why, kTrustRemedy));
  }
  return warnings;
}

fs::path TreeCache::pathOf(const TreeCacheKey& key, std::string_view ending) const {
  const std::string content = fmt::format(
      "{} {:016x} {}", key.sha256, std::bit_cast<std::uint64_t>(key.metresPerUnit), treeCacheFingerprint());
  return settings_.folder / (sha256OfBytes(content) + std::string(ending));
}

std::string TreeCache::distrust() const {
  return isOn() ? distrustOfFolder(settings_.folder) : std::string();
}

void TreeCache::requireTrust() const {
  const std::string why = distrust();
  if (!why.empty())
    throw FileError(settings_.folder.string(), "this cache is not used, since " + why, kTrustRemedy);
}

std::optional<TreeCacheFile> TreeCache::find(const TreeCacheKey& key) const {
  if (!isOn() || !distrust().empty()) return std::nullopt;
  std::optional<TreeCacheFile> file = TreeCacheFile::open(pathOf(key, kTreeEnding), key);
  if (file) file->touch();
  return file;
}

bool TreeCache::store(const TreeCacheKey& key, const CachedMesh& mesh, const CachedTree* tree) const {
  if (!isOn() || mesh.mesh.triangles().size() < settings_.leastTriangles) return false;
  const fs::path path = pathOf(key, kTreeEnding);
  return keep(path, [&] { return writeTreeCacheFile(path, key, mesh, tree, settings_.maxBytes) > 0; });
}

std::optional<std::string> TreeCache::findText(const TreeCacheKey& key) const {
  if (!isOn() || !distrust().empty()) return std::nullopt;
  try {
    const InputFile file(pathOf(key, kTextEnding), FileOwner::User);
    if (file.size() < kChecksumBytes || file.size() > kChecksumBytes + kMaxCachedTextBytes)
      return std::nullopt;
    std::string text(static_cast<std::size_t>(file.size()), '\0');
    if (!file.readAt(0, std::as_writable_bytes(std::span(text)))) return std::nullopt;
    const std::string checksum = text.substr(0, kChecksumBytes);
    text.erase(0, kChecksumBytes);
    if (checksum != checksumLine(text)) return std::nullopt;
    file.touch();
    return text;
  } catch (const FileError&) {
    return std::nullopt;
  }
}

bool TreeCache::storeText(const TreeCacheKey& key, std::string_view text) const {
  if (!isOn() || text.size() > kMaxCachedTextBytes || kChecksumBytes + text.size() > settings_.maxBytes)
    return false;
  const fs::path path = pathOf(key, kTextEnding);
  return keep(path, [&] {
    // As a mesh: the file may be one that only the user can read.
    AtomicFile out(path, FileAccess::Private, Unfinished::Hidden, Links::Replace);
    out.write(checksumLine(text));
    out.write(text);
    out.commit(AtomicFile::Flush::Later);
    return true;
  });
}

bool TreeCache::keep(const fs::path& file, const std::function<bool()>& write) const {
  try {
    createPrivateFolder(settings_.folder);
    requireTrust();
    closeDefaultFolder(settings_.folder);
    if (!write()) return false;
    evict(file);
    return true;
  } catch (const std::exception&) {
    return false;  // Disk full, folder not writable, no memory: the next time takes as long as this time.
  }
}

void TreeCache::evict(const fs::path& newest) const {
  std::error_code unknown;
  const std::uintmax_t written = fs::file_size(newest, unknown);
  if (!unknown && takeRoom(settings_, written)) return;
  std::vector<Entry> entries = entriesOf(settings_.folder);
  std::uint64_t total = 0;
  for (const Entry& entry : entries)
    total += entry.bytes;
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.used < b.used; });
  for (const Entry& entry : entries) {
    if (total <= settings_.maxBytes) break;
    if (entry.path == newest) continue;
    std::error_code failure;
    if (fs::remove(entry.path, failure)) total -= entry.bytes;
  }
  setRoom(settings_, total);
}

TreeCache::Usage TreeCache::usage() const {
  requireTrust();
  Usage usage;
  for (const Entry& entry : entriesOf(settings_.folder)) {
    usage.files += isTree(entry.path) ? 1 : 0;
    usage.bytes += entry.bytes;
  }
  return usage;
}

TreeCache::Usage TreeCache::clear() const {
  requireTrust();
  removeAbandoned(settings_.folder);
  Usage removed;
  for (const Entry& entry : entriesOf(settings_.folder)) {
    std::error_code failure;
    fs::remove(entry.path, failure);
    if (failure) {
      throw FileError(entry.path.string(), "it cannot be removed: " + failure.message(),
                      "check the permissions of its folder");
    }
    removed.files += isTree(entry.path) ? 1 : 0;
    removed.bytes += entry.bytes;
  }
  return removed;
}

}  // namespace nearfit
