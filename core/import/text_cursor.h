#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/import/reader_input.h"

namespace nearfit {

/// Parses a decimal number as in mesh files: leading plus signs, "inf" and "nan" are allowed; overflow gives
/// infinity, underflow zero. Independent of the locale. std::nullopt if it is not a number.
std::optional<double> parseNumber(std::string_view token);

/// Parses a decimal integer; std::nullopt if it is not one or does not fit.
std::optional<std::int64_t> parseInteger(std::string_view token);

/// Reads a text file token by token and tracks the line. Lines end in LF, CRLF or CR. Tokens are views into
/// the file: no allocation.
class TextCursor {
 public:
  struct Syntax {
    char comment = '#';             ///< Starts a comment that ends with the line.
    bool hasContinuations = false;  ///< A backslash at the end of a line joins it with the next.
  };

  /// Starts at the beginning of the file. `input` must outlive the cursor.
  TextCursor(const ReaderInput& input, Syntax syntax);
  /// Starts at byte `offset`, which is in line `line`.
  TextCursor(const ReaderInput& input, Syntax syntax, std::size_t offset, std::size_t line);

  /// Goes to the start of the next line; false if there is none.
  bool nextLine();
  /// The next token on this line; empty at its end.
  std::string_view token();
  /// The next token on this or a later line; empty at the end of the file.
  std::string_view tokenAcrossLines();

  /// Skips the rest of this line, continuations included.
  void skipRest();

  /// A token as a number. Throws FileError if it is not one; `what` names the expected item.
  double asNumber(std::string_view token, std::string_view what) const;
  /// A token as an integer. Throws FileError if it is not one; `what` names the expected item.
  std::int64_t asInteger(std::string_view token, std::string_view what) const;
  /// The next token, on this or a later line, as a number. Throws FileError if it is not one or the file
  /// ends; `what` names the expected item.
  double number(std::string_view what);
  /// Like number(), for an integer.
  std::int64_t integer(std::string_view what);

  /// Current line, from 1.
  std::size_t line() const noexcept { return line_; }
  /// Offset of the next byte in the file.
  std::size_t offset() const noexcept { return static_cast<std::size_t>(position_ - begin_); }
  std::size_t bytesLeft() const noexcept { return static_cast<std::size_t>(end_ - position_); }
  /// Throws a FileError naming the file and the line.
  [[noreturn]] void fail(const std::string& problem, const std::string& remedy) const;
  /// Throws a FileError that the file ends where `what` is expected.
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
