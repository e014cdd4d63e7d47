#pragma once

#include <QString>
#include <array>

#include <vtkActor.h>
#include <vtkLineSource.h>
#include <vtkNew.h>

#include "core/placing/measure.h"
#include "ui/view3d/glyphs/pair_segment.h"

namespace nearfit::ui {

class SpotLabel;
class Viewport;

/// Draws a measured distance over all parts: a line with a label at its middle, and its components along the
/// world axes in their colours.
class MeasureMark {
 public:
  /// @param view  May be destroyed first; after that only the destructor may be called.
  explicit MeasureMark(Viewport& view);
  ~MeasureMark();
  MeasureMark(const MeasureMark&) = delete;
  MeasureMark& operator=(const MeasureMark&) = delete;

  /// @param measurement  World frame.
  /// @param text         Of the label.
  void show(const Measurement& measurement, const QString& text);
  void clear();

 private:
  vtkWeakPointer<vtkRenderer> overlay_;
  PairSegment segment_;
  struct Leg {
    vtkNew<vtkLineSource> line;
    vtkNew<vtkActor> actor;
  };
  std::array<Leg, 3> legs_;
  SpotLabel* label_;
};

}  // namespace nearfit::ui
