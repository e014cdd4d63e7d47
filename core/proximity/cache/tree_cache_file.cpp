#include "core/proximity/cache/tree_cache_file.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/base/error.h"
#include "core/files/checksum.h"
#include "core/parallel/parallel_for.h"
#include "core/proximity/cache/tree_cache_checks.h"

namespace nearfit {
namespace {

using Section = TreeCacheSection;

bool isSameFile(const TreeCacheHeader& a, const TreeCacheHeader& b) {
  return a.magic == b.magic && a.byteOrder == b.byteOrder && a.version == b.version &&
         a.elementBytes == b.elementBytes && a.fingerprint == b.fingerprint && a.sha256 == b.sha256 &&
         a.metresPerUnit == b.metresPerUnit && a.reserved == b.reserved;
}

/// Returns a block of a section, which has its own checksum.
std::span<const std::byte> blockOf(std::span<const std::byte> section, std::size_t block) {
  const std::size_t first = block * kTreeCacheBlock;
  return section.subspan(first, std::min(kTreeCacheBlock, section.size() - first));
}

}  // namespace

std::optional<TreeCacheFile> TreeCacheFile::open(const std::filesystem::path& file, const TreeCacheKey& key) {
  if (key.sha256.size() != 64) return std::nullopt;
  std::shared_ptr<const MappedFile> mapped;
  try {
    mapped = std::make_shared<const MappedFile>(file);
  } catch (const FileError&) {
    return std::nullopt;
  }
  const std::span<const std::byte> bytes = mapped->bytes();
  TreeCacheHeader header;
  if (bytes.size() < sizeof(header)) return std::nullopt;
  std::memcpy(&header, bytes.data(), sizeof(header));
  if (!isSameFile(header, treeCacheHeader(std::span<const char, 64>(key.sha256), key.metresPerUnit)))
    return std::nullopt;
  const std::optional<TreeCacheLayout> layout = treeCacheLayout(header.counts);
  if (!layout || layout->offsets.back() != bytes.size()) return std::nullopt;
  const auto blockChecksums = bytes.subspan(sizeof(header), layout->offsets[0] - sizeof(header));
  if (treeCacheChecksum(header, blockChecksums) != header.checksum) return std::nullopt;
  return TreeCacheFile(std::move(mapped), header, *layout);
}

bool TreeCacheFile::isIntact(Section first, Section last) const {
  struct Block {
    std::size_t section, number;
  };
  std::vector<Block> blocks;
  bool isPaddedWithZeros = true;
  for (std::size_t i = index(first); i <= index(last); ++i) {
    for (std::size_t k = 0; k < layout_.firstBlock[i + 1] - layout_.firstBlock[i]; ++k)
      blocks.push_back({i, k});
    const std::size_t end = layout_.offsets[i] + layout_.bytes[i];
    for (const std::byte padding : file_->bytes().subspan(end, layout_.offsets[i + 1] - end))
      isPaddedWithZeros &= padding == std::byte{0};
  }
  std::atomic<bool> isIntact{isPaddedWithZeros};
  parallelFor(blocks.size(), [&](std::size_t i) {
    const auto [section, number] = blocks[i];
    std::uint64_t expected = 0;
    std::memcpy(&expected,
                file_->bytes().data() + sizeof(TreeCacheHeader) +
                    sizeof(expected) * (layout_.firstBlock[section] + number),
                sizeof(expected));
    const auto content = file_->bytes().subspan(layout_.offsets[section], layout_.bytes[section]);
    if (checksumOf(blockOf(content, number)) != expected) isIntact = false;
  });
  return isIntact;
}

template <typename T>
SharedArray<T> TreeCacheFile::array(Section section) const {
  const std::byte* begin = file_->bytes().data() + layout_.offsets[index(section)];
  return {std::span(reinterpret_cast<const T*>(begin), count(section)), file_};
}

std::optional<MeshBuildReport> TreeCacheFile::report(const MeshFacts& facts) const {
  MeshBuildReport report;
  report.weldedVertices = facts.counts[0];
  report.degenerateFaces = facts.counts[1];
  report.duplicateFaces = facts.counts[2];
  report.nonFiniteFaces = facts.counts[3];
  report.swappedFaces = facts.counts[4];
  report.stitchedEdges = facts.counts[5];
  report.turnedInsideOut = facts.turnedInsideOut != 0;
  report.coordinateRounding = facts.coordinateRounding;
  const SharedArray<char> warnings = array<char>(Section::Warnings);
  if (!warnings.empty() && warnings[warnings.size() - 1] != '\0') return std::nullopt;
  for (std::size_t i = 0; i < warnings.size(); i += report.warnings.back().size() + 1)
    report.warnings.emplace_back(warnings.view().data() + i);
  return report;
}

TriangleMesh::Arrays TreeCacheFile::meshArrays(Section vertices, const std::array<double, 6>& b,
                                               const std::array<std::uint32_t, 4>& topology) const {
  const auto section = [first = index(vertices)](std::size_t i) { return static_cast<Section>(first + i); };
  return {array<glm::dvec3>(section(0)),
          array<Triangle>(section(1)),
          array<MeshEdge>(section(2)),
          array<std::uint32_t>(section(3)),
          array<std::array<std::uint32_t, 3>>(section(4)),
          array<std::uint32_t>(section(5)),
          array<std::uint32_t>(section(6)),
          {{b[0], b[1], b[2]}, {b[3], b[4], b[5]}},
          {topology[0], topology[1], topology[2], topology[3]}};
}

std::optional<TreeCacheFile::Searched> TreeCacheFile::searched(const TriangleMesh& mesh) const {
  if (count(Section::SearchedFacts) != 1) return Searched{mesh, 0.0};
  const SearchedFacts facts = array<SearchedFacts>(Section::SearchedFacts)[0];
  TriangleMesh::Arrays arrays = meshArrays(Section::SearchedVertices, facts.bounds, facts.topology);
  if (!(facts.deviation >= 0.0) || !std::isfinite(facts.deviation) || !isSound(arrays)) return std::nullopt;
  return Searched{TriangleMesh(std::move(arrays)), facts.deviation};
}

std::optional<CachedMesh> TreeCacheFile::mesh() const {
  if (count(Section::MeshFacts) != 1 || !isIntact(Section::MeshFacts, Section::VertexFirstEdge))
    return std::nullopt;
  const MeshFacts facts = array<MeshFacts>(Section::MeshFacts)[0];
  TriangleMesh::Arrays arrays = meshArrays(Section::Vertices, facts.bounds, facts.topology);
  std::optional<MeshBuildReport> built = report(facts);
  const bool isMassFinite = std::ranges::all_of(facts.mass, [](double x) { return std::isfinite(x); });
  if (!built || !isMassFinite || !(facts.coordinateRounding >= 0.0) ||
      !std::isfinite(facts.coordinateRounding) ||
      facts.massBasis > static_cast<std::uint32_t>(MassBasis::OrientedBox) || !isSound(arrays)) {
    return std::nullopt;
  }
  MassProperties mass;
  mass.volume = facts.mass[0];
  mass.centre = {facts.mass[1], facts.mass[2], facts.mass[3]};
  for (int k = 0; k < 9; ++k)
    mass.inertia[k / 3][k % 3] = facts.mass[4 + static_cast<std::size_t>(k)];
  mass.basis = static_cast<MassBasis>(facts.massBasis);
  return CachedMesh{TriangleMesh(std::move(arrays)), std::move(*built), mass};
}

std::optional<CachedTree> TreeCacheFile::tree(const TriangleMesh& mesh) const {
  if (!hasTree() || !isIntact(Section::TreeFacts, Section::SearchedVertexFirstEdge)) return std::nullopt;
  const TreeFacts facts = array<TreeFacts>(Section::TreeFacts)[0];
  std::optional<Searched> of = searched(mesh);
  if (!of || facts.isSolid > 1) return std::nullopt;
  const FeatureCounts all = featuresOf(of->mesh);
  if (facts.all != std::array<std::uint64_t, 3>{all.vertices, all.edges, all.faces}) return std::nullopt;
  const auto& c = facts.centreAndSize;
  NormalConeTree::Arrays arrays{{c[0], c[1], c[2]},
                                c[3],
                                array<NormalConeTree::Node>(Section::Nodes),
                                array<glm::dvec3>(Section::Positions),
                                array<NormalConeTree::VertexLeaf>(Section::VertexLeaves),
                                array<NormalConeTree::EdgeLeaf>(Section::EdgeLeaves),
                                array<NormalConeTree::FaceLeaf>(Section::FaceLeaves),
                                array<std::uint32_t>(Section::Neighbours)};
  arrays.mesh = of->mesh;
  arrays.deviation = of->deviation;
  if (!isSound(arrays)) return std::nullopt;
  return CachedTree{NormalConeTree(std::move(arrays)), facts.isSolid == 1};
}

}  // namespace nearfit
