#include "core/text/json_file.h"

#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/files/input_file.h"
#include "core/text/utf8.h"

namespace nearfit {
namespace {

using Json = nlohmann::json;

/// Line and column, as "12:7", of a 1-based byte offset; columns count characters.
std::string lineAndColumn(std::string_view text, std::size_t byte) {
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

constexpr const char* kRestore = "correct the file or restore a copy";

/// Builds the value from the parser's events, within the limits. The library's own builder with a callback looks
/// through all members of the parent after each object, which takes the square of their number.
class JsonBuilder final : public nlohmann::json_sax<Json> {
 public:
  JsonBuilder(const std::filesystem::path& file, std::string_view text, const JsonLimits& limits)
      : file_(file), text_(text), limits_(limits) {}

  /// The whole value, once it has been parsed.
  Json take() { return std::move(root_); }

  bool null() override { return add(Json()); }
  bool boolean(bool value) override { return add(Json(value)); }
  bool number_integer(number_integer_t value) override { return add(Json(value)); }
  bool number_unsigned(number_unsigned_t value) override { return add(Json(value)); }
  bool number_float(number_float_t value, const string_t&) override { return add(Json(value)); }
  bool string(string_t& value) override { return add(Json(std::move(value))); }
  bool binary(binary_t&) override { return false; }  // Text has none.
  bool start_object(std::size_t) override { return begin(Json::object()); }
  bool end_object() override { return end(); }
  bool start_array(std::size_t) override { return begin(Json::array()); }
  bool end_array() override { return end(); }

  bool key(string_t& name) override {
    count();
    // Leaves the name alone if the object has it already.
    const auto [member, isNew] = open_.back()->get_ref<Json::object_t&>().try_emplace(std::move(name));
    if (!isNew) {
      fail(
          fmt::format("an object has the key \"{}\" twice", printableText(truncatedUtf8(member->first, 80))));
    }
    member_ = &member->second;
    return true;
  }

  bool parse_error(std::size_t byte, const std::string&, const nlohmann::detail::exception& error) override {
    if (dynamic_cast<const Json::parse_error*>(&error) == nullptr) {
      throw FileError(file_.string(), "it is not valid JSON: " + detail(error.what(), "number overflow"),
                      kRestore);
    }
    throw FileError(file_.string() + ":" + lineAndColumn(text_, byte),
                    "this is not valid JSON: " + detail(error.what(), "syntax error"), kRestore);
  }

 private:
  /// Puts a value where the next one belongs; returns its place, which stays until its parent gets another.
  Json* place(Json value) {
    count();
    if (open_.empty()) {
      root_ = std::move(value);
      return &root_;
    }
    Json& parent = *open_.back();
    if (parent.is_array()) {
      parent.push_back(std::move(value));
      return &parent.back();
    }
    *member_ = std::move(value);
    return member_;
  }

  bool add(Json value) {
    place(std::move(value));
    return true;
  }

  bool begin(Json value) {
    if (open_.size() >= limits_.maxDepth)
      fail(fmt::format("it is nested deeper than {} levels", limits_.maxDepth));
    open_.push_back(place(std::move(value)));
    return true;
  }

  bool end() {
    count();
    open_.pop_back();
    return true;
  }

  void count() {
    if (++values_ > limits_.maxValues) fail(fmt::format("it holds more than {} values", limits_.maxValues));
  }

  [[noreturn]] void fail(const std::string& problem) const { throw FileError(file_.string(), problem); }

  const std::filesystem::path& file_;
  std::string_view text_;
  const JsonLimits& limits_;
  Json root_;
  std::vector<Json*> open_;  ///< Objects and arrays that have not ended, outermost first.
  Json* member_ = nullptr;   ///< Value of the last key.
  std::size_t values_ = 0;
};

}  // namespace

Json readJsonFile(const std::filesystem::path& file, const JsonLimits& limits) {
  // Opened once: another file may take its place meanwhile.
  InputFile input(file);
  if (input.size() > limits.maxBytes) {
    throw FileError(file.string(), fmt::format("it is larger than {} bytes", limits.maxBytes),
                    "check that it is the right file");
  }
  const std::vector<char> text = input.readAll();
  return readJsonText({text.data(), text.size()}, file, limits);
}

Json readJsonText(std::string_view text, const std::filesystem::path& file, const JsonLimits& limits) {
  if (text.size() > limits.maxBytes)
    throw FileError(file.string(), fmt::format("it is larger than {} bytes", limits.maxBytes));
  JsonBuilder builder(file, text, limits);
  // The builder throws on all errors.
  static_cast<void>(Json::sax_parse(text.begin(), text.end(), &builder));
  return builder.take();
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
