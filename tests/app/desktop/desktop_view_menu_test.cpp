#include <QDockWidget>
#include <QMenu>

#include "tests/app/desktop/menus.h"
#include "tests/app/desktop/view_pointer.h"
#include "ui/model/parts_model.h"
#include "ui/model/selection.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

/// A place of the front view on each of the cubes, and one beside both.
const glm::dvec3 kFixed(-0.01, -0.02, 0.005), kMoving(0.003, -0.01, 0.036), kBeside(0.03, 0.0, 0.04);

struct Pointer : ViewPointer {
  explicit Pointer(DesktopDriver& d) : ViewPointer(d) {
    d.addCubes();
    d.window().selection().select(std::nullopt);
    look("viewFront");
  }
  /// Opens the menu, and again when it closes at once.
  template <class Open>
  static void openMenu(const Open& open) {
    openPatiently([&] {
      open();
      return QTest::qWaitFor([] { return menu() != nullptr; }, kUntilTheNextTryMs);
    });
  }
  void rightClick(const glm::dvec3& point) {
    openMenu([&] { QTest::mouseClick(&view(), Qt::RightButton, {}, seen(point)); });
  }
  static QMenu* menu() {
    auto* menu = qobject_cast<QMenu*>(QApplication::activePopupWidget());
    return menu != nullptr && menu->objectName() == QStringLiteral("viewMenu") ? menu : nullptr;
  }
  static void choose(QAction* action) { clickEntry(*menu(), action); }
};

}  // namespace

class DesktopViewMenuTest : public QObject {
  Q_OBJECT

 private slots:
  void aRightClickOpensTheMenuOfThePartThatItSelects();
  void aRightClickOnASelectedPartKeepsAllThatIsSelected();
  void besideAllPartsItOffersToSelectAndFit();
  void aRightDragZoomsAndOpensNothing();
  void theMenuKeyOpensItToo();
  void renameHasAKeyAndBringsTheTreeUp();
};

void DesktopViewMenuTest::aRightClickOpensTheMenuOfThePartThatItSelects() {
  DesktopDriver d;
  Pointer pointer(d);
  pointer.rightClick(kFixed);
  QVERIFY(pointer.menu() != nullptr);
  QVERIFY(d.window().selection().parts() == std::vector{d.partId("fixed")});
  for (const char* name : {"takeInHand", "rename", "duplicate", "toggleVisible", "toggleLock", "remove"}) {
    QVERIFY2(pointer.menu()->actions().contains(d.action(name)), name);
    QVERIFY2(d.action(name)->isShortcutVisibleInContextMenu(), name);
    QVERIFY2(!d.action(name)->shortcut().isEmpty(), name);
  }
  pointer.choose(d.action("toggleVisible"));
  QTRY_VERIFY(!d.part("fixed").isVisible);
  QTRY_VERIFY(pointer.menu() == nullptr);
}

void DesktopViewMenuTest::aRightClickOnASelectedPartKeepsAllThatIsSelected() {
  DesktopDriver d;
  Pointer pointer(d);
  const std::vector<PartId> both{d.partId("fixed"), d.partId("moving")};
  d.window().selection().set(both);
  pointer.rightClick(kFixed);
  QVERIFY(pointer.menu() != nullptr);
  QVERIFY(d.window().selection().parts() == both);
  QTest::keyClick(pointer.menu(), Qt::Key_Escape);
  QTRY_VERIFY(pointer.menu() == nullptr);
}

void DesktopViewMenuTest::besideAllPartsItOffersToSelectAndFit() {
  DesktopDriver d;
  Pointer pointer(d);
  pointer.rightClick(kBeside);
  QVERIFY(pointer.menu() != nullptr);
  QVERIFY(!pointer.menu()->actions().contains(d.action("remove")));
  pointer.choose(d.action("selectAll"));
  QTRY_COMPARE(d.window().selection().parts().size(), std::size_t{2});
}

void DesktopViewMenuTest::aRightDragZoomsAndOpensNothing() {
  DesktopDriver d;
  Pointer pointer(d);
  const double before = pointer.view().projection().metresPerPixel({0.0, 0.0, 0.0});
  const QPoint from = pointer.seen(kFixed);
  QTest::mousePress(&pointer.view(), Qt::RightButton, {}, from);
  for (int i = 1; i <= 10; ++i) {
    const QPoint at = from + QPoint(0, -8 * i);
    QMouseEvent move(QEvent::MouseMove, at, pointer.view().mapToGlobal(at), Qt::NoButton, Qt::RightButton,
                     {});
    QApplication::sendEvent(&pointer.view(), &move);
  }
  QTest::mouseRelease(&pointer.view(), Qt::RightButton, {}, from + QPoint(0, -80));
  QVERIFY(std::abs(pointer.view().projection().metresPerPixel({0.0, 0.0, 0.0}) / before - 1.0) > 0.05);
  QTest::qWait(100);
  QVERIFY(pointer.menu() == nullptr);
  QVERIFY(d.window().selection().isEmpty());
}

void DesktopViewMenuTest::theMenuKeyOpensItToo() {
  DesktopDriver d;
  Pointer pointer(d);
  d.window().selection().select(d.partId("moving"));
  pointer.openMenu([&] {
    const QPoint middle = pointer.view().rect().center();
    QContextMenuEvent event(QContextMenuEvent::Keyboard, middle, pointer.view().mapToGlobal(middle));
    QApplication::sendEvent(&pointer.view(), &event);
  });
  QVERIFY(pointer.menu() != nullptr);
  QVERIFY(pointer.menu()->actions().contains(d.action("remove")));
  QTest::keyClick(pointer.menu(), Qt::Key_Escape);
}

void DesktopViewMenuTest::renameHasAKeyAndBringsTheTreeUp() {
  DesktopDriver d;
  Pointer pointer(d);
  pointer.click(kMoving);
  d.widget<QDockWidget>("historyDock")->raise();
  pointer.view().setFocus();
  pressShortcut(d, Qt::Key_F2);
  QTRY_VERIFY(d.partsView()->isVisible());
  auto* editor = d.partsView()->findChild<QLineEdit*>();
  QVERIFY(editor != nullptr);
  editor->selectAll();
  QTest::keyClicks(editor, QStringLiteral("Lid"));
  QTest::keyClick(editor, Qt::Key_Return);
  QTRY_VERIFY(d.session().scene().findByName("Lid") != nullptr);
}

NEARFIT_QT_SUITE(DesktopViewMenuTest, runDesktopTest<DesktopViewMenuTest>)
#include "desktop_view_menu_test.moc"
