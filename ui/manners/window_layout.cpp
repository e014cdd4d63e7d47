#include "ui/manners/window_layout.h"

#include <QMainWindow>
#include <QSettings>

#include "ui/preferences.h"

namespace nearfit::ui {
namespace {

/// To be raised when docks change so that what was kept of them makes no sense.
constexpr int kVersion = 1;
const QString kKey = QStringLiteral("window/layout");

}  // namespace

WindowLayout::WindowLayout(QMainWindow* window)
    : QObject(window), window_(window), fresh_(window->saveState(kVersion)) {}

void WindowLayout::restore() {
  window_->restoreGeometry(Preferences::windowGeometry());
  // What is none, or of another version, changes nothing.
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
