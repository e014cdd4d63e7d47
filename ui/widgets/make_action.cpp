#include "ui/widgets/make_action.h"

#include <QAction>

#include "ui/widgets/theme.h"

namespace nearfit::ui {

QAction* makeAction(QObject* parent, const char* name, const QString& text, const QString& iconName,
                    const QKeySequence& keys, const QString& help) {
  auto* action = new QAction(text, parent);
  action->setObjectName(QLatin1String(name));
  if (!iconName.isEmpty()) action->setIcon(icon(iconName));
  action->setShortcut(keys);
  if (help.isEmpty()) return action;
  const QString shown = action->shortcut().toString(QKeySequence::NativeText);
  action->setToolTip(shown.isEmpty() ? help : QStringLiteral("%1 (%2)").arg(help, shown));
  return action;
}

QAction* makeSwitch(QObject* parent, const char* name, const QString& text, const QString& iconName,
                    bool isOn, const QString& help) {
  QAction* action = makeAction(parent, name, text, iconName, {}, help);
  action->setCheckable(true);
  action->setChecked(isOn);
  return action;
}

}  // namespace nearfit::ui
