#pragma once

#include <string>
#include <string_view>

namespace nearfit {

/// Formats a name or path as a CSV field (RFC 4180). Quotes it, doubling quotes inside, if it contains a comma,
/// a semicolon, a quote or a line break, or begins or ends with a blank.
///
/// Spreadsheets run a cell that begins with =, +, -, @, a tab or a carriage return, even in quotes. Such a name
/// gets an apostrophe in front, which they take for the mark of text, and quotes. Not for numbers.
inline std::string csvField(std::string_view text) {
  constexpr std::string_view kRun = "=+-@\t\r";
  const bool isRun = !text.empty() && kRun.find(text.front()) != kRun.npos;
  const bool isPlain = !isRun && text.find_first_of(",;\"\r\n") == text.npos &&
                       (text.empty() || (text.front() != ' ' && text.back() != ' '));
  if (isPlain) return std::string(text);
  std::string quoted = isRun ? "\"'" : "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

}  // namespace nearfit
