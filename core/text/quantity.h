#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "core/error.h"

namespace nearfit {

/// What a quantity is, as exponents: a force is a length by a mass by a time to the power of -2.
struct Dimension {
  int length = 0, angle = 0, mass = 0, time = 0;
  bool operator==(const Dimension&) const = default;
};

/// A unit, and what one of it is in SI: {.dimension = {.length = 1}, .inSi = 1e-3} is a millimetre.
struct Unit {
  Dimension dimension;
  double inSi = 1.0;
};

/// A number that a user typed and that cannot be read.
class QuantityError : public UsageError {
 public:
  QuantityError(std::size_t position, const std::string& text, const std::string& problem,
                const std::string& remedy);
  /// Where in the text the mistake is [bytes]; its length when something is missing at the end.
  std::size_t position() const noexcept { return position_; }

 private:
  std::size_t position_;
};

/// Longest text that is read [bytes].
constexpr std::size_t kMaxQuantityBytes = 1000;

/// The unit of a text such as "mm", "N s/m", "kg/m³" or "%"; of no dimension for an empty one. Throws
/// QuantityError.
Unit unitNamed(std::string_view text);

/// A number with units and arithmetic, in SI: "12.5 mm", "1/4 in", "2*(3 mm + 0,5 cm)", "pi/6 rad",
/// "20 mm * sin(30 deg)".
///
/// A unit multiplies all that stands before it up to the next + or -: 1/4 in is a quarter of an inch. Point
/// and comma both are decimal separators, nothing separates thousands, and arguments are separated by
/// semicolons: "max(1,5 mm; 2 mm)". Functions: sqrt abs min max, sin cos tan of an angle, asin acos atan.
/// Dimensions are checked: an area is no length, and a number without unit cannot be added to a length.
///
/// @param shown  Unit that a number without any is in, and dimension that the result must have.
/// Throws QuantityError, also when the result is not finite. Not real-time safe.
double evaluateQuantity(std::string_view text, const Unit& shown);

/// As evaluateQuantity; a text that begins with += or -= is added to what is there, or taken from it, and one
/// that begins with *= or /= multiplies or divides it.
/// @param present  What is there, in SI.
double editedQuantity(std::string_view text, const Unit& shown, double present);

}  // namespace nearfit
