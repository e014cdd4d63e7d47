#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/proximity/cache/tree_cache_file.h"

namespace nearfit {

/// Mesh files of fewer triangles are not cached: reading the file and building the hierarchy takes some
/// milliseconds, and thousands of small files would push out the few large ones that take seconds.
constexpr std::size_t kMinCachedTriangles = 2000;

/// Max size of the cache unless NEARFIT_CACHE_SIZE sets another [bytes].
constexpr std::uint64_t kDefaultTreeCacheBytes = std::uint64_t{4} << 30;

/// Max size of a text that is kept [bytes]: the tree of an assembly of tens of thousands of instances.
constexpr std::size_t kMaxCachedTextBytes = std::size_t{16} << 20;

/// Settings of the cache; see treeCacheSettings().
struct TreeCacheSettings {
  std::filesystem::path folder;  ///< Empty: the cache is off.
  std::uint64_t maxBytes = kDefaultTreeCacheBytes;
  std::size_t leastTriangles = kMinCachedTriangles;
};

/// Reads the settings from the environment. NEARFIT_CACHE names the folder or is "off"; the default is
/// `nearfit` in XDG_CACHE_HOME, or in `.cache` of HOME. NEARFIT_CACHE_SIZE is a size for parseByteSize().
/// Invalid values are ignored; treeCacheWarnings() tells of them.
TreeCacheSettings treeCacheSettings();

/// Parses a number of bytes, such as "1000", "100M", "1.5G" or "4GB": a whole number, or any number followed
/// by K, M, G or T (powers of 1024); a B may follow. No value if the text is anything else.
std::optional<std::uint64_t> parseByteSize(const std::string& text);

/// Why the cache that the environment names is not used as it says, a sentence each: a size that is no size,
/// a folder that is not the user's alone. Empty if all is well or the cache is off.
std::vector<std::string> treeCacheWarnings();

/// Folder of meshes with their hierarchies, keyed by the content of the files that they come from, and of texts about
/// those files. Any number of threads and
/// processes may use one folder at once. The cache can only save time: a damaged file, or one of another
/// version, counts as absent, and a folder that cannot be written stays as it is. So does one in which other
/// users could have written, or that belongs to another: nothing in it is used. A folder that is created, and
/// all files, are readable by the user only.
class TreeCache {
 public:
  explicit TreeCache(TreeCacheSettings settings = treeCacheSettings()) : settings_(std::move(settings)) {}

  bool isOn() const noexcept { return !settings_.folder.empty(); }
  const TreeCacheSettings& settings() const noexcept { return settings_; }
  /// Why the folder is not used (see distrustOf); empty if it may be, or does not exist.
  std::string distrust() const;

  /// Opens the file cached for the key, its parts not checked yet, and marks it as just used; no value if
  /// there is none.
  std::optional<TreeCacheFile> find(const TreeCacheKey& key) const;
  /// Caches a mesh, with its hierarchy unless that is null, in place of what was cached for the key. Then
  /// removes the least recently used files until the rest is within `maxBytes`; the folder is only looked through where
  /// what this process has written since the last time may not fit. False if nothing was cached, for whatever reason.
  bool store(const TreeCacheKey& key, const CachedMesh& mesh, const CachedTree* tree) const;

  /// Text cached for the key, as it was stored, and marks it as just used; no value if there is none.
  std::optional<std::string> findText(const TreeCacheKey& key) const;
  /// Caches a text, such as the tree of a document, likewise. False if nothing was cached, also if the text has more
  /// than kMaxCachedTextBytes.
  bool storeText(const TreeCacheKey& key, std::string_view text) const;

  struct Usage {
    std::size_t files = 0;  ///< Of meshes; texts count by their bytes.
    std::uint64_t bytes = 0;
  };
  /// Number and size of the cached files. Throws FileError if the folder cannot be read or is not used.
  Usage usage() const;
  /// Removes all cached files and returns what they were. Throws FileError, also if one cannot be removed.
  Usage clear() const;

 private:
  std::filesystem::path pathOf(const TreeCacheKey& key, std::string_view ending) const;
  /// Has `write` write the file, which returns false if it has not, and makes room for it.
  bool keep(const std::filesystem::path& file, const std::function<bool()>& write) const;
  void evict(const std::filesystem::path& newest) const;
  void requireTrust() const;

  TreeCacheSettings settings_;
};

}  // namespace nearfit
