#include "ui/shell/welcome_card.h"

#include <QAction>
#include <QEvent>
#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>

#include "core/session/session.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {

WelcomeCard::WelcomeCard(Session& session, const QList<QAction*>& ways, QWidget* parent)
    : QFrame(parent), session_(session) {
  setObjectName(QStringLiteral("welcome"));
  setStyleSheet(QStringLiteral(
      "#welcome { background: rgba(255, 255, 255, 235); border: 1px solid #c9d2db; border-radius: 10px; }"));
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(36, 28, 36, 30);
  layout->setSpacing(9);
  auto* picture = new QLabel(this);
  picture->setPixmap(icon(QStringLiteral("nearfit")).pixmap(64, 64));
  picture->setAlignment(Qt::AlignHCenter);
  auto* title = new QLabel(QStringLiteral("Nearfit"), this);
  title->setStyleSheet(QStringLiteral("font-size: 20pt; font-weight: bold; color: #1c252e"));
  title->setAlignment(Qt::AlignHCenter);
  auto* hint = new QLabel(tr("Feel how parts fit together before they exist.\n"
                             "Add two or more meshes, take one in hand, press Feel."),
                          this);
  hint->setAlignment(Qt::AlignHCenter);
  hint->setStyleSheet(QStringLiteral("color: %1; padding-bottom: 10px").arg(colours::kMutedText.name()));
  layout->addWidget(picture);
  layout->addWidget(title);
  layout->addWidget(hint);
  for (QAction* way : ways)
    addButton(way, way == ways.constFirst());
  parent->installEventFilter(this);
  adjustSize();
  centre();
  changes_ = session.onChange(SceneEvents::Stage::Panels, [this] { showIfEmpty(); });
  showIfEmpty();
}

void WelcomeCard::showIfEmpty() {
  setVisible(session_.scene().parts().empty());
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
  layout()->addWidget(button);
}

bool WelcomeCard::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::Resize) centre();
  return QFrame::eventFilter(watched, event);
}

void WelcomeCard::centre() {
  move(parentWidget()->rect().center() - rect().center());
}

}  // namespace nearfit::ui
