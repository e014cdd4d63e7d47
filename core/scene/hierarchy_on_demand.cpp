#include "core/scene/hierarchy_on_demand.h"

#include <chrono>

#include "core/base/error.h"
#include "core/mesh/flat_mesh.h"

namespace nearfit {
namespace {

/// Max delay before a waiting thread notices its own cancellation.
constexpr std::chrono::milliseconds kPatience{20};

/// Progress when the flats are merged.
constexpr double kMerged = 0.15;

double secondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

std::optional<HierarchyOrigin> HierarchyOnDemand::origin() const {
  return isReady() ? std::optional(origin_) : std::nullopt;
}

const NormalConeTree& HierarchyOnDemand::make(const TriangleMesh& mesh, const ProgressCallback& progress) {
  waitForTurn(progress);
  // Now either this thread alone makes the hierarchy, or it is ready.
  if (const NormalConeTree* tree = ready_.load(std::memory_order_acquire)) return *tree;
  const auto end = [this] {
    const std::lock_guard lock(mutex_);
    isMaking_ = false;
    ended_.notify_all();
  };
  try {
    findOrBuild(mesh, progress);
  } catch (...) {
    end();
    throw;
  }
  end();
  return *tree_;
}

void HierarchyOnDemand::waitForTurn(const ProgressCallback& progress) {
  std::unique_lock lock(mutex_);
  while (isMaking_) {
    ended_.wait_for(lock, kPatience);
    if (!isMaking_ || !progress) continue;
    lock.unlock();
    if (!progress(0.0)) throw Cancelled();
    lock.lock();
  }
  isMaking_ = !isReady();
}

void HierarchyOnDemand::findOrBuild(const TriangleMesh& mesh, const ProgressCallback& progress) {
  if (progress && !progress(0.0)) throw Cancelled();
  const auto start = std::chrono::steady_clock::now();
  std::optional<NormalConeTree> found = find_ ? find_() : std::nullopt;
  if (found) {
    tree_.emplace(std::move(*found));
  } else if (build_) {
    tree_.emplace(build_(progress));
  } else {
    tree_.emplace(mergeFlats(mesh, coordinateRounding_, stageOf(progress, 0.0, kMerged)),
                  stageCallback(progress, kMerged, 1.0));
  }
  origin_ = {found.has_value(), secondsSince(start)};
  ready_.store(&*tree_, std::memory_order_release);
  if (!found && keep_) keep_(*tree_);
  // Not called again: release what they hold, such as meshes.
  find_ = nullptr;
  keep_ = nullptr;
  build_ = nullptr;
  if (progress) progress(1.0);
}

}  // namespace nearfit
