#pragma once

#include <QFile>
#include <QString>
#include <filesystem>

namespace nearfit::ui {

inline std::filesystem::path toPath(const QString& file) {
  return std::filesystem::path(QFile::encodeName(file).toStdString());
}

inline QString fromPath(const std::filesystem::path& file) {
  return QFile::decodeName(QByteArray::fromStdString(file.string()));
}

}  // namespace nearfit::ui
