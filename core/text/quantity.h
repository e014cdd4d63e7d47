#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "core/base/error.h"

namespace nearfit {

/// Physical dimension as exponents; a force has {length 1, mass 1, time -2}.
struct Dimension {
  int length = 0, angle = 0, mass = 0, time = 0;
  bool operator==(const Dimension&) const = default;
};

/// A unit and its size in SI; a millimetre is {.dimension = {.length = 1}, .inSi = 1e-3}.
struct Unit {
  Dimension dimension;
  double inSi = 1.0;
};

/// Typed text that is not a valid quantity.
class QuantityError : public UsageError {
 public:
  QuantityError(std::size_t position, const std::string& text, const std::string& problem,
                const std::string& remedy);
  /// Position of the mistake in the text [bytes]; the text's length if something is missing at the end.
  std::size_t position() const noexcept { return position_; }

 private:
  std::size_t position_;
};

/// Max length of a text [bytes].
constexpr std::size_t kMaxQuantityBytes = 1000;

/// Unit written as "mm", "N s/m", "kg/m³" or "%"; dimensionless for an empty text. Throws QuantityError.
Unit unitNamed(std::string_view text);

/// Evaluates a number with units and arithmetic, and returns it in SI: "12.5 mm", "1/4 in",
/// "2*(3 mm + 0,5 cm)", "pi/6 rad", "20 mm * sin(30 deg)".
///
/// A unit multiplies everything before it back to the last + or -: 1/4 in is a quarter of an inch. Point and
/// comma are both decimal separators; there is no thousands separator. Semicolons separate arguments:
/// "max(1,5 mm; 2 mm)". Functions: sqrt, abs, min, max; sin, cos, tan of an angle; asin, acos, atan.
/// Dimensions are checked: an area is not a length, and a number without unit cannot be added to a length.
///
/// @param shown  Unit of a result without units, and the dimension required of any other result.
/// Throws QuantityError, also if the result is not finite. Not real-time safe.
double evaluateQuantity(std::string_view text, const Unit& shown);

/// Like evaluateQuantity(), but a text that begins with +=, -=, *= or /= changes the present value.
/// @param present  Present value, in SI.
double editedQuantity(std::string_view text, const Unit& shown, double present);

}  // namespace nearfit
