#include "app/desktop/device_text.h"

#include <QObject>

namespace nearfit::desktop {

QString deviceText(DeviceState state, bool isPushing, const QString& note) {
  const QString because = note.isEmpty() ? QString() : QStringLiteral(": ") + note;
  switch (state) {
    case DeviceState::Armed:
      return isPushing ? QObject::tr("Armed: it pushes.")
                       : QObject::tr("It leads the part; it does not push.");
    case DeviceState::Ready:
      return QObject::tr("Not armed: it leads the part and does not push.");
    case DeviceState::Uncalibrated:
      return QObject::tr("Not calibrated%1.").arg(because);
    case DeviceState::Fault:
      return QObject::tr("Stopped%1. It does not push until it is reset and armed again.").arg(because);
    case DeviceState::Lost:
      return QObject::tr("Lost%1.").arg(because);
    default:
      return {};
  }
}

}  // namespace nearfit::desktop
