#include "ui/view3d/glyphs/lmd_overlay.h"

#include <QApplication>
#include <QSettings>
#include <QSignalSpy>
#include <QTemporaryDir>
#include <QtTest>
#include <cmath>
#include <initializer_list>
#include <vector>

#include <vtkActorCollection.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>

#include "tests/support/qt/qt_suite.h"
#include "ui/panels/view/view_actions.h"

using namespace nearfit;

namespace {

constexpr double kCutoff = 1e-3;

/// One minimum each at 0.1, 0.2 ... of the cutoff, in another order; one of them blocked.
std::vector<SnapshotLmd> tenMinima(std::size_t blocked = 10) {
  std::vector<SnapshotLmd> all;
  for (const int tenths : {7, 3, 10, 1, 5, 9, 2, 8, 4, 6}) {
    SnapshotLmd entry;
    entry.lmd.distance = 0.1 * tenths * kCutoff;
    entry.lmd.direction = {0.0, 0.0, 1.0};
    entry.lmd.scenePoint = {static_cast<double>(tenths), 0.0, 0.0};
    entry.lmd.partPoint = entry.lmd.scenePoint + entry.lmd.distance * entry.lmd.direction;
    entry.lmd.isBlocked = all.size() == blocked;
    all.push_back(entry);
  }
  return all;
}

/// What the actors that are seen have: lines with the longest of them [m], and dots.
struct Seen {
  vtkIdType lines = 0, dots = 0;
  double widest = 0.0;
};
Seen seenIn(vtkRenderer& renderer) {
  Seen seen;
  // Asked for again the collection begins anew.
  vtkActorCollection* actors = renderer.GetActors();
  actors->InitTraversal();
  while (vtkActor* actor = actors->GetNextActor()) {
    if (!actor->GetVisibility()) continue;
    const vtkPolyData* data = vtkPolyDataMapper::SafeDownCast(actor->GetMapper())->GetInput();
    auto& input = const_cast<vtkPolyData&>(*data);
    const bool isDots = actor->GetProperty()->GetRepresentation() == VTK_POINTS;
    seen.lines += isDots ? 0 : input.GetNumberOfLines();
    seen.dots += isDots ? input.GetNumberOfPoints() : input.GetNumberOfVerts();
    if (input.GetNumberOfPoints() > 0)
      seen.widest = std::max(seen.widest, static_cast<double>(actor->GetProperty()->GetLineWidth()));
  }
  return seen;
}

}  // namespace

class LmdOverlayTest : public QObject {
  Q_OBJECT

 private slots:
  void initTestCase();
  void init();
  void nearestAreChosenByCountAndDistance();
  void formsAreDrawnAsChosen();
  void nearestThatIsNotBlockedIsDrawnLarger();
  void coloursSpanTheDistancesThatAreDrawn();
  void coloursSpanOnlyWhatIsChosenToBeDrawn();
  void coloursDoNotFlickerWhileDistancesChange();
  void coloursFollowDistancesThatFallToAQuarter();
  void atRestColoursAreThoseOfAFreshStart();
  void aRangeAtTheEdgeOfAStepDoesNotComeAndGoAtRest();
  void aChosenRangeOfColoursIsKept();
  void menuChoosesAndRemembers();

 private:
  QTemporaryDir settings_;
};

void LmdOverlayTest::initTestCase() {
  QVERIFY(settings_.isValid());
  QSettings::setDefaultFormat(QSettings::IniFormat);
  QSettings::setPath(QSettings::IniFormat, QSettings::UserScope, settings_.path());
}

void LmdOverlayTest::init() {
  QSettings().clear();
}

void LmdOverlayTest::nearestAreChosenByCountAndDistance() {
  const std::vector<SnapshotLmd> all = tenMinima();
  const auto tenths = [&](const ui::MinimaChoice& choice) {
    QList<int> out;
    for (const SnapshotLmd& entry : ui::chosenMinima(all, kCutoff, choice))
      out << qRound(10.0 * entry.lmd.distance / kCutoff);
    return out;
  };
  QCOMPARE(tenths({}), (QList<int>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10}));
  QCOMPARE(tenths({.most = 3}), (QList<int>{1, 2, 3}));
  QCOMPARE(tenths({.nearerThan = 0.45}), (QList<int>{1, 2, 3, 4}));
  QCOMPARE(tenths({.most = 30, .nearerThan = 0.25}), (QList<int>{1, 2}));
  QCOMPARE(tenths({.nearerThan = 0.05}), QList<int>());
}

void LmdOverlayTest::formsAreDrawnAsChosen() {
  vtkNew<vtkRenderer> renderer;
  ui::LmdOverlay overlay(*renderer.Get());
  const std::vector<SnapshotLmd> all = tenMinima();
  const auto shown = [&](const ui::MinimaChoice& choice) {
    overlay.setChoice(choice);
    overlay.show(all, kCutoff);
    return seenIn(*renderer.Get());
  };
  // Each line has a halo; the nearest is there once more.
  QCOMPARE(shown({}).lines, 22);
  QCOMPARE(shown({}).dots, 22);
  QCOMPARE(shown({.hasPoints = false}).dots, 0);
  QCOMPARE(shown({.hasSegments = false}).lines, 0);
  QCOMPARE(shown({.hasSegments = false, .hasNormals = true}).lines, 20);
  QCOMPARE(shown({.most = 4}).dots, 10);
  overlay.setVisible(false);
  QCOMPARE(shown({.hasNormals = true}).lines, 0);
  overlay.setVisible(true);
  QCOMPARE(seenIn(*renderer.Get()).lines, 42);
}

void LmdOverlayTest::nearestThatIsNotBlockedIsDrawnLarger() {
  vtkNew<vtkRenderer> renderer;
  ui::LmdOverlay overlay(*renderer.Get());
  overlay.show(tenMinima(), kCutoff);
  QVERIFY(seenIn(*renderer.Get()).widest >= 8.0);
  // The fourth is the nearest. What bars it exerts no force: the next is drawn larger.
  const std::vector<SnapshotLmd> barred = tenMinima(3);
  overlay.show(barred, kCutoff);
  vtkActorCollection* actors = renderer->GetActors();
  actors->InitTraversal();
  bool isFound = false;
  while (vtkActor* actor = actors->GetNextActor()) {
    if (actor->GetProperty()->GetRepresentation() != VTK_POINTS) continue;
    vtkPolyData* data = vtkPolyDataMapper::SafeDownCast(actor->GetMapper())->GetInput();
    QCOMPARE(data->GetNumberOfPoints(), 2);
    QCOMPARE(data->GetPoint(0)[0], 2.0);
    isFound = true;
  }
  QVERIFY(isFound);
}

namespace {

/// Minima at these distances [m].
std::vector<SnapshotLmd> minimaAt(std::initializer_list<double> distances) {
  std::vector<SnapshotLmd> all;
  for (const double distance : distances) {
    SnapshotLmd entry;
    entry.lmd.distance = distance;
    entry.lmd.direction = {0.0, 0.0, 1.0};
    entry.lmd.partPoint = {0.0, 0.0, distance};
    all.push_back(entry);
  }
  return all;
}

bool isAbout(double a, double b) {
  return std::abs(a - b) < 1e-9 * b;
}

}  // namespace

/// The range was the cutoff of 10 mm, in which an 8 mm nut is all red.
void LmdOverlayTest::coloursSpanTheDistancesThatAreDrawn() {
  vtkNew<vtkRenderer> renderer;
  ui::LmdOverlay overlay(*renderer.Get());
  constexpr double kTenMillimetres = 0.01;
  overlay.show(minimaAt({1e-4, 2e-4, 2e-4, 3e-4, 8e-3}), kTenMillimetres);
  QVERIFY(isAbout(overlay.colourRange(), 5e-4));
  overlay.show(minimaAt({1e-4, 2e-4, 2e-4, 3e-4, 8e-3}), 10.0 * kTenMillimetres);
  QVERIFY2(isAbout(overlay.colourRange(), 5e-4), "the cutoff has nothing to do with it");
  overlay.clear();
  overlay.show(minimaAt({2e-3, 5e-3, 8e-3}), kTenMillimetres);
  QVERIFY(isAbout(overlay.colourRange(), 1e-2));
  // Contact, at the margin, is red.
  overlay.clear();
  overlay.show(minimaAt({1e-4}), kTenMillimetres, 1e-4);
  QVERIFY(isAbout(overlay.colourRange(), 5e-4));
}

/// The near tenth of the minima stayed as red as all of them.
void LmdOverlayTest::coloursSpanOnlyWhatIsChosenToBeDrawn() {
  vtkNew<vtkRenderer> renderer;
  ui::LmdOverlay overlay(*renderer.Get());
  constexpr double kTenMillimetres = 0.01;
  const auto all = minimaAt({1e-4, 2e-4, 3e-4, 6e-3, 8e-3, 9e-3, 9.5e-3});
  const auto rangeOf = [&](const ui::MinimaChoice& choice) {
    overlay.setChoice(choice);
    overlay.show(all, kTenMillimetres);
    return overlay.colourRange();
  };
  // Twice the median of 6 mm, rounded up, and of 0.2 mm.
  QVERIFY(isAbout(rangeOf({}), 2e-2));
  QVERIFY(isAbout(rangeOf({.nearerThan = 0.1}), 5e-4));
  QVERIFY(isAbout(rangeOf({}), 2e-2));
  QVERIFY(isAbout(rangeOf({.most = 3}), 5e-4));
}

void LmdOverlayTest::coloursDoNotFlickerWhileDistancesChange() {
  ui::ColourRange colours;
  int changes = 0;
  double last = colours.end();
  for (int i = 0; i < 1000; ++i) {
    colours.see(minimaAt({1e-3 * (1.0 + 0.3 * std::sin(0.1 * i))}), 0.0);
    changes += colours.end() != last ? 1 : 0;
    last = colours.end();
  }
  QVERIFY2(changes <= 2, qPrintable(QString::number(changes)));
  colours.see({}, 1e-4);
  QCOMPARE(colours.end(), last);
}

/// The range stayed at 2 mm, so that all minima were red.
void LmdOverlayTest::coloursFollowDistancesThatFallToAQuarter() {
  ui::ColourRange colours;
  colours.see(minimaAt({0.98e-3}), 0.0);
  QVERIFY(isAbout(colours.end(), 2e-3));
  colours.see(minimaAt({0.26e-3}), 0.0);
  QVERIFY(isAbout(colours.end(), 1e-3));
  // 0.6 mm, half as much again as is wanted now, needs this step.
  colours.see(minimaAt({0.2e-3}), 0.0);
  QVERIFY(isAbout(colours.end(), 1e-3));
}

/// At 0.75 mm it stayed at the 5 mm of before, so that all minima were red.
void LmdOverlayTest::atRestColoursAreThoseOfAFreshStart() {
  ui::ColourRange colours, fresh;
  constexpr double kTick = 0.02;
  double time = 0.0;
  const auto see = [&](double distance, int ticks) {
    for (int i = 0; i < ticks; ++i, time += kTick)
      colours.see(minimaAt({distance}), 0.0, time);
  };
  see(2.2e-3, 10);
  QVERIFY(isAbout(colours.end(), 5e-3));
  see(0.75e-3, 10);
  QVERIFY2(isAbout(colours.end(), 5e-3), "the hand may turn back");
  see(0.75e-3, 30);
  fresh.see(minimaAt({0.75e-3}), 0.0);
  QVERIFY(isAbout(fresh.end(), 2e-3));
  QCOMPARE(colours.end(), fresh.end());
  // Minima that come nearer at once are not waited for.
  see(2.2e-3, 1);
  QVERIFY(isAbout(colours.end(), 5e-3));
}

void LmdOverlayTest::aRangeAtTheEdgeOfAStepDoesNotComeAndGoAtRest() {
  ui::ColourRange colours;
  int changes = 0;
  double last = 0.0;
  for (int i = 0; i < 1000; ++i) {
    // Twice the distance is 1 % about 2 mm.
    colours.see(minimaAt({1e-3 * (1.0 + 0.01 * std::sin(0.05 * i))}), 0.0, 0.02 * i);
    changes += colours.end() != last ? 1 : 0;
    last = colours.end();
  }
  QVERIFY2(changes <= 3, qPrintable(QString::number(changes)));
}

void LmdOverlayTest::aChosenRangeOfColoursIsKept() {
  QSettings().setValue(QStringLiteral("minima/colourRange"), 0.002);
  {
    ui::MinimaMenu menu(nullptr);
    QCOMPARE(menu.choice().colourRange, 0.002);
    QVERIFY(menu.findChild<QAction*>(QStringLiteral("minimaColoursChosen"))->isChecked());
    vtkNew<vtkRenderer> renderer;
    ui::LmdOverlay overlay(*renderer.Get());
    overlay.setChoice(menu.choice());
    overlay.show(minimaAt({1e-4}), kCutoff);
    QCOMPARE(overlay.colourRange(), 0.002);
    menu.findChild<QAction*>(QStringLiteral("minimaColoursAutomatic"))->trigger();
    QCOMPARE(menu.choice().colourRange, 0.0);
  }
  QCOMPARE(ui::MinimaMenu(nullptr).choice().colourRange, 0.0);
  // A number that makes no sense is ignored.
  QSettings().setValue(QStringLiteral("minima/colourRange"), QStringLiteral("nan"));
  QCOMPARE(ui::MinimaMenu(nullptr).choice().colourRange, 0.0);
}

void LmdOverlayTest::menuChoosesAndRemembers() {
  {
    ui::MinimaMenu menu(nullptr);
    QCOMPARE(menu.choice(), ui::MinimaChoice());
    QSignalSpy changes(&menu, &ui::MinimaMenu::choiceChanged);
    const auto action = [&](const char* name) { return menu.findChild<QAction*>(QLatin1String(name)); };
    for (const char* name : {"minimaNormals", "minimaPoints", "minimaMost10", "minimaWithin25"}) {
      QVERIFY2(action(name) != nullptr, name);
      action(name)->trigger();
    }
    QCOMPARE(changes.count(), 4);
    QVERIFY(action("minimaMost10")->isChecked() && !action("minimaMost0")->isChecked());
    action("minimaMost10")->trigger();
    QCOMPARE(changes.count(), 4);
  }
  const ui::MinimaMenu again(nullptr);
  const ui::MinimaChoice expected{.hasPoints = false, .hasNormals = true, .most = 10, .nearerThan = 0.25};
  QCOMPARE(again.choice(), expected);
  QVERIFY(again.findChild<QAction*>(QStringLiteral("minimaWithin25"))->isChecked());
  // What makes no sense counts for nothing.
  QSettings().setValue(QStringLiteral("minima/most"), -3);
  QSettings().setValue(QStringLiteral("minima/nearerThanPercent"), QStringLiteral("near"));
  const ui::MinimaMenu usual(nullptr);
  QCOMPARE(usual.choice().most, std::size_t{0});
  QCOMPARE(usual.choice().nearerThan, 1.0);
}

NEARFIT_QT_SUITE(LmdOverlayTest, test::runQtTest<LmdOverlayTest>)
#include "lmd_overlay_test.moc"
