// What the view draws over the parts while one is felt, and the entries of the View menu that say what of it.
#include <QDoubleSpinBox>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "tests/app/desktop/view_driver.h"
#include "ui/model/parts_model.h"
#include "ui/view3d/view_detail.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

/// Pixels of a rectangle that two pictures of one size do not have alike.
int changedPixels(const QImage& a, const QImage& b, const QRect& place) {
  constexpr int kSeen = 24;  ///< Of 255: less is the smoothing's.
  const auto differ = [](QRgb p, QRgb q) {
    return std::abs(qRed(p) - qRed(q)) > kSeen || std::abs(qGreen(p) - qGreen(q)) > kSeen ||
           std::abs(qBlue(p) - qBlue(q)) > kSeen;
  };
  const QRect seen = place & a.rect() & b.rect();
  int count = 0;
  for (int y = seen.top(); y <= seen.bottom(); ++y)
    for (int x = seen.left(); x <= seen.right(); ++x)
      count += differ(a.pixel(x, y), b.pixel(x, y)) ? 1 : 0;
  return count;
}

int changedPixels(const QImage& a, const QImage& b) {
  return changedPixels(a, b, a.rect());
}

/// Pixels that are of a colour, however brightly it is lit.
int pixelsOf(const QColor& colour, const QImage& picture) {
  constexpr int kHue = 8, kMinSaturation = 100;
  int count = 0;
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      const QColor pixel = picture.pixelColor(x, y);
      const int away = std::abs(pixel.hsvHue() - colour.hsvHue());
      if (pixel.hsvSaturation() >= kMinSaturation && std::min(away, 360 - away) <= kHue) ++count;
    }
  }
  return count;
}

struct GlyphsFixture {
  GlyphsFixture() {
    QObject::connect(&d.application.servo(), &desktop::ServoController::snapshotArrived, &d.application,
                     [this](const ServoSnapshot& snapshot) { newest = snapshot; });
    d.addCubes();
  }
  /// Taken by the manual hand, looked at from the front with nothing selected.
  void feel() {
    d.startWith(ui::Hand::Manual);
    ViewDriver(d).look("viewFront");
  }
  void selectNothing() {
    if (d.action("selectNone")->isEnabled()) d.choose("selectNone");
  }
  /// The hand goes 3 mm beyond contact and stays.
  void press() {
    d.clickPart(1, ui::PartsModel::Name);
    d.type<QDoubleSpinBox>("positionZ", "-8");
    QTRY_VERIFY(newest.storedContacts > 0 && glm::length(newest.wrench.force) > 1.0);
  }
  /// Once force and stiffness have settled and the view with them.
  QImage settledPicture() {
    constexpr std::uint64_t kTicks = 100;
    constexpr int kFew = 10;
    QImage before, now = d.picture();
    const auto isSettled = [&] {
      before = now;
      const std::uint64_t tick = newest.tick;
      if (!QTest::qWaitFor([&] { return newest.tick > tick + kTicks; }, kQtPatienceMs)) return false;
      now = d.picture();
      return changedPixels(before, now) < kFew;
    };
    if (!QTest::qWaitFor(isSettled, kQtPatienceMs)) throw Error("view", "it does not come to rest");
    return now;
  }

  DesktopDriver d;
  ServoSnapshot newest;
};

/// The moving cube with a gap to the cube below, one to a ceiling and one to a wall: a minimum in each.
struct Gaps : GlyphsFixture {
  Gaps() {
    d.add({writeOff(d.folder.path() / "ceiling.off",
                    boxMesh(glm::dvec3(0.04, 0.04, 0.01), glm::dvec3(0.0, 0.0, 0.052))),
           writeOff(d.folder.path() / "wall.off",
                    boxMesh(glm::dvec3(0.01, 0.04, 0.02), glm::dvec3(0.023, 0.0, 0.035)))});
    QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{4});
    feel();
    QTRY_COMPARE(d.text("statusMinima"), QStringLiteral("Minima 3"));
    selectNothing();
    d.choose("minima");
    without = d.picture();
    d.choose("minima");
    for (std::size_t i = 0; i < newest.storedLmds; ++i)
      minima.push_back(newest.lmds[i].lmd);
    std::ranges::sort(minima, {}, &Lmd::distance);
  }
  int drawnAt(const glm::dvec3& place, int radius) {
    const QPoint middle = ViewDriver(d).seen(place);
    return changedPixels(without, d.picture(),
                         {middle - QPoint(radius, radius), middle + QPoint(radius, radius)});
  }
  /// In the middle of a gap, clear of the dots at both ends.
  bool hasLine(const Lmd& lmd) { return drawnAt(0.5 * (lmd.scenePoint + lmd.partPoint), 1) > 0; }
  /// On the part, beside the line.
  int dotSize(const Lmd& lmd) { return drawnAt(lmd.partPoint, 6); }
  /// Which of the gaps, from the narrowest, have a line.
  QString lines() {
    QString text;
    for (const Lmd& lmd : minima)
      text += hasLine(lmd) ? QChar('x') : QChar('-');
    return text;
  }

  QImage without;  ///< The view with all minima switched off.
  std::vector<Lmd> minima;
};

}  // namespace

class DesktopGlyphsTest : public QObject {
  Q_OBJECT

 private slots:
  void init() { QSettings().clear(); }
  void eachSwitchTakesAwayWhatItNamesAndBringsItBack_data();
  void eachSwitchTakesAwayWhatItNamesAndBringsItBack();
  void forceContactAndHandAreThereOnlyWhileItIsPressed();
  void theGapsHaveTheMinimaThatTheyAreBuiltWith();
  void segmentsPointsAndNormalsAreDrawnAsChosen();
  void asManyOfTheNearestAreDrawnAsChosen();
  void minimaFartherThanChosenAreNotDrawn();
  void theRangeOfColoursIsChosenInADialog();
  void theLegendIsDraggedAndHiddenAndThatIsRemembered();
  void theQualityWhileFeelingIsRemembered();
};

void DesktopGlyphsTest::eachSwitchTakesAwayWhatItNamesAndBringsItBack_data() {
  QTest::addColumn<QColor>("colour");
  QTest::newRow("minima") << QColor();
  QTest::newRow("wrench") << ui::colours::kForce;
  QTest::newRow("contacts") << ui::colours::kContact;
  QTest::newRow("handGhost") << ui::colours::kHand;
  QTest::newRow("edges") << QColor();
  QTest::newRow("seeThrough") << QColor();
}

void DesktopGlyphsTest::eachSwitchTakesAwayWhatItNamesAndBringsItBack() {
  QFETCH(QColor, colour);
  const char* name = QTest::currentDataTag();
  GlyphsFixture f;
  f.feel();
  f.press();
  f.selectNothing();
  QVERIFY(f.d.action(name)->isChecked());
  const QImage with = f.settledPicture();
  constexpr int kMin = 60;
  f.d.choose(name);
  QVERIFY(!f.d.action(name)->isChecked());
  QTRY_VERIFY(changedPixels(with, f.d.picture()) > kMin);
  const QImage without = f.d.picture();
  if (colour.isValid()) QVERIFY(pixelsOf(colour, with) > pixelsOf(colour, without) + kMin);
  f.d.choose(name);
  QVERIFY(f.d.action(name)->isChecked());
  const int effect = changedPixels(with, without);
  QTRY_VERIFY(changedPixels(with, f.d.picture()) < effect / 10);
}

void DesktopGlyphsTest::forceContactAndHandAreThereOnlyWhileItIsPressed() {
  GlyphsFixture f;
  f.feel();
  QTRY_COMPARE(f.d.text("statusMinima"), QStringLiteral("Minima 1"));
  f.selectNothing();
  const QImage apart = f.settledPicture();
  f.press();
  f.selectNothing();
  constexpr int kMin = 60;
  const std::pair<const char*, QColor> glyphs[] = {
      {"force", ui::colours::kForce}, {"contact", ui::colours::kContact}, {"hand", ui::colours::kHand}};
  for (const auto& [name, colour] : glyphs)
    QTRY_VERIFY2(pixelsOf(colour, f.d.picture()) > pixelsOf(colour, apart) + kMin, name);
  f.d.clickPart(1, ui::PartsModel::Name);
  f.d.type<QDoubleSpinBox>("positionZ", "0");
  QTRY_COMPARE(f.d.text("force"), QStringLiteral("0.00 N"));
  f.selectNothing();
  QTRY_VERIFY(changedPixels(apart, f.d.picture()) < kMin);
}

void DesktopGlyphsTest::theGapsHaveTheMinimaThatTheyAreBuiltWith() {
  Gaps g;
  QCOMPARE(g.minima.size(), std::size_t{3});
  const double gaps[] = {2e-3, 5e-3, 8e-3};
  for (std::size_t i = 0; i < 3; ++i)
    QVERIFY(std::abs(g.minima[i].distance - gaps[i]) < 1e-9);
  QCOMPARE(g.lines(), QStringLiteral("xxx"));
  g.d.choose("minima");
  QTRY_COMPARE(g.lines(), QStringLiteral("---"));
  QCOMPARE(changedPixels(g.without, g.d.picture()), 0);
}

void DesktopGlyphsTest::segmentsPointsAndNormalsAreDrawnAsChosen() {
  Gaps g;
  const Lmd middle = g.minima[1], widest = g.minima[2];
  const int dotWithLine = g.dotSize(middle);
  g.d.choose("minimaSegments");
  QTRY_VERIFY(!g.hasLine(middle) && !g.hasLine(widest));
  const int dot = g.dotSize(middle);
  QVERIFY(dot > 30 && dot <= dotWithLine);
  // Normals go from either point over 4 mm of the 5: they meet there, though no segment is drawn.
  g.d.choose("minimaNormals");
  QTRY_VERIFY(g.hasLine(middle));
  g.d.choose("minimaPoints");
  QTRY_VERIFY(g.dotSize(middle) < dot);
  QVERIFY(g.hasLine(middle));
  const int pin = g.drawnAt(0.5 * (middle.scenePoint + middle.partPoint), 6);
  g.d.choose("minimaNormals");
  QTRY_COMPARE(changedPixels(g.without, g.d.picture()), 0);
  g.d.choose("minimaSegments");
  QTRY_VERIFY(g.hasLine(middle) && g.hasLine(widest));
  // A segment has a halo, and is the wider.
  QVERIFY(g.drawnAt(0.5 * (middle.scenePoint + middle.partPoint), 6) > pin);
  QVERIFY(g.dotSize(middle) < dotWithLine);
  g.d.choose("minimaPoints");
  QTRY_COMPARE(g.dotSize(middle), dotWithLine);
}

void DesktopGlyphsTest::asManyOfTheNearestAreDrawnAsChosen() {
  Gaps g;
  const QImage all = g.d.picture();
  QCOMPARE(g.lines(), QStringLiteral("xxx"));
  g.d.choose("minimaMost1");
  QTRY_COMPARE(g.lines(), QStringLiteral("x--"));
  // More than there are.
  g.d.choose("minimaMost10");
  QTRY_COMPARE(g.lines(), QStringLiteral("xxx"));
  g.d.choose("minimaMost1");
  QTRY_COMPARE(g.lines(), QStringLiteral("x--"));
  g.d.choose("minimaMost0");
  QTRY_COMPARE(changedPixels(all, g.d.picture()), 0);
  QVERIFY(g.d.action("minimaMost0")->isChecked() && !g.d.action("minimaMost1")->isChecked());
}

void DesktopGlyphsTest::minimaFartherThanChosenAreNotDrawn() {
  Gaps g;
  // The hand brings the 5 mm to 4: clear of the half of the cutoff of 10 mm. The ceiling is then at 3.
  g.d.clickPart(1, ui::PartsModel::Name);
  g.d.type<QDoubleSpinBox>("positionZ", "-1");
  QTRY_COMPARE(g.d.text("statusDistance"), QStringLiteral("Min distance 3.00 mm"));
  g.selectNothing();
  g.minima.clear();
  for (std::size_t i = 0; i < g.newest.storedLmds; ++i)
    g.minima.push_back(g.newest.lmds[i].lmd);
  std::ranges::sort(g.minima, {}, &Lmd::distance);
  g.d.choose("minima");
  g.without = g.d.picture();
  g.d.choose("minima");
  const QImage all = g.d.picture();
  QCOMPARE(g.lines(), QStringLiteral("xxx"));
  g.d.choose("minimaWithin50");
  QTRY_COMPARE(g.lines(), QStringLiteral("xx-"));
  g.d.choose("minimaWithin25");
  QTRY_COMPARE(g.lines(), QStringLiteral("---"));
  g.d.choose("minimaWithin100");
  QTRY_COMPARE(changedPixels(all, g.d.picture()), 0);
}

void DesktopGlyphsTest::theRangeOfColoursIsChosenInADialog() {
  Gaps g;
  const QImage automatic = g.d.picture();
  whenModal<QDialog>(
      [](QDialog* dialog) {
        auto* field = dialog->findChild<QDoubleSpinBox*>(QStringLiteral("colourRange"));
        field->setFocus();
        field->selectAll();
        QTest::keyClicks(field, QStringLiteral("2"));
        QTest::keyClick(field, Qt::Key_Return);
      },
      QStringLiteral("colourRangeDialog"));
  g.d.choose("minimaColoursChosen");
  QVERIFY(g.d.action("minimaColoursChosen")->isChecked());
  QTRY_VERIFY2(changedPixels(automatic, g.d.picture()) > 20, "the gap of 5 mm is blue now");
  g.d.choose("minimaColoursAutomatic");
  QTRY_COMPARE(changedPixels(automatic, g.d.picture()), 0);
}

void DesktopGlyphsTest::theLegendIsDraggedAndHiddenAndThatIsRemembered() {
  QPoint place;
  {
    GlyphsFixture f;
    f.feel();
    auto* legend = f.d.widget<QWidget>("colourLegend");
    QTRY_VERIFY(legend->isVisible());
    const QPoint before = legend->pos(), way(120, -90);
    const QPoint from = legend->rect().center();
    QTest::mousePress(legend, Qt::LeftButton, {}, from);
    QMouseEvent move(QEvent::MouseMove, from + way, legend->mapToGlobal(from + way), Qt::NoButton,
                     Qt::LeftButton, {});
    QApplication::sendEvent(legend, &move);
    place = before + way;
    QCOMPARE(legend->pos(), place);
    QTest::mouseRelease(legend, Qt::LeftButton, {}, from);
    // It stays there while numbers come.
    const std::uint64_t tick = f.newest.tick;
    f.press();
    QTRY_VERIFY(f.newest.tick > tick + 100);
    QVERIFY((legend->pos() - place).manhattanLength() <= 2);
    f.d.choose("legend");
    QVERIFY(!legend->isVisible());
    f.d.choose("stop");
  }
  GlyphsFixture again;
  again.feel();
  auto* legend = again.d.widget<QWidget>("colourLegend");
  QTRY_COMPARE(again.d.text("statusMinima"), QStringLiteral("Minima 1"));
  QVERIFY(!legend->isVisible());
  again.d.choose("legend");
  QTRY_VERIFY(legend->isVisible());
  QVERIFY((legend->pos() - place).manhattanLength() <= 2);
}

void DesktopGlyphsTest::theQualityWhileFeelingIsRemembered() {
  const auto ofView = [](DesktopDriver& d) { return d.window().viewport().detail().feelQuality(); };
  {
    DesktopDriver d;
    QVERIFY(d.action("quality-balanced")->isChecked());
    QVERIFY(ofView(d) == ui::FeelQuality::Balanced);
    d.choose("quality-fast");
    QVERIFY(ofView(d) == ui::FeelQuality::Fast);
    d.choose("quality-full");
    QVERIFY(ofView(d) == ui::FeelQuality::Full);
  }
  DesktopDriver d;
  QVERIFY(d.action("quality-full")->isChecked() && !d.action("quality-balanced")->isChecked());
  QVERIFY(ofView(d) == ui::FeelQuality::Full);
}

NEARFIT_QT_SUITE(DesktopGlyphsTest, runDesktopTest<DesktopGlyphsTest>)
#include "desktop_glyphs_test.moc"
