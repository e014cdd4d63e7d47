#include "core/text/json_file.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/files/input_file.h"
#include "core/text/utf8.h"

namespace nearfit {
namespace {

using Json = nlohmann::json;

/// Enforces the limits while parsing: check() is called for each parser event with the nesting depth.
class ParseGuard {
 public:
  ParseGuard(const std::filesystem::path& file, const JsonLimits& limits) : file_(file), limits_(limits) {}

  void check(std::size_t depth, Json::parse_event_t event, const Json& parsed) {
    if (depth > limits_.maxDepth) fail(fmt::format("it is nested deeper than {} levels", limits_.maxDepth));
    if (event == Json::parse_event_t::key) {
      checkKey(parsed.get_ref<const std::string&>());
    } else if (event == Json::parse_event_t::object_start) {
      keys_.emplace_back();
    } else if (event == Json::parse_event_t::object_end) {
      keys_.pop_back();
    }
    if (++values_ > limits_.maxValues) fail(fmt::format("it holds more than {} values", limits_.maxValues));
  }

 private:
  void checkKey(const std::string& key) {
    if (!keys_.back().insert(key).second) {
      fail(fmt::format("an object has the key \"{}\" twice", printableText(truncatedUtf8(key, 80))));
    }
  }
  [[noreturn]] void fail(const std::string& problem) const { throw FileError(file_.string(), problem); }

  const std::filesystem::path& file_;
  const JsonLimits& limits_;
  std::vector<std::set<std::string>> keys_;  ///< Keys of each open object.
  std::size_t values_ = 0;
};

/// Line and column, as "12:7", of a 1-based byte offset; columns count characters.
std::string lineAndColumn(const std::vector<char>& text, std::size_t byte) {
  std::size_t line = 1, column = 1;
  for (std::size_t i = 0; i + 1 < byte && i < text.size(); ++i) {
    if (text[i] == '\n') {
      ++line;
      column = 1;
    } else if ((static_cast<unsigned char>(text[i]) & 0xC0U) != 0x80U) {
      ++column;
    }
  }
  return fmt::format("{}:{}", line, column);
}

/// The library's message from `start` on, shortened and made printable.
std::string detail(const std::string& message, const char* start) {
  constexpr std::size_t kMaxDetail = 160;
  const std::size_t begin = message.find(start);
  const std::string text = begin == std::string::npos ? message : message.substr(begin);
  return printableText(std::string_view(text).substr(0, kMaxDetail));
}

}  // namespace

Json readJsonFile(const std::filesystem::path& file, const JsonLimits& limits) {
  if (InputFile(file).size() > limits.maxBytes) {
    throw FileError(file.string(), fmt::format("it is larger than {} bytes", limits.maxBytes),
                    "check that it is the right file");
  }
  const std::vector<char> text = readWholeFile(file);
  ParseGuard guard(file, limits);
  try {
    return Json::parse(text.begin(), text.end(),
                       [&](int depth, Json::parse_event_t event, const Json& parsed) {
                         guard.check(static_cast<std::size_t>(std::max(depth, 0)), event, parsed);
                         return true;
                       });
  } catch (const Json::parse_error& e) {
    throw FileError(file.string() + ":" + lineAndColumn(text, e.byte),
                    "this is not valid JSON: " + detail(e.what(), "syntax error"),
                    "correct the file or restore a copy");
  } catch (const Json::exception& e) {
    throw FileError(file.string(), "it is not valid JSON: " + detail(e.what(), "number overflow"),
                    "correct the file or restore a copy");
  }
}

void JsonField::fail(const std::string& problem, const std::string& remedy) const {
  throw FileError(path_.empty() ? file_->string() : file_->string() + ": " + path_, problem, remedy);
}

void JsonField::require(bool isOfType, const char* wanted) const {
  if (!isOfType) fail(fmt::format("it is of type {}, but {} is expected", value_->type_name(), wanted));
}

bool JsonField::has(const std::string& key) const {
  require(value_->is_object(), "an object");
  return value_->contains(key);
}

JsonField JsonField::at(const std::string& key) const {
  const JsonField unchecked(*value_, *file_, path_.empty() ? key : path_ + "." + key);
  if (!has(key)) unchecked.fail("it is missing");
  return {(*value_)[key], *file_, unchecked.path_};
}

JsonField JsonField::at(std::size_t index) const {
  return {(*value_)[index], *file_, fmt::format("{}[{}]", path_, index)};
}

std::size_t JsonField::size() const {
  require(value_->is_array(), "an array");
  return value_->size();
}

void JsonField::requireSize(std::size_t count) const {
  if (size() != count) fail(fmt::format("it has {} elements, but {} are expected", size(), count));
}

double JsonField::number() const {
  require(value_->is_number(), "a number");
  const double number = value_->get<double>();
  if (!std::isfinite(number)) fail("it is not a finite number");
  return number;
}

double JsonField::numberWithin(double lower, double upper) const {
  const double value = number();
  if (value < lower || value > upper)
    fail(fmt::format("{} is out of range", value), fmt::format("give a value from {} to {}", lower, upper));
  return value;
}

bool JsonField::isTrue() const {
  require(value_->is_boolean(), "true or false");
  return value_->get<bool>();
}

std::string JsonField::text(std::size_t maxBytes) const {
  require(value_->is_string(), "a string");
  const std::string& text = value_->get_ref<const std::string&>();
  if (text.size() > maxBytes) fail(fmt::format("it is longer than {} bytes", maxBytes));
  if (text.find('\0') != std::string::npos) fail("it holds a NUL character");
  return text;
}

}  // namespace nearfit
