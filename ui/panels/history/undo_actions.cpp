#include "ui/panels/history/undo_actions.h"

#include <QAction>

#include "core/session/session.h"
#include "ui/model/scene_work.h"
#include "ui/widgets/make_action.h"
#include "ui/widgets/names.h"

namespace nearfit::ui {
namespace {

/// Names a step in an action that acts on it.
/// @param verb  What the action does, for its text.
/// @param help  The same for its tool tip.
/// @param step  Label of the step; empty: there is none.
void showStep(QAction& action, const QString& verb, const QString& help, const std::string& step) {
  // An ampersand in a part's name must not become a menu mnemonic.
  const QString name = shortName(step).replace(QChar('&'), QStringLiteral("&&"));
  action.setText(step.empty() ? verb : verb + QChar(' ') + name);
  setHelp(action, help);
}

}  // namespace

UndoActions::UndoActions(Session& session, const SceneWork& work, QObject* parent)
    : QObject(parent),
      undo(makeAction(this, "undo", tr("&Undo"), QStringLiteral("undo"), QKeySequence::Undo)),
      redo(makeAction(this, "redo", tr("&Redo"), QStringLiteral("redo"))),
      session_(session),
      work_(work) {
  redo->setShortcuts({QKeySequence(QStringLiteral("Ctrl+Shift+Z")), QKeySequence(QStringLiteral("Ctrl+Y"))});
  connect(undo, &QAction::triggered, this, [this] {
    emit sceneNeeded();
    const QString step = shortName(session_.undoText());
    session_.undo();
    if (!step.isEmpty()) emit noted(tr("Undone: %1").arg(step));
  });
  connect(redo, &QAction::triggered, this, [this] {
    emit sceneNeeded();
    const QString step = shortName(session_.redoText());
    session_.redo();
    if (!step.isEmpty()) emit noted(tr("Redone: %1").arg(step));
  });
  // They must work from the feel settings too, which stay open beside the window.
  for (QAction* action : {undo, redo})
    action->setShortcutContext(Qt::ApplicationShortcut);
  connect(&work_, &SceneWork::busyChanged, this, &UndoActions::update);
  changes_ = session_.onChange(SceneEvents::Stage::Panels, [this] { update(); });
  update();
}

void UndoActions::update() {
  undo->setEnabled(!work_.isBusy() && session_.canUndo());
  redo->setEnabled(!work_.isBusy() && session_.canRedo());
  showStep(*undo, tr("&Undo"), tr("Undo the last step"), session_.undoText());
  showStep(*redo, tr("&Redo"), tr("Redo the last undone step"), session_.redoText());
}

}  // namespace nearfit::ui
