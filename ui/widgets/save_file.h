#pragma once

#include <QString>
#include <QStringList>
#include <optional>

class QWidget;

namespace nearfit::ui {

/// Request for the name of a file to save.
struct SaveRequest {
  QString title;
  QString start;        ///< Folder and name that are offered first.
  QStringList filters;  ///< Filters for QFileDialog, one for each kind.
  /// Suffixes without dots: the usual one of each kind first, in the order of `filters` if there are several.
  QStringList suffixes;
};

/// Asks for a file to save to. A name that ends in none of the suffixes gets that of the chosen kind,
/// whatever dots are in it. Asks before a file is replaced.
/// @return std::nullopt if the user cancels.
std::optional<QString> askForSave(const SaveRequest& request, QWidget* parent);

}  // namespace nearfit::ui
