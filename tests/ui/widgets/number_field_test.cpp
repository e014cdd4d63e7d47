#include "ui/widgets/number_field.h"

#include <QApplication>
#include <QLineEdit>
#include <QSettings>
#include <QSignalSpy>
#include <QToolTip>
#include <QVBoxLayout>
#include <QtTest>
#include <cmath>
#include <memory>

#include "tests/support/qt/qt_suite.h"
#include "tests/support/temporary_folder.h"
#include "ui/shell/main_menus.h"
#include "ui/widgets/preferences.h"

using namespace nearfit;
using namespace nearfit::ui;

class NumberFieldTest : public QObject {
  Q_OBJECT

 private slots:
  void init();
  void cleanup();
  void takesUnitsAndArithmetic();
  void numbersWithoutUnitAreInTheShownOne();
  void relativeEditsGoOnFromWhatIsThere();
  void whatCannotBeReadStaysAndIsExplained();
  void faultsSurviveLosingTheFocusAndWhatIsShownMeanwhile();
  void aFieldThatActsAtOnceTakesBackWhatCannotBeReadWhenItIsLeft();
  void escapeTakesBack();
  void outOfLimitsIsSaidNotClamped();
  void stepsGoOnFromWhatWasTyped();
  void unitMenuChangesEveryLengthAndIsRemembered();
  void typedNumbersKeepMoreThanIsShown();
  void largeNumbersLeaveRoomForTheirUnit();
  void compoundUnitsConvert();
  void aDoubleClickSelectsTheWholeNumber();
  void aNumberThatChangesAfterReturnStaysSelected();
  void aFieldWithoutFocusHasNoCaret();
  void aDisabledFieldIsNotSelected();
  void toolTipTellsWhatCanBeTyped();

 private:
  QLineEdit* edit() const { return length_->findChild<QLineEdit*>(); }
  void type(NumberField* field, const QString& text) {
    field->setFocus();
    field->selectAll();
    QTest::keyClicks(field, text);
  }
  void enter(NumberField* field, const QString& text) {
    type(field, text);
    QTest::keyClick(field, Qt::Key_Return);
  }
  static bool isNear(double a, double b) { return std::abs(a - b) <= 1e-12 * (1.0 + std::abs(b)); }

  std::unique_ptr<QWidget> window_;
  NumberField *length_ = nullptr, *angle_ = nullptr, *stiffness_ = nullptr;
};

void NumberFieldTest::init() {
  Preferences::setLengthUnit(LengthUnit::Millimetre);
  window_ = std::make_unique<QWidget>();
  length_ = new NumberField(window_.get());
  length_->setLength(4);
  length_->setQuantityRange(-10.0, 10.0);
  length_->setQuantityStep(1e-3);
  angle_ = new NumberField(window_.get());
  angle_->setUnit(QStringLiteral("°"));
  angle_->setRange(-360.0, 360.0);
  stiffness_ = new NumberField(window_.get());
  stiffness_->setUnit(QStringLiteral(" N/m"));
  stiffness_->setQuantityRange(0.0, 1e6);
  auto* layout = new QVBoxLayout(window_.get());
  for (QWidget* field : {length_, angle_, stiffness_})
    layout->addWidget(field);
  window_->show();
  QVERIFY(QTest::qWaitForWindowExposed(window_.get()));
  QApplication::setActiveWindow(window_.get());
  length_->setFocus();
}

void NumberFieldTest::cleanup() {
  window_.reset();
}

void NumberFieldTest::takesUnitsAndArithmetic() {
  QSignalSpy edits(length_, &NumberField::quantityEdited);
  enter(length_, QStringLiteral("1/4 in"));
  QVERIFY(isNear(length_->quantity(), 0.00635));
  QCOMPARE(length_->text(), QStringLiteral("6.3500 mm"));
  enter(length_, QStringLiteral("2*(3 mm + 0,5 cm)"));
  QVERIFY(isNear(length_->quantity(), 0.016));
  QCOMPARE(edits.count(), 2);
  enter(angle_, QStringLiteral("pi/6 rad"));
  QVERIFY(isNear(angle_->quantity(), std::acos(-1.0) / 6.0));
  QCOMPARE(angle_->text(), QStringLiteral("30.00°"));
}

void NumberFieldTest::numbersWithoutUnitAreInTheShownOne() {
  enter(length_, QStringLiteral("12,5"));
  QVERIFY(isNear(length_->quantity(), 0.0125));
  // The unit that stands there may stay, or be typed.
  enter(length_, QStringLiteral("7.5 mm"));
  QVERIFY(isNear(length_->quantity(), 0.0075));
  edit()->setCursorPosition(0);
  QTest::keyClick(length_, Qt::Key_Delete);
  QTest::keyClicks(length_, QStringLiteral("8"));
  QTest::keyClick(length_, Qt::Key_Return);
  QVERIFY(isNear(length_->quantity(), 0.0085));
}

void NumberFieldTest::relativeEditsGoOnFromWhatIsThere() {
  length_->showQuantity(0.010);
  enter(length_, QStringLiteral("+= 5 mm"));
  QVERIFY(isNear(length_->quantity(), 0.015));
  // Once more is once: leaving the field adds nothing.
  angle_->setFocus();
  QVERIFY(isNear(length_->quantity(), 0.015));
  enter(length_, QStringLiteral("-=1/2 in"));
  QVERIFY(isNear(length_->quantity(), 0.0023));
  enter(length_, QStringLiteral("-5"));
  QVERIFY(isNear(length_->quantity(), -0.005));
}

void NumberFieldTest::whatCannotBeReadStaysAndIsExplained() {
  length_->showQuantity(0.010);
  QSignalSpy edits(length_, &NumberField::quantityEdited);
  enter(length_, QStringLiteral("12 foo + 3"));
  QVERIFY(length_->isFaulty());
  QCOMPARE(length_->text(), QStringLiteral("12 foo + 3"));
  QCOMPARE(edits.count(), 0);
  QCOMPARE(length_->quantity(), 0.010);
  QTRY_VERIFY(QToolTip::isVisible());
  QVERIFY2(QToolTip::text().contains(QStringLiteral("Character 4")), qPrintable(QToolTip::text()));
  QVERIFY(QToolTip::text().contains(QStringLiteral("foo")));
  QVERIFY(length_->accessibleDescription().contains(QStringLiteral("foo")));
  QCOMPARE(edit()->cursorPosition(), 3);
  // It is mended where it is.
  QTest::keyClick(length_, Qt::Key_Delete);
  QTest::keyClick(length_, Qt::Key_Delete);
  QTest::keyClick(length_, Qt::Key_Delete);
  QVERIFY(!length_->isFaulty());
  QTest::keyClick(length_, Qt::Key_Return);
  QVERIFY(isNear(length_->quantity(), 0.015));
  for (const char* wrong : {"3 mm * 2 mm", "30 deg", "2*(3", "", "1/0", "3 + 2 mm"}) {
    type(length_, QStringLiteral("x"));
    edit()->clear();
    QTest::keyClicks(length_, QLatin1String(wrong));
    QTest::keyClick(length_, Qt::Key_Return);
    QVERIFY2(length_->isFaulty(), wrong);
    QCOMPARE(length_->text(), QLatin1String(wrong));
    QVERIFY(isNear(length_->quantity(), 0.015));
  }
}

void NumberFieldTest::faultsSurviveLosingTheFocusAndWhatIsShownMeanwhile() {
  length_->showQuantity(0.010);
  type(length_, QStringLiteral("2*(3"));
  angle_->setFocus();
  QVERIFY(length_->isFaulty());
  QCOMPARE(length_->text(), QStringLiteral("2*(3"));
  // A servo that tells where the part is does not wipe it out.
  length_->showQuantity(0.020);
  QCOMPARE(length_->text(), QStringLiteral("2*(3"));
  length_->setFocus();
  edit()->end(false);
  QTest::keyClicks(length_, QStringLiteral(")"));
  angle_->setFocus();
  QVERIFY(!length_->isFaulty());
  QVERIFY(isNear(length_->quantity(), 0.006));
}

/// An "f" stayed in place of the pose while the part was felt and put down.
void NumberFieldTest::aFieldThatActsAtOnceTakesBackWhatCannotBeReadWhenItIsLeft() {
  length_->setActingAtOnce();
  length_->showQuantity(0.010);
  QSignalSpy edits(length_, &NumberField::quantityEdited), notes(length_, &NumberField::noted);
  type(length_, QStringLiteral("f"));
  // As when another window is looked at.
  QFocusEvent away(QEvent::FocusOut, Qt::ActiveWindowFocusReason);
  QCoreApplication::sendEvent(length_, &away);
  QCOMPARE(length_->text(), QStringLiteral("f"));
  angle_->setFocus();
  QVERIFY(!length_->isFaulty() && !length_->isUnsettled());
  QCOMPARE(length_->text(), QStringLiteral("10.0000 mm"));
  QCOMPARE(notes.count(), 1);
  const QString note = notes[0][0].toString();
  QVERIFY2(note.contains(QStringLiteral("“f” was taken back")) && !note.contains('\n'), qPrintable(note));
  length_->showQuantity(0.020);
  QCOMPARE(length_->text(), QStringLiteral("20.0000 mm"));
  // Also where Return has marked it before, and where the field is disabled meanwhile.
  enter(length_, QStringLiteral("2*(3"));
  QVERIFY(length_->isFaulty());
  length_->setEnabled(false);
  QVERIFY(!length_->isFaulty());
  QCOMPARE(length_->text(), QStringLiteral("20.0000 mm"));
  QCOMPARE(notes.count(), 2);
  QCOMPARE(edits.count(), 0);
  // What can be read counts as before.
  length_->setEnabled(true);
  type(length_, QStringLiteral("3"));
  angle_->setFocus();
  QVERIFY(isNear(length_->quantity(), 0.003));
  QCOMPARE(notes.count(), 2);
}

void NumberFieldTest::escapeTakesBack() {
  length_->showQuantity(0.010);
  enter(length_, QStringLiteral("nonsense"));
  QVERIFY(length_->isFaulty());
  QTest::keyClick(length_, Qt::Key_Escape);
  QVERIFY(!length_->isFaulty());
  QCOMPARE(length_->text(), QStringLiteral("10.0000 mm"));
  QCOMPARE(length_->quantity(), 0.010);
}

void NumberFieldTest::outOfLimitsIsSaidNotClamped() {
  enter(length_, QStringLiteral("11 m"));
  QVERIFY(length_->isFaulty());
  QVERIFY(length_->accessibleDescription().contains(QStringLiteral("10000 mm")));
  QCOMPARE(length_->quantity(), 0.0);
  enter(length_, QStringLiteral("10 m"));
  QVERIFY(isNear(length_->quantity(), 10.0));
}

void NumberFieldTest::stepsGoOnFromWhatWasTyped() {
  type(length_, QStringLiteral("1 cm"));
  QTest::keyClick(length_, Qt::Key_Up);
  QVERIFY(isNear(length_->quantity(), 0.011));
  type(length_, QStringLiteral("1 cm +"));
  QTest::keyClick(length_, Qt::Key_Up);
  QVERIFY(length_->isFaulty());
  QCOMPARE(length_->text(), QStringLiteral("1 cm +"));
}

void NumberFieldTest::unitMenuChangesEveryLengthAndIsRemembered() {
  UnitMenu menu(window_.get());
  length_->showQuantity(0.0254);
  QSignalSpy edits(length_, &NumberField::quantityEdited);
  menu.findChild<QAction*>(QStringLiteral("unit-in"))->trigger();
  QCOMPARE(length_->text(), QStringLiteral("1.00000 in"));
  QCOMPARE(length_->quantity(), 0.0254);
  QCOMPARE(edits.count(), 0);
  QCOMPARE(angle_->text(), QStringLiteral("0.00°"));
  enter(length_, QStringLiteral("3"));
  QVERIFY(isNear(length_->quantity(), 0.0762));
  enter(length_, QStringLiteral("10 mm"));
  QVERIFY(isNear(length_->quantity(), 0.010));
  QCOMPARE(Preferences::lengthUnit(), LengthUnit::Inch);
  NumberField later;
  later.setLength(3);
  QVERIFY(later.text().endsWith(QStringLiteral(" in")));
  UnitMenu again(window_.get());
  QVERIFY(again.findChild<QAction*>(QStringLiteral("unit-in"))->isChecked());
}

void NumberFieldTest::typedNumbersKeepMoreThanIsShown() {
  enter(length_, QStringLiteral("1/3 in"));
  QCOMPARE(length_->text(), QStringLiteral("8.4667 mm"));
  QVERIFY(isNear(length_->quantity(), 0.0254 / 3.0));
}

void NumberFieldTest::largeNumbersLeaveRoomForTheirUnit() {
  length_->setQuantityRange(-1e4, 1e4);
  length_->showQuantity(135.690994);
  QCOMPARE(length_->text(), QStringLiteral("135690.99 mm"));
  // The number itself is not rounded, by Return or a step either.
  length_->setFocus();
  QTest::keyClick(length_, Qt::Key_Return);
  QVERIFY(isNear(length_->quantity(), 135.690994));
  QTest::keyClick(length_, Qt::Key_Up);
  QVERIFY(isNear(length_->quantity(), 135.691994));
  length_->showQuantity(-1e4);
  QCOMPARE(length_->text(), QStringLiteral("-10000000.0 mm"));
  length_->showQuantity(1.0);
  QCOMPARE(length_->text(), QStringLiteral("1000.0000 mm"));
}

void NumberFieldTest::compoundUnitsConvert() {
  enter(stiffness_, QStringLiteral("2 N/mm"));
  QVERIFY(isNear(stiffness_->quantity(), 2000.0));
  QCOMPARE(stiffness_->text(), QStringLiteral("2000.00 N/m"));
}

void NumberFieldTest::aDoubleClickSelectsTheWholeNumber() {
  length_->showQuantity(0.0);
  const int inDecimals = edit()->fontMetrics().horizontalAdvance(QStringLiteral("0.00"));
  QTest::mouseDClick(edit(), Qt::LeftButton, {}, QPoint(inDecimals, edit()->height() / 2));
  QCOMPARE(edit()->selectedText(), QStringLiteral("0.0000 mm"));
  QTest::keyClicks(length_, QStringLiteral("12"));
  QTest::keyClick(length_, Qt::Key_Return);
  QVERIFY(isNear(length_->quantity(), 0.012));
}

void NumberFieldTest::aNumberThatChangesAfterReturnStaysSelected() {
  enter(length_, QStringLiteral("1"));
  for (const double shown : {-0.00015, 0.0125, -0.125, 0.003}) {
    length_->showQuantity(shown);
    QCOMPARE(edit()->selectedText(), length_->text());
  }
  QTest::keyClicks(length_, QStringLiteral("4"));
  QTest::keyClick(length_, Qt::Key_Return);
  QVERIFY(isNear(length_->quantity(), 0.004));
}

/// Two fields had one.
void NumberFieldTest::aFieldWithoutFocusHasNoCaret() {
  const int usual = QApplication::cursorFlashTime();
  QApplication::setCursorFlashTime(0);
  // A caret is seen to move.
  const auto hasCaret = [this] {
    QImage pictures[2];
    for (const int at : {0, 1}) {
      edit()->setCursorPosition(4 * at);
      pictures[at] = edit()->grab().toImage();
    }
    return pictures[0] != pictures[1];
  };
  type(length_, QStringLiteral("2*(3"));
  const bool hasItFirst = hasCaret();
  angle_->setFocus();
  const bool isFaulty = length_->isFaulty(), hasItLater = hasCaret();
  QApplication::setCursorFlashTime(usual);
  QVERIFY(hasItFirst && isFaulty);
  QVERIFY(!hasItLater);
  QCOMPARE(length_->text(), QStringLiteral("2*(3"));
}

/// After *New* it was.
void NumberFieldTest::aDisabledFieldIsNotSelected() {
  enter(length_, QStringLiteral("1"));
  length_->selectAll();
  // As while a dialog asks.
  QApplication::setActiveWindow(nullptr);
  QVERIFY(edit()->hasSelectedText());
  length_->setEnabled(false);
  QVERIFY(!edit()->hasSelectedText());
  length_->showQuantity(0.003);
  QVERIFY(!edit()->hasSelectedText());
}

void NumberFieldTest::toolTipTellsWhatCanBeTyped() {
  length_->setHelp(QStringLiteral("How far"));
  QHelpEvent event(QEvent::ToolTip, QPoint(5, 5), length_->mapToGlobal(QPoint(5, 5)));
  QApplication::sendEvent(length_, &event);
  QTRY_VERIFY(QToolTip::isVisible());
  for (const char* part : {"How far", "From -10000 to 10000 mm", "1/4 in", "+="})
    QVERIFY2(QToolTip::text().contains(QLatin1String(part)), part);
}

NEARFIT_QT_SUITE(NumberFieldTest, [](int argc, char** argv) {
  const test::TemporaryFolder settings;
  QSettings::setPath(QSettings::IniFormat, QSettings::UserScope,
                     QString::fromStdString(settings.path().string()));
  QSettings::setDefaultFormat(QSettings::IniFormat);
  QCoreApplication::setOrganizationName(QStringLiteral("nearfit-test"));
  return test::runQtTest<NumberFieldTest>(argc, argv);
})
#include "number_field_test.moc"
