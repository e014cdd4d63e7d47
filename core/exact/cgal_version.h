#pragma once

namespace nearfit {

/// Version of CGAL, such as "5.5.1".
const char* cgalVersion() noexcept;

}  // namespace nearfit
