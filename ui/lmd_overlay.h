#pragma once

#include <span>

#include <vtkActor.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>

#include "core/haptics/servo_tick.h"

namespace nearfit::ui {

/// Draws each minimum as a segment with its two points, coloured by distance; a blocked one, which exerts no
/// force, as a faint line alone.
class LmdOverlay {
 public:
  /// @param renderer  Outlives this.
  explicit LmdOverlay(vtkRenderer& renderer);

  /// @param lmds    In world coordinates [m].
  /// @param cutoff  Distance that gets the last colour [m]; > 0.
  void show(std::span<const SnapshotLmd> lmds, double cutoff);
  void clear() { show({}, 1.0); }
  void setVisible(bool isVisible);

 private:
  vtkNew<vtkPolyData> segments_, points_, blocked_;
  vtkNew<vtkActor> halo_, lines_, dots_, faint_;
};

}  // namespace nearfit::ui
