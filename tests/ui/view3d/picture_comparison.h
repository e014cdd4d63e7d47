#pragma once

#include <QImage>
#include <QPainter>
#include <QRect>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

/// Whether a picture looks like another: by what an eye would see, not by single pixels.
namespace nearfit::test {

struct PictureDifference {
  /// Pixels are compared in squares of so many, which forgives what edges are smoothed by.
  static constexpr int kSquare = 3;
  /// By how much a square's channel may differ without anybody seeing it, of 255.
  static constexpr int kSeen = 24;
  /// The most that a picture may differ: on the average of all squares, of 255, and the share of squares that
  /// differ by more than kSeen. A glyph that is missing is some thousandths of a small picture.
  static constexpr double kMaxMean = 0.5, kMaxShare = 0.0005;

  double mean = 255.0, share = 1.0;
  QImage picture;  ///< White where they differ most; as large as the squares are many.

  bool isSeen() const { return !(mean <= kMaxMean && share <= kMaxShare); }
};

/// @param texts  Areas of letters, which differ from one font to another: compared by their mean colour
/// alone.
inline PictureDifference compare(QImage seen, QImage expected, const std::vector<QRect>& texts = {}) {
  PictureDifference difference;
  if (seen.isNull() || seen.size() != expected.size()) return difference;
  const QSize squares(seen.width() / PictureDifference::kSquare, seen.height() / PictureDifference::kSquare);
  for (QImage* image : {&seen, &expected}) {
    *image = image->convertToFormat(QImage::Format_RGB32);
    for (const QRect& text : texts) {
      const QImage one = image->copy(text).scaled(1, 1, Qt::IgnoreAspectRatio, Qt::SmoothTransformation);
      QPainter(image).fillRect(text, one.pixelColor(0, 0));
    }
    *image = image->scaled(squares, Qt::IgnoreAspectRatio, Qt::SmoothTransformation)
                 .convertToFormat(QImage::Format_RGB32);
  }
  difference.picture = QImage(squares, QImage::Format_RGB32);
  double sum = 0.0;
  int many = 0;
  for (int y = 0; y < squares.height(); ++y) {
    for (int x = 0; x < squares.width(); ++x) {
      const QRgb a = seen.pixel(x, y), b = expected.pixel(x, y);
      const int most = std::max(
          {std::abs(qRed(a) - qRed(b)), std::abs(qGreen(a) - qGreen(b)), std::abs(qBlue(a) - qBlue(b))});
      sum += most;
      if (most > PictureDifference::kSeen) ++many;
      const int grey = std::min(255, 4 * most);
      difference.picture.setPixel(x, y, qRgb(grey, grey, grey));
    }
  }
  const double count = static_cast<double>(squares.width()) * squares.height();
  difference.mean = sum / count;
  difference.share = many / count;
  return difference;
}

}  // namespace nearfit::test
