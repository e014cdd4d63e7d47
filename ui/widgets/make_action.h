#pragma once

#include <QKeySequence>
#include <QString>

class QAction;
class QObject;

namespace nearfit::ui {

/// Sets what the tool tip of an action says: its name and keys, and below them the help. The name and keys are kept up
/// to date. Replaces what setToolTip() set; from then on only setHelp() changes it.
/// @param help  A sentence without the name or keys; plain text.
void setHelp(QAction& action, const QString& help);

/// Makes an action.
/// @param parent    Owns it.
/// @param iconName  As for icon(); empty: none.
/// @param help      As for setHelp(); empty: its tool tip is its text.
QAction* makeAction(QObject* parent, const char* name, const QString& text, const QString& iconName = {},
                    const QKeySequence& keys = {}, const QString& help = {});
/// Makes an action that is on or off, without keys.
QAction* makeSwitch(QObject* parent, const char* name, const QString& text, const QString& iconName,
                    bool isOn, const QString& help);

}  // namespace nearfit::ui
