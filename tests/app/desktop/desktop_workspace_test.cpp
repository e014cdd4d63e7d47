// What the panel sets of a hand's way into the scene while it feels: scale, clutch, and motions that count.
#include <QCheckBox>
#include <QComboBox>
#include <QToolButton>
#include <memory>

#include "tests/app/desktop/desktop_driver.h"
#include "tests/app/desktop/fake_device.h"
#include "ui/widgets/number_field.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

/// Two cubes, the moving one led by a fake device, far from the other.
struct WorkspaceFixture {
  WorkspaceFixture() {
    source->devices = {{QStringLiteral("arm"), QStringLiteral("Fake arm"), {}, true}};
    d = std::make_unique<DesktopDriver>(std::unique_ptr<desktop::DeviceSource>(source));
    handle = source->handle;
    d->addCubes();
    d->session().movePart(d->partId("moving"), {{1.0, 0.0, 0.0, 0.0}, {0.0, 0.0, 0.1}});
  }
  void choose(const char* list, const QString& name) {
    auto* box = d->widget<QComboBox>(list);
    box->setFocus();
    const int wanted = box->findText(name);
    for (int keys = 0; keys < box->count() && box->currentIndex() != wanted; ++keys)
      QTest::keyClick(box, box->currentIndex() < wanted ? Qt::Key_Down : Qt::Key_Up);
    QCOMPARE(box->currentText(), name);
  }
  void click(const char* button) { QTest::mouseClick(d->widget<QAbstractButton>(button), Qt::LeftButton); }
  void feel() {
    choose("hand", QStringLiteral("Fake arm"));
    click("startStop");
    QTRY_VERIFY(isFeltAt({0.0, 0.0, 0.1}));
  }
  bool isFeltAt(const glm::dvec3& place) const {
    return d->felt && glm::distance(d->felt->translation, place) < 1e-9;
  }

  FakeSource* source = new FakeSource;
  std::unique_ptr<DesktopDriver> d;
  std::shared_ptr<Handle> handle;
};

}  // namespace

class DesktopWorkspaceTest : public QObject {
  Q_OBJECT

 private slots:
  void theScaleMakesSmallMotionsLarge();
  void inAPlaneTheHandGoesAlongItAlone();
  void theClutchHoldsThePartWhileTheDeviceIsBroughtBack();
  void theClutchIsForADeviceInHand();
  void whatThereIsToSetDependsOnTheHand();
  void aDeviceThatSendsNoReportsHasNoRate();
};

void DesktopWorkspaceTest::theScaleMakesSmallMotionsLarge() {
  WorkspaceFixture f;
  f.feel();
  f.d->type<ui::NumberField>("panelScale", "5");
  QCOMPARE(f.d->session().scene().haptics().mapping.scale, 5.0);
  f.handle->moveTo({0.002, 0.003, 0.0});
  QTRY_VERIFY(f.isFeltAt({0.01, 0.015, 0.1}));
  f.d->choose("undo");
  QCOMPARE(f.d->widget<ui::NumberField>("panelScale")->quantity(), 1.0);
}

void DesktopWorkspaceTest::inAPlaneTheHandGoesAlongItAlone() {
  WorkspaceFixture f;
  f.choose("hand", QStringLiteral("Fake arm"));
  const std::size_t before = f.d->session().historyIndex();
  auto* freedom = f.d->widget<QComboBox>("panel-freedom");
  QVERIFY(freedom->isVisible());
  freedom->setFocus();
  QTest::keyClick(freedom, Qt::Key_Down);
  QCOMPARE(freedom->currentText(), QStringLiteral("In the XY plane"));
  QCOMPARE(f.d->session().historyIndex(), before + 1);
  QVERIFY(f.d->widget<QCheckBox>("panel-lockZ")->isChecked());
  QVERIFY(f.d->widget<QCheckBox>("panel-lockRx")->isChecked());
  QVERIFY(!f.d->widget<QCheckBox>("panel-lockX")->isChecked());
  f.feel();
  f.handle->moveTo({0.004, 0.0, 0.05});
  QTRY_VERIFY(f.isFeltAt({0.004, 0.0, 0.1}));
  // One lock by itself makes it something that has no name.
  QTest::mouseClick(f.d->widget<QCheckBox>("panel-lockX"), Qt::LeftButton, {}, QPoint(8, 8));
  QVERIFY(f.d->session().scene().haptics().mapping.translationLocks == (std::array{true, false, true}));
  QCOMPARE(freedom->currentText(), QStringLiteral("Other locks"));
  QCOMPARE(f.d->widget<QCheckBox>("lockX")->isChecked(), true);
}

void DesktopWorkspaceTest::theClutchHoldsThePartWhileTheDeviceIsBroughtBack() {
  WorkspaceFixture f;
  f.feel();
  f.handle->moveTo({0.003, 0.0, 0.0});
  QTRY_VERIFY(f.isFeltAt({0.003, 0.0, 0.1}));
  auto* note = f.d->widget<QLabel>("clutchNote");
  QVERIFY(!note->isVisible());
  f.click("clutchButton");
  QTRY_VERIFY(note->isVisible());
  QVERIFY(f.d->action("clutch")->isChecked());
  keepPictures(f.d->window(), QStringLiteral("feel-panel"));
  f.handle->moveTo({-0.05, 0.02, 0.0});
  QTest::qWait(100);
  QVERIFY(f.isFeltAt({0.003, 0.0, 0.1}));
  pressShortcut(*f.d, Qt::Key_F9);
  QTRY_VERIFY(!note->isVisible());
  QVERIFY(f.isFeltAt({0.003, 0.0, 0.1}));
  f.handle->moveTo({-0.05, 0.024, 0.0});
  QTRY_VERIFY(f.isFeltAt({0.003, 0.004, 0.1}));
}

void DesktopWorkspaceTest::theClutchIsForADeviceInHand() {
  WorkspaceFixture f;
  QVERIFY(!f.d->action("clutch")->isEnabled());
  f.feel();
  QVERIFY(f.d->action("clutch")->isEnabled());
  f.d->choose("clutch");
  QVERIFY(f.d->application.servo().status().isClutched);
  f.click("startStop");
  QVERIFY(!f.d->action("clutch")->isEnabled() && !f.d->action("clutch")->isChecked());
  // Off at each start.
  f.feel();
  f.handle->moveTo({0.003, 0.0, 0.0});
  QTRY_VERIFY(f.isFeltAt({0.003, 0.0, 0.1}));
}

void DesktopWorkspaceTest::whatThereIsToSetDependsOnTheHand() {
  WorkspaceFixture f;
  auto* scale = f.d->widget<ui::NumberField>("panelScale");
  auto* freedom = f.d->widget<QComboBox>("panel-freedom");
  f.choose("hand", QStringLiteral("Scripted hand"));
  QVERIFY(!scale->isVisible() && !freedom->isVisible());
  f.choose("hand", QStringLiteral("Manual hand"));
  QVERIFY(!scale->isVisible() && freedom->isVisible());
  f.choose("hand", QStringLiteral("Fake arm"));
  QVERIFY(scale->isVisible() && f.d->widget<QToolButton>("clutchButton")->isVisible());
  // A recording has been through scale and locks when it was made: neither would have an effect.
  auto* why = f.d->widget<QLabel>("recordedNote");
  QVERIFY(!why->isVisible());
  f.choose("hand", QStringLiteral("Recorded hand"));
  QVERIFY(!scale->isVisible() && !freedom->isVisible() && why->isVisible());
  QVERIFY(f.d->widget<QToolButton>("clutchButton")->isVisible());
  f.choose("hand", QStringLiteral("Fake arm"));
  QVERIFY(scale->isVisible() && freedom->isVisible() && !why->isVisible());
  f.choose("hand", QStringLiteral("Scripted hand"));
  QVERIFY(!freedom->isVisible());
}

void DesktopWorkspaceTest::aDeviceThatSendsNoReportsHasNoRate() {
  WorkspaceFixture f;
  auto* rate = f.d->widget<QLabel>("reportRate");
  QVERIFY(!rate->isVisible());
  f.feel();
  QTRY_VERIFY(rate->isVisible());
  QTRY_VERIFY(f.d->text("rate").endsWith(QStringLiteral("Hz")));
  QCOMPARE(rate->text(), QStringLiteral("–"));
  QCOMPARE(f.d->text("reportJitter"), QStringLiteral("–"));
}

NEARFIT_QT_SUITE(DesktopWorkspaceTest, runDesktopTest<DesktopWorkspaceTest>)
#include "desktop_workspace_test.moc"
