#include <QCheckBox>
#include <QClipboard>
#include <QComboBox>
#include <QSpinBox>
#include <QStatusBar>

#include "tests/app/desktop/export_driver.h"
#include "tests/ui/view3d/picture_comparison.h"
#include "ui/files/export/picture_dialog.h"
#include "ui/widgets/error_box.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

enum Ground { View, White, Transparent };

/// Chooses in the dialog for pictures as a user does, and ends it by one of its buttons.
struct PictureChoice {
  int sizeRow = 0;   ///< As shown, twice, four times, own.
  QString ownWidth;  ///< Typed where it is not empty.
  Ground ground = View;
  bool hasAxes = true, hasLabels = true;
  const char* button = "Save…";
  QString* heightText = nullptr;
  QImage* preview = nullptr;

  void make(ui::PictureDialog* dialog) const {
    choose(dialog->findChild<QComboBox*>(QStringLiteral("pictureSize")), sizeRow);
    if (!ownWidth.isEmpty()) {
      auto* width = dialog->findChild<QSpinBox*>(QStringLiteral("pictureWidth"));
      width->setFocus();
      width->selectAll();
      QTest::keyClicks(width, ownWidth);
      QTest::keyClick(width, Qt::Key_Tab);
    }
    choose(dialog->findChild<QComboBox*>(QStringLiteral("pictureGround")), ground);
    tick(dialog->findChild<QCheckBox*>(QStringLiteral("pictureAxes")), hasAxes);
    tick(dialog->findChild<QCheckBox*>(QStringLiteral("pictureLabels")), hasLabels);
    if (heightText != nullptr)
      *heightText = dialog->findChild<QLabel*>(QStringLiteral("pictureHeight"))->text();
    if (preview != nullptr) {
      QCoreApplication::processEvents();
      const auto* label = dialog->findChild<QLabel*>(QStringLiteral("picturePreview"));
      QTRY_VERIFY(label->pixmap(Qt::ReturnByValue).width() > 0);
      *preview = label->pixmap(Qt::ReturnByValue).toImage();
    }
    for (QAbstractButton* wanted : dialog->findChild<QDialogButtonBox*>()->buttons()) {
      if (wanted->text().remove('&') == QString::fromUtf8(button)) QTest::mouseClick(wanted, Qt::LeftButton);
    }
  }

 private:
  static void choose(QComboBox* box, int row) {
    box->setFocus();
    QTest::keyClick(box, Qt::Key_Home);
    for (int i = 0; i < row; ++i)
      QTest::keyClick(box, Qt::Key_Down);
  }
  static void tick(QCheckBox* box, bool isOn) {
    if (box->isChecked() != isOn) QTest::mouseClick(box, Qt::LeftButton, {}, QPoint(8, box->height() / 2));
  }
};

/// Two cubes in a view that is at rest, and pictures of it by the shortcut.
struct PictureDesk : DesktopDriver {
  PictureDesk() {
    // Pictures have it, and the view without its widgets has not.
    window().viewport().setScaleBarVisible(false);
    addCubes();
    QTRY_VERIFY(window().viewport().pictureCount() > 0);
    (void)picture();
  }

  void press(Qt::Key key, Qt::KeyboardModifiers modifiers) { pressShortcut(*this, key, modifiers); }
  QString file(const char* name) const { return QString::fromStdString((folder.path() / name).string()); }
  void save(const PictureChoice& choice, const QString& to) {
    whenModal<ui::PictureDialog>([choice](ui::PictureDialog* dialog) { choice.make(dialog); });
    whenModal<QFileDialog>([to](QFileDialog* dialog) { chooseFile(dialog, to); });
    press(Qt::Key_P, Qt::ControlModifier | Qt::ShiftModifier);
  }
  QImage saved(const PictureChoice& choice, const char* name) {
    save(choice, file(name));
    const QString begin = QStringLiteral("Saved %1, ").arg(QLatin1String(name));
    [&] { QTRY_VERIFY(told().startsWith(begin)); }();
    return QImage(file(name));
  }
  QString told() { return window().statusBar()->currentMessage(); }
  /// What the view shows, but for the axes in its corner.
  QSize shownSize() { return window().viewport().grabFramebuffer().size(); }
};

/// Where the view shows a place within the moving cube's front face, off all edges.
QPoint onMovingCube(PictureDesk& d) {
  const glm::dvec2 pixel = d.window().viewport().projection().pixelOf({0.003, -0.01, 0.036}).value();
  return QPoint(qRound(pixel.x), qRound(pixel.y)) * d.window().viewport().devicePixelRatioF();
}

}  // namespace

class DesktopPictureTest : public QObject {
  Q_OBJECT

 private slots:
  void init() { QSettings().remove(QStringLiteral("picture")); }
  void aPictureShowsWhatTheViewShows();
  void aLargerOneShowsTheSameFiner();
  void anOwnWidthKeepsTheShape();
  void onWhiteAndOnNothingPartsLookTheSame();
  void axesAndLegendCanBeLeftOut();
  void aCutThatFollowsItsPartsIsTakenAsItIs();
  void theViewIsAsItWasAfterwards();
  void theDialogShowsItFirstAndRemembersItsChoices();
  void aJpegIsWrittenUnlessItWouldBeTransparent();
  void whatCannotBeWrittenIsTold();
  void cancellingWritesNothing();
  void picturesAreCopied();
};

void DesktopPictureTest::aPictureShowsWhatTheViewShows() {
  PictureDesk d;
  const QImage shown = d.picture();
  const QImage saved = d.saved({}, "view.png");
  QCOMPARE(saved.size(), shown.size());
  const PictureDifference difference = compare(saved, shown);
  QVERIFY2(!difference.isSeen(), qPrintable(QString::number(difference.mean)));
  QCOMPARE(saved.text(QStringLiteral("Software")), QStringLiteral("Nearfit"));
}

void DesktopPictureTest::aLargerOneShowsTheSameFiner() {
  PictureDesk d;
  const QImage shown = d.picture();
  for (const int times : {2, 4}) {
    PictureChoice choice;
    choice.sizeRow = times / 2;
    const QImage saved = d.saved(choice, times == 2 ? "twice.png" : "four.png");
    QCOMPARE(saved.size(), shown.size() * times);
    const QImage small = saved.scaled(shown.size(), Qt::IgnoreAspectRatio, Qt::SmoothTransformation);
    // Edges are smoothed in their own way: a little is seen, and nothing is elsewhere.
    const PictureDifference difference = compare(small, shown);
    QVERIFY2(difference.mean < 1.5 && difference.share < 0.01,
             qPrintable(QStringLiteral("%1 %2").arg(difference.mean).arg(difference.share)));
  }
}

void DesktopPictureTest::anOwnWidthKeepsTheShape() {
  PictureDesk d;
  const QSize shown = d.shownSize();
  QString height;
  PictureChoice choice;
  choice.ownWidth = QStringLiteral("1000");
  choice.heightText = &height;
  const QImage saved = d.saved(choice, "own.png");
  QCOMPARE(saved.width(), 1000);
  QCOMPARE(saved.height(), qRound(1000.0 * shown.height() / shown.width()));
  QCOMPARE(height, QStringLiteral("× %1 px").arg(saved.height()));
}

void DesktopPictureTest::onWhiteAndOnNothingPartsLookTheSame() {
  PictureDesk d;
  const QPoint opaque = onMovingCube(d);
  PictureChoice choice;
  choice.hasAxes = false;
  choice.ground = White;
  const QImage onWhite = d.saved(choice, "white.png");
  QCOMPARE(onWhite.pixelColor(2, 2), QColor(Qt::white));
  QVERIFY(onWhite.pixelColor(opaque) != QColor(Qt::white));
  choice.ground = Transparent;
  const QImage onNothing = d.saved(choice, "nothing.png");
  QVERIFY(onNothing.hasAlphaChannel());
  QCOMPARE(qAlpha(onNothing.pixel(2, 2)), 0);
  QCOMPARE(qAlpha(onNothing.pixel(opaque)), 255);
  QImage put(onNothing.size(), QImage::Format_RGB32);
  put.fill(Qt::white);
  QPainter(&put).drawImage(0, 0, onNothing);
  const PictureDifference difference = compare(put, onWhite);
  QVERIFY2(!difference.isSeen(), qPrintable(QString::number(difference.mean)));
  // Parts that shine through do so in the picture too.
  d.session().setOpacity({d.partId("moving")}, 0.4);
  d.picture();
  const QImage thin = d.saved(choice, "thin.png");
  const int cover = qAlpha(thin.pixel(opaque));
  QVERIFY2(cover > 60 && cover < 250, qPrintable(QString::number(cover)));
}

void DesktopPictureTest::axesAndLegendCanBeLeftOut() {
  PictureDesk d;
  d.startWith(ui::Hand::Manual);
  auto* legend = d.widget<QWidget>("colourLegend");
  QTRY_VERIFY(legend->isVisible());
  PictureChoice choice;
  choice.ground = Transparent;
  const QImage with = d.saved(choice, "with.png");
  choice.hasAxes = choice.hasLabels = false;
  const QImage without = d.saved(choice, "without.png");
  const QPoint onLegend = legend->geometry().center() * d.window().viewport().devicePixelRatioF();
  QVERIFY(qAlpha(with.pixel(onLegend)) > 200);
  QCOMPARE(qAlpha(without.pixel(onLegend)), 0);
  const auto covered = [](const QImage& picture) {
    const QRect corner(picture.width() - 100, 0, 100, 100);
    int count = 0;
    for (int y = corner.top(); y <= corner.bottom(); ++y)
      for (int x = corner.left(); x <= corner.right(); ++x)
        count += qAlpha(picture.pixel(x, y)) > 128 ? 1 : 0;
    return count;
  };
  QVERIFY2(covered(with) > 500, qPrintable(QString::number(covered(with))));
  QCOMPARE(covered(without), 0);
  d.choose("stop");
}

void DesktopPictureTest::aCutThatFollowsItsPartsIsTakenAsItIs() {
  PictureDesk d;
  d.choose("section");
  d.picture();
  // Faces of the cut come and go with the picture that is taken: none has been drawn in between.
  for (const double x : {0.2, 0.0}) {
    d.session().movePart(d.partId("fixed"), {{1, 0, 0, 0}, {x, 0, 0}});
    d.press(Qt::Key_C, Qt::ControlModifier | Qt::AltModifier);
    const QImage taken = QApplication::clipboard()->image();
    const PictureDifference difference = compare(taken, d.picture());
    QVERIFY2(difference.mean < 1.0, qPrintable(QString::number(difference.mean)));
  }
}

void DesktopPictureTest::theViewIsAsItWasAfterwards() {
  PictureDesk d;
  QVERIFY(d.comesToRest());
  const QImage before = d.picture();
  PictureChoice choice;
  choice.sizeRow = 2;
  choice.ground = Transparent;
  choice.hasAxes = choice.hasLabels = false;
  d.saved(choice, "some.png");
  QVERIFY(d.comesToRest());
  QCOMPARE(d.window().viewport().grabFramebuffer().size(), before.size());
  const PictureDifference difference = compare(d.picture(), before);
  QVERIFY2(!difference.isSeen(), qPrintable(QString::number(difference.mean)));
}

void DesktopPictureTest::theDialogShowsItFirstAndRemembersItsChoices() {
  PictureDesk d;
  QImage preview;
  PictureChoice choice;
  choice.sizeRow = 1;
  choice.ground = White;
  choice.hasAxes = false;
  choice.preview = &preview;
  const QImage saved = d.saved(choice, "first.png");
  const QImage small = saved.scaled(preview.size(), Qt::IgnoreAspectRatio, Qt::SmoothTransformation);
  const PictureDifference difference = compare(preview, small);
  QVERIFY2(difference.mean < 3.0 && difference.share < 0.03,
           qPrintable(QStringLiteral("%1 %2").arg(difference.mean).arg(difference.share)));
  bool isAsBefore = false;
  whenModal<ui::PictureDialog>([&](ui::PictureDialog* dialog) {
    isAsBefore = dialog->findChild<QComboBox*>(QStringLiteral("pictureSize"))->currentIndex() == 1 &&
                 dialog->findChild<QComboBox*>(QStringLiteral("pictureGround"))->currentIndex() == White &&
                 !dialog->findChild<QCheckBox*>(QStringLiteral("pictureAxes"))->isChecked() &&
                 dialog->findChild<QCheckBox*>(QStringLiteral("pictureLabels"))->isChecked();
    keepPictures(*dialog, QStringLiteral("picture-dialog"));
    QTest::keyClick(dialog, Qt::Key_Escape);
  });
  d.press(Qt::Key_P, Qt::ControlModifier | Qt::ShiftModifier);
  QVERIFY(isAsBefore);
}

void DesktopPictureTest::aJpegIsWrittenUnlessItWouldBeTransparent() {
  PictureDesk d;
  const QImage saved = d.saved({}, "view.jpg");
  const PictureDifference difference = compare(saved, d.picture());
  QVERIFY2(difference.mean < 2.0, qPrintable(QString::number(difference.mean)));
  QFile file(d.file("view.jpg"));
  QVERIFY(file.open(QIODevice::ReadOnly));
  QCOMPARE(file.read(2), QByteArray("\xff\xd8"));

  // What has another suffix, or one that knows no transparency, gets one that fits.
  PictureChoice choice;
  choice.ground = Transparent;
  d.save(choice, d.file("glass.jpg"));
  // The file is there before the window hears of it, and until then no other picture can be saved.
  QTRY_VERIFY(d.told().startsWith(QStringLiteral("Saved glass.jpg.png, ")));
  QVERIFY(QFile::exists(d.file("glass.jpg.png")));
  d.save({}, d.file("view.bmp"));
  QTRY_VERIFY(d.told().startsWith(QStringLiteral("Saved view.bmp.png, ")));
  QVERIFY(QFile::exists(d.file("view.bmp.png")));
  QVERIFY(!QFile::exists(d.file("glass.jpg")) && !QFile::exists(d.file("view.bmp")));
}

void DesktopPictureTest::whatCannotBeWrittenIsTold() {
  PictureDesk d;
  std::vector<ui::Failure> failures;
  d.window().setFailureSink([&](const ui::Failure& failure) { failures.push_back(failure); });
  const std::filesystem::path missing = d.folder.path() / "missing";
  whenModal<ui::PictureDialog>([](ui::PictureDialog* dialog) { PictureChoice().make(dialog); });
  whenModal<QFileDialog>([&](QFileDialog* dialog) {
    // The dialog itself takes no folder that is not there: it goes while the dialog is open.
    std::filesystem::create_directory(missing);
    chooseFile(dialog, d.file("missing/view.png"));
    std::filesystem::remove(missing);
  });
  d.press(Qt::Key_P, Qt::ControlModifier | Qt::ShiftModifier);
  QTRY_COMPARE(failures.size(), std::size_t{1});
  QVERIFY(failures[0].details.contains(QStringLiteral("missing/view.png")));
}

void DesktopPictureTest::cancellingWritesNothing() {
  PictureDesk d;
  whenModal<ui::PictureDialog>([](ui::PictureDialog* dialog) { QTest::keyClick(dialog, Qt::Key_Escape); });
  d.press(Qt::Key_P, Qt::ControlModifier | Qt::ShiftModifier);
  whenModal<ui::PictureDialog>([](ui::PictureDialog* dialog) { PictureChoice().make(dialog); });
  whenModal<QFileDialog>([](QFileDialog* dialog) { dialog->reject(); });
  d.press(Qt::Key_P, Qt::ControlModifier | Qt::ShiftModifier);
  QCOMPARE(std::distance(std::filesystem::directory_iterator(d.folder.path()), {}), std::ptrdiff_t{2});
}

void DesktopPictureTest::picturesAreCopied() {
  PictureDesk d;
  QApplication::clipboard()->clear();
  d.press(Qt::Key_C, Qt::ControlModifier | Qt::AltModifier);
  QTRY_COMPARE(QApplication::clipboard()->image().size(), d.shownSize());
  QVERIFY(d.told().startsWith(QStringLiteral("Copied a picture")));
  PictureChoice choice;
  choice.sizeRow = 1;
  choice.button = "Copy";
  whenModal<ui::PictureDialog>([choice](ui::PictureDialog* dialog) { choice.make(dialog); });
  d.press(Qt::Key_P, Qt::ControlModifier | Qt::ShiftModifier);
  QTRY_COMPARE(QApplication::clipboard()->image().size(), d.shownSize() * 2);
}

NEARFIT_QT_SUITE(DesktopPictureTest, runDesktopTest<DesktopPictureTest>)
#include "desktop_picture_test.moc"
