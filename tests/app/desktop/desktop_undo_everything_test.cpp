// Each command for parts and groups, given as a user gives it: one step, taken back and done again exactly.
#include <QColorDialog>
#include <QDropEvent>
#include <QMimeData>
#include <QTabBar>
#include <QTabWidget>
#include <algorithm>
#include <array>

#include "tests/app/desktop/desktop_driver.h"
#include "ui/model/parts_model.h"
#include "ui/model/selection.h"
#include "ui/widgets/number_field.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

/// Cubes a, b and c, and d in a group, each with something of its own, and the tree that shows them.
struct UndoDesk : DesktopDriver {
  UndoDesk() {
    add({fixedFile, fixedFile, fixedFile, movingFile});
    [&] { QTRY_COMPARE(session().scene().parts().size(), std::size_t{4}); }();
    const char* const names[] = {"a", "b", "c", "d"};
    for (std::size_t i = 0; i < ids.size(); ++i) {
      ids[i] = session().scene().parts()[i]->id;
      session().renamePart(ids[i], names[i]);
      session().movePart(ids[i], {{1, 0, 0, 0}, {0.1 * double(i), 0.01, -0.02}});
    }
    session().setOpacity({ids[1]}, 0.75);
    session().setVisible(ids[2], false);
    session().setDensity(ids[0], 7850.0);
    frame = session().group({{ids[3]}, {}}, "Frame");
    session().setMovingPart(ids[0]);
    window().selection().select(std::nullopt);
  }
  ui::PartsModel& model() { return *qobject_cast<ui::PartsModel*>(partsView()->model()); }
  template <typename Id>
  void click(Id id, Qt::KeyboardModifiers modifiers = {}) {
    const QModelIndex index = model().indexOf(id);
    partsView()->scrollTo(index);
    QTest::mouseClick(partsView()->viewport(), Qt::LeftButton, modifiers,
                      partsView()->visualRect(index).center());
  }
  /// The first two, by their rows.
  void clickTwo() {
    click(ids[0]);
    click(ids[1], Qt::ControlModifier);
  }
  void key(Qt::Key key, Qt::KeyboardModifiers modifiers = {}) {
    QApplication::setActiveWindow(&window());
    partsView()->setFocus();
    QTest::keyClick(partsView(), key, modifiers);
  }
  /// Types a name into the row's editor, which F2 opens.
  void rename(const char* name) {
    key(Qt::Key_F2);
    auto* editor = partsView()->findChild<QLineEdit*>();
    if (editor == nullptr) throw Error("rename", "no editor has come");
    editor->selectAll();
    QTest::keyClicks(editor, QLatin1String(name));
    QTest::keyClick(editor, Qt::Key_Return);
  }
  /// As a drag ends that began on a part's row.
  void drop(PartId part, const QPoint& place) {
    QWidget* rows = partsView()->viewport();
    const std::unique_ptr<QMimeData> data(model().mimeData({model().indexOf(part)}));
    QDragEnterEvent enter(place, Qt::MoveAction, data.get(), Qt::LeftButton, {});
    QApplication::sendEvent(rows, &enter);
    QDragMoveEvent move(place, Qt::MoveAction, data.get(), Qt::LeftButton, {});
    QApplication::sendEvent(rows, &move);
    QDropEvent event(place, Qt::MoveAction, data.get(), Qt::LeftButton, {});
    QApplication::sendEvent(rows, &event);
  }
  void becomeGreen() {
    whenModal<QColorDialog>([](QColorDialog* dialog) {
      dialog->setCurrentColor(QColor(0, 255, 0));
      QTest::mouseClick(dialog->findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Ok), Qt::LeftButton);
    });
    choose("recolour");
  }
  void chooseTransparency(const char* name) {
    for (QAction* entry : menuBarActions()) {
      QMenu* menu = entry->menu();
      if (menu == nullptr || menu->objectName() != QLatin1String("transparencyMenu")) continue;
      return choose(menu->findChild<QAction*>(QLatin1String(name)));
    }
    throw Error("transparency", "no menu has it");
  }
  /// The feel settings, at a tab of theirs.
  void openFeel(int tab) {
    choose("feelSettings");
    auto* tabs = widget<QTabWidget>("feelTabs");
    QTRY_VERIFY(tabs->isVisible());
    QTest::mouseClick(tabs->tabBar(), Qt::LeftButton, {}, tabs->tabBar()->tabRect(tab).center());
    QCOMPARE(tabs->currentIndex(), tab);
  }
  /// The entries of all menus of the bar.
  QList<QAction*> menuBarActions() {
    QList<QAction*> entries;
    for (const QAction* menu : window().menuBar()->actions())
      entries << menu->menu()->actions();
    return entries;
  }
  const Scene& scene() { return session().scene(); }
  const Part& at(std::size_t i) { return *scene().find(ids[i]); }

  std::array<PartId, 4> ids{};
  GroupId frame{};
};

struct Command {
  const char* name;
  void (*prepare)(UndoDesk&);  ///< None: nothing.
  void (*give)(UndoDesk&);
  bool (*isDone)(UndoDesk&);
};

const Command kCommands[] = {
    {"a part is renamed", nullptr,
     [](UndoDesk& d) {
       d.click(d.ids[1]);
       d.rename("bracket");
     },
     [](UndoDesk& d) { return d.at(1).name == "bracket"; }},
    {"a group is renamed", nullptr,
     [](UndoDesk& d) {
       d.click(d.frame);
       d.rename("Housing");
     },
     [](UndoDesk& d) { return d.scene().findGroup(d.frame)->name == "Housing"; }},
    {"a part is coloured", nullptr,
     [](UndoDesk& d) {
       d.click(d.ids[0]);
       d.becomeGreen();
     },
     [](UndoDesk& d) { return d.at(0).colour == Colour{0, 1, 0} && d.at(1).colour != Colour{0, 1, 0}; }},
    {"several are coloured", nullptr,
     [](UndoDesk& d) {
       d.clickTwo();
       d.becomeGreen();
     },
     [](UndoDesk& d) { return d.at(0).colour == Colour{0, 1, 0} && d.at(1).colour == Colour{0, 1, 0}; }},
    {"several become transparent", nullptr,
     [](UndoDesk& d) {
       d.clickTwo();
       d.chooseTransparency("transparency50");
     },
     [](UndoDesk& d) { return d.at(0).opacity == 0.5 && d.at(1).opacity == 0.5 && d.at(2).opacity == 1.0; }},
    {"several are hidden", nullptr,
     [](UndoDesk& d) {
       d.clickTwo();
       d.key(Qt::Key_H);
     },
     [](UndoDesk& d) { return !d.at(0).isVisible && !d.at(1).isVisible && d.at(3).isVisible; }},
    {"a hidden part is shown", nullptr,
     [](UndoDesk& d) {
       d.click(d.ids[2]);
       d.key(Qt::Key_H);
     },
     [](UndoDesk& d) { return d.at(2).isVisible; }},
    {"a part is locked", nullptr,
     [](UndoDesk& d) {
       d.click(d.ids[1]);
       d.key(Qt::Key_L, Qt::ControlModifier);
     },
     [](UndoDesk& d) { return d.at(1).isLocked && !d.at(0).isLocked; }},
    {"a group is locked", nullptr,
     [](UndoDesk& d) {
       d.click(d.frame);
       d.key(Qt::Key_L, Qt::ControlModifier);
     },
     [](UndoDesk& d) { return d.scene().isLocked(d.at(3)) && !d.at(3).isLocked; }},
    {"a part is isolated", nullptr,
     [](UndoDesk& d) {
       d.click(d.ids[1]);
       d.key(Qt::Key_I);
     },
     [](UndoDesk& d) { return d.scene().isIsolated() && !d.at(0).isVisible && d.at(1).isVisible; }},
    {"isolation ends",
     [](UndoDesk& d) {
       d.click(d.ids[1]);
       d.key(Qt::Key_I);
     },
     [](UndoDesk& d) { d.key(Qt::Key_I, Qt::ShiftModifier); },
     [](UndoDesk& d) { return !d.scene().isIsolated() && d.at(0).isVisible && !d.at(2).isVisible; }},
    {"several are duplicated", nullptr,
     [](UndoDesk& d) {
       d.clickTwo();
       d.key(Qt::Key_D, Qt::ControlModifier);
     },
     [](UndoDesk& d) { return d.scene().parts().size() == 6; }},
    {"a group is duplicated", nullptr,
     [](UndoDesk& d) {
       d.click(d.frame);
       d.key(Qt::Key_D, Qt::ControlModifier);
     },
     [](UndoDesk& d) { return d.scene().groups().size() == 2 && d.scene().parts().size() == 5; }},
    {"several are grouped", nullptr,
     [](UndoDesk& d) {
       d.clickTwo();
       d.key(Qt::Key_G, Qt::ControlModifier);
     },
     [](UndoDesk& d) { return d.at(0).group && d.at(0).group == d.at(1).group && !d.at(2).group; }},
    {"a group is taken apart", nullptr,
     [](UndoDesk& d) {
       d.click(d.frame);
       d.key(Qt::Key_G, Qt::ControlModifier | Qt::ShiftModifier);
     },
     [](UndoDesk& d) { return d.scene().groups().empty() && !d.at(3).group; }},
    {"a part is dropped on a group", nullptr,
     [](UndoDesk& d) { d.drop(d.ids[1], d.partsView()->visualRect(d.model().indexOf(d.frame)).center()); },
     [](UndoDesk& d) { return d.at(1).group == d.frame; }},
    {"a part is dropped beside the groups", nullptr,
     [](UndoDesk& d) { d.drop(d.ids[3], d.partsView()->viewport()->rect().bottomLeft() + QPoint(20, -5)); },
     [](UndoDesk& d) { return !d.at(3).group && d.scene().findGroup(d.frame) != nullptr; }},
    {"several are deleted, the one in hand among them", nullptr,
     [](UndoDesk& d) {
       d.clickTwo();
       d.key(Qt::Key_Delete);
     },
     [](UndoDesk& d) { return d.scene().parts().size() == 2 && !d.scene().movingPart(); }},
    {"a group is deleted", nullptr,
     [](UndoDesk& d) {
       d.click(d.frame);
       d.key(Qt::Key_Delete);
     },
     [](UndoDesk& d) { return d.scene().groups().empty() && d.scene().parts().size() == 3; }},
    {"several get a density", nullptr,
     [](UndoDesk& d) {
       d.clickTwo();
       d.type<ui::NumberField>("density", "2700");
     },
     [](UndoDesk& d) { return d.at(0).density == 2700.0 && d.at(1).density == 2700.0; }},
    {"a number of the feel is typed", [](UndoDesk& d) { d.openFeel(0); },
     [](UndoDesk& d) { d.type<ui::NumberField>("friction", "0.2"); },
     [](UndoDesk& d) { return d.scene().haptics().proxy.friction == 0.2; }},
    {"a motion of the hand is locked", [](UndoDesk& d) { d.openFeel(2); },
     [](UndoDesk& d) {
       auto* box = d.widget<QAbstractButton>("lockX");
       QTest::mouseClick(box, Qt::LeftButton, {}, QPoint(8, box->height() / 2));
     },
     [](UndoDesk& d) { return bool(d.scene().haptics().mapping.translationLocks[0]); }},
};

/// Whether nothing at all is different.
bool isExactly(const Scene& a, const Scene& b) {
  const auto sameParts = [](const Scene::PartPtr& x, const Scene::PartPtr& y) { return isSame(*x, *y); };
  const auto sameGroups = [](const Scene::GroupPtr& x, const Scene::GroupPtr& y) { return *x == *y; };
  return std::ranges::equal(a.parts(), b.parts(), sameParts) &&
         std::ranges::equal(a.groups(), b.groups(), sameGroups) && a.movingPart() == b.movingPart() &&
         a.haptics() == b.haptics();
}

}  // namespace

class DesktopUndoEverythingTest : public QObject {
  Q_OBJECT

 private slots:
  void eachCommandIsOneStepThatIsTakenBackAndDoneAgainExactly_data();
  void eachCommandIsOneStepThatIsTakenBackAndDoneAgainExactly();
};

void DesktopUndoEverythingTest::eachCommandIsOneStepThatIsTakenBackAndDoneAgainExactly_data() {
  QTest::addColumn<int>("row");
  for (std::size_t i = 0; i < std::size(kCommands); ++i)
    QTest::newRow(kCommands[i].name) << static_cast<int>(i);
}

void DesktopUndoEverythingTest::eachCommandIsOneStepThatIsTakenBackAndDoneAgainExactly() {
  QFETCH(int, row);
  const Command& command = kCommands[row];
  UndoDesk d;
  QStringList failures;
  d.window().setFailureSink([&](const ui::Failure& failure) { failures << failure.summary; });
  if (command.prepare != nullptr) command.prepare(d);
  const Scene before = d.scene();
  const std::size_t steps = d.session().historyIndex();
  QVERIFY(!command.isDone(d));

  command.give(d);
  QTRY_COMPARE(d.session().historyIndex(), steps + 1);
  QVERIFY(command.isDone(d));
  const Scene after = d.scene();
  QVERIFY(!isExactly(after, before));
  const QString label = QString::fromStdString(d.session().undoText());
  QVERIFY(!label.isEmpty());

  for (const auto& [key, modifiers] : {std::pair(Qt::Key_Y, Qt::KeyboardModifiers(Qt::ControlModifier)),
                                       std::pair(Qt::Key_Z, Qt::ControlModifier | Qt::ShiftModifier)}) {
    pressShortcut(d, Qt::Key_Z, Qt::ControlModifier);
    QCOMPARE(d.session().historyIndex(), steps);
    QVERIFY(isExactly(d.scene(), before));
    QCOMPARE(QString::fromStdString(d.session().redoText()), label);
    pressShortcut(d, key, modifiers);
    QCOMPARE(d.session().historyIndex(), steps + 1);
    QVERIFY(isExactly(d.scene(), after));
  }
  // Nothing more lies behind it.
  QVERIFY(!d.session().canRedo());
  QVERIFY2(failures.isEmpty(), qPrintable(failures.join('\n')));
}

NEARFIT_QT_SUITE(DesktopUndoEverythingTest, runDesktopTest<DesktopUndoEverythingTest>)
#include "desktop_undo_everything_test.moc"
