#pragma once

#include <QMetaType>
#include <QString>
#include <QVector>

namespace nearfit::ui {

/// A connected device that can be chosen as the hand, or a notice about devices.
struct DeviceChoice {
  QString id;    ///< Unique while the device is connected; empty for a notice.
  QString name;  ///< Text in the list.
  QString note;  ///< Why it cannot be used and what to do, or what it needs; may be empty.
  bool isUsable = false;
  bool isMendable = false;  ///< Not usable, but the user can fix that.
  QString command = {};     ///< Shell command, one line, that fixes it; may be empty.
  bool operator==(const DeviceChoice& other) const {
    return id == other.id && name == other.name && note == other.note && isUsable == other.isUsable &&
           isMendable == other.isMendable && command == other.command;
  }
};

}  // namespace nearfit::ui

Q_DECLARE_METATYPE(nearfit::ui::DeviceChoice)
Q_DECLARE_METATYPE(QVector<nearfit::ui::DeviceChoice>)
