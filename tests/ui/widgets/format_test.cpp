#include "ui/widgets/format.h"

#include <QtTest>
#include <limits>

#include "tests/support/qt/qt_suite.h"
#include "ui/widgets/number_field.h"

using namespace nearfit::ui;

class FormatTest : public QObject {
  Q_OBJECT

 private slots:
  void lengthsTakeTheUnitOfTheirSize();
  void distancesSayWhetherTheyAreBounds();
  void lengthsKeepThreeFigures();
  void lengthsAreInTheUnitThatWasChosen();
  void noLengthIsADash();
  void roundLengthsHaveNoZerosBehind();
  void extentsHaveOneUnitForAllAxes();
  void smallTorquesAreInMillinewtonMetres();
  void massesAndEnergiesTakeTheUnitOfTheirSize();
  void numbersHaveNoZerosBehind();
  void durationsTakeTheUnitOfTheirSize();
  void decimalsAreThoseOfNumberFields();
};

void FormatTest::lengthsTakeTheUnitOfTheirSize() {
  QCOMPARE(formatLength(1.5), QStringLiteral("1.50 m"));
  QCOMPARE(formatLength(0.0015), QStringLiteral("1.50 mm"));
  QCOMPARE(formatLength(0.0), QStringLiteral("0.00 mm"));
  QCOMPARE(formatLength(2.5e-6), QStringLiteral("2.50 µm"));
}

void FormatTest::distancesSayWhetherTheyAreBounds() {
  QCOMPARE(formatDistance(0.00026, true), QStringLiteral("at least 0.26 mm"));
  QCOMPARE(formatDistance(0.00026, false), QStringLiteral("0.26 mm"));
  QCOMPARE(formatDistance(std::numeric_limits<double>::infinity(), true), QStringLiteral("–"));
}

void FormatTest::lengthsKeepThreeFigures() {
  QCOMPARE(formatLength(0.01234), QStringLiteral("12.3 mm"));
  QCOMPARE(formatLength(0.1234), QStringLiteral("123 mm"));
  QCOMPARE(formatLength(0.009996), QStringLiteral("10.0 mm"));
}

void FormatTest::lengthsAreInTheUnitThatWasChosen() {
  QCOMPARE(formatLength(0.0254, LengthUnit::Inch), QStringLiteral("1.00 in"));
  QCOMPARE(formatLength(0.00123, LengthUnit::Inch), QStringLiteral("0.0484 in"));
  QCOMPARE(formatLength(3.0, LengthUnit::Inch), QStringLiteral("118 in"));
  QCOMPARE(formatLength(2.54e-6, LengthUnit::Inch), QStringLiteral("100 µin"));
  QCOMPARE(formatLength(0.0, LengthUnit::Inch), QStringLiteral("0.00 in"));
  QCOMPARE(formatLength(0.01234, LengthUnit::Centimetre), QStringLiteral("1.23 cm"));
  QCOMPARE(formatLength(-0.005, LengthUnit::Metre), QStringLiteral("-0.00500 m"));
  QCOMPARE(formatLength(5e-5, LengthUnit::Metre), QStringLiteral("50.0 µm"));
  QCOMPARE(formatLength(0.01234, LengthUnit::Millimetre), formatLength(0.01234));
  setShownLengthUnit(LengthUnit::Inch);
  QCOMPARE(formatLength(0.0254), QStringLiteral("1.00 in"));
  setShownLengthUnit(LengthUnit::Millimetre);
}

void FormatTest::noLengthIsADash() {
  QCOMPARE(formatLength(std::numeric_limits<double>::infinity()), QStringLiteral("–"));
}

void FormatTest::roundLengthsHaveNoZerosBehind() {
  QCOMPARE(formatRoundLength(0.02), QStringLiteral("20 mm"));
  QCOMPARE(formatRoundLength(0.0005), QStringLiteral("0.5 mm"));
  QCOMPARE(formatRoundLength(5e-5), QStringLiteral("50 µm"));
  QCOMPARE(formatRoundLength(2.0), QStringLiteral("2 m"));
  setShownLengthUnit(LengthUnit::Inch);
  QCOMPARE(formatRoundLength(0.0254 / 5.0), QStringLiteral("0.2 in"));
  setShownLengthUnit(LengthUnit::Millimetre);
}

void FormatTest::extentsHaveOneUnitForAllAxes() {
  QCOMPARE(formatExtent({0.053, 0.016, 0.016}), QStringLiteral("53 × 16 × 16 mm"));
  QCOMPARE(formatExtent({53.0, 16.0, 0.25}), QStringLiteral("53 × 16 × 0.25 m"));
  QCOMPARE(formatExtent({5.3e-5, 1.6e-5, 0.0}), QStringLiteral("53 × 16 × 0 µm"));
  QCOMPARE(formatExtent({0.123456, 2e-6, 0.01}), QStringLiteral("123.5 × 0.002 × 10 mm"));
  QCOMPARE(formatExtent(glm::dvec3(0.0)), QStringLiteral("0 × 0 × 0 mm"));
  QCOMPARE(formatExtent({std::numeric_limits<double>::infinity(), 1.0, 1.0}), QStringLiteral("–"));
  setShownLengthUnit(LengthUnit::Inch);
  QCOMPARE(formatExtent({0.254, 0.0127, 0.0254}), QStringLiteral("10 × 0.5 × 1 in"));
  setShownLengthUnit(LengthUnit::Millimetre);
}

void FormatTest::smallTorquesAreInMillinewtonMetres() {
  QCOMPARE(formatTorque(0.0123), QStringLiteral("12.3 mN·m"));
  QCOMPARE(formatTorque(1.5), QStringLiteral("1.50 N·m"));
}

void FormatTest::massesAndEnergiesTakeTheUnitOfTheirSize() {
  QCOMPARE(formatMass(12.3), QStringLiteral("12.3 kg"));
  QCOMPARE(formatMass(0.0628), QStringLiteral("62.8 g"));
  QCOMPARE(formatMass(5e-7), QStringLiteral("0.50 mg"));
  QCOMPARE(formatMass(4.4e-9), QStringLiteral("4.40 µg"));
  QCOMPARE(formatMass(2e-12), QStringLiteral("2.00 ng"));
  QCOMPARE(formatMass(0.0), QStringLiteral("0.00 mg"));
  QCOMPARE(formatEnergy(-0.0368), QStringLiteral("-36.8 mJ"));
  QCOMPARE(formatEnergy(0.0), QStringLiteral("0.00 mJ"));
  QCOMPARE(formatEnergy(4e-6), QStringLiteral("4.00 µJ"));
}

void FormatTest::numbersHaveNoZerosBehind() {
  QCOMPARE(formatNumber(1600.0), QStringLiteral("1600"));
  QCOMPARE(formatNumber(1e6), QStringLiteral("1000000"));
  QCOMPARE(formatNumber(0.2), QStringLiteral("0.2"));
  QCOMPARE(formatNumber(5e-5), QStringLiteral("0.00005"));
  QCOMPARE(formatNumber(-1.23456), QStringLiteral("-1.235"));
  QCOMPARE(formatNumber(0.0), QStringLiteral("0"));
}

void FormatTest::durationsTakeTheUnitOfTheirSize() {
  QCOMPARE(formatDuration(1.2e-5), QStringLiteral("12.0 µs"));
  QCOMPARE(formatDuration(3.92e-3), QStringLiteral("3.92 ms"));
  QCOMPARE(formatDuration(2.0), QStringLiteral("2.00 s"));
}

// Fields said "0,25", and the mass beside them "8.00 g".
void FormatTest::decimalsAreThoseOfNumberFields() {
  const QLocale before;
  QLocale::setDefault(QLocale(QLocale::German, QLocale::Germany));
  NumberField field;
  field.setUnit(QStringLiteral(" mm"));
  field.setDecimals(2);
  field.setRange(0.0, 1e6);
  const auto inField = [&field](double value) {
    field.setValue(value);
    return field.text();
  };
  QCOMPARE(inField(0.25), QStringLiteral("0,25 mm"));
  QCOMPARE(formatLength(0.00025), inField(0.25));
  QCOMPARE(lengthIn(LengthUnit::Millimetre, 1.2345, 2), inField(1234.5));
  QCOMPARE(formatMass(0.008), QStringLiteral("8,00 g"));
  QCOMPARE(formatForce(3.42), QStringLiteral("3,42 N"));
  QCOMPARE(formatNumber(0.2), QStringLiteral("0,2"));
  QCOMPARE(formatNumber(1600.0), QStringLiteral("1600"));
  QCOMPARE(formatDuration(0.0013), QStringLiteral("1,30 ms"));
  QLocale::setDefault(before);
}

NEARFIT_QT_SUITE(FormatTest, nearfit::test::runQtTest<FormatTest>)
#include "format_test.moc"
