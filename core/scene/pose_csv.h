#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/math/rigid_transform.h"

namespace nearfit::csv {

/// A place in a file, for messages.
struct Place {
  const std::filesystem::path& file;
  std::size_t line;

  [[noreturn]] void fail(const std::string& problem, const std::string& remedy) const;
};

/// Rows of a CSV file, without blank lines, comments (`#`) and what surrounds them. Throws FileError.
class Rows {
 public:
  explicit Rows(const std::filesystem::path& file);

  /// Nothing at the end. Valid until the next call.
  std::optional<std::string_view> next();
  /// What `parse` makes of the row that was read last. Nothing where it throws FileError and the row's end is
  /// missing: a file of which only that row was not written to its end.
  /// @param hasOthers  There are rows before it; a file of a single row that is wrong is wrong.
  template <typename Parse>
  auto parsed(bool hasOthers, const Parse& parse) const -> std::optional<decltype(parse())> {
    try {
      return parse();
    } catch (const FileError&) {
      if (hasEnd_ || !hasOthers) throw;
      return std::nullopt;
    }
  }
  const Place& place() const noexcept { return place_; }
  std::uint64_t size() const noexcept { return size_; }
  /// Bytes that have been read.
  std::uint64_t taken() const noexcept { return taken_; }

 private:
  /// Seven numbers need a tenth of it, a row of a recording a quarter. A binary file without line ends must
  /// not fill memory.
  static constexpr std::streamsize kMaxLineBytes = 4096;

  std::ifstream in_;
  Place place_;
  std::uint64_t size_ = 0, taken_ = 0;
  bool hasEnd_ = false;  ///< The row that was read last.
  std::array<char, kMaxLineBytes> buffer_;
};

std::string_view trimmed(std::string_view text) noexcept;
std::vector<std::string_view> columnsOf(std::string_view row);
/// The whole text; nothing when it is no number. `nan` and `inf` are numbers here.
std::optional<double> parseNumber(std::string_view text) noexcept;
/// The number in a column that must be finite; `column` counts from 0.
double finiteNumber(std::string_view text, std::size_t column, const Place& place, const char* remedy);

/// tx, ty, tz, qw, qx, qy, qz: near enough, and the quaternion of unit length to kQuaternionSlack;
/// normalised.
/// @param firstColumn  Of them in the file, from 0.
RigidTransform poseOf(std::span<const double, 7> values, std::size_t firstColumn, const Place& place);

}  // namespace nearfit::csv
