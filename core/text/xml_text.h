#pragma once

#include <string>
#include <string_view>

namespace nearfit {

/// A text for an attribute or content of XML 1.0 in UTF-8: &, <, >, quotes, tabs and line breaks as references.
/// Characters that XML cannot hold, and bytes that are no UTF-8, become U+FFFD.
std::string xmlText(std::string_view text);

}  // namespace nearfit
