#include "ui/widgets/notice_bar.h"

#include <QEvent>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QStyle>
#include <QToolButton>
#include <QVBoxLayout>
#include <algorithm>
#include <utility>

#include "ui/widgets/names.h"

namespace nearfit::ui {
namespace {

/// Leaves the corner to the view's orientation marker [pixels].
constexpr int kNoticeMargin = 10, kMarkerWidth = 130, kMaxWidth = 760;

}  // namespace

NoticeBar::NoticeBar(QWidget* parent) : QFrame(parent) {
  setObjectName(QStringLiteral("noticeBar"));
  setAccessibleName(tr("Notices"));
  setAutoFillBackground(true);
  setFrameShape(QFrame::StyledPanel);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(8, 4, 8, 4);
  layout->setSpacing(2);
  parent->installEventFilter(this);
  hide();
}

void NoticeBar::offer(const QString& key, const QString& text, std::vector<Choice> choices,
                      std::function<void()> dismissed) {
  withdraw(key);
  auto* row = new QWidget(this);
  row->setObjectName(QStringLiteral("notice-") + key);
  auto* layout = new QHBoxLayout(row);
  layout->setContentsMargins(0, 0, 0, 0);
  auto* label = new QLabel(breakable(text), row);
  label->setObjectName(QStringLiteral("noticeText"));
  label->setTextFormat(Qt::PlainText);
  label->setWordWrap(true);
  layout->addWidget(label, 1);
  int number = 0;
  for (Choice& choice : choices) {
    auto* button = new QPushButton(choice.text, row);
    button->setObjectName(QStringLiteral("choice%1").arg(++number));
    connect(button, &QPushButton::clicked, this, [this, key, act = std::move(choice.act)] {
      withdraw(key);
      act();
    });
    layout->addWidget(button);
  }
  auto* close = new QToolButton(row);
  close->setObjectName(QStringLiteral("dismiss"));
  close->setAutoRaise(true);
  close->setIcon(style()->standardIcon(QStyle::SP_TitleBarCloseButton));
  close->setToolTip(tr("Dismiss and change nothing"));
  close->setAccessibleName(tr("Dismiss: %1").arg(text));
  connect(close, &QToolButton::clicked, this, [this, key, dismissed = std::move(dismissed)] {
    withdraw(key);
    if (dismissed) dismissed();
  });
  layout->addWidget(close);
  offers_[key] = row;
  qobject_cast<QVBoxLayout*>(this->layout())->addWidget(row);
  show();
  raise();
  place();
}

void NoticeBar::withdraw(const QString& key) {
  QWidget* row = offers_.take(key);
  if (row == nullptr) return;
  layout()->removeWidget(row);
  row->hide();
  row->deleteLater();
  setVisible(!offers_.isEmpty());
  if (!offers_.isEmpty()) place();
}

bool NoticeBar::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::Resize && isVisible()) place();
  return QFrame::eventFilter(watched, event);
}

void NoticeBar::place() {
  const int width = std::min(parentWidget()->width() - 2 * kNoticeMargin - kMarkerWidth, kMaxWidth);
  const int height = layout()->hasHeightForWidth() ? layout()->totalHeightForWidth(width)
                                                   : layout()->totalSizeHint().height();
  setGeometry((parentWidget()->width() - kMarkerWidth - width) / 2, kNoticeMargin, width, height);
}

}  // namespace nearfit::ui
