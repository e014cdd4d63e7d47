#pragma once

#include <QIconEngine>
#include <QString>

namespace nearfit::ui {

/// An icon of resources/icons, drawn for light panels or, its colours translated, for dark ones: as the theme
/// is when it is painted.
class ThemedIcon : public QIconEngine {
 public:
  explicit ThemedIcon(const QString& file) : file_(file) {}

  void paint(QPainter* painter, const QRect& rect, QIcon::Mode mode, QIcon::State state) override;
  QPixmap pixmap(const QSize& size, QIcon::Mode mode, QIcon::State state) override;
  QIconEngine* clone() const override { return new ThemedIcon(file_); }

 private:
  QString file_;
};

}  // namespace nearfit::ui
