#pragma once

#include <QTreeView>

namespace nearfit::ui {

/// The tree of parts. A click on an icon in a row toggles it and selects nothing.
class PartsView : public QTreeView {
  Q_OBJECT

 public:
  explicit PartsView(QWidget* parent = nullptr);

  /// Shows the rows whose names contain the text, with the groups around them and all that matching groups
  /// hold; shows all rows if it is empty.
  void setFilter(const QString& text);

 protected:
  void changeEvent(QEvent* event) override;
  QItemSelectionModel::SelectionFlags selectionCommand(const QModelIndex& index,
                                                       const QEvent* event) const override;

 private:
  void showHighlight();
  /// Hides a row unless it, a row below it or a group around it matches. Returns true if it stays.
  bool filterRow(int row, const QModelIndex& parent, const QString& text, bool isWithinMatch);
};

}  // namespace nearfit::ui
