#pragma once

class QImage;
class QString;

namespace nearfit::ui {

/// Writes a picture as PNG, or as JPEG if the file's suffix says so; replaces the file whole or not at all (atomicWrite()).
/// Any thread. Throws FileError.
void writePicture(const QImage& picture, const QString& file);

}  // namespace nearfit::ui
