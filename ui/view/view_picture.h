#pragma once

#include <QImage>

class QWidget;
class vtkCameraOrientationWidget;
class vtkRenderer;

namespace nearfit::ui {

class ViewDetail;

/// How a picture that is taken away shows the view.
struct PictureStyle {
  enum class Ground {
    View,         ///< As the view has it.
    White,        ///< For paper.
    Transparent,  ///< For pages of any colour.
  };
  double scale = 1.0;  ///< Of the view's own pixels; lines, dots and letters grow with it.
  Ground ground = Ground::View;
  bool hasAxes = true;    ///< Those in the corner.
  bool hasLabels = true;  ///< The legend, and what is measured.
};

/// Marks what stands over the view and belongs in its pictures, as handles and bars of tools do not.
void setInPictures(QWidget& label);

/// Takes pictures of a view away from the screen: whole, whatever the view leaves out to be quick, and in
/// another size. The view is as it was after that, and drawn anew.
class ViewPicture {
 public:
  /// All outlive this.
  struct View {
    QWidget& widget;
    vtkRenderer& parts;
    vtkRenderer& overlay;
    vtkCameraOrientationWidget& axes;
    ViewDetail& detail;
  };
  explicit ViewPicture(const View& view) : view_(view) {}

  /// The view's own size, and the largest one that the machine can draw [pixels].
  QSize size() const;
  QSize largestSize() const;

  /// @param style  Its scale is held to what largestSize() allows.
  /// @return Null when there is nothing to draw on.
  QImage take(const PictureStyle& style);
  /// The same, only as much of the parts as a quick picture shows.
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
