#pragma once

#include <QByteArray>
#include <QString>

#include "core/haptics/rate_settings.h"
#include "ui/widgets/length_unit.h"

namespace nearfit::ui {

/// Settings that the program keeps for a user between runs (QSettings); nothing that belongs to a scene.
class Preferences {
 public:
  /// Folder of the file chosen last; the user's documents folder, or home, at first or
  /// if it no longer exists.
  static QString lastFolder();
  /// Remembers the folder of `file`.
  static void rememberFolderOf(const QString& file);

  /// How a space mouse drives; the defaults at first, or if the stored settings are out of range.
  static RateSettings rate();
  static void setRate(const RateSettings& settings);

  /// The hand chosen last, as HandChoice names it; empty at first.
  static QString hand();
  static void setHand(const QString& hand);

  /// Unit of the lengths shown; millimetres at first.
  static LengthUnit lengthUnit();
  static void setLengthUnit(LengthUnit unit);

  /// Range of maps of clearance [m]; 0, at first or if the stored one is no length: automatic.
  static double clearanceRange();
  static void setClearanceRange(double range);
  /// True if maps of clearance show near parts too; false at first.
  static bool hasNearClearances();
  static void setNearClearances(bool hasNearParts);

  /// Max threshold of a check of the scene [m].
  static constexpr double kMaxCheckThreshold = 1e3;
  /// Distance up to which checks and reports of the scene list pairs of parts [m]; 1 mm at first, or if the stored one is
  /// out of range.
  static double checkThreshold();
  static void setCheckThreshold(double threshold);

  /// True if the view is in orthographic projection; false at first.
  static bool isOrthographic();
  static void setOrthographic(bool isOrthographic);
  /// True if the view has a scale bar; true at first.
  static bool hasScaleBar();
  static void setScaleBar(bool hasScaleBar);

  /// Returns true the first time the program runs for this user, and false from then on.
  static bool takeFirstRun();

  /// As QWidget::saveGeometry() gives it; empty at first.
  static QByteArray windowGeometry();
  static void setWindowGeometry(const QByteArray& geometry);
};

}  // namespace nearfit::ui
