#include <QDoubleSpinBox>

#include "tests/app/desktop/desktop_driver.h"
#include "ui/model/parts_model.h"
#include "ui/model/selection.h"
#include "ui/model/shown_poses.h"

using namespace nearfit;
using namespace nearfit::test;

/// The fixed cube, the moving one over it, and a second such cube 30 mm aside, in a group with the first.
class PairInHand : public DesktopDriver {
 public:
  PairInHand() {
    addCubes();
    add({movingFile});
    (void)QTest::qWaitFor([this] { return session().scene().parts().size() == 3; });
    lead = partId("moving");
    other = session().scene().parts().back()->id;
    session().movePart(other, {{1, 0, 0, 0}, {0.03, 0.0, 0.0}});
    group = session().group({{lead, other}, {}}, "Pair");
    session().setMovingPart(std::nullopt);
    window().setFailureSink([this](const ui::Failure& failure) { failures << failure.summary; });
  }
  void click(GroupId id, int column) {
    QTreeView* view = partsView();
    auto& model = *qobject_cast<ui::PartsModel*>(view->model());
    const QModelIndex index = model.indexOf(id).siblingAtColumn(column);
    view->scrollTo(index);
    QTest::mouseClick(view->viewport(), Qt::LeftButton, {}, view->visualRect(index).center());
  }
  double shownX(PartId id) {
    return window().viewport().poses().poseOf(session().scene().get(id)).translation.x;
  }
  double x(PartId id) { return session().scene().get(id).worldFromPart.translation.x; }

  PartId lead{}, other{};
  GroupId group{};
  QStringList failures;
};

class DesktopGroupInHandTest : public QObject {
  Q_OBJECT

 private slots:
  void aGroupIsTakenInHandByKeyAndByItsHandAndPutDown();
  void itsPartsMoveAsOneAndAreKeptAsOneStep();
  void itsPartsAreNotPlacedAloneWhileItIsFelt();
  void withoutASelectionTheNumbersAreThoseOfTheGroup();
  void theNumbersOfAGroupAreThoseOfOnePartInHandOrNot();
  void theNumbersOfTheWholeGroupAreThoseOfOneBody();
  void typedNumbersMoveTheWholeGroupAboutItsCentreOfMass();
  void anotherThingInHandEndsTheGroup();
  void aLockedPartIsRefusedWithAWord();
  void aGroupOfAllPartsHasNothingToFeel();
  void itIsSavedAndOpenedAgain();
};

void DesktopGroupInHandTest::aGroupIsTakenInHandByKeyAndByItsHandAndPutDown() {
  PairInHand d;
  d.click(d.group, ui::PartsModel::Name);
  QCOMPARE(d.window().selection().groups(), std::vector{d.group});
  pressShortcut(d, Qt::Key_H, Qt::ControlModifier);
  QVERIFY(d.session().scene().movingGroup() == d.group);
  QVERIFY(d.widget<QPushButton>("startStop")->isEnabled());
  d.click(d.group, ui::PartsModel::Moving);
  QVERIFY(!d.session().scene().movingPart());
  d.click(d.group, ui::PartsModel::Moving);
  QVERIFY(d.session().scene().movingGroup() == d.group);
  QCOMPARE(d.session().undoText(), std::string("Make Pair the moving group"));
  QVERIFY(d.failures.isEmpty());
}

void DesktopGroupInHandTest::itsPartsMoveAsOneAndAreKeptAsOneStep() {
  PairInHand d;
  d.session().setMovingGroup(d.group);
  const std::size_t before = d.session().historyIndex();
  d.startWith(ui::Hand::Manual);
  QTRY_VERIFY(d.isFeltAtX(0.0));
  d.application.servo().moveHand({{1, 0, 0, 0}, {0.004, 0.0, 0.001}});
  QTRY_VERIFY(d.isFeltAtX(0.004));
  QTRY_VERIFY(isNear(d.shownX(d.other), 0.034, 1e-9));
  QCOMPARE(d.x(d.other), 0.03);
  keepPictures(d.window(), QStringLiteral("group-in-hand"));
  d.choose("stop");
  QVERIFY(isNear(d.x(d.lead), 0.004, 1e-9));
  QVERIFY(isNear(d.x(d.other), 0.034, 1e-9));
  QCOMPARE(d.session().historyIndex(), before + 1);
  d.session().undo();
  QCOMPARE(d.x(d.lead), 0.0);
  QCOMPARE(d.x(d.other), 0.03);
  QVERIFY(d.session().scene().movingGroup() == d.group);
  QVERIFY(d.failures.isEmpty());
}

void DesktopGroupInHandTest::itsPartsAreNotPlacedAloneWhileItIsFelt() {
  PairInHand d;
  d.session().setMovingGroup(d.group);
  d.startWith(ui::Hand::Manual);
  QTRY_VERIFY(d.isFeltAtX(0.0));
  // Numbers of any of them are those of the group: the hand takes both along.
  d.window().selection().select(d.other);
  QCOMPARE(d.text("poseHeading"), QStringLiteral("Pair"));
  QCOMPARE(d.widget<QDoubleSpinBox>("positionX")->value(), 0.0);
  d.type<QDoubleSpinBox>("positionX", "-4");
  QTRY_VERIFY(d.isFeltAtX(-0.004));
  QTRY_VERIFY(isNear(d.shownX(d.other), 0.026, 1e-9));
  QCOMPARE(d.x(d.other), 0.03);
  d.choose("stop");
  d.window().selection().select(d.other);
  QTRY_VERIFY(d.text("poseHeading") != QStringLiteral("Pair"));
  QVERIFY(d.widget<QDoubleSpinBox>("positionX")->isEnabled());
  d.type<QDoubleSpinBox>("positionX", "40");
  QVERIFY(isNear(d.x(d.other), 0.04, 1e-9));
  QVERIFY(isNear(d.x(d.lead), -0.004, 1e-9));
}

void DesktopGroupInHandTest::withoutASelectionTheNumbersAreThoseOfTheGroup() {
  PairInHand d;
  // The other part is 30 mm aside: its numbers would differ.
  d.session().setMovingGroup(d.group);
  d.startWith(ui::Hand::Manual);
  QTRY_VERIFY(d.isFeltAtX(0.0));
  d.window().selection().select(std::nullopt);
  QCOMPARE(d.text("poseHeading"), QStringLiteral("Pair"));
  d.application.servo().moveHand({{1, 0, 0, 0}, {0.004, 0.0, 0.001}});
  QTRY_VERIFY(isNear(d.widget<QDoubleSpinBox>("positionX")->value(), 4.0, 1e-3));
  QVERIFY(d.widget<QDoubleSpinBox>("positionX")->isEnabled());
  // Between the two cubes.
  QTRY_COMPARE(d.text("massCentre"), QStringLiteral("Centre of mass 19.000, 0.000, 36.000 mm"));
  d.choose("stop");
  QTRY_VERIFY(!d.application.servo().isRunning());
  QCOMPARE(d.text("poseHeading"), QStringLiteral("Pair"));
  QVERIFY(d.widget<QDoubleSpinBox>("positionX")->isEnabled());
  d.session().setMovingPart(std::nullopt);
  QCOMPARE(d.text("poseHeading"), QStringLiteral("No part selected"));
  QVERIFY(!d.widget<QLabel>("massCentre")->isVisible());
}

/// They were those of its last part until it was taken in hand.
void DesktopGroupInHandTest::theNumbersOfAGroupAreThoseOfOnePartInHandOrNot() {
  PairInHand d;
  d.session().movePart(d.lead, {{1, 0, 0, 0}, {0.002, 0.0, 0.0}});
  d.window().selection().set({d.lead, d.other}, {d.group});
  const auto* x = d.widget<QDoubleSpinBox>("positionX");
  QVERIFY(isNear(x->value(), 2.0, 1e-9));
  QVERIFY(d.widget<QLabel>("poseHeading")->toolTip().contains(QStringLiteral("moving")));
  d.session().setMovingGroup(d.group);
  QVERIFY(isNear(x->value(), 2.0, 1e-9));
  d.session().setMovingPart(std::nullopt);
  d.type<QDoubleSpinBox>("positionX", "3");
  QVERIFY(isNear(d.x(d.lead), 0.003, 1e-9) && isNear(d.x(d.other), 0.031, 1e-9));
}

/// They were those of the part selected last, under the name of the group.
void DesktopGroupInHandTest::theNumbersOfTheWholeGroupAreThoseOfOneBody() {
  PairInHand d;
  d.session().setDensity(d.other, 3000.0);
  d.session().setMovingGroup(d.group);
  d.window().selection().set({d.lead, d.other}, {d.group});
  QCOMPARE(d.text("poseHeading"), QStringLiteral("Pair"));
  QVERIFY(d.widget<QLabel>("poseHeading")->toolTip().contains(QStringLiteral("moving, which leads")));
  // As place --group gives it: of the part that leads.
  QCOMPARE(d.widget<QDoubleSpinBox>("positionX")->value(), 0.0);
  // Two cubes of 8 cm^3, of water and of three times its density.
  QCOMPARE(d.text("mass"), QStringLiteral("32.0 g"));
  QCOMPARE(d.text("massCentre"), QStringLiteral("Centre of mass 22.500, 0.000, 35.000 mm"));
  // What is hidden is not felt.
  d.session().setVisible(d.lead, false);
  QCOMPARE(d.text("mass"), QStringLiteral("24.0 g"));
  QCOMPARE(d.text("massCentre"), QStringLiteral("Centre of mass 30.000, 0.000, 35.000 mm"));
  d.session().setVisible(d.lead, true);
  d.window().selection().select(d.other);
  QCOMPARE(d.widget<QDoubleSpinBox>("positionX")->value(), 30.0);
  QVERIFY(!d.widget<QLabel>("massCentre")->isVisible());
}

void DesktopGroupInHandTest::typedNumbersMoveTheWholeGroupAboutItsCentreOfMass() {
  PairInHand d;
  d.session().setMovingGroup(d.group);
  d.window().selection().set({d.lead, d.other}, {d.group});
  const std::size_t before = d.session().historyIndex();
  d.type<QDoubleSpinBox>("positionX", "5");
  QVERIFY(isNear(d.x(d.lead), 0.005, 1e-12) && isNear(d.x(d.other), 0.035, 1e-12));
  QCOMPARE(d.session().historyIndex(), before + 1);
  // Half a turn about the middle of the two exchanges them.
  d.type<QDoubleSpinBox>("rotationZ", "180");
  QVERIFY(isNear(d.x(d.lead), 0.035, 1e-9) && isNear(d.x(d.other), 0.005, 1e-9));
  d.session().undo();
  d.session().undo();
  QVERIFY(d.x(d.lead) == 0.0 && d.x(d.other) == 0.03);
  QVERIFY(d.failures.isEmpty());
}

void DesktopGroupInHandTest::anotherThingInHandEndsTheGroup() {
  PairInHand d;
  d.session().setMovingGroup(d.group);
  d.startWith(ui::Hand::Manual);
  QTRY_VERIFY(d.isFeltAtX(0.0));
  // The same part leads, but it is another body.
  d.session().setMovingPart(d.lead);
  QVERIFY(!d.application.servo().isRunning());
  d.session().setMovingGroup(d.group);
  d.startWith(ui::Hand::Manual);
  QTRY_VERIFY(d.isFeltAtX(0.0));
  d.session().deleteNodes({{}, {d.group}});
  QVERIFY(!d.application.servo().isRunning());
  QVERIFY(d.failures.isEmpty());
}

void DesktopGroupInHandTest::aLockedPartIsRefusedWithAWord() {
  PairInHand d;
  d.session().setLocked(d.other, true);
  d.click(d.group, ui::PartsModel::Moving);
  QVERIFY(!d.session().scene().movingPart());
  QCOMPARE(d.failures, QStringList{QStringLiteral("The group could not be taken in hand.")});
}

/// It was started, with nothing to be felt against.
void DesktopGroupInHandTest::aGroupOfAllPartsHasNothingToFeel() {
  PairInHand d;
  d.session().setMovingGroup(d.group);
  const auto* button = d.widget<QPushButton>("startStop");
  const QString why = QStringLiteral("No other part is visible: nothing can be felt.");
  QVERIFY(button->isEnabled());
  const PartId fixed = d.partId("fixed");
  d.session().setVisible(fixed, false);
  QVERIFY(!button->isEnabled());
  QCOMPARE(d.text("whyNotFelt"), why);
  d.session().setVisible(fixed, true);
  QVERIFY(button->isEnabled());
  d.session().deletePart(fixed);
  QVERIFY(!button->isEnabled());
  QCOMPARE(d.text("whyNotFelt"), why);
}

void DesktopGroupInHandTest::itIsSavedAndOpenedAgain() {
  PairInHand d;
  d.session().setMovingGroup(d.group);
  const auto file = d.folder.path() / "pair.nearfit";
  d.session().save(file);
  d.session().reset();
  d.window().document().openFiles({QString::fromStdString(file.string())}, std::nullopt);
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{3});
  const Scene& scene = d.session().scene();
  QVERIFY(scene.movingGroup().has_value());
  QCOMPARE(scene.findGroup(*scene.movingGroup())->name, std::string("Pair"));
  QCOMPARE(scene.movingParts().size(), std::size_t{2});
}

NEARFIT_QT_SUITE(DesktopGroupInHandTest, runDesktopTest<DesktopGroupInHandTest>)
#include "desktop_group_in_hand_test.moc"
