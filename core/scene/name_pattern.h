#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace nearfit {

/// Patterns for names of parts: `*` stands for any characters, also none, `?` for one character, and `\` takes the
/// character after it as it is. Case counts.

/// Max length of a pattern [bytes of UTF-8]: that of a name with each character escaped.
constexpr std::size_t kMaxPatternBytes = 400;

/// True if the pattern stands for the whole name. O(length of both, multiplied).
bool matchesPattern(std::string_view pattern, std::string_view name) noexcept;

/// The pattern that stands for this name alone.
std::string patternOf(std::string_view name);

/// The only name that a pattern stands for; std::nullopt if it has a `*` or `?`.
std::optional<std::string> onlyNameOf(std::string_view pattern);

/// Throws UsageError if a pattern is empty, longer than kMaxPatternBytes, not printable UTF-8, or ends in a single `\`.
void checkPattern(const std::string& pattern);

}  // namespace nearfit
