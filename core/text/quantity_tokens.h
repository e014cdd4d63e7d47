#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/text/quantity.h"

namespace nearfit {

/// A typed quantity with every number and unit replaced by a name, ready for an arithmetic parser: "1/4 in"
/// becomes "n0/n1*u0".
struct QuantityTokens {
  struct Number {
    double value = 0.0;
    bool isExponent = false;  ///< Follows a ^.
  };
  std::string expression;
  std::vector<std::size_t> origin;  ///< For each byte of the expression, its position in the text.
  std::vector<Number> numbers;      ///< n0, n1, ...
  std::vector<Unit> units;          ///< u0, u1, ...
};

/// True if `name` is a function that quantities may use.
bool isQuantityFunction(std::string_view name) noexcept;

/// Splits a typed quantity into tokens. Throws QuantityError.
/// @param wanted  Dimension whose units error messages suggest.
QuantityTokens tokenizeQuantity(std::string_view text, const Dimension& wanted);

}  // namespace nearfit
