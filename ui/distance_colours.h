#pragma once

#include <QColor>

#include <vtkLookupTable.h>
#include <vtkSmartPointer.h>

namespace nearfit::ui {

/// Colour of a distance: red at contact, over yellow, to blue at the cutoff.
/// @param fraction  Distance over cutoff; clamped to 0 to 1.
QColor distanceColour(double fraction);

/// The same colours for scalars from 0 to 1.
vtkSmartPointer<vtkLookupTable> distanceLookupTable();

}  // namespace nearfit::ui
