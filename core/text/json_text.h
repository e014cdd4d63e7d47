#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace nearfit {

/// JSON as a person would lay it out: two spaces a level, arrays of plain values on one line, a newline at
/// the end. Doubles with the fewest digits that read back as the same double. Strings must be UTF-8.
std::string prettyJson(const nlohmann::ordered_json& value);

/// The double with the fewest digits that is nearest to the float: 0.62, not 0.62000000476837158.
/// Cast back to float it is the same float.
double shortestDouble(float value);

}  // namespace nearfit
