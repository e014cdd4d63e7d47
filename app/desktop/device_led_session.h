#pragma once

#include <QObject>
#include <QString>
#include <optional>

#include "app/desktop/application.h"

namespace nearfit::desktop {

/// Options of a run that a device leads.
struct LedOptions {
  QString device;                 ///< Named as for chooseDevice(), or "replay:FILE"; empty: the first.
  bool isArming = false;          ///< Arms it as soon as it is ready.
  std::optional<double> seconds;  ///< From the first tick on; then the program ends and prints a summary.
};

/// Opens files in the window and takes the moving part in hand with a device; otherwise the
/// window is the user's.
class DeviceLedSession : public QObject {
  Q_OBJECT

 public:
  /// @param application  Must outlive this.
  DeviceLedSession(Application& application, LedOptions options);

  /// Starts. If `seconds` is set, the event loop ends with 0, or with 1 after a message on stderr.
  /// @param metresPerUnit, tessellation  As for Document::openFiles().
  void begin(const QStringList& files, std::optional<double> metresPerUnit,
             const std::optional<Tessellation>& tessellation);

 private:
  void take(bool isComplete);
  void follow(const ui::ServoStatus& status);
  void finish();
  void fail(const QString& message);

  Application& application_;
  const LedOptions options_;
  bool hasBegun_ = false, hasArmed_ = false, hasEnded_ = false;
};

}  // namespace nearfit::desktop
