#pragma once

#include <QWidget>
#include <optional>

#include "core/session/session.h"
#include "ui/panels/clearance/map_search.h"
#include "ui/widgets/error_box.h"

class QAction;
class QCheckBox;
class QLabel;
class QProgressBar;
class QPushButton;
class QWidget;

namespace nearfit::ui {

class ClearanceLegend;
class HandState;
class HistogramView;
class MapProbe;
class NumberField;
class Selection;
class Viewport;

/// Colours the selected part, else the part or group in hand, by its clearance to the others, and shows how much of its surface
/// is how near. The colours stay while the panel is hidden.
class ClearanceMapPanel : public QWidget {
  Q_OBJECT

 public:
  /// The scene to map and the view to show it in; all outlive this.
  struct Context {
    Session& session;
    const Selection& selection;
    const HandState& hand;
    Viewport& view;
  };
  explicit ClearanceMapPanel(const Context& context, QWidget* parent = nullptr);

  /// Returns the switch that turns colours on and off.
  QAction* colour() const noexcept { return colour_; }
  const ClearanceMapSearch& search() const noexcept { return search_; }

 public slots:
  /// Shows lengths in the unit that has been chosen.
  void refresh();

 signals:
  /// Emitted when the user wants to export the map.
  void exportWanted();
  /// Emitted when something failed that the user must see.
  void failed(const nearfit::ui::Failure& failure);

 private:
  void setUpFields();
  void setUpLayout();
  void setColoured(bool isColoured);
  void applyRange();
  void showMap();
  void showWork();
  /// Name of the part or group that is mapped; empty if there is none.
  QString subjectName() const;
  QString subjectText() const;
  /// How much of the surface is how near.
  QString areasText() const;
  void showLegend();

  Session& session_;
  Viewport& view_;
  ClearanceMapSearch search_;
  ClearanceLegend* legend_;
  MapProbe* probe_;
  QAction* colour_;
  QCheckBox *automatic_, *nearParts_;
  NumberField *range_, *threshold_;
  HistogramView* histogram_;
  QLabel *subject_, *areas_;
  QProgressBar* progress_;
  QPushButton *cancel_, *export_;
  Subscription changes_;
};

}  // namespace nearfit::ui
