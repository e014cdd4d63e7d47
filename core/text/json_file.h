#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

namespace nearfit {

/// What a JSON file may hold before it is refused: bounds memory and time against hostile files.
struct JsonLimits {
  std::size_t maxBytes = 8U << 20U;
  std::size_t maxDepth = 32;
  std::size_t maxValues = 1'000'000;
};

/// Reads a JSON file (RFC 8259). An object that says a key twice is refused, since readers differ in which
/// they take. Throws FileError: with line and column where the text is no JSON, or saying which limit it
/// passes.
nlohmann::json readJsonFile(const std::filesystem::path& file, const JsonLimits& limits = {});

/// A value of a JSON file and its path in there (`parts[3].position`), for readers that trust nothing: each
/// call checks what it returns and throws FileError naming file and path. The JSON value must outlive the
/// field.
class JsonField {
 public:
  JsonField(const nlohmann::json& root, const std::filesystem::path& file) : value_(&root), file_(&file) {}

  /// Member of an object; it must be there.
  JsonField at(const std::string& key) const;
  bool has(const std::string& key) const;
  /// Element of an array; index < size().
  JsonField at(std::size_t index) const;
  /// Elements of an array.
  std::size_t size() const;
  /// Fails unless it is an array of `count` elements.
  void requireSize(std::size_t count) const;
  bool isNull() const noexcept { return value_->is_null(); }
  /// A finite number.
  double number() const;
  double numberWithin(double lower, double upper) const;
  bool isTrue() const;
  /// UTF-8 without NUL of at most `maxBytes` bytes.
  std::string text(std::size_t maxBytes) const;

  [[noreturn]] void fail(const std::string& problem, const std::string& remedy = {}) const;

 private:
  JsonField(const nlohmann::json& value, const std::filesystem::path& file, std::string path)
      : value_(&value), file_(&file), path_(std::move(path)) {}
  void require(bool isOfType, const char* wanted) const;

  const nlohmann::json* value_;
  const std::filesystem::path* file_;
  std::string path_;
};

}  // namespace nearfit
