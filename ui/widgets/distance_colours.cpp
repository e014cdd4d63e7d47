#include "ui/widgets/distance_colours.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace nearfit::ui {
namespace {

/// Colour stops, equally spaced from 0 to 1.
const std::array<QColor, 5> kStops = {QColor(0xc9, 0x18, 0x2b), QColor(0xf4, 0x76, 0x2e),
                                      QColor(0xf9, 0xc9, 0x32), QColor(0x3f, 0xae, 0x7d),
                                      QColor(0x2a, 0x6f, 0xbb)};

}  // namespace

QColor distanceColour(double fraction) {
  const double position = std::clamp(fraction, 0.0, 1.0) * static_cast<double>(kStops.size() - 1);
  const auto lower = std::min(static_cast<std::size_t>(position), kStops.size() - 2);
  const double t = position - static_cast<double>(lower);
  const QColor& a = kStops[lower];
  const QColor& b = kStops[lower + 1];
  const auto mix = [t](double from, double to) { return from + t * (to - from); };
  return QColor::fromRgbF(mix(a.redF(), b.redF()), mix(a.greenF(), b.greenF()), mix(a.blueF(), b.blueF()));
}

vtkSmartPointer<vtkLookupTable> distanceLookupTable() {
  constexpr int kColours = 256;
  auto table = vtkSmartPointer<vtkLookupTable>::New();
  table->SetNumberOfTableValues(kColours);
  table->SetTableRange(0.0, 1.0);
  for (int i = 0; i < kColours; ++i) {
    const QColor colour = distanceColour(static_cast<double>(i) / (kColours - 1));
    table->SetTableValue(i, colour.redF(), colour.greenF(), colour.blueF());
  }
  return table;
}

}  // namespace nearfit::ui
