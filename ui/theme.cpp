#include "ui/theme.h"

#include <QApplication>
#include <QPalette>
#include <QStyleFactory>

// Q_INIT_RESOURCE declares a function and so must stand outside of any namespace.
static void initResources() {
  Q_INIT_RESOURCE(nearfit);
}

namespace nearfit::ui {
namespace {

constexpr const char* kStyleSheet = R"(
QMainWindow { background: #eef1f4; }
QMainWindow::separator { background: #d5dbe1; width: 1px; height: 1px; }
QMainWindow::separator:hover { background: #1f73d0; }
QMenuBar { background: #f7f9fa; border-bottom: 1px solid #d5dbe1; }
QMenuBar::item { padding: 4px 9px; background: transparent; }
QMenuBar::item:selected { background: #dcebfb; border-radius: 3px; }
QToolBar { background: #f7f9fa; border: none; border-bottom: 1px solid #d5dbe1; padding: 3px 6px; spacing: 2px; }
QToolBar::separator { background: #d5dbe1; width: 1px; margin: 5px 6px; }
QToolBar QToolButton { border: 1px solid transparent; border-radius: 4px; padding: 4px; }
QToolBar QToolButton:hover { background: #e6eef7; border-color: #c9d9ea; }
QToolBar QToolButton:pressed, QToolBar QToolButton:checked { background: #d3e5f8; border-color: #9fc4ec; }
QDockWidget { font-weight: bold; color: #3b4754; }
QDockWidget::title { background: #e4e9ee; padding: 6px 10px; }
QDockWidget > QWidget { background: #f7f9fa; }
QStatusBar { background: #f7f9fa; border-top: 1px solid #d5dbe1; }
QStatusBar::item { border: none; }
QTreeView { border: none; background: #ffffff; outline: none; }
QTreeView::item { height: 28px; border: none; padding-left: 4px; }
QTreeView::item:hover { background: #f0f5fa; }
QTreeView::item:selected { background: #d3e5f8; color: #16202a; }
QDialogButtonBox { dialogbuttonbox-buttons-have-icons: 0; }
QToolTip { background: #2c3640; color: #ffffff; border: none; padding: 4px; }
)";

}  // namespace

void loadResources() {
  initResources();
}

void applyTheme(QApplication& application) {
  loadResources();
  QApplication::setStyle(QStyleFactory::create(QStringLiteral("Fusion")));
  QPalette palette;
  palette.setColor(QPalette::Window, QColor(0xf7, 0xf9, 0xfa));
  palette.setColor(QPalette::Base, Qt::white);
  palette.setColor(QPalette::AlternateBase, QColor(0xf3, 0xf6, 0xf9));
  palette.setColor(QPalette::Button, QColor(0xf7, 0xf9, 0xfa));
  palette.setColor(QPalette::Highlight, colours::kAccent);
  palette.setColor(QPalette::HighlightedText, Qt::white);
  for (const auto role : {QPalette::WindowText, QPalette::Text, QPalette::ButtonText}) {
    palette.setColor(role, QColor(0x1c, 0x25, 0x2e));
    palette.setColor(QPalette::Disabled, role, QColor(0x9a, 0xa4, 0xae));
  }
  QApplication::setPalette(palette);
  application.setStyleSheet(QString::fromLatin1(kStyleSheet));
  QApplication::setWindowIcon(icon(QStringLiteral("nearfit")));
}

QIcon icon(const QString& name) {
  return QIcon(QStringLiteral(":/icons/%1.svg").arg(name));
}

}  // namespace nearfit::ui
