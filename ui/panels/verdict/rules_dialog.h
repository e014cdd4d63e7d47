#pragma once

#include <optional>
#include <vector>

#include "core/scene/scene.h"

class QWidget;

namespace nearfit::ui {

/// Shows the rules of a scene's check to be added, changed and removed.
/// @param added  A rule to begin with, such as for the pair of a finding; it is last, and chosen.
/// @return std::nullopt if the user cancels; else valid rules.
std::optional<std::vector<PairRule>> askForRules(const Scene& scene, const std::optional<PairRule>& added,
                                                 QWidget* parent);

}  // namespace nearfit::ui
