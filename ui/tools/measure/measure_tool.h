#pragma once

#include <QObject>
#include <array>
#include <optional>

#include "core/placing/measure.h"
#include "core/session/session.h"
#include "ui/tools/placing/feature_picker.h"
#include "ui/view3d/measure_mark.h"
#include "ui/widgets/length_unit.h"
#include "ui/widgets/view_bar.h"

class QAction;
class QHBoxLayout;
class QLabel;
class QPushButton;

namespace nearfit::ui {

class Viewport;

/// The measuring tool's bar: prompt, values, copy and close.
class MeasureBar : public ViewBar {
  Q_OBJECT

 public:
  explicit MeasureBar(QWidget* view);

  /// Shows what to do next.
  /// @param hint  The feature under the pointer; may be empty.
  void showPrompt(const QString& prompt, const QString& hint);
  /// Shows the values in that unit; nullopt clears them.
  /// @param measurement  World frame.
  void showMeasurement(const std::optional<Measurement>& measurement, LengthUnit unit);

 signals:
  /// Emitted by Close.
  void closed();

 private:
  struct Value {
    QLabel *name, *number;
  };
  Value addValue(QHBoxLayout& row, const char* name, const QString& title, const QString& toolTip);
  void copy() const;

  QLabel *prompt_, *hint_;
  /// Distance, x, y, z, perpendicular, point to point, angle, how faces lie.
  std::array<Value, 8> values_;
  QPushButton *copy_, *close_;
};

/// Measures between two clicks in the view, each on a corner, edge, circle or face of the same or two parts.
/// The measurement follows its parts and disappears when one leaves the scene. A third click starts a new
/// one; Escape ends the tool.
class MeasureTool : public QObject {
  Q_OBJECT

 public:
  /// @param session, view  Outlive this.
  MeasureTool(const Session& session, Viewport& view, QObject* parent);
  ~MeasureTool() override;

  /// Starts and stops the tool.
  QAction* action() const noexcept { return action_; }

 public slots:
  /// Updates the measurement after parts have moved or the length unit has changed.
  void refresh();

 private:
  struct End {
    PartId part{};
    PartGeometryPtr geometry;  ///< The geometry picked; the part may get another one.
    MeasureEnd inPart;
    QString name;
  };

  void start();
  void stop();
  void take(const FeaturePick& pick);
  void forget();
  void light(FeatureHighlight& highlight, const FeaturePick& pick);
  /// Returns the end in the world, with its part as shown; nullopt if the part or its geometry is gone.
  std::optional<MeasureEnd> shown(const End& end) const;
  void tell(const QString& hint);

  const Session& session_;
  Viewport& view_;
  QAction* action_;
  MeasureBar* bar_;
  FeaturePicker picker_;
  MeasureMark mark_;
  FeatureHighlight fromLight_, toLight_;
  std::optional<End> from_, to_;
};

}  // namespace nearfit::ui
