#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace nearfit {

/// Lends work spaces to the tasks of parallel loops: as many are made as tasks run at a time, and kept for later ones.
/// Thread-safe. A work space whose task throws is dropped.
template <class Space>
class WorkSpaces {
 public:
  /// @param make  Makes one; called in any thread.
  explicit WorkSpaces(std::function<std::unique_ptr<Space>()> make) : make_(std::move(make)) {}

  /// Calls task(Space&) with a work space that no other task uses meanwhile.
  template <class Task>
  void with(const Task& task) {
    std::unique_ptr<Space> space = take();
    if (!space) space = make_();
    task(*space);
    const std::scoped_lock lock(mutex_);
    free_.push_back(std::move(space));
  }

 private:
  std::unique_ptr<Space> take() {
    const std::scoped_lock lock(mutex_);
    if (free_.empty()) return nullptr;
    std::unique_ptr<Space> space = std::move(free_.back());
    free_.pop_back();
    return space;
  }

  std::function<std::unique_ptr<Space>()> make_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Space>> free_;
};

}  // namespace nearfit
