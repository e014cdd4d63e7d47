#pragma once

#include <string>
#include <string_view>

namespace nearfit {

/// A field of a CSV file as RFC 4180 has it: in quotes, those inside doubled, where it holds a comma, a
/// quote, a line break or blanks at its ends; else as it is.
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
