// Commands recorded by the menu, given by the window's actions, and replayed with and without a window.
#include <QMenu>
#include <QMenuBar>
#include <QProcess>
#include <QStatusBar>

#include "core/scene/scene_file.h"
#include "tests/app/desktop/desktop_driver.h"
#include "tests/support/places.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

QString scriptName() {
  return QStringLiteral("session.jsonl");
}

/// The session's scene as a scene file in that folder would have it.
std::string sceneText(DesktopDriver& d, const TemporaryFolder& folder) {
  return sceneFileText(d.session().scene(), folder.path() / "out.nearfit");
}

QString pathIn(const TemporaryFolder& folder, const QString& name) {
  return QString::fromStdString(folder.path().string()) + QChar('/') + name;
}

/// Starts to record by the menu.
void record(DesktopDriver& d, const QString& file) {
  whenModal<QFileDialog>([file](QFileDialog* dialog) { chooseFile(dialog, file); });
  d.choose("recordCommands");
}

}  // namespace

class DesktopScriptTest : public QObject {
  Q_OBJECT

 private slots:
  void aRecordedSessionLeadsToTheSameSceneInAWindowAndWithoutOne();
  void theEntrySaysHowManyCommandsThereAre();
  void oneCommandIsNotCalledCommands();
  void anotherSceneEndsTheRecording();
  void aCancelledQuestionRecordsNothing();
  void aLineThatFailsIsShownAndTheSceneIsAsBeforeIt();
  void aMeshOfTheStartThatHasChangedIsTold();
};

void DesktopScriptTest::aRecordedSessionLeadsToTheSameSceneInAWindowAndWithoutOne() {
  DesktopDriver d;
  const QString script = pathIn(d.folder, scriptName());
  d.addCubes();
  record(d, script);
  QVERIFY(d.action("recordCommands")->isChecked());
  d.window().selection().select(d.partId("fixed"));
  d.choose("duplicate");
  d.choose("toggleVisible");
  d.window().selection().select(d.partId("moving"));
  d.choose("remove");
  pressShortcut(d, Qt::Key_Z, Qt::ControlModifier);
  d.add({d.movingFile});
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{4});
  d.session().movePart(d.partId("fixed"), {{0.5, -0.5, 0.5, 0.5}, {0.1, 0.2, 1.0 / 3.0}});
  d.choose("selectAll");
  d.choose("group");
  d.choose("recordCommands");
  QVERIFY(!d.action("recordCommands")->isChecked());
  const std::string expected = sceneText(d, d.folder);

  DesktopDriver other;
  other.application.replayScript(script);
  QTRY_COMPARE(other.session().scene().parts().size(), std::size_t{4});
  QTRY_COMPARE(QString::fromStdString(sceneText(other, d.folder)), QString::fromStdString(expected));
  QVERIFY(other.session().isModified());
  QVERIFY(other.session().file().empty());

  QProcess program;
  program.start(QString::fromStdString(test::builtPath("nearfit-cli")),
                {QStringLiteral("script"), script, QStringLiteral("-o"),
                 pathIn(d.folder, QStringLiteral("out.nearfit"))});
  QVERIFY(program.waitForFinished(60'000));
  QVERIFY2(program.exitCode() == 0, program.readAllStandardError().constData());
  QCOMPARE(QString::fromStdString(readBytes(d.folder.path() / "out.nearfit")),
           QString::fromStdString(expected));
}

void DesktopScriptTest::theEntrySaysHowManyCommandsThereAre() {
  DesktopDriver d;
  d.addCubes();
  const QString before = d.action("recordCommands")->text();
  record(d, pathIn(d.folder, scriptName()));
  QVERIFY(d.action("recordCommands")->text().contains(QStringLiteral("(0)")));
  d.session().renamePart(d.partId("fixed"), "Block");
  QVERIFY(d.action("recordCommands")->text().contains(QStringLiteral("(1)")));
  d.session().undo();
  QVERIFY(d.action("recordCommands")->text().contains(QStringLiteral("(0)")));
  d.session().redo();
  d.add({d.movingFile});
  QTRY_VERIFY(d.action("recordCommands")->text().contains(QStringLiteral("(2)")));
  QMenu* edit = d.window().menuBar()->findChild<QMenu*>(QStringLiteral("editMenu"));
  QVERIFY(edit != nullptr && edit->actions().contains(d.action("recordCommands")));
  edit->popup(d.window().mapToGlobal(QPoint(0, 0)));
  keepPictures(*edit, QStringLiteral("recording-commands"));
  edit->close();
  d.choose("recordCommands");
  QCOMPARE(d.action("recordCommands")->text(), before);
  QCOMPARE(d.window().statusBar()->currentMessage(), QStringLiteral("Recorded 2 commands to session.jsonl"));
  keepPictures(d.window(), QStringLiteral("recorded-commands"));
}

void DesktopScriptTest::oneCommandIsNotCalledCommands() {
  DesktopDriver d;
  d.addCubes();
  record(d, pathIn(d.folder, scriptName()));
  d.session().renamePart(d.partId("fixed"), "Block");
  d.choose("recordCommands");
  QCOMPARE(d.window().statusBar()->currentMessage(), QStringLiteral("Recorded 1 command to session.jsonl"));
}

void DesktopScriptTest::anotherSceneEndsTheRecording() {
  DesktopDriver d;
  d.addCubes();
  record(d, pathIn(d.folder, scriptName()));
  d.session().renamePart(d.partId("fixed"), "Block");
  d.session().reset();
  QVERIFY(!d.action("recordCommands")->isChecked());
  const std::string script = readBytes(d.folder.path() / scriptName().toStdString());
  QVERIFY(script.find("renamePart") != std::string::npos);
}

void DesktopScriptTest::aCancelledQuestionRecordsNothing() {
  DesktopDriver d;
  whenModal<QFileDialog>([](QFileDialog* dialog) { dialog->reject(); });
  d.choose("recordCommands");
  QVERIFY(!d.action("recordCommands")->isChecked());
}

void DesktopScriptTest::aLineThatFailsIsShownAndTheSceneIsAsBeforeIt() {
  DesktopDriver d;
  QString shown;
  d.window().setFailureSink([&](const ui::Failure& failure) { shown = failure.details; });
  const auto script = d.folder.write(
      "bad.jsonl",
      "{\"nearfitScript\": 1}\n{\"do\": \"group\", \"parts\": [], \"name\": \"Frame\"}\n{\"do\": 1}\n");
  d.application.replayScript(QString::fromStdString(script.string()));
  QTRY_VERIFY(shown.contains(QStringLiteral("bad.jsonl:3")));
  QCOMPARE(d.session().scene().groups().size(), std::size_t{1});
}

/// The command line told of it, the window did not.
void DesktopScriptTest::aMeshOfTheStartThatHasChangedIsTold() {
  DesktopDriver d;
  d.addCubes();
  d.session().save(d.folder.path() / "start.nearfit");
  const auto script = d.folder.write("session.jsonl",
                                     "{\"nearfitScript\": 1, \"scene\": \"start.nearfit\"}\n"
                                     "{\"do\": \"renamePart\", \"part\": \"moving\", \"name\": \"Cube\"}\n");
  writeOff(d.fixedFile.toStdString(), boxMesh(glm::dvec3(0.05)));
  DesktopDriver other;
  other.application.replayScript(QString::fromStdString(script.string()));
  QTRY_COMPARE(other.session().scene().parts().size(), std::size_t{2});
  QTRY_VERIFY(other.widget<QWidget>("notice-others") != nullptr);
  const auto* text = other.widget<QWidget>("notice-others")->findChild<QLabel*>(QStringLiteral("noticeText"));
  QVERIFY2(text->text().startsWith(QStringLiteral("fixed.off has changed since")), qPrintable(text->text()));
  QVERIFY(other.session().scene().findByName("Cube") != nullptr);
}

NEARFIT_QT_SUITE(DesktopScriptTest, runDesktopTest<DesktopScriptTest>)
#include "desktop_script_test.moc"
