// For builds where lib3mf is missing.
#include "app/import/threemf_model.h"
#include "core/base/error.h"

namespace nearfit::importer {

ThreeMfModel loadThreeMf(const ImportJob& job) {
  throw FileError(job.file.string(), "this build of Nearfit reads no 3MF, because lib3mf was missing",
                  "install lib3mf-dev and build again, or export STL or STEP");
}

}  // namespace nearfit::importer
