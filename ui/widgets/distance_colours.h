#pragma once

#include <QColor>

#include <vtkLookupTable.h>
#include <vtkSmartPointer.h>

namespace nearfit::ui {

/// Returns the colour of a distance: from red at contact through yellow to blue at the cutoff.
/// @param fraction  Distance over cutoff; clamped to [0, 1].
QColor distanceColour(double fraction);

/// Returns the same colours as a table for scalars from 0 to 1.
vtkSmartPointer<vtkLookupTable> distanceLookupTable();

}  // namespace nearfit::ui
