#pragma once

#include <QStyledItemDelegate>
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

}  // namespace nearfit::ui
