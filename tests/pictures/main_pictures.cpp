// nearfit-pictures FOLDER light|dark: pictures of the window at work, of each panel, menu and dialog, by the
// real application; those whose names begin with "guide-" stand in the guide. resources/scripts/pictures
// runs it in both themes and at two scales.
#include <QAbstractButton>
#include <QAbstractItemView>
#include <QComboBox>
#include <QDialog>
#include <QDir>
#include <QDockWidget>
#include <QDoubleSpinBox>
#include <QFile>
#include <QMenu>
#include <QMenuBar>
#include <QPainter>
#include <QTabWidget>
#include <QTableView>
#include <QToolButton>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "core/path/path_file.h"
#include "core/recovery/recovery_folder.h"
#include "core/servo/motion_recording.h"
#include "tests/app/desktop/desktop_driver.h"
#include "tests/app/desktop/dialog_answers.h"
#include "tests/app/desktop/fake_device.h"
#include "tests/support/places.h"
#include "ui/files/recovery/recovery.h"
#include "ui/files/unit_dialog.h"
#include "ui/model/selection.h"
#include "ui/widgets/error_box.h"
#include "ui/widgets/paths.h"
#include "ui/widgets/progress_dialog.h"
#include "ui/widgets/theme.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

constexpr std::size_t kDemoParts = 4;
constexpr int kSettleMs = 350;  ///< For layout, and the pictures of the view that follow.
/// Ticks of the scripted hand until it presses and turns.
constexpr std::uint64_t kFeelFor = 2450;
/// Where the sensor on the housing is drawn [m].
constexpr glm::dvec3 kSensor(0.02, 0.0, 0.03);

/// The box of a part along the world's axes.
Aabb worldBounds(const Part& part) {
  Aabb box;
  for (const glm::dvec3& vertex : part.geometry->mesh.vertices())
    box.add(part.worldFromPart.applyToPoint(vertex));
  return box;
}

class Pictures {
 public:
  explicit Pictures(const QString& folder) : folder_(folder) {
    driver_.window().setFailureSink([this](const ui::Failure& failure) {
      std::fprintf(stderr, "nearfit-pictures: %s %s\n", qPrintable(failure.summary),
                   qPrintable(failure.details));
      ++failures_;
    });
    QObject::connect(&driver_.application.servo(), &desktop::ServoController::snapshotArrived,
                     &driver_.application, [this](const ServoSnapshot& snapshot) { tick_ = snapshot.tick; });
    driver_.window().resize(1280, 800);
  }

  bool takeAll() {
    atFirst();
    showDemo();
    atWork();
    placing();
    inspecting();
    narrow();
    menus();
    dialogs();
    presets();
    feeling();
    recording();
    device();
    verdicts();
    documents();
    return failures_ == 0;
  }

 private:
  void settle() { QTest::qWait(kSettleMs); }
  void grab(QWidget& widget, const QString& name) {
    settle();
    savePicture(widget.grab(), name);
  }
  void savePicture(const QPixmap& picture, const QString& name) {
    const QString file = QDir(folder_).filePath(name + QStringLiteral(".png"));
    if (picture.save(file, "PNG")) return;
    std::fprintf(stderr, "nearfit-pictures: %s cannot be written\n", qPrintable(file));
    ++failures_;
  }
  void grabWindow(const char* name) { grab(driver_.window(), QLatin1String(name)); }
  void trigger(const char* action) {
    QAction* wanted = driver_.action(action);
    if (wanted != nullptr && wanted->isEnabled()) {
      wanted->trigger();
    } else {
      std::fprintf(stderr, "nearfit-pictures: %s cannot be done\n", action);
      ++failures_;
    }
  }
  template <class Condition>
  void wait(Condition&& isTrue, const char* what) {
    if (QTest::qWaitFor(isTrue, 60'000)) return;
    std::fprintf(stderr, "nearfit-pictures: waited for %s in vain\n", what);
    ++failures_;
  }
  /// The window with a card before it, as the screen has them.
  void grabWindowWith(QWidget& card, const char* name) {
    settle();
    QPixmap picture = driver_.window().grab();
    QPainter painter(&picture);
    const QRect place(driver_.window().mapFromGlobal(card.mapToGlobal(QPoint(0, 0))), card.size());
    painter.drawPixmap(place.topLeft(), card.grab());
    // There is no window manager that frames it.
    painter.setPen(card.palette().color(QPalette::Mid));
    painter.drawRect(place);
    painter.end();
    savePicture(picture, QLatin1String(name));
  }
  /// What `open` opens, a modal dialog, once `fill` has filled it in; closed again.
  void grabDialog(const QString& name, const std::function<void()>& open,
                  const std::function<void(QDialog&)>& fill = {}) {
    const auto wasThere = std::make_shared<bool>(false);
    whenModal<QDialog>([this, wasThere, name, fill](QDialog* dialog) {
      *wasThere = true;
      if (fill) fill(*dialog);
      grab(*dialog, QStringLiteral("dialog-") + name);
      dialog->reject();
    });
    open();
    wait([&] { return *wasThere; }, qPrintable(name));
  }

  void atFirst() {
    grabWindow("window-first");
    // It opens the demo.
    trigger("tour");
    auto* tour = driver_.widget<QFrame>("tour");
    wait([&] { return tour->isVisible(); }, "the tour");
    for (int stop = 1; tour->isVisible() && stop < 20; ++stop) {
      grab(driver_.window(), QStringLiteral("tour-%1").arg(stop));
      QTest::mouseClick(driver_.widget<QPushButton>("tourNext"), Qt::LeftButton);
    }
  }
  void showDemo() {
    driver_.window().selection().select(driver_.session().scene().movingPart());
    trigger("fitSelection");
    grabWindow("window-demo");
  }
  void atWork() {
    for (QDockWidget* dock : driver_.window().findChildren<QDockWidget*>()) {
      const bool wasVisible = dock->isVisible();
      dock->show();
      dock->raise();
      grab(*dock, QStringLiteral("panel-") + dock->objectName());
      if (!wasVisible) dock->hide();
    }
  }
  void placing() {
    for (const char* tool : {"gizmoMove", "gizmoTurn", "gizmoMoveAndTurn"}) {
      trigger(tool);
      grabWindow(tool);
    }
    grabWindow("guide-place");
    trigger("align");
    grabWindow("window-align");
    QTest::keyClick(&driver_.window(), Qt::Key_Escape);
  }
  void inspecting() {
    ui::Viewport& view = driver_.window().viewport();
    // What is measured shows best with nothing over it.
    driver_.window().selection().select({});
    trigger("measure");
    const Part& moving = *driver_.session().scene().find(*driver_.session().scene().movingPart());
    const Aabb& box = moving.geometry->mesh.bounds();
    for (const double y : {box.lower.y, box.upper.y}) {
      const auto pixel =
          view.projection().pixelOf(moving.worldFromPart.applyToPoint({box.centre().x, y, box.upper.z}));
      if (pixel) QTest::mouseClick(&view, Qt::LeftButton, {}, {qRound(pixel->x), qRound(pixel->y)});
      settle();
    }
    grabWindow("window-measure");
    trigger("measure");
    trigger("section");
    QTest::mouseClick(driver_.widget<QAbstractButton>("sectionX"), Qt::LeftButton);
    grabWindow("guide-section");
    trigger("section");
    driver_.window().selection().select({moving.id});
  }
  /// As on a small laptop: what the toolbars have no room for is behind a button.
  void narrow() {
    const QSize before = driver_.window().size();
    driver_.window().resize(1024, 700);
    grabWindow("window-narrow");
    driver_.window().resize(before);
  }
  void menus() {
    for (QMenu* menu : driver_.window().findChildren<QMenu*>()) {
      if (menu->isEmpty()) continue;
      const QString title = menu->title().isEmpty() ? menu->actions().first()->objectName() : menu->title();
      menu->popup(driver_.window().mapToGlobal(QPoint(40, 40)));
      grab(*menu, QStringLiteral("menu-") +
                      QString(title).remove('&').remove(QStringLiteral("…")).replace(' ', '-'));
      menu->hide();
    }
  }
  void grabFailure(const QString& name, const ui::Failure& failure) {
    ui::showFailure(failure, &driver_.window());
    auto* box = driver_.widget<QDialog>("errorBox");
    grab(*box, QStringLiteral("dialog-") + name);
    delete box;
  }
  void failures() {
    grabFailure(QStringLiteral("error"),
                {QStringLiteral("The scene could not be opened."),
                 QStringLiteral("/home/ada/lift/bracket.nearfit: line 41: \"mesh\" names no file; write the "
                                "path of a mesh file, relative to the scene")});
    QVector<ui::FailedItem> files;
    for (int i = 1; i <= 8; ++i) {
      files << ui::FailedItem{QStringLiteral("bracket-%1.stl").arg(i),
                              QStringLiteral("It ends within triangle %1.").arg(117 * i),
                              QStringLiteral("Export it again from the program that it comes from."),
                              {}};
    }
    grabFailure(QStringLiteral("errors"),
                ui::describeItems(QStringLiteral("8 of 34 files could not be loaded. The others were added."),
                                  files));
  }
  void dialogs() {
    ui::MainWindow& window = driver_.window();
    grabDialog(QStringLiteral("export"), [this] { trigger("exportPlacement"); });
    grabDialog(QStringLiteral("picture"), [this] { trigger("savePicture"); });
    grabDialog(QStringLiteral("about"), [this] { trigger("about"); });
    const QString mesh = ui::fromPath(driver_.session().scene().parts().front()->geometry->file);
    grabDialog(QStringLiteral("unit"), [&] { ui::askForUnit({mesh}, {}, &window); });
    failures();
    trigger("duplicate");
    grabDialog(QStringLiteral("unsaved"), [&] { window.close(); });
    trigger("undo");
    auto* progress =
        new ui::ProgressDialog(QStringLiteral("Loading"), QStringLiteral("Loading bracket.stl…"), &window);
    progress->show();
    progress->setFraction(0.4);
    grab(*progress, QStringLiteral("dialog-progress"));
    progress->hide();
    progress->deleteLater();
    LostWork lost;
    lost.head = {"/home/ada/lift/bracket.nearfit", 12, 5};
    lost.time = std::chrono::system_clock::now() - std::chrono::minutes(7);
    auto* recovery = new ui::RecoveryDialog({lost}, &window);
    recovery->show();
    grab(*recovery, QStringLiteral("dialog-recovery"));
    recovery->close();
    trigger("shortcuts");
    auto* shortcuts = driver_.widget<QDialog>("shortcutsDialog");
    grab(*shortcuts, QStringLiteral("dialog-shortcuts"));
    shortcuts->close();
    trigger("feelSettings");
    auto* feel = driver_.widget<QDialog>("feelDialog");
    auto* tabs = feel->findChild<QTabWidget*>(QStringLiteral("feelTabs"));
    for (int tab = 0; tabs != nullptr && tab < tabs->count(); ++tab) {
      tabs->setCurrentIndex(tab);
      grab(*feel, QStringLiteral("dialog-feel-%1").arg(tab + 1));
    }
    feel->close();
  }
  void presets() {
    auto* choice = driver_.window().findChild<QPushButton*>(QStringLiteral("presetMenu"));
    const auto command = [choice](const char* name) {
      for (QAction* action : choice->menu()->actions()) {
        if (action->objectName() == QLatin1String(name)) action->trigger();
      }
    };
    grabDialog(QStringLiteral("preset-name"), [&] { command("savePreset"); });
    whenModal<QDialog>([](QDialog* dialog) { dialog->accept(); });
    command("savePreset");
    grabDialog(QStringLiteral("preset-delete"), [&] { command("deletePreset"); });
  }
  void feeling() {
    driver_.window().selection().select(driver_.session().scene().movingPart());
    trigger("gizmoNone");
    driver_.chooseHand(ui::Hand::Scripted);
    trigger("start");
    wait([this] { return tick_ > kFeelFor; }, "the scripted hand");
    grabWindow("guide-main-window");
    // Side by side, as by a drag of the title.
    auto* plots = driver_.widget<QDockWidget>("plotsDock");
    driver_.window().addDockWidget(Qt::BottomDockWidgetArea, plots, Qt::Horizontal);
    for (QDockWidget* dock : {driver_.widget<QDockWidget>("clearanceDock"), plots})
      dock->show();
    wait([this] { return tick_ > 2 * kFeelFor; }, "its next turn");
    grabWindow("guide-clearances");
    atWork();
    trigger("stop");
    // A part that overlaps is said to.
    driver_.window().selection().select(driver_.session().scene().movingPart());
    trigger("duplicate");
    tick_ = 0;
    trigger("start");
    wait([this] { return tick_ > kFeelFor; }, "the scripted hand again");
    grabWindow("window-overlapping");
    trigger("stop");
  }

  /// What was felt, played again.
  void recording() {
    const std::string file = (driver_.folder.path() / "felt.csv").string();
    MotionWriter writer(file);
    const Part& moving = *driver_.session().scene().find(*driver_.session().scene().movingPart());
    for (int i = 0; i <= 2000; ++i) {
      MotionRow row;
      row.time = 1e-3 * i;
      row.proxy = row.handle = moving.worldFromPart;
      row.proxy.translation.z += 0.01 * std::sin(3e-3 * i);
      row.wrench.force = {std::sin(3e-3 * i), 0.3 * std::cos(7e-3 * i), std::cos(3e-3 * i)};
      row.wrench.torque = 0.01 * row.wrench.force;
      row.distance = 2e-3 + 1e-3 * std::cos(3e-3 * i);
      row.tickTime = 40e-6;
      row.lateness = 12e-6;
      writer.write(row);
    }
    writer.finish();
    whenModal<QFileDialog>([&](QFileDialog* dialog) { chooseFile(dialog, QString::fromStdString(file)); });
    trigger("openRecording");
    auto* name = driver_.widget<QLabel>("timelineName");
    wait([&] { return name->isVisible(); }, "the recording");
    grabWindow("window-replay");
    QTest::mouseClick(driver_.widget<QAbstractButton>("timelineClose"), Qt::LeftButton);
  }
  /// Each state of a device that is plugged in.
  void device() {
    devices_->devices = {
        {QStringLiteral("arm"), QStringLiteral("OpenHap at bus 1"), {}, true},
        {QStringLiteral("other"), QStringLiteral("Novint Falcon at bus 2"),
         QStringLiteral("You have no permission to open it: see resources/docs/devices.md."), false}};
    driver_.application.watcher().poll();
    // Room for all of the panel, and nothing that overlaps.
    for (const char* dock : {"clearanceDock", "plotsDock", "timelineDock"})
      driver_.widget<QDockWidget>(dock)->hide();
    while (driver_.session().scene().parts().size() > kDemoParts)
      trigger("undo");
    const QSize before = driver_.window().size();
    driver_.window().resize(before.width(), 960);
    auto* hand = driver_.widget<QComboBox>("hand");
    hand->showPopup();
    grab(*hand->view()->window(), QStringLiteral("list-hands"));
    hand->hidePopup();
    hand->setFocus();
    const int wanted = hand->findText(devices_->devices.first().name);
    for (int keys = 0; keys < 10 && hand->currentIndex() != wanted; ++keys)
      QTest::keyClick(hand, Qt::Key_Down);
    auto* dock = driver_.widget<QDockWidget>("feelDock");
    const auto feel = [&](const char* name) {
      trigger("start");
      wait([&] { return driver_.application.servo().isRunning(); }, "the device");
      QTest::qWait(1000);
      grab(*dock, QLatin1String(name));
    };
    devices_->handle->needsCalibration = true;
    feel("panel-feel-uncalibrated");
    trigger("stop");
    devices_->handle->needsCalibration = false;
    feel("panel-feel-device");
    QTest::mouseClick(driver_.widget<QPushButton>("arm"), Qt::LeftButton);
    QTest::qWait(500);
    grab(*dock, QStringLiteral("panel-feel-armed"));
    trigger("clutch");
    grab(*dock, QStringLiteral("panel-feel-clutched"));
    grabWindow("window-device");
    devices_->handle->isFaulty = true;
    QTest::qWait(500);
    grab(*dock, QStringLiteral("panel-feel-fault"));
    trigger("stop");
    driver_.window().resize(before);
  }

  void press(const char* button) {
    QTest::mouseClick(driver_.widget<QAbstractButton>(button), Qt::LeftButton);
  }
  void expectNone(const DialogAnswers& answers) {
    for (const QString& fault : answers.faults()) {
      std::fprintf(stderr, "nearfit-pictures: not as expected: %s\n", qPrintable(fault));
      ++failures_;
    }
  }
  /// A box as a mesh file of this name; size and centre in metres.
  QString boxFile(const char* name, const glm::dvec3& size, const glm::dvec3& centre) {
    return writeOff(driver_.folder.path() / (std::string(name) + ".off"), boxMesh(size, centre));
  }

  /// A housing, a plug that is 5 mm deep in its side, a cover that stands on it, and a sensor that is clear of them.
  void openHousing() {
    driver_.session().reset();
    driver_.add({boxFile("Housing", {0.08, 0.05, 0.02}, {0.0, 0.0, 0.0}),
                 boxFile("Plug", {0.02, 0.016, 0.012}, {0.045, 0.0, 0.0}),
                 boxFile("Cover", {0.04, 0.04, 0.006}, {-0.015, 0.0, 0.013}),
                 boxFile("Sensor", {0.01, 0.01, 0.01}, kSensor)});
    wait([this] { return driver_.session().scene().parts().size() == 4; }, "the housing");
    driver_.session().setMovingPart(driver_.partId("Sensor"));
    driver_.session().save(driver_.folder.path() / "housing.nearfit");
    driver_.window().selection().select(std::nullopt);
    driver_.partsView()->expandAll();
    trigger("viewIso");
    trigger("fit");
    settle();
  }
  /// *Check scene*, the suggestion of a path, a path with its clearance, and a report.
  void verdicts() {
    openHousing();
    sceneCheck();
    report();
    suggestion();
    certifiedPath();
  }
  void sceneCheck() {
    trigger("checkScene");
    auto* table = driver_.widget<QTableView>("sceneCheckTable");
    wait([&] { return table->isVisible(); }, "the panel of checks");
    driver_.type<QDoubleSpinBox>("sceneCheckThreshold", "10 mm");
    press("runSceneCheck");
    wait([&] { return table->model()->rowCount() == 2; }, "the check of the scene");
    // The worst comes first. Its place is framed over a while.
    QTest::mouseClick(table->viewport(), Qt::LeftButton, {},
                      table->visualRect(table->model()->index(0, 0)).center());
    auto* label = driver_.window().viewport().findChild<QLabel*>(QStringLiteral("pairLabel"));
    wait([&] { return label->isVisible(); }, "the mark of the clash");
    QTest::qWait(1000);
    grabWindow("guide-check-scene");
    atWork();
    grabDialog(QStringLiteral("rules"), [this] { press("ruleForPair"); });
    grabDialog(
        QStringLiteral("accept"), [this] { press("acceptFinding"); },
        [](QDialog& dialog) {
          QTest::keyClicks(dialog.findChild<QLineEdit*>(QStringLiteral("acceptReason")),
                           QStringLiteral("Pressed in, then glued"));
        });
    trigger("fit");
  }
  /// The page goes beside the pictures, for a browser.
  void report() {
    grabDialog(QStringLiteral("report"), [this] { trigger("report"); });
    const QString page = QDir(QDir(folder_).absolutePath()).filePath(QStringLiteral("report.html"));
    QFile::remove(page);
    DialogAnswers answers;
    answers.expectButton(QStringLiteral("reportDialog"), QDialogButtonBox::Save).expectFile(page);
    trigger("report");
    wait([&] { return QFile::exists(page); }, "the report");
    expectNone(answers);
  }
  /// The sensor was put down in front of the housing: the way to where it was drawn.
  void suggestion() {
    driver_.widget<QDockWidget>("sceneCheckDock")->hide();
    driver_.session().movePart(driver_.partId("Sensor"), {{1, 0, 0, 0}, {0.0, -0.05, -0.03}});
    trigger("fit");
    const auto wantDrawn = [](QDialog& dialog) {
      // A click beside its text chooses nothing.
      auto* drawn = dialog.findChild<QRadioButton*>(QStringLiteral("suggestToDrawn"));
      QTest::mouseClick(drawn, Qt::LeftButton, {}, QPoint(10, drawn->height() / 2));
    };
    grabDialog(QStringLiteral("suggest"), [this] { trigger("suggestPath"); }, wantDrawn);
    DialogAnswers answers;
    answers.expect(QStringLiteral("suggestDialog"), [&](QDialog& dialog) {
      wantDrawn(dialog);
      QTest::mouseClick(dialog.findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Ok), Qt::LeftButton);
      return true;
    });
    trigger("suggestPath");
    const auto card = [this] { return driver_.widget<QDialog>("suggestionCard"); };
    wait([&] { return card() != nullptr && card()->isVisible(); }, "a suggestion");
    expectNone(answers);
    if (card() == nullptr) return;
    // The ghost is on its way.
    QTest::qWait(1200);
    grabWindowWith(*card(), "guide-suggested-path");
    card()->reject();
    wait([&] { return card() == nullptr; }, "the end of the suggestion");
    trigger("undo");
  }
  /// The sensor comes down beside the cover, to 2 mm from it and 3 mm from the housing; certified.
  void certifiedPath() {
    const glm::dvec3 corners[] = {{0.005, 0.0, 0.0}, {0.005, 0.0, -0.012}, {-0.008, 0.0, -0.012}};
    constexpr int kPosesOfLeg = 40;
    AssemblyPath path;
    path.parts = {"Sensor"};
    path.centre = kSensor;
    for (int i = 0; i <= 2 * kPosesOfLeg; ++i) {
      const int leg = std::min(i / kPosesOfLeg, 1);
      const double share = static_cast<double>(i) / kPosesOfLeg - leg;
      path.poses.push_back({0.05 * i, {{1, 0, 0, 0}, glm::mix(corners[leg], corners[leg + 1], share)}});
    }
    const std::filesystem::path file = driver_.folder.path() / "sensor.nfpath";
    writePathFile(path, file);
    {
      DialogAnswers answers;
      answers.expectFile(ui::fromPath(file));
      trigger("openRecording");
      auto* name = driver_.widget<QLabel>("timelineName");
      wait([&] { return name->isVisible() && name->text() == QStringLiteral("sensor.nfpath"); }, "the path");
      expectNone(answers);
    }
    trigger("plotPathClearance");
    wait(
        [this] {
          return driver_.action("certifyPath")->isEnabled() &&
                 !driver_.text("timelineNote").contains(QStringLiteral("Clearance –"));
        },
        "the clearance along the path");
    grabDialog(QStringLiteral("save-path"), [this] { trigger("savePath"); });
    grabDialog(QStringLiteral("swept-volume"), [this] { trigger("exportSwept"); });
    grabDialog(QStringLiteral("certify"), [this] { trigger("certifyPath"); });
    DialogAnswers answers;
    answers.expectButton(QStringLiteral("certifyDialog"), QDialogButtonBox::Ok);
    trigger("certifyPath");
    wait([this] { return !driver_.text("timelineResult").isEmpty(); }, "the certificate");
    expectNone(answers);
    grabWindow("guide-path");
    QTest::mouseClick(driver_.widget<QAbstractButton>("timelineClose"), Qt::LeftButton);
    driver_.widget<QDockWidget>("timelineDock")->hide();
  }

  /// Opens a file of the models beside the repository in a scene of its own.
  bool openModel(const char* name) {
    const std::filesystem::path file = test::sharedFolder() / "models" / "public" / name;
    if (!std::filesystem::exists(file)) {
      std::fprintf(stderr, "nearfit-pictures: %s is missing\n", file.c_str());
      ++failures_;
      return false;
    }
    driver_.session().reset();
    driver_.window().document().openFiles({ui::fromPath(file)});
    wait([&] { return !driver_.session().scene().parts().empty(); }, name);
    driver_.partsView()->expandAll();
    driver_.window().selection().select(std::nullopt);
    trigger("fit");
    settle();
    return true;
  }
  /// STEP files: the tree that they bring, and a part of it in hand.
  void documents() {
    if (openModel("trimesh_box_assembly.STEP")) {
      grabWindow("guide-assembly");
      // The lid, lifted by a few millimetres and led down on the walls.
      const Part lid = driver_.part("box_top");
      RigidTransform pose = lid.worldFromPart;
      pose.translation.z += 8e-3;
      driver_.session().movePart(lid.id, pose);
      driver_.session().setMovingPart(lid.id);
      driver_.window().selection().select(lid.id);
      tick_ = 0;
      driver_.startWith(ui::Hand::Manual);
      pose.translation.z -= 4e-3;
      driver_.application.servo().moveHand(pose);
      wait([this] { return tick_ > 500; }, "the lid in hand");
      grabWindow("guide-assembly-felt");
      trigger("stop");
    }
    if (openModel("steptools_vise.stp")) {
      grabWindow("guide-vise");
      feelVise();
    }
  }
  /// A block is added to the vise, led down on it until it stops, and all is saved and opened again.
  void feelVise() {
    const Part vise = *driver_.session().scene().parts().front();
    const Aabb box = worldBounds(vise);
    const glm::dvec3 size(0.3 * glm::distance(box.lower, box.upper) * glm::dvec3(1.0, 1.0, 0.3));
    const double gap = 0.1 * size.z;
    const glm::dvec3 above(box.centre().x, box.centre().y, box.upper.z + gap + 0.5 * size.z);
    driver_.add({boxFile("Block", size, above)});
    wait([this] { return driver_.session().scene().parts().size() == 2; }, "the block");
    driver_.session().setMovingPart(driver_.partId("Block"));
    driver_.window().selection().select(driver_.partId("Block"));
    trigger("fit");
    tick_ = 0;
    driver_.startWith(ui::Hand::Manual);
    // Step by step, as a hand does, and at last by a quarter of the gap too far.
    constexpr int kSteps = 25;
    for (int i = 1; i <= kSteps; ++i) {
      RigidTransform hand;
      hand.translation.z = -1.25 * gap * i / kSteps;
      driver_.application.servo().moveHand(hand);
      const std::uint64_t then = tick_ + 40;
      wait([&] { return tick_ > then; }, "the block in hand");
    }
    wait([&] { return driver_.felt && driver_.felt->translation.z < -0.9 * gap; }, "the block at contact");
    grabWindow("guide-vise-felt");
    trigger("stop");
    const std::filesystem::path file = driver_.folder.path() / "vise.nearfit";
    driver_.session().save(file);
    driver_.session().reset();
    driver_.window().document().openFiles({ui::fromPath(file)});
    wait([this] { return driver_.session().scene().parts().size() == 2; }, "the vise that was saved");
    driver_.partsView()->expandAll();
    trigger("fit");
    grabWindow("guide-vise-reopened");
  }

  QString folder_;
  FakeSource* devices_ = new FakeSource;  ///< The driver's.
  DesktopDriver driver_{std::unique_ptr<desktop::DeviceSource>(devices_)};
  std::uint64_t tick_ = 0;
  int failures_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  const TemporaryFolder settings;
  desktop::Application::prepare();
  QSettings::setPath(QSettings::IniFormat, QSettings::UserScope,
                     QString::fromStdString(settings.path().string()));
  QCoreApplication::setAttribute(Qt::AA_DontUseNativeDialogs);
  QApplication qt(argc, argv);
  const QStringList arguments = QCoreApplication::arguments();
  if (arguments.size() != 3 ||
      (arguments[2] != QStringLiteral("light") && arguments[2] != QStringLiteral("dark"))) {
    std::fprintf(stderr, "usage: nearfit-pictures FOLDER light|dark\n");
    return 2;
  }
  desktop::Application::configure();
  ui::setColourScheme(arguments[2] == QStringLiteral("dark") ? ui::ColourScheme::Dark
                                                             : ui::ColourScheme::Light);
  if (!QDir().mkpath(arguments[1])) {
    std::fprintf(stderr, "nearfit-pictures: %s cannot be made\n", qPrintable(arguments[1]));
    return 1;
  }
  return Pictures(arguments[1]).takeAll() ? 0 : 1;
}
