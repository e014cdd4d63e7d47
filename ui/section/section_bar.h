#pragma once

#include <array>
#include <optional>
#include <utility>

#include "ui/view_bar.h"

class QCheckBox;
class QHBoxLayout;
class QLabel;
class QPushButton;
class QSlider;
class QToolButton;

namespace nearfit::ui {

class NumberField;

/// What a plane was laid across: an axis of the world, the direction of sight as it was then, or a face.
enum class SectionAxis { X, Y, Z, Sight, Face };

/// What a section is set by, over the lower edge of the view.
class SectionBar : public ViewBar {
  Q_OBJECT

 public:
  explicit SectionBar(QWidget* view);

  /// Nothing: the plane has been tilted since.
  void showAxis(std::optional<SectionAxis> axis);
  /// A face is being asked for.
  void showPicking(bool isPicking);
  /// Along the plane's direction [m].
  void showPosition(double position, const std::pair<double, double>& reach);
  bool isMovingSpared() const;
  void spareMoving(bool isSpared);
  /// What is asked for, or cannot be closed; may be empty.
  void showNote(const QString& note);

 signals:
  /// Also when the same is chosen again; not Face.
  void axisChosen(nearfit::ui::SectionAxis axis);
  /// A face shall be asked for, or shall not any more.
  void faceWanted(bool isWanted);
  /// [m]
  void positionEdited(double position);
  void flipped();
  void sparingEdited(bool isSpared);
  void closed();

 private:
  QToolButton* addAxis(QHBoxLayout& row, const char* name, const QString& text, const QString& toolTip);
  void addAxes(QHBoxLayout& row);
  void setUpFields();

  std::array<QToolButton*, 5> axes_{};  ///< By SectionAxis.
  QSlider* slider_;
  NumberField* position_;
  QPushButton* flip_;
  QCheckBox* spare_;
  QPushButton* close_;
  QLabel* note_;
  std::optional<SectionAxis> axis_;
  bool isPicking_ = false;
  std::pair<double, double> reach_{0.0, 1.0};  ///< Of the slider [m].
};

}  // namespace nearfit::ui
