#include "ui/panels/replay/record_action.h"

#include <QFileInfo>
#include <QWidget>
#include <optional>

#include "ui/model/hand_state.h"
#include "ui/widgets/format.h"
#include "ui/widgets/make_action.h"
#include "ui/widgets/names.h"
#include "ui/widgets/preferences.h"
#include "ui/widgets/save_file.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {

RecordAction::RecordAction(const HandState& hand, QWidget* window)
    : QAction(ui::icon(QStringLiteral("record")), tr("&Record…"), window), window_(window), hand_(hand) {
  setObjectName(QStringLiteral("record"));
  setShortcut(QKeySequence(Qt::Key_F8));
  setCheckable(true);
  setHelp(*this, tr("Record every tick to a file until you stop"));
  connect(this, &QAction::triggered, this, [this](bool isOn) {
    if (isOn) {
      askAndStart();
    } else {
      emit recordRequested({});
    }
  });
}

void RecordAction::askAndStart() {
  const std::optional<QString> file = askForSave({tr("Record to"),
                                                  Preferences::lastFolder() + QStringLiteral("/felt.csv"),
                                                  {tr("Recordings (*.csv)")},
                                                  {QStringLiteral("csv")}},
                                                 window_);
  if (!file) return setChecked(false);
  Preferences::rememberFolderOf(*file);
  emit recordRequested(*file);
  if (!hand_.status().isTaken())
    emit noted(tr("The next feel will be recorded to %1").arg(shortName(QFileInfo(*file).fileName())));
}

void RecordAction::showRecording(const QString& file, double seconds) {
  const bool isOn = !file.isEmpty();
  setChecked(isOn);
  QString shown = tr("&Record…");
  if (isOn && seconds > 0.0) shown = tr("Stop &recording (%1 s)").arg(seconds, 0, 'f', 0);
  if (isOn && !(seconds > 0.0))
    shown = tr("Cancel &recording to %1").arg(shortName(QFileInfo(file).fileName()));
  if (text() != shown) setText(shown);
}

void RecordAction::showRecorded(const QString& file, double seconds, quint64 lost) {
  QString note =
      tr("Recorded %1 s to %2").arg(formatFixed(seconds, 1), shortName(QFileInfo(file).fileName()));
  if (lost > 0) note += tr("; %1 ticks are missing because the window was busy").arg(lost);
  emit noted(note);
}

void RecordAction::showFailed() {
  emit noted(tr("The recording has stopped"));
}

}  // namespace nearfit::ui
