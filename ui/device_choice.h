#pragma once

#include <QMetaType>
#include <QString>
#include <QVector>

namespace nearfit::ui {

/// A device that is plugged in, as a choice of hand; or something about devices that the user may know.
struct DeviceChoice {
  QString id;    ///< Tells it from all others for as long as it is plugged in; empty for a mere notice.
  QString name;  ///< For the list.
  QString note;  ///< Why it cannot be used and what to do, or what it needs; may be empty.
  bool isUsable = false;
  bool isMendable = false;  ///< It cannot be used, and the user can do something about it.
  QString command = {};     ///< One line for a shell that does; or empty.
  bool operator==(const DeviceChoice& other) const {
    return id == other.id && name == other.name && note == other.note && isUsable == other.isUsable &&
           isMendable == other.isMendable && command == other.command;
  }
};

}  // namespace nearfit::ui

Q_DECLARE_METATYPE(nearfit::ui::DeviceChoice)
Q_DECLARE_METATYPE(QVector<nearfit::ui::DeviceChoice>)
