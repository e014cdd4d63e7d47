#pragma once

#include <QPoint>
#include <chrono>
#include <memory>
#include <vector>

#include "core/scene/scene.h"

namespace nearfit::bench {

/// The same parts in a window of plain VTK and Qt, an actor each, as their tutorials show it: what to compare
/// with.
class PlainWindow {
 public:
  explicit PlainWindow(const Scene& scene);
  ~PlainWindow();

  /// As BenchWindow::orbit.
  std::vector<double> orbit(std::chrono::milliseconds time);
  void pickAt(const QPoint& position);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace nearfit::bench
