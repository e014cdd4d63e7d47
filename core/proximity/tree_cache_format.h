#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/mesh/mass_properties.h"
#include "core/mesh/mesh_builder.h"
#include "core/proximity/normal_cone_tree.h"

/// How a mesh with all that is derived from it lies in a cache file, for the code that writes and reads them:
///
///     TreeCacheHeader
///     checksum of each block of each section, 8 bytes each
///     sections in the order of TreeCacheSection, each from a multiple of 64 bytes on, zeros between
///
/// Sections are the arrays as they lie in memory, so that a mapped file is used in place. A file without a
/// hierarchy has the sections from TreeFacts on empty.
namespace nearfit {

/// Goes up by one whenever this layout changes, or the meaning of a field. What import and building compute
/// needs no number: the header carries a fingerprint of their sources (see core/CMakeLists.txt).
constexpr std::uint32_t kTreeCacheVersion = 3;

/// Bytes of a section that share a checksum: enough work for a thread, enough threads for a large file.
constexpr std::size_t kTreeCacheBlock = std::size_t{2} << 20;
/// As NormalConeTree::Node asks for.
constexpr std::size_t kTreeCacheAlignment = 64;

enum class TreeCacheSection : std::uint8_t {
  MeshFacts,
  Warnings,  ///< Characters; a zero behind each warning.
  Vertices,
  Triangles,
  Edges,
  EdgeFaces,
  TriangleEdges,
  VertexEdges,
  VertexFirstEdge,
  TreeFacts,
  Nodes,
  Positions,
  VertexLeaves,
  EdgeLeaves,
  FaceLeaves,
  Neighbours,
};
constexpr std::size_t kTreeCacheSections = 16;

/// What a mesh is besides its arrays.
struct MeshFacts {
  std::array<double, 6> bounds;         ///< Lower, upper.
  std::array<double, 13> mass;          ///< Volume, centre, inertia by columns.
  std::array<std::uint64_t, 6> counts;  ///< Of MeshBuildReport, in its order.
  std::array<std::uint32_t, 4> topology;
  std::uint32_t massBasis, turnedInsideOut;
};
static_assert(sizeof(MeshFacts) == 224);

struct TreeFacts {
  std::array<double, 4> centreAndSize;
  std::array<std::uint64_t, 3> all;  ///< FeatureCounts, in their order.
  std::uint64_t isSolid;             ///< 0 or 1, see isSolidThroughout.
};
static_assert(sizeof(TreeFacts) == 64);

struct TreeCacheHeader {
  std::array<char, 8> magic;
  std::uint32_t byteOrder;
  std::uint32_t version;
  std::array<std::uint32_t, kTreeCacheSections> elementBytes;
  std::array<char, 64> fingerprint;  ///< Of the sources that compute what is here.
  std::array<char, 64> sha256;       ///< Of the mesh file, hexadecimal.
  double metresPerUnit;
  std::array<std::uint64_t, kTreeCacheSections> counts;  ///< Elements.
  std::uint64_t checksum;                                ///< See treeCacheChecksum().
  std::array<char, 32> reserved;
};
static_assert(sizeof(TreeCacheHeader) == 384);

/// Where each section begins and what it is checked by, as follows from its number of elements.
struct TreeCacheLayout {
  std::array<std::size_t, kTreeCacheSections + 1> offsets;     ///< The last is the file's size.
  std::array<std::size_t, kTreeCacheSections> bytes;           ///< Without the zeros behind.
  std::array<std::size_t, kTreeCacheSections + 1> firstBlock;  ///< The last is how many there are.
};

/// Differs between programs that would write different files for a mesh.
std::string treeCacheFingerprint();

/// The header of a file for that mesh file, without numbers of elements and checksum.
TreeCacheHeader treeCacheHeader(std::span<const char, 64> sha256, double metresPerUnit) noexcept;

/// None when there are more elements of a kind than 32 bits can name.
std::optional<TreeCacheLayout> treeCacheLayout(
    const std::array<std::uint64_t, kTreeCacheSections>& counts) noexcept;

/// What the header's checksum should be.
/// @param blockChecksums  All between the header and the first section.
std::uint64_t treeCacheChecksum(TreeCacheHeader header, std::span<const std::byte> blockChecksums) noexcept;

MeshFacts meshFactsOf(const TriangleMesh& mesh, const MeshBuildReport& report, const MassProperties& mass);

}  // namespace nearfit
