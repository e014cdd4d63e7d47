#include "ui/shell/tour.h"

#include <QApplication>
#include <QEvent>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>
#include <algorithm>
#include <utility>

#include "ui/widgets/font_scale.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

constexpr int kTourWidth = 330, kTourGap = 12;

}  // namespace

Tour::Tour(QWidget* window)
    : QFrame(window),
      title_(new QLabel(this)),
      text_(new QLabel(this)),
      count_(new QLabel(this)),
      next_(new QPushButton(tr("Next"), this)),
      leave_(new QPushButton(tr("End the tour"), this)),
      frame_(new QFrame(window)) {
  setObjectName(QStringLiteral("tour"));
  setAccessibleName(tr("Tour"));
  setAutoFillBackground(true);
  setFrameShape(QFrame::StyledPanel);
  frame_->setObjectName(QStringLiteral("tourFrame"));
  frame_->setAttribute(Qt::WA_TransparentForMouseEvents);
  frame_->setStyleSheet(QStringLiteral("#tourFrame { border: 2px solid %1; border-radius: 4px; }")
                            .arg(colours::kAccent.name()));
  frame_->hide();
  QFont bold = title_->font();
  bold.setBold(true);
  title_->setFont(bold);
  title_->setObjectName(QStringLiteral("tourTitle"));
  text_->setWordWrap(true);
  text_->setObjectName(QStringLiteral("tourText"));
  next_->setObjectName(QStringLiteral("tourNext"));
  leave_->setObjectName(QStringLiteral("tourLeave"));
  auto* buttons = new QHBoxLayout;
  buttons->addWidget(count_, 1);
  buttons->addWidget(leave_);
  buttons->addWidget(next_);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(14, 12, 14, 12);
  layout->addWidget(title_);
  layout->addWidget(text_);
  layout->addLayout(buttons);
  connect(next_, &QPushButton::clicked, this, &Tour::next);
  connect(leave_, &QPushButton::clicked, this, &Tour::end);
  window->installEventFilter(this);
  hide();
}

void Tour::begin(std::vector<Stop> stops) {
  stops_ = std::move(stops);
  std::erase_if(stops_, [](const Stop& stop) { return stop.where == nullptr || !stop.where->isVisible(); });
  if (stops_.empty()) return;
  show(0);
}

void Tour::show(std::size_t stop) {
  current_ = stop;
  title_->setText(stops_[stop].title);
  text_->setText(stops_[stop].text);
  count_->setText(tr("%1 of %2").arg(stop + 1).arg(stops_.size()));
  next_->setText(stop + 1 < stops_.size() ? tr("Next") : tr("Done"));
  // Installing it again does not make two of it.
  qApp->installEventFilter(this);
  frame_->show();
  frame_->raise();
  QFrame::show();
  raise();
  place();
  next_->setFocus();
}

void Tour::next() {
  for (std::size_t stop = current_ + 1; stop < stops_.size(); ++stop) {
    if (stops_[stop].where != nullptr && stops_[stop].where->isVisible()) return show(stop);
  }
  end();
}

void Tour::end() {
  if (isHidden()) return;
  qApp->removeEventFilter(this);
  hide();
  frame_->hide();
  emit ended();
}

/// Places the callout beside what it is about, on the side with most room. If no side has enough, it goes into the
/// upper left corner of it: a view has its legend, scale bar and axes in the others, and its centre stays free.
void Tour::place() {
  QWidget* where = stops_[current_].where;
  if (where == nullptr) return;
  const QRect around(where->mapTo(parentWidget(), QPoint(0, 0)), where->size());
  const QRect whole = parentWidget()->rect();
  frame_->setGeometry(around.adjusted(-2, -2, 2, 2).intersected(whole));
  const int wide = forFont(*this, kTourWidth);
  resize(wide, layout()->hasHeightForWidth() ? layout()->totalHeightForWidth(wide)
                                             : layout()->totalSizeHint().height());
  const int left = around.left(), right = whole.width() - around.right();
  const int top = around.top(), bottom = whole.height() - around.bottom();
  QPoint corner = around.center() - QPoint(width() / 2, height() / 2);
  if (std::max(left, right) >= width() + 2 * kTourGap) {
    corner.setX(right >= left ? around.right() + kTourGap : around.left() - kTourGap - width());
  } else if (std::max(top, bottom) >= height() + 2 * kTourGap) {
    corner.setY(bottom >= top ? around.bottom() + kTourGap : around.top() - kTourGap - height());
  } else {
    corner = around.topLeft() + QPoint(kTourGap, kTourGap);
  }
  move(std::clamp(corner.x(), kTourGap, std::max(kTourGap, whole.width() - width() - kTourGap)),
       std::clamp(corner.y(), kTourGap, std::max(kTourGap, whole.height() - height() - kTourGap)));
}

bool Tour::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::Resize && watched == parentWidget() && isVisible()) place();
  if (event->type() == QEvent::KeyPress && isVisible()) {
    const auto* receiver = qobject_cast<QWidget*>(watched);
    if (receiver != nullptr && takeKey(*receiver, static_cast<QKeyEvent*>(event)->key())) return true;
  }
  return QFrame::eventFilter(watched, event);
}

bool Tour::takeKey(const QWidget& receiver, int key) {
  // Dialogs keep their keys, and the callout has its own.
  if (receiver.window() != window() || &receiver == this || isAncestorOf(&receiver)) return false;
  const bool isField = receiver.inherits("QLineEdit") || receiver.inherits("QAbstractSpinBox") ||
                       receiver.inherits("QComboBox");
  if (key == Qt::Key_Escape && !isField) {
    end();
    return true;
  }
  // In lists Return opens or edits.
  const bool isExplained =
      std::ranges::any_of(stops_, [&](const Stop& stop) { return stop.where == &receiver; });
  if (!isExplained || (key != Qt::Key_Return && key != Qt::Key_Enter)) return false;
  next();
  return true;
}

void Tour::keyPressEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_Escape) return end();
  if (event->key() == Qt::Key_Return || event->key() == Qt::Key_Enter)
    return focusWidget() == leave_ ? end() : next();
  QFrame::keyPressEvent(event);
}

}  // namespace nearfit::ui
