#pragma once

#include <QString>
#include <QStringList>
#include <optional>

#include <glm/vec3.hpp>

class QWidget;

namespace nearfit::ui {

/// Length of a grown person's hand, wrist to fingertip: between the medians of women and men. Source: DIN 33402-2 [m].
constexpr double kHandLength = 0.19;

/// Facts that help to choose a unit.
struct UnitHints {
  /// Extent of what is in the scene [m], shown for comparison beside a hand's; std::nullopt: nothing.
  std::optional<glm::dvec3> scene = {};
  /// Diagonals of the smallest and the largest part in the scene [m], or a hand's length if there is none: the unit that
  /// is offered gives a size near these (likelyMeshUnit()).
  double leastSize = kHandLength, mostSize = kHandLength;
  /// Offered instead if it gives a plausible size: metres per unit that the user chose for such files before.
  std::optional<double> chosen = {};
};

/// Asks for the unit of mesh files that do not store one. Shows the size that each unit gives them; several
/// files are measured together. Reads the files in another thread and takes no answer before that.
/// @param files  At least one. If none of them can be read, there is nothing to ask: returns any unit, and loading the
///               files says what is wrong with them.
/// @return Metres per unit; std::nullopt if the user cancels.
std::optional<double> askForUnit(const QStringList& files, const UnitHints& hints, QWidget* parent);

/// Asks for another unit of parts that are in the scene. Shows the size that each unit gives them.
/// @param parts          Their names, for the question.
/// @param extent         Along each axis of the mesh files, in the files' units; of documents that change as a whole, of
///                       what they place.
/// @param hints          The extent of the other parts is shown for comparison.
/// @param metresPerUnit  Of the present unit.
/// @return Metres per unit; std::nullopt if the user cancels.
std::optional<double> askForOtherUnit(const QStringList& parts, const glm::dvec3& extent,
                                      const UnitHints& hints, double metresPerUnit, QWidget* parent);

}  // namespace nearfit::ui
