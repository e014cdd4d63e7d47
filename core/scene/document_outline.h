#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/import/cad_document.h"

namespace nearfit {

/// A CAD document without its geometry: what the cache keeps beside the shapes.
struct DocumentOutline {
  struct Shape {
    std::string key;
    std::string problem;  ///< Why it has no geometry; empty if it has.
  };
  std::vector<CadNode> nodes;
  std::vector<Shape> shapes;  ///< By CadNode::shape.
  std::vector<std::string> warnings;
};

/// Makes all texts printable UTF-8 and names at most as long as a part's. Throws FileError, naming the file, if a
/// parent does not come before its child, a shape does not exist, a pose is out of range, a key is empty, repeated, too
/// long or not UTF-8, or a colour has no value from 0 to 1.
DocumentOutline checkedOutline(DocumentOutline outline, const std::filesystem::path& file);

/// The outline as text, and read from it: nothing in it is trusted; no value if it is not an outline.
std::string outlineText(const DocumentOutline& outline);
std::optional<DocumentOutline> readOutline(std::string_view text, const std::filesystem::path& file);

}  // namespace nearfit
