#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/text/quantity.h"

namespace nearfit {

/// A unit by its name or sign ("mm", "in", "\"", "°", "N"); nothing when there is none of that name.
std::optional<Unit> findUnit(std::string_view name) noexcept;

/// The names of the units of a dimension, for messages: "nm, µm, mm, cm, m, km, in, ft". Empty when none is.
std::string unitNames(const Dimension& dimension);

/// What a dimension is called, with its article: "a length", "an area".
std::string nameOf(const Dimension& dimension);

}  // namespace nearfit
