#pragma once

#include <QObject>
#include <optional>

#include "core/session.h"
#include "ui/measure/measure_mark.h"
#include "ui/placing/feature_picker.h"

class QAction;

namespace nearfit::ui {

class MeasureBar;
class Viewport;

/// Measures between two clicks in the view, each on a corner, edge, circle or face of a part, the same one or
/// two. What is measured goes with its parts, however they are moved, and with a part that leaves it is gone;
/// a third click begins anew, Escape leaves.
class MeasureTool : public QObject {
  Q_OBJECT

 public:
  /// @param session, view  Outlive this.
  MeasureTool(const Session& session, Viewport& view, QObject* parent);
  ~MeasureTool() override;

  /// Switches it on and off.
  QAction* action() const noexcept { return action_; }

 public slots:
  /// The parts are elsewhere, or the unit of length is another.
  void refresh();

 private:
  struct End {
    PartId part{};
    PartGeometryPtr geometry;  ///< That was pointed at: the part may get another.
    MeasureEnd inPart;
    QString name;
  };

  void start();
  void stop();
  void take(const FeaturePick& pick);
  void forget();
  void light(FeatureHighlight& highlight, const FeaturePick& pick);
  /// In the world as it is shown.
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
