#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

namespace nearfit {

/// True if a spreadsheet would run a cell that begins so, even in quotes: =, +, -, @, a tab or a line break, and the
/// full-width ＝, ＋, － and ＠, which Excel takes for the ASCII ones in Japanese.
/// Source: OWASP, CSV Injection (community.owasp.org/attacks/CSV_Injection).
inline bool isRunBySpreadsheets(std::string_view text) {
  constexpr std::array<std::string_view, 11> kStarts{
      "=", "+", "-", "@", "\t", "\r", "\n", "\xEF\xBC\x9D", "\xEF\xBC\x8B", "\xEF\xBC\x8D", "\xEF\xBC\xA0"};
  return std::ranges::any_of(kStarts, [text](std::string_view start) { return text.starts_with(start); });
}

/// Formats a name or path as a CSV field (RFC 4180). Quotes it, doubling quotes inside, if it contains a comma,
/// a semicolon, a quote or a line break, or begins or ends with a blank.
///
/// A name that a spreadsheet would run gets an apostrophe in front, which spreadsheets take for the mark of text, and
/// quotes. Not for numbers.
inline std::string csvField(std::string_view text) {
  const bool isRun = isRunBySpreadsheets(text);
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
