#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace nearfit {

/// Formats JSON for human readers: two spaces per level, arrays of plain values on one line, a newline at the
/// end. Doubles have the fewest digits that read back as the same double. Strings must be UTF-8.
std::string prettyJson(const nlohmann::ordered_json& value);

/// Nearest double to the shortest decimal that reads back as `value`: 0.62, not 0.62000000476837158. Cast to
/// float, it equals `value`.
double shortestDouble(float value);

}  // namespace nearfit
