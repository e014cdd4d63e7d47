#include "core/text/quantity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include <muParser.h>

#include "core/text/quantity_tokens.h"
#include "core/text/unit_table.h"
#include "core/text/utf8.h"

namespace nearfit {
namespace {

constexpr std::size_t kDimensions = 4;
using Scales = std::array<double, kDimensions>;  ///< For length, angle, mass, time.

/// State of an evaluation that functions depend on; trials find the dimension of the result.
struct Pass {
  double angle = 1.0;    ///< Scale of angles.
  bool isTrial = false;  ///< Numbers are arbitrary; choices between them and domains do not matter.
};

const Pass& passOf(const void* data) {
  return *static_cast<const Pass*>(data);
}

double sine(void* pass, double x) {
  return std::sin(x / passOf(pass).angle);
}
double cosine(void* pass, double x) {
  return std::cos(x / passOf(pass).angle);
}
double tangent(void* pass, double x) {
  return std::tan(x / passOf(pass).angle);
}
/// Inverse function; a trial uses one that is defined everywhere.
template <double (*Of)(double)>
double inverse(void* pass, double x) {
  const Pass& is = passOf(pass);
  return is.angle * (is.isTrial ? std::atan(x) : Of(x));
}
double root(void* pass, double x) {
  return std::sqrt(passOf(pass).isTrial ? std::abs(x) : x);
}
double magnitude(void* /*pass*/, double x) {
  return std::abs(x);
}
/// Min or max of arguments of equal dimension. A trial takes their sum, which reveals differing dimensions.
template <bool IsMost>
double extreme(void* pass, const double* values, int count) {
  double result = values[0];
  for (int i = 1; i < count; ++i) {
    if (passOf(pass).isTrial) {
      result += values[i];
    } else {
      result = IsMost ? std::max(result, values[i]) : std::min(result, values[i]);
    }
  }
  return result;
}

double power(double base, int exponent) {
  return std::pow(base, exponent);
}

double scaleOf(const Dimension& d, const Scales& scales) {
  return power(scales[0], d.length) * power(scales[1], d.angle) * power(scales[2], d.mass) *
         power(scales[3], d.time);
}

std::string problemOf(mu::EErrorCodes code) {
  switch (code) {
    case mu::ecUNEXPECTED_EOF:
    case mu::ecUNEXPECTED_CONDITIONAL:
      return "the expression is incomplete";
    case mu::ecMISSING_PARENS:
      return "a bracket is not closed";
    case mu::ecUNEXPECTED_PARENS:
      return "unexpected bracket";
    case mu::ecUNEXPECTED_OPERATOR:
      return "unexpected operator";
    case mu::ecUNEXPECTED_ARG_SEP:
    case mu::ecUNEXPECTED_ARG:
      return "semicolon outside a function";
    case mu::ecTOO_FEW_PARAMS:
      return "the function needs more arguments";
    case mu::ecTOO_MANY_PARAMS:
      return "the function takes fewer arguments";
    case mu::ecUNEXPECTED_VAR:
    case mu::ecUNEXPECTED_VAL:
    case mu::ecUNEXPECTED_FUN:
      return "an operator is missing before this";
    default:
      return "it cannot be read beyond this point";
  }
}

/// Evaluates one text, repeatedly for trials.
class Evaluation {
 public:
  Evaluation(std::string_view text, const Dimension& wanted)
      : text_(text), tokens_(tokenizeQuantity(text, wanted)) {
    numbers_.resize(tokens_.numbers.size());
    units_.resize(tokens_.units.size());
    if (tokens_.expression.empty()) fail(text_.size(), "there is no number", "type one");
    define();
  }

  [[noreturn]] void fail(std::size_t position, const std::string& problem, const std::string& remedy) const {
    throw QuantityError(position, text_, problem, remedy);
  }

  double value() { return evaluate({1.0, 1.0, 1.0, 1.0}, {}); }

  /// Dimension of the result; std::nullopt if the dimensions of its terms do not match.
  std::optional<Dimension> dimension() {
    // More than one trial, since the numbers of one may lie outside the domain of a power or function.
    constexpr unsigned kTrials = 8;
    for (unsigned trial = 1; trial <= kTrials; ++trial) {
      if (!std::isfinite(evaluate({1.0, 1.0, 1.0, 1.0}, trial))) continue;
      return dimensionOfTrial(trial);
    }
    return std::nullopt;
  }

 private:
  void define() {
    try {
      parser_.ClearFun();
      parser_.ClearConst();
      parser_.DefineFunUserData("sin", sine, &pass_, false);
      parser_.DefineFunUserData("cos", cosine, &pass_, false);
      parser_.DefineFunUserData("tan", tangent, &pass_, false);
      parser_.DefineFunUserData("asin", inverse<std::asin>, &pass_, false);
      parser_.DefineFunUserData("acos", inverse<std::acos>, &pass_, false);
      parser_.DefineFunUserData("atan", inverse<std::atan>, &pass_, false);
      parser_.DefineFunUserData("sqrt", root, &pass_, false);
      parser_.DefineFunUserData("abs", magnitude, &pass_, false);
      parser_.DefineFunUserData("min", extreme<false>, &pass_, false);
      parser_.DefineFunUserData("max", extreme<true>, &pass_, false);
      for (std::size_t i = 0; i < numbers_.size(); ++i)
        parser_.DefineVar("n" + std::to_string(i), &numbers_[i]);
      for (std::size_t i = 0; i < units_.size(); ++i)
        parser_.DefineVar("u" + std::to_string(i), &units_[i]);
      parser_.SetExpr(tokens_.expression);
    } catch (const mu::ParserError& error) {
      fail(error);
    }
  }

  [[noreturn]] void fail(const mu::ParserError& error) const {
    const int at = error.GetPos();
    const bool isInside = at >= 0 && static_cast<std::size_t>(at) < tokens_.origin.size();
    // The parser reports where it noticed the error; for missing tokens that is past the last one.
    const bool isAtEnd =
        error.GetCode() == mu::ecUNEXPECTED_EOF || error.GetCode() == mu::ecMISSING_PARENS || !isInside;
    fail(isAtEnd ? text_.size() : tokens_.origin[static_cast<std::size_t>(at)], problemOf(error.GetCode()),
         "write for example 12.5 mm or 2*(3 + 4)");
  }

  /// @param trial  0: with the numbers as typed; otherwise the seed of arbitrary ones.
  double evaluate(const Scales& scales, unsigned trial) {
    pass_ = {scales[1], trial != 0};
    for (std::size_t i = 0; i < numbers_.size(); ++i) {
      const QuantityTokens::Number& number = tokens_.numbers[i];
      // Multiples of the golden ratio are spread evenly, and no sum of a few of them equals another.
      const double any = 1.0 + std::fmod(0.6180339887498949 * double(i + 1) * double(trial), 1.0);
      numbers_[i] = trial == 0 || number.isExponent ? number.value : any;
    }
    for (std::size_t i = 0; i < units_.size(); ++i)
      units_[i] = (trial == 0 ? tokens_.units[i].inSi : 1.0) * scaleOf(tokens_.units[i].dimension, scales);
    try {
      int count = 0;
      const double* results = parser_.Eval(count);
      if (count != 1) fail(text_.size(), "several numbers", "write one; the decimal separator is . or ,");
      return results[0];
    } catch (const mu::ParserError& error) {
      fail(error);
    }
  }

  /// A sum of terms of one dimension scales as a power of the units' size: in units half as large, the number
  /// of a length doubles and that of an area quadruples.
  std::optional<Dimension> dimensionOfTrial(unsigned trial) {
    constexpr double kRounding = 1e-7;
    const double plain = evaluate({1.0, 1.0, 1.0, 1.0}, trial);
    std::array<int, kDimensions> exponents{};
    for (std::size_t d = 0; d < kDimensions; ++d) {
      Scales twice{1.0, 1.0, 1.0, 1.0}, thrice = twice;
      twice[d] = 2.0;
      thrice[d] = 3.0;
      const double ratio = evaluate(twice, trial) / plain, other = evaluate(thrice, trial) / plain;
      if (!(ratio > 0.0) || !(other > 0.0)) return std::nullopt;
      const double exponent = std::log2(ratio), rounded = std::round(exponent);
      if (!(std::abs(exponent - rounded) < kRounding) || std::abs(rounded) > 100.0) return std::nullopt;
      if (!(std::abs(std::log(other) - rounded * std::log(3.0)) < kRounding)) return std::nullopt;
      exponents[d] = static_cast<int>(rounded);
    }
    return Dimension{exponents[0], exponents[1], exponents[2], exponents[3]};
  }

  std::string text_;
  QuantityTokens tokens_;
  mu::Parser parser_;
  std::vector<double> numbers_, units_;
  Pass pass_;
};

void checkLength(std::string_view text) {
  if (text.size() <= kMaxQuantityBytes) return;
  throw QuantityError(kMaxQuantityBytes, truncatedUtf8(text, 40) + "…", "it is too long",
                      "write a shorter one");
}

}  // namespace

QuantityError::QuantityError(std::size_t position, const std::string& text, const std::string& problem,
                             const std::string& remedy)
    : UsageError("“" + text + "”", problem, remedy), position_(position) {}

Unit unitNamed(std::string_view text) {
  checkLength(text);
  if (text.find_first_not_of(' ') == std::string_view::npos) return {};
  Evaluation evaluation(text, {});
  const std::optional<Dimension> dimension = evaluation.dimension();
  if (!dimension) evaluation.fail(0, "it is not a unit", "use for example mm or N s/m");
  return {*dimension, evaluation.value()};
}

double evaluateQuantity(std::string_view text, const Unit& shown) {
  checkLength(text);
  const std::string units = unitNames(shown.dimension);
  const std::string fitting = units.empty() ? "leave the unit out" : "use one of " + units + ", or none";
  Evaluation evaluation(text, shown.dimension);
  const std::optional<Dimension> dimension = evaluation.dimension();
  if (!dimension) {
    evaluation.fail(0, "its units do not match", "give all numbers of a sum units of the same kind, or none");
  }
  if (*dimension != Dimension{} && *dimension != shown.dimension) {
    evaluation.fail(0, "it is " + nameOf(*dimension) + ", but " + nameOf(shown.dimension) + " is expected",
                    fitting);
  }
  const double value = evaluation.value() * (*dimension == Dimension{} ? shown.inSi : 1.0);
  if (!std::isfinite(value)) {
    evaluation.fail(0, "its value is not finite",
                    "look for a division by zero or a root of a negative number");
  }
  return value;
}

double editedQuantity(std::string_view text, const Unit& shown, double present) {
  const std::size_t first = std::min(text.find_first_not_of(" \t"), text.size());
  const std::string_view edit = text.substr(first);
  const bool isRelative =
      edit.size() >= 2 && edit[1] == '=' && std::string_view("+-*/").find(edit[0]) != std::string_view::npos;
  if (!isRelative) return evaluateQuantity(text, shown);
  const bool isFactor = edit[0] == '*' || edit[0] == '/';
  double operand = 0.0;
  try {
    operand = evaluateQuantity(edit.substr(2), isFactor ? Unit{} : shown);
  } catch (const QuantityError& error) {
    throw QuantityError(first + 2 + error.position(), std::string(text), error.problem(), error.remedy());
  }
  const double result = edit[0] == '+'   ? present + operand
                        : edit[0] == '-' ? present - operand
                        : edit[0] == '*' ? present * operand
                                         : present / operand;
  if (!std::isfinite(result))
    throw QuantityError(first, std::string(text), "its value is not finite", "divide by another number");
  return result;
}

}  // namespace nearfit
