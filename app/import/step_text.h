#pragma once

#include <string>
#include <string_view>

namespace nearfit::importer {

/// A text of a STEP file in UTF-8: control directives such as \X2\00FC\X0\ become the characters that they stand for
/// (ISO 10303-21, 6.4.3). OpenCASCADE leaves those that it does not know.
std::string decodedStepText(std::string_view text);

}  // namespace nearfit::importer
