#include "ui/widgets/make_action.h"

#include <QAction>
#include <QTextDocument>

#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

/// Property of an action with help: the help.
constexpr const char* kHelp = "help";

void showHelp(QAction& action) {
  // Without the mark of an underlined letter.
  QString name = action.iconText();
  if (name.endsWith(QChar(0x2026))) name.chop(1);
  const QString keys = action.shortcut().toString(QKeySequence::NativeText);
  const QString heading = keys.isEmpty() ? name : QStringLiteral("%1 (%2)").arg(name, keys);
  const QString tip = heading + QChar('\n') + action.property(kHelp).toString();
  // A part's name must not be read as markup.
  action.setToolTip(Qt::mightBeRichText(tip)
                        ? QStringLiteral("<qt>%1</qt>")
                              .arg(tip.toHtmlEscaped().replace(QChar('\n'), QStringLiteral("<br>")))
                        : tip);
}

}  // namespace

void setHelp(QAction& action, const QString& help) {
  const bool isFirst = !action.property(kHelp).isValid();
  action.setProperty(kHelp, help);
  showHelp(action);
  // A tool tip that is as before tells of no change, so this ends.
  if (isFirst) QObject::connect(&action, &QAction::changed, &action, [&action] { showHelp(action); });
}

QAction* makeAction(QObject* parent, const char* name, const QString& text, const QString& iconName,
                    const QKeySequence& keys, const QString& help) {
  auto* action = new QAction(text, parent);
  action->setObjectName(QLatin1String(name));
  if (!iconName.isEmpty()) action->setIcon(icon(iconName));
  action->setShortcut(keys);
  if (!help.isEmpty()) setHelp(*action, help);
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
