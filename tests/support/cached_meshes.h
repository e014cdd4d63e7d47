#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "core/proximity/cache/tree_cache.h"

/// Meshes to put into a cache, and cache files to spoil.
namespace nearfit::test {

/// As loading makes it, with a report of which nothing is zero.
CachedMesh cachedMeshOf(TriangleMesh mesh);

/// Whether all arrays and numbers are the same, bit by bit.
bool areSame(const TriangleMesh& a, const TriangleMesh& b);
bool areSame(const NormalConeTree& a, const NormalConeTree& b);
bool areSame(const CachedMesh& a, const CachedMesh& b);

/// The one file of ours in a cache's folder; throws std::runtime_error when there is none or more.
std::filesystem::path onlyFileIn(const std::filesystem::path& folder);

/// A cache file's bytes, to be changed.
class CacheImage {
 public:
  explicit CacheImage(const std::filesystem::path& file);

  std::string bytes;

  TreeCacheHeader header() const;
  void setHeader(const TreeCacheHeader& header);
  /// Where a section begins, and its bytes. The layout is that of the file as it was read.
  std::size_t offset(TreeCacheSection section) const;
  std::size_t size(TreeCacheSection section) const;
  const TreeCacheLayout& layout() const noexcept { return layout_; }

  template <typename T>
  T value(TreeCacheSection section, std::size_t byte) const {
    T value;
    bytes.copy(reinterpret_cast<char*>(&value), sizeof(T), offset(section) + byte);
    return value;
  }
  template <typename T>
  void set(TreeCacheSection section, std::size_t byte, const T& value) {
    bytes.replace(offset(section) + byte, sizeof(T), reinterpret_cast<const char*>(&value), sizeof(T));
  }
  /// Makes all checksums right for what is there now.
  void seal();

 private:
  TreeCacheLayout layout_;
};

}  // namespace nearfit::test
