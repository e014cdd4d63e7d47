#include <QColorDialog>
#include <QDoubleSpinBox>
#include <QDropEvent>
#include <QMenu>
#include <QMimeData>
#include <QPointer>
#include <QStatusBar>

#include "tests/app/desktop/desktop_driver.h"
#include "ui/model/parts_model.h"
#include "ui/model/selection.h"

using namespace nearfit;
using namespace nearfit::test;

using Parts = std::vector<PartId>;

/// Three cubes, none in hand, and the tree that shows them.
class Tree : public DesktopDriver {
 public:
  explicit Tree(int count = 3) {
    QStringList files;
    for (int i = 0; i < count; ++i)
      files << fixedFile;
    add(files);
    (void)QTest::qWaitFor([&] { return session().scene().parts().size() == std::size_t(count); });
    for (const Scene::PartPtr& part : session().scene().parts())
      ids.push_back(part->id);
    session().reset(session().scene());
    selection().select(std::nullopt);
  }
  ui::Selection& selection() { return window().selection(); }
  ui::PartsModel& model() { return *qobject_cast<ui::PartsModel*>(partsView()->model()); }
  template <typename Id>
  void click(Id id, Qt::KeyboardModifiers modifiers = {}, int column = ui::PartsModel::Name) {
    QTreeView* view = partsView();
    const QModelIndex index = model().indexOf(id).siblingAtColumn(column);
    view->scrollTo(index);
    QTest::mouseClick(view->viewport(), Qt::LeftButton, modifiers, view->visualRect(index).center());
  }
  void key(Qt::Key key, Qt::KeyboardModifiers modifiers = {}) {
    // There is no window manager that gives it back after a dialog.
    QApplication::setActiveWindow(&window());
    QTest::keyClick(partsView(), key, modifiers);
  }
  /// Puts parts into a new group: by clicks on their rows and the key.
  GroupId group(std::initializer_list<std::size_t> members) {
    for (const std::size_t i : members)
      click(ids[i], i == *members.begin() ? Qt::NoModifier : Qt::ControlModifier);
    key(Qt::Key_G, Qt::ControlModifier);
    return session().scene().groups().back()->id;
  }
  const Part& at(std::size_t i) { return *session().scene().find(ids[i]); }
  std::size_t steps() { return session().historyIndex(); }

  Parts ids;
};

class DesktopTreeTest : public QObject {
  Q_OBJECT

 private slots:
  void groupsAndUngroupsByKeys();
  void aGroupIsSelectedWithAllThatItHolds();
  void severalAreHiddenLockedAndDeletedInOneStepEach();
  void aSwitchOfASelectedRowIsForAllOfThemAndSelectsNothing();
  void isolatesAndShowsExactlyWhatWasVisible();
  void whatIsAddedWhileIsolatedStaysWhenTheRestComesBack();
  void aGroupThatHoldsWhatIsInHandIsDeletedAndComesBackWithIt();
  void aGroupIsRenamedInPlace();
  void aRowIsDroppedOnAGroupAndAtTheTop();
  void severalMoveAsOneByNumberAndByKey();
  void severalBecomeTransparentAndAreCopied();
  void whatAGroupLocksIsLockedForEveryTool();
  void aLockedPartIsColouredAsItIsMadeTransparent();
  void whatIsInHandIsPutDownToBeLocked();
  void whatIsFeltIsNotLockedAndThatIsNoQuestion();
  void aRefusedNameStaysInItsEditorAndSaysWhy();
  void aRefusedNameThatIsLeftChangesNothing();
  void aNameIsLookedForAmongMany();
  void groupsStayClosedThroughChanges();
};

void DesktopTreeTest::groupsAndUngroupsByKeys() {
  Tree d;
  d.click(d.ids[0]);
  d.click(d.ids[2], Qt::ControlModifier);
  d.key(Qt::Key_G, Qt::ControlModifier);
  QCOMPARE(d.session().scene().groups().size(), std::size_t{1});
  const GroupId group = d.session().scene().groups()[0]->id;
  QVERIFY(d.at(0).group == group && !d.at(1).group && d.at(2).group == group);
  QCOMPARE(d.model().rowCount(), 2);
  QCOMPARE(d.model().rowCount(d.model().indexOf(group)), 2);
  QVERIFY(d.partsView()->isExpanded(d.model().indexOf(group)));
  QVERIFY(d.selection().groups() == std::vector{group});
  d.key(Qt::Key_G, Qt::ControlModifier | Qt::ShiftModifier);
  QVERIFY(d.session().scene().groups().empty() && !d.at(0).group);
  d.key(Qt::Key_Z, Qt::ControlModifier);
  QVERIFY(d.at(0).group == group);
}

void DesktopTreeTest::aGroupIsSelectedWithAllThatItHolds() {
  Tree d;
  const GroupId group = d.group({0, 1});
  d.click(group);
  QVERIFY(d.selection().parts() == (Parts{d.ids[0], d.ids[1]}));
  d.click(d.ids[2], Qt::ControlModifier);
  QVERIFY(d.selection().parts() == (Parts{d.ids[0], d.ids[1], d.ids[2]}));
  QVERIFY(d.selection().groups() == std::vector{group});
  d.click(group, Qt::ControlModifier);
  QVERIFY(d.selection().parts() == Parts{d.ids[2]});
}

void DesktopTreeTest::severalAreHiddenLockedAndDeletedInOneStepEach() {
  Tree d;
  d.click(d.ids[0]);
  d.click(d.ids[1], Qt::ShiftModifier);
  d.key(Qt::Key_H);
  QVERIFY(!d.at(0).isVisible && !d.at(1).isVisible && d.at(2).isVisible);
  QCOMPARE(d.steps(), std::size_t{1});
  d.key(Qt::Key_H);
  QVERIFY(d.at(0).isVisible && d.at(1).isVisible);
  d.key(Qt::Key_L, Qt::ControlModifier);
  QVERIFY(d.at(0).isLocked && d.at(1).isLocked && !d.at(2).isLocked);
  QVERIFY(!d.action("remove")->isEnabled());
  d.key(Qt::Key_L, Qt::ControlModifier);
  QCOMPARE(d.steps(), std::size_t{4});
  d.key(Qt::Key_Delete);
  QCOMPARE(d.session().scene().parts().size(), std::size_t{1});
  QCOMPARE(d.steps(), std::size_t{5});
  d.session().undo();
  QCOMPARE(d.session().scene().parts().size(), std::size_t{3});
}

void DesktopTreeTest::aSwitchOfASelectedRowIsForAllOfThemAndSelectsNothing() {
  Tree d;
  d.click(d.ids[0]);
  d.click(d.ids[1], Qt::ControlModifier);
  d.click(d.ids[1], {}, ui::PartsModel::Visible);
  QVERIFY(!d.at(0).isVisible && !d.at(1).isVisible && d.at(2).isVisible);
  d.click(d.ids[2], {}, ui::PartsModel::Locked);
  QVERIFY(!d.at(0).isLocked && d.at(2).isLocked);
  QVERIFY(d.selection().parts() == (Parts{d.ids[0], d.ids[1]}));
}

void DesktopTreeTest::isolatesAndShowsExactlyWhatWasVisible() {
  Tree d;
  d.session().setVisible(d.ids[1], false);
  QVERIFY(!d.action("endIsolation")->isEnabled());
  d.click(d.ids[2]);
  d.key(Qt::Key_I);
  QVERIFY(!d.at(0).isVisible && !d.at(1).isVisible && d.at(2).isVisible);
  d.session().setVisible(d.ids[1], true);
  d.key(Qt::Key_I, Qt::ShiftModifier);
  QVERIFY(d.at(0).isVisible && !d.at(1).isVisible && d.at(2).isVisible);
}

void DesktopTreeTest::whatIsAddedWhileIsolatedStaysWhenTheRestComesBack() {
  Tree d;
  d.session().setVisible(d.ids[1], false);
  d.click(d.ids[2]);
  d.key(Qt::Key_I);
  d.add({d.movingFile});
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{4});
  QVERIFY(d.part("moving").isVisible);
  QVERIFY(!d.at(0).isVisible && !d.at(1).isVisible && d.at(2).isVisible);
  // Not before all of the loading is done.
  QTRY_VERIFY(d.action("endIsolation")->isEnabled());
  d.choose("endIsolation");
  QVERIFY(d.at(0).isVisible && !d.at(1).isVisible && d.at(2).isVisible);
  QVERIFY(d.part("moving").isVisible);
  QVERIFY(!d.action("endIsolation")->isEnabled());
}

void DesktopTreeTest::aGroupThatHoldsWhatIsInHandIsDeletedAndComesBackWithIt() {
  Tree d;
  const GroupId group = d.group({0, 1});
  d.session().setMovingPart(d.ids[0]);
  d.click(group);
  d.key(Qt::Key_Delete);
  QCOMPARE(d.session().scene().parts().size(), std::size_t{1});
  QVERIFY(d.session().scene().groups().empty() && !d.session().scene().movingPart());
  d.key(Qt::Key_Z, Qt::ControlModifier);
  QCOMPARE(d.session().scene().parts().size(), std::size_t{3});
  QVERIFY(d.at(0).group == group && d.at(1).group == group);
  QVERIFY(d.session().scene().movingPart() == d.ids[0]);
}

void DesktopTreeTest::aGroupIsRenamedInPlace() {
  Tree d;
  const GroupId group = d.group({0});
  d.click(group);
  d.choose("rename");
  auto* editor = d.partsView()->findChild<QLineEdit*>();
  QVERIFY(editor != nullptr);
  editor->selectAll();
  QTest::keyClicks(editor, QStringLiteral("Frame"));
  QTest::keyClick(editor, Qt::Key_Return);
  QTRY_COMPARE(d.session().scene().findGroup(group)->name, std::string("Frame"));
}

void DesktopTreeTest::aRowIsDroppedOnAGroupAndAtTheTop() {
  Tree d;
  const GroupId group = d.group({0});
  QTreeView* view = d.partsView();
  const auto drop = [&](PartId part, const QPoint& place) {
    const std::unique_ptr<QMimeData> data(d.model().mimeData({d.model().indexOf(part)}));
    QDragEnterEvent enter(place, Qt::MoveAction, data.get(), Qt::LeftButton, {});
    QApplication::sendEvent(view->viewport(), &enter);
    QDragMoveEvent move(place, Qt::MoveAction, data.get(), Qt::LeftButton, {});
    QApplication::sendEvent(view->viewport(), &move);
    QDropEvent event(place, Qt::MoveAction, data.get(), Qt::LeftButton, {});
    QApplication::sendEvent(view->viewport(), &event);
  };
  drop(d.ids[2], view->visualRect(d.model().indexOf(group)).center());
  QTRY_VERIFY(d.at(2).group == group);
  QVERIFY(d.session().scene().parts().size() == 3);
  drop(d.ids[0], view->viewport()->rect().bottomLeft() + QPoint(20, -5));
  QTRY_VERIFY(!d.at(0).group);
}

void DesktopTreeTest::severalMoveAsOneByNumberAndByKey() {
  Tree d;
  d.session().movePart(d.ids[1], {{1, 0, 0, 0}, {0.1, 0.02, 0}});
  d.click(d.ids[0]);
  d.click(d.ids[1], Qt::ControlModifier);
  QVERIFY(d.text("poseHeading").contains(QStringLiteral("1 more")));
  const std::size_t before = d.steps();
  d.type<QDoubleSpinBox>("positionX", "250");
  QCOMPARE(d.steps(), before + 1);
  QVERIFY(glm::distance(d.at(1).worldFromPart.translation, glm::dvec3(0.25, 0.02, 0)) < 1e-12);
  QVERIFY(glm::distance(d.at(0).worldFromPart.translation, glm::dvec3(0.15, 0, 0)) < 1e-12);
  // A quarter turn takes both about their common centre of mass, as the gizmo's ring does.
  d.type<QDoubleSpinBox>("rotationZ", "90");
  QVERIFY(glm::distance(d.at(0).worldFromPart.translation, glm::dvec3(0.21, -0.04, 0)) < 1e-12);
  QVERIFY(glm::distance(d.at(1).worldFromPart.translation, glm::dvec3(0.19, 0.06, 0)) < 1e-12);
  d.type<QDoubleSpinBox>("nudgeStep", "2");
  d.window().viewport().setFocus();
  pressInView(d, Qt::Key_Right);
  QVERIFY(std::abs(d.at(0).worldFromPart.translation.x - 0.212) < 1e-12);
  QVERIFY(std::abs(d.at(1).worldFromPart.translation.x - 0.192) < 1e-12);
  QVERIFY(d.at(2).worldFromPart.translation == glm::dvec3(0.0));
  d.session().undo();
  d.session().undo();
  d.session().undo();
  QCOMPARE(d.at(0).worldFromPart.translation.x, 0.0);
}

void DesktopTreeTest::severalBecomeTransparentAndAreCopied() {
  Tree d;
  const GroupId group = d.group({0, 1});
  d.click(group);
  QAction* half = nullptr;
  for (QAction* action : d.window().menuBar()->actions().at(1)->menu()->actions()) {
    if (action->menu() != nullptr && half == nullptr)
      half = action->menu()->findChild<QAction*>(QStringLiteral("transparency50"));
  }
  QVERIFY(half != nullptr);
  d.choose(half);
  QCOMPARE(d.at(0).opacity, 0.5);
  QCOMPARE(d.at(1).opacity, 0.5);
  QCOMPARE(d.at(2).opacity, 1.0);
  QVERIFY(half->isChecked());
  d.key(Qt::Key_D, Qt::ControlModifier);
  QCOMPARE(d.session().scene().groups().size(), std::size_t{2});
  QCOMPARE(d.session().scene().parts().size(), std::size_t{5});
  QVERIFY(d.selection().groups() == std::vector{d.session().scene().groups()[1]->id});
}

void DesktopTreeTest::whatAGroupLocksIsLockedForEveryTool() {
  Tree d;
  const GroupId group = d.group({0});
  d.click(group, {}, ui::PartsModel::Locked);
  QVERIFY(d.session().scene().isLocked(d.at(0)));
  d.click(d.ids[0]);
  for (const char* name : {"rename", "remove", "takeInHand"})
    QVERIFY2(!d.action(name)->isEnabled(), name);
  for (const char* field : {"positionX", "rotationZ", "density"})
    QVERIFY2(!d.widget<QDoubleSpinBox>(field)->isEnabled(), field);
}

// Its transparency could be changed, its colour not.
void DesktopTreeTest::aLockedPartIsColouredAsItIsMadeTransparent() {
  Tree d;
  d.session().setLocked(d.ids[0], true);
  d.click(d.ids[0]);
  QVERIFY(d.action("recolour")->isEnabled());
  whenModal<QColorDialog>([](QColorDialog* dialog) {
    dialog->setCurrentColor(QColor(0, 255, 0));
    QTest::mouseClick(dialog->findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Ok), Qt::LeftButton);
  });
  d.choose("recolour");
  QVERIFY(d.at(0).colour == (Colour{0.0F, 1.0F, 0.0F}));
  QVERIFY(d.at(0).isLocked);
  QCOMPARE(d.session().undoText(), std::string("Recolour fixed"));
}

// It was refused in a dialog, also while nothing was felt.
void DesktopTreeTest::whatIsInHandIsPutDownToBeLocked() {
  Tree d;
  QStringList failures;
  d.window().setFailureSink([&](const ui::Failure& failure) { failures << failure.summary; });
  const GroupId group = d.group({0, 1});
  d.session().setMovingPart(d.ids[1]);
  const std::size_t before = d.steps();
  d.click(d.ids[1]);
  d.key(Qt::Key_L, Qt::ControlModifier);
  QVERIFY(d.at(1).isLocked && !d.session().scene().movingPart());
  QVERIFY(d.window().statusBar()->currentMessage().contains(QStringLiteral("no longer in hand")));
  QCOMPARE(d.steps(), before + 1);
  d.session().undo();
  QVERIFY(!d.at(1).isLocked && d.session().scene().movingPart() == d.ids[1]);
  // As well by the lock of its group.
  d.click(group, {}, ui::PartsModel::Locked);
  QVERIFY(d.session().scene().isLocked(d.at(1)) && !d.session().scene().movingPart());
  QVERIFY(failures.isEmpty());
}

void DesktopTreeTest::whatIsFeltIsNotLockedAndThatIsNoQuestion() {
  Tree d;
  QStringList failures;
  d.window().setFailureSink([&](const ui::Failure& failure) { failures << failure.summary; });
  d.session().setMovingPart(d.ids[1]);
  d.click(d.ids[1]);
  d.startWith(ui::Hand::Manual);
  QTRY_VERIFY(d.application.servo().statistics().ticks > 10);
  d.key(Qt::Key_L, Qt::ControlModifier);
  QVERIFY(d.window().statusBar()->currentMessage().contains(QStringLiteral("is being felt: stop (F6)")));
  QVERIFY(!d.at(1).isLocked && d.application.servo().isRunning());
  d.choose("stop");
  QVERIFY(failures.isEmpty());
}

// A dialog said "Another part has it. Where: name", and what was typed was gone.
void DesktopTreeTest::aRefusedNameStaysInItsEditorAndSaysWhy() {
  Tree d;
  QStringList failures;
  d.window().setFailureSink([&](const ui::Failure& failure) { failures << failure.summary; });
  d.session().renamePart(d.ids[0], "wall");
  d.click(d.ids[1]);
  d.choose("rename");
  QPointer<QLineEdit> editor = d.partsView()->findChild<QLineEdit*>();
  QVERIFY(editor != nullptr);
  const std::string before = d.at(1).name;
  editor->selectAll();
  QTest::keyClicks(editor, QStringLiteral("wall"));
  QTest::keyClick(editor, Qt::Key_Return);
  QCOMPARE(d.at(1).name, before);
  QVERIFY(editor != nullptr && editor->isVisible());
  QCOMPARE(editor->text(), QStringLiteral("wall"));
  QCOMPARE(editor->accessibleDescription(),
           QStringLiteral("\"wall\" is the name of another part: choose another name"));
  QTest::keyClicks(editor, QStringLiteral(" 2"));
  QVERIFY(editor->accessibleDescription().isEmpty());
  QTest::keyClick(editor, Qt::Key_Return);
  QTRY_COMPARE(d.at(1).name, std::string("wall 2"));
  QTRY_VERIFY(editor == nullptr);
  QVERIFY(failures.isEmpty());
}

void DesktopTreeTest::aRefusedNameThatIsLeftChangesNothing() {
  Tree d;
  QStringList failures;
  d.window().setFailureSink([&](const ui::Failure& failure) { failures << failure.summary; });
  d.session().renamePart(d.ids[0], "wall");
  const std::size_t before = d.steps();
  const auto type = [&] {
    d.click(d.ids[1]);
    d.choose("rename");
    QPointer<QLineEdit> editor = d.partsView()->findChild<QLineEdit*>();
    editor->selectAll();
    QTest::keyClicks(editor, QStringLiteral("wall"));
    QTest::keyClick(editor, Qt::Key_Return);
    return editor;
  };
  QPointer<QLineEdit> editor = type();
  // It waits while something else has the focus.
  d.window().viewport().setFocus();
  QVERIFY(editor != nullptr && editor->isVisible());
  editor->setFocus();
  QTest::keyClick(editor, Qt::Key_Escape);
  QTRY_VERIFY(editor == nullptr);
  editor = type();
  d.click(d.ids[2]);
  QTRY_VERIFY(editor == nullptr);
  QVERIFY(d.window().statusBar()->currentMessage().contains(QStringLiteral("is the name of another part")));
  QCOMPARE(d.steps(), before);
  QVERIFY(failures.isEmpty());
}

void DesktopTreeTest::aNameIsLookedForAmongMany() {
  Tree d(14);
  const GroupId group = d.session().group({{d.ids[3], d.ids[4]}, {}}, "Frame");
  d.session().renamePart(d.ids[3], "Left bolt");
  auto* filter = d.widget<QLineEdit>("partsFilter");
  QVERIFY(filter->isVisible());
  const auto isHidden = [&](const QModelIndex& i) { return d.partsView()->isRowHidden(i.row(), i.parent()); };
  QTest::keyClicks(filter, QStringLiteral("bolt"));
  QVERIFY(!isHidden(d.model().indexOf(d.ids[3])) && !isHidden(d.model().indexOf(group)));
  QVERIFY(isHidden(d.model().indexOf(d.ids[4])) && isHidden(d.model().indexOf(d.ids[0])));
  // A change of the scene shows nothing that does not match.
  d.session().renamePart(d.ids[5], "Right bolt");
  QVERIFY(!isHidden(d.model().indexOf(d.ids[5])) && isHidden(d.model().indexOf(d.ids[6])));
  filter->clear();
  for (const PartId id : d.ids)
    QVERIFY(!isHidden(d.model().indexOf(id)));
}

void DesktopTreeTest::groupsStayClosedThroughChanges() {
  Tree d;
  const GroupId group = d.group({0});
  d.partsView()->collapse(d.model().indexOf(group));
  d.session().duplicatePart(d.ids[1]);
  QVERIFY(!d.partsView()->isExpanded(d.model().indexOf(group)));
}

NEARFIT_QT_SUITE(DesktopTreeTest, runDesktopTest<DesktopTreeTest>)
#include "desktop_tree_test.moc"
