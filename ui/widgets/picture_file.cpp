#include "ui/widgets/picture_file.h"

#include <QBuffer>
#include <QByteArray>
#include <QFileInfo>
#include <QImage>
#include <QString>
#include <cstddef>
#include <string_view>

#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "ui/widgets/paths.h"

namespace nearfit::ui {
namespace {

constexpr int kJpegQuality = 92;  ///< Out of 100: edges of parts stay clean.

}  // namespace

void writePicture(const QImage& picture, const QString& file) {
  const QString suffix = QFileInfo(file).suffix().toLower();
  const bool isJpeg = suffix == QLatin1String("jpg") || suffix == QLatin1String("jpeg");
  QByteArray bytes;
  QBuffer buffer(&bytes);
  buffer.open(QIODevice::WriteOnly);
  if (!picture.save(&buffer, isJpeg ? "JPG" : "PNG", isJpeg ? kJpegQuality : -1))
    throw FileError(toPath(file).string(), "the picture could not be encoded", "choose a smaller size");
  atomicWrite(toPath(file), std::string_view(bytes.constData(), static_cast<std::size_t>(bytes.size())));
}

}  // namespace nearfit::ui
