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
#include "core/proximity/hierarchy/normal_cone_tree.h"

/// Layout of a cache file, which holds a mesh and all that is derived from it:
///
///     TreeCacheHeader
///     checksum of each block of each section, 8 bytes each
///     sections in the order of TreeCacheSection, each at a multiple of 64 bytes, zeros between
///
/// Sections are the arrays as they lie in memory: what is read is used in place. The sections from ShapeFacts to
/// FaceOfTriangle are empty but for a shape of a CAD document, and the last three if it has no faces of its own. In a
/// file without a hierarchy, the sections from TreeFacts on are empty. The sections from SearchedFacts on hold the mesh of
/// the hierarchy, with its flats merged; they are empty if that is the mesh itself.
namespace nearfit {

/// Increases by one whenever this layout or the meaning of a field changes. What import and building compute
/// needs no number: the header carries a fingerprint of their sources (see core/CMakeLists.txt).
constexpr std::uint32_t kTreeCacheVersion = 7;

/// Bytes of a section that share a checksum: enough work for a thread, and enough blocks in a large file.
constexpr std::size_t kTreeCacheBlock = std::size_t{2} << 20;
/// Alignment of sections, as NormalConeTree::Node requires [bytes].
constexpr std::size_t kTreeCacheAlignment = 64;

/// Sections of a cache file, in order.
enum class TreeCacheSection : std::uint8_t {
  MeshFacts,
  Warnings,  ///< Characters; each warning ends with a zero.
  Vertices,
  Triangles,
  Edges,
  EdgeFaces,
  TriangleEdges,
  VertexEdges,
  VertexFirstEdge,
  ShapeFacts,
  ShapeFaces,
  FaceColours,  ///< One for each face, or none.
  FaceOfTriangle,
  TreeFacts,
  Nodes,
  Positions,
  VertexLeaves,
  EdgeLeaves,
  FaceLeaves,
  Neighbours,
  SearchedFacts,
  SearchedVertices,
  SearchedTriangles,
  SearchedEdges,
  SearchedEdgeFaces,
  SearchedTriangleEdges,
  SearchedVertexEdges,
  SearchedVertexFirstEdge,
};
constexpr std::size_t kTreeCacheSections = 28;

/// What a mesh has besides its arrays.
struct MeshFacts {
  std::array<double, 6> bounds;         ///< Lower, upper.
  std::array<double, 13> mass;          ///< Volume, centre, inertia by columns.
  std::array<std::uint64_t, 6> counts;  ///< Counts of MeshBuildReport, in its order.
  std::array<std::uint32_t, 4> topology;
  std::uint32_t massBasis, turnedInsideOut;
  double coordinateRounding;  ///< Of MeshBuildReport [m].
};
static_assert(sizeof(MeshFacts) == 232);

/// What a shape of a CAD document has besides its mesh and faces.
struct ShapeFacts {
  double chord, angle, exactVolume;  ///< See CachedShape.
  std::uint64_t isExact;             ///< 0 or 1.
  double statedUnit;                 ///< See CachedShape.
};
static_assert(sizeof(ShapeFacts) == 40);

/// An ExactSurface, without gaps between its numbers.
struct ShapeFace {
  std::array<double, 3> point, direction;
  double radius, minorRadius, halfAngle;
  std::uint32_t kind, isHollow;
};
static_assert(sizeof(ShapeFace) == 80);

/// Colour of a face; `isSet` is 0 for a face in the part's own colour, else 1.
struct ShapeColour {
  std::array<float, 3> rgb;
  std::uint32_t isSet;
};
static_assert(sizeof(ShapeColour) == 16);

/// What a hierarchy has besides its arrays.
struct TreeFacts {
  std::array<double, 4> centreAndSize;
  std::array<std::uint64_t, 3> all;  ///< Fields of FeatureCounts, in their order.
  std::uint64_t isSolid;             ///< 0 or 1, see isSolidThroughout.
};
static_assert(sizeof(TreeFacts) == 64);

/// Box, topology and deviation of the mesh of a hierarchy; its arrays are sections.
struct SearchedFacts {
  std::array<double, 6> bounds;  ///< Lower, upper.
  std::array<std::uint32_t, 4> topology;
  double deviation;  ///< NormalConeTree::deviation() [m].
};
static_assert(sizeof(SearchedFacts) == 72);

/// Header of a cache file.
struct TreeCacheHeader {
  std::array<char, 8> magic;
  std::uint32_t byteOrder;
  std::uint32_t version;
  std::array<std::uint32_t, kTreeCacheSections> elementBytes;
  std::array<char, 64> fingerprint;  ///< Fingerprint of the sources that compute the contents.
  std::array<char, 64> sha256;       ///< Of the key, hexadecimal.
  double metresPerUnit;
  std::array<std::uint64_t, kTreeCacheSections> counts;  ///< Number of elements, by section.
  std::uint64_t checksum;                                ///< See treeCacheChecksum().
  std::array<char, 32> reserved;
};
static_assert(sizeof(TreeCacheHeader) == 528);

/// Where each section and its blocks begin, as follows from the numbers of elements.
struct TreeCacheLayout {
  std::array<std::size_t, kTreeCacheSections + 1> offsets;     ///< [bytes]; the last is the file's size.
  std::array<std::size_t, kTreeCacheSections> bytes;           ///< Without the zeros behind.
  std::array<std::size_t, kTreeCacheSections + 1> firstBlock;  ///< The last is the number of blocks.
};

/// Returns a string that differs between programs that would write different files for a mesh.
std::string treeCacheFingerprint();

/// Returns the header of a file for a mesh file, without numbers of elements and checksum.
TreeCacheHeader treeCacheHeader(std::span<const char, 64> sha256, double metresPerUnit) noexcept;

/// Returns the layout; no value if a section has more elements than 32 bits can name.
std::optional<TreeCacheLayout> treeCacheLayout(
    const std::array<std::uint64_t, kTreeCacheSections>& counts) noexcept;

/// Returns the checksum that belongs in the header.
/// @param blockChecksums  All bytes between the header and the first section.
std::uint64_t treeCacheChecksum(TreeCacheHeader header, std::span<const std::byte> blockChecksums) noexcept;

/// Collects what the mesh of a hierarchy has besides its arrays.
SearchedFacts searchedFactsOf(const NormalConeTree& tree);

/// Collects what a mesh has besides its arrays.
MeshFacts meshFactsOf(const TriangleMesh& mesh, const MeshBuildReport& report, const MassProperties& mass);

}  // namespace nearfit
