#pragma once

#include <span>
#include <vector>

#include <vtkActor.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>

#include "core/haptics/servo_snapshot.h"
#include "ui/minima/minima_choice.h"

namespace nearfit::ui {

/// Draws minima as segments with their two points, coloured by distance, the nearest larger; a blocked one,
/// which exerts no force, as a faint line alone. Normals are short lines from either point towards the other
/// surface: as long in a gap of a micrometre as in one of the cutoff.
class LmdOverlay {
 public:
  /// @param renderer  Outlives this.
  explicit LmdOverlay(vtkRenderer& renderer);

  /// @param lmds    In world coordinates [m].
  /// @param cutoff  Distance that gets the last colour [m]; > 0.
  void show(std::span<const SnapshotLmd> lmds, double cutoff);
  void clear() { show({}, 1.0); }
  void setVisible(bool isVisible);
  /// Counts from the next show() on.
  void setChoice(const MinimaChoice& choice);

 private:
  void applyVisibility();

  MinimaChoice choice_;
  bool isVisible_ = true;
  vtkNew<vtkPolyData> segments_, points_, normals_, blocked_, nearest_;
  vtkNew<vtkActor> halo_, lines_, dots_, pins_, faint_, nearestHalo_, nearestLine_, nearestDots_;
};

/// Those of the minima that are drawn: the nearest, as many and as near as is chosen, nearest first.
std::vector<SnapshotLmd> chosenMinima(std::span<const SnapshotLmd> lmds, double cutoff,
                                      const MinimaChoice& choice);

}  // namespace nearfit::ui
