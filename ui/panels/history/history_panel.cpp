#include "ui/panels/history/history_panel.h"

#include <QListView>
#include <QVBoxLayout>

#include "ui/model/history_model.h"
#include "ui/model/scene_work.h"

namespace nearfit::ui {

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

void HistoryPanel::refresh() {
  model_->refresh();
}

void HistoryPanel::goTo(int row) {
  if (row >= 0) session_.goTo(static_cast<std::size_t>(row));
}

}  // namespace nearfit::ui
