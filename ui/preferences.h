#pragma once

#include <QByteArray>
#include <QString>

#include "core/haptics/rate_settings.h"
#include "ui/length_unit.h"

namespace nearfit::ui {

/// What the program remembers for a user from one run to the next. Nothing of a scene is in here.
class Preferences {
 public:
  /// Metres in one unit of the mesh file added last; 1e-3 (millimetres) at first.
  static double metresPerUnit();
  static void setMetresPerUnit(double metresPerUnit);

  /// Folder of the file chosen last; the user's documents, or home, at first and where it is there no more.
  static QString lastFolder();
  /// Remembers the folder of `file`.
  static void rememberFolderOf(const QString& file);

  /// How a space mouse drives; the usual settings at first, and where what is kept makes no sense.
  static RateSettings rate();
  static void setRate(const RateSettings& settings);

  /// The unit that lengths are shown in; millimetres at first.
  static LengthUnit lengthUnit();
  static void setLengthUnit(LengthUnit unit);

  /// Whether the program has never run before for this user; from now on it has.
  static bool takeFirstRun();

  static QByteArray windowGeometry();
  static void setWindowGeometry(const QByteArray& geometry);
};

}  // namespace nearfit::ui
