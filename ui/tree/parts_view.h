#pragma once

#include <QTreeView>

namespace nearfit::ui {

/// The tree of parts: a click on a switch in a row switches, and selects nothing.
class PartsView : public QTreeView {
  Q_OBJECT

 public:
  explicit PartsView(QWidget* parent = nullptr);

  /// Rows whose names hold the text and all that leads to them, or all when it is empty.
  void setFilter(const QString& text);

 protected:
  void changeEvent(QEvent* event) override;
  QItemSelectionModel::SelectionFlags selectionCommand(const QModelIndex& index,
                                                       const QEvent* event) const override;

 private:
  void showHighlight();
  /// Whether the row or one below it stays.
  bool filterRow(int row, const QModelIndex& parent, const QString& text, bool isWithinMatch);
};

}  // namespace nearfit::ui
