#include "tests/support/cached_meshes.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "core/files/checksum.h"
#include "core/mesh/mass_properties.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::test {
namespace {

template <typename T>
bool areSameBytes(const T& a, const T& b) {
  // Bit for bit is what a cache promises. NOLINTNEXTLINE(bugprone-suspicious-memory-comparison)
  return std::memcmp(&a, &b, sizeof(T)) == 0;
}

template <typename T>
bool areSameArrays(const SharedArray<T>& a, const SharedArray<T>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.view().data(), b.view().data(), a.byteSize()) == 0);
}

}  // namespace

CachedMesh cachedMeshOf(TriangleMesh mesh) {
  const MassProperties mass = massProperties(mesh);
  return {
      std::move(mesh), {1, 2, 3, 4, 5, 6, 7e-9, true, {"One thing.", "", "Another, with \xC3\xBC."}}, mass};
}

bool areSame(const TriangleMesh& meshA, const TriangleMesh& meshB) {
  const TriangleMesh::Arrays &a = meshA.arrays(), &b = meshB.arrays();
  return areSameArrays(a.vertices, b.vertices) && areSameArrays(a.triangles, b.triangles) &&
         areSameArrays(a.edges, b.edges) && areSameArrays(a.edgeFaces, b.edgeFaces) &&
         areSameArrays(a.triangleEdges, b.triangleEdges) && areSameArrays(a.vertexEdges, b.vertexEdges) &&
         areSameArrays(a.vertexFirstEdge, b.vertexFirstEdge) && areSameBytes(a.bounds, b.bounds) &&
         areSameBytes(a.topology, b.topology);
}

bool areSame(const NormalConeTree& treeA, const NormalConeTree& treeB) {
  const NormalConeTree::Arrays &a = treeA.arrays(), &b = treeB.arrays();
  return areSame(a.mesh, b.mesh) && areSameBytes(a.deviation, b.deviation) &&
         areSameBytes(a.centre, b.centre) && areSameBytes(a.size, b.size) &&
         areSameArrays(a.nodes, b.nodes) && areSameArrays(a.positions, b.positions) &&
         areSameArrays(a.vertices, b.vertices) && areSameArrays(a.edges, b.edges) &&
         areSameArrays(a.faces, b.faces) && areSameArrays(a.neighbours, b.neighbours);
}

bool areSame(const CachedMesh& a, const CachedMesh& b) {
  const MeshBuildReport &r = a.report, &s = b.report;
  return areSame(a.mesh, b.mesh) && r.weldedVertices == s.weldedVertices &&
         r.degenerateFaces == s.degenerateFaces && r.duplicateFaces == s.duplicateFaces &&
         r.nonFiniteFaces == s.nonFiniteFaces && r.swappedFaces == s.swappedFaces &&
         areSameBytes(r.coordinateRounding, s.coordinateRounding) && r.stitchedEdges == s.stitchedEdges &&
         r.turnedInsideOut == s.turnedInsideOut && r.warnings == s.warnings &&
         areSameBytes(a.mass.volume, b.mass.volume) && areSameBytes(a.mass.centre, b.mass.centre) &&
         areSameBytes(a.mass.inertia, b.mass.inertia) && a.mass.basis == b.mass.basis;
}

std::filesystem::path onlyFileIn(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".nearfit-tree") files.push_back(entry.path());
  }
  if (files.size() != 1) throw std::runtime_error(std::to_string(files.size()) + " files in the cache");
  return files.front();
}

CacheImage::CacheImage(const std::filesystem::path& file)
    : bytes(readBytes(file)), layout_(treeCacheLayout(header().counts).value()) {}

TreeCacheHeader CacheImage::header() const {
  TreeCacheHeader header;
  std::memcpy(&header, bytes.data(), sizeof(header));
  return header;
}

void CacheImage::setHeader(const TreeCacheHeader& header) {
  std::memcpy(bytes.data(), &header, sizeof(header));
}

std::size_t CacheImage::offset(TreeCacheSection section) const {
  return layout_.offsets[static_cast<std::size_t>(section)];
}

std::size_t CacheImage::size(TreeCacheSection section) const {
  return layout_.bytes[static_cast<std::size_t>(section)];
}

void CacheImage::seal() {
  const auto all = std::as_bytes(std::span(bytes));
  for (std::size_t i = 0; i < kTreeCacheSections; ++i) {
    for (std::size_t k = layout_.firstBlock[i]; k < layout_.firstBlock[i + 1]; ++k) {
      const std::size_t first = (k - layout_.firstBlock[i]) * kTreeCacheBlock;
      const std::uint64_t checksum = checksumOf(
          all.subspan(layout_.offsets[i] + first, std::min(kTreeCacheBlock, layout_.bytes[i] - first)));
      std::memcpy(bytes.data() + sizeof(TreeCacheHeader) + 8 * k, &checksum, 8);
    }
  }
  TreeCacheHeader sealed = header();
  sealed.checksum = treeCacheChecksum(
      sealed, all.subspan(sizeof(TreeCacheHeader), layout_.offsets[0] - sizeof(TreeCacheHeader)));
  setHeader(sealed);
}

}  // namespace nearfit::test
