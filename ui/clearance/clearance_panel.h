#pragma once

#include <QWidget>
#include <cstdint>
#include <optional>
#include <utility>

#include "core/report/clearance.h"
#include "core/session.h"
#include "ui/dialogs/error_box.h"

class QComboBox;
class QLabel;
class QPushButton;
class QSortFilterProxyModel;
class QTableView;

namespace nearfit::ui {

class ClearanceModel;
class ClearanceSearch;
class NumberField;

/// How near a part is to each other one, as a table; the row that is chosen is a pair to look at.
class ClearancePanel : public QWidget {
  Q_OBJECT

 public:
  /// @param session, search  Outlive this.
  ClearancePanel(Session& session, ClearanceSearch& search, QWidget* parent = nullptr);

  /// The pair of the chosen row, as it is now; nothing when none is chosen.
  std::optional<PartClearance> chosen() const;

 signals:
  /// The user has chosen a row.
  void pairChosen(nearfit::PartId part, nearfit::PartId other);
  /// What chosen() gives may be another.
  void chosenChanged();
  void failed(const nearfit::ui::Failure& failure);
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
  std::uint64_t sceneSerial_ = 0;  ///< Of the scene whose parts are offered.
  ClearanceModel* model_;
  QSortFilterProxyModel* sorted_;
  QTableView* table_;
  QComboBox* subject_;
  NumberField* threshold_;
  QLabel* note_;
  QPushButton* export_;
};

}  // namespace nearfit::ui
