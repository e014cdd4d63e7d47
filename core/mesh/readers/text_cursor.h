#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/mesh/readers/reader_input.h"

namespace nearfit {

/// A decimal number as mesh files write it: leading plus signs, "inf" and "nan" are allowed, a number too
/// large for double becomes infinite, one too small zero. The same in every locale. Empty when it is no
/// number.
std::optional<double> parseNumber(std::string_view token);

/// A decimal integer; empty when it is none or does not fit.
std::optional<std::int64_t> parseInteger(std::string_view token);

/// Walks a text file token by token and knows the line it is on. Lines end in LF, CRLF or CR.
/// Never allocates for tokens: they are views into the file.
class TextCursor {
 public:
  struct Syntax {
    char comment = '#';             ///< From here to the end of its line nothing counts.
    bool hasContinuations = false;  ///< A backslash at the end of a line joins it with the next.
  };

  /// Starts at the beginning of the first line. `input` must outlive the cursor.
  TextCursor(const ReaderInput& input, Syntax syntax);
  /// Starts at byte `offset`, which lies in line `line`.
  TextCursor(const ReaderInput& input, Syntax syntax, std::size_t offset, std::size_t line);

  /// Goes to the start of the next line; false when there is none.
  bool nextLine();
  /// The next token on this line; empty at the line's end.
  std::string_view token();
  /// The next token on this line or on one of those that follow; empty at the end of the file.
  std::string_view tokenAcrossLines();

  /// Passes over what is left of this line, continuations included, up to its end.
  void skipRest();

  /// A token as a number. Throws FileError when it is none; `what` says what should have stood here.
  double asNumber(std::string_view token, std::string_view what) const;
  std::int64_t asInteger(std::string_view token, std::string_view what) const;
  /// The next token (across lines) as a number. Throws FileError when it is none or the file ends; `what`
  /// says what should have stood here.
  double number(std::string_view what);
  /// The same for an integer.
  std::int64_t integer(std::string_view what);

  std::size_t line() const noexcept { return line_; }
  /// Byte of the file that comes next.
  std::size_t offset() const noexcept { return static_cast<std::size_t>(position_ - begin_); }
  std::size_t bytesLeft() const noexcept { return static_cast<std::size_t>(end_ - position_); }
  /// Throws a FileError that names the file and the line.
  [[noreturn]] void fail(const std::string& problem, const std::string& remedy) const;
  [[noreturn]] void failAtEnd(std::string_view what) const;

 private:
  bool skipContinuation();
  [[noreturn]] void failNotA(std::string_view kind, std::string_view token, std::string_view what) const;

  const ReaderInput& input_;
  Syntax syntax_;
  const char *begin_, *position_, *end_, *nextReport_;
  std::size_t line_ = 1;
};

}  // namespace nearfit
