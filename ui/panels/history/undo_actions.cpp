#include "ui/panels/history/undo_actions.h"

#include <QAction>
#include <optional>

#include "core/session/session.h"
#include "ui/model/hand_state.h"
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

UndoActions::UndoActions(Session& session, const SceneWork& work, const HandState& hand, QObject* parent)
    : QObject(parent),
      undo(makeAction(this, "undo", tr("&Undo"), QStringLiteral("undo"), QKeySequence::Undo)),
      redo(makeAction(this, "redo", tr("&Redo"), QStringLiteral("redo"))),
      session_(session),
      work_(work),
      hand_(hand) {
  redo->setShortcuts({QKeySequence(QStringLiteral("Ctrl+Shift+Z")), QKeySequence(QStringLiteral("Ctrl+Y"))});
  connect(undo, &QAction::triggered, this, [this] {
    emit sceneNeeded();
    step(tr("Undone: %1"), session_.undoText(), [this] { session_.undo(); });
  });
  connect(redo, &QAction::triggered, this, [this] {
    emit sceneNeeded();
    step(tr("Redone: %1"), session_.redoText(), [this] { session_.redo(); });
  });
  // They must work from the feel settings too, which stay open beside the window.
  for (QAction* action : {undo, redo})
    action->setShortcutContext(Qt::ApplicationShortcut);
  connect(&work_, &SceneWork::busyChanged, this, &UndoActions::update);
  changes_ = session_.onChange(SceneEvents::Stage::Panels, [this] { update(); });
  update();
}

void UndoActions::step(const QString& pattern, const std::string& label, const std::function<void()>& act) {
  const QString name = shortName(label);
  const std::optional<PartId> held = hand_.part();
  const QString heldName = held ? shortName(session_.scene().get(*held).name) : QString();
  act();
  QString note = name.isEmpty() ? QString() : pattern.arg(name);
  // A step may take away the part, or that it is the one to move.
  if (held && !hand_.part()) note += tr(". Feeling has stopped: %1 is no longer in hand").arg(heldName);
  if (!note.isEmpty()) emit noted(note);
}

void UndoActions::update() {
  undo->setEnabled(!work_.isBusy() && session_.canUndo());
  redo->setEnabled(!work_.isBusy() && session_.canRedo());
  showStep(*undo, tr("&Undo"), tr("Undo the last step"), session_.undoText());
  showStep(*redo, tr("&Redo"), tr("Redo the last undone step"), session_.redoText());
}

}  // namespace nearfit::ui
