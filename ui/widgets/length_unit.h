#pragma once

#include <QString>
#include <array>

namespace nearfit::ui {

/// Unit of the lengths that are shown, and of those typed without a unit.
enum class LengthUnit { Millimetre, Centimetre, Metre, Inch };

constexpr std::array<LengthUnit, 4> kLengthUnits = {LengthUnit::Millimetre, LengthUnit::Centimetre,
                                                    LengthUnit::Metre, LengthUnit::Inch};

/// Returns the unit that the user chose; millimetres at first. Process-wide, GUI thread only. Preferences
/// keeps it between runs.
LengthUnit shownLengthUnit() noexcept;
void setShownLengthUnit(LengthUnit unit) noexcept;

/// Returns the symbol: "mm", "cm", "m", "in".
QString symbolOf(LengthUnit unit);
/// Returns the translated name for menus: "Millimetres".
QString nameOf(LengthUnit unit);
/// Returns the length of one unit [m].
double metresOf(LengthUnit unit) noexcept;
/// Formats a length with its unit: "-1.25 mm". Never writes "-0".
/// @param metres  The length [m].
QString lengthIn(LengthUnit unit, double metres, int decimals);
/// Returns the decimals that show five figures of a length: 3 to 9.
/// @param metres  The length [m].
int measuredDecimals(LengthUnit unit, double metres) noexcept;
/// Returns how many more decimals `unit` needs than millimetres for about the same resolution.
int extraDecimals(LengthUnit unit) noexcept;

}  // namespace nearfit::ui
