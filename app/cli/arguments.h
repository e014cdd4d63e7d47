#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/math/rigid_transform.h"

namespace nearfit::cli {

/// Help text on the form of a pose.
inline constexpr const char* kPoseHelp = "tx,ty,tz,qw,qx,qy,qz: translation [m] and unit quaternion";

/// Returns metres per unit, for a unit's name or a number. Throws UsageError.
double parseUnit(const std::string& text);

/// Parses seven numbers separated by commas; returns std::nullopt for any other text. Throws UsageError if
/// a number is not finite or the quaternion's length is off by more than kQuaternionSlack; a smaller error
/// is normalised away.
std::optional<RigidTransform> parsePoseIfAny(const std::string& text);
/// Same as parsePoseIfAny(), but throws UsageError, naming the option, if the text is no pose.
RigidTransform parsePose(const std::string& option, const std::string& text);

/// Throws UsageError: the option takes `count` numbers.
[[noreturn]] void failNumbers(const std::string& option, const std::string& text, std::size_t count);
/// Parses as many numbers as `numbers` holds, separated by commas. Returns false for any other text.
bool parseNumbersIfAny(std::string_view text, std::span<double> numbers);
/// Parses Count numbers. Throws UsageError, naming the option, for any other text.
template <std::size_t Count>
std::array<double, Count> parseNumbers(const std::string& option, const std::string& text) {
  std::array<double, Count> numbers{};
  if (!parseNumbersIfAny(text, numbers)) failNumbers(option, text, Count);
  return numbers;
}

/// Returns a length in metres, given with a unit or in metres: "0.02mm". Throws UsageError, naming the option.
double parseLength(const std::string& option, const std::string& text);

/// Throws UsageError if an option's value is not finite or not above zero; `orZero` allows zero.
void checkPositive(const std::string& option, double value, bool orZero = false);

}  // namespace nearfit::cli
