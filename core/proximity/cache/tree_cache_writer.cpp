#include <algorithm>

#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "core/files/checksum.h"
#include "core/parallel/parallel_for.h"
#include "core/proximity/cache/tree_cache_file.h"

namespace nearfit {
namespace {

using Bytes = std::span<const std::byte>;
using Contents = std::array<Bytes, kTreeCacheSections>;
using Counts = std::array<std::uint64_t, kTreeCacheSections>;

std::string warningsText(const MeshBuildReport& report) {
  std::string text;
  for (const std::string& warning : report.warnings) {
    if (warning.find('\0') != std::string::npos)
      throw Error("mesh", "a warning about it cannot be cached", "load the mesh file itself");
    text += warning;
    text += '\0';
  }
  return text;
}

/// Collects the contents of the sections, without copying them.
class Gatherer {
 public:
  template <typename T>
  void add(std::span<const T> values) {
    contents[next_] = std::as_bytes(values);
    counts[next_++] = values.size();
  }
  /// Leaves sections empty.
  void skip(std::size_t count) { next_ += count; }
  template <typename T>
  void add(const SharedArray<T>& values) {
    add(values.view());
  }

  Contents contents;
  Counts counts{};

 private:
  std::size_t next_ = 0;
};

void addArrays(Gatherer& out, const TriangleMesh::Arrays& m) {
  out.add(m.vertices);
  out.add(m.triangles);
  out.add(m.edges);
  out.add(m.edgeFaces);
  out.add(m.triangleEdges);
  out.add(m.vertexEdges);
  out.add(m.vertexFirstEdge);
}

void addMesh(Gatherer& out, const MeshFacts& facts, const std::string& warnings, const TriangleMesh& mesh) {
  out.add(std::span(&facts, 1));
  out.add(std::span(warnings.data(), warnings.size()));
  addArrays(out, mesh.arrays());
}

/// Sections of a shape of a CAD document, which must live until they are written.
struct ShapeSections {
  ShapeFacts facts{};
  std::vector<ShapeFace> faces;
  std::vector<ShapeColour> colours;
};
constexpr std::size_t kShapeSections = 4;

ShapeFace faceOf(const ExactSurface& surface) {
  return {{surface.point.x, surface.point.y, surface.point.z},
          {surface.direction.x, surface.direction.y, surface.direction.z},
          surface.radius,
          surface.minorRadius,
          surface.halfAngle,
          static_cast<std::uint32_t>(surface.kind),
          surface.isHollow ? 1U : 0U};
}

ShapeSections sectionsOf(const CachedShape& shape) {
  ShapeSections sections;
  sections.facts = {shape.chord, shape.angle, shape.exactVolume, shape.isExact ? 1U : 0U, shape.statedUnit};
  if (shape.surfaces != nullptr) {
    for (const ExactSurface& surface : shape.surfaces->faces)
      sections.faces.push_back(faceOf(surface));
  }
  for (const auto& colour : shape.faceColours)
    sections.colours.push_back({colour.value_or(std::array<float, 3>{}), colour ? 1U : 0U});
  return sections;
}

void addShape(Gatherer& out, const ShapeSections& sections, const CachedShape& shape) {
  out.add(std::span(&sections.facts, 1));
  out.add(std::span<const ShapeFace>(sections.faces));
  out.add(std::span<const ShapeColour>(sections.colours));
  if (shape.surfaces != nullptr)
    out.add(std::span<const std::uint32_t>(shape.surfaces->faceOfTriangle));
  else
    out.skip(1);
}

void addTree(Gatherer& out, const TreeFacts& facts, const NormalConeTree::Arrays& tree) {
  out.add(std::span(&facts, 1));
  out.add(tree.nodes);
  out.add(tree.positions);
  out.add(tree.vertices);
  out.add(tree.edges);
  out.add(tree.faces);
  out.add(tree.neighbours);
}
TreeFacts treeFactsOf(const CachedTree& cached) {
  const NormalConeTree::Arrays& tree = cached.tree.arrays();
  const FeatureCounts all = cached.tree.allFeatures();
  return {{tree.centre.x, tree.centre.y, tree.centre.z, tree.size},
          {all.vertices, all.edges, all.faces},
          cached.isSolid ? 1U : 0U};
}

/// Returns the header and checksums.
std::vector<std::byte> beginning(TreeCacheHeader header, const TreeCacheLayout& layout,
                                 const Contents& contents) {
  std::vector<std::byte> bytes(layout.offsets[0]);
  struct Block {
    Bytes content;
    std::size_t place;
  };
  std::vector<Block> blocks;
  for (std::size_t i = 0; i < kTreeCacheSections; ++i) {
    for (std::size_t first = 0; first < contents[i].size(); first += kTreeCacheBlock) {
      blocks.push_back(
          {contents[i].subspan(first, std::min(kTreeCacheBlock, contents[i].size() - first)),
           sizeof(header) + sizeof(std::uint64_t) * (layout.firstBlock[i] + first / kTreeCacheBlock)});
    }
  }
  parallelFor(blocks.size(), [&](std::size_t i) {
    const std::uint64_t checksum = checksumOf(blocks[i].content);
    std::memcpy(bytes.data() + blocks[i].place, &checksum, sizeof(checksum));
  });
  header.checksum = treeCacheChecksum(header, std::span(bytes).subspan(sizeof(header)));
  std::memcpy(bytes.data(), &header, sizeof(header));
  return bytes;
}

std::string_view textOf(Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

std::uint64_t writeTreeCacheFile(const std::filesystem::path& file, const TreeCacheKey& key,
                                 const CachedMesh& mesh, const CachedTree* tree, std::uint64_t maxBytes) {
  if (key.sha256.size() != 64) throw Error("cache", "it needs the mesh file's SHA-256");
  const MeshFacts meshFacts = meshFactsOf(mesh.mesh, mesh.report, mesh.mass);
  const std::string warnings = warningsText(mesh.report);
  const TreeFacts treeFacts = tree != nullptr ? treeFactsOf(*tree) : TreeFacts{};
  Gatherer gathered;
  addMesh(gathered, meshFacts, warnings, mesh.mesh);
  const ShapeSections shape = mesh.shape ? sectionsOf(*mesh.shape) : ShapeSections{};
  if (mesh.shape)
    addShape(gathered, shape, *mesh.shape);
  else
    gathered.skip(kShapeSections);
  SearchedFacts searchedFacts{};
  if (tree != nullptr) {
    addTree(gathered, treeFacts, tree->tree.arrays());
    const TriangleMesh& searched = tree->tree.mesh();
    if (!searched.sharesArraysOf(mesh.mesh)) {
      searchedFacts = searchedFactsOf(tree->tree);
      gathered.add(std::span<const SearchedFacts>(&searchedFacts, 1));
      addArrays(gathered, searched.arrays());
    }
  }
  TreeCacheHeader header = treeCacheHeader(std::span<const char, 64>(key.sha256), key.metresPerUnit);
  header.counts = gathered.counts;
  const std::optional<TreeCacheLayout> layout = treeCacheLayout(header.counts);
  if (!layout || layout->offsets.back() > maxBytes) return 0;

  // The mesh file may be one that only the user can read.
  AtomicFile out(file, FileAccess::Private, Unfinished::Hidden, Links::Replace);
  out.write(textOf(beginning(header, *layout, gathered.contents)));
  constexpr std::array<char, kTreeCacheAlignment> kZeros{};
  for (std::size_t i = 0; i < kTreeCacheSections; ++i) {
    out.write(textOf(gathered.contents[i]));
    const std::size_t end = layout->offsets[i] + layout->bytes[i];
    out.write({kZeros.data(), layout->offsets[i + 1] - end});
  }
  out.commit(AtomicFile::Flush::Later);
  return layout->offsets.back();
}

}  // namespace nearfit
