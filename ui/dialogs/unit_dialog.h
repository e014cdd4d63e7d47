#pragma once

#include <QString>
#include <optional>

class QWidget;

namespace nearfit::ui {

/// Asks in which unit the numbers of mesh files are, which they do not say themselves. Offers the unit chosen
/// last and remembers the answer.
/// @param what  The file, or how many files, for the question.
/// @return Metres per unit; empty when the user cancelled.
std::optional<double> askForUnit(const QString& what, QWidget* parent);

}  // namespace nearfit::ui
