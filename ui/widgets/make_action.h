#pragma once

#include <QKeySequence>
#include <QString>

class QAction;
class QObject;

namespace nearfit::ui {

/// Makes an action.
/// @param parent    Owns it.
/// @param iconName  As for icon(); empty: none.
/// @param help      What it does, for its tool tip, which also names the keys; empty: its text.
QAction* makeAction(QObject* parent, const char* name, const QString& text, const QString& iconName = {},
                    const QKeySequence& keys = {}, const QString& help = {});
/// Makes an action that is on or off, without keys.
QAction* makeSwitch(QObject* parent, const char* name, const QString& text, const QString& iconName,
                    bool isOn, const QString& help);

}  // namespace nearfit::ui
