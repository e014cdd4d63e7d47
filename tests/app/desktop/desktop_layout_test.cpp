// How the user has arranged the window comes back in the next one; and no dialog has a field without a name.
#include <QAbstractSpinBox>
#include <QCheckBox>
#include <QDockWidget>
#include <QGuiApplication>
#include <QHeaderView>
#include <QScreen>
#include <QScrollArea>
#include <QScrollBar>
#include <QTableView>
#include <algorithm>

#include "tests/app/desktop/desktop_driver.h"
#include "ui/files/export/export_dialog.h"
#include "ui/files/export/picture_dialog.h"
#include "ui/panels/feel/feel_dialog.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

/// A window as a run of the program shows it: of the size that it has itself.
struct Run {
  Run() {
    application.window().show();
    (void)QTest::qWaitForWindowExposed(&application.window());
    QApplication::setActiveWindow(&application.window());
  }
  ui::MainWindow& window() { return application.window(); }
  QDockWidget* dock(const char* name) { return window().findChild<QDockWidget*>(QLatin1String(name)); }
  QAction* action(const char* name) { return window().findChild<QAction*>(QLatin1String(name)); }
  void choose(const char* name) { chooseCommand(window(), action(name)); }
  /// Ends the run as a user does.
  void close() { QVERIFY(window().close()); }

  desktop::Application application{std::make_unique<NoDevices>()};
};

/// A mouse that is pressed on a dock's title, and let go over another place of the window.
void dragDock(QMainWindow& window, QDockWidget* dock, const QPoint& to) {
  const QPoint title(40, 8);
  const auto send = [&](QEvent::Type type, const QPoint& global, Qt::MouseButtons held) {
    const bool isMove = type == QEvent::MouseMove;
    const QPoint local = dock->mapFromGlobal(global);
    QMouseEvent event(type, local, window.mapFromGlobal(global), global,
                      isMove ? Qt::NoButton : Qt::LeftButton, held, {});
    QApplication::sendEvent(dock, &event);
    QCoreApplication::processEvents();
  };
  const QPoint from = dock->mapToGlobal(title), end = window.mapToGlobal(to);
  send(QEvent::MouseButtonPress, from, Qt::LeftButton);
  for (int i = 1; i <= 20; ++i)
    send(QEvent::MouseMove, from + (end - from) * i / 20, Qt::LeftButton);
  send(QEvent::MouseMove, end, Qt::LeftButton);
  send(QEvent::MouseButtonRelease, end, Qt::NoButton);
}

/// The piece of a widget that its parents and the window leave to be seen, in the window. Unlike visibleRegion() it has
/// what the widget's own children cover: of a table that is all but the frame.
QRect seenOf(const QWidget& widget) {
  QRect seen = widget.isVisible() ? widget.rect() : QRect();
  for (const QWidget* w = &widget; !w->isWindow(); w = w->parentWidget())
    seen = seen.translated(w->pos()) & w->parentWidget()->rect();
  return seen;
}

/// Of a dialog, the fields that a screen reader has no name for.
QStringList namelessFields(const QWidget& dialog) {
  const QList<QLabel*> labels = dialog.findChildren<QLabel*>();
  QStringList nameless;
  for (const QWidget* field : dialog.findChildren<QWidget*>()) {
    const bool isField = qobject_cast<const QLineEdit*>(field) != nullptr ||
                         qobject_cast<const QAbstractSpinBox*>(field) != nullptr ||
                         qobject_cast<const QComboBox*>(field) != nullptr ||
                         qobject_cast<const QCheckBox*>(field) != nullptr;
    // What a spin box or a list types in is reached through it.
    const QWidget* parent = field->parentWidget();
    const bool isPiece = qobject_cast<const QAbstractSpinBox*>(parent) != nullptr ||
                         qobject_cast<const QComboBox*>(parent) != nullptr;
    if (!isField || isPiece || !field->accessibleName().isEmpty()) continue;
    const auto* box = qobject_cast<const QCheckBox*>(field);
    if (box != nullptr && !box->text().isEmpty()) continue;
    // A label may speak for a row of which this is the field.
    const auto speaks = [field, &dialog](const QLabel* label) {
      if (label->buddy() == nullptr || label->text().isEmpty()) return false;
      for (const QWidget* w = field; w != nullptr && w != &dialog; w = w->parentWidget()) {
        if (label->buddy() == w && (w == field || w->focusProxy() == field)) return true;
      }
      return false;
    };
    if (std::none_of(labels.begin(), labels.end(), speaks))
      nameless << QLatin1String(field->metaObject()->className()) + QChar(' ') + field->objectName();
  }
  return nameless;
}

int fieldCount(const QWidget& dialog) {
  return static_cast<int>(dialog.findChildren<QComboBox*>().size() +
                          dialog.findChildren<QLineEdit*>().size() +
                          dialog.findChildren<QRadioButton*>().size());
}

}  // namespace

class DesktopLayoutTest : public QObject {
  Q_OBJECT

 private slots:
  void init() { QSettings().clear(); }
  void cleanup() { ui::setColourScheme(ui::ColourScheme::Light); }
  void theFirstWindowIsOfItsUsualSizeWhereThereIsRoom();
  void theSizeOfTheWindowComesBack();
  void aWindowLargerThanItsScreenIsFittedToIt();
  void aScreenOf1600By1000IsEnoughAtScaleTwo();
  void panelsAtTheBottomScrollInASmallWindow();
  void aSmallWindowShowsTwoRowsOfClearancesAndAPieceOfThePlots();
  void aPanelOpensWithRoomForItsButtons_data();
  void aPanelOpensWithRoomForItsButtons();
  void aHeightThatTheUserGivesAPanelStays();
  void whatIsHiddenAndMovedComesBack();
  void theThemeComesBack();
  void dialogsThatAreMadeOnDemandHaveNoNamelessField_data();
  void dialogsThatAreMadeOnDemandHaveNoNamelessField();
};

void DesktopLayoutTest::theFirstWindowIsOfItsUsualSizeWhereThereIsRoom() {
  const QSize usual(1360, 860), room = QGuiApplication::primaryScreen()->availableSize();
  QVERIFY(room.width() >= usual.width() && room.height() >= usual.height() + 40);
  Run run;
  QCOMPARE(run.window().size(), usual);
  run.close();
}

void DesktopLayoutTest::theSizeOfTheWindowComesBack() {
  QSize usual;
  const auto isOfSize = [](Run& run, const QSize& size) {
    return QTest::qWaitFor([&] { return run.window().size() == size; }, kQtPatienceMs);
  };
  {
    Run run;
    usual = run.window().size();
    run.window().resize(usual - QSize(70, 60));
    QVERIFY(isOfSize(run, usual - QSize(70, 60)));
    run.close();
  }
  {
    Run run;
    QVERIFY(isOfSize(run, usual - QSize(70, 60)));
    run.window().resize(usual - QSize(30, 90));
    QVERIFY(isOfSize(run, usual - QSize(30, 90)));
    run.close();
  }
  Run run;
  QVERIFY(isOfSize(run, usual - QSize(30, 90)));
  run.close();
}

void DesktopLayoutTest::aWindowLargerThanItsScreenIsFittedToIt() {
  const QRect room = QGuiApplication::primaryScreen()->availableGeometry();
  {
    Run run;
    run.window().resize(room.size() + QSize(400, 300));
    QTRY_VERIFY(run.window().width() > room.width());
    run.close();
  }
  Run run;
  QVERIFY2(run.window().width() <= room.width() && run.window().height() <= room.height(),
           qPrintable(QStringLiteral("%1 x %2").arg(run.window().width()).arg(run.window().height())));
}

/// The panels' least sizes made the window larger than that.
void DesktopLayoutTest::aScreenOf1600By1000IsEnoughAtScaleTwo() {
  constexpr QSize kRoom(800, 464);  ///< Without the title bar.
  Run run;
  run.window().resize(kRoom);
  QTRY_COMPARE(run.window().size(), kRoom);
  // The last number in the status bar is the one to keep.
  auto* distance = run.window().findChild<QWidget*>(QStringLiteral("statusDistance"));
  QTRY_VERIFY(!run.window().findChild<QWidget*>(QStringLiteral("statusRate"))->isVisible());
  QVERIFY(distance->isVisible());
  const auto shown = [&] { return QRect(distance->mapTo(&run.window(), QPoint()), distance->size()); };
  QTRY_VERIFY2(run.window().rect().contains(shown()), qPrintable(QString::number(shown().right())));
  run.window().resize(1360, 860);
  QTRY_VERIFY(run.window().findChild<QWidget*>(QStringLiteral("statusRate"))->isVisible());
  run.close();
}

/// They made the window larger than the screen, and *Repair* was out of reach.
void DesktopLayoutTest::panelsAtTheBottomScrollInASmallWindow() {
  constexpr QSize kRoom(800, 464);  ///< Without the title bar.
  Run run;
  run.window().resize(kRoom);
  QTRY_COMPARE(run.window().size(), kRoom);
  const struct {
    const char *dock, *pane, *content;
  } panels[] = {{"checkDock", "checkScroll", "repairPart"},
                {"sceneCheckDock", "sceneCheckScroll", "exportSceneCheck"},
                {"clearanceMapDock", "clearanceMapScroll", "exportClearanceMap"},
                {"clearanceDock", "clearanceScroll", "clearanceTable"},
                {"plotsDock", "plotsScroll", "plotView"}};
  for (const auto& panel : panels) {
    QDockWidget* dock = run.dock(panel.dock);
    chooseCommand(run.window(), panelEntry(dock));
    QTRY_VERIFY(dock->isVisible());
    // The window would grow once the panel is laid out.
    QTest::qWait(100);
    QVERIFY2(run.window().size() == kRoom, panel.dock);
    auto* scroll = dock->findChild<QScrollArea*>(QLatin1String(panel.pane));
    auto* content = dock->findChild<QWidget*>(QLatin1String(panel.content));
    QVERIFY2(scroll != nullptr && content != nullptr, panel.dock);
    scroll->ensureWidgetVisible(content);
    // Two lines of text, or a button whole.
    const QRect seen = seenOf(*content);
    const int needed = std::min(content->height(), 2 * content->fontMetrics().lineSpacing());
    QVERIFY2(seen.width() >= needed && seen.height() >= needed,
             qPrintable(QStringLiteral("%1: %2 x %3 of %4 x %5")
                            .arg(QLatin1String(panel.content))
                            .arg(seen.width())
                            .arg(seen.height())
                            .arg(content->width())
                            .arg(content->height())));
    dock->close();
    QTRY_VERIFY(!dock->isVisible());
  }
  run.close();
}

/// The view's least height left the header and 25 pixels of the plots.
void DesktopLayoutTest::aSmallWindowShowsTwoRowsOfClearancesAndAPieceOfThePlots() {
  constexpr QSize kRoom(800, 464);  ///< Without the title bar.
  constexpr int kLeastOfPlots = 60;
  Run run;
  run.window().resize(kRoom);
  QTRY_COMPARE(run.window().size(), kRoom);
  const auto open = [&run](const char* name, const char* pane, QWidget& content) {
    QDockWidget* dock = run.dock(name);
    chooseCommand(run.window(), panelEntry(dock));
    // Once the panel is laid out.
    (void)QTest::qWaitFor([dock] { return dock->isVisible(); }, kQtPatienceMs);
    QTest::qWait(100);
    dock->findChild<QScrollArea*>(QLatin1String(pane))->ensureWidgetVisible(&content);
  };
  auto& table = *run.dock("clearanceDock")->findChild<QTableView*>(QStringLiteral("clearanceTable"));
  open("clearanceDock", "clearanceScroll", table);
  const int rows = table.horizontalHeader()->height() + 2 * table.verticalHeader()->defaultSectionSize();
  QTRY_VERIFY2(seenOf(table).height() >= rows, qPrintable(QString::number(seenOf(table).height())));
  run.dock("clearanceDock")->close();
  auto& plots = *run.dock("plotsDock")->findChild<QWidget*>(QStringLiteral("plotView"));
  open("plotsDock", "plotsScroll", plots);
  QTRY_VERIFY2(seenOf(plots).height() >= kLeastOfPlots, qPrintable(QString::number(seenOf(plots).height())));
  QCOMPARE(run.window().size(), kRoom);
  run.close();
}

void DesktopLayoutTest::aPanelOpensWithRoomForItsButtons_data() {
  QTest::addColumn<QSize>("size");
  QTest::addColumn<bool>("isAfterAnother");
  QTest::newRow("screen of 1600 x 1000") << QSize(1600, 981) << false;
  QTest::newRow("in a tab beside another") << QSize(1600, 981) << true;
  QTest::newRow("usual size") << QSize(1360, 860) << false;
}

/// *Scene check* hid its lowest row of buttons, below a table that scrolled too.
void DesktopLayoutTest::aPanelOpensWithRoomForItsButtons() {
  QFETCH(QSize, size);
  QFETCH(bool, isAfterAnother);
  Run run;
  run.window().resize(size);
  QTRY_COMPARE(run.window().size(), size);
  if (isAfterAnother) {
    chooseCommand(run.window(), panelEntry(run.dock("checkDock")));
    QTRY_VERIFY(run.dock("checkDock")->isVisible());
  }
  QDockWidget* dock = run.dock("sceneCheckDock");
  chooseCommand(run.window(), panelEntry(dock));
  const auto* scroll = dock->findChild<QScrollArea*>(QStringLiteral("sceneCheckScroll"));
  for (const char* name :
       {"runSceneCheck", "acceptFinding", "fixFinding", "ruleForPair", "exportSceneCheck"}) {
    const auto* button = dock->findChild<QPushButton*>(QLatin1String(name));
    QTRY_VERIFY2(button->isVisible() && seenOf(*button).size() == button->size(), name);
  }
  QTRY_COMPARE(scroll->verticalScrollBar()->maximum(), 0);
  // The view stays the larger.
  QVERIFY(dock->height() < size.height() / 2);
  QCOMPARE(run.window().size(), size);
  run.close();
}

/// A panel gets its height once, not whenever it is asked for.
void DesktopLayoutTest::aHeightThatTheUserGivesAPanelStays() {
  Run run;
  QDockWidget* dock = run.dock("sceneCheckDock");
  const auto* scroll = dock->findChild<QScrollArea*>(QStringLiteral("sceneCheckScroll"));
  chooseCommand(run.window(), panelEntry(dock));
  QTRY_VERIFY(dock->isVisible() && scroll->widget()->height() >= scroll->widget()->sizeHint().height());
  const int before = dock->height();
  run.window().resizeDocks({dock}, {before + 60}, Qt::Vertical);
  QTRY_COMPARE(dock->height(), before + 60);
  // The table gives way, so that nothing else scrolls.
  QTRY_COMPARE(scroll->verticalScrollBar()->maximum(), 0);
  // Asks for the panel that is shown already.
  run.choose("checkScene");
  QTest::qWait(100);
  QCOMPARE(dock->height(), before + 60);
  run.close();
}

void DesktopLayoutTest::whatIsHiddenAndMovedComesBack() {
  {
    Run run;
    QDockWidget* feel = run.dock("feelDock");
    QCOMPARE(run.window().dockWidgetArea(feel), Qt::RightDockWidgetArea);
    dragDock(run.window(), feel, {8, run.window().height() / 2});
    QTRY_COMPARE(run.window().dockWidgetArea(feel), Qt::LeftDockWidgetArea);
    QTRY_VERIFY(!feel->isFloating());
    run.dock("poseDock")->close();
    // By its entry in the menu: it is behind a tab first.
    chooseCommand(run.window(), panelEntry(run.dock("historyDock")));
    QTRY_VERIFY(!run.dock("historyDock")->visibleRegion().isEmpty());
    QVERIFY(run.dock("historyDock")->isVisible());
    chooseCommand(run.window(), panelEntry(run.dock("historyDock")));
    QTRY_VERIFY(!run.dock("historyDock")->isVisible());
    run.close();
  }
  Run run;
  QCOMPARE(run.window().dockWidgetArea(run.dock("feelDock")), Qt::LeftDockWidgetArea);
  QVERIFY(run.dock("feelDock")->isVisible() && run.dock("partsDock")->isVisible());
  QVERIFY(!run.dock("poseDock")->isVisible() && !run.dock("historyDock")->isVisible());
  QVERIFY(!run.dock("historyDock")->toggleViewAction()->isChecked());
  run.choose("resetLayout");
  QTRY_COMPARE(run.window().dockWidgetArea(run.dock("feelDock")), Qt::RightDockWidgetArea);
  QVERIFY(run.dock("poseDock")->isVisible());
  run.close();
}

void DesktopLayoutTest::theThemeComesBack() {
  // The desktop of these tests is light.
  const struct {
    const char* action;
    bool isDark;
  } themes[] = {{"themeDark", true}, {"themeSystem", false}, {"themeDark", true}, {"themeLight", false}};
  for (const auto& theme : themes) {
    {
      Run run;
      run.choose(theme.action);
      QVERIFY(run.action(theme.action)->isChecked());
      QCOMPARE(ui::isThemeDark(), theme.isDark);
      run.close();
    }
    // As the program does when it starts.
    desktop::Application::configure();
    Run run;
    for (const char* other : {"themeDark", "themeLight", "themeSystem"})
      QCOMPARE(run.action(other)->isChecked(), QLatin1String(other) == QLatin1String(theme.action));
    QCOMPARE(ui::isThemeDark(), theme.isDark);
    QCOMPARE(run.window().palette().color(QPalette::Window).lightness() < 128, theme.isDark);
    run.close();
  }
}

namespace {

/// Opens a dialog in one way, and hands it over.
using Look = std::function<void(QDialog*)>;
struct Opening {
  const char* name;
  void (*open)(DesktopDriver&, const Look&);
};

template <class Dialog>
void choosing(DesktopDriver& d, const char* command, const char* name, const Look& look) {
  whenModal<Dialog>(
      [look](Dialog* dialog) {
        look(dialog);
        QTest::keyClick(dialog, Qt::Key_Escape);
      },
      QLatin1String(name));
  d.choose(command);
}

const Opening kOpenings[] = {
    {"unit of length",
     [](DesktopDriver& d, const Look& look) {
       whenModal<QFileDialog>([&d, look](QFileDialog* files) {
         whenModal<QDialog>(
             [look](QDialog* dialog) {
               look(dialog);
               QTest::keyClick(dialog, Qt::Key_Escape);
             },
             QStringLiteral("unitDialog"));
         chooseFile(files, d.fixedFile);
       });
       d.choose("addParts");
     }},
    {"export",
     [](DesktopDriver& d, const Look& look) {
       choosing<ui::ExportDialog>(d, "exportPlacement", "exportDialog", look);
     }},
    {"picture",
     [](DesktopDriver& d, const Look& look) {
       choosing<ui::PictureDialog>(d, "savePicture", "pictureDialog", look);
     }},
    {"feel settings",
     [](DesktopDriver& d, const Look& look) {
       d.choose("feelSettings");
       auto* dialog = d.widget<ui::FeelDialog>("feelDialog");
       QTRY_VERIFY(dialog->isVisible());
       look(dialog);
     }},
    {"name of a preset",
     [](DesktopDriver& d, const Look& look) {
       d.choose("feelSettings");
       auto* button = d.widget<QPushButton>("presetMenu");
       QTRY_VERIFY(button->isVisible());
       whenModal<QDialog>(
           [look](QDialog* dialog) {
             look(dialog);
             QTest::keyClick(dialog, Qt::Key_Escape);
           },
           QStringLiteral("presetNameDialog"));
       // The button waits until its menu is gone.
       QTimer::singleShot(0, button->menu(), [menu = button->menu(), entry = d.action("savePreset")] {
         QVERIFY(QTest::qWaitFor([menu] { return menu->isVisible(); }));
         clickEntry(*menu, entry);
       });
       QTest::mouseClick(button, Qt::LeftButton);
     }},
};

}  // namespace

void DesktopLayoutTest::dialogsThatAreMadeOnDemandHaveNoNamelessField_data() {
  QTest::addColumn<int>("row");
  for (std::size_t i = 0; i < std::size(kOpenings); ++i)
    QTest::newRow(kOpenings[i].name) << static_cast<int>(i);
}

void DesktopLayoutTest::dialogsThatAreMadeOnDemandHaveNoNamelessField() {
  QFETCH(int, row);
  DesktopDriver d;
  d.addCubes();
  int fields = 0;
  QStringList nameless;
  kOpenings[row].open(d, [&](QDialog* dialog) {
    fields = fieldCount(*dialog);
    nameless = namelessFields(*dialog);
  });
  QTRY_VERIFY(fields > 0);
  QVERIFY2(nameless.isEmpty(), qPrintable(nameless.join(QStringLiteral(", "))));
}

NEARFIT_QT_SUITE(DesktopLayoutTest, runDesktopTest<DesktopLayoutTest>)
#include "desktop_layout_test.moc"
