#pragma once

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>

#include "core/mesh/mesh_import.h"
#include "core/proximity/normal_cone_tree.h"

namespace nearfit {

/// The hierarchy of one mesh, built when it is first needed. Any number of threads may ask: one builds, the
/// others wait for it.
class HierarchyOnDemand {
 public:
  HierarchyOnDemand() = default;
  HierarchyOnDemand(const HierarchyOnDemand&) = delete;
  HierarchyOnDemand& operator=(const HierarchyOnDemand&) = delete;

  /// Whether tree() answers at once.
  bool isReady() const noexcept { return ready_.load(std::memory_order_acquire) != nullptr; }
  /// Builds the hierarchy of `mesh`, always the same one, unless it is there. Throws what building does, and
  /// Cancelled; the next call then starts anew.
  const NormalConeTree& get(const TriangleMesh& mesh, const ProgressCallback& progress = {});
  /// How long building took [s]; 0 before.
  double buildTime() const noexcept { return isReady() ? buildTime_ : 0.0; }

 private:
  void waitForTurn(const ProgressCallback& progress);
  void build(const TriangleMesh& mesh, const ProgressCallback& progress);

  std::mutex mutex_;
  std::condition_variable ended_;
  bool isBuilding_ = false;  ///< Guarded by the mutex; the rest belongs to who builds until it is ready.
  std::unique_ptr<const NormalConeTree> tree_;
  double buildTime_ = 0.0;
  std::atomic<const NormalConeTree*> ready_{nullptr};
};

}  // namespace nearfit
