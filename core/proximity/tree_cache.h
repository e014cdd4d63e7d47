#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "core/proximity/tree_cache_file.h"

namespace nearfit {

/// Meshes of fewer triangles are not kept: reading the file and building the hierarchy takes some
/// milliseconds, and thousands of small files would push out the few large ones that take seconds.
constexpr std::size_t kLeastCachedTriangles = 2000;

/// How much the cache may hold unless NEARFIT_CACHE_SIZE says otherwise [bytes].
constexpr std::uint64_t kDefaultTreeCacheBytes = std::uint64_t{4} << 30;

struct TreeCacheSettings {
  std::filesystem::path folder;  ///< Empty: nothing is cached.
  std::uint64_t maxBytes = kDefaultTreeCacheBytes;
  std::size_t leastTriangles = kLeastCachedTriangles;
};

/// As the environment has it: NEARFIT_CACHE names the folder or says "off"; without it, it is `nearfit` in
/// XDG_CACHE_HOME, or in `.cache` of HOME; NEARFIT_CACHE_SIZE is a number of bytes, or one with K, M, G or T
/// (powers of 1024) behind; what makes no sense counts as not said.
TreeCacheSettings treeCacheSettings();

/// Bytes as NEARFIT_CACHE_SIZE writes them; none when the text is anything else.
std::optional<std::uint64_t> parseByteSize(const std::string& text);

/// A folder of meshes with their hierarchies, known by the content of the mesh files. Any number of threads
/// and processes may use one folder at once. It can only save time: a file that is damaged, or that another
/// version wrote, is as good as none, and a folder that cannot be written stays as it is.
class TreeCache {
 public:
  explicit TreeCache(TreeCacheSettings settings = treeCacheSettings()) : settings_(std::move(settings)) {}

  bool isOn() const noexcept { return !settings_.folder.empty(); }
  const TreeCacheSettings& settings() const noexcept { return settings_; }

  /// What is kept for the key, its parts not checked yet, and marks it as used just now.
  std::optional<TreeCacheFile> find(const TreeCacheKey& key) const;
  /// Keeps a mesh, with its hierarchy unless that is null, in place of what was kept for the key. Removes
  /// what was not used for longest until the rest is no larger than allowed. False when nothing was kept.
  bool store(const TreeCacheKey& key, const CachedMesh& mesh, const CachedTree* tree) const;

  struct Usage {
    std::size_t files = 0;
    std::uint64_t bytes = 0;
  };
  Usage usage() const;
  /// Removes all that is kept; returns what that was. Throws FileError when some of it cannot be removed.
  Usage clear() const;

 private:
  std::filesystem::path pathOf(const TreeCacheKey& key) const;
  void evict(const std::filesystem::path& newest) const;

  TreeCacheSettings settings_;
};

}  // namespace nearfit
