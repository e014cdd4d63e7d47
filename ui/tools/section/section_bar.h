#pragma once

#include <array>
#include <optional>
#include <utility>

#include "ui/widgets/view_bar.h"

class QCheckBox;
class QHBoxLayout;
class QLabel;
class QPushButton;
class QSlider;
class QToolButton;

namespace nearfit::ui {

class NumberField;

/// Ways to lay the plane: across a world axis or the direction of view at that time, or through a face.
enum class SectionAxis { X, Y, Z, Sight, Face };

/// The section tool's bar: axis, position, flip, and whether the moving part stays whole.
class SectionBar : public ViewBar {
  Q_OBJECT

 public:
  explicit SectionBar(QWidget* view);

  /// Checks the button of that axis; nullopt: the plane was tilted since.
  void showAxis(std::optional<SectionAxis> axis);
  /// Shows whether a face is being asked for.
  void showPicking(bool isPicking);
  /// Shows the plane's position.
  /// @param position  Along the plane's direction [m].
  /// @param reach     Ends of the slider [m].
  void showPosition(double position, const std::pair<double, double>& reach);
  /// True if the moving part stays whole.
  bool isMovingSpared() const;
  /// Sets that without a signal.
  void spareMoving(bool isSpared);
  /// Shows a prompt, or what cannot be closed; empty hides it.
  void showNote(const QString& note);

 signals:
  /// Emitted when an axis is chosen, also the same one again; never with Face.
  void axisChosen(nearfit::ui::SectionAxis axis);
  /// Emitted when the user starts or stops asking for a face.
  void faceWanted(bool isWanted);
  /// Emitted when the plane is moved by slider or number [m].
  void positionEdited(double position);
  /// Emitted by Flip: cut away the other side.
  void flipped();
  /// Emitted when the user chose whether the moving part stays whole.
  void sparingEdited(bool isSpared);
  /// Emitted by Close.
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
  std::pair<double, double> reach_{0.0, 1.0};  ///< Ends of the slider [m].
};

}  // namespace nearfit::ui
