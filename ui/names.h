#pragma once

#include <QString>
#include <QStringList>
#include <string>

namespace nearfit::ui {

/// A name as it stands within a text: cut in the middle where it is longer than a line should be.
QString shortName(const QString& name);
QString shortName(const std::string& name);

/// A text for a label that wraps: also words that are too long for a line are broken.
QString breakable(const QString& text);

/// "a", "a and b", "a, b and c", "a, b and 4 more"; each cut where it is long.
/// @param most   Names that are said, at least 1.
/// @param count  How many there are, when not all of them are given.
QString listOfNames(const QStringList& names, int most, int count = 0);

}  // namespace nearfit::ui
