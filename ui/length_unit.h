#pragma once

#include <QString>
#include <array>

namespace nearfit::ui {

/// The unit that lengths are shown in, and typed in where none is given.
enum class LengthUnit { Millimetre, Centimetre, Metre, Inch };

constexpr std::array<LengthUnit, 4> kLengthUnits = {LengthUnit::Millimetre, LengthUnit::Centimetre,
                                                    LengthUnit::Metre, LengthUnit::Inch};

/// The one that the user has chosen; kept by the preferences from run to run.
LengthUnit shownLengthUnit() noexcept;
void setShownLengthUnit(LengthUnit unit) noexcept;

/// Short: "mm", "cm", "m", "in".
QString symbolOf(LengthUnit unit);
/// For menus: "Millimetres".
QString nameOf(LengthUnit unit);
/// [m]
double metresOf(LengthUnit unit) noexcept;
/// A length with its unit: "-1.25 mm".
/// @param metres  [m]
QString lengthIn(LengthUnit unit, double metres, int decimals);
/// Decimals that show five figures of a length, and thousandths at least.
int measuredDecimals(LengthUnit unit, double metres) noexcept;
/// Decimals that a number needs more than in millimetres to be about as fine.
int extraDecimals(LengthUnit unit) noexcept;

}  // namespace nearfit::ui
