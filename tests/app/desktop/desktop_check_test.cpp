#include <QCheckBox>
#include <QDockWidget>
#include <QDoubleSpinBox>
#include <QHeaderView>
#include <QTableView>
#include <algorithm>
#include <filesystem>

#include "core/scene/part_geometry.h"
#include "tests/app/desktop/desktop_driver.h"
#include "ui/model/findings_model.h"
#include "ui/model/parts_model.h"
#include "ui/model/selection.h"

using namespace nearfit;
using namespace nearfit::test;
using ui::FindingsModel;

namespace {

/// The fixed cube of 40 mm, and one beside it without one of its twelve triangles.
struct CheckFixture {
  CheckFixture() {
    const TriangleMesh whole = boxMesh(glm::dvec3(0.04), glm::dvec3(0.1, 0.0, 0.0));
    const TriangleMesh open({whole.vertices().begin(), whole.vertices().end()},
                            {whole.triangles().begin(), whole.triangles().end() - 1});
    openFile = writeOff(d.folder.path() / "open.off", open);
    d.add({d.fixedFile, openFile});
    if (!QTest::qWaitFor([&] { return d.session().scene().parts().size() == 2; }, 30'000))
      throw Error("parts", "they are not added");
    table = d.widget<QTableView>("findingsTable");
  }
  void showPanel(const char* part) {
    d.window().selection().select(d.partId(part));
    d.choose("check");
  }
  /// Closes the open cube by a repair.
  void fillHole() {
    showPanel("open");
    QTRY_COMPARE(table->model()->rowCount(), 1);
    d.type<QDoubleSpinBox>("repairFillSize", "60 mm");
    QTest::mouseClick(d.widget<QPushButton>("repairPart"), Qt::LeftButton);
    QTRY_VERIFY(!isOpen("open"));
  }
  QString cell(int row, int column) const { return table->model()->index(row, column).data().toString(); }
  void clickRow(int row) {
    QTest::mouseClick(table->viewport(), Qt::LeftButton, {},
                      table->visualRect(table->model()->index(row, FindingsModel::Kind)).center());
  }
  /// The icon in the column of badges; null: none.
  QIcon badge(int row) const {
    const QVariant icon =
        d.partsView()->model()->index(row, ui::PartsModel::Findings).data(Qt::DecorationRole);
    return icon.value<QIcon>();
  }
  QString badgeText(int row) const {
    return d.partsView()->model()->index(row, ui::PartsModel::Findings).data(Qt::ToolTipRole).toString();
  }
  bool isOpen(const char* part) { return d.part(part).geometry->mesh.topology().openEdges > 0; }

  mutable DesktopDriver d;
  QString openFile;
  QTableView* table = nullptr;
};

}  // namespace

class DesktopCheckTest : public QObject {
  Q_OBJECT

 private slots:
  void aBadgeMarksThePartWithFindings();
  void aClickOnTheBadgeShowsItsFindings();
  void theTableSaysWhatIsWrongAndFollowsTheSelection();
  void theEffectOfAFindingIsWholeInTheTable();
  void aWideTableShowsCountsAndPlacesWhole();
  void aRowShowsThePlaceInTheView();
  void aRepairIsOneStepAndSaysWhatItChanged();
  void aRepairedPartIsSavedAndOpenedAsSuch();
  void aRepairedPartStaysSoWhenItsUnitChangesOrItsFileIsReloaded();
  void withoutRepairsOrForALockedPartThereIsNothingToPress();
  void aPartThatIsFeltIsNotRepaired();
  void whatCannotBeRepairedIsSaidWithTheReason();
};

void DesktopCheckTest::aBadgeMarksThePartWithFindings() {
  CheckFixture f;
  QTRY_VERIFY(!f.d.partsView()->isColumnHidden(ui::PartsModel::Findings));
  QVERIFY(f.badge(0).isNull());
  QVERIFY(!f.badge(1).isNull());
  QVERIFY2(f.badgeText(1).startsWith(QStringLiteral("Open edges: 1\n")), qPrintable(f.badgeText(1)));
  QVERIFY2(f.badgeText(1).endsWith(QStringLiteral("and to repair it")), qPrintable(f.badgeText(1)));
  // Without the part there is nothing to mark.
  f.d.session().deletePart(f.d.partId("open"));
  QTRY_VERIFY(f.d.partsView()->isColumnHidden(ui::PartsModel::Findings));
}

void DesktopCheckTest::aClickOnTheBadgeShowsItsFindings() {
  CheckFixture f;
  QTRY_VERIFY(!f.badge(1).isNull());
  const auto* dock = f.d.widget<QDockWidget>("checkDock");
  QVERIFY(!dock->isVisible());
  f.d.clickPart(1, ui::PartsModel::Findings);
  QTRY_VERIFY(dock->isVisible());
  QCOMPARE(f.d.window().selection().current(), std::optional(f.d.partId("open")));
  QTRY_COMPARE(f.table->model()->rowCount(), 1);
  keepPictures(f.d.window(), QStringLiteral("check"));
}

void DesktopCheckTest::theTableSaysWhatIsWrongAndFollowsTheSelection() {
  CheckFixture f;
  f.showPanel("open");
  QTRY_COMPARE(f.table->model()->rowCount(), 1);
  QCOMPARE(f.cell(0, FindingsModel::Kind), QStringLiteral("Open edges"));
  QCOMPARE(f.cell(0, FindingsModel::Count), QStringLiteral("3 edges"));
  // 40 mm, 40 mm and the diagonal.
  QCOMPARE(f.cell(0, FindingsModel::Size), QStringLiteral("137 mm"));
  f.d.choose("unit-in");
  QCOMPARE(f.cell(0, FindingsModel::Size), QStringLiteral("5.38 in"));
  f.d.choose("unit-mm");
  f.d.window().selection().select(f.d.partId("fixed"));
  QTRY_COMPARE(f.d.text("checkNote"), QStringLiteral("Nothing is wrong with its mesh."));
  QCOMPARE(f.table->model()->rowCount(), 0);
  f.d.window().selection().select({});
  QVERIFY(f.d.text("checkTitle").startsWith(QStringLiteral("Select a part")));
}

/// Both were cut in a panel of any width.
void DesktopCheckTest::aWideTableShowsCountsAndPlacesWhole() {
  CheckFixture f;
  f.showPanel("open");
  QTRY_COMPARE(f.table->model()->rowCount(), 1);
  f.d.window().resize(1900, 900);
  for (const int column : {FindingsModel::Kind, FindingsModel::Count, FindingsModel::Size,
                           FindingsModel::Place, FindingsModel::Effect}) {
    const QFontMetrics letters = f.table->fontMetrics();
    const QString header = f.table->model()->headerData(column, Qt::Horizontal).toString();
    const int needed =
        std::max(letters.horizontalAdvance(f.cell(0, column)), letters.horizontalAdvance(header));
    QTRY_VERIFY2(f.table->columnWidth(column) > needed, qPrintable(header));
  }
}

/// It was elided, beside a count with room to spare.
void DesktopCheckTest::theEffectOfAFindingIsWholeInTheTable() {
  CheckFixture f;
  f.showPanel("open");
  QTRY_COMPARE(f.table->model()->rowCount(), 1);
  const QString effect = f.cell(0, FindingsModel::Effect);
  const int needed = f.table->fontMetrics().horizontalAdvance(effect);
  QTRY_VERIFY2(f.table->columnWidth(FindingsModel::Effect) > needed, qPrintable(effect));
  QVERIFY(f.table->columnWidth(FindingsModel::Count) < f.table->columnWidth(FindingsModel::Effect));
  const auto tip = [&](int column) {
    return f.table->model()->index(0, column).data(Qt::ToolTipRole).toString();
  };
  QCOMPARE(tip(FindingsModel::Effect), effect);
  QCOMPARE(tip(FindingsModel::Count), QStringLiteral("3 edges"));
  QCOMPARE(tip(FindingsModel::Place), f.cell(0, FindingsModel::Place));
}

void DesktopCheckTest::aRowShowsThePlaceInTheView() {
  CheckFixture f;
  f.showPanel("open");
  QTRY_COMPARE(f.table->model()->rowCount(), 1);
  QVERIFY(f.d.text("checkNote").startsWith(QStringLiteral("Select a row")));
  f.clickRow(0);
  // The hole is at x = 120 mm: it is in the middle of the view now.
  const glm::dvec3 middle(0.12, 0.0, 0.0);
  const auto isInTheMiddle = [&] {
    const std::optional<glm::dvec2> seen = f.d.window().viewport().projection().pixelOf(middle);
    const QSize size = f.d.window().viewport().size();
    return seen && std::abs(seen->x / size.width() - 0.5) < 0.25 &&
           std::abs(seen->y / size.height() - 0.5) < 0.25;
  };
  QTRY_VERIFY(isInTheMiddle());
  const QImage with = f.d.picture();
  f.table->clearSelection();
  QVERIFY(differentPixels(f.d.picture(), with) > 100);
  f.clickRow(0);
  QVERIFY(differentPixels(f.d.picture(), with) < 100);
  // Another part is selected: nothing of this one is shown.
  f.d.window().selection().select(f.d.partId("fixed"));
  QVERIFY(differentPixels(f.d.picture(), with) > 100);
}

void DesktopCheckTest::aRepairIsOneStepAndSaysWhatItChanged() {
  CheckFixture f;
  f.showPanel("open");
  QTRY_COMPARE(f.table->model()->rowCount(), 1);
  QVERIFY(f.d.widget<QCheckBox>("repairFill")->isChecked());
  QVERIFY(!f.d.widget<QCheckBox>("repairWeld")->isChecked());
  // The hole is 57 mm large.
  QVERIFY(f.d.widget<QDoubleSpinBox>("repairFillSize")->value() > 56.6);
  QVERIFY(f.d.widget<QDoubleSpinBox>("repairFillSize")->value() < 60.0);
  f.d.type<QDoubleSpinBox>("repairFillSize", "60 mm");
  QTest::mouseClick(f.d.widget<QPushButton>("repairPart"), Qt::LeftButton);
  QTRY_VERIFY(!f.isOpen("open"));
  QCOMPARE(f.d.session().undoText(), std::string("Repair open"));
  const QString result = f.d.text("repairResult");
  QVERIFY2(result.contains(QStringLiteral("holes filled: 1 with 1 faces")), qPrintable(result));
  // A third of the smallest height of the triangle, 28.28 mm.
  QVERIFY2(result.contains(QStringLiteral("moved by at most 9.43 mm")), qPrintable(result));
  QVERIFY2(result.contains(QStringLiteral("encloses a volume now")), qPrintable(result));
  QTRY_COMPARE(f.d.text("checkNote"), QStringLiteral("Nothing is wrong with its mesh."));
  QTRY_VERIFY(f.badge(1).isNull());
  f.d.session().undo();
  QVERIFY(f.isOpen("open"));
  QVERIFY(!f.d.widget<QLabel>("repairResult")->isVisible());
  // Its check is still known.
  QCOMPARE(f.table->model()->rowCount(), 1);
  f.d.session().redo();
  QVERIFY(!f.isOpen("open"));
  QVERIFY2(readBytes(f.openFile.toStdString()).find("OFF\n8 11 0") == 0, "the file stays");
}

void DesktopCheckTest::aRepairedPartIsSavedAndOpenedAsSuch() {
  CheckFixture f;
  f.fillHole();
  const std::filesystem::path file = f.d.folder.path() / "repaired.nearfit";
  f.d.session().save(file);
  f.d.session().reset();
  f.d.window().document().openScene(QString::fromStdString(file.string()));
  QTRY_COMPARE(f.d.session().scene().parts().size(), std::size_t{2});
  QVERIFY(!f.isOpen("open"));
  QCOMPARE(f.d.part("open").geometry->repairs.size(), std::size_t{1});
  QVERIFY(f.d.part("fixed").geometry->repairs.empty());
}

void DesktopCheckTest::aRepairedPartStaysSoWhenItsUnitChangesOrItsFileIsReloaded() {
  CheckFixture f;
  f.fillHole();
  whenModal<QDialog>([](QDialog* question) { answerUnit(question, "in"); });
  f.d.choose("changeUnit");
  QTRY_VERIFY(isNear(widthOf(f.d.part("open")), 0.04 * 25.4, 1e-9));
  QVERIFY2(!f.isOpen("open"), "the hole that may be filled has grown too");
  QVERIFY(isNear(f.d.part("open").geometry->repairs.front().size, 0.06 * 25.4, 1e-9));
  f.d.session().undo();
  // The file becomes a smaller cube, open too.
  const TriangleMesh whole = boxMesh(glm::dvec3(0.03));
  writeOff(f.openFile.toStdString(), TriangleMesh({whole.vertices().begin(), whole.vertices().end()},
                                                  {whole.triangles().begin() + 1, whole.triangles().end()}));
  f.d.choose("reloadParts");
  QTRY_VERIFY(isNear(widthOf(f.d.part("open")), 0.03, 1e-9));
  QVERIFY(!f.isOpen("open"));
}

void DesktopCheckTest::withoutRepairsOrForALockedPartThereIsNothingToPress() {
  CheckFixture f;
  f.showPanel("open");
  QTRY_COMPARE(f.table->model()->rowCount(), 1);
  auto* repair = f.d.widget<QPushButton>("repairPart");
  QVERIFY(repair->isEnabled());
  auto* fill = f.d.widget<QCheckBox>("repairFill");
  QTest::mouseClick(fill, Qt::LeftButton, {}, {8, fill->height() / 2});
  QVERIFY(!fill->isChecked());
  QVERIFY(!repair->isEnabled());
  QTest::mouseClick(fill, Qt::LeftButton, {}, {8, fill->height() / 2});
  QVERIFY(repair->isEnabled());
  f.d.session().setLocked(f.d.partId("open"), true);
  QVERIFY(!repair->isEnabled());
  f.d.session().setLocked(f.d.partId("open"), false);
  // No-ops record no undo step.
  f.d.type<QDoubleSpinBox>("repairFillSize", "1 mm");
  const std::string before = f.d.session().undoText();
  QTest::mouseClick(repair, Qt::LeftButton);
  QTRY_VERIFY(f.d.text("repairResult").startsWith(QStringLiteral("There was nothing to repair")));
  QCOMPARE(f.d.session().undoText(), before);
}

void DesktopCheckTest::aPartThatIsFeltIsNotRepaired() {
  CheckFixture f;
  f.d.session().setMovingPart(f.d.partId("fixed"));
  f.showPanel("open");
  QTRY_COMPARE(f.table->model()->rowCount(), 1);
  auto* repair = f.d.widget<QPushButton>("repairPart");
  QVERIFY(repair->isEnabled());
  f.d.startWith(ui::Hand::Manual);
  QTRY_VERIFY(!repair->isEnabled());
  f.d.choose("stop");
  QTRY_VERIFY(repair->isEnabled());
}

/// Findings stayed after a repair, and nothing said why none was offered for them.
void DesktopCheckTest::whatCannotBeRepairedIsSaidWithTheReason() {
  CheckFixture f;
  const auto* label = f.d.widget<QLabel>("checkUnrepaired");
  // Two cubes that cross, in one mesh without one of its triangles.
  const TriangleMesh both =
      joined(boxMesh(glm::dvec3(0.04)), boxMesh(glm::dvec3(0.03), {0.02, 0.021, 0.022}));
  f.d.add({writeOff(f.d.folder.path() / "crossing.off",
                    TriangleMesh({both.vertices().begin(), both.vertices().end()},
                                 {both.triangles().begin(), both.triangles().end() - 1}))});
  QTRY_COMPARE(f.d.session().scene().parts().size(), std::size_t{3});
  f.showPanel("crossing");
  const QString crossing =
      QStringLiteral("Self-intersections cannot be repaired: the mesh does not say which");
  QTRY_VERIFY2(f.d.text("checkUnrepaired").startsWith(crossing), qPrintable(f.d.text("checkUnrepaired")));
  QTRY_VERIFY(label->isVisible());
  QVERIFY(!f.d.text("checkUnrepaired").contains(QStringLiteral("Open edges")));
  f.d.type<QDoubleSpinBox>("repairFillSize", "60 mm");
  QTest::mouseClick(f.d.widget<QPushButton>("repairPart"), Qt::LeftButton);
  QTRY_VERIFY(!f.isOpen("crossing"));
  QTRY_VERIFY(f.d.text("checkUnrepaired").startsWith(crossing));
  // Its triangle in the tree offered a repair all the same.
  QTRY_VERIFY2(f.badgeText(2).endsWith(QStringLiteral("why it cannot be repaired")),
               qPrintable(f.badgeText(2)));
  // For what can be repaired there is no such line.
  f.d.window().selection().select(f.d.partId("open"));
  QTRY_COMPARE(f.table->model()->rowCount(), 1);
  QVERIFY(!label->isVisible());
}

NEARFIT_QT_SUITE(DesktopCheckTest, runDesktopTest<DesktopCheckTest>)
#include "desktop_check_test.moc"
