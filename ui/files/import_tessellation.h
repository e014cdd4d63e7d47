#pragma once

#include "core/import/cad_document.h"

namespace nearfit::ui {

/// Tessellation in which CAD documents are added, as the user chose it last, in an earlier run too (QSettings); both 0,
/// which suits each shape, at first or if the stored one is out of range.
Tessellation importTessellation();
void setImportTessellation(const Tessellation& tessellation);

}  // namespace nearfit::ui
