#pragma once

#include <QStyledItemDelegate>
#include <QTreeView>
#include <functional>

namespace nearfit::ui {

/// Edits a name in its row. A name that would be refused stays in the editor, marked and with the reason
/// below it, until it is corrected, or discarded with Escape.
class NameDelegate : public QStyledItemDelegate {
  Q_OBJECT

 public:
  /// Returns why a row cannot have a name; empty if it can.
  using Refusal = std::function<QString(const QModelIndex&, const QString&)>;

  explicit NameDelegate(Refusal refusal, QObject* parent = nullptr);

  QWidget* createEditor(QWidget* parent, const QStyleOptionViewItem& option,
                        const QModelIndex& index) const override;
  void setModelData(QWidget* editor, QAbstractItemModel* model, const QModelIndex& index) const override;

 signals:
  /// Emitted when a refused name was discarded because its row was left.
  void refused(const QString& reason) const;

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  /// Marks a name that is refused. Returns true if it is.
  bool mark(QWidget& editor) const;

  Refusal refusal_;
  mutable QPersistentModelIndex edited_;
};

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
