#include <QDoubleSpinBox>
#include <QProcess>
#include <QSignalSpy>
#include <QStatusBar>
#include <algorithm>

#include <signal.h>

#include "core/recovery/recovery_folder.h"
#include "core/scene/scene_file.h"
#include "tests/app/desktop/recovery_driver.h"
#include "tests/support/places.h"
#include "tests/support/process_identity_of.h"
#include "ui/files/recovery/autosave.h"
#include "ui/files/recovery/recovery.h"
#include "ui/model/parts_model.h"

using namespace nearfit;
using namespace nearfit::test;

namespace fs = std::filesystem;

namespace {

/// What a process that is about to die has on its screen.
struct Doomed {
  DesktopDriver& d;
  const fs::path folder, state;

  void waitForJournal(const std::string& expected) const {
    if (!isJournalKept(state, expected)) std::exit(3);
    std::ofstream(folder / "expected") << expected;
  }
  void typeX(const char* millimetres) const {
    d.clickPart(1, ui::PartsModel::Name);
    d.type<QDoubleSpinBox>("positionX", millimetres);
  }
  void loseEdits() const {
    typeX("12.345678901");
    d.type<QDoubleSpinBox>("rotationZ", "33.3");
    waitForJournal(poses(d.session().scene()));
  }
  void loseHeld() const {
    d.session().save(folder / "held.nearfit");
    RigidTransform last;
    QObject::connect(&d.application.servo(), &desktop::ServoController::snapshotArrived, &d.application,
                     [&](const ServoSnapshot& snapshot) { last = snapshot.proxy; });
    d.startWith(ui::Hand::Manual);
    const std::size_t steps = d.session().history().size();
    typeX("7.25");
    const bool isThere =
        QTest::qWaitFor([&] { return std::abs(last.translation.x - 0.00725) < 1e-12; }, 30'000);
    if (!isThere || d.session().history().size() != steps) std::exit(4);
    Scene expected = d.session().scene();
    Part part = d.part("moving");
    part.worldFromPart = last;
    expected.replace(part);
    waitForJournal(poses(expected));
    if (d.session().history().size() != steps) std::exit(5);
  }
};

/// The other end of `lose`: works on a scene and dies without a word.
int die(int argc, char** argv) {
  desktop::Application::prepare();
  const fs::path folder = argv[3];
  QSettings::setPath(QSettings::IniFormat, QSettings::UserScope, QString::fromStdString(folder.string()));
  QApplication qt(argc, argv);
  desktop::Application::configure();
  DesktopDriver d;
  const Doomed doomed{d, folder, folder / "state"};
  d.window().protectWork(doomed.state);
  d.add({QString::fromStdString((folder / "fixed.off").string()),
         QString::fromStdString((folder / "moving.off").string())});
  if (!QTest::qWaitFor([&] { return d.session().scene().parts().size() == 2; }, 30'000)) return 2;
  d.session().setMovingPart(d.partId("moving"));
  QLatin1String(argv[2]) == QLatin1String("held") ? doomed.loseHeld() : doomed.loseEdits();
  fs::remove_all(d.folder.path());
  return ::raise(SIGKILL);
}

}  // namespace

class DesktopRecoveryTest : public QObject {
  Q_OBJECT

 private slots:
  void unsavedSceneOfAKilledProcessComesBack();
  void poseInHandOfAKilledProcessComesBackAndTheFileIsKnown();
  void theProgramItselfIsKilledAndItsSceneComesBack();
  void whatEndsOnlyAfterTheStartIsOfferedToo();
  void laterOffersAgainAndDiscardDoesNot();
  void damagedJournalIsTold();
  void savingOrUndoingLeavesNothingToRecover();
  void nothingIsWrittenWhileNothingChanges();
  void folderThatCannotBeWrittenGivesOneQuietNote();
};

namespace {

/// A folder with the meshes that the scene of a process that dies is made of.
struct DoomedPlace {
  DoomedPlace() {
    writeOff(folder.path() / "fixed.off", boxMesh(glm::dvec3(0.04)));
    writeOff(folder.path() / "moving.off", boxMesh(glm::dvec3(0.02), glm::dvec3(0.0, 0.0, 0.035)));
  }
  void lose(const char* how) {
    QProcess process;
    process.setProcessChannelMode(QProcess::ForwardedChannels);
    process.start(QCoreApplication::applicationFilePath(),
                  {QStringLiteral("desktop_recovery_test"), QStringLiteral("--die"), QLatin1String(how),
                   QString::fromStdString(folder.path().string())});
    QVERIFY(process.waitForFinished(120'000));
    QCOMPARE(process.exitStatus(), QProcess::CrashExit);
  }
  std::string expected() const { return readBytes(folder.path() / "expected"); }

  TemporaryFolder folder;
  fs::path state = folder.path() / "state";
};

}  // namespace

void DesktopRecoveryTest::unsavedSceneOfAKilledProcessComesBack() {
  DoomedPlace place;
  place.lose("edits");
  QVERIFY(!QTest::currentTestFailed());
  DesktopDriver d;
  d.window().protectWork(place.state);
  ui::RecoveryDialog* dialog = dialogOf(d);
  QVERIFY(dialog != nullptr);
  QString texts;
  for (const QLabel* label : dialog->findChildren<QLabel*>())
    texts += label->text() + QChar('\n');
  QVERIFY2(texts.contains(QStringLiteral("never saved")), qPrintable(texts));
  QVERIFY2(texts.contains(QStringLiteral("4 unsaved changes")), qPrintable(texts));
  clickIn(dialog, "restore1");
  QTRY_COMPARE_WITH_TIMEOUT(d.session().scene().parts().size(), std::size_t{2}, 30'000);
  QCOMPARE(poses(d.session().scene()), place.expected());
  QVERIFY(d.session().file().empty());
  QVERIFY(d.window().isWindowModified());
  // It is this process's now, and the old journal is gone once the new one is there.
  const std::vector<fs::path> own{place.state / (textOf(thisProcess()) + ".nearfit")};
  QTRY_VERIFY_WITH_TIMEOUT(filesIn(place.state) == own, 30'000);
}

void DesktopRecoveryTest::poseInHandOfAKilledProcessComesBackAndTheFileIsKnown() {
  DoomedPlace place;
  place.lose("held");
  QVERIFY(!QTest::currentTestFailed());
  DesktopDriver d;
  d.window().protectWork(place.state);
  ui::RecoveryDialog* dialog = dialogOf(d);
  QVERIFY(dialog != nullptr);
  clickIn(dialog, "restore1");
  QTRY_COMPARE_WITH_TIMEOUT(d.session().scene().parts().size(), std::size_t{2}, 30'000);
  QCOMPARE(poses(d.session().scene()), place.expected());
  QCOMPARE(d.session().file(), place.folder.path() / "held.nearfit");
  QVERIFY(d.window().isWindowModified());
  QVERIFY(d.window().windowTitle().contains(QStringLiteral("held.nearfit")));
}

void DesktopRecoveryTest::theProgramItselfIsKilledAndItsSceneComesBack() {
  DoomedPlace place;
  Scene scene;
  Part part;
  part.geometry = loadPartGeometry(place.folder.path() / "fixed.off", 1e-3);
  part.name = "odd";
  part.worldFromPart = {glm::normalize(glm::dquat(0.1, 0.2, 0.3, 0.4)), {0.1 + 0.2, 1e-300, -1.0 / 3.0}};
  scene.add(part);
  const fs::path file = place.folder.path() / "odd.nearfit";
  writeSceneFile(scene, file);
  const auto before = poses(readSceneFile(file));

  QProcess program;
  QProcessEnvironment environment = QProcessEnvironment::systemEnvironment();
  const QString home = QString::fromStdString(place.folder.path().string());
  environment.insert(QStringLiteral("XDG_STATE_HOME"), home);
  environment.insert(QStringLiteral("XDG_CONFIG_HOME"), home);
  program.setProcessEnvironment(environment);
  program.start(QString::fromStdString(test::builtPath("nearfit")),
                {QString::fromStdString(file.string()), home + QStringLiteral("/moving.off"),
                 QStringLiteral("--unit"), QStringLiteral("mm")});
  const fs::path state = place.folder.path() / "nearfit" / "recovery";
  QTRY_VERIFY_WITH_TIMEOUT(journalIn(state).has_value(), 60'000);
  program.kill();
  QVERIFY(program.waitForFinished());
  QCOMPARE(program.exitStatus(), QProcess::CrashExit);

  DesktopDriver d;
  d.window().protectWork(state);
  ui::RecoveryDialog* dialog = dialogOf(d);
  QVERIFY(dialog != nullptr);
  clickIn(dialog, "restore1");
  QTRY_COMPARE_WITH_TIMEOUT(d.session().scene().parts().size(), std::size_t{2}, 30'000);
  const std::string after = poses(d.session().scene());
  QVERIFY(after.starts_with(before));
  QCOMPARE(d.session().file(), file);
}

void DesktopRecoveryTest::whatEndsOnlyAfterTheStartIsOfferedToo() {
  DoomedPlace place;
  place.lose("edits");
  QVERIFY(!QTest::currentTestFailed());
  // It is another's, who runs for now.
  QProcess other;
  other.start(QStringLiteral("sleep"), {QStringLiteral("1000")});
  QVERIFY(other.waitForStarted());
  const ProcessIdentity owner = identityOf(static_cast<::pid_t>(other.processId()));
  QVERIFY(isRunning(owner));
  fs::rename(filesIn(place.state).front(), place.state / (textOf(owner) + ".nearfit"));
  DesktopDriver d;
  d.window().protectWork(place.state);
  auto* recovery = d.window().findChild<ui::Recovery*>();
  QSignalSpy looked(recovery, &ui::Recovery::looked);
  QTRY_COMPARE(looked.count(), 1);
  QVERIFY(d.window().findChild<ui::RecoveryDialog*>() == nullptr);
  other.kill();
  QVERIFY(other.waitForFinished());
  ui::RecoveryDialog* dialog = dialogOf(d);
  QVERIFY(dialog != nullptr);
  clickIn(dialog, "restore1");
  QTRY_COMPARE_WITH_TIMEOUT(d.session().scene().parts().size(), std::size_t{2}, 30'000);
  QCOMPARE(poses(d.session().scene()), place.expected());
}

void DesktopRecoveryTest::laterOffersAgainAndDiscardDoesNot() {
  DoomedPlace place;
  place.lose("edits");
  QVERIFY(!QTest::currentTestFailed());
  // As another process would have it that ends before the last one looks.
  {
    RecoveryFolder folder(place.state, {"00000000", 1, 1});
    QCOMPARE(folder.takeLost().lost.size(), std::size_t{1});
  }
  DesktopDriver d;
  d.window().protectWork(place.state);
  ui::RecoveryDialog* dialog = dialogOf(d);
  QVERIFY(dialog != nullptr);
  const QPointer<QDialog> closed(dialog);
  const auto labels = dialog->findChildren<QLabel*>();
  QVERIFY(std::ranges::any_of(labels, [](const QLabel* label) {
    return label->text().contains(QStringLiteral("Items left for later are offered at next start."));
  }));
  clickIn(dialog, "later1");
  QTRY_VERIFY_WITH_TIMEOUT(closed.isNull(), 30'000);
  QCOMPARE(filesIn(place.state).size(), std::size_t{1});
  {
    RecoveryFolder folder(place.state, {"00000000", 1, 1});
    fs::rename(filesIn(place.state).front(), place.state / "00000000-1-2.nearfit");
  }
  DesktopDriver again;
  again.window().protectWork(place.state);
  dialog = dialogOf(again);
  QVERIFY(dialog != nullptr);
  clickIn(dialog, "discard1");
  QTRY_COMPARE_WITH_TIMEOUT(filesIn(place.state).size(), std::size_t{0}, 30'000);
  QVERIFY(again.session().scene().parts().empty());
}

void DesktopRecoveryTest::damagedJournalIsTold() {
  TemporaryFolder folder;
  folder.write("00000000-1-2.nearfit", "{\"nearfit\": ");
  DesktopDriver d;
  QStringList told;
  d.window().setFailureSink([&](const ui::Failure& failure) { told << failure.summary + failure.details; });
  d.window().protectWork(folder.path());
  QTRY_COMPARE_WITH_TIMEOUT(told.size(), 1, 30'000);
  QVERIFY2(told.first().contains(QStringLiteral("damaged")), qPrintable(told.first()));
  QCOMPARE(filesIn(folder.path(), ".damaged").size(), std::size_t{1});
}

void DesktopRecoveryTest::savingOrUndoingLeavesNothingToRecover() {
  DesktopDriver d;
  const fs::path state = d.folder.path() / "state";
  d.window().protectWork(state);
  d.addCubes();
  QTRY_COMPARE_WITH_TIMEOUT(filesIn(state).size(), std::size_t{1}, 30'000);
  d.session().save(d.folder.path() / "pair.nearfit");
  QTRY_COMPARE_WITH_TIMEOUT(filesIn(state).size(), std::size_t{0}, 30'000);
  d.session().setVisible(d.partId("fixed"), false);
  QTRY_COMPARE_WITH_TIMEOUT(filesIn(state).size(), std::size_t{1}, 30'000);
  pressShortcut(d, Qt::Key_Z, Qt::ControlModifier);
  QTRY_COMPARE_WITH_TIMEOUT(filesIn(state).size(), std::size_t{0}, 30'000);
}

void DesktopRecoveryTest::nothingIsWrittenWhileNothingChanges() {
  DesktopDriver d;
  d.window().protectWork(d.folder.path() / "state");
  auto* autosave = d.window().findChild<ui::Autosave*>();
  QSignalSpy written(autosave, &ui::Autosave::written);
  d.addCubes();
  QTRY_COMPARE_WITH_TIMEOUT(written.count(), 1, 30'000);
  d.startWith(ui::Hand::Manual);
  bool isFelt = false;
  connect(&d.application.servo(), &desktop::ServoController::snapshotArrived, this, [&] { isFelt = true; });
  QTRY_VERIFY_WITH_TIMEOUT(isFelt, 30'000);
  // Time for writes that must not be; a slow machine has fewer, never more.
  QTest::qWait(ui::Autosave::kMotionInterval + ui::Autosave::kDelay);
  QCOMPARE(written.count(), 1);
}

void DesktopRecoveryTest::folderThatCannotBeWrittenGivesOneQuietNote() {
  DesktopDriver d;
  d.window().protectWork(d.folder.write("file", "in the way") / "recovery");
  auto* autosave = d.window().findChild<ui::Autosave*>();
  QSignalSpy failed(autosave, &ui::Autosave::failed);
  d.addCubes();
  QTRY_COMPARE_WITH_TIMEOUT(failed.count(), 1, 30'000);
  QTRY_VERIFY_WITH_TIMEOUT(
      d.window().statusBar()->currentMessage().contains(QStringLiteral("cannot be protected")), 30'000);
  autosave->writeNow();
  QTRY_VERIFY_WITH_TIMEOUT(!autosave->isWriting(), 30'000);
  QCOMPARE(failed.count(), 1);
  QVERIFY(QApplication::activeModalWidget() == nullptr);
}

NEARFIT_QT_SUITE(DesktopRecoveryTest, [](int argc, char** argv) {
  if (argc == 4 && QLatin1String(argv[1]) == QLatin1String("--die")) return die(argc, argv);
  return runDesktopTest<DesktopRecoveryTest>(argc, argv);
})
#include "desktop_recovery_test.moc"
