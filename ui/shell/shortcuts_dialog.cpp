#include "ui/shell/shortcuts_dialog.h"

#include <QAction>
#include <QDialogButtonBox>
#include <QHeaderView>
#include <QLineEdit>
#include <QMainWindow>
#include <QMenu>
#include <QMenuBar>
#include <QScreen>
#include <QScrollBar>
#include <QSet>
#include <QTreeWidget>
#include <QVBoxLayout>
#include <algorithm>
#include <utility>

namespace nearfit::ui {
namespace {

/// Returns a menu's text without mnemonics and the ellipsis at its end; "&&" is an ampersand. One inside is of a name
/// that was shortened.
QString plainText(const QString& text) {
  QString plain = text;
  plain.replace(QStringLiteral("&&"), QStringLiteral("\x01")).remove(QChar('&')).replace('\x01', '&');
  if (plain.endsWith(QChar(0x2026))) plain.chop(1);
  return plain;
}

QString keysOf(const QAction& action) {
  QStringList keys;
  for (const QKeySequence& sequence : action.shortcuts())
    keys << sequence.toString(QKeySequence::NativeText);
  return keys.join(QObject::tr(" or "));
}

/// An empty icon as wide as the others, so that names align.
QIcon noIcon() {
  QPixmap empty(32, 32);
  empty.fill(Qt::transparent);
  return empty;
}

QTreeWidgetItem* addGroup(QTreeWidget* list, const QString& title) {
  auto* group = new QTreeWidgetItem(list, {title});
  QFont bold = list->font();
  bold.setBold(true);
  group->setFont(0, bold);
  group->setFlags(Qt::ItemIsEnabled);
  group->setFirstColumnSpanned(true);
  return group;
}

/// Adds the actions that have keys and are not listed yet.
/// @param menu  Prefix for actions of a submenu, such as "Drop to contact: "; empty for a menu of the bar.
void listActions(QTreeWidgetItem* group, const QList<QAction*>& actions, QSet<const QAction*>& listed,
                 const QString& menu = {}) {
  for (QAction* action : actions) {
    if (action->menu() != nullptr)
      listActions(group, action->menu()->actions(), listed,
                  QObject::tr("%1: ").arg(plainText(action->text())));
    if (action->menu() != nullptr || action->shortcut().isEmpty() || listed.contains(action)) continue;
    listed << action;
    auto* item = new QTreeWidgetItem(group, {menu + plainText(action->text()), keysOf(*action)});
    item->setIcon(0, action->icon().isNull() ? noIcon() : action->icon());
    item->setToolTip(0, action->toolTip());
  }
}

void addView(QTreeWidget* list) {
  QTreeWidgetItem* group = addGroup(list, QObject::tr("Mouse and keys in the view"));
  const std::pair<QString, QString> entries[] = {
      {QObject::tr("Orbit"), QObject::tr("Left drag")},
      {QObject::tr("Orbit, even where a drag would move a part"), QObject::tr("Ctrl+Middle drag")},
      {QObject::tr("Pan"), QObject::tr("Middle drag")},
      {QObject::tr("Zoom"), QObject::tr("Wheel, or right drag")},
      {QObject::tr("Select a part"), QObject::tr("Click")},
      {QObject::tr("Add to the selection, or remove from it"), QObject::tr("Ctrl+Click")},
      {QObject::tr("Menu of commands for a part"), QObject::tr("Right click, or the Menu key")},
      {QObject::tr("Select the parts seen in a box"), QObject::tr("B, then left drag")},
      {QObject::tr("Go from Parts or History to the view, then to the pose"), QObject::tr("Tab")},
      {QObject::tr("Move the part by a step"), QObject::tr("Arrow keys, Page Up, Page Down")},
      {QObject::tr("Rotate the part by a step"), QObject::tr("Shift+Arrow keys, Shift+Page Up or Page Down")},
      {QObject::tr("Move the manual hand"), QObject::tr("Shift+Left drag, Shift+Wheel")},
      {QObject::tr("Rotate the manual hand"), QObject::tr("Shift+Right drag")}};
  for (const auto& [what, keys] : entries)
    new QTreeWidgetItem(group, {what, keys});
}

}  // namespace

ShortcutsDialog::ShortcutsDialog(QMainWindow* window)
    : QDialog(window), window_(window), search_(new QLineEdit(this)), list_(new QTreeWidget(this)) {
  setObjectName(QStringLiteral("shortcutsDialog"));
  setWindowTitle(tr("Keyboard shortcuts"));
  search_->setObjectName(QStringLiteral("shortcutSearch"));
  search_->setPlaceholderText(tr("Search for a command or a key"));
  search_->setAccessibleName(tr("Search for a command or a key"));
  search_->setClearButtonEnabled(true);
  list_->setObjectName(QStringLiteral("shortcutList"));
  list_->setAccessibleName(tr("Commands and their keys"));
  list_->setColumnCount(2);
  list_->setHeaderLabels({tr("Command"), tr("Keys")});
  list_->setRootIsDecorated(false);
  list_->setSelectionMode(QAbstractItemView::NoSelection);
  list_->header()->setSectionResizeMode(0, QHeaderView::ResizeToContents);
  list_->header()->setSectionResizeMode(1, QHeaderView::ResizeToContents);
  list_->header()->setStretchLastSection(true);
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close, this);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  auto* layout = new QVBoxLayout(this);
  layout->addWidget(search_);
  layout->addWidget(list_);
  layout->addWidget(buttons);
  connect(search_, &QLineEdit::textChanged, this, &ShortcutsDialog::filter);
}

void ShortcutsDialog::open() {
  fill();
  search_->clear();
  search_->setFocus();
  fitToContent();
  show();
  raise();
}

/// Makes both columns readable at any font size, as far as the screen allows.
void ShortcutsDialog::fitToContent() {
  constexpr int kRows = 26;
  const int around = 2 * style()->pixelMetric(QStyle::PM_LayoutLeftMargin) +
                     list_->verticalScrollBar()->sizeHint().width() + 2 * list_->frameWidth() +
                     fontMetrics().height();
  list_->header()->setStretchLastSection(false);
  int wide = around;
  for (int column = 0; column < list_->columnCount(); ++column) {
    list_->resizeColumnToContents(column);
    wide += list_->columnWidth(column);
  }
  list_->header()->setStretchLastSection(true);
  const QSize room = 0.9 * QSizeF(screen()->availableSize()).toSize();
  resize(QSize(wide, kRows * list_->visualItemRect(list_->topLevelItem(0)).height()).boundedTo(room));
}

void ShortcutsDialog::fill() {
  list_->clear();
  QSet<const QAction*> listed;
  for (QAction* top : window_->menuBar()->actions()) {
    if (top->menu() != nullptr)
      listActions(addGroup(list_, plainText(top->text())), top->menu()->actions(), listed);
  }
  listActions(addGroup(list_, tr("Elsewhere")), window_->findChildren<QAction*>(), listed);
  addView(list_);
  for (int i = list_->topLevelItemCount() - 1; i >= 0; --i) {
    if (list_->topLevelItem(i)->childCount() == 0) delete list_->takeTopLevelItem(i);
  }
  list_->expandAll();
}

void ShortcutsDialog::filter(const QString& words) {
  const QStringList wanted = words.split(' ', Qt::SkipEmptyParts);
  for (int i = 0; i < list_->topLevelItemCount(); ++i) {
    QTreeWidgetItem* group = list_->topLevelItem(i);
    bool isAnyShown = false;
    for (int j = 0; j < group->childCount(); ++j) {
      QTreeWidgetItem* item = group->child(j);
      const QString text = item->text(0) + QChar(' ') + item->text(1);
      const bool isShown = std::all_of(wanted.begin(), wanted.end(), [&](const QString& word) {
        return text.contains(word, Qt::CaseInsensitive);
      });
      item->setHidden(!isShown);
      isAnyShown = isAnyShown || isShown;
    }
    group->setHidden(!isAnyShown);
  }
}

}  // namespace nearfit::ui
