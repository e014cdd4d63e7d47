#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>

#include "core/progress.h"
#include "core/proximity/normal_cone_tree.h"

namespace nearfit {

/// Where a hierarchy came from, and how long that took.
struct HierarchyOrigin {
  bool isFromCache = false;
  double seconds = 0.0;  ///< To build it, or to map and check it; not what keeping it took.
};

/// The hierarchy of one mesh, built when it is first needed, or taken from where one was kept. Any number of
/// threads may ask: one builds, the others wait for it.
class HierarchyOnDemand {
 public:
  /// What was kept of the hierarchy; none when it must be built.
  using Find = std::function<std::optional<NormalConeTree>()>;
  /// Keeps what was built.
  using Keep = std::function<void(const NormalConeTree&)>;

  explicit HierarchyOnDemand(Find find = {}, Keep keep = {})
      : find_(std::move(find)), keep_(std::move(keep)) {}
  HierarchyOnDemand(const HierarchyOnDemand&) = delete;
  HierarchyOnDemand& operator=(const HierarchyOnDemand&) = delete;

  /// Whether get() answers at once.
  bool isReady() const noexcept { return ready_.load(std::memory_order_acquire) != nullptr; }
  /// Makes the hierarchy of `mesh`, always the same one, unless it is there. Throws what building does, and
  /// Cancelled; the next call then starts anew.
  const NormalConeTree& get(const TriangleMesh& mesh, const ProgressCallback& progress = {}) {
    const NormalConeTree* tree = ready_.load(std::memory_order_acquire);
    return tree != nullptr ? *tree : make(mesh, progress);
  }
  /// None before it is ready.
  std::optional<HierarchyOrigin> origin() const;

 private:
  const NormalConeTree& make(const TriangleMesh& mesh, const ProgressCallback& progress);
  void waitForTurn(const ProgressCallback& progress);
  void findOrBuild(const TriangleMesh& mesh, const ProgressCallback& progress);

  Find find_;
  Keep keep_;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool isMaking_ = false;  ///< Guarded by the mutex; what follows belongs to who makes it until it is ready.
  std::optional<const NormalConeTree> tree_;
  HierarchyOrigin origin_;
  std::atomic<const NormalConeTree*> ready_{nullptr};
};

}  // namespace nearfit
