#include "ui/panels/history/command_record_action.h"

#include <QFileInfo>
#include <QWidget>
#include <exception>
#include <optional>

#include "core/session/session.h"
#include "ui/widgets/make_action.h"
#include "ui/widgets/names.h"
#include "ui/widgets/paths.h"
#include "ui/widgets/preferences.h"
#include "ui/widgets/save_file.h"

namespace nearfit::ui {

CommandRecordAction::CommandRecordAction(Session& session, QWidget* window)
    : QAction(window), window_(window), recorder_(session) {
  setObjectName(QStringLiteral("recordCommands"));
  setCheckable(true);
  setText(tr("Record commands…"));
  setHelp(*this, tr("Record the commands that change the scene to a script until you stop"));
  connect(this, &QAction::triggered, this, [this](bool isOn) {
    emit sceneNeeded();
    if (isOn) {
      askAndStart();
    } else {
      stop();
    }
  });
  changes_ = session.onChange(SceneEvents::Stage::Panels, [this] { follow(); });
}

CommandRecordAction::~CommandRecordAction() {
  changes_.end();
  try {
    recorder_.stop();
  } catch (...) {
    // The window is gone, and with it the place to say so; the file holds a script without commands.
  }
}

bool CommandRecordAction::attempt(const QString& what, const std::function<void()>& act) {
  try {
    act();
    return true;
  } catch (const std::exception&) {
    emit failed(describe(what, std::current_exception()));
    return false;
  }
}

void CommandRecordAction::askAndStart() {
  const std::optional<QString> file =
      askForSave({tr("Record commands to"),
                  Preferences::lastFolder() + QStringLiteral("/session.jsonl"),
                  {tr("Scripts (*.jsonl)")},
                  {QStringLiteral("jsonl")}},
                 window_);
  if (file) {
    Preferences::rememberFolderOf(*file);
    attempt(tr("The commands cannot be recorded."), [&] { recorder_.start(toPath(*file)); });
  }
  update();
}

void CommandRecordAction::stop() {
  const QString name = shortName(QFileInfo(fromPath(recorder_.file())).fileName());
  const auto steps = static_cast<qulonglong>(recorder_.steps());
  if (attempt(tr("The recorded commands could not be written."), [this] { recorder_.stop(); })) {
    emit noted(steps == 1 ? tr("Recorded 1 command to %1").arg(name)
                          : tr("Recorded %1 commands to %2").arg(steps).arg(name));
  } else if (recorder_.endsHere()) {
    // Its scene is gone: there is nothing to go on with.
    recorder_.drop();
  }
  update();
}

void CommandRecordAction::follow() {
  if (!recorder_.isRecording()) return;
  if (recorder_.endsHere()) return stop();
  if (!attempt(tr("The commands cannot be recorded any more."), [this] { recorder_.follow(); }))
    recorder_.drop();
  update();
}

void CommandRecordAction::update() {
  setChecked(recorder_.isRecording());
  const QString shown =
      recorder_.isRecording()
          ? tr("Stop recording commands (%1)").arg(static_cast<qulonglong>(recorder_.steps()))
          : tr("Record commands…");
  if (text() != shown) setText(shown);
}

}  // namespace nearfit::ui
