#pragma once

#include <QWidget>
#include <cstdint>
#include <optional>
#include <utility>

#include "core/report/clearance.h"
#include "core/session/session.h"
#include "ui/widgets/error_box.h"

class QComboBox;
class QLabel;
class QPushButton;
class QSortFilterProxyModel;
class QTableView;

namespace nearfit::ui {

class ClearanceModel;
class ClearanceSearch;
class NumberField;

/// Shows in a table how near a part is to each other one; the chosen row is a pair to look at.
class ClearancePanel : public QWidget {
  Q_OBJECT

 public:
  /// @param session  Must outlive this.
  /// @param search   Must outlive this.
  ClearancePanel(Session& session, ClearanceSearch& search, QWidget* parent = nullptr);

  /// Returns the pair of the chosen row, as it is now; std::nullopt if no row is chosen or
  /// the panel is hidden.
  std::optional<PartClearance> chosen() const;

 signals:
  /// Emitted when the user chooses a row.
  void pairChosen(nearfit::PartId part, nearfit::PartId other);
  /// Emitted when chosen() may return another pair.
  void chosenChanged();
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
  void choose();
  void exportTable();

  Session& session_;
  ClearanceSearch& search_;
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
