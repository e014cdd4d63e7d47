#include <QClipboard>
#include <QElapsedTimer>
#include <QMenu>
#include <QStatusBar>
#include <QTableWidget>
#include <QToolButton>
#include <algorithm>

#include "tests/app/desktop/file_drop.h"
#include "tests/support/mesh_files.h"
#include "ui/files/recent_files.h"
#include "ui/model/parts_model.h"

using namespace nearfit;
using namespace nearfit::test;

namespace fs = std::filesystem;

namespace {

/// Opens File > Open recent.
QMenu& openRecent(DesktopDriver& d) {
  const QList<QMenu*> menus = d.window().findChildren<QMenu*>();
  QMenu* recent = *std::find_if(menus.begin(), menus.end(), [](const QMenu* menu) {
    return menu->title().contains(QStringLiteral("recent"));
  });
  openMenus(d.window(), menusTo(d.window().menuBar()->actions(), recent->menuAction()) + QList{recent});
  return *recent;
}

/// Answers the question for the unit, and counts how often it was asked.
void answerUnits(const char* unit, int& asked) {
  whenModal<QDialog>(
      [unit, &asked](QDialog* dialog) {
        ++asked;
        answerUnit(dialog, unit);
      },
      QStringLiteral("unitDialog"));
}

QPushButton* choice(DesktopDriver& d, const char* notice, const char* button) {
  auto* row = d.widget<QWidget>(notice);
  return row != nullptr && row->isVisible() ? row->findChild<QPushButton*>(QLatin1String(button)) : nullptr;
}

/// What the notice of changed files says; empty while there is none.
QString reloadText(DesktopDriver& d) {
  if (choice(d, "notice-reload", "choice1") == nullptr) return {};
  return d.widget<QWidget>("notice-reload")->findChild<QLabel*>(QStringLiteral("noticeText"))->text();
}

/// As programs save that care: beside it, then in its place.
void replaceByCube(const QString& file, double edge) {
  const fs::path target = file.toStdString();
  const fs::path beside = target.parent_path() / "being-written.tmp";
  writeOff(beside, boxMesh(glm::dvec3(edge)));
  fs::rename(beside, target);
}

}  // namespace

class DesktopPartFilesTest : public QObject {
  Q_OBJECT

 private slots:
  void init() { QSettings().clear(); }
  void recentScenesAreInTheMenuAndOpen();
  void missingRecentSceneIsToldAndLeavesTheList();
  void droppedFolderIsTakenApartAndTheUnitAskedOnce();
  void folderWithoutPartsIsToldQuietly();
  void fiftyBadFilesGiveOneBoxWithDetailsToCopy();
  void notesOnManyMeshesAreKeptInTheListOfParts();
  void aMeshThatWasMendedIsNotCalledOpen();
  void replacedFileIsOfferedAndReloadedInItsPlace();
  void aSecondChangedFileJoinsTheFirstInTheNotice();
  void whatWasWavedAwayIsNotNamedAgain();
  void reloadAlwaysFollowsTheFile();
  void rewrittenSameContentIsNotOffered();
  void partOfTheWrongUnitIsCalledOutAndRescaled();
  void aPartThatIsTooLargeIsCalledOutToo();
  void aFactorOfAMillionIsWrittenOut();
  void cancelOfAMillionTrianglesAnswersBeforeTheImporterDoes();
};

void DesktopPartFilesTest::recentScenesAreInTheMenuAndOpen() {
  DesktopDriver d;
  d.addCubes();
  const fs::path file = d.folder.path() / "a & b.nearfit";
  d.session().save(file);
  d.session().reset();
  d.window().document().openScene(nameOf(file));
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{2});
  pressShortcut(d, Qt::Key_N, Qt::ControlModifier);
  QVERIFY(d.session().scene().parts().empty());
  QMenu& menu = openRecent(d);
  QCOMPARE(menu.actions().first()->text(), QStringLiteral("&1  a && b.nearfit"));
  clickEntry(menu, menu.actions().first());
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{2});
}

void DesktopPartFilesTest::missingRecentSceneIsToldAndLeavesTheList() {
  DesktopDriver d;
  ui::RecentFiles::remember(nameOf(d.folder.path() / "gone.nearfit"));
  QStringList told;
  d.window().setFailureSink([&](const ui::Failure& failure) { told << failure.details; });
  QMenu& menu = openRecent(d);
  QVERIFY(menu.actions().first()->text().contains(QStringLiteral("(missing)")));
  clickEntry(menu, menu.actions().first());
  QCOMPARE(told.size(), 1);
  QVERIFY(told.first().contains(QStringLiteral("gone.nearfit")));
  QVERIFY(ui::RecentFiles::list().isEmpty());
}

void DesktopPartFilesTest::droppedFolderIsTakenApartAndTheUnitAskedOnce() {
  DesktopDriver d;
  const fs::path folder = d.folder.path() / "parts";
  fs::create_directories(folder / "inner");
  writeOff(folder / "a.off", boxMesh(glm::dvec3(0.01)));
  writeOff(folder / "inner" / "b.off", boxMesh(glm::dvec3(0.02)));
  std::ofstream(folder / "notes.txt") << "no mesh";
  int asked = 0;
  answerUnits("cm", asked);
  drop(d.window(), {nameOf(folder), d.fixedFile});
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{3});
  QCOMPARE(asked, 1);
  for (const Scene::PartPtr& part : d.session().scene().parts())
    QCOMPARE(part->geometry->metresPerUnit, 0.01);
}

void DesktopPartFilesTest::folderWithoutPartsIsToldQuietly() {
  DesktopDriver d;
  const fs::path folder = d.folder.path() / "empty";
  fs::create_directories(folder);
  drop(d.window(), {nameOf(folder)});
  QTRY_VERIFY(d.window().statusBar()->currentMessage().contains(QStringLiteral("Nothing to open")));
}

void DesktopPartFilesTest::fiftyBadFilesGiveOneBoxWithDetailsToCopy() {
  DesktopDriver d;
  QStringList files{d.fixedFile};
  for (int i = 0; i < 50; ++i)
    files << nameOf(d.folder.write("bad" + std::to_string(i) + ".off", "OFF\nnonsense\n"));
  QApplication::clipboard()->clear();
  d.add(files);
  QTRY_VERIFY(d.widget<QDialog>("errorBox") != nullptr);
  auto* box = d.widget<QDialog>("errorBox");
  QTRY_VERIFY(box->isVisible());
  QCOMPARE(d.window().findChildren<QDialog*>(QStringLiteral("errorBox")).size(), 1);
  QCOMPARE(box->findChild<QLabel*>(QStringLiteral("errorSummary"))->text(),
           QStringLiteral("50 of 51 files could not be loaded. The others were added."));
  QVERIFY(box->height() < 700);
  const auto* table = box->findChild<QTableWidget*>(QStringLiteral("errorTable"));
  QCOMPARE(table->rowCount(), 50);
  QTRY_VERIFY2(table->rowAt(table->viewport()->height() - 1) >= 4, "some lines are seen at a glance");
  for (int i = 0; i < 50; ++i) {
    QCOMPARE(table->item(i, 0)->text(), QStringLiteral("bad%1.off").arg(i));
    QVERIFY(!table->item(i, 1)->text().isEmpty() && !table->item(i, 2)->text().isEmpty());
    for (int column = 0; column < table->columnCount(); ++column) {
      const QRect room(0, 0, table->columnWidth(column), 10'000);
      const QRect needed =
          table->fontMetrics().boundingRect(room, Qt::TextWordWrap, table->item(i, column)->text());
      QVERIFY2(table->rowHeight(i) >= needed.height(), "no line is cut off");
    }
  }
  keepPictures(*box, QStringLiteral("fifty-bad-files"));
  QTest::mouseClick(box->findChild<QPushButton*>(QStringLiteral("copyDetails")), Qt::LeftButton);
  QVERIFY(box->isVisible());
  QTest::keyClick(box, Qt::Key_Return);
  QTRY_VERIFY(d.widget<QDialog>("errorBox") == nullptr);
  QCOMPARE(d.session().scene().parts().size(), std::size_t{1});
  const QStringList copied = QApplication::clipboard()->text().split('\n');
  for (const char* name : {"bad0.off", "bad49.off"})
    QCOMPARE(copied.filter(QLatin1String(name)).size(), 1);
}

void DesktopPartFilesTest::notesOnManyMeshesAreKeptInTheListOfParts() {
  DesktopDriver d;
  QStringList files;
  for (int i = 0; i < 3; ++i) {
    TriangleMesh box = boxMesh(glm::dvec3(0.02));
    std::vector<Triangle> open(box.triangles().begin(), box.triangles().end() - 1);
    files << writeOff(d.folder.path() / ("open" + std::to_string(i) + ".off"),
                      TriangleMesh({box.vertices().begin(), box.vertices().end()}, open));
  }
  d.add(files);
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{3});
  QVERIFY2(d.window().statusBar()->currentMessage().contains(QStringLiteral("3 meshes")),
           qPrintable(d.window().statusBar()->currentMessage()));
  const QAbstractItemModel* parts = d.partsView()->model();
  for (int row = 0; row < 3; ++row) {
    const QString tip = parts->index(row, ui::PartsModel::Name).data(Qt::ToolTipRole).toString();
    const std::string note =
        d.session().scene().parts()[static_cast<std::size_t>(row)]->geometry->report.warnings.at(0);
    QVERIFY2(tip.contains(QString::fromStdString(note)), qPrintable(tip));
  }
}

/// A nut without a finding was.
void DesktopPartFilesTest::aMeshThatWasMendedIsNotCalledOpen() {
  DesktopDriver d;
  const TriangleMesh box = boxMesh(glm::dvec3(0.02));
  const fs::path file = d.folder.path() / "box.off";
  {
    std::ofstream out(file);
    out << "OFF\n" << box.vertices().size() << ' ' << box.triangles().size() + 2 << " 0\n";
    for (const glm::dvec3& p : box.vertices())
      out << p.x * 1e3 << ' ' << p.y * 1e3 << ' ' << p.z * 1e3 << '\n';
    for (const Triangle& t : box.triangles())
      out << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
    const Triangle& twice = box.triangles()[0];
    out << "3 " << twice[0] << ' ' << twice[1] << ' ' << twice[2] << "\n3 0 0 1\n";
  }
  d.add({nameOf(file)});
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{1});
  QCOMPARE(d.session().scene().parts()[0]->geometry->report.warnings.size(), std::size_t{2});
  QVERIFY2(d.window().statusBar()->currentMessage().startsWith(QStringLiteral("Mended on loading")),
           qPrintable(d.window().statusBar()->currentMessage()));
}

void DesktopPartFilesTest::replacedFileIsOfferedAndReloadedInItsPlace() {
  DesktopDriver d;
  d.addCubes();
  const RigidTransform pose{{0.5, 0.5, 0.5, 0.5}, {0.1, 0.2, 0.3}};
  d.session().movePart(d.partId("fixed"), pose);
  replaceByCube(d.fixedFile, 0.05);
  QTRY_VERIFY_WITH_TIMEOUT(choice(d, "notice-reload", "choice1") != nullptr, 20'000);
  QCOMPARE(widthOf(d.part("fixed")), 0.04);
  QTest::mouseClick(choice(d, "notice-reload", "choice1"), Qt::LeftButton);
  QTRY_VERIFY(qFuzzyCompare(widthOf(d.part("fixed")), 0.05));
  QCOMPARE(d.part("fixed").worldFromPart.translation, pose.translation);
  QCOMPARE(d.part("fixed").worldFromPart.rotation, pose.rotation);
  QCOMPARE(widthOf(d.part("moving")), 0.02);
  QVERIFY(choice(d, "notice-reload", "choice1") == nullptr);
  QCOMPARE(d.action("undo")->text(), QStringLiteral("&Undo Reload fixed"));
  pressShortcut(d, Qt::Key_Z, Qt::ControlModifier);
  QCOMPARE(widthOf(d.part("fixed")), 0.04);
  // It goes on being watched although it is another file now.
  replaceByCube(d.fixedFile, 0.06);
  QTRY_VERIFY_WITH_TIMEOUT(choice(d, "notice-reload", "choice1") != nullptr, 20'000);
}

// The notice of the second took the place of the first's, which was then never read.
void DesktopPartFilesTest::aSecondChangedFileJoinsTheFirstInTheNotice() {
  DesktopDriver d;
  d.addCubes();
  replaceByCube(d.fixedFile, 0.05);
  QTRY_COMPARE_WITH_TIMEOUT(reloadText(d), QStringLiteral("fixed.off has changed on disk since it was read."),
                            20'000);
  replaceByCube(d.movingFile, 0.03);
  QTRY_COMPARE_WITH_TIMEOUT(
      reloadText(d), QStringLiteral("fixed.off and moving.off have changed on disk since they were read."),
      20'000);
  QTest::mouseClick(choice(d, "notice-reload", "choice1"), Qt::LeftButton);
  QTRY_VERIFY(qFuzzyCompare(widthOf(d.part("fixed")), 0.05));
  QVERIFY(qFuzzyCompare(widthOf(d.part("moving")), 0.03));
  QVERIFY(choice(d, "notice-reload", "choice1") == nullptr);
}

void DesktopPartFilesTest::whatWasWavedAwayIsNotNamedAgain() {
  DesktopDriver d;
  d.addCubes();
  replaceByCube(d.fixedFile, 0.05);
  QTRY_VERIFY_WITH_TIMEOUT(choice(d, "notice-reload", "choice1") != nullptr, 20'000);
  QTest::mouseClick(d.widget<QWidget>("notice-reload")->findChild<QToolButton*>(QStringLiteral("dismiss")),
                    Qt::LeftButton);
  QVERIFY(choice(d, "notice-reload", "choice1") == nullptr);
  replaceByCube(d.movingFile, 0.03);
  QTRY_COMPARE_WITH_TIMEOUT(reloadText(d),
                            QStringLiteral("moving.off has changed on disk since it was read."), 20'000);
}

void DesktopPartFilesTest::reloadAlwaysFollowsTheFile() {
  DesktopDriver d;
  d.addCubes();
  replaceByCube(d.fixedFile, 0.05);
  QTRY_VERIFY_WITH_TIMEOUT(choice(d, "notice-reload", "choice2") != nullptr, 20'000);
  QTest::mouseClick(choice(d, "notice-reload", "choice2"), Qt::LeftButton);
  QTRY_VERIFY(qFuzzyCompare(widthOf(d.part("fixed")), 0.05));
  QVERIFY(d.action("reloadAlways")->isChecked());
  // Written in place this time.
  writeOff(d.fixedFile.toStdString(), boxMesh(glm::dvec3(0.065)));
  QTRY_COMPARE_WITH_TIMEOUT(widthOf(d.part("fixed")), 0.065, 20'000);
}

void DesktopPartFilesTest::rewrittenSameContentIsNotOffered() {
  DesktopDriver d;
  d.addCubes();
  replaceByCube(d.fixedFile, 0.04);
  replaceByCube(d.movingFile, 0.05);
  QTRY_VERIFY_WITH_TIMEOUT(choice(d, "notice-reload", "choice1") != nullptr, 20'000);
  const QString text = reloadText(d);
  QVERIFY2(text.contains(QStringLiteral("moving.off")) && !text.contains(QStringLiteral("fixed.off")),
           qPrintable(text));
}

void DesktopPartFilesTest::partOfTheWrongUnitIsCalledOutAndRescaled() {
  DesktopDriver d;
  d.addCubes();
  const QString tiny = writeOff(d.folder.path() / "tiny.off", boxMesh(glm::dvec3(0.00003)));
  d.add({tiny});
  QTRY_VERIFY(choice(d, "notice-rescale", "choice1") != nullptr);
  QCOMPARE(choice(d, "notice-rescale", "choice1")->text().remove(QChar(',')),
           QStringLiteral("Make 1000 times larger"));
  QTest::mouseClick(choice(d, "notice-rescale", "choice1"), Qt::LeftButton);
  QTRY_VERIFY(qFuzzyCompare(widthOf(d.part("tiny")), 0.03));
  QVERIFY(choice(d, "notice-rescale", "choice1") == nullptr);
  pressShortcut(d, Qt::Key_Z, Qt::ControlModifier);
  QCOMPARE(widthOf(d.part("tiny")), 0.00003);
}

/// The button said "Make 1e+06 times smaller".
void DesktopPartFilesTest::aFactorOfAMillionIsWrittenOut() {
  DesktopDriver d;
  d.addCubes();
  d.window().document().addParts({writeOff(d.folder.path() / "vast.off", boxMesh(glm::dvec3(30'000.0)))},
                                 1.0);
  QTRY_VERIFY(choice(d, "notice-rescale", "choice1") != nullptr);
  QStringList offers;
  for (const char* name : {"choice1", "choice2", "choice3"})
    if (const auto* button = choice(d, "notice-rescale", name)) offers << button->text().remove(QChar(','));
  QVERIFY2(offers.contains(QStringLiteral("Make 1000000 times smaller")),
           qPrintable(offers.join(QChar(';'))));
  for (const QString& offer : offers)
    QVERIFY2(!offer.contains(QStringLiteral("e+")), qPrintable(offer));
}

void DesktopPartFilesTest::aPartThatIsTooLargeIsCalledOutToo() {
  DesktopDriver d;
  d.addCubes();
  d.add({writeOff(d.folder.path() / "huge.off", boxMesh(glm::dvec3(30.0)))});
  QTRY_VERIFY(choice(d, "notice-rescale", "choice1") != nullptr);
  const auto* text = d.widget<QWidget>("notice-rescale")->findChild<QLabel*>(QStringLiteral("noticeText"));
  QVERIFY2(text->text().contains(QStringLiteral("about")) &&
               text->text().contains(QStringLiteral("times larger than the other parts")),
           qPrintable(text->text()));
  QCOMPARE(choice(d, "notice-rescale", "choice1")->text().remove(QChar(',')),
           QStringLiteral("Make 1000 times smaller"));
  QTest::mouseClick(choice(d, "notice-rescale", "choice1"), Qt::LeftButton);
  QTRY_VERIFY(qFuzzyCompare(widthOf(d.part("huge")), 0.03));
  QVERIFY(choice(d, "notice-rescale", "choice1") == nullptr);
}

void DesktopPartFilesTest::cancelOfAMillionTrianglesAnswersBeforeTheImporterDoes() {
  DesktopDriver d;
  const fs::path file = d.folder.write("million.stl", stlBinary(uvSphereMesh(0.05, 1000, 501)));
  QElapsedTimer sinceClick;
  qint64 answeredAfter = -1;
  whenModal<QDialog>(
      [&](QDialog* dialog) {
        sinceClick.start();
        QTest::mouseClick(dialog->findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Cancel),
                          Qt::LeftButton);
      },
      QStringLiteral("progressDialog"));
  QStringList shown;
  const auto watch = connect(d.window().statusBar(), &QStatusBar::messageChanged, this,
                             [&](const QString& text) { shown << text; });
  connect(&d.window().document(), &ui::Document::loaded, this,
          [&](bool isComplete) { answeredAfter = isComplete ? -2 : sinceClick.elapsed(); });
  d.add({nameOf(file)});
  QVERIFY(d.window().document().isBusy());
  QTRY_VERIFY_WITH_TIMEOUT(answeredAfter != -1, 60'000);
  QVERIFY2(answeredAfter >= 0, "it was loaded although it was cancelled");
  qInfo("answered after %lld ms", static_cast<long long>(answeredAfter));
  QVERIFY(!d.window().document().isBusy());
  QVERIFY(d.window().findChild<QDialog*>(QStringLiteral("progressDialog")) == nullptr);
  // Nothing told that it had ended.
  disconnect(watch);
  QVERIFY2(shown.contains(QStringLiteral("Loading of million.stl cancelled. Nothing was added.")),
           qPrintable(shown.join('\n')));
  // The next file need not wait for the importer to notice.
  d.add({d.fixedFile});
  QTRY_COMPARE_WITH_TIMEOUT(d.session().scene().parts().size(), std::size_t{1}, 60'000);
}

NEARFIT_QT_SUITE(DesktopPartFilesTest, runDesktopTest<DesktopPartFilesTest>)
#include "desktop_part_files_test.moc"
