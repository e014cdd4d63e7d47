#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/files/input_file.h"
#include "core/mesh/exact_surface.h"
#include "core/proximity/cache/tree_cache_format.h"

namespace nearfit {

/// Key of a cached mesh.
struct TreeCacheKey {
  /// Of the mesh file's bytes, or of what names or makes up a shape of a CAD document; 64 hexadecimal digits.
  std::string sha256;
  double metresPerUnit = 1.0;  ///< Unit of the mesh file [m].
};

/// What a shape of a CAD document has besides its mesh.
struct CachedShape {
  /// In metres, with a face for each triangle of the mesh; null if the shape has no faces of its own.
  std::shared_ptr<const SurfaceFaces> surfaces;
  std::vector<std::optional<std::array<float, 3>>> faceColours;  ///< sRGB, for each face; or empty.
  double chord = 0.0, angle = 0.0;                               ///< Tessellation in effect [m, rad].
  double exactVolume = 0.0;                                      ///< Of the exact solid [m^3]; 0 if unknown.
  bool isExact = false;                                          ///< Came from exact surfaces.
  double statedUnit = 1.0;                                       ///< See PartGeometry.
};

/// Mesh of a mesh file or of a shape of a CAD document, and what loading found out about it.
struct CachedMesh {
  TriangleMesh mesh;
  MeshBuildReport report;
  MassProperties mass;
  std::optional<CachedShape> shape = std::nullopt;  ///< No value for a mesh file.
};

/// Hierarchy of a mesh, and what is found out along with it. Copies share the arrays.
struct CachedTree {
  NormalConeTree tree;
  bool isSolid = false;  ///< Result of isSolidThroughout.
};

/// Open cache file. Nothing in it is trusted: each part is read to memory and checked there as a whole,
/// checksums and every index, before it is returned. Later changes of the file do not reach it.
class TreeCacheFile {
 public:
  /// Opens a cache file. No value if it does not exist, is not the user's alone (FileOwner::User), has
  /// another key, is of an older or newer version, is truncated, or has a damaged header.
  static std::optional<TreeCacheFile> open(const std::filesystem::path& file, const TreeCacheKey& key);

  /// Reads the mesh; no value if it is damaged or does not fit in memory.
  std::optional<CachedMesh> mesh() const;
  bool hasTree() const noexcept { return header_.counts[index(TreeCacheSection::TreeFacts)] == 1; }
  /// Reads the hierarchy, likewise; no value if there is none.
  /// @param mesh  The mesh of the file.
  std::optional<CachedTree> tree(const TriangleMesh& mesh) const;
  /// Marks the file as just used.
  void touch() const noexcept { file_->touch(); }

 private:
  static constexpr std::size_t index(TreeCacheSection section) { return static_cast<std::size_t>(section); }

  /// Sections in memory, one after the other as in the file; their checksums are right.
  struct Sections {
    std::shared_ptr<std::byte> bytes;  ///< At a multiple of kTreeCacheAlignment.
    std::size_t offset = 0;            ///< Of the first byte in the file.
  };
  /// Bytes of a section that share a checksum, with the zeros that follow them in the file.
  struct Block {
    std::size_t offset, size, zeros;
    std::uint64_t checksum;
  };

  TreeCacheFile(std::shared_ptr<const InputFile> file, const TreeCacheHeader& header,
                const TreeCacheLayout& layout, std::vector<std::byte> blockChecksums)
      : file_(std::move(file)),
        header_(header),
        layout_(layout),
        blockChecksums_(std::move(blockChecksums)) {}
  /// Blocks of the sections from `first` to `last`.
  std::vector<Block> blocks(TreeCacheSection first, TreeCacheSection last) const;
  /// Reads a block to its place; false if the file is shorter or the block is damaged. Throws FileError.
  bool take(const Block& block, const Sections& to) const;
  /// Reads the sections from `first` to `last`; no value if one is damaged.
  std::optional<Sections> read(TreeCacheSection first, TreeCacheSection last) const;
  std::size_t count(TreeCacheSection section) const noexcept {
    return static_cast<std::size_t>(header_.counts[index(section)]);
  }
  template <typename T>
  SharedArray<T> array(const Sections& from, TreeCacheSection section) const;
  /// Arrays of a mesh whose first section is `vertices`, not checked yet.
  TriangleMesh::Arrays meshArrays(const Sections& from, TreeCacheSection vertices,
                                  const std::array<double, 6>& bounds,
                                  const std::array<std::uint32_t, 4>& topology) const;
  /// Mesh of the hierarchy and its deviation; no value if it is damaged.
  struct Searched {
    TriangleMesh mesh;
    double deviation = 0.0;
  };
  std::optional<Searched> searched(const Sections& from, const TriangleMesh& mesh) const;
  std::optional<MeshBuildReport> report(const Sections& from, const MeshFacts& facts) const;
  /// False if the sections of a shape are damaged. No shape if there is none.
  bool readShape(const Sections& from, std::size_t triangles, std::optional<CachedShape>& shape) const;

  std::shared_ptr<const InputFile> file_;
  TreeCacheHeader header_;
  TreeCacheLayout layout_;
  std::vector<std::byte> blockChecksums_;
};

/// Writes a cache file atomically, readable by the user only, in place of a symbolic link too. Does not flush
/// it to disk: checksums detect what a crash damages. `tree` may be null. Throws FileError, and Error if the
/// mesh cannot be cached (a warning contains a zero) or the key has no SHA-256.
/// @param maxBytes  If the file would be larger, or a section would have 2^32 elements or more, writes
///                  nothing and returns 0; else returns the file's size.
std::uint64_t writeTreeCacheFile(const std::filesystem::path& file, const TreeCacheKey& key,
                                 const CachedMesh& mesh, const CachedTree* tree, std::uint64_t maxBytes);

}  // namespace nearfit
