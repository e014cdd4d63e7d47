#include "core/proximity/cache/tree_cache_file.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <new>

#include "core/base/error.h"
#include "core/files/checksum.h"
#include "core/math/finite.h"
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

constexpr std::align_val_t kAlignment{kTreeCacheAlignment};

/// The surface; no value if a number of it is not finite or its kind is unknown.
std::optional<ExactSurface> surfaceOf(const ShapeFace& face) {
  ExactSurface surface;
  surface.point = {face.point[0], face.point[1], face.point[2]};
  surface.direction = {face.direction[0], face.direction[1], face.direction[2]};
  surface.radius = face.radius;
  surface.minorRadius = face.minorRadius;
  surface.halfAngle = face.halfAngle;
  surface.isHollow = face.isHollow == 1;
  surface.kind = static_cast<SurfaceKind>(face.kind);
  const bool isKnown = face.kind <= static_cast<std::uint32_t>(SurfaceKind::Torus) && face.isHollow <= 1;
  const bool areFinite = isFinite(surface.point) && isFinite(surface.direction) &&
                         std::isfinite(face.radius) && std::isfinite(face.minorRadius) &&
                         std::isfinite(face.halfAngle);
  return isKnown && areFinite ? std::optional(surface) : std::nullopt;
}

/// Memory for sections, not initialised. Throws std::bad_alloc.
std::shared_ptr<std::byte> alignedMemory(std::size_t size) {
  auto* const bytes = static_cast<std::byte*>(::operator new(size, kAlignment));
  return {bytes, [](std::byte* memory) { ::operator delete(memory, kAlignment); }};
}

}  // namespace

std::optional<TreeCacheFile> TreeCacheFile::open(const std::filesystem::path& file, const TreeCacheKey& key) {
  if (key.sha256.size() != 64) return std::nullopt;
  try {
    auto input = std::make_shared<const InputFile>(file, FileOwner::User);
    TreeCacheHeader header{};
    if (!input->readAt(0, std::as_writable_bytes(std::span(&header, 1)))) return std::nullopt;
    if (!isSameFile(header, treeCacheHeader(std::span<const char, 64>(key.sha256), key.metresPerUnit)))
      return std::nullopt;
    const std::optional<TreeCacheLayout> layout = treeCacheLayout(header.counts);
    if (!layout || layout->offsets.back() != input->size()) return std::nullopt;
    std::vector<std::byte> blockChecksums(layout->offsets[0] - sizeof(header));
    if (!input->readAt(sizeof(header), blockChecksums) ||
        treeCacheChecksum(header, blockChecksums) != header.checksum) {
      return std::nullopt;
    }
    return TreeCacheFile(std::move(input), header, *layout, std::move(blockChecksums));
  } catch (const FileError&) {
    return std::nullopt;
  }
}

std::vector<TreeCacheFile::Block> TreeCacheFile::blocks(Section first, Section last) const {
  std::vector<Block> blocks;
  for (std::size_t i = index(first); i <= index(last); ++i) {
    const std::size_t end = layout_.offsets[i] + layout_.bytes[i];
    for (std::size_t k = layout_.firstBlock[i]; k < layout_.firstBlock[i + 1]; ++k) {
      Block block{};
      block.offset = layout_.offsets[i] + (k - layout_.firstBlock[i]) * kTreeCacheBlock;
      block.size = std::min(kTreeCacheBlock, end - block.offset);
      block.zeros = block.offset + block.size == end ? layout_.offsets[i + 1] - end : 0;
      std::memcpy(&block.checksum, blockChecksums_.data() + k * sizeof(block.checksum),
                  sizeof(block.checksum));
      blocks.push_back(block);
    }
  }
  return blocks;
}

bool TreeCacheFile::take(const Block& block, const Sections& to) const {
  const std::span<std::byte> bytes(to.bytes.get() + (block.offset - to.offset), block.size + block.zeros);
  return file_->readAt(block.offset, bytes) && checksumOf(bytes.first(block.size)) == block.checksum &&
         std::ranges::all_of(bytes.last(block.zeros), [](std::byte zero) { return zero == std::byte{0}; });
}

std::optional<TreeCacheFile::Sections> TreeCacheFile::read(Section first, Section last) const {
  const std::size_t begin = layout_.offsets[index(first)], end = layout_.offsets[index(last) + 1];
  try {
    const Sections sections{alignedMemory(end - begin), begin};
    const std::vector<Block> parts = blocks(first, last);
    std::atomic<bool> isIntact{true};
    parallelFor(parts.size(), [&](std::size_t i) {
      if (!take(parts[i], sections)) isIntact = false;
    });
    return isIntact ? std::optional(sections) : std::nullopt;
  } catch (const FileError&) {
  } catch (const std::bad_alloc&) {
  }
  return std::nullopt;  // The mesh file is still there to load.
}

template <typename T>
SharedArray<T> TreeCacheFile::array(const Sections& from, Section section) const {
  const std::byte* begin = from.bytes.get() + (layout_.offsets[index(section)] - from.offset);
  return {std::span(reinterpret_cast<const T*>(begin), count(section)), from.bytes};
}

std::optional<MeshBuildReport> TreeCacheFile::report(const Sections& from, const MeshFacts& facts) const {
  MeshBuildReport report;
  report.weldedVertices = facts.counts[0];
  report.degenerateFaces = facts.counts[1];
  report.duplicateFaces = facts.counts[2];
  report.nonFiniteFaces = facts.counts[3];
  report.swappedFaces = facts.counts[4];
  report.stitchedEdges = facts.counts[5];
  report.turnedInsideOut = facts.turnedInsideOut != 0;
  report.coordinateRounding = facts.coordinateRounding;
  const SharedArray<char> warnings = array<char>(from, Section::Warnings);
  if (!warnings.empty() && warnings[warnings.size() - 1] != '\0') return std::nullopt;
  for (std::size_t i = 0; i < warnings.size(); i += report.warnings.back().size() + 1)
    report.warnings.emplace_back(warnings.view().data() + i);
  return report;
}

TriangleMesh::Arrays TreeCacheFile::meshArrays(const Sections& from, Section vertices,
                                               const std::array<double, 6>& b,
                                               const std::array<std::uint32_t, 4>& topology) const {
  const auto section = [first = index(vertices)](std::size_t i) { return static_cast<Section>(first + i); };
  return {array<glm::dvec3>(from, section(0)),
          array<Triangle>(from, section(1)),
          array<MeshEdge>(from, section(2)),
          array<std::uint32_t>(from, section(3)),
          array<std::array<std::uint32_t, 3>>(from, section(4)),
          array<std::uint32_t>(from, section(5)),
          array<std::uint32_t>(from, section(6)),
          {{b[0], b[1], b[2]}, {b[3], b[4], b[5]}},
          {topology[0], topology[1], topology[2], topology[3]}};
}

std::optional<TreeCacheFile::Searched> TreeCacheFile::searched(const Sections& from,
                                                               const TriangleMesh& mesh) const {
  if (count(Section::SearchedFacts) != 1) return Searched{mesh, 0.0};
  const SearchedFacts facts = array<SearchedFacts>(from, Section::SearchedFacts)[0];
  TriangleMesh::Arrays arrays = meshArrays(from, Section::SearchedVertices, facts.bounds, facts.topology);
  if (!(facts.deviation >= 0.0) || !std::isfinite(facts.deviation) || !isSound(arrays)) return std::nullopt;
  return Searched{TriangleMesh(std::move(arrays)), facts.deviation};
}

std::optional<CachedMesh> TreeCacheFile::mesh() const {
  if (count(Section::MeshFacts) != 1) return std::nullopt;
  const std::optional<Sections> sections = read(Section::MeshFacts, Section::FaceOfTriangle);
  if (!sections) return std::nullopt;
  const MeshFacts facts = array<MeshFacts>(*sections, Section::MeshFacts)[0];
  TriangleMesh::Arrays arrays = meshArrays(*sections, Section::Vertices, facts.bounds, facts.topology);
  std::optional<MeshBuildReport> built = report(*sections, facts);
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
  CachedMesh cached{TriangleMesh(std::move(arrays)), std::move(*built), mass};
  if (!readShape(*sections, cached.mesh.triangles().size(), cached.shape)) return std::nullopt;
  return cached;
}

bool TreeCacheFile::readShape(const Sections& from, std::size_t triangles,
                              std::optional<CachedShape>& shape) const {
  const std::size_t faces = count(Section::ShapeFaces), colours = count(Section::FaceColours);
  const bool hasFaces = count(Section::FaceOfTriangle) > 0;
  if (count(Section::ShapeFacts) == 0) return faces == 0 && colours == 0 && !hasFaces;
  if (count(Section::ShapeFacts) != 1 || hasFaces != (faces > 0) || (colours != 0 && colours != faces) ||
      (hasFaces && count(Section::FaceOfTriangle) != triangles))
    return false;
  const ShapeFacts facts = array<ShapeFacts>(from, Section::ShapeFacts)[0];
  for (const double value : {facts.chord, facts.angle, facts.exactVolume}) {
    if (!(value >= 0.0) || !std::isfinite(value)) return false;
  }
  if (facts.isExact > 1 || !(facts.statedUnit > 0.0) || !std::isfinite(facts.statedUnit)) return false;
  CachedShape read;
  read.chord = facts.chord;
  read.angle = facts.angle;
  read.exactVolume = facts.exactVolume;
  read.statedUnit = facts.statedUnit;
  read.isExact = facts.isExact == 1;
  if (hasFaces) {
    const SharedArray<std::uint32_t> faceOf = array<std::uint32_t>(from, Section::FaceOfTriangle);
    SurfaceFaces surfaces;
    surfaces.faceOfTriangle.assign(faceOf.view().begin(), faceOf.view().end());
    if (std::ranges::any_of(surfaces.faceOfTriangle, [faces](std::uint32_t face) { return face >= faces; }))
      return false;
    const SharedArray<ShapeFace> shapeFaces = array<ShapeFace>(from, Section::ShapeFaces);
    for (const ShapeFace& face : shapeFaces.view()) {
      const std::optional<ExactSurface> surface = surfaceOf(face);
      if (!surface) return false;
      surfaces.faces.push_back(*surface);
    }
    read.surfaces = std::make_shared<const SurfaceFaces>(std::move(surfaces));
  }
  const SharedArray<ShapeColour> shapeColours = array<ShapeColour>(from, Section::FaceColours);
  for (const ShapeColour& colour : shapeColours.view()) {
    if (colour.isSet > 1 || !std::ranges::all_of(colour.rgb, [](float c) { return c >= 0.0F && c <= 1.0F; }))
      return false;
    read.faceColours.push_back(colour.isSet == 1 ? std::optional(colour.rgb) : std::nullopt);
  }
  shape = std::move(read);
  return true;
}

std::optional<CachedTree> TreeCacheFile::tree(const TriangleMesh& mesh) const {
  if (!hasTree()) return std::nullopt;
  const std::optional<Sections> sections = read(Section::TreeFacts, Section::SearchedVertexFirstEdge);
  if (!sections) return std::nullopt;
  const TreeFacts facts = array<TreeFacts>(*sections, Section::TreeFacts)[0];
  std::optional<Searched> of = searched(*sections, mesh);
  if (!of || facts.isSolid > 1) return std::nullopt;
  const FeatureCounts all = featuresOf(of->mesh);
  if (facts.all != std::array<std::uint64_t, 3>{all.vertices, all.edges, all.faces}) return std::nullopt;
  const auto& c = facts.centreAndSize;
  NormalConeTree::Arrays arrays{{c[0], c[1], c[2]},
                                c[3],
                                array<NormalConeTree::Node>(*sections, Section::Nodes),
                                array<glm::dvec3>(*sections, Section::Positions),
                                array<NormalConeTree::VertexLeaf>(*sections, Section::VertexLeaves),
                                array<NormalConeTree::EdgeLeaf>(*sections, Section::EdgeLeaves),
                                array<NormalConeTree::FaceLeaf>(*sections, Section::FaceLeaves),
                                array<std::uint32_t>(*sections, Section::Neighbours)};
  arrays.mesh = of->mesh;
  arrays.deviation = of->deviation;
  if (!isSound(arrays)) return std::nullopt;
  return CachedTree{NormalConeTree(std::move(arrays)), facts.isSolid == 1};
}

}  // namespace nearfit
