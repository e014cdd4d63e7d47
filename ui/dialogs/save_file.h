#pragma once

#include <QString>
#include <QStringList>
#include <optional>

class QWidget;

namespace nearfit::ui {

/// A file that a user is to name.
struct SaveRequest {
  QString title;
  QString start;         ///< Folder and name that are offered first.
  QStringList filters;   ///< As of QFileDialog, one for each kind.
  QStringList suffixes;  ///< Without dots; of each kind its usual one first, in the filters' order where
                         ///< there are several.
};

/// Asks where to. A name that ends in none of the suffixes gets that of the kind that is chosen, whatever
/// dots are in it; what stands there is replaced only when the user says so.
/// @return Nothing when the user cancels.
std::optional<QString> askForSave(const SaveRequest& request, QWidget* parent);

}  // namespace nearfit::ui
