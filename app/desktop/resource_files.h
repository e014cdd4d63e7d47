#pragma once

#include <QString>

namespace nearfit::desktop {

/// Returns the path of a file that comes with the program, named by its path below resources/
/// ("demo/piston.nearfit"): beside the installed program, or in the source tree that it was built from. Empty
/// if it is in neither. Needs the QCoreApplication.
QString resourceFile(const QString& name);

}  // namespace nearfit::desktop
