#pragma once

#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "core/verdict/finding_states.h"

namespace nearfit {

/// The findings that are there or gone, in the order of tables: the worst first.
/// @param compared  Kept by pointer in the result.
std::vector<const ComparedFinding*> findingsBySeverity(const std::vector<ComparedFinding>& compared);

/// A check of a scene as a table of text, one row for each finding that is there, the worst first: those that no rule
/// allows, then by verdict, then the deepest or nearest. A line names the columns; lengths are in metres.
/// @param compared  Of this check (finding_states.h); findings that are gone have rows of their own.
std::string sceneCheckTable(const Scene& scene, const SceneCheck& check,
                            const std::vector<ComparedFinding>& compared);

/// One line: pairs checked, left out, and by verdict; how many of the clashes no rule allows, and how many of these the
/// user has accepted.
std::string sceneCheckSummary(const SceneCheck& check, const std::vector<ComparedFinding>& compared);

/// One line: findings that are new, worse, better and gone beside the last check; "" if there was none before.
std::string sceneCheckChanges(const std::vector<ComparedFinding>& compared);

/// The same rows as CSV (UTF-8): `part`, `other`, `verdict`, `allowed` (0 or 1), `rule` (in words), `state`, `change`,
/// `reason`, `distance [m]`, the points `part_x [m]` ... `other_z [m]`, `minima`, `every_minimum` (0 or 1), `depth [m]`,
/// `depth_exact` (0 or 1), `free_x` ... `free_z` (direction of the translation of the first part that frees it),
/// `volume [m^3]`, `volume_problem`, `curves [m]` (length), `interference [m]` (at most), and what the last check found:
/// `before_verdict`, `before_distance [m]`, `before_depth [m]`. Cells without a value are empty.
std::string sceneCheckCsv(const Scene& scene, const SceneCheck& check,
                          const std::vector<ComparedFinding>& compared);

/// All of it as JSON: threshold, rules, counts, findings with points, minima, curves and measures, pairs left out,
/// findings that are gone. Lengths are in metres, in the world frame; what is not known is null.
std::string sceneCheckJson(const Scene& scene, const SceneCheck& check,
                           const std::vector<ComparedFinding>& compared);

}  // namespace nearfit
