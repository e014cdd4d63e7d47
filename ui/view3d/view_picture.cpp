#include "ui/view3d/view_picture.h"

#include <QPainter>
#include <QVariant>
#include <QWidget>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <vtkActor.h>
#include <vtkCameraOrientationWidget.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkTextureObject.h>
#include <vtkUnsignedCharArray.h>

#include "ui/view3d/camera/orientation_marker.h"
#include "ui/view3d/view_detail.h"

namespace nearfit::ui {
namespace {

constexpr const char* kInPictures = "inPictures";

/// Poster size. Drawing takes some 25 bytes per pixel.
constexpr double kMaxPixels = 36e6;

vtkOpenGLRenderWindow& windowOf(vtkRenderer& renderer) {
  return *vtkOpenGLRenderWindow::SafeDownCast(renderer.GetRenderWindow());
}

/// Scales line widths and point sizes while it exists.
class LargerLines {
 public:
  LargerLines(std::initializer_list<vtkRenderer*> renderers, double scale) {
    for (vtkRenderer* renderer : renderers) {
      vtkPropCollection* props = renderer->GetViewProps();
      vtkCollectionSimpleIterator it;
      props->InitTraversal(it);
      while (vtkProp* prop = props->GetNextProp(it)) {
        if (auto* actor = vtkActor::SafeDownCast(prop)) add(actor->GetProperty());
      }
    }
    for (const Widths& w : before_) {
      w.look->SetLineWidth(static_cast<float>(w.line * scale));
      w.look->SetPointSize(static_cast<float>(w.point * scale));
    }
  }
  ~LargerLines() {
    for (const Widths& w : before_) {
      w.look->SetLineWidth(w.line);
      w.look->SetPointSize(w.point);
    }
  }
  LargerLines(const LargerLines&) = delete;
  LargerLines& operator=(const LargerLines&) = delete;

 private:
  struct Widths {
    vtkSmartPointer<vtkProperty>
        look;  ///< Owned: drawing may remove its actor from the view, such as a cut that follows its parts.
    float line, point;
  };
  /// Adds a property once, though several actors may share it.
  void add(vtkProperty* look) {
    const bool isKnown =
        std::any_of(before_.begin(), before_.end(), [look](const Widths& w) { return w.look.Get() == look; });
    if (!isKnown) before_.push_back({look, look->GetLineWidth(), look->GetPointSize()});
  }

  std::vector<Widths> before_;
};

/// Replaces the background while it exists.
class OtherGround {
 public:
  explicit OtherGround(vtkRenderer& renderer)
      : renderer_(renderer), isGradient_(renderer.GetGradientBackground()) {
    renderer_.GetBackground(before_.data());
  }
  ~OtherGround() {
    renderer_.SetGradientBackground(isGradient_);
    renderer_.SetBackground(before_.data());
  }
  OtherGround(const OtherGround&) = delete;
  OtherGround& operator=(const OtherGround&) = delete;

  void set(double grey) {
    renderer_.GradientBackgroundOff();
    renderer_.SetBackground(grey, grey, grey);
  }

 private:
  vtkRenderer& renderer_;
  std::array<double, 3> before_{};
  bool isGradient_;
};

/// Computes colour and alpha of each pixel from pictures over black and over white; exact for any blending
/// and smoothing of edges.
QImage uncovered(const QImage& overBlack, const QImage& overWhite) {
  QImage picture(overBlack.size(), QImage::Format_ARGB32_Premultiplied);
  for (int y = 0; y < picture.height(); ++y) {
    const auto* black = reinterpret_cast<const QRgb*>(overBlack.constScanLine(y));
    const auto* white = reinterpret_cast<const QRgb*>(overWhite.constScanLine(y));
    auto* line = reinterpret_cast<QRgb*>(picture.scanLine(y));
    for (int x = 0; x < picture.width(); ++x) {
      const QRgb b = black[x], w = white[x];
      // The channels differ by rounding. Take the largest alpha: no premultiplied colour may exceed it.
      const int shows = std::min({qRed(w) - qRed(b), qGreen(w) - qGreen(b), qBlue(w) - qBlue(b)});
      const int cover = std::max({255 - shows, qRed(b), qGreen(b), qBlue(b)});
      line[x] = qRgba(qRed(b), qGreen(b), qBlue(b), std::min(cover, 255));
    }
  }
  return picture;
}

}  // namespace

void setInPictures(QWidget& label) {
  label.setProperty(kInPictures, true);
}

QSize ViewPicture::size() const {
  const int* size = view_.parts.GetRenderWindow()->GetSize();
  return {size[0], size[1]};
}

QSize ViewPicture::largestSize() const {
  const QSize now = size();
  if (now.isEmpty()) return now;
  vtkOpenGLRenderWindow& window = windowOf(view_.parts);
  window.MakeCurrent();
  const double most = vtkTextureObject::GetMaximumTextureSize(&window);
  const double width = now.width(), height = now.height();
  double scale = std::sqrt(kMaxPixels / (width * height));
  if (most > 0.0) scale = std::min(scale, most / std::max(width, height));
  return {static_cast<int>(width * scale), static_cast<int>(height * scale)};
}

QImage ViewPicture::take(const PictureStyle& style) {
  return take(style, Detail::Whole);
}

QImage ViewPicture::preview(const PictureStyle& style) {
  return take(style, Detail::Quick);
}

QImage ViewPicture::take(const PictureStyle& style, Detail detail) {
  vtkOpenGLRenderWindow& window = windowOf(view_.parts);
  const QSize before = size();
  if (before.isEmpty() || window.GetNeverRendered() != 0) return {};
  const double most = static_cast<double>(largestSize().width()) / before.width();
  const double scale = std::clamp(style.scale, 1.0 / before.width(), std::max(1.0, most));
  const QSize size(std::max(1, static_cast<int>(std::lround(before.width() * scale))),
                   std::max(1, static_cast<int>(std::lround(before.height() * scale))));
  const bool hasAxes = view_.axes.GetEnabled() != 0;
  view_.detail.drop();
  if (!style.hasAxes) view_.axes.Off();
  sizeOrientationMarker(view_.axes, scale);
  window.SetSize(size.width(), size.height());
  QImage picture;
  {
    const LargerLines lines({&view_.parts, &view_.overlay}, scale);
    picture = draw(style, detail);
  }
  window.SetSize(before.width(), before.height());
  sizeOrientationMarker(view_.axes, 1.0);
  if (hasAxes) view_.axes.On();
  view_.detail.drop();
  // The window shows the picture drawn last.
  window.Render();
  if (style.hasLabels) paintLabels(picture, scale * view_.widget.devicePixelRatioF());
  return picture;
}

QImage ViewPicture::draw(const PictureStyle& style, Detail detail) {
  OtherGround ground(view_.parts);
  if (style.ground == PictureStyle::Ground::View) return drawn(detail);
  ground.set(1.0);
  const QImage overWhite = drawn(detail);
  if (style.ground == PictureStyle::Ground::White) return overWhite;
  ground.set(0.0);
  return uncovered(drawn(detail), overWhite);
}

QImage ViewPicture::drawn(Detail detail) {
  vtkOpenGLRenderWindow& window = windowOf(view_.parts);
  detail == Detail::Whole ? view_.detail.completeAnew() : view_.detail.showAllNext();
  window.Render();
  const QSize size = this->size();
  vtkNew<vtkUnsignedCharArray> pixels;
  constexpr int kBack = 0;
  window.GetRGBACharPixelData(0, 0, size.width() - 1, size.height() - 1, kBack, pixels);
  const QImage upsideDown(pixels->GetPointer(0), size.width(), size.height(), QImage::Format_RGBX8888);
  return upsideDown.mirrored().convertToFormat(QImage::Format_RGB32);
}

void ViewPicture::paintLabels(QImage& picture, double scale) const {
  QPainter painter(&picture);
  painter.setRenderHints(QPainter::Antialiasing | QPainter::TextAntialiasing |
                         QPainter::SmoothPixmapTransform);
  painter.scale(scale, scale);
  for (QObject* child : view_.widget.children()) {
    auto* label = qobject_cast<QWidget*>(child);
    if (label == nullptr || !label->isVisible() || !label->property(kInPictures).toBool()) continue;
    painter.save();
    painter.translate(label->pos());
    label->render(&painter, QPoint(), QRegion(), QWidget::DrawChildren);
    painter.restore();
  }
}

}  // namespace nearfit::ui
