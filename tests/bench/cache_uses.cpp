#include <array>
#include <filesystem>

#include "core/base/error.h"
#include "core/proximity/cache/tree_cache.h"
#include "core/proximity/query/lmd_query.h"
#include "tests/bench/query_method.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::bench {
namespace {

/// A mesh with its hierarchy in a cache of its own, as if it had been loaded from a file.
class CacheOfOne {
 public:
  explicit CacheOfOne(const TriangleMesh& mesh)
      : cached_{mesh, {}, massProperties(mesh)},
        tree_{NormalConeTree(mesh), true},
        cache_({folder_.path(), kMaxBytes, 0}) {}

  BuiltHierarchy write() const {
    if (!cache_.store(key_, cached_, &tree_)) throw Error("cache", "the mesh cannot be kept");
    return {nullptr, static_cast<std::size_t>(cache_.usage().bytes)};
  }

  /// What is read.
  struct Loaded {
    CachedMesh mesh;
    NormalConeTree tree;
  };
  Loaded load() const {
    const std::optional<TreeCacheFile> file = cache_.find(key_);
    std::optional<CachedMesh> mesh = file ? file->mesh() : std::nullopt;
    std::optional<CachedTree> tree = mesh ? file->tree(mesh->mesh) : std::nullopt;
    if (!mesh || !tree) throw Error("cache", "what was kept is not to be had");
    return {std::move(*mesh), std::move(tree->tree)};
  }

  /// Loads, and measures the mesh against itself set beside it.
  BuiltHierarchy loadAndQuery() const {
    const Loaded loaded = load();
    const Aabb& box = loaded.mesh.mesh.bounds();
    const double cutoff = kCutoff * box.diagonal();
    RigidTransform beside;
    beside.translation.x = box.upper.x - box.lower.x + 0.5 * cutoff;
    LmdScratch scratch;
    std::array<Lmd, 1024> lmds;
    const LmdResult result = findLmds(loaded.tree, loaded.tree, beside, cutoff, scratch, lmds);
    if (result.count == 0) throw Error("cache", "the first query found nothing");
    return {nullptr, bytesOf(loaded)};
  }

  static std::size_t bytesOf(const Loaded& loaded) {
    return loaded.mesh.mesh.byteSize() + loaded.tree.byteSize();
  }

 private:
  static constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 40;
  static constexpr double kCutoff = 0.05;  ///< Of the diagonal, as in the query benchmark.

  test::TemporaryFolder folder_;
  TreeCacheKey key_{std::string(64, '0'), 1.0};
  CachedMesh cached_;
  CachedTree tree_;
  TreeCache cache_;
};

}  // namespace

std::vector<BuildEntry> nearfitCacheUses() {
  return {
      {"nearfit-cache-write",
       {},
       [](const TriangleMesh& mesh) -> std::function<BuiltHierarchy()> {
         const auto cache = std::make_shared<const CacheOfOne>(mesh);
         return [cache] { return cache->write(); };
       }},
      {"nearfit-cache-load",
       {},
       [](const TriangleMesh& mesh) -> std::function<BuiltHierarchy()> {
         const auto cache = std::make_shared<const CacheOfOne>(mesh);
         cache->write();
         return [cache]() -> BuiltHierarchy {
           auto loaded = std::make_shared<const CacheOfOne::Loaded>(cache->load());
           return {loaded, CacheOfOne::bytesOf(*loaded)};
         };
       }},
      {"nearfit-cache-query",
       {},
       [](const TriangleMesh& mesh) -> std::function<BuiltHierarchy()> {
         const auto cache = std::make_shared<const CacheOfOne>(mesh);
         cache->write();
         return [cache] { return cache->loadAndQuery(); };
       }},
  };
}

}  // namespace nearfit::bench
