#pragma once

#include <QFile>
#include <QString>
#include <filesystem>

namespace nearfit::ui {

/// Converts a file name to a path, in the file system's encoding.
inline std::filesystem::path toPath(const QString& file) {
  return std::filesystem::path(QFile::encodeName(file).toStdString());
}

/// Converts a path to a file name, in the file system's encoding.
inline QString fromPath(const std::filesystem::path& file) {
  return QFile::decodeName(QByteArray::fromStdString(file.string()));
}

}  // namespace nearfit::ui
