#include "ui/shell/welcome_card.h"

#include <QAction>
#include <QDir>
#include <QEvent>
#include <QFileInfo>
#include <QLabel>
#include <QLayoutItem>
#include <QPushButton>
#include <QScrollArea>
#include <QStyle>
#include <QVBoxLayout>
#include <algorithm>
#include <memory>

#include "core/session/session.h"
#include "ui/files/recent_files.h"
#include "ui/widgets/names.h"
#include "ui/widgets/scroll_column.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

constexpr int kMaxRecent = 4;
/// To the edges of the parent, where the card scrolls, and the width of its border [pixels].
constexpr int kAround = 4, kBorder = 1;

}  // namespace

WelcomeCard::WelcomeCard(Session& session, const QList<QAction*>& ways, QWidget* parent)
    : QFrame(parent),
      session_(session),
      content_(new QWidget(this)),
      recent_(new QWidget(content_)),
      hint_(new QLabel(tr("Feel how parts fit together before they exist.\n"
                          "Add two or more meshes, take one in hand, press Feel."),
                       this)),
      recentRows_(new QVBoxLayout(recent_)) {
  setObjectName(QStringLiteral("welcome"));
  setStyleSheet(QStringLiteral(
      "#welcome { background: rgba(255, 255, 255, 235); border: 1px solid #c9d2db; border-radius: 10px; }"));
  auto* layout = new QVBoxLayout(content_);
  layout->setContentsMargins(36, 28, 36, 30);
  layout->setSpacing(9);
  auto* picture = new QLabel(this);
  picture->setPixmap(icon(QStringLiteral("nearfit")).pixmap(64, 64));
  picture->setAlignment(Qt::AlignHCenter);
  auto* title = new QLabel(QStringLiteral("Nearfit"), this);
  title->setStyleSheet(QStringLiteral("font-size: 20pt; font-weight: bold; color: #1c252e"));
  title->setAlignment(Qt::AlignHCenter);
  hint_->setObjectName(QStringLiteral("welcomeHint"));
  hint_->setAlignment(Qt::AlignHCenter);
  hint_->setStyleSheet(QStringLiteral("color: %1; padding-bottom: 10px").arg(colours::kMutedText.name()));
  layout->addWidget(picture);
  layout->addWidget(title);
  layout->addWidget(hint_);
  for (QAction* way : ways)
    addButton(way, way == ways.constFirst());
  recentRows_->setContentsMargins(0, 8, 0, 0);
  recentRows_->setSpacing(2);
  layout->addWidget(recent_);
  QScrollArea* scroll = makeScrollPane(content_, "welcomeScroll");
  // The card itself is the background.
  scroll->viewport()->setAutoFillBackground(false);
  content_->setAutoFillBackground(false);
  auto* whole = new QVBoxLayout(this);
  whole->setContentsMargins(kBorder, kBorder, kBorder, kBorder);
  whole->addWidget(scroll);
  parent->installEventFilter(this);
  content_->installEventFilter(this);
  changes_ = session.onChange(SceneEvents::Stage::Panels, [this] { showIfEmpty(); });
  showIfEmpty();
}

void WelcomeCard::showIfEmpty() {
  const bool isEmpty = session_.scene().parts().empty();
  if (isEmpty) listRecent();
  setVisible(isEmpty);
}

void WelcomeCard::listRecent() {
  while (std::unique_ptr<QLayoutItem> row{recentRows_->takeAt(0)})
    delete row->widget();
  int count = 0;
  for (const QString& file : RecentFiles::list()) {
    if (count == kMaxRecent) break;
    if (!QFileInfo::exists(file)) continue;
    if (count == 0) recentRows_->addWidget(new QLabel(tr("Recent scenes"), recent_));
    auto* button = new QPushButton(
        shortName(QFileInfo(file).fileName()).replace(QChar('&'), QStringLiteral("&&")), recent_);
    button->setObjectName(QStringLiteral("recent%1").arg(++count));
    button->setFlat(true);
    button->setToolTip(QDir::toNativeSeparators(file));
    // Opening it fills this list anew.
    connect(
        button, &QPushButton::clicked, this, [this, file] { emit recentWanted(file); }, Qt::QueuedConnection);
    recentRows_->addWidget(button);
  }
  recent_->setVisible(count > 0);
  fit();
}

void WelcomeCard::addButton(QAction* action, bool isMain) {
  auto* button = new QPushButton(action->icon(), action->text(), this);
  button->setObjectName(action->objectName() + QStringLiteral("Button"));
  button->setMinimumHeight(34);
  button->setIconSize(QSize(20, 20));
  button->setDefault(isMain);
  const auto followAction = [button, action] { button->setEnabled(action->isEnabled()); };
  connect(button, &QPushButton::clicked, action, &QAction::trigger);
  connect(action, &QAction::changed, button, followAction);
  followAction();
  content_->layout()->addWidget(button);
}

bool WelcomeCard::eventFilter(QObject* watched, QEvent* event) {
  const QEvent::Type changing = watched == content_ ? QEvent::LayoutRequest : QEvent::Resize;
  if (event->type() == changing) fit();
  return QFrame::eventFilter(watched, event);
}

void WelcomeCard::fit() {
  ensurePolished();
  // The style sheet's border makes a frame, besides the layout's margin.
  const QMargins frame = contentsMargins();
  const QSize border(2 * kBorder + frame.left() + frame.right(), 2 * kBorder + frame.top() + frame.bottom());
  const QSize room = (parentWidget()->size() - 2 * QSize(kAround, kAround)).expandedTo({0, 0});
  if (!hint_->wordWrap()) wideWidth_ = content_->sizeHint().width();
  const int bar = style()->pixelMetric(QStyle::PM_ScrollBarExtent);
  const bool isNarrow = wideWidth_ + border.width() + bar > room.width();
  if (hint_->wordWrap() != isNarrow) hint_->setWordWrap(isNarrow);
  QSize size = content_->sizeHint();
  if (isNarrow) {
    size.setWidth(std::max(room.width() - border.width(), content_->minimumSizeHint().width()));
    if (content_->hasHeightForWidth()) size.setHeight(content_->heightForWidth(size.width()));
  }
  size += border;
  // Each bar takes room from the other direction.
  if (size.width() > room.width()) size.rheight() += bar;
  if (size.height() > room.height()) size.rwidth() += bar;
  size = size.boundedTo(room);
  resize(size);
  move(parentWidget()->rect().center() - rect().center());
}

}  // namespace nearfit::ui
