#pragma once

#include <QWidget>
#include <cstdint>
#include <optional>

#include "core/report/clearance.h"
#include "core/session/session.h"
#include "ui/panels/clearance/clearance_search.h"
#include "ui/view3d/glyphs/pair_segment.h"
#include "ui/widgets/error_box.h"

class QComboBox;
class QLabel;
class QPushButton;
class QSortFilterProxyModel;
class QTableView;

namespace nearfit::ui {

class ClearanceModel;
class HandState;
class NumberField;
class Selection;
class SpotLabel;
class Viewport;

/// Shows in a table how near a part is to each other one. The view shows where the pair of the chosen row is
/// nearest, with the distance; choosing a row highlights the two and fits them into the view, until another part is
/// selected or Escape is pressed. It leaves the selection alone: the next number or drag is meant for one part.
class ClearancePanel : public QWidget {
  Q_OBJECT

 public:
  /// What it measures and shows it in; all outlive this.
  struct Context {
    Session& session;
    const Selection& selection;
    const HandState& hand;
    Viewport& view;
  };
  /// @param window  Sees the keys that nothing in it has handled; outlives this.
  ClearancePanel(const Context& context, ClearanceSearch::PoseOfMoving poseOfMoving, QWidget* window);

 public slots:
  /// Shows lengths in the unit that has been chosen.
  void refresh();

 signals:
  /// Emitted when something failed that the user must see.
  void failed(const nearfit::ui::Failure& failure);
  /// Emitted with a short note for the status bar.
  void noted(const QString& text);

 protected:
  void showEvent(QShowEvent* event) override;
  void hideEvent(QHideEvent* event) override;

 private:
  void setUpTable();
  void setUpFields();
  void showSubjects();
  void showClearances();
  void showNote();
  /// Returns the pair of the chosen row, as it is now; nullopt if no row is chosen or the panel is hidden.
  std::optional<PartClearance> chosen() const;
  void choose();
  /// Shows in the view where the chosen pair is nearest.
  void showPair();
  /// True while a recording shows the moving part where it was not searched yet.
  bool isBehindReplay() const;
  /// Follows the moving part where the servo does not: in a recording.
  void followMoving();
  void exportTable();

  Session& session_;
  Viewport& view_;
  ClearanceSearch search_;
  PairSegment segment_;
  bool isPairShown_ = false;  ///< The pair is highlighted.
  SpotLabel* label_;
  std::uint64_t sceneSerial_ = 0;  ///< Serial of the scene whose parts are offered.
  ClearanceModel* model_;
  QSortFilterProxyModel* sorted_;
  QTableView* table_;
  QComboBox* subject_;
  NumberField* threshold_;
  QLabel* note_;
  QPushButton* export_;
  Subscription changes_;
};

}  // namespace nearfit::ui
