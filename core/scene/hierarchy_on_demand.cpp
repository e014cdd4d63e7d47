#include "core/scene/hierarchy_on_demand.h"

#include <chrono>

#include "core/error.h"

namespace nearfit {
namespace {

/// How long one who waits for another's work may take to see that it was cancelled itself.
constexpr std::chrono::milliseconds kPatience{20};

}  // namespace

const NormalConeTree& HierarchyOnDemand::get(const TriangleMesh& mesh, const ProgressCallback& progress) {
  if (const NormalConeTree* tree = ready_.load(std::memory_order_acquire)) return *tree;
  waitForTurn(progress);
  // From here on this thread is the only one that builds, or the hierarchy is there.
  if (!isReady()) build(mesh, progress);
  return *ready_.load(std::memory_order_acquire);
}

void HierarchyOnDemand::waitForTurn(const ProgressCallback& progress) {
  std::unique_lock lock(mutex_);
  while (isBuilding_) {
    ended_.wait_for(lock, kPatience);
    if (!isBuilding_ || !progress) continue;
    lock.unlock();
    if (!progress(0.0)) throw Cancelled();
    lock.lock();
  }
  isBuilding_ = !isReady();
}

void HierarchyOnDemand::build(const TriangleMesh& mesh, const ProgressCallback& progress) {
  const auto end = [this] {
    const std::lock_guard lock(mutex_);
    isBuilding_ = false;
    ended_.notify_all();
  };
  try {
    if (progress && !progress(0.0)) throw Cancelled();
    const auto start = std::chrono::steady_clock::now();
    auto tree = std::make_unique<const NormalConeTree>(mesh, progress);
    buildTime_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (progress && !progress(1.0)) throw Cancelled();
    tree_ = std::move(tree);
    ready_.store(tree_.get(), std::memory_order_release);
  } catch (...) {
    end();
    throw;
  }
  end();
}

}  // namespace nearfit
