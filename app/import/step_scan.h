#pragma once

#include <span>
#include <string>

namespace nearfit::importer {

/// Looks through the text of a STEP file once, without building anything, for what makes readers of such files take all
/// memory or overflow their stack: nesting of parentheses, numbers beyond range, assemblies that contain themselves,
/// assemblies nested so that a few lines stand for a billion instances, and entities chained deep by their references.
/// Takes time nearly linear in the size of the file.
/// Throws FileError with the line.
void scanStep(std::span<const char> text, const std::string& name);

}  // namespace nearfit::importer
