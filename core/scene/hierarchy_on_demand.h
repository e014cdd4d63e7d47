#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>

#include "core/base/progress.h"
#include "core/proximity/hierarchy/normal_cone_tree.h"

namespace nearfit {

/// Where a hierarchy came from and how long it took.
struct HierarchyOrigin {
  bool isFromCache = false;
  double seconds = 0.0;  ///< Time to build it, or to read and check it; excludes storing it.
};

/// Hierarchy of one mesh with its flats merged (mergeFlats()), built or taken from the cache when first needed. Thread-safe: one thread builds,
/// others wait for it.
class HierarchyOnDemand {
 public:
  /// Looks up a stored hierarchy; std::nullopt if it must be built.
  using Find = std::function<std::optional<NormalConeTree>()>;
  /// Stores a newly built hierarchy.
  using Keep = std::function<void(const NormalConeTree&)>;
  /// Builds a hierarchy of a mesh whose flats are known already. May throw Cancelled.
  using Build = std::function<NormalConeTree(const ProgressCallback&)>;

  /// @param coordinateRounding  Of the mesh, as for mergeFlats() [m].
  explicit HierarchyOnDemand(Find find = {}, Keep keep = {}, double coordinateRounding = 0.0)
      : find_(std::move(find)), keep_(std::move(keep)), coordinateRounding_(coordinateRounding) {}
  /// @param build  Takes the place of mergeFlats() and what follows.
  HierarchyOnDemand(Find find, Keep keep, Build build)
      : find_(std::move(find)), keep_(std::move(keep)), build_(std::move(build)) {}
  HierarchyOnDemand(const HierarchyOnDemand&) = delete;
  HierarchyOnDemand& operator=(const HierarchyOnDemand&) = delete;

  /// True if get() returns at once. Real-time safe.
  bool isReady() const noexcept { return ready_.load(std::memory_order_acquire) != nullptr; }
  /// Returns the hierarchy of `mesh`, which must be the same mesh in each call; builds it if
  /// needed. Real-time safe once isReady(). Throws Cancelled and what building throws; the next
  /// call then starts over.
  const NormalConeTree& get(const TriangleMesh& mesh, const ProgressCallback& progress = {}) {
    const NormalConeTree* tree = ready_.load(std::memory_order_acquire);
    return tree != nullptr ? *tree : make(mesh, progress);
  }
  /// Origin of the hierarchy; std::nullopt until ready.
  std::optional<HierarchyOrigin> origin() const;

 private:
  const NormalConeTree& make(const TriangleMesh& mesh, const ProgressCallback& progress);
  void waitForTurn(const ProgressCallback& progress);
  void findOrBuild(const TriangleMesh& mesh, const ProgressCallback& progress);

  Find find_;
  Keep keep_;
  Build build_;
  double coordinateRounding_ = 0.0;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool isMaking_ = false;  ///< Guarded by mutex_. Until ready, only the making thread uses the members below.
  std::optional<const NormalConeTree> tree_;
  HierarchyOrigin origin_;
  std::atomic<const NormalConeTree*> ready_{nullptr};
};

}  // namespace nearfit
