#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/math/rigid_transform.h"

namespace nearfit::cli {

/// What --unit takes, for help texts.
inline constexpr const char* kUnitHelp =
    "Unit of the mesh files' coordinates: m, cm, mm, um, in, ft, or a number of metres";
/// What poses look like, for help texts.
inline constexpr const char* kPoseHelp = "tx,ty,tz,qw,qx,qy,qz: translation [m] and unit quaternion";

/// Metres to the unit. Throws UsageError.
double parseUnit(const std::string& text);

/// Seven numbers with commas between them; none when the text is anything else.
/// Throws UsageError when a number is not finite or the quaternion is off unit by more than kQuaternionSlack;
/// a smaller error is normalised away.
std::optional<RigidTransform> parsePoseIfAny(const std::string& text);
/// As parsePoseIfAny; throws UsageError also when the text is no pose.
RigidTransform parsePose(const std::string& option, const std::string& text);

[[noreturn]] void failNumbers(const std::string& option, const std::string& text, std::size_t count);
/// As many numbers as `numbers` takes, with commas between them; false when the text is anything else.
bool parseNumbersIfAny(std::string_view text, std::span<double> numbers);
/// That many numbers. Throws UsageError naming the option when the text is anything else.
template <std::size_t Count>
std::array<double, Count> parseNumbers(const std::string& option, const std::string& text) {
  std::array<double, Count> numbers{};
  if (!parseNumbersIfAny(text, numbers)) failNumbers(option, text, Count);
  return numbers;
}

/// Throws UsageError when the value of an option is not finite or not above (or, with `orZero`, below) zero.
void checkPositive(const std::string& option, double value, bool orZero = false);

}  // namespace nearfit::cli
