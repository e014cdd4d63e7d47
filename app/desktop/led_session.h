#pragma once

#include <QObject>
#include <QString>
#include <optional>

#include "app/desktop/application.h"

namespace nearfit::desktop {

/// What is to be felt as soon as the files are open.
struct LedOptions {
  QString device;                 ///< As chooseDevice has it, or "replay:FILE"; empty for the first.
  bool isArming = false;          ///< As soon as it is ready.
  std::optional<double> seconds;  ///< From the first tick on; then the program ends and says what was done.
};

/// Opens files in the window and takes the moving part in hand with a device; for the rest the window is the
/// user's.
class LedSession : public QObject {
  Q_OBJECT

 public:
  /// @param application  Outlives this.
  LedSession(Application& application, LedOptions options);

  /// Begins. With a time, the event loop ends with 0, or with 1 after a message on stderr.
  void begin(const QStringList& files);

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
