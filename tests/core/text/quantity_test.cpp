#include "core/text/quantity.h"

#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include <gtest/gtest.h>

namespace nearfit::quantity_test {
namespace {

const Unit kMillimetre{{.length = 1}, 1e-3};
const Unit kDegree{{.angle = 1}, std::numbers::pi / 180.0};
const Unit kPlain{};

double lengthOf(const std::string& text) {
  return evaluateQuantity(text, kMillimetre);
}
double angleOf(const std::string& text) {
  return evaluateQuantity(text, kDegree);
}

/// What is said of a text, and where.
struct Refusal {
  std::size_t position = std::string::npos;
  std::string problem, remedy;
};
Refusal refusalOf(const std::string& text, const Unit& unit = kMillimetre) {
  try {
    const double value = evaluateQuantity(text, unit);
    ADD_FAILURE() << "“" << text << "” was read as " << value;
  } catch (const QuantityError& error) {
    EXPECT_FALSE(error.remedy().empty()) << text;
    return {error.position(), error.problem(), error.remedy()};
  }
  return {};
}

TEST(Quantity, NumbersWithoutUnitAreInTheShownOne) {
  EXPECT_DOUBLE_EQ(lengthOf("12.5"), 0.0125);
  EXPECT_DOUBLE_EQ(lengthOf(" -3 "), -0.003);
  EXPECT_DOUBLE_EQ(lengthOf("2*(3+4)"), 0.014);
  EXPECT_DOUBLE_EQ(angleOf("90"), std::numbers::pi / 2.0);
  EXPECT_DOUBLE_EQ(evaluateQuantity("7", kPlain), 7.0);
}

TEST(Quantity, UnitsConvert) {
  EXPECT_DOUBLE_EQ(lengthOf("12.5 mm"), 0.0125);
  EXPECT_DOUBLE_EQ(lengthOf("12.5mm"), 0.0125);
  EXPECT_DOUBLE_EQ(lengthOf("1 in"), 0.0254);
  EXPECT_DOUBLE_EQ(lengthOf("1\""), 0.0254);
  EXPECT_DOUBLE_EQ(lengthOf("1 ft"), 0.3048);
  EXPECT_DOUBLE_EQ(lengthOf("850 µm"), 850e-6);
  EXPECT_DOUBLE_EQ(lengthOf("850 um"), 850e-6);
  EXPECT_DOUBLE_EQ(lengthOf("1e-3 m"), 0.001);
  EXPECT_DOUBLE_EQ(angleOf("90 deg"), std::numbers::pi / 2.0);
  EXPECT_DOUBLE_EQ(angleOf("90°"), std::numbers::pi / 2.0);
  EXPECT_DOUBLE_EQ(angleOf("0.25 rev"), std::numbers::pi / 2.0);
}

TEST(Quantity, AUnitBelongsToAllOfItsTerm) {
  EXPECT_DOUBLE_EQ(lengthOf("1/4 in"), 0.00635);
  EXPECT_DOUBLE_EQ(lengthOf("1 in + 1/4 in"), 0.03175);
  EXPECT_DOUBLE_EQ(lengthOf("2*(3 mm + 0.5 cm)"), 0.016);
  EXPECT_DOUBLE_EQ(lengthOf("(1 + 2) mm"), 0.003);
  EXPECT_DOUBLE_EQ(angleOf("pi/6 rad"), std::numbers::pi / 6.0);
  EXPECT_DOUBLE_EQ(angleOf("2 pi rad"), 2.0 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(lengthOf("-2^2 mm"), -0.004);
}

TEST(Quantity, PointAndCommaBothSeparateDecimals) {
  EXPECT_DOUBLE_EQ(lengthOf("12,5"), 0.0125);
  EXPECT_DOUBLE_EQ(lengthOf(",5 mm + .25 mm"), 0.00075);
  EXPECT_DOUBLE_EQ(lengthOf("max(1,5 mm; 2,5 mm)"), 0.0025);
  EXPECT_EQ(refusalOf("1,234.5").position, 5U);
  EXPECT_EQ(refusalOf("1.234.567").position, 5U);
}

TEST(Quantity, FunctionsTakeWhatTheyAreDefinedFor) {
  EXPECT_DOUBLE_EQ(lengthOf("20 mm * sin(30 deg)"), 0.02 * std::sin(std::numbers::pi / 6.0));
  EXPECT_DOUBLE_EQ(lengthOf("sqrt((3 mm)^2 + (4 mm)^2)"), 0.005);
  EXPECT_DOUBLE_EQ(angleOf("atan(3 mm / (4 mm))"), std::atan(0.75));
  EXPECT_DOUBLE_EQ(angleOf("asin(0,5)"), std::asin(0.5));
  EXPECT_DOUBLE_EQ(lengthOf("abs(-2 mm) + min(4 mm; 3 mm; 5 mm)"), 0.005);
  // Degrees or radians? It has to be said.
  EXPECT_NE(refusalOf("10 mm * sin(30)").problem.find("do not match"), std::string::npos);
}

TEST(Quantity, DimensionsAreChecked) {
  EXPECT_NE(refusalOf("3 mm * 2 mm").problem.find("an area"), std::string::npos);
  EXPECT_NE(refusalOf("3 mm * 2 mm").problem.find("a length is expected"), std::string::npos);
  EXPECT_NE(refusalOf("30 deg").problem.find("an angle"), std::string::npos);
  EXPECT_NE(refusalOf("1 mm", kDegree).problem.find("an angle is expected"), std::string::npos);
  EXPECT_NE(refusalOf("1 mm", kPlain).problem.find("number without unit is expected"), std::string::npos);
  for (const char* mixed : {"3 + 5 mm", "3 mm + 2 deg", "1 mm + 1 mm^2", "max(3; 4 mm)", "2^(3 mm)"})
    EXPECT_NE(refusalOf(mixed).problem.find("do not match"), std::string::npos) << mixed;
}

TEST(Quantity, ZerosDoNotHideADimension) {
  EXPECT_EQ(lengthOf("0 mm"), 0.0);
  EXPECT_EQ(lengthOf("5 mm - 5 mm"), 0.0);
  EXPECT_FALSE(refusalOf("0 mm + 3").problem.empty());
  EXPECT_FALSE(refusalOf("0 mm * 2 mm").problem.empty());
  EXPECT_FALSE(refusalOf("0 deg").problem.empty());
}

TEST(Quantity, CompoundUnitsAreRead) {
  EXPECT_DOUBLE_EQ(unitNamed("N/mm").inSi, 1000.0);
  EXPECT_DOUBLE_EQ(evaluateQuantity("2 N/mm", unitNamed(" N/m")), 2000.0);
  EXPECT_DOUBLE_EQ(evaluateQuantity("7.85 g/cm³", unitNamed(" kg/m³")), 7850.0);
  EXPECT_DOUBLE_EQ(evaluateQuantity("5", unitNamed(" %")), 0.05);
  EXPECT_DOUBLE_EQ(evaluateQuantity("180 deg/s", unitNamed(" °/s")), std::numbers::pi);
  EXPECT_EQ(unitNamed(" N·m·s/rad").dimension, (Dimension{.length = 2, .angle = -1, .mass = 1, .time = -1}));
  EXPECT_EQ(unitNamed("").dimension, Dimension{});
  EXPECT_FALSE(refusalOf("2 N", unitNamed("N/m")).problem.empty());
}

TEST(Quantity, MistakesAreShownWhereTheyAre) {
  EXPECT_EQ(refusalOf("12 foo").position, 3U);
  EXPECT_NE(refusalOf("12 foo").problem.find("foo"), std::string::npos);
  EXPECT_NE(refusalOf("12 foo").remedy.find("mm"), std::string::npos);
  EXPECT_EQ(refusalOf("3 4").position, 2U);
  EXPECT_EQ(refusalOf("2*(3+4").position, 6U);
  EXPECT_NE(refusalOf("2*(3+4").problem.find("not closed"), std::string::npos);
  EXPECT_EQ(refusalOf("5 +").position, 3U);
  EXPECT_EQ(refusalOf("").position, 0U);
  EXPECT_EQ(refusalOf("3 $ 4").position, 2U);
  EXPECT_EQ(refusalOf("sin 30").position, 3U);
  EXPECT_FALSE(refusalOf("1/0").problem.empty());
  EXPECT_FALSE(refusalOf("sqrt(-1)").problem.empty());
  EXPECT_FALSE(refusalOf("1e999").problem.empty());
  EXPECT_FALSE(refusalOf("1;2").problem.empty());
  EXPECT_FALSE(refusalOf(std::string(2000, '(')).problem.empty());
  EXPECT_FALSE(refusalOf("1=2").problem.empty());
}

TEST(Quantity, EditsGoOnFromWhatIsThere) {
  EXPECT_DOUBLE_EQ(editedQuantity("+= 5 mm", kMillimetre, 0.010), 0.015);
  EXPECT_DOUBLE_EQ(editedQuantity(" -=0.5", kMillimetre, 0.010), 0.0095);
  EXPECT_DOUBLE_EQ(editedQuantity("*= 2", kMillimetre, 0.010), 0.020);
  EXPECT_DOUBLE_EQ(editedQuantity("/=4", kMillimetre, 0.010), 0.0025);
  EXPECT_DOUBLE_EQ(editedQuantity("+5", kMillimetre, 0.010), 0.005);
  EXPECT_DOUBLE_EQ(editedQuantity("-5", kMillimetre, 0.010), -0.005);
  EXPECT_THROW(editedQuantity("*= 2 mm", kMillimetre, 0.010), QuantityError);
  EXPECT_THROW(editedQuantity("/= 0", kMillimetre, 0.010), QuantityError);
  try {
    editedQuantity("+= 5 foo", kMillimetre, 0.0);
    ADD_FAILURE();
  } catch (const QuantityError& error) {
    EXPECT_EQ(error.position(), 5U);
  }
}

/// A sum or product of random literals with its value, of known dimension, built with no parser.
struct Made {
  std::string text;
  double value;
};
Made lengthMade(std::mt19937_64& random, int depth);
Made numberMade(std::mt19937_64& random) {
  const auto quarters = static_cast<int>(random() % 40) + 1;
  return {std::to_string(quarters) + "/4", quarters / 4.0};
}
Made lengthMade(std::mt19937_64& random, int depth) {
  static const std::pair<const char*, double> kUnits[] = {
      {"mm", 1e-3}, {"cm", 1e-2}, {"in", 0.0254}, {"m", 1.0}};
  const Made number = numberMade(random);
  if (depth == 0) {
    const auto& [name, size] = kUnits[random() % 4];
    return {number.text + " " + name, number.value * size};
  }
  const Made a = lengthMade(random, depth - 1), b = lengthMade(random, depth - 1);
  switch (random() % 4) {
    case 0:
      return {"(" + a.text + " + " + b.text + ")", a.value + b.value};
    case 1:
      return {"(" + a.text + " - (" + b.text + "))", a.value - b.value};
    case 2:
      return {"(" + number.text + ")*(" + a.text + ")", number.value * a.value};
    default:
      return {"(" + a.text + ")/(" + number.text + ")", a.value / number.value};
  }
}

TEST(Quantity, RandomSumsOfLengthsHaveTheirValueAndRandomProductsAreRefused) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 300; ++i) {
    const Made made = lengthMade(random, static_cast<int>(random() % 4));
    EXPECT_NEAR(lengthOf(made.text), made.value, 1e-12 * (1.0 + std::abs(made.value))) << made.text;
    const Made other = lengthMade(random, 1);
    EXPECT_THROW(lengthOf("(" + made.text + ")*(" + other.text + ")"), QuantityError) << made.text;
    EXPECT_THROW(lengthOf(made.text + " + 1"), QuantityError) << made.text;
  }
}

TEST(Quantity, RandomBytesAreReadOrRefused) {
  std::mt19937_64 random(11);
  const std::string alphabet = "0123456789.,;+-*/^()e mcinpi°²'\"sqrtabdg=%\xC2\xB5\xFF\n";
  for (int i = 0; i < 5000; ++i) {
    std::string text;
    for (std::size_t n = random() % 20; n > 0; --n)
      text += alphabet[random() % alphabet.size()];
    try {
      EXPECT_TRUE(std::isfinite(editedQuantity(text, kMillimetre, 1.0))) << text;
    } catch (const QuantityError& error) {
      EXPECT_LE(error.position(), text.size()) << text;
      EXPECT_FALSE(error.problem().empty()) << text;
    }
  }
}

}  // namespace
}  // namespace nearfit::quantity_test
