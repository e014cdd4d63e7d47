#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace nearfit {

/// Limits beyond which a JSON file is refused; they bound memory and time against hostile files.
struct JsonLimits {
  std::size_t maxBytes = 8U << 20U;   ///< Size of the file [bytes].
  std::size_t maxDepth = 32;          ///< Levels of nesting.
  std::size_t maxValues = 1'000'000;  ///< Parser events: values, keys and brackets.
};

/// Reads a JSON file (RFC 8259). Refuses objects with duplicate keys, since parsers differ in which one they
/// keep. O(n log n). Throws FileError with line and column for invalid JSON, or naming the limit exceeded.
nlohmann::json readJsonFile(const std::filesystem::path& file, const JsonLimits& limits = {});

/// Reads JSON from memory, as readJsonFile() does from a file; `file` only appears in messages.
nlohmann::json readJsonText(std::string_view text, const std::filesystem::path& file,
                            const JsonLimits& limits = {});

/// A value in a JSON file, with its path there (`parts[3].position`), for readers that trust nothing. Each
/// call checks the type it returns and throws FileError naming file and path. The JSON value and the file's
/// path must outlive the field.
class JsonField {
 public:
  JsonField(const nlohmann::json& root, const std::filesystem::path& file) : value_(&root), file_(&file) {}

  /// Member of an object; throws if it is missing.
  JsonField at(const std::string& key) const;
  /// True if the object has the member.
  bool has(const std::string& key) const;
  /// Element of an array; index < size().
  JsonField at(std::size_t index) const;
  /// Number of elements of an array.
  std::size_t size() const;
  /// Throws unless this is an array of `count` elements.
  void requireSize(std::size_t count) const;
  bool isNull() const noexcept { return value_->is_null(); }
  bool isObject() const noexcept { return value_->is_object(); }
  /// A finite number.
  double number() const;
  /// A finite number from `lower` to `upper`, both included.
  double numberWithin(double lower, double upper) const;
  /// The value of a boolean.
  bool isTrue() const;
  /// A string of at most `maxBytes` bytes, UTF-8 without NUL.
  std::string text(std::size_t maxBytes) const;

  /// Throws FileError for this value.
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
