#pragma once

#include <QString>
#include <QStringList>
#include <string>

namespace nearfit::ui {

/// Shortens a name for use within a text: beyond 40 characters its middle becomes an ellipsis.
QString shortName(const QString& name);
QString shortName(const std::string& name);

/// Returns `text` for a label that wraps, with zero-width spaces where long words may break.
QString breakable(const QString& text);

/// Returns "a", "a and b", "a, b and c" or "a, b and 4 more"; each name shortened.
/// @param most   Max number of names listed; at least 1.
/// @param count  Total number, where `names` does not hold all.
QString listOfNames(const QStringList& names, int most, int count = 0);

}  // namespace nearfit::ui
