#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/export/product_shape.h"
#include "core/import/step_request.h"

namespace nearfit::exporter {

/// Writes an assembly as a STEP file: products for shapes in the colours that they are placed in, assemblies for groups
/// within one for the whole, occurrences with the nodes' names and places.
/// @param shapes    By shape of the request; moved from.
/// @param progress  Gets the fraction done.
/// @param sink      Takes the file, piece by piece.
/// Throws Error, what OpenCASCADE and `sink` throw.
void writeStep(const StepRequest& request, std::vector<ProductShape>& shapes,
               const std::function<void(double fraction)>& progress,
               const std::function<void(std::string_view text)>& sink);

/// A text as a string of a STEP file, quotes included: apostrophes and backslashes doubled, what is not ASCII as \X2\ and
/// \X4\. Source: ISO 10303-21, 6.4.3.
std::string stepString(std::string_view utf8);

}  // namespace nearfit::exporter
