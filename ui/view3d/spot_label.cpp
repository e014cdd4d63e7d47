#include "ui/view3d/spot_label.h"

#include "ui/view3d/view_picture.h"
#include "ui/view3d/viewport.h"

namespace nearfit::ui {

SpotLabel::SpotLabel(Viewport& view, const QString& name) : QLabel(&view), view_(view) {
  setObjectName(name);
  setAttribute(Qt::WA_TransparentForMouseEvents);
  setInPictures(*this);
  setStyleSheet(QStringLiteral("#%1 { background: rgba(28, 37, 46, 225); color: white; border-radius: 5px; "
                               "padding: 3px 7px; font-weight: 600; }")
                    .arg(name));
  hide();
  connect(&view, &Viewport::drawn, this, &SpotLabel::place);
}

void SpotLabel::showAt(const glm::dvec3& point, const QString& text) {
  point_ = point;
  setText(text);
  adjustSize();
  place();
}

void SpotLabel::end() {
  point_.reset();
  hide();
}

void SpotLabel::place() {
  if (!point_) return;
  const auto seen = view_.projection().pixelOf(*point_);
  const QPoint at = seen ? QPointF(seen->x, seen->y).toPoint() : QPoint(-1, -1);
  setVisible(view_.rect().contains(at));
  move(at - QPoint(width() / 2, height() / 2));
}

}  // namespace nearfit::ui
