#pragma once

#include <QStyledItemDelegate>
#include <functional>

namespace nearfit::ui {

/// Edits a name in its row. One that would be refused stays in the editor, marked and with the reason below
/// it, until it is mended, or taken back by Escape.
class NameDelegate : public QStyledItemDelegate {
  Q_OBJECT

 public:
  /// Says why a row cannot have a name; empty when it can.
  using Refusal = std::function<QString(const QModelIndex&, const QString&)>;

  explicit NameDelegate(Refusal refusal, QObject* parent = nullptr);

  QWidget* createEditor(QWidget* parent, const QStyleOptionViewItem& option,
                        const QModelIndex& index) const override;
  void setModelData(QWidget* editor, QAbstractItemModel* model, const QModelIndex& index) const override;

 signals:
  /// What was typed is gone, as its row was left.
  void refused(const QString& reason) const;

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  /// Whether it is refused; then it is marked.
  bool mark(QWidget& editor) const;

  Refusal refusal_;
  mutable QPersistentModelIndex edited_;
};

}  // namespace nearfit::ui
