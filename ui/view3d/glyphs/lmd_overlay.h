#pragma once

#include <span>
#include <vector>

#include <vtkActor.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>

#include "core/servo/servo_snapshot.h"
#include "ui/view3d/glyphs/colour_range.h"
#include "ui/view3d/glyphs/minima_choice.h"

namespace nearfit::ui {

/// Draws minima as segments with their two points, coloured by distance, the nearest one larger. A blocked
/// minimum, which exerts no force, is a faint line alone. Normals are short lines from both points towards
/// the other surface, of the same length whatever the gap.
class LmdOverlay {
 public:
  /// @param renderer  Outlives this.
  explicit LmdOverlay(vtkRenderer& renderer);

  /// @param lmds    World frame [m].
  /// @param cutoff  Within which they were found [m]; > 0.
  /// @param margin  Distance in contact [m].
  /// @param time    Of the minima [s].
  void show(std::span<const SnapshotLmd> lmds, double cutoff, double margin = 0.0, double time = 0.0);
  /// True if the same minima, shown again, have other colours: their hand has rested until a time [s].
  bool isDue(double time) const noexcept { return colours_.isDue(time); }
  void clear();
  /// Returns the distance at the end of the colour scale [m].
  double colourRange() const noexcept { return colours_.end(); }
  void setVisible(bool isVisible);
  /// @param share  Of the usual opacity, for all that this draws; 0 to 1.
  void setOpacity(double share);
  /// Sets what is drawn; counts from the next show() on.
  void setChoice(const MinimaChoice& choice);

 private:
  void applyVisibility();

  MinimaChoice choice_;
  ColourRange colours_;
  bool isVisible_ = true;
  vtkNew<vtkPolyData> segments_, points_, normals_, blocked_, nearest_;
  vtkNew<vtkActor> halo_, lines_, dots_, pins_, faint_, nearestHalo_, nearestLine_, nearestDots_;
};

/// Returns the minima to draw, as many and as near as `choice` allows, nearest first.
std::vector<SnapshotLmd> chosenMinima(std::span<const SnapshotLmd> lmds, double cutoff,
                                      const MinimaChoice& choice);

}  // namespace nearfit::ui
