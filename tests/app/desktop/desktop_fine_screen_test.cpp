// The whole window on a screen with two pixels for each of the window's: the mouse counts the latter.
#include <QGuiApplication>
#include <QScreen>
#include <QSpinBox>
#include <QStatusBar>

#include "tests/app/desktop/view_pointer.h"
#include "ui/files/export/picture_dialog.h"
#include "ui/model/selection.h"

using namespace nearfit;
using namespace nearfit::test;

using Parts = std::vector<PartId>;

namespace {

/// The two cubes, from the front.
struct FineScreen {
  FineScreen() : mouse(d) {
    // No larger than need be: four times as many pixels are drawn as on other screens.
    d.window().resize(d.window().minimumSizeHint());
    d.addCubes();
    d.window().selection().select(std::nullopt);
    mouse.look("viewFront");
  }
  ui::Selection& selection() { return d.window().selection(); }
  /// What a click there selects.
  std::optional<PartId> clicked(const QPoint& at) {
    QTest::mouseClick(&mouse.view(), Qt::LeftButton, {}, at);
    return selection().current();
  }
  /// A picture of that width, which the dialog is made to say; as in the window for 0.
  QImage saved(int width) {
    const QString name = QStringLiteral("wide%1.png").arg(width);
    const QString file = QString::fromStdString(d.folder.path().string()) + QChar('/') + name;
    whenModal<ui::PictureDialog>([width](ui::PictureDialog* dialog) {
      auto* field = dialog->findChild<QSpinBox*>(QStringLiteral("pictureWidth"));
      if (width > 0) {
        field->setFocus();
        field->selectAll();
        QTest::keyClicks(field, QString::number(width));
        QTest::keyClick(field, Qt::Key_Tab);
      }
      QTest::mouseClick(dialog->findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Save),
                        Qt::LeftButton);
    });
    whenModal<QFileDialog>([file](QFileDialog* dialog) { chooseFile(dialog, file); });
    pressShortcut(d, Qt::Key_P, Qt::ControlModifier | Qt::ShiftModifier);
    [&] {
      QTRY_VERIFY(d.window().statusBar()->currentMessage().startsWith(QStringLiteral("Saved ") + name));
    }();
    return QImage(file);
  }

  DesktopDriver d;
  ViewPointer mouse;
};

}  // namespace

class DesktopFineScreenTest : public QObject {
  Q_OBJECT

 private slots:
  void init() { QSettings().clear(); }
  void theFirstWindowFitsIt();
  void aClickPicksThePartUnderTheMouse();
  void anArrowMovesThePartAsFarAsTheMouse();
  void aBoxTakesWhatIsInIt();
  void aPictureHasTheSizeThatIsAskedFor();
};

/// With no size kept from an earlier run the window opened larger than the screen.
void DesktopFineScreenTest::theFirstWindowFitsIt() {
  desktop::Application application(std::make_unique<NoDevices>());
  QWidget& window = application.window();
  window.show();
  QVERIFY(QTest::qWaitForWindowExposed(&window));
  const QSize room = QGuiApplication::primaryScreen()->availableSize();
  constexpr int kUsualWidth = 1360, kUsualHeight = 860;
  QVERIFY2(room.width() < kUsualWidth && room.height() < kUsualHeight, "the usual window does not fit");
  const QSize most = room.expandedTo(window.minimumSizeHint());
  QVERIFY2(most.width() < kUsualWidth && most.height() < kUsualHeight, "a smaller one does");
  QVERIFY2(window.width() <= most.width() && window.height() <= most.height(),
           qPrintable(QStringLiteral("%1 x %2").arg(window.width()).arg(window.height())));
}

void DesktopFineScreenTest::aClickPicksThePartUnderTheMouse() {
  FineScreen b;
  QCOMPARE(b.mouse.view().devicePixelRatioF(), 2.0);
  const PartId fixed = b.d.partId("fixed"), moving = b.d.partId("moving");
  // Just within and just beside the corners of the faces that look this way.
  const struct {
    glm::dvec3 corner;
    QPoint outward;
    PartId part;
  } corners[] = {{{-0.01, -0.01, 0.045}, {-1, -1}, moving},
                 {{0.01, -0.01, 0.045}, {1, -1}, moving},
                 {{-0.02, -0.02, -0.02}, {-1, 1}, fixed},
                 {{0.02, -0.02, -0.02}, {1, 1}, fixed}};
  for (const auto& [corner, outward, part] : corners) {
    const QPoint at = b.mouse.seen(corner);
    QVERIFY(b.clicked(at - 4 * outward) == part);
    QVERIFY(!b.clicked(at + 4 * outward));
  }
}

void DesktopFineScreenTest::anArrowMovesThePartAsFarAsTheMouse() {
  FineScreen b;
  QVERIFY(b.clicked(b.mouse.seen({0.005, -0.01, 0.04})) == b.d.partId("moving"));
  QTRY_VERIFY(b.mouse.overlay().picture().has_value());
  const std::pair<GizmoGrip, QPoint> drags[] = {{GizmoGrip::MoveX, {50, 0}}, {GizmoGrip::MoveZ, {0, -30}}};
  for (const auto& [handle, way] : drags) {
    const glm::dvec3 centre = b.d.part("moving").worldFromPart.applyToPoint({0, 0, 0.035});
    const QPoint before = b.mouse.seen(centre);
    b.mouse.drag(b.mouse.handle(handle), way);
    const glm::dvec3 now = b.d.part("moving").worldFromPart.applyToPoint({0, 0, 0.035});
    const QPoint gone = b.mouse.seen(now) - before;
    QVERIFY2((gone - way).manhattanLength() <= 2,
             qPrintable(QStringLiteral("%1 %2").arg(gone.x()).arg(gone.y())));
    // And the gizmo with it.
    QVERIFY((b.mouse.handle(GizmoGrip::MoveFree) - b.mouse.seen(now)).manhattanLength() <= 2);
  }
}

void DesktopFineScreenTest::aBoxTakesWhatIsInIt() {
  FineScreen b;
  const auto box = [&](const QPoint& from, const QPoint& to) {
    pressInView(b.d, Qt::Key_B);
    b.mouse.drag(from, to - from);
    return b.selection().parts();
  };
  const QPoint upper = b.mouse.seen({-0.01, -0.01, 0.045}), lower = b.mouse.seen({0.01, -0.01, 0.025});
  // Around the small one, without the large one below it.
  QVERIFY(box(upper - QPoint(6, 6), {lower.x() + 6, lower.y() + 1}) == Parts{b.d.partId("moving")});
  // To the left of it, and above it: nothing.
  QVERIFY(box({upper.x() - 60, upper.y()}, {upper.x() - 4, lower.y()}).empty());
  QVERIFY(box({upper.x(), upper.y() - 40}, {lower.x(), upper.y() - 4}).empty());
  const QPoint corner = b.mouse.seen({0.02, -0.02, -0.02});
  QVERIFY(box(corner - QPoint(5, 5), corner + QPoint(20, 20)) == Parts{b.d.partId("fixed")});
  QVERIFY(box(upper - QPoint(80, 6), corner + QPoint(5, 5)) ==
          (Parts{b.d.partId("fixed"), b.d.partId("moving")}));
}

void DesktopFineScreenTest::aPictureHasTheSizeThatIsAskedFor() {
  FineScreen b;
  const QSize view = b.mouse.view().size();
  const QImage asShown = b.saved(0);
  QCOMPARE(asShown.size(), 2 * view);
  const QImage own = b.saved(900);
  QCOMPARE(own.width(), 900);
  QCOMPARE(own.height(), qRound(900.0 * view.height() / view.width()));
  // All of the view is in it: the middle of the moving cube is where the view has it.
  const QPoint middle = b.mouse.seen({0.0, -0.01, 0.035});
  for (const QImage& picture : {asShown, own}) {
    const double scale = static_cast<double>(picture.width()) / view.width();
    const QPoint at(qRound(scale * middle.x()), qRound(scale * middle.y()));
    const QPoint beside = at - QPoint(qRound(scale * 150), 0);
    QVERIFY(picture.pixelColor(at) != picture.pixelColor(beside));
    QVERIFY(picture.pixelColor(beside) == picture.pixelColor(beside - QPoint(4, 0)));
  }
}

NEARFIT_QT_SUITE(DesktopFineScreenTest, [](int argc, char** argv) {
  qputenv("QT_SCALE_FACTOR", "2");
  return runDesktopTest<DesktopFineScreenTest>(argc, argv);
})
#include "desktop_fine_screen_test.moc"
