#include "ui/panels/history/history_panel.h"

#include <QApplication>
#include <QFont>
#include <QListView>
#include <QPalette>
#include <QVBoxLayout>
#include <utility>

#include <glm/trigonometric.hpp>

#include "ui/model/scene_work.h"
#include "ui/widgets/format.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

/// The least shift that is shown, 0.01 µm [m], and the least angle, half of 0.001° [rad]: less would be nothing but zeros.
constexpr double kMinShift = 1e-8, kMinAngle = 8.73e-6;

/// Formats an angle [rad] with one decimal, or with the three of number fields if it would show as 0.0°.
QString formatTurn(double angle) {
  constexpr double kSmall = 0.05;  // [degrees]
  const double degrees = glm::degrees(angle);
  return formatFixed(degrees, degrees < kSmall ? 3 : 1) + QChar(0xB0);
}

/// Says of a move that would show as none how small it is.
QString formatTinyMove(const Session::Step& step) {
  constexpr double kLeastDegrees = 0.001;
  const bool isTurn = step.angle / kMinAngle > step.shift / kMinShift;
  return HistoryModel::tr("under %1")
      .arg(isTurn ? formatFixed(kLeastDegrees, 3) + QChar(0xB0) : formatLength(kMinShift));
}

}  // namespace

void HistoryModel::show(std::vector<Session::Step> steps, int current) {
  if (steps == steps_ && current == current_) return;
  beginResetModel();
  steps_ = std::move(steps);
  current_ = current;
  endResetModel();
}

void HistoryModel::refresh() {
  if (!steps_.empty()) emit dataChanged(index(0), index(rowCount() - 1));
}

int HistoryModel::rowCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : static_cast<int>(steps_.size());
}

QString HistoryModel::text(int row) const {
  const Session::Step& step = steps_[static_cast<std::size_t>(row)];
  if (step.label.empty()) return tr("Beginning");
  QString text = QString::fromStdString(step.label);
  const bool isShift = step.shift >= kMinShift, isTurn = step.angle >= kMinAngle;
  if (isShift) text += QStringLiteral(", ") + formatLength(step.shift);
  if (isTurn) text += QStringLiteral(", ") + formatTurn(step.angle);
  const bool isMove = step.shift > 0.0 || step.angle > 0.0;
  if (isMove && !isShift && !isTurn) text += QStringLiteral(", ") + formatTinyMove(step);
  return text;
}

QVariant HistoryModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid() || index.row() >= rowCount()) return {};
  const int row = index.row();
  switch (role) {
    case Qt::DisplayRole:
      return text(row);
    case Qt::ToolTipRole:
      if (row == current_) return tr("The current state of the scene");
      return row < current_ ? tr("Undo back to here") : tr("Redo up to here");
    case Qt::AccessibleTextRole:
      if (row == current_) return tr("%1, current state").arg(text(row));
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

HistoryPanel::HistoryPanel(Session& session, const SceneWork& work, QWidget* parent)
    : QWidget(parent), session_(session), model_(new HistoryModel(this)), view_(new QListView(this)) {
  setObjectName(QStringLiteral("historyPanel"));
  view_->setObjectName(QStringLiteral("historyView"));
  view_->setAccessibleName(tr("History"));
  view_->setAccessibleDescription(tr("Steps of undo and redo, oldest first"));
  view_->setModel(model_);
  view_->setUniformItemSizes(true);
  view_->setEditTriggers(QAbstractItemView::NoEditTriggers);
  view_->setTextElideMode(Qt::ElideMiddle);
  view_->setIconSize(QSize(16, 16));
  view_->setFrameShape(QFrame::NoFrame);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(view_);
  connect(view_, &QListView::clicked, this, [this](const QModelIndex& index) { goTo(index.row()); });
  connect(view_, &QListView::activated, this, [this](const QModelIndex& index) { goTo(index.row()); });
  connect(&work, &SceneWork::busyChanged, this, [this, &work] { setEnabled(!work.isBusy()); });
  changes_ = session_.onChange(SceneEvents::Stage::Panels, [this] { showHistory(); });
  showHistory();
}

void HistoryPanel::showHistory() {
  const int current = static_cast<int>(session_.historyIndex());
  model_->show(session_.history(), current);
  const QModelIndex index = model_->index(current);
  if (view_->currentIndex() == index) return;
  view_->setCurrentIndex(index);
  view_->scrollTo(index);
}

QWidget* HistoryPanel::list() const noexcept {
  return view_;
}

void HistoryPanel::refresh() {
  model_->refresh();
}

void HistoryPanel::goTo(int row) {
  if (row >= 0) session_.goTo(static_cast<std::size_t>(row));
}

}  // namespace nearfit::ui
