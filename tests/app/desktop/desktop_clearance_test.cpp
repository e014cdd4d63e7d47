#include <QComboBox>
#include <QDockWidget>
#include <QDoubleSpinBox>
#include <QHeaderView>
#include <QMenu>
#include <QStyleOption>
#include <QTableView>
#include <QToolButton>
#include <QVector>
#include <vector>

#include "tests/app/desktop/desktop_driver.h"
#include "tests/app/desktop/row_highlight.h"
#include "ui/model/clearance_model.h"
#include "ui/model/parts_model.h"
#include "ui/model/selection.h"

using namespace nearfit;
using namespace nearfit::test;
using ui::ClearanceModel;

namespace {

/// The two cubes, 5 mm apart, and a third that stands 30 mm beside the moving one; the table is shown.
struct ClearanceFixture {
  ClearanceFixture() {
    d.addCubes();
    const QString beside =
        writeOff(d.folder.path() / "beside.off", boxMesh(glm::dvec3(0.02), glm::dvec3(0.05, 0.0, 0.035)));
    d.add({beside});
    (void)QTest::qWaitFor([&] { return d.session().scene().parts().size() == 3; });
    d.choose(panelEntry(d.widget<QDockWidget>("clearanceDock")));
    table = d.widget<QTableView>("clearanceTable");
  }
  QString cell(int row, int column) const { return table->model()->index(row, column).data().toString(); }
  /// Of the row whose part is called so.
  QString of(const char* name, int column) const {
    for (int row = 0; row < table->model()->rowCount(); ++row) {
      if (cell(row, ClearanceModel::Other) == QLatin1String(name)) return cell(row, column);
    }
    return {};
  }
  void clickRow(int row) {
    QTest::mouseClick(table->viewport(), Qt::LeftButton, {},
                      table->visualRect(table->model()->index(row, ClearanceModel::Distance)).center());
  }

  DesktopDriver d;
  QTableView* table = nullptr;
};

}  // namespace

class DesktopClearanceTest : public QObject {
  Q_OBJECT

 private slots:
  void theTableSaysHowNearEachOtherPartIs();
  void theThresholdMarksPairsInColourAndInWords();
  void lengthsAreInTheUnitThatIsChosen();
  void aRowShowsItsPairAndWhereItIsNearestAndSelectsNothing();
  void thePairIsShownUntilTheNextSelectionOrEscape();
  void touchingIsToldApartFromOverlapping();
  void theTableFollowsMovesAndOverlaps();
  void theTableFollowsThePartInHand();
  void columnsAreSortedByWhatTheyMean();
  void textsOfNeighbouringColumnsStandApart();
  void anotherPartThanTheOneInHandIsChosen();
  void theTableIsExported();
  void aHiddenTableSearchesNothing();
  void eachReviewPanelIsOneClickAway();
  void reviewPanelsShareOnePlaceAndLeaveTheSidesTheirHeight();
  void theButtonOfAPanelBehindATabBringsItToTheFront();
  void theEntryOfAPanelBehindATabBringsItToTheFront();
  void theNoteFollowsWhatIsChosen();
};

void DesktopClearanceTest::theTableSaysHowNearEachOtherPartIs() {
  ClearanceFixture f;
  QTRY_COMPARE(f.of("fixed", ClearanceModel::Distance), QStringLiteral("5.00 mm"));
  QCOMPARE(f.of("beside", ClearanceModel::Distance), QStringLiteral("30.0 mm"));
  QCOMPARE(f.of("fixed", ClearanceModel::Minima), QStringLiteral("1"));
  QCOMPARE(f.of("beside", ClearanceModel::Minima), QStringLiteral("0"));
  QCOMPARE(f.table->model()->rowCount(), 2);
}

void DesktopClearanceTest::theThresholdMarksPairsInColourAndInWords() {
  ClearanceFixture f;
  QTRY_COMPARE(f.of("fixed", ClearanceModel::Verdict), QStringLiteral("clear"));
  f.d.type<QDoubleSpinBox>("clearanceThreshold", "5.5");
  QCOMPARE(f.of("fixed", ClearanceModel::Verdict), QStringLiteral("too near"));
  QCOMPARE(f.of("beside", ClearanceModel::Verdict), QStringLiteral("clear"));
  const auto colourOf = [&](int row) {
    return f.table->model()->index(row, ClearanceModel::Distance).data(Qt::ForegroundRole);
  };
  QVERIFY(colourOf(0).isValid());
  QVERIFY(!colourOf(1).isValid());
}

void DesktopClearanceTest::lengthsAreInTheUnitThatIsChosen() {
  ClearanceFixture f;
  QTRY_COMPARE(f.of("fixed", ClearanceModel::Distance), QStringLiteral("5.00 mm"));
  f.d.choose("unit-in");
  QCOMPARE(f.of("fixed", ClearanceModel::Distance), QStringLiteral("0.197 in"));
  f.d.type<QDoubleSpinBox>("clearanceThreshold", "0.19");
  QCOMPARE(f.of("fixed", ClearanceModel::Verdict), QStringLiteral("clear"));
  f.d.type<QDoubleSpinBox>("clearanceThreshold", "1/2 cm + 1 um");
  QCOMPARE(f.of("fixed", ClearanceModel::Verdict), QStringLiteral("too near"));
  f.d.choose("unit-mm");
  QCOMPARE(f.d.widget<QDoubleSpinBox>("clearanceThreshold")->text(), QStringLiteral("5.001 mm"));
  f.d.type<QDoubleSpinBox>("clearanceThreshold", "1");
}

/// It selected both parts, so that the next number or drag moved both.
void DesktopClearanceTest::aRowShowsItsPairAndWhereItIsNearestAndSelectsNothing() {
  ClearanceFixture f;
  QTRY_COMPARE(f.table->model()->rowCount(), 2);
  const int before = f.d.window().viewport().pictureCount();
  QCOMPARE(f.cell(1, ClearanceModel::Other), QStringLiteral("beside"));
  const std::vector<PartId> expected{f.d.partId("fixed")};
  f.d.window().selection().set(expected);
  f.clickRow(1);
  QCOMPARE(f.d.window().selection().parts(), expected);
  auto* label = f.d.widget<QLabel>("clearanceLabel");
  QTRY_VERIFY(label->isVisible());
  QCOMPARE(label->text(), QStringLiteral("30.0 mm"));
  QTRY_VERIFY(f.d.window().viewport().pictureCount() > before);
  const QImage with = f.d.picture();
  // The pair fills more than half of the view, one way or the other.
  const ViewProjection view = f.d.window().viewport().projection();
  glm::dvec2 least(1e9), most(-1e9);
  for (const char* name : {"beside", "moving"}) {
    const Part& part = f.d.part(name);
    for (const glm::dvec3& vertex : part.geometry->mesh.vertices()) {
      const glm::dvec2 seen = view.pixelOf(part.worldFromPart.applyToPoint(vertex)).value();
      least = glm::min(least, seen);
      most = glm::max(most, seen);
    }
  }
  const QSize size = f.d.window().viewport().size();
  const double share = std::max((most.x - least.x) / size.width(), (most.y - least.y) / size.height());
  QVERIFY2(share > 0.5 && share < 1.0, qPrintable(QString::number(share)));
  // The same picture without the pair's segment.
  f.table->clearSelection();
  QCOMPARE(f.d.window().selection().parts(), expected);
  QVERIFY(!label->isVisible());
  QVERIFY(differentPixels(f.d.picture(), with) > 100);
}

/// It stayed highlighted, and its label lay on the handles of what was selected then.
void DesktopClearanceTest::thePairIsShownUntilTheNextSelectionOrEscape() {
  ClearanceFixture f;
  QTRY_COMPARE(f.table->model()->rowCount(), 2);
  checkThatAPairIsShownUntilTheNextSelectionOrEscape(
      f.d, {*f.table, *f.d.widget<QLabel>("clearanceLabel"), [&f] { f.clickRow(1); }}, "fixed", "beside");
}

void DesktopClearanceTest::touchingIsToldApartFromOverlapping() {
  ClearanceFixture f;
  QTRY_COMPARE(f.of("fixed", ClearanceModel::Distance), QStringLiteral("5.00 mm"));
  const auto lift = [&](double height) {
    f.d.session().movePart(f.d.partId("fixed"), {{1, 0, 0, 0}, {0.0, 0.0, height}});
  };
  lift(0.005);
  QTRY_COMPARE(f.of("fixed", ClearanceModel::Verdict), QStringLiteral("touching"));
  QCOMPARE(f.of("fixed", ClearanceModel::Distance), QStringLiteral("0.00 mm"));
  lift(0.006);
  QTRY_COMPARE(f.of("fixed", ClearanceModel::Verdict), QStringLiteral("overlapping"));
}

void DesktopClearanceTest::theTableFollowsMovesAndOverlaps() {
  ClearanceFixture f;
  QTRY_COMPARE(f.of("fixed", ClearanceModel::Distance), QStringLiteral("5.00 mm"));
  f.d.session().movePart(f.d.partId("fixed"), {{1, 0, 0, 0}, {0, 0, 0.01}});
  QTRY_COMPARE(f.of("fixed", ClearanceModel::Verdict), QStringLiteral("overlapping"));
  QCOMPARE(f.of("fixed", ClearanceModel::Distance), QStringLiteral("–"));
  f.d.session().undo();
  QTRY_COMPARE(f.of("fixed", ClearanceModel::Distance), QStringLiteral("5.00 mm"));
  f.d.session().setVisible(f.d.partId("fixed"), false);
  QTRY_COMPARE(f.table->model()->rowCount(), 1);
}

void DesktopClearanceTest::theTableFollowsThePartInHand() {
  ClearanceFixture f;
  QTRY_COMPARE(f.of("fixed", ClearanceModel::Distance), QStringLiteral("5.00 mm"));
  f.d.startWith(ui::Hand::Manual);
  f.d.clickPart(1, ui::PartsModel::Name);
  f.d.type<QDoubleSpinBox>("positionZ", "2");
  QTRY_COMPARE(f.of("fixed", ClearanceModel::Distance), QStringLiteral("7.00 mm"));
  // The servo knows nothing of what is beyond its cutoff: that is searched.
  f.d.type<QDoubleSpinBox>("positionX", "-3");
  QTRY_COMPARE(f.of("beside", ClearanceModel::Distance), QStringLiteral("33.0 mm"));
}

void DesktopClearanceTest::columnsAreSortedByWhatTheyMean() {
  ClearanceFixture f;
  QTRY_COMPARE(f.table->model()->rowCount(), 2);
  QCOMPARE(f.cell(0, ClearanceModel::Other), QStringLiteral("fixed"));
  QHeaderView* header = f.table->horizontalHeader();
  const auto clickHeader = [&](int column) {
    QTest::mouseClick(header->viewport(), Qt::LeftButton, {},
                      {header->sectionViewportPosition(column) + 20, header->height() / 2});
  };
  clickHeader(ClearanceModel::Distance);
  QCOMPARE(f.cell(0, ClearanceModel::Other), QStringLiteral("beside"));
  clickHeader(ClearanceModel::Other);
  clickHeader(ClearanceModel::Other);
  QCOMPARE(f.cell(0, ClearanceModel::Other), QStringLiteral("fixed"));
}

/// "Minima", at the right of its column, and "Verdict", at the left of the next one, read as one.
void DesktopClearanceTest::textsOfNeighbouringColumnsStandApart() {
  constexpr int kApart = 10;
  ClearanceFixture f;
  QTRY_COMPARE(f.table->model()->rowCount(), 2);
  const QHeaderView* header = f.table->horizontalHeader();
  const auto labelOf = [header](int column) {
    QStyleOptionHeader option;
    option.initFrom(header);
    option.orientation = Qt::Horizontal;
    option.rect = {header->sectionViewportPosition(column), 0, header->sectionSize(column), header->height()};
    return header->style()->subElementRect(QStyle::SE_HeaderLabel, &option, header);
  };
  const QRect minima = labelOf(ClearanceModel::Minima), verdict = labelOf(ClearanceModel::Verdict);
  QVERIFY2(verdict.left() - minima.right() >= kApart,
           qPrintable(QString::number(verdict.left() - minima.right())));
  for (const int column : {int{ClearanceModel::Minima}, int{ClearanceModel::Verdict}}) {
    const QString text = f.table->model()->headerData(column, Qt::Horizontal).toString();
    QVERIFY2(labelOf(column).width() >= header->fontMetrics().horizontalAdvance(text), qPrintable(text));
  }
  // The rows have as much room: each text is whole in its cell less the margins.
  const int margin = f.table->style()->pixelMetric(QStyle::PM_FocusFrameHMargin, nullptr, f.table) + 1;
  QVERIFY(2 * margin >= kApart);
  for (int row = 0; row < 2; ++row) {
    const QString text = f.cell(row, ClearanceModel::Verdict);
    QVERIFY2(f.table->columnWidth(ClearanceModel::Verdict) - 2 * margin >=
                 f.table->fontMetrics().horizontalAdvance(text),
             qPrintable(text));
  }
}

void DesktopClearanceTest::anotherPartThanTheOneInHandIsChosen() {
  ClearanceFixture f;
  auto* part = f.d.widget<QComboBox>("clearancePart");
  QCOMPARE(part->currentText(), QStringLiteral("In hand: moving"));
  part->setFocus();
  QTest::keyClick(part, Qt::Key_End);
  QCOMPARE(part->currentText(), QStringLiteral("beside"));
  QTRY_COMPARE(f.of("moving", ClearanceModel::Distance), QStringLiteral("30.0 mm"));
  f.d.session().deletePart(f.d.partId("beside"));
  QCOMPARE(part->currentText(), QStringLiteral("In hand: moving"));
  QTRY_COMPARE(f.of("fixed", ClearanceModel::Distance), QStringLiteral("5.00 mm"));
  QCOMPARE(f.table->model()->rowCount(), 1);
}

void DesktopClearanceTest::theTableIsExported() {
  ClearanceFixture f;
  QTRY_COMPARE(f.table->model()->rowCount(), 2);
  const auto file = f.d.folder.path() / "clear.csv";
  whenModal<QFileDialog>(
      [&](QFileDialog* dialog) { chooseFile(dialog, QString::fromStdString(file.string())); });
  QTest::mouseClick(f.d.widget<QPushButton>("exportClearances"), Qt::LeftButton);
  QTRY_VERIFY(std::filesystem::exists(file));
  QVERIFY(readBytes(file).find("\nmoving,fixed,0.005") != std::string::npos);
  QVERIFY2(readBytes(file).starts_with("part,other,distance [m],part_x [m]"), "lengths have their unit");
}

/// They made a row of narrow panels, and the side panels stayed low once these were closed.
void DesktopClearanceTest::reviewPanelsShareOnePlaceAndLeaveTheSidesTheirHeight() {
  DesktopDriver d;
  d.addCubes();
  const auto heights = [&d] {
    QVector<int> all;
    for (const char* name : {"partsDock", "poseDock", "feelDock"})
      all << d.widget<QDockWidget>(name)->height();
    return all;
  };
  const QVector<int> before = heights();
  const std::vector<const char*> names{"clearanceDock", "clearanceMapDock", "plotsDock", "timelineDock"};
  const auto press = [&d](const char* name) {
    auto* button = d.window().findChild<QToolButton*>(QLatin1String(name) + QStringLiteral("Button"));
    QTest::mouseClick(button, Qt::LeftButton);
  };
  const auto isInFront = [&d](const char* name) {
    const auto* dock = d.widget<QDockWidget>(name);
    return dock->isVisible() && !dock->visibleRegion().isEmpty();
  };
  for (const char* name : names) {
    press(name);
    QTRY_VERIFY2(isInFront(name), name);
  }
  QVERIFY(isInFront("plotsDock") && !isInFront("clearanceDock") && !isInFront("clearanceMapDock"));
  auto *clearances = d.widget<QDockWidget>("clearanceDock"), *plots = d.widget<QDockWidget>("plotsDock");
  // The panels of checks too.
  QCOMPARE(d.window().tabifiedDockWidgets(clearances).size(), 4);
  QCOMPARE(plots->width(), d.window().centralWidget()->width());
  // Also one that was in front last.
  press("plotsDock");
  QTRY_VERIFY(!plots->isVisible());
  press("plotsDock");
  QTRY_VERIFY(isInFront("plotsDock"));
  for (const char* name : names) {
    // One behind a tab comes to the front first.
    if (!isInFront(name)) press(name);
    QTRY_VERIFY2(isInFront(name), name);
    press(name);
    QTRY_VERIFY2(!d.widget<QDockWidget>(name)->isVisible(), name);
  }
  QTRY_VERIFY2(heights() == before, qPrintable(QString::number(heights().at(1))));
  // Where it was put beside another, it comes back.
  d.window().addDockWidget(Qt::BottomDockWidgetArea, plots, Qt::Horizontal);
  press("clearanceDock");
  press("plotsDock");
  QTRY_VERIFY(isInFront("clearanceDock") && isInFront("plotsDock"));
}

/// It was closed: both buttons looked pressed, and nothing said which of the two was seen.
void DesktopClearanceTest::theButtonOfAPanelBehindATabBringsItToTheFront() {
  DesktopDriver d;
  const auto press = [&d](const char* name) {
    QTest::mouseClick(d.window().findChild<QToolButton*>(QLatin1String(name) + QStringLiteral("Button")),
                      Qt::LeftButton);
  };
  const auto* check = d.widget<QDockWidget>("sceneCheckDock");
  const auto* plots = d.widget<QDockWidget>("plotsDock");
  press("sceneCheckDock");
  QTRY_VERIFY(check->isVisible() && !check->visibleRegion().isEmpty());
  press("plotsDock");
  QTRY_VERIFY(plots->isVisible() && !plots->visibleRegion().isEmpty());
  QTRY_VERIFY(check->isVisible() && check->visibleRegion().isEmpty());
  press("sceneCheckDock");
  QTRY_VERIFY(check->isVisible() && !check->visibleRegion().isEmpty());
  QVERIFY(plots->isVisible() && plots->visibleRegion().isEmpty());
  QVERIFY(check->toggleViewAction()->isChecked() && plots->toggleViewAction()->isChecked());
  // In front it is closed, and the other stays.
  press("sceneCheckDock");
  QTRY_VERIFY(!check->isVisible());
  QTRY_VERIFY(plots->isVisible() && !plots->visibleRegion().isEmpty());
}

/// It was closed, as by the button before.
void DesktopClearanceTest::theEntryOfAPanelBehindATabBringsItToTheFront() {
  DesktopDriver d;
  const auto* mesh = d.widget<QDockWidget>("checkDock");
  const auto* plots = d.widget<QDockWidget>("plotsDock");
  const auto isInFront = [](const QDockWidget* dock) {
    return dock->isVisible() && !dock->visibleRegion().isEmpty();
  };
  QVERIFY(!panelEntry(mesh)->isChecked());
  d.choose(panelEntry(mesh));
  QTRY_VERIFY(isInFront(mesh));
  d.choose(panelEntry(plots));
  QTRY_VERIFY(isInFront(plots) && !isInFront(mesh));
  QVERIFY(panelEntry(mesh)->isChecked() && panelEntry(plots)->isChecked());
  d.choose(panelEntry(mesh));
  QTRY_VERIFY(isInFront(mesh));
  QVERIFY(plots->isVisible() && !isInFront(plots));
  QVERIFY(panelEntry(mesh)->isChecked() && panelEntry(plots)->isChecked());
  // In front it is closed, and the other stays.
  d.choose(panelEntry(mesh));
  QTRY_VERIFY(!mesh->isVisible());
  QTRY_VERIFY(isInFront(plots));
  QVERIFY(!panelEntry(mesh)->isChecked() && panelEntry(plots)->isChecked());
}

void DesktopClearanceTest::theNoteFollowsWhatIsChosen() {
  ClearanceFixture f;
  QTRY_COMPARE(f.of("fixed", ClearanceModel::Distance), QStringLiteral("5.00 mm"));
  QVERIFY(f.d.text("clearanceNote").startsWith(QStringLiteral("Select a row")));
  f.clickRow(0);
  QVERIFY(f.d.text("clearanceNote").startsWith(QStringLiteral("The line in the view")));
  // They overlap: no line says where.
  f.d.clickPart(1, ui::PartsModel::Name);
  f.d.type<QDoubleSpinBox>("positionZ", "-10");
  QTRY_COMPARE(f.of("fixed", ClearanceModel::Verdict), QStringLiteral("overlapping"));
  f.clickRow(0);
  QVERIFY2(f.d.text("clearanceNote").isEmpty(), qPrintable(f.d.text("clearanceNote")));
}

void DesktopClearanceTest::aHiddenTableSearchesNothing() {
  ClearanceFixture f;
  QTRY_COMPARE(f.of("fixed", ClearanceModel::Distance), QStringLiteral("5.00 mm"));
  auto* dock = f.d.widget<QDockWidget>("clearanceDock");
  f.d.choose(panelEntry(dock));
  f.d.session().movePart(f.d.partId("fixed"), {{1, 0, 0, 0}, {0, 0, -0.002}});
  QTest::qWait(400);
  QCOMPARE(f.of("fixed", ClearanceModel::Distance), QStringLiteral("5.00 mm"));
  f.d.choose(panelEntry(dock));
  QTRY_COMPARE(f.of("fixed", ClearanceModel::Distance), QStringLiteral("7.00 mm"));
}

void DesktopClearanceTest::eachReviewPanelIsOneClickAway() {
  DesktopDriver d;
  for (const char* name :
       {"clearanceDock", "clearanceMapDock", "plotsDock", "timelineDock", "sceneCheckDock"}) {
    const auto* dock = d.widget<QDockWidget>(name);
    auto* button = d.window().findChild<QToolButton*>(QLatin1String(name) + QStringLiteral("Button"));
    QVERIFY2(button != nullptr && button->isVisible() && !button->text().isEmpty(), name);
    QVERIFY2(!dock->isVisible(), name);
    QTest::mouseClick(button, Qt::LeftButton);
    QTRY_VERIFY2(dock->isVisible(), name);
    QTest::mouseClick(button, Qt::LeftButton);
    QTRY_VERIFY2(!dock->isVisible(), name);
  }
}

NEARFIT_QT_SUITE(DesktopClearanceTest, runDesktopTest<DesktopClearanceTest>)
#include "desktop_clearance_test.moc"
