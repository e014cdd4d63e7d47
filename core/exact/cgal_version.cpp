#include "core/exact/cgal_version.h"

#include <CGAL/version.h>

namespace nearfit {

const char* cgalVersion() noexcept {
  return CGAL_VERSION_STR;
}

}  // namespace nearfit
