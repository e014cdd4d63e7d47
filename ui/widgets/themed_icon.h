#pragma once

#include <QIconEngine>
#include <QString>

namespace nearfit::ui {

/// Paints an icon of resources/icons in the colours of the theme at that moment, light or dark.
class ThemedIcon : public QIconEngine {
 public:
  /// @param file  The SVG's resource path.
  explicit ThemedIcon(const QString& file) : file_(file) {}

  void paint(QPainter* painter, const QRect& rect, QIcon::Mode mode, QIcon::State state) override;
  QPixmap pixmap(const QSize& size, QIcon::Mode mode, QIcon::State state) override;
  QIconEngine* clone() const override { return new ThemedIcon(file_); }

 private:
  QString file_;
};

}  // namespace nearfit::ui
