#pragma once

#include <QString>
#include <array>
#include <optional>

#include <vtkActor.h>
#include <vtkLineSource.h>
#include <vtkNew.h>

#include "core/placing/measure.h"
#include "ui/pair_segment.h"

class QLabel;

namespace nearfit::ui {

class Viewport;

/// A measured distance in the view: its line with a label in the middle, and the way along the world's axes
/// in their colours. Over all parts.
class MeasureMark {
 public:
  /// @param view  Outlives this, or takes what is drawn with it.
  explicit MeasureMark(Viewport& view);
  ~MeasureMark();
  MeasureMark(const MeasureMark&) = delete;
  MeasureMark& operator=(const MeasureMark&) = delete;

  /// @param measurement  In the world.
  void show(const Measurement& measurement, const QString& text);
  void clear();
  bool isShown() const noexcept { return shown_.has_value(); }
  /// The label stands where the line is seen now; once a picture has been drawn.
  void placeLabel();

 private:
  Viewport& view_;
  vtkWeakPointer<vtkRenderer> overlay_;
  PairSegment segment_;
  struct Leg {
    vtkNew<vtkLineSource> line;
    vtkNew<vtkActor> actor;
  };
  std::array<Leg, 3> legs_;
  QLabel* label_;
  std::optional<Measurement> shown_;
};

}  // namespace nearfit::ui
