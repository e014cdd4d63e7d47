// Files of the cache: arrays of a small mesh and its hierarchy, changed at will and given right checksums, or
// any bytes. What the cache takes can be worked with like a mesh that was imported.
#include "core/proximity/cache/tree_cache.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "core/files/checksum.h"
#include "core/haptics/mass_metric.h"
#include "core/proximity/overlap/interference.h"
#include "core/proximity/surface/surface_contacts.h"
#include "core/proximity/surface/surface_distance.h"
#include "core/proximity/tracking/candidate_list.h"
#include "tests/fuzz/byte_source.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/cached_meshes.h"
#include "tests/support/degenerate_meshes.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/triangle_tests.h"

namespace nearfit::fuzz {
namespace {

const TreeCacheKey kKey{std::string(64, 'a'), 0.001};

/// A cache file as the bytes of each of its sections.
struct Sections {
  std::array<std::string, kTreeCacheSections> bytes;

  /// Puts them in place with checksums for what is there.
  std::string file() const {
    TreeCacheHeader header = treeCacheHeader(std::span<const char, 64>(kKey.sha256), kKey.metresPerUnit);
    for (std::size_t i = 0; i < kTreeCacheSections; ++i)
      header.counts[i] = bytes[i].size() / header.elementBytes[i];
    const TreeCacheLayout layout = treeCacheLayout(header.counts).value();
    std::string out(layout.offsets.back(), '\0');
    for (std::size_t i = 0; i < kTreeCacheSections; ++i) {
      out.replace(layout.offsets[i], layout.bytes[i], bytes[i], 0, layout.bytes[i]);
      // Far smaller than a block, of which each has a checksum.
      if (layout.bytes[i] == 0) continue;
      const std::uint64_t checksum =
          checksumOf(std::as_bytes(std::span(out)).subspan(layout.offsets[i], layout.bytes[i]));
      std::memcpy(out.data() + sizeof(header) + sizeof(checksum) * layout.firstBlock[i], &checksum,
                  sizeof(checksum));
    }
    header.checksum = treeCacheChecksum(
        header, std::as_bytes(std::span(out)).subspan(sizeof(header), layout.offsets[0] - sizeof(header)));
    std::memcpy(out.data(), &header, sizeof(header));
    return out;
  }
};

Sections sectionsOf(const TriangleMesh& mesh, const test::TemporaryFolder& folder) {
  const auto path = folder.path() / "whole";
  const CachedTree tree{NormalConeTree(mesh), true};
  writeTreeCacheFile(path, kKey, test::cachedMeshOf(mesh), &tree, std::numeric_limits<std::uint64_t>::max());
  const test::CacheImage image(path);
  Sections sections;
  for (std::size_t i = 0; i < kTreeCacheSections; ++i)
    sections.bytes[i] = image.bytes.substr(image.layout().offsets[i], image.layout().bytes[i]);
  return sections;
}

/// Changes numbers, lengths, or single bits of a section.
void change(ByteSource& bytes, Sections& sections) {
  const std::size_t which = bytes.below(kTreeCacheSections);
  std::string& section = sections.bytes[which];
  const auto put = [&](std::size_t at, const auto& value) {
    if (at + sizeof(value) <= section.size()) std::memcpy(section.data() + at, &value, sizeof(value));
  };
  const std::size_t at = bytes.raw<std::uint16_t>();
  const TreeCacheHeader header = treeCacheHeader(std::span<const char, 64>(kKey.sha256), 1.0);
  switch (bytes.below(6)) {
    case 0:
      return put(4 * at, static_cast<std::uint32_t>(bytes.byte()));
    case 1:
      return put(4 * at, bytes.raw<std::uint32_t>());
    case 2:
      return put(8 * at, bytes.number());
    case 3:
      return put(4 * at, static_cast<float>(bytes.number()));
    case 4:
      if (at < section.size()) section[at] = static_cast<char>(section[at] ^ static_cast<char>(bytes.byte()));
      return;
    default:
      constexpr std::size_t kMax = 64;
      section.resize(header.elementBytes[which] * (at % kMax), '\0');
  }
}

void useTree(const NormalConeTree& tree) {
  static LmdScratch scratch(512);
  const RigidTransform pose{{0.8, 0.6, 0.0, 0.0}, {0.9, 0.1, 0.2}};
  std::vector<Lmd> found(64);
  require(findLmds(tree, tree, pose, 1.0, scratch, found).count <= found.size(), "no more minima than room");
  CandidateList list;
  list.build({tree, tree, pose, 1.0}, {{}, {0.1, 0.1}}, scratch);
  const SurfaceDistance distance = leastSurfaceDistance(tree, tree, pose, 1.0, scratch, 1U << 16);
  require(!(distance.lowerBound < 0.0), "a lower bound is none below 0");
}

void useMesh(const CachedMesh& cached, const NormalConeTree& tree) {
  const MassMetric metric = massMetric(cached.mass, cached.mesh);
  static_cast<void>(metric);
  static LmdScratch scratch(512);
  const RigidTransform pose{{0.8, 0.6, 0.0, 0.0}, {0.9, 0.1, 0.2}};
  findInterference(tree, tree, pose);
  const UnsidedSurface surface(tree);
  std::vector<TrianglePair> pairs(1024);
  std::vector<SurfaceContact> contacts(64);
  const NearbyTriangles nearby = findNearbyTriangles(surface, surface, pose, 1.0, scratch, pairs, 1U << 16);
  require(nearby.count <= pairs.size(), "no more triangles than room");
  test::testTriangles(surface, surface, pose, 1.0,
                      {std::span(pairs).first(nearby.count), nearby.within, 0.0, 0.0}, contacts);
}

void use(const std::filesystem::path& path) {
  const auto file = TreeCacheFile::open(path, kKey);
  const auto mesh = file ? file->mesh() : std::nullopt;
  if (!mesh) return;
  for (const glm::dvec3& v : mesh->mesh.vertices())
    require(isFinite(v), "vertices are finite");
  require(std::isfinite(mesh->mass.volume) && isFinite(mesh->mass.centre), "mass properties are finite");
  useMesh(*mesh, NormalConeTree(mesh->mesh));
  if (const auto tree = file->tree(mesh->mesh)) {
    useTree(tree->tree);
    useMesh(*mesh, tree->tree);
  }
}

void run(ByteSource& bytes) {
  static const test::TemporaryFolder folder;
  static const std::array<Sections, 3> kMeshes{sectionsOf(test::tetrahedronMesh(), folder),
                                               sectionsOf(test::boxMesh({1.0, 2.0, 3.0}), folder),
                                               sectionsOf(test::finsMesh(1, 3, 2.0), folder)};
  const std::size_t choice = bytes.below(kMeshes.size() + 1);
  if (choice == kMeshes.size()) {
    const auto rest = bytes.rest();
    use(folder.write("changed", {reinterpret_cast<const char*>(rest.data()), rest.size()}));
    return;
  }
  Sections sections = kMeshes[choice];
  constexpr int kMaxChanges = 16;
  for (int i = 0; i < kMaxChanges && !bytes.isEmpty(); ++i)
    change(bytes, sections);
  use(folder.write("changed", sections.file()));
}

}  // namespace
}  // namespace nearfit::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  nearfit::fuzz::ByteSource bytes(data, size);
  nearfit::fuzz::run(bytes);
  return 0;
}
