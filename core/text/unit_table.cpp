#include "core/text/unit_table.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <utility>

namespace nearfit {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0, kInch = 0.0254;
constexpr Dimension kNone, kLength{.length = 1}, kAngle{.angle = 1}, kMass{.mass = 1}, kTime{.time = 1};
constexpr Dimension kForce{.length = 1, .mass = 1, .time = -2};

struct NamedUnit {
  std::string_view name;
  Unit unit;
  bool isListed = true;  ///< False for alternative spellings.
};

constexpr std::array kUnits = std::to_array<NamedUnit>({
    {"nm", {kLength, 1e-9}},
    {"µm", {kLength, 1e-6}},
    {"μm", {kLength, 1e-6}, false},  // The Greek letter, which looks the same.
    {"um", {kLength, 1e-6}, false},
    {"mm", {kLength, 1e-3}},
    {"cm", {kLength, 1e-2}},
    {"dm", {kLength, 1e-1}, false},
    {"m", {kLength, 1.0}},
    {"km", {kLength, 1e3}},
    {"thou", {kLength, 1e-3 * kInch}},
    {"in", {kLength, kInch}},
    {"inch", {kLength, kInch}, false},
    {"\"", {kLength, kInch}, false},
    {"″", {kLength, kInch}, false},
    {"ft", {kLength, 12.0 * kInch}},
    {"'", {kLength, 12.0 * kInch}, false},
    {"′", {kLength, 12.0 * kInch}, false},
    {"deg", {kAngle, kDegree}},
    {"°", {kAngle, kDegree}, false},
    {"rad", {kAngle, 1.0}},
    {"mrad", {kAngle, 1e-3}},
    {"rev", {kAngle, 2.0 * std::numbers::pi}},
    {"mg", {kMass, 1e-6}},
    {"g", {kMass, 1e-3}},
    {"kg", {kMass, 1.0}},
    {"t", {kMass, 1e3}},
    {"µs", {kTime, 1e-6}, false},
    {"us", {kTime, 1e-6}, false},
    {"ms", {kTime, 1e-3}},
    {"s", {kTime, 1.0}},
    {"min", {kTime, 60.0}},
    {"mN", {kForce, 1e-3}},
    {"N", {kForce, 1.0}},
    {"kN", {kForce, 1e3}},
    {"%", {kNone, 0.01}},
});

constexpr std::array kNames = std::to_array<std::pair<Dimension, std::string_view>>({
    {kNone, "a number without unit"},
    {kLength, "a length"},
    {{.length = 2}, "an area"},
    {{.length = 3}, "a volume"},
    {{.length = -1}, "an inverse length"},
    {kAngle, "an angle"},
    {{.angle = 2}, "an angle squared"},
    {kMass, "a mass"},
    {kTime, "a time"},
    {kForce, "a force"},
    {{.length = 1, .time = -1}, "a speed"},
    {{.angle = 1, .time = -1}, "an angular speed"},
    {{.length = 1, .time = -2}, "an acceleration"},
    {{.length = -3, .mass = 1}, "a density"},
    {{.mass = 1, .time = -2}, "a stiffness"},
    {{.mass = 1, .time = -1}, "a damping"},
    {{.length = 2, .mass = 1, .time = -2}, "a torque or an energy"},
    {{.length = 2, .angle = -1, .mass = 1, .time = -2}, "a rotational stiffness"},
    {{.length = 2, .angle = -1, .mass = 1, .time = -1}, "a rotational damping"},
});

}  // namespace

std::optional<Unit> findUnit(std::string_view name) noexcept {
  const auto* found =
      std::find_if(kUnits.begin(), kUnits.end(), [&](const NamedUnit& u) { return u.name == name; });
  if (found == kUnits.end()) return std::nullopt;
  return found->unit;
}

std::string unitNames(const Dimension& dimension) {
  std::string names;
  for (const NamedUnit& u : kUnits) {
    if (!u.isListed || u.unit.dimension != dimension) continue;
    if (!names.empty()) names += ", ";
    names += u.name;
  }
  return names;
}

std::string nameOf(const Dimension& dimension) {
  for (const auto& [known, name] : kNames) {
    if (known == dimension) return std::string(name);
  }
  return "of another dimension";
}

}  // namespace nearfit
