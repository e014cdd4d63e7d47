#include "ui/shell/window_layout.h"

#include <QMainWindow>
#include <QScreen>
#include <QSettings>
#include <algorithm>

#include "ui/widgets/preferences.h"

namespace nearfit::ui {
namespace {

/// Raise it when docks change so that a saved layout no longer fits.
constexpr int kVersion = 2;
const QString kLayoutKey = QStringLiteral("window/layout");

}  // namespace

WindowLayout::WindowLayout(QMainWindow* window)
    : QObject(window), window_(window), fresh_(window->saveState(kVersion)) {}

void WindowLayout::restore() {
  window_->restoreGeometry(Preferences::windowGeometry());
  // Does nothing without a saved layout of this version.
  window_->restoreState(QSettings().value(kLayoutKey).toByteArray(), kVersion);
  fitToScreen();
}

void WindowLayout::fitToScreen() {
  constexpr int kTitleBar = 36;  // [pixels]
  const QScreen* screen = window_->screen();
  if (screen == nullptr || window_->isMaximized() || window_->isFullScreen()) return;
  const QRect room = screen->availableGeometry();
  const QSize most(room.width(), std::max(1, room.height() - kTitleBar));
  if (window_->width() <= most.width() && window_->height() <= most.height()) return;
  window_->resize(window_->size().boundedTo(most));
  window_->move(room.topLeft());
}

void WindowLayout::remember() const {
  Preferences::setWindowGeometry(window_->saveGeometry());
  QSettings().setValue(kLayoutKey, window_->saveState(kVersion));
}

void WindowLayout::reset() {
  window_->restoreState(fresh_, kVersion);
}

}  // namespace nearfit::ui
