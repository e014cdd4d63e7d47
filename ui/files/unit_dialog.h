#pragma once

#include <QString>
#include <QStringList>
#include <optional>

#include <glm/vec3.hpp>

class QWidget;

namespace nearfit::ui {

/// Asks for the unit of mesh files that do not store one. Shows the size that each unit gives them; several
/// files are measured together. Reads the files in another thread and takes no answer before that. Offers the
/// unit chosen last and remembers the answer.
/// @param files   At least one. If none of them can be read, there is nothing to ask: returns the unit chosen
///                last, and loading the files says what is wrong with them.
/// @param others  Extent of what is in the scene [m], shown for comparison beside a hand's; std::nullopt: nothing.
/// @return Metres per unit; std::nullopt if the user cancels.
std::optional<double> askForUnit(const QStringList& files, const std::optional<glm::dvec3>& others,
                                 QWidget* parent);

/// Asks for another unit of parts that are in the scene. Shows the size that each unit gives them.
/// @param parts          Their names, for the question.
/// @param extent         Along each axis of the mesh files, in the files' units.
/// @param metresPerUnit  Of the present unit.
/// @return Metres per unit; std::nullopt if the user cancels.
std::optional<double> askForOtherUnit(const QStringList& parts, const glm::dvec3& extent,
                                      double metresPerUnit, QWidget* parent);

}  // namespace nearfit::ui
