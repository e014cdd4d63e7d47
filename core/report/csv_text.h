#pragma once

#include <string>
#include <string_view>

namespace nearfit {

/// Formats a CSV field (RFC 4180). Quotes it, doubling quotes inside, if it contains a comma, a quote, a line
/// break, or leading or trailing blanks.
inline std::string csvField(std::string_view text) {
  const bool isPlain = text.find_first_of(",\"\r\n") == text.npos &&
                       (text.empty() || (text.front() != ' ' && text.back() != ' '));
  if (isPlain) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

}  // namespace nearfit
