#pragma once

#include <QString>
#include <cstddef>
#include <cstdint>

#include <glm/vec3.hpp>

#include "ui/widgets/length_unit.h"

namespace nearfit::ui {

// Text for people: decimals as in the user's locale, as in number fields, and no thousands separators.
// Exported files have a decimal point instead.

/// Formats with that many decimals.
QString formatFixed(double value, int decimals);
/// Formats a length in the unit that the user chose (shownLengthUnit()): "12.3 mm", three figures or more.
/// Millimetres become "1.20 m" from 1 m up. Short lengths have a unit of their own: "85.0 µm" below 0.1 mm,
/// "850 µin" below 0.001 in. Returns a dash if not finite.
QString formatLength(double metres);
QString formatLength(double metres, LengthUnit unit);
/// The same without trailing zeros, for lengths that are round: "20 mm", "50 µm".
QString formatRoundLength(double metres);
/// Formats the extent of a box along each axis [m], all three in one unit: "53 × 16 × 0.2 mm". At most four
/// figures each. Returns a dash if not finite.
QString formatExtent(const glm::dvec3& metres);
/// Formats a distance of which perhaps only a lower bound is known: "at least 0.26 mm".
QString formatDistance(double metres, bool isBound);
/// Formats a number of minima, of which some may be missing: "12", "12+".
QString formatMinima(std::uint32_t count, bool isTruncated);
/// Returns what the "+" of formatMinima() means, for a tool tip; empty without one.
QString explainMinima(bool isTruncated);
/// Formats a number of parts: "1 part", "12 parts".
QString formatParts(std::size_t count);
/// Formats a force [N]: "3.42 N".
QString formatForce(double newtons);
/// Formats a torque [N m]: "12.3 mN·m", "1.20 N·m".
QString formatTorque(double newtonMetres);
/// Formats a mass [kg]: "1.23 kg", "45.6 g", "0.50 mg".
QString formatMass(double kilograms);
/// Formats at most four figures, without exponent or trailing zeros: "1600", "0.2", "0.00005". Digits before
/// the point are all kept. Returns a dash if not finite.
QString formatNumber(double value);
/// Formats an energy [J]: "1.23 mJ", "45.6 µJ".
QString formatEnergy(double joules);
/// Formats a duration [s]: "12.0 µs", "1.30 ms".
QString formatDuration(double seconds);

}  // namespace nearfit::ui
