#include <QDoubleSpinBox>
#include <QMenu>
#include <QMessageBox>
#include <QWindow>
#include <algorithm>

#include <nlohmann/json.hpp>

#include "core/scene/scene_file.h"
#include "tests/app/desktop/file_drop.h"
#include "tests/support/file_size_limit.h"
#include "ui/files/recent_files.h"
#include "ui/model/parts_model.h"

using namespace nearfit;
using namespace nearfit::test;

namespace fs = std::filesystem;

namespace {

/// While it lives, answers the question about unsaved changes, and counts how often it was asked.
class Answers {
 public:
  explicit Answers(QMessageBox::StandardButton answer) {
    timer_.setInterval(20);
    QObject::connect(&timer_, &QTimer::timeout, &timer_, [this, answer] {
      auto* box = qobject_cast<QMessageBox*>(QApplication::activeModalWidget());
      if (box == nullptr || !box->isVisible() || box->objectName() != QStringLiteral("unsavedBox")) return;
      ++asked;
      QTest::mouseClick(box->button(answer), Qt::LeftButton);
    });
    timer_.start();
  }

  int asked = 0;

 private:
  QTimer timer_;
};

/// The cubes saved as a scene in a folder of their own, of which the first was then moved by 2.5 mm in x; and
/// another scene, of one part.
struct Work {
  Work() {
    fs::create_directory(place);
    d.addCubes();
    d.session().save(file);
    saved = readBytes(file);
    Scene scene;
    Part part;
    part.name = "alone";
    part.geometry = d.part("moving").geometry;
    scene.add(part);
    writeSceneFile(scene, other);
    change();
  }
  void change() {
    d.clickPart(0, ui::PartsModel::Name);
    d.type<QDoubleSpinBox>("positionX", "2.5");
    QVERIFY(d.window().isWindowModified());
  }
  /// Where the first cube stands in x, by a scene's file [m].
  static double savedX(const fs::path& file) {
    return nlohmann::json::parse(readBytes(file)).at("parts").at(0).at("position").at(0).get<double>();
  }
  /// The scene stands open as it was changed, marked so, and its file is as it was.
  void verifyAllIsKept(const fs::path& in) {
    QVERIFY(!d.window().document().isBusy());
    QVERIFY(d.window().isVisible());
    QVERIFY(d.window().isWindowModified());
    QVERIFY(d.session().canUndo());
    QCOMPARE(d.session().scene().parts().size(), std::size_t{2});
    QCOMPARE(d.part("fixed").worldFromPart.translation.x, 0.0025);
    QCOMPARE(d.session().file(), file);
    QVERIFY(d.window().windowTitle().contains(QStringLiteral("mine.nearfit[*]")));
    QVERIFY2(readBytes(in) == saved, "byte for byte");
    QVERIFY(d.widget<QDialog>("errorBox") == nullptr);
  }
  void verifyAllIsKept() { verifyAllIsKept(file); }
  /// What the message says of a failure to write that file, which is then put away.
  void readMessage(const fs::path& target, const QString& why) {
    QTRY_VERIFY(d.widget<QDialog>("errorBox") != nullptr);
    QTRY_VERIFY(d.widget<QDialog>("errorBox")->isVisible());
    QCOMPARE(d.text("errorSummary"), QStringLiteral("The scene could not be saved."));
    const QString details = d.text("errorDetails");
    QVERIFY2(details.contains(QStringLiteral("Where: ") + nameOf(target)), qPrintable(details));
    QVERIFY2(details.contains(why), qPrintable(details));
    const auto* buttons = d.widget<QDialog>("errorBox")->findChild<QDialogButtonBox*>();
    QTest::mouseClick(buttons->button(QDialogButtonBox::Ok), Qt::LeftButton);
    QTRY_VERIFY(d.widget<QDialog>("errorBox") == nullptr);
  }
  /// The folder goes elsewhere, with all that is in it, and a file comes in its place.
  void replaceFolderByFile() {
    fs::rename(place, away);
    d.folder.write("place", "no folder");
  }
  void pressSave() { pressShortcut(d, Qt::Key_S, Qt::ControlModifier); }
  void saveAs(const fs::path& target) {
    whenModal<QFileDialog>([&](QFileDialog* dialog) { chooseFile(dialog, nameOf(target)); });
    d.choose("saveAs");
  }

  DesktopDriver d;
  const fs::path place = d.folder.path() / "place", away = d.folder.path() / "away";
  const fs::path file = place / "mine.nearfit", other = d.folder.path() / "other.nearfit";
  std::string saved;  ///< What is in the file.
};

const QString kNoFolder = QStringLiteral("Check that its folder exists.");

void openFromRecent(DesktopDriver& d, const fs::path& file) {
  ui::RecentFiles::remember(nameOf(file));
  const QList<QMenu*> menus = d.window().findChildren<QMenu*>();
  QMenu* recent = *std::ranges::find_if(
      menus, [](const QMenu* menu) { return menu->title().contains(QStringLiteral("recent")); });
  openMenus(d.window(), menusTo(d.window().menuBar()->actions(), recent->menuAction()) + QList{recent});
  clickEntry(*recent, recent->actions().first());
}

void addWays() {
  QTest::addColumn<QString>("way");
  for (const char* way : {"newScene", "openDemo", "open", "recent", "drop", "quit", "close"})
    QTest::newRow(way) << QString::fromLatin1(way);
}

/// Leaves the scene for another one, or the program.
void leave(Work& w, const QString& way) {
  if (way == QStringLiteral("open")) {
    whenModal<QFileDialog>([&](QFileDialog* dialog) { chooseFile(dialog, nameOf(w.other)); });
    pressShortcut(w.d, Qt::Key_O, Qt::ControlModifier);
  } else if (way == QStringLiteral("recent")) {
    openFromRecent(w.d, w.other);
  } else if (way == QStringLiteral("drop")) {
    drop(w.d.window(), {nameOf(w.other)});
  } else if (way == QStringLiteral("close")) {
    // As the window system tells that the cross in the title was clicked.
    QCloseEvent close;
    QApplication::sendEvent(w.d.window().windowHandle(), &close);
  } else {
    w.d.choose(w.d.action(qPrintable(way)));
  }
}

/// Starts a new scene and answers the question by an Alt key; false if the question stays open.
bool leaveByAltKey(Work& w, Qt::Key key) {
  bool isAnswered = false;
  whenModal<QMessageBox>(
      [&](QMessageBox* box) {
        QApplication::setActiveWindow(box);
        QTest::keyClick(box, key, Qt::AltModifier);
        isAnswered = QTest::qWaitFor([&] { return !box->isVisible(); }, kQtPatienceMs);
        if (!isAnswered) box->reject();
      },
      QStringLiteral("unsavedBox"));
  w.d.choose("newScene");
  return isAnswered;
}

void verifyIsLeft(Work& w, const QString& way) {
  if (way == QStringLiteral("quit") || way == QStringLiteral("close")) {
    QTRY_VERIFY(!w.d.window().isVisible());
    return;
  }
  const bool isNew = way == QStringLiteral("newScene"), isDemo = way == QStringLiteral("openDemo");
  QTRY_COMPARE(w.d.session().file(), isNew || isDemo ? fs::path() : w.other);
  QCOMPARE(w.d.session().scene().parts().size(), std::size_t(isNew ? 0 : isDemo ? 4 : 1));
  QVERIFY(!w.d.window().isWindowModified());
}

}  // namespace

class DesktopUnsavedTest : public QObject {
  Q_OBJECT

 private slots:
  void init() { QSettings().clear(); }
  void cancelLosesNothingWhicheverWayOneLeaves_data() { addWays(); }
  void cancelLosesNothingWhicheverWayOneLeaves();
  void discardLeavesAndTheFileStaysAsItWas_data() { addWays(); }
  void discardLeavesAndTheFileStaysAsItWas();
  void saveWritesTheChangeAndLeaves_data() { addWays(); }
  void saveWritesTheChangeAndLeaves();
  void altKeysAnswerTheQuestion();
  void sceneWithoutAFileAsksWhereToAndCancelKeepsIt();
  void sceneWithoutAFileIsSavedWhereItIsSaidBeforeTheProgramEnds();
  void saveThatFailsIsToldAndTheSceneStays_data() { addWays(); }
  void saveThatFailsIsToldAndTheSceneStays();
  void saveIntoAFolderThatIsGoneIsToldAndKeepsTheMark();
  void saveAsWhereNoFolderIsKeepsTheOldNameAndFile();
  void fullDiskLeavesTheOldFileAsItWas();
};

void DesktopUnsavedTest::cancelLosesNothingWhicheverWayOneLeaves() {
  QFETCH(QString, way);
  Work w;
  Answers cancel(QMessageBox::Cancel);
  leave(w, way);
  QTRY_COMPARE(cancel.asked, 1);
  QTRY_VERIFY(QApplication::activeModalWidget() == nullptr);
  w.verifyAllIsKept();
}

void DesktopUnsavedTest::discardLeavesAndTheFileStaysAsItWas() {
  QFETCH(QString, way);
  Work w;
  Answers discard(QMessageBox::Discard);
  leave(w, way);
  QTRY_COMPARE(discard.asked, 1);
  verifyIsLeft(w, way);
  QVERIFY(readBytes(w.file) == w.saved);
}

void DesktopUnsavedTest::saveWritesTheChangeAndLeaves() {
  QFETCH(QString, way);
  Work w;
  Answers save(QMessageBox::Save);
  leave(w, way);
  QTRY_COMPARE(save.asked, 1);
  verifyIsLeft(w, way);
  QCOMPARE(Work::savedX(w.file), 0.0025);
}

/// Qt's own texts of the three buttons have no keys.
void DesktopUnsavedTest::altKeysAnswerTheQuestion() {
  {
    Work w;
    QVERIFY(leaveByAltKey(w, Qt::Key_C));
    w.verifyAllIsKept();
    QVERIFY(leaveByAltKey(w, Qt::Key_D));
    verifyIsLeft(w, QStringLiteral("newScene"));
    QVERIFY(readBytes(w.file) == w.saved);
  }
  Work w;
  QVERIFY(leaveByAltKey(w, Qt::Key_S));
  verifyIsLeft(w, QStringLiteral("newScene"));
  QCOMPARE(Work::savedX(w.file), 0.0025);
}

void DesktopUnsavedTest::sceneWithoutAFileAsksWhereToAndCancelKeepsIt() {
  DesktopDriver d;
  d.addCubes();
  Answers save(QMessageBox::Save);
  int offered = 0;
  for (const char* command : {"newScene", "openDemo", "quit"}) {
    whenModal<QFileDialog>([&](QFileDialog* dialog) {
      ++offered;
      QTest::mouseClick(dialog->findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Cancel),
                        Qt::LeftButton);
    });
    d.choose(command);
    QCOMPARE(save.asked, offered);
    QVERIFY2(d.window().isVisible() && !d.window().document().isBusy(), command);
    QCOMPARE(d.session().scene().parts().size(), std::size_t{2});
    QVERIFY2(d.window().isWindowModified() && d.session().file().empty(), command);
  }
  QCOMPARE(offered, 3);
}

void DesktopUnsavedTest::sceneWithoutAFileIsSavedWhereItIsSaidBeforeTheProgramEnds() {
  DesktopDriver d;
  d.addCubes();
  const fs::path file = d.folder.path() / "named.nearfit";
  Answers save(QMessageBox::Save);
  whenModal<QFileDialog>([&](QFileDialog* dialog) { chooseFile(dialog, nameOf(file)); });
  d.choose("quit");
  QCOMPARE(save.asked, 1);
  QVERIFY(!d.window().isVisible());
  QCOMPARE(readSceneFile(file).parts().size(), std::size_t{2});
}

void DesktopUnsavedTest::saveThatFailsIsToldAndTheSceneStays() {
  QFETCH(QString, way);
  Work w;
  w.replaceFolderByFile();
  Answers save(QMessageBox::Save);
  leave(w, way);
  w.readMessage(w.file, kNoFolder);
  QCOMPARE(save.asked, 1);
  w.verifyAllIsKept(w.away / "mine.nearfit");
}

void DesktopUnsavedTest::saveIntoAFolderThatIsGoneIsToldAndKeepsTheMark() {
  Work w;
  w.replaceFolderByFile();
  w.pressSave();
  w.readMessage(w.file, kNoFolder);
  w.verifyAllIsKept(w.away / "mine.nearfit");
  fs::remove(w.place);
  w.pressSave();
  w.readMessage(w.file, kNoFolder);
  w.verifyAllIsKept(w.away / "mine.nearfit");
  QVERIFY(ui::RecentFiles::list().isEmpty());
  fs::rename(w.away, w.place);
  w.pressSave();
  QVERIFY(!w.d.window().isWindowModified());
  QCOMPARE(Work::savedX(w.file), 0.0025);
}

void DesktopUnsavedTest::saveAsWhereNoFolderIsKeepsTheOldNameAndFile() {
  Work w;
  const fs::path nowhere = w.d.folder.path() / "nowhere" / "new.nearfit";
  const fs::path underAFile = w.d.folder.write("file", "no folder") / "new.nearfit";
  for (const fs::path& target : {nowhere, underAFile}) {
    w.saveAs(target);
    w.readMessage(target, kNoFolder);
    w.verifyAllIsKept();
  }
  QVERIFY(ui::RecentFiles::list().isEmpty());
  const fs::path good = w.d.folder.path() / "new.nearfit";
  w.saveAs(good);
  QVERIFY(!w.d.window().isWindowModified());
  QVERIFY(w.d.window().windowTitle().contains(QStringLiteral("new.nearfit[*]")));
  QCOMPARE(Work::savedX(good), 0.0025);
  QVERIFY(readBytes(w.file) == w.saved);
}

void DesktopUnsavedTest::fullDiskLeavesTheOldFileAsItWas() {
  Work w;
  {
    const FileSizeLimit full(100);
    w.pressSave();
  }
  w.readMessage(w.file, QStringLiteral("Writing it failed"));
  w.verifyAllIsKept();
  const auto files = std::distance(fs::directory_iterator(w.place), fs::directory_iterator());
  QVERIFY2(files == 1, "nothing is left beside it");
  w.pressSave();
  QVERIFY(!w.d.window().isWindowModified());
  QCOMPARE(Work::savedX(w.file), 0.0025);
}

NEARFIT_QT_SUITE(DesktopUnsavedTest, runDesktopTest<DesktopUnsavedTest>)
#include "desktop_unsaved_test.moc"
