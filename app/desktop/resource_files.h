#pragma once

#include <QString>

namespace nearfit::desktop {

/// A file that comes with the program, by its path below resources/ ("demo/piston.nearfit"): beside the
/// installed program, or in the source tree that it was built from. Empty when it is in neither. Needs the
/// QCoreApplication.
QString resourceFile(const QString& name);

}  // namespace nearfit::desktop
