#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/files/input_file.h"
#include "core/math/rigid_transform.h"

namespace nearfit::csv {

/// A place in a file, for error messages.
struct Place {
  const std::filesystem::path& file;
  std::size_t line;

  /// Throws FileError naming the file and the line.
  [[noreturn]] void fail(const std::string& problem, const std::string& remedy) const;
};

/// Reads the rows of a CSV file, trimmed, without blank lines and comments (`#`). Throws FileError.
class Rows {
 public:
  /// Throws FileError as InputFile does: pipes and devices are refused. `file` must outlive the rows.
  explicit Rows(const std::filesystem::path& file);

  /// The next row; std::nullopt at the end. Valid until the next call.
  std::optional<std::string_view> next();
  /// Returns parse() of the last row. Returns std::nullopt if parse() throws FileError and the row has no
  /// line end: writing of the file was interrupted there.
  /// @param hasOthers  True if valid rows precede it; the error of a file's only row is always thrown.
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
  /// Size of the file when it was opened [bytes].
  std::uint64_t size() const noexcept { return in_.size(); }
  /// Bytes read so far.
  std::uint64_t taken() const noexcept { return taken_; }

 private:
  /// The next line without its end; std::nullopt at the end of the file.
  std::optional<std::string_view> nextLine();
  void refill();

  InputFile in_;
  Place place_;
  std::uint64_t taken_ = 0;
  bool hasEnd_ = false;  ///< Refers to the last row read.
  std::vector<char> buffer_;
  std::string_view unread_;  ///< Part of the buffer.
};

/// Removes leading and trailing blanks, tabs and carriage returns.
std::string_view trimmed(std::string_view text) noexcept;
/// Trimmed fields between commas; quotes have no meaning.
std::vector<std::string_view> columnsOf(std::string_view row);
/// The whole text as a number; std::nullopt if it is not one. Accepts `nan` and `inf`.
std::optional<double> parseNumber(std::string_view text) noexcept;
/// A finite number from a column counted from 0. Throws FileError with `remedy`.
double finiteNumber(std::string_view text, std::size_t column, const Place& place, const char* remedy);

/// Pose from tx, ty, tz [m], qw, qx, qy, qz, normalised. Throws FileError if a coordinate exceeds
/// kMaxPosition or the quaternion's length differs from 1 by more than kQuaternionSlack.
/// @param firstColumn  Column of tx in the file, from 0; for messages.
RigidTransform poseOf(std::span<const double, 7> values, std::size_t firstColumn, const Place& place);

}  // namespace nearfit::csv
