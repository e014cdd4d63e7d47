#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/text/quantity.h"

namespace nearfit {

/// A typed quantity with every number and unit as a name, for a parser of arithmetic: "1/4 in" becomes
/// "n0/n1*u0".
struct QuantityTokens {
  struct Number {
    double value = 0.0;
    bool isExponent = false;  ///< Stands behind a ^.
  };
  std::string expression;
  std::vector<std::size_t> origin;  ///< Of each byte of the expression, in the text.
  std::vector<Number> numbers;      ///< n0, n1, ...
  std::vector<Unit> units;          ///< u0, u1, ...
};

/// The functions that may be used.
bool isQuantityFunction(std::string_view name) noexcept;

/// @param wanted  For messages: what units would do.
/// Throws QuantityError.
QuantityTokens tokenizeQuantity(std::string_view text, const Dimension& wanted);

}  // namespace nearfit
