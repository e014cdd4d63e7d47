#include "app/cli/arguments.h"

#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/scene/mesh_unit.h"
#include "core/scene/scene.h"
#include "core/text/quantity.h"

namespace nearfit::cli {
namespace {

std::optional<double> parseNumber(std::string_view text) {
  while (!text.empty() && text.front() == ' ')
    text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ')
    text.remove_suffix(1);
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

double parseUnit(const std::string& text) {
  return parseMeshUnit(text, "--unit");
}

bool parseNumbersIfAny(std::string_view text, std::span<double> numbers) {
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::size_t comma = text.find(',');
    if ((comma == std::string_view::npos) != (i + 1 == numbers.size())) return false;
    const std::optional<double> number = parseNumber(text.substr(0, comma));
    if (!number) return false;
    numbers[i] = *number;
    if (comma != std::string_view::npos) text.remove_prefix(comma + 1);
  }
  return true;
}

void failNumbers(const std::string& option, const std::string& text, std::size_t count) {
  throw UsageError(option, fmt::format("\"{}\" is not a valid value", text),
                   count == 1 ? "give a number" : fmt::format("give {} numbers separated by commas", count));
}

std::optional<RigidTransform> parsePoseIfAny(const std::string& text) {
  std::array<double, 7> n{};
  if (!parseNumbersIfAny(text, n)) return std::nullopt;
  if (!std::isfinite(n[0]) || !std::isfinite(n[1]) || !std::isfinite(n[2])) {
    throw UsageError(fmt::format("pose \"{}\"", text), "a number is not finite", "give finite numbers");
  }
  // The scene's limits on positions do not apply: queries work anywhere.
  return RigidTransform{checkedPose({{n[3], n[4], n[5], n[6]}, {}}).rotation, {n[0], n[1], n[2]}};
}

RigidTransform parsePose(const std::string& option, const std::string& text) {
  const std::optional<RigidTransform> pose = parsePoseIfAny(text);
  if (!pose)
    throw UsageError(option, fmt::format("\"{}\" is not a pose", text), std::string("give ") + kPoseHelp);
  return *pose;
}

double parseLength(const std::string& option, const std::string& text) {
  try {
    return evaluateQuantity(text, Unit{{.length = 1}, 1.0});
  } catch (const UsageError& e) {
    throw UsageError(option, e.problem(), e.remedy());
  }
}

void checkPositive(const std::string& option, double value, bool orZero) {
  if (std::isfinite(value) && (value > 0.0 || (orZero && value == 0.0))) return;
  throw UsageError(option, fmt::format("{} is out of range", value),
                   orZero ? "give a finite number that is not negative" : "give a finite number above zero");
}

}  // namespace nearfit::cli
