#include "ui/view3d/drawing/picture_pace.h"

#include <QScreen>
#include <QTimer>
#include <algorithm>

namespace nearfit::ui {

void PicturePace::request() {
  if (hasRequest_) return;
  hasRequest_ = true;
  const QScreen* screen = view_.window()->screen();
  const auto interval = static_cast<qint64>(1000.0 / std::max(30.0, screen->refreshRate()));
  const qint64 since = sincePicture_.isValid() ? sincePicture_.elapsed() : interval;
  QTimer::singleShot(static_cast<int>(std::max<qint64>(0, interval - since)), Qt::PreciseTimer, this, [this] {
    hasRequest_ = false;
    if (view_.isVisible()) emit pictureDue();
  });
}

}  // namespace nearfit::ui
