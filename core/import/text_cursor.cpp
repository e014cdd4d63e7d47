#include "core/import/text_cursor.h"

#include <algorithm>
#include <charconv>
#include <limits>

#include <fmt/format.h>

#include "core/base/error.h"

namespace nearfit {
namespace {

constexpr std::size_t kReportBytes = std::size_t{1} << 20;

bool isLineEnd(char c) {
  return c == '\n' || c == '\r';
}
bool isBlank(char c) {
  return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

std::string_view withoutPlus(std::string_view token) {
  const bool hasPlus = token.size() > 1 && token[0] == '+' && token[1] != '-' && token[1] != '+';
  return hasPlus ? token.substr(1) : token;
}

/// Converts a well-formed number beyond double's range to infinity or zero, through long double.
std::optional<double> parseExtremeNumber(std::string_view digits) {
  long double wide = 0.0L;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), wide);
  if (end != digits.data() + digits.size() || error != std::errc{}) return std::nullopt;
  return static_cast<double>(wide);
}

}  // namespace

std::string inQuotes(std::string_view text) {
  constexpr std::size_t kLongest = 32;
  std::string result = "'";
  for (const char c : text.substr(0, kLongest))
    result += c >= ' ' && c <= '~' ? c : '?';
  return result + (text.size() > kLongest ? "...'" : "'");
}

std::optional<double> parseNumber(std::string_view token) {
  const std::string_view digits = withoutPlus(token);
  double value = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range) return parseExtremeNumber(digits);
  if (end != digits.data() + digits.size() || error != std::errc{}) return std::nullopt;
  return value;
}

std::optional<std::int64_t> parseInteger(std::string_view token) {
  const std::string_view digits = withoutPlus(token);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (end != digits.data() + digits.size() || error != std::errc{}) return std::nullopt;
  return value;
}

TextCursor::TextCursor(const ReaderInput& input, Syntax syntax) : TextCursor(input, syntax, 0, 1) {}

TextCursor::TextCursor(const ReaderInput& input, Syntax syntax, std::size_t offset, std::size_t line)
    : input_(input),
      syntax_(syntax),
      begin_(input.bytes.data()),
      position_(begin_ + offset),
      end_(begin_ + input.bytes.size()),
      nextReport_(position_),
      line_(line) {}

bool TextCursor::nextLine() {
  position_ = std::find_if(position_, end_, isLineEnd);
  if (position_ == end_) return false;
  const bool isPair = *position_ == '\r' && position_ + 1 != end_ && position_[1] == '\n';
  position_ += isPair ? 2 : 1;
  ++line_;
  if (position_ >= nextReport_) {
    input_.report(static_cast<double>(position_ - begin_) / static_cast<double>(end_ - begin_));
    nextReport_ = position_ + std::min(kReportBytes, bytesLeft());
  }
  return position_ != end_;
}

bool TextCursor::skipContinuation() {
  if (!syntax_.hasContinuations || *position_ != '\\') return false;
  const char* after = std::find_if_not(position_ + 1, end_, isBlank);
  if (after != end_ && !isLineEnd(*after)) return false;
  position_ = after;
  nextLine();
  return true;
}

std::string_view TextCursor::token() {
  do {
    position_ = std::find_if_not(position_, end_, isBlank);
    if (position_ == end_ || isLineEnd(*position_) || *position_ == syntax_.comment) return {};
  } while (skipContinuation());
  const char* start = position_;
  while (position_ != end_ && !isBlank(*position_) && !isLineEnd(*position_) &&
         *position_ != syntax_.comment) {
    const bool mayContinue = *position_ == '\\' && position_ != start;
    if (mayContinue && syntax_.hasContinuations && (position_ + 1 == end_ || isLineEnd(position_[1]))) break;
    ++position_;
  }
  return {start, static_cast<std::size_t>(position_ - start)};
}

std::string_view TextCursor::tokenAcrossLines() {
  for (;;) {
    const std::string_view found = token();
    if (!found.empty() || !nextLine()) return found;
  }
}

void TextCursor::skipRest() {
  while (!token().empty()) {
  }
}

double TextCursor::asNumber(std::string_view token, std::string_view what) const {
  const std::optional<double> value = parseNumber(token);
  if (!value) failNotA("number", token, what);
  return *value;
}

std::int64_t TextCursor::asInteger(std::string_view token, std::string_view what) const {
  const std::optional<std::int64_t> value = parseInteger(token);
  if (!value) failNotA("whole number", token, what);
  return *value;
}

double TextCursor::number(std::string_view what) {
  const std::string_view found = tokenAcrossLines();
  if (found.empty()) failAtEnd(what);
  return asNumber(found, what);
}

std::int64_t TextCursor::integer(std::string_view what) {
  const std::string_view found = tokenAcrossLines();
  if (found.empty()) failAtEnd(what);
  return asInteger(found, what);
}

void TextCursor::fail(const std::string& problem, const std::string& remedy) const {
  throw FileError(fmt::format("{}:{}", input_.name, line_), problem, remedy);
}

void TextCursor::failAtEnd(std::string_view what) const {
  fail(fmt::format("the file ends where {} is expected", what), "it is cut off: export or copy it again");
}

void TextCursor::failNotA(std::string_view kind, std::string_view token, std::string_view what) const {
  const bool hasComma = token.find(',') != std::string_view::npos;
  fail(fmt::format("expected {}, but {} is not a {}", what, inQuotes(token), kind),
       hasComma ? "export it with decimal points instead of commas"
                : "correct the line or export the file again");
}

}  // namespace nearfit
