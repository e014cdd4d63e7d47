#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/text/quantity.h"

namespace nearfit {

/// Unit with this name or sign ("mm", "in", "\"", "°", "N"); std::nullopt if unknown.
std::optional<Unit> findUnit(std::string_view name) noexcept;

/// Comma-separated units of a dimension, for messages: "nm, µm, mm, cm, m, km, thou, in, ft". Empty if there
/// are none. Alternative spellings are left out.
std::string unitNames(const Dimension& dimension);

/// Name of a dimension with its article ("a length", "an area"), or "of another dimension".
std::string nameOf(const Dimension& dimension);

}  // namespace nearfit
