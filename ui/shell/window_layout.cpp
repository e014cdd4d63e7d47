#include "ui/shell/window_layout.h"

#include <QMainWindow>
#include <QSettings>

#include "ui/widgets/preferences.h"

namespace nearfit::ui {
namespace {

/// Raise it when docks change so that a saved layout no longer fits.
constexpr int kVersion = 1;
const QString kKey = QStringLiteral("window/layout");

}  // namespace

WindowLayout::WindowLayout(QMainWindow* window)
    : QObject(window), window_(window), fresh_(window->saveState(kVersion)) {}

void WindowLayout::restore() {
  window_->restoreGeometry(Preferences::windowGeometry());
  // Does nothing without a saved layout of this version.
  window_->restoreState(QSettings().value(kKey).toByteArray(), kVersion);
}

void WindowLayout::remember() const {
  Preferences::setWindowGeometry(window_->saveGeometry());
  QSettings().setValue(kKey, window_->saveState(kVersion));
}

void WindowLayout::reset() {
  window_->restoreState(fresh_, kVersion);
}

}  // namespace nearfit::ui
