#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/error.h"
#include "core/import/document_file.h"

/// Values as bytes in the order of this machine, for files that programs of one build hand each other.
namespace nearfit {

/// Writes values one after the other.
class DocumentWriter {
 public:
  explicit DocumentWriter(const DocumentSink& sink) : sink_(sink) {}

  template <class T>
  void value(const T& value) {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
    sink_(std::as_bytes(std::span(&value, 1)));
  }
  template <class T>
  void values(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    value(std::uint64_t{values.size()});
    if (!values.empty()) sink_(std::as_bytes(values));
  }
  void text(const std::string& text) { values(std::span<const char>(text)); }
  void texts(const std::vector<std::string>& texts) {
    value(std::uint64_t{texts.size()});
    for (const std::string& one : texts)
      text(one);
  }
  void point(const glm::dvec3& p) {
    for (const double x : {p.x, p.y, p.z})
      value(x);
  }
  void colour(const std::optional<CadColour>& colour) {
    value(static_cast<std::uint8_t>(colour.has_value()));
    for (const float c : colour.value_or(CadColour{}))
      value(c);
  }

 private:
  const DocumentSink& sink_;
};

/// Reads what DocumentWriter writes. Throws Error where the bytes end too early or are no such value.
class DocumentReader {
 public:
  explicit DocumentReader(std::span<const std::byte> bytes) : bytes_(bytes), size_(bytes.size()) {}

  template <class T>
  T value() {
    static_assert(std::is_arithmetic_v<T>);
    T value{};
    std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
    return value;
  }
  bool flag() {
    const auto flag = value<std::uint8_t>();
    if (flag > 1) fail("a flag is neither 0 nor 1");
    return flag == 1;
  }
  /// A count of what takes at least `bytesEach` in the file, so that no count takes more memory than the file does.
  std::size_t count(std::size_t bytesEach) {
    const auto count = value<std::uint64_t>();
    if (count > bytes_.size() / bytesEach) fail("it ends too early");
    return static_cast<std::size_t>(count);
  }
  template <class T>
  std::vector<T> values() {
    static_assert(std::is_trivially_copyable_v<T>);
    std::vector<T> values(count(sizeof(T)));
    const std::span<const std::byte> from = take(values.size() * sizeof(T));
    if (!values.empty()) std::memcpy(values.data(), from.data(), from.size());
    return values;
  }
  std::string text() {
    const std::span<const std::byte> from = take(count(1));
    return {reinterpret_cast<const char*>(from.data()), from.size()};
  }
  std::vector<std::string> texts() {
    std::vector<std::string> texts(count(sizeof(std::uint64_t)));
    for (std::string& one : texts)
      one = text();
    return texts;
  }
  glm::dvec3 point() {
    glm::dvec3 p;
    for (int k = 0; k < 3; ++k)
      p[k] = value<double>();
    return p;
  }
  std::optional<CadColour> colour() {
    const bool hasColour = flag();
    CadColour colour;
    for (float& c : colour)
      c = value<float>();
    return hasColour ? std::optional(colour) : std::nullopt;
  }
  bool isAtEnd() const noexcept { return bytes_.empty(); }
  /// Bytes that are not read yet.
  std::span<const std::byte> rest() const noexcept { return bytes_; }
  [[noreturn]] void fail(const char* problem) const {
    throw Error("byte " + std::to_string(size_ - bytes_.size()), problem, "import the file again");
  }

 private:
  std::span<const std::byte> take(std::size_t count) {
    if (count > bytes_.size()) fail("it ends too early");
    const std::span<const std::byte> taken = bytes_.first(count);
    bytes_ = bytes_.subspan(count);
    return taken;
  }

  std::span<const std::byte> bytes_;
  std::size_t size_;
};

}  // namespace nearfit
