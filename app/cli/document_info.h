#pragma once

#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "core/scene/document_load.h"

namespace nearfit::cli {

/// Text of nearfit-cli info about a CAD document: unit, shapes with their triangles, and the tree.
/// @param name     Of the file, as it was given.
/// @param density  [kg/m^3]; std::nullopt: no masses.
std::string documentText(const std::string& name, const LoadedDocument& document,
                         std::optional<double> density);
nlohmann::ordered_json documentJson(const std::string& name, const LoadedDocument& document,
                                    std::optional<double> density);

}  // namespace nearfit::cli
