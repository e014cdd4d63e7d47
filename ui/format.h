#pragma once

#include <QString>

#include "ui/length_unit.h"

namespace nearfit::ui {

/// All of these write decimals as the user's locale does, as number fields do, and group no thousands. They
/// are for people: what is exported has a point.

/// With so many decimals.
QString formatFixed(double value, int decimals);
/// A length as an engineer writes it, in the unit that the user has chosen (shownLengthUnit); three to four
/// figures. In millimetres what is long or short has a unit of its own: "12.34 mm", "850 um" with the micro
/// sign, "1.20 m"; in the others what is short alone: "1.23 cm", "0.484 in", "850 uin". "-" when it is not
/// finite.
/// @param metres  [m]
QString formatLength(double metres);
QString formatLength(double metres, LengthUnit unit);
/// "3.42 N"; `newtons` in [N].
QString formatForce(double newtons);
/// "12.3 mN·m" or "1.20 N·m"; `newtonMetres` in [N m].
QString formatTorque(double newtonMetres);
/// "1.23 kg", "45.6 g", "0.50 mg"; `kilograms` in [kg].
QString formatMass(double kilograms);
/// Four figures at most, without exponent and without zeros behind the last: "1600", "0.2", "0.00005".
QString formatNumber(double value);
/// "1.23 mJ", "45.6 µJ"; `joules` in [J].
QString formatEnergy(double joules);
/// "12 µs", "1.3 ms"; `seconds` in [s].
QString formatDuration(double seconds);

}  // namespace nearfit::ui
