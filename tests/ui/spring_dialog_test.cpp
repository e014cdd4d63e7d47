#include "ui/dialogs/spring_dialog.h"

#include <QDoubleSpinBox>
#include <QtTest>
#include <optional>

#include "core/scene/haptic_limits.h"

using namespace nearfit;

class SpringDialogTest : public QObject {
  Q_OBJECT

 private slots:
  void init();
  void changesOnlyTheFieldThatWasEdited();
  void offersWhatASceneAllowsAndNoMore();
  void showingIsNoEdit();
  void unitOfStiffnessFollowsTheLaw();

 private:
  QDoubleSpinBox* field(const char* name) { return dialog_->findChild<QDoubleSpinBox*>(QLatin1String(name)); }
  void type(const char* name, const char* number) {
    field(name)->selectAll();
    QTest::keyClicks(field(name), QLatin1String(number));
    QTest::keyClick(field(name), Qt::Key_Return);
  }

  std::unique_ptr<ui::SpringDialog> dialog_;
  std::optional<SpringParameters> edited_;
};

void SpringDialogTest::init() {
  dialog_ = std::make_unique<ui::SpringDialog>();
  edited_.reset();
  connect(dialog_.get(), &ui::SpringDialog::springsEdited, this,
          [this](const SpringParameters& springs) { edited_ = springs; });
}

void SpringDialogTest::changesOnlyTheFieldThatWasEdited() {
  // A cutoff with more digits than the field shows.
  const SpringParameters before{1.23456789e-3, 333.333333, 0.123456789, SpringLaw::Linear};
  dialog_->showSprings(before);
  type("stiffness", "500");
  QVERIFY(edited_);
  QCOMPARE(edited_->stiffness, 500.0);
  QCOMPARE(edited_->cutoff, before.cutoff);
  QCOMPARE(edited_->damping, before.damping);
  type("cutoff", "2.5");
  QVERIFY(std::abs(edited_->cutoff - 2.5e-3) < 1e-18);
  QCOMPARE(edited_->stiffness, 500.0);
}

void SpringDialogTest::offersWhatASceneAllowsAndNoMore() {
  QCOMPARE(field("cutoff")->minimum(), kMinCutoff * 1e3);
  QCOMPARE(field("cutoff")->maximum(), kMaxCutoff * 1e3);
  QCOMPARE(field("stiffness")->maximum(), kMaxStiffness);
  QCOMPARE(field("damping")->minimum(), kMinDamping);
  type("damping", "-3");
  QVERIFY2(!edited_ || edited_->damping >= 0.0, "damping that drives is refused");
}

void SpringDialogTest::showingIsNoEdit() {
  dialog_->showSprings({0.5, 10.0, 1.0, SpringLaw::Printed});
  QVERIFY(!edited_);
  QCOMPARE(field("cutoff")->value(), 500.0);
}

void SpringDialogTest::unitOfStiffnessFollowsTheLaw() {
  dialog_->showSprings({0.01, 10.0, 0.0, SpringLaw::Linear});
  QCOMPARE(field("stiffness")->suffix(), QStringLiteral(" N/m"));
  dialog_->showSprings({0.01, 10.0, 0.0, SpringLaw::Printed});
  QCOMPARE(field("stiffness")->suffix(), QStringLiteral(" N/m²"));
}

QTEST_MAIN(SpringDialogTest)
#include "spring_dialog_test.moc"
