#pragma once

#include <optional>

#include "core/scene/refinement.h"

class QWidget;

namespace nearfit::ui {

/// Asks for another tessellation of shapes. Shows the present one, its triangles, and how many parts will follow.
/// @param refinement  Names the parts, all of which are in the scene; at least one.
/// @return std::nullopt if the user cancels.
std::optional<Tessellation> askForTessellation(const Scene& scene, const Refinement& refinement,
                                               QWidget* parent);

/// Asks for the tessellation of documents that are added from now on. Shows the present one.
/// @return std::nullopt if the user cancels.
std::optional<Tessellation> askForImportTessellation(const Tessellation& present, QWidget* parent);

}  // namespace nearfit::ui
