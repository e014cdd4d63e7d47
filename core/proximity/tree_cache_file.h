#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "core/files/mapped_file.h"
#include "core/proximity/tree_cache_format.h"

namespace nearfit {

/// What a cached mesh is known by.
struct TreeCacheKey {
  std::string sha256;  ///< Of the mesh file's bytes, 64 hexadecimal digits.
  double metresPerUnit = 1.0;
};

/// A mesh file's mesh, and what loading found out about it.
struct CachedMesh {
  TriangleMesh mesh;
  MeshBuildReport report;
  MassProperties mass;
};

/// The hierarchy of a mesh, and what is found out along with it. Copies share the arrays.
struct CachedTree {
  NormalConeTree tree;
  bool isSolid = false;  ///< As isSolidThroughout says.
};

/// A cache file that is mapped. Nothing in it is trusted: each part is checked as a whole, checksums and
/// every index, before it is given away.
class TreeCacheFile {
 public:
  /// None when there is no such file, it is another's, older or newer, cut short, or its header is damaged.
  static std::optional<TreeCacheFile> open(const std::filesystem::path& file, const TreeCacheKey& key);

  /// None when it is damaged. What is returned keeps the mapping alive and uses it in place.
  std::optional<CachedMesh> mesh() const;
  bool hasTree() const noexcept { return header_.counts[index(TreeCacheSection::TreeFacts)] == 1; }
  /// None when it is damaged or there is none.
  std::optional<CachedTree> tree() const;

 private:
  static constexpr std::size_t index(TreeCacheSection section) { return static_cast<std::size_t>(section); }

  TreeCacheFile(std::shared_ptr<const MappedFile> file, const TreeCacheHeader& header,
                const TreeCacheLayout& layout)
      : file_(std::move(file)), header_(header), layout_(layout) {}
  bool isIntact(TreeCacheSection first, TreeCacheSection last) const;
  std::size_t count(TreeCacheSection section) const noexcept {
    return static_cast<std::size_t>(header_.counts[index(section)]);
  }
  template <typename T>
  SharedArray<T> array(TreeCacheSection section) const;
  std::optional<MeshBuildReport> report(const MeshFacts& facts) const;

  std::shared_ptr<const MappedFile> file_;
  TreeCacheHeader header_;
  TreeCacheLayout layout_;
};

/// Puts a file in place atomically. Not flushed to disk: what a crash damages, checksums find. `tree` may be
/// null. Throws FileError; Error when the mesh cannot be cached (a warning with a zero in it).
/// @param maxBytes  Writes nothing and returns 0 when the file would be larger; else its size.
std::uint64_t writeTreeCacheFile(const std::filesystem::path& file, const TreeCacheKey& key,
                                 const CachedMesh& mesh, const CachedTree* tree, std::uint64_t maxBytes);

}  // namespace nearfit
