#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <random>
#include <utility>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/mesh/flat_mesh.h"
#include "core/proximity/cache/tree_cache.h"
#include "tests/support/cached_meshes.h"
#include "tests/support/limited_process.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/trial_share.h"

namespace nearfit::tree_cache_damage_test {
namespace {

namespace fs = std::filesystem;
using Section = TreeCacheSection;
using Node = NormalConeTree::Node;

/// Of a file of half a megabyte: what a damaged one says of itself may ask for any amount.
constexpr std::size_t kMemory = std::size_t{512} << 20;
constexpr unsigned kSeconds = 300;

const TreeCacheKey kKey{std::string(64, 'a'), 0.001};

enum class Taken { Nothing, Mesh, Both };

/// A star, and a box whose faces are cut finely: the hierarchy has a mesh of its own, with fewer triangles.
TriangleMesh starAndBox() {
  return test::joined(test::starMesh(3, 1.0, 3, 0.3),
                      test::subdivided(test::boxMesh({1.0, 1.0, 1.0}, {3.0, 0.0, 0.0}), 2));
}

/// A cached mesh with its hierarchy, to be damaged again and again.
class TreeCacheDamage : public testing::Test {
 protected:
  TreeCacheDamage()
      : mesh_(test::cachedMeshOf(starAndBox())),
        tree_{NormalConeTree(mergeFlats(mesh_.mesh, 0.0)), true},
        cache_({folder_.path(), std::uint64_t{1} << 40, 0}) {
    cache_.store(kKey, mesh_, &tree_);
    file_ = test::onlyFileIn(folder_.path());
    image_.emplace(file_);
  }

  void write(const std::string& bytes) const {
    std::ofstream(file_, std::ios::binary | std::ios::trunc).write(bytes.data(), std::ssize(bytes));
  }

  /// What the cache gives of the file as it is now; anything given is whole and right.
  Taken taken() const {
    const auto file = cache_.find(kKey);
    const auto mesh = file ? file->mesh() : std::nullopt;
    if (!mesh) return Taken::Nothing;
    const auto tree = file->tree(mesh->mesh);
    if (!tree) return Taken::Mesh;
    return Taken::Both;
  }

  Taken takenOf(const std::string& bytes) const {
    write(bytes);
    return taken();
  }

  /// Runs in a process of its own, within bounds of memory and time.
  static void expectTrue(const std::function<bool()>& work) {
    const test::LimitedOutcome outcome = test::runLimited([&] { return work() ? 0 : 1; }, kMemory, kSeconds);
    EXPECT_TRUE(outcome.hasEnded) << "signal " << outcome.signal;
    EXPECT_EQ(outcome.result, 0);
  }

  /// What is taken once `change` was made and all checksums corrected.
  template <typename Change>
  Taken takenAfter(Change change) const {
    test::CacheImage image = *image_;
    change(image);
    image.seal();
    return takenOf(image.bytes);
  }

  test::TemporaryFolder folder_;
  CachedMesh mesh_;
  CachedTree tree_;
  TreeCache cache_;
  fs::path file_;
  std::optional<test::CacheImage> image_;
};

TEST_F(TreeCacheDamage, UndamagedFileIsTaken) {
  EXPECT_EQ(taken(), Taken::Both);
  EXPECT_EQ(takenAfter([](test::CacheImage&) {}), Taken::Both);
}

TEST_F(TreeCacheDamage, CutFileIsNotTakenWhereverItIsCut) {
  std::vector<std::size_t> cuts{0, 1, sizeof(TreeCacheHeader) - 1, sizeof(TreeCacheHeader)};
  for (const std::size_t border : image_->layout().offsets) {
    cuts.push_back(border - 1);
    if (border < image_->bytes.size()) cuts.insert(cuts.end(), {border, border + 1});
  }
  std::mt19937_64 random(1);
  for (int i = 0; i < 200; ++i)
    cuts.push_back(random() % image_->bytes.size());
  expectTrue([&] {
    for (const std::size_t cut : cuts) {
      if (takenOf(image_->bytes.substr(0, cut)) != Taken::Nothing) return false;
    }
    return takenOf(image_->bytes + '\0') == Taken::Nothing;
  });
}

TEST_F(TreeCacheDamage, NoFlippedBitIsOverlooked) {
  // The header with the checksums, then each section with the zeros behind it.
  std::vector<std::size_t> borders{0};
  borders.insert(borders.end(), image_->layout().offsets.begin(), image_->layout().offsets.end());
  const std::size_t treeBegin = image_->offset(Section::TreeFacts);
  expectTrue([&] {
    std::mt19937_64 random(2);
    std::fstream file(file_, std::ios::binary | std::ios::in | std::ios::out);
    const auto put = [&](std::size_t at, char byte) {
      file.seekp(static_cast<std::streamoff>(at)).put(byte).flush();
    };
    for (std::size_t i = 0; i + 1 < borders.size(); ++i) {
      for (int k = 0; k < 500 / static_cast<int>(test::kTrialShare) && borders[i] < borders[i + 1]; ++k) {
        const std::size_t at = borders[i] + random() % (borders[i + 1] - borders[i]);
        put(at, static_cast<char>(image_->bytes[at] ^ static_cast<char>(1U << random() % 8)));
        if (taken() != (at < treeBegin ? Taken::Nothing : Taken::Mesh)) return false;
        put(at, image_->bytes[at]);
      }
    }
    return taken() == Taken::Both;
  });
}

TEST_F(TreeCacheDamage, OtherFormatsVersionsAndMachinesAreNotTaken) {
  const auto takenWith = [&](auto change) {
    return takenAfter([&](test::CacheImage& image) {
      TreeCacheHeader header = image.header();
      change(header);
      image.setHeader(header);
    });
  };
  EXPECT_EQ(takenWith([](TreeCacheHeader& h) { h.magic[0] = 'n'; }), Taken::Nothing);
  EXPECT_EQ(takenWith([](TreeCacheHeader& h) { ++h.version; }), Taken::Nothing);
  EXPECT_EQ(takenWith([](TreeCacheHeader& h) { --h.version; }), Taken::Nothing);
  EXPECT_EQ(takenWith([](TreeCacheHeader& h) { h.byteOrder = 0x04030201; }), Taken::Nothing);
  EXPECT_EQ(takenWith([](TreeCacheHeader& h) { h.elementBytes[4] += 8; }), Taken::Nothing);
  EXPECT_EQ(takenWith([](TreeCacheHeader& h) { h.fingerprint[5] ^= 1; }), Taken::Nothing);
  EXPECT_EQ(takenWith([](TreeCacheHeader& h) { h.sha256[63] ^= 1; }), Taken::Nothing);
  EXPECT_EQ(takenWith([](TreeCacheHeader& h) { h.metresPerUnit = 1.0; }), Taken::Nothing);
  EXPECT_EQ(takenWith([](TreeCacheHeader&) {}), Taken::Both);
}

TEST_F(TreeCacheDamage, AbsurdCountsTakeNoMemory) {
  expectTrue([&] {
    for (std::size_t section = 0; section < kTreeCacheSections; ++section) {
      for (const std::uint64_t count : {std::uint64_t{0}, std::uint64_t{1} << 31, std::uint64_t{0xFFFFFFFF},
                                        std::uint64_t{1} << 58, ~std::uint64_t{0}}) {
        test::CacheImage image = *image_;
        TreeCacheHeader header = image.header();
        // A mesh file has no faces.
        if (header.counts[section] == count) continue;
        header.counts[section] = count;
        image.setHeader(header);
        // Its place in memory is that of the old counts, its checksum is right for the new.
        image.seal();
        if (takenOf(image.bytes) == Taken::Both) return false;
      }
    }
    return true;
  });
}

TEST_F(TreeCacheDamage, IndicesOutOfRangeAreFoundWhateverTheChecksumsSay) {
  const auto damaged = {Section::Triangles,           Section::Edges,
                        Section::EdgeFaces,           Section::TriangleEdges,
                        Section::VertexEdges,         Section::VertexFirstEdge,
                        Section::VertexLeaves,        Section::EdgeLeaves,
                        Section::FaceLeaves,          Section::Neighbours,
                        Section::SearchedTriangles,   Section::SearchedEdges,
                        Section::SearchedEdgeFaces,   Section::SearchedTriangleEdges,
                        Section::SearchedVertexEdges, Section::SearchedVertexFirstEdge};
  expectTrue([&] {
    std::mt19937_64 random(3);
    for (const Section section : damaged) {
      for (int i = 0; i < 40; ++i) {
        const std::size_t word = random() % (image_->size(section) / 4);
        const std::uint32_t index = i % 2 == 0 ? 0xFFFFFFF0U : 1U << 30;
        const Taken result = takenAfter([&](auto& image) { image.set(section, 4 * word, index); });
        if (result != (section < Section::TreeFacts ? Taken::Nothing : Taken::Mesh)) return false;
      }
    }
    return true;
  });
}

// Found by fuzzing: every index was in range, but a face that an edge named was none of its own. The corner
// that is left of the face without the edge's ends, a sum, was then a vertex beyond the last.
TEST_F(TreeCacheDamage, NeighboursThatAreNoneAreFoundWhateverTheChecksumsSay) {
  const auto triangles = static_cast<std::uint32_t>(mesh_.mesh.triangles().size());
  const auto edges = static_cast<std::uint32_t>(mesh_.mesh.edges().size());
  std::mt19937_64 random(4);
  for (const auto& [section, limit] :
       {std::pair(Section::EdgeFaces, triangles), std::pair(Section::TriangleEdges, edges),
        std::pair(Section::VertexEdges, edges)}) {
    for (int i = 0; i < 20; ++i) {
      const std::size_t at = 4 * (random() % (image_->size(section) / 4));
      const auto old = image_->value<std::uint32_t>(section, at);
      const auto other = static_cast<std::uint32_t>((old + 1 + random() % (limit - 1)) % limit);
      EXPECT_EQ(takenAfter([&](auto& image) { image.set(section, at, other); }), Taken::Nothing);
    }
    // Two that are right, in place of each other: one of a vertex is now one of its neighbour's, or out of
    // order.
    const auto first = image_->value<std::uint32_t>(section, 0),
               second = image_->value<std::uint32_t>(section, 4);
    const auto swapTwo = [&](auto& image) {
      image.set(section, 0, second);
      image.set(section, 4, first);
    };
    EXPECT_EQ(takenAfter(swapTwo), Taken::Nothing);
  }
  const auto repeatEdge = [&](auto& image) {
    MeshEdge edge = image.template value<MeshEdge>(Section::Edges, sizeof(MeshEdge));
    const MeshEdge before = image.template value<MeshEdge>(Section::Edges, 0);
    edge.v0 = before.v0;
    edge.v1 = before.v1;
    image.set(Section::Edges, sizeof(MeshEdge), edge);
  };
  EXPECT_EQ(takenAfter(repeatEdge), Taken::Nothing);
}

TEST_F(TreeCacheDamage, NumbersThatAreNoneAreFoundWhateverTheChecksumsSay) {
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(takenAfter([&](auto& image) { image.set(Section::Vertices, 8 * 17, nan); }), Taken::Nothing);
  // Bounds, and mass properties, which once were taken as they were: a mass that is no number is felt as one.
  for (const std::size_t number : {0U, 5U, 6U, 8U, 18U})
    EXPECT_EQ(takenAfter([&](auto& image) { image.set(Section::MeshFacts, 8 * number, nan); }),
              Taken::Nothing);
  EXPECT_EQ(takenAfter([&](auto& image) { image.set(Section::Positions, 8 * 17, infinity); }), Taken::Mesh);
  EXPECT_EQ(takenAfter([&](auto& image) { image.set(Section::TreeFacts, 24, nan); }), Taken::Mesh);
  EXPECT_EQ(takenAfter([&](auto& image) { image.set(Section::SearchedVertices, 8 * 17, nan); }), Taken::Mesh);
  // Bounds and deviation.
  for (const std::size_t number : {0U, 5U, 8U})
    EXPECT_EQ(takenAfter([&](auto& image) { image.set(Section::SearchedFacts, 8 * number, nan); }),
              Taken::Mesh);
  EXPECT_EQ(takenAfter([&](auto& image) { image.set(Section::SearchedFacts, 64, -1.0); }), Taken::Mesh);
  // The rounding of the coordinates.
  EXPECT_EQ(takenAfter([&](auto& image) { image.set(Section::MeshFacts, 224, nan); }), Taken::Nothing);
  // Solid or not: the last number.
  for (const std::uint64_t solid : {std::uint64_t{2}, ~std::uint64_t{0}})
    EXPECT_EQ(takenAfter([&](auto& image) { image.set(Section::TreeFacts, 56, solid); }), Taken::Mesh);
  for (const std::size_t number : {0U, 30U, 60U, 90U, 100U, 110U}) {
    const auto change = [&](auto& image) {
      image.set(Section::Nodes, sizeof(Node) + 4 * number, std::numeric_limits<float>::quiet_NaN());
    };
    EXPECT_EQ(takenAfter(change), Taken::Mesh) << number;
  }
}

TEST_F(TreeCacheDamage, ChildrenThatMakeNoTreeAreFoundWhateverTheChecksumsSay) {
  const auto takenWithChild = [&](std::size_t node, std::size_t lane, std::uint32_t child) {
    return takenAfter([&](auto& image) {
      Node changed = image.template value<Node>(Section::Nodes, node * sizeof(Node));
      changed.child[lane] = child;
      image.set(Section::Nodes, node * sizeof(Node), changed);
    });
  };
  const auto nodes = static_cast<std::uint32_t>(tree_.tree.nodes().size());
  const Node second = tree_.tree.nodes()[1];
  EXPECT_EQ(takenWithChild(1, 0, second.child[0]), Taken::Both);
  EXPECT_EQ(takenWithChild(1, 0, second.child[1]), Taken::Mesh) << "one child twice, one never";
  EXPECT_EQ(takenWithChild(1, 0, 1), Taken::Mesh) << "its own child";
  EXPECT_EQ(takenWithChild(1, 0, 0), Taken::Mesh) << "its parent's parent";
  EXPECT_EQ(takenWithChild(1, 0, nodes), Taken::Mesh) << "beyond the last";
  ASSERT_FALSE(NormalConeTree::isLeaf(second.child[0]));
  for (const FeatureKind kind : {FeatureKind::Vertex, FeatureKind::Edge, FeatureKind::Face}) {
    const std::uint32_t child = NormalConeTree::nodeChild(NormalConeTree::nodeIndex(second.child[0]), kind);
    EXPECT_EQ(takenWithChild(1, 0, child), child == second.child[0] ? Taken::Both : Taken::Mesh)
        << "lowest kind below it";
  }
  EXPECT_EQ(takenWithChild(0, 0, NormalConeTree::kNoChild), Taken::Mesh) << "no root";
  EXPECT_EQ(takenWithChild(0, 1, 1), Taken::Mesh) << "two roots";
  for (const std::uint32_t kind : {0U, 1U, 2U, 3U}) {
    EXPECT_EQ(takenWithChild(nodes - 1, 0, NormalConeTree::kLeafBit | kind << 29 | 0x0FFFFFFFU), Taken::Mesh);
  }
}

TEST_F(TreeCacheDamage, LaneWithoutAChildMustLieOutOfReach) {
  // The first node has one child: its other lanes have none.
  ASSERT_EQ(tree_.tree.nodes()[0].child[3], NormalConeTree::kNoChild);
  const auto takenWithLane = [&](auto change) {
    return takenAfter([&](auto& image) {
      Node node = image.template value<Node>(Section::Nodes, 0);
      change(node);
      image.set(Section::Nodes, 0, node);
    });
  };
  EXPECT_EQ(takenWithLane([](Node& node) { node.centre[1][3] = 0.0F; }), Taken::Mesh);
  EXPECT_EQ(takenWithLane([](Node& node) { node.half[2][3] = 1e18F; }), Taken::Mesh);
  EXPECT_EQ(takenWithLane([](Node& node) { node.child[3] = 1; }), Taken::Mesh);
}

}  // namespace
}  // namespace nearfit::tree_cache_damage_test
