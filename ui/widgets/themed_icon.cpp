#include "ui/widgets/themed_icon.h"

#include <QApplication>
#include <QFile>
#include <QPainter>
#include <QPixmapCache>
#include <QStyle>
#include <QStyleOption>
#include <QSvgRenderer>

#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

QPixmap draw(const QString& file, const QSize& size, bool isDark) {
  QFile svg(file);
  if (!svg.open(QIODevice::ReadOnly)) return {};
  QString text = QString::fromUtf8(svg.readAll());
  if (isDark) text = inDarkColours(text);
  QSvgRenderer renderer(text.toUtf8());
  QPixmap pixmap(size);
  pixmap.fill(Qt::transparent);
  QPainter painter(&pixmap);
  renderer.render(&painter);
  return pixmap;
}

}  // namespace

void ThemedIcon::paint(QPainter* painter, const QRect& rect, QIcon::Mode mode, QIcon::State state) {
  const qreal ratio = painter->device() != nullptr ? painter->device()->devicePixelRatioF() : 1.0;
  QPixmap shown = pixmap(rect.size() * ratio, mode, state);
  shown.setDevicePixelRatio(ratio);
  painter->drawPixmap(rect, shown);
}

QPixmap ThemedIcon::pixmap(const QSize& size, QIcon::Mode mode, QIcon::State) {
  const bool isDark = isThemeDark();
  const QString key = QStringLiteral("nearfit:%1:%2x%3:%4:%5")
                          .arg(file_)
                          .arg(size.width())
                          .arg(size.height())
                          .arg(static_cast<int>(mode))
                          .arg(isDark);
  QPixmap pixmap;
  if (QPixmapCache::find(key, &pixmap)) return pixmap;
  pixmap = draw(file_, size, isDark);
  if (mode == QIcon::Disabled) {
    QStyleOption option;
    option.palette = QApplication::palette();
    pixmap = QApplication::style()->generatedIconPixmap(mode, pixmap, &option);
  }
  QPixmapCache::insert(key, pixmap);
  return pixmap;
}

}  // namespace nearfit::ui
