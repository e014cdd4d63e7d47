#pragma once

#include <algorithm>
#include <numbers>

/// Tolerances of shapes for which none are asked. The benchmark meshes by them too, without the importer.
namespace nearfit::importer {

/// Default chord: this fraction of the diagonal of a part that fills a screen of 2,000 pixels is one of them. Not finer
/// than a micrometre, below what is machined, and not coarser than a millimetre, which a hand feels as an edge [m].
constexpr double kChordFraction = 1.0 / 2000.0, kMinDefaultChord = 1e-6, kMaxDefaultChord = 1e-3;
/// Default angle: 30 facets around a bore, however small it is against its part [rad].
constexpr double kDefaultAngle = 12.0 * std::numbers::pi / 180.0;

/// Default chord of a shape, in the unit of its diagonal.
/// @param hasUnit  False: the limits, which are in metres, do not apply.
inline double defaultChord(double diagonal, double metresPerUnit, bool hasUnit) {
  const double chord = diagonal * kChordFraction;
  return hasUnit ? std::clamp(chord, kMinDefaultChord / metresPerUnit, kMaxDefaultChord / metresPerUnit)
                 : chord;
}

}  // namespace nearfit::importer
