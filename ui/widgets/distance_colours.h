#pragma once

#include <QColor>

#include <vtkLookupTable.h>
#include <vtkSmartPointer.h>

namespace nearfit::ui {

/// Returns the colour of a distance: from red at contact through yellow to blue at the end of the scale.
/// @param fraction  Share of the scale; clamped to [0, 1].
QColor distanceColour(double fraction);

/// Returns the same colours as a table for scalars from 0 to 1.
vtkSmartPointer<vtkLookupTable> distanceLookupTable();

}  // namespace nearfit::ui
