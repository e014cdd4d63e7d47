#pragma once

#include <QByteArray>
#include <QString>

namespace nearfit::ui {

/// What the program remembers for a user from one run to the next. Nothing of a scene is in here.
class Preferences {
 public:
  /// Metres in one unit of the mesh file added last; 1e-3 (millimetres) at first.
  static double metresPerUnit();
  static void setMetresPerUnit(double metresPerUnit);

  /// Folder of the file chosen last; empty at first.
  static QString lastFolder();
  /// Remembers the folder of `file`.
  static void rememberFolderOf(const QString& file);

  static QByteArray windowGeometry();
  static void setWindowGeometry(const QByteArray& geometry);
};

}  // namespace nearfit::ui
