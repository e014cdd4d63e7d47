#pragma once

#include <QImage>

class QWidget;
class vtkCameraOrientationWidget;
class vtkRenderer;

namespace nearfit::ui {

class ViewDetail;

/// How an exported picture shows the view.
struct PictureStyle {
  enum class Ground {
    View,         ///< The view's own background.
    White,        ///< For paper.
    Transparent,  ///< For pages of any colour.
  };
  double scale = 1.0;  ///< Relative to the view's size; lines, dots and text grow with it.
  Ground ground = Ground::View;
  bool hasAxes = true;    ///< The axes in the corner.
  bool hasLabels = true;  ///< Legend, measurements and scale bar.
};

/// Marks a child widget of the view to be painted into exported pictures; handles and tool bars are not.
void setInPictures(QWidget& label);

/// Exports pictures of the view: in full detail, whatever the view leaves out for speed, and in any size.
/// Restores and redraws the view afterwards.
class ViewPicture {
 public:
  /// Parts of the view; all outlive this.
  struct View {
    QWidget& widget;
    vtkRenderer& parts;
    vtkRenderer& overlay;
    vtkCameraOrientationWidget& axes;
    ViewDetail& detail;
  };
  explicit ViewPicture(const View& view) : view_(view) {}

  /// The view's size [device pixels].
  QSize size() const;
  /// The largest size that the machine can draw, in the same proportion [pixels].
  QSize largestSize() const;

  /// Draws a picture.
  /// @param style  Its scale is clamped to what largestSize() allows.
  /// @return  Null if the view has not been drawn yet.
  QImage take(const PictureStyle& style);
  /// The same with only the detail of a quick picture.
  QImage preview(const PictureStyle& style);

 private:
  enum class Detail { Quick, Whole };

  QImage take(const PictureStyle& style, Detail detail);
  QImage draw(const PictureStyle& style, Detail detail);
  QImage drawn(Detail detail);
  void paintLabels(QImage& picture, double scale) const;

  View view_;
};

}  // namespace nearfit::ui
