#pragma once

#include <QObject>
#include <QString>
#include <optional>

#include "app/desktop/application.h"

namespace nearfit::desktop {

/// Opens files in the window, takes the moving part in hand if there is one, and writes a
/// picture of the window.
class Screenshot : public QObject {
  Q_OBJECT

 public:
  /// @param application  Must outlive this.
  Screenshot(Application& application, QString output);

  /// Starts; the event loop then ends with 0, or with 1 after a message on stderr.
  /// @param metresPerUnit, tessellation  As for Document::openFiles().
  void take(const QStringList& files, std::optional<double> metresPerUnit,
            const std::optional<Tessellation>& tessellation);

 private:
  void arrange(bool isComplete);
  void waitForMinima(const ServoSnapshot& snapshot);
  void write();
  void fail(const QString& message);

  Application& application_;
  QString output_;
  QString note_;  ///< The last that the document made.
  bool hasFailed_ = false, isWriting_ = false;
};

}  // namespace nearfit::desktop
