#pragma once

#include <QString>
#include <optional>

class QWidget;

namespace nearfit::ui {

/// Asks for the unit of mesh files that do not store one. Offers the unit chosen last and
/// remembers the answer.
/// @param what  The file, or the number of files, for the question.
/// @return Metres per unit; std::nullopt if the user cancels.
std::optional<double> askForUnit(const QString& what, QWidget* parent);

}  // namespace nearfit::ui
