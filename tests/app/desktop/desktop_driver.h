#pragma once

#include <QAbstractItemModel>
#include <QAction>
#include <QApplication>
#include <QComboBox>
#include <QDialogButtonBox>
#include <QFileDialog>
#include <QLabel>
#include <QLineEdit>
#include <QListView>
#include <QPushButton>
#include <QRadioButton>
#include <QSettings>
#include <QTimer>
#include <QTreeView>
#include <QtTest>
#include <cmath>
#include <fstream>
#include <functional>
#include <numbers>
#include <optional>

#include "app/desktop/application.h"
#include "core/base/error.h"
#include "core/mesh/triangle_mesh.h"
#include "tests/app/desktop/menus.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/qt/qt_patience.h"
#include "tests/support/qt/qt_suite.h"
#include "tests/support/temporary_folder.h"
#include "ui/files/document.h"
#include "ui/model/selection.h"
#include "ui/view3d/viewport.h"
#include "ui/widgets/theme.h"

/// Drives the desktop application as a user does: by its widgets, with real events.
namespace nearfit::test {

/// Runs a Qt Test object with the QApplication set up as the program does; settings go to a temporary folder.
template <class Test>
int runDesktopTest(int argc, char** argv) {
  const TemporaryFolder settings;
  desktop::Application::prepare();
  QSettings::setPath(QSettings::IniFormat, QSettings::UserScope,
                     QString::fromStdString(settings.path().string()));
  QCoreApplication::setAttribute(Qt::AA_DontUseNativeDialogs);
  QApplication qt(argc, argv);
  desktop::Application::configure();
  Test test;
  return QTest::qExec(&test, argc, argv);
}

constexpr double kDegree = std::numbers::pi / 180.0;  ///< [rad]

inline bool isNear(double a, double b, double tolerance) {
  return std::abs(a - b) <= tolerance;
}

/// Extent of a part's mesh along its x axis [m].
inline double widthOf(const Part& part) {
  const Aabb& box = part.geometry->mesh.bounds();
  return box.upper.x - box.lower.x;
}

/// A mesh as an OFF file, its numbers in millimetres.
inline QString writeOff(const std::filesystem::path& file, const TriangleMesh& mesh) {
  std::ofstream out(file);
  out.precision(17);
  out << "OFF\n" << mesh.vertices().size() << ' ' << mesh.triangles().size() << " 0\n";
  for (const glm::dvec3& p : mesh.vertices())
    out << p.x * 1e3 << ' ' << p.y * 1e3 << ' ' << p.z * 1e3 << '\n';
  for (const Triangle& t : mesh.triangles())
    out << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
  return QString::fromStdString(file.string());
}

/// Ends a dialog that has not been answered after a long while, and fails the test, which would hang in the call that
/// opened the dialog.
inline void endIfUnanswered(QDialog* dialog) {
  // Later than what `act` may wait for itself.
  QTimer::singleShot(2 * kQtPatienceMs, dialog, [dialog] {
    if (!dialog->isVisible()) return;
    QTest::qFail(qPrintable(QStringLiteral("“%1” was not answered").arg(dialog->objectName())), __FILE__,
                 __LINE__);
    dialog->reject();
  });
}

/// Waits for a modal dialog of a type and, if given, a name, from inside the call that opens it, and hands it
/// to `act`, which must answer it. DialogAnswers (dialog_answers.h) answers one dialog after another.
template <class Dialog>
void whenModal(std::function<void(Dialog*)> act, const QString& name = {}) {
  auto* timer = new QTimer(qApp);
  timer->setInterval(20);
  QObject::connect(timer, &QTimer::timeout, timer, [timer, name, act = std::move(act)] {
    auto* dialog = qobject_cast<Dialog*>(QApplication::activeModalWidget());
    if (dialog == nullptr || !dialog->isVisible()) return;
    if (!name.isEmpty() && dialog->objectName() != name) return;
    timer->stop();
    timer->deleteLater();
    endIfUnanswered(dialog);
    act(dialog);
  });
  timer->start();
}

/// Answers the question for a unit, once it shows what size each unit gives.
/// @param unit  "mm", "in", ...; null: the one that is offered.
inline void answerUnit(QDialog* question, const char* unit = nullptr) {
  auto* accept = question->findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Ok);
  QTRY_VERIFY(accept->isEnabled());
  if (unit != nullptr) {
    auto* choice = question->findChild<QRadioButton*>(QStringLiteral("unit-") + QLatin1String(unit));
    QVERIFY(choice != nullptr);
    choice->setFocus();
    QTest::keyClick(choice, Qt::Key_Space);
    QVERIFY(choice->isChecked());
  }
  QTest::mouseClick(accept, Qt::LeftButton);
}

/// Puts a path into a file dialog and accepts it by its button.
inline void chooseFile(QFileDialog* dialog, const QString& file) {
  // What is typed takes back what the dialog proposes, where that is there and so marked; a text that is set
  // does not.
  dialog->findChild<QListView*>(QStringLiteral("listView"))->clearSelection();
  dialog->findChild<QLineEdit*>(QStringLiteral("fileNameEdit"))->setText(file);
  const auto accept =
      dialog->acceptMode() == QFileDialog::AcceptSave ? QDialogButtonBox::Save : QDialogButtonBox::Open;
  QTest::mouseClick(dialog->findChild<QDialogButtonBox*>()->button(accept), Qt::LeftButton);
}

/// Number of pixels in which two pictures of one size differ.
inline int differentPixels(const QImage& a, const QImage& b) {
  int count = 0;
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x)
      count += a.pixel(x, y) != b.pixel(x, y) ? 1 : 0;
  }
  return count;
}

/// Keeps pictures of a widget in both themes in the folder that NEARFIT_PICTURES names, to be looked at;
/// without one nothing happens.
inline void keepPictures(QWidget& widget, const QString& name) {
  const QString folder = qEnvironmentVariable("NEARFIT_PICTURES");
  if (folder.isEmpty()) return;
  const ui::ColourScheme before = ui::colourScheme();
  const std::pair<ui::ColourScheme, QString> schemes[] = {{ui::ColourScheme::Light, QStringLiteral("light")},
                                                          {ui::ColourScheme::Dark, QStringLiteral("dark")}};
  for (const auto& [scheme, word] : schemes) {
    ui::setColourScheme(scheme);
    QTest::qWait(300);
    widget.grab().save(QStringLiteral("%1/%2-%3.png").arg(folder, name, word));
  }
  ui::setColourScheme(before);
}

/// Tests run on machines with devices too.
class NoDevices final : public desktop::DeviceSource {
 public:
  bool hasChanged() override { return false; }
  QVector<ui::DeviceChoice> list() override { return {}; }
  QString find(const QString&) override { throw Error("devices", "there are none"); }
  std::unique_ptr<HapticDevice> make(const QString&) override { throw Error("devices", "there are none"); }
};

/// The application with a fixed cube of 40 mm about the origin and a moving cube of 20 mm whose lower face is
/// 5 mm above it: their one minimum is the region between the two faces.
class DesktopDriver {
 public:
  /// @param devices  Those that are plugged in: none that the tests do not know of.
  explicit DesktopDriver(std::unique_ptr<desktop::DeviceSource> devices = std::make_unique<NoDevices>())
      : application(std::move(devices)) {
    QWidget& w = application.window();
    w.resize(1200, 760);
    w.show();
    (void)QTest::qWaitForWindowExposed(&w);
    QApplication::setActiveWindow(&w);
    QObject::connect(&application.servo(), &desktop::ServoController::snapshotArrived, &application,
                     [this](const ServoSnapshot& snapshot) { felt = snapshot.proxy; });
    QObject::connect(&application.servo(), &desktop::ServoController::statusChanged, &application,
                     [this](const ui::ServoStatus& status) {
                       if (!status.isTaken()) felt.reset();
                     });
    fixedFile = writeOff(folder.path() / "fixed.off", boxMesh(glm::dvec3(0.04)));
    movingFile =
        writeOff(folder.path() / "moving.off", boxMesh(glm::dvec3(0.02), glm::dvec3(0.0, 0.0, 0.035)));
  }

  /// Adds both cubes without dialogs and makes the second the moving part.
  void addCubes() {
    add({fixedFile, movingFile});
    QTRY_COMPARE(session().scene().parts().size(), std::size_t{2});
    session().setMovingPart(partId("moving"));
  }
  /// Adds parts without dialogs, and leaves the selection as it was, or the moving part selected if nothing was:
  /// most tests select by themselves.
  void add(const QStringList& files) {
    auto* once = new QObject(&application);
    QObject::connect(&window().document(), &ui::Document::loaded, once,
                     [this, once, before = window().selection().parts()] {
                       once->deleteLater();
                       window().selection().set(before);
                       if (before.empty()) window().selection().select(session().scene().movingPart());
                     });
    window().document().addParts(files, 1e-3);
  }

  Session& session() { return application.session(); }
  ui::MainWindow& window() { return application.window(); }
  PartId partId(const char* name) { return session().scene().findByName(name)->id; }
  const Part& part(const char* name) { return *session().scene().findByName(name); }

  QAction* action(const char* name) { return window().findChild<QAction*>(QLatin1String(name)); }
  /// Gives a command by the menus, or by its button where it is in none.
  void choose(QAction* action) { chooseCommand(window(), action); }
  void choose(const char* name) { choose(action(name)); }
  /// Chooses what leads the moving part, by keys in the list.
  void chooseHand(ui::Hand hand) {
    auto* hands = widget<QComboBox>("hand");
    hands->setFocus();
    QTest::keyClick(hands, Qt::Key_Home);
    while (hands->currentData().value<ui::Hand>() != hand) {
      const int before = hands->currentIndex();
      QTest::keyClick(hands, Qt::Key_Down);
      if (hands->currentIndex() == before) throw Error("hand", "it cannot be chosen");
    }
  }
  /// Takes the moving part in hand: whose hand by keys in its list, then the command.
  void startWith(ui::Hand hand) {
    chooseHand(hand);
    choose("start");
    const auto isInHand = [this] {
      return application.servo().isRunning() && QApplication::activeModalWidget() == nullptr;
    };
    if (!QTest::qWaitFor(isInHand, 30'000)) throw Error("hand", "it does not hold the part");
  }
  template <class Widget>
  Widget* widget(const char* name) {
    return window().findChild<Widget*>(QLatin1String(name));
  }
  /// The servo has told that the part in hand is at this x, in its frame's origin [m].
  bool isFeltAtX(double x) const { return felt && std::abs(felt->translation.x - x) < 1e-9; }
  /// There is a while in which nothing is drawn: a window system that is late may ask for pictures at first.
  bool comesToRest() {
    for (int again = 0; again < 30; ++again) {
      const int before = window().viewport().pictureCount();
      QTest::qWait(1000);
      if (window().viewport().pictureCount() == before) return true;
    }
    return false;
  }
  /// What the view shows now, drawn whole: one that is drawn in its own time may still show what was before.
  QImage picture() {
    window().viewport().completePicture();
    return window().viewport().grabFramebuffer();
  }
  QString text(const char* label) { return widget<QLabel>(label)->text(); }
  QTreeView* partsView() { return widget<QTreeView>("partsView"); }

  /// Clicks a cell of the parts list.
  void clickPart(int row, int column) {
    QTreeView* view = partsView();
    QTest::mouseClick(view->viewport(), Qt::LeftButton, {},
                      view->visualRect(view->model()->index(row, column)).center());
  }
  /// Replaces a spin box's text as a user types it, and leaves it by Return.
  template <class Field>
  void type(const char* name, const char* number) {
    auto* field = widget<Field>(name);
    field->setFocus();
    field->selectAll();
    QTest::keyClicks(field, QLatin1String(number));
    QTest::keyClick(field, Qt::Key_Return);
  }

  TemporaryFolder folder;
  QString fixedFile, movingFile;
  std::optional<RigidTransform> felt;  ///< Where the part in hand is, once the servo has told.
  desktop::Application application;
};

/// A key of the window's. There is no window manager that gives the window the focus back after a dialog or a
/// menu, nor says so at once.
inline void pressShortcut(DesktopDriver& d, Qt::Key key, Qt::KeyboardModifiers modifiers = {}) {
  QApplication::setActiveWindow(&d.window());
  QTest::keyClick(&d.window(), key, modifiers);
}

/// The same of the view's, which has the focus then.
inline void pressInView(DesktopDriver& d, Qt::Key key, Qt::KeyboardModifiers modifiers = {}) {
  QApplication::setActiveWindow(&d.window());
  QTest::keyClick(&d.window().viewport(), key, modifiers);
}

}  // namespace nearfit::test
