#pragma once

#include <QString>
#include <optional>

class QWidget;

namespace nearfit::ui {

/// Asks why findings of a scene check may stay: one line, as PairRecord::reason.
/// @param count    Number of findings.
/// @param offered  Reason that is offered.
/// @return std::nullopt if the user cancels; else not empty.
std::optional<QString> askForReason(int count, const QString& offered, QWidget* parent);

}  // namespace nearfit::ui
