#include "core/proximity/cache/tree_cache_format.h"

#include <algorithm>
#include <string_view>

#include "geometry_fingerprint.h"

#include "core/files/checksum.h"

namespace nearfit {
namespace {

constexpr std::array<char, 8> kMagic{'N', 'E', 'A', 'R', 'F', 'I', 'T', '\n'};
/// Reads as another number on a big-endian machine.
constexpr std::uint32_t kByteOrder = 0x01020304;

using Sizes = std::array<std::uint32_t, kTreeCacheSections>;

/// Adds the sizes of the elements of a mesh's arrays, from its vertices on.
constexpr std::size_t addMeshSizes(Sizes& sizes, std::size_t next) {
  for (const std::size_t size :
       {sizeof(glm::dvec3), sizeof(Triangle), sizeof(MeshEdge), sizeof(std::uint32_t),
        sizeof(std::array<std::uint32_t, 3>), sizeof(std::uint32_t), sizeof(std::uint32_t)})
    sizes[next++] = static_cast<std::uint32_t>(size);
  return next;
}

constexpr Sizes elementSizes() {
  Sizes sizes{};
  std::size_t next = 0;
  sizes[next++] = sizeof(MeshFacts);
  sizes[next++] = sizeof(char);
  next = addMeshSizes(sizes, next);
  for (const std::size_t size :
       {sizeof(ShapeFacts), sizeof(ShapeFace), sizeof(ShapeColour), sizeof(std::uint32_t), sizeof(TreeFacts),
        sizeof(NormalConeTree::Node), sizeof(glm::dvec3), sizeof(NormalConeTree::VertexLeaf),
        sizeof(NormalConeTree::EdgeLeaf), sizeof(NormalConeTree::FaceLeaf), sizeof(std::uint32_t),
        sizeof(SearchedFacts)})
    sizes[next++] = static_cast<std::uint32_t>(size);
  addMeshSizes(sizes, next);
  return sizes;
}

constexpr Sizes kElementBytes = elementSizes();
static_assert(kElementBytes.back() == sizeof(std::uint32_t), "every section has a size");

static_assert(sizeof(kGeometryFingerprint) == 64 + 1);

std::array<double, 6> numbersOf(const Aabb& box) {
  return {box.lower.x, box.lower.y, box.lower.z, box.upper.x, box.upper.y, box.upper.z};
}
std::array<std::uint32_t, 4> numbersOf(const MeshTopology& topology) {
  return {topology.openEdges, topology.nonManifoldEdges, topology.inconsistentEdges, topology.components};
}

std::size_t aligned(std::size_t offset) {
  return (offset + kTreeCacheAlignment - 1) / kTreeCacheAlignment * kTreeCacheAlignment;
}

}  // namespace

std::string treeCacheFingerprint() {
  return std::to_string(kTreeCacheVersion) + " " + kGeometryFingerprint;
}

TreeCacheHeader treeCacheHeader(std::span<const char, 64> sha256, double metresPerUnit) noexcept {
  TreeCacheHeader header{};
  header.magic = kMagic;
  header.byteOrder = kByteOrder;
  header.version = kTreeCacheVersion;
  header.elementBytes = kElementBytes;
  std::copy_n(kGeometryFingerprint, header.fingerprint.size(), header.fingerprint.begin());
  std::ranges::copy(sha256, header.sha256.begin());
  header.metresPerUnit = metresPerUnit;
  return header;
}

std::optional<TreeCacheLayout> treeCacheLayout(
    const std::array<std::uint64_t, kTreeCacheSections>& counts) noexcept {
  TreeCacheLayout layout{};
  for (std::size_t i = 0; i < kTreeCacheSections; ++i) {
    if (counts[i] > 0xFFFFFFFFU) return std::nullopt;
    layout.bytes[i] = static_cast<std::size_t>(counts[i]) * kElementBytes[i];
    layout.firstBlock[i + 1] =
        layout.firstBlock[i] + (layout.bytes[i] + kTreeCacheBlock - 1) / kTreeCacheBlock;
  }
  layout.offsets[0] =
      aligned(sizeof(TreeCacheHeader) + sizeof(std::uint64_t) * layout.firstBlock[kTreeCacheSections]);
  for (std::size_t i = 0; i < kTreeCacheSections; ++i)
    layout.offsets[i + 1] = aligned(layout.offsets[i] + layout.bytes[i]);
  return layout;
}

std::uint64_t treeCacheChecksum(TreeCacheHeader header, std::span<const std::byte> blockChecksums) noexcept {
  header.checksum = 0;
  const std::array<std::uint64_t, 2> both{checksumOf(std::as_bytes(std::span(&header, 1))),
                                          checksumOf(blockChecksums)};
  return checksumOf(std::as_bytes(std::span(both)));
}

MeshFacts meshFactsOf(const TriangleMesh& mesh, const MeshBuildReport& report, const MassProperties& mass) {
  MeshFacts facts{};
  facts.bounds = numbersOf(mesh.bounds());
  facts.mass = {mass.volume, mass.centre.x, mass.centre.y, mass.centre.z};
  for (int k = 0; k < 9; ++k)
    facts.mass[4 + static_cast<std::size_t>(k)] = mass.inertia[k / 3][k % 3];
  facts.massBasis = static_cast<std::uint32_t>(mass.basis);
  facts.counts = {report.weldedVertices, report.degenerateFaces, report.duplicateFaces,
                  report.nonFiniteFaces, report.swappedFaces,    report.stitchedEdges};
  facts.turnedInsideOut = report.turnedInsideOut ? 1 : 0;
  facts.topology = numbersOf(mesh.topology());
  facts.coordinateRounding = report.coordinateRounding;
  return facts;
}

SearchedFacts searchedFactsOf(const NormalConeTree& tree) {
  return {numbersOf(tree.mesh().bounds()), numbersOf(tree.mesh().topology()), tree.deviation()};
}

}  // namespace nearfit
