#pragma once

#include <QObject>
#include <optional>

#include "core/session/session.h"
#include "ui/tools/placing/feature_picker.h"
#include "ui/view3d/measure_mark.h"

class QAction;

namespace nearfit::ui {

class MeasureBar;
class Viewport;

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
