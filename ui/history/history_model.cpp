#include "ui/history/history_model.h"

#include <QApplication>
#include <QFont>
#include <QPalette>
#include <utility>

#include "ui/theme.h"

namespace nearfit::ui {

void HistoryModel::show(std::vector<std::string> labels, int current) {
  if (labels == labels_ && current == current_) return;
  beginResetModel();
  labels_ = std::move(labels);
  current_ = current;
  endResetModel();
}

int HistoryModel::rowCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : static_cast<int>(labels_.size());
}

QString HistoryModel::text(int row) const {
  const std::string& label = labels_[static_cast<std::size_t>(row)];
  return label.empty() ? tr("Beginning") : QString::fromStdString(label);
}

QVariant HistoryModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid() || index.row() >= rowCount()) return {};
  const int row = index.row();
  switch (role) {
    case Qt::DisplayRole:
      return text(row);
    case Qt::ToolTipRole:
      if (row == current_) return tr("The scene is as it was after this step");
      return row < current_ ? tr("Undo back to here") : tr("Redo up to here");
    case Qt::AccessibleTextRole:
      if (row == current_) return tr("%1, present state").arg(text(row));
      return row < current_ ? text(row) : tr("%1, undone").arg(text(row));
    case Qt::DecorationRole:
      return row == current_ ? icon(QStringLiteral("history-now")) : icon(QStringLiteral("history-step"));
    case Qt::FontRole: {
      QFont font;
      font.setBold(row == current_);
      font.setItalic(row > current_);
      return font;
    }
    case Qt::ForegroundRole:
      return row > current_ ? QVariant(QApplication::palette().color(QPalette::PlaceholderText)) : QVariant();
    default:
      return {};
  }
}

}  // namespace nearfit::ui
