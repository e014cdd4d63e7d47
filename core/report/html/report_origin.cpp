#include "core/report/html/report_origin.h"

#include <array>
#include <ctime>
#include <string_view>

#include "git_revision.h"
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <glm/detail/setup.hpp>
#include <nlohmann/json.hpp>
#include <openssl/crypto.h>
#include <pwd.h>
#include <sys/utsname.h>
#include <unistd.h>
#include <zlib.h>

#include "core/base/error.h"
#include "core/exact/cgal_version.h"
#include "core/import/import_process.h"

namespace nearfit {
namespace {

/// The user's name on this system; empty if it has none.
std::string userName() {
  // The size that the manual of getpwuid_r() calls enough.
  std::array<char, 16384> text{};
  ::passwd entry{};
  ::passwd* found = nullptr;
  if (::getpwuid_r(::geteuid(), &entry, text.data(), text.size(), &found) != 0 || found == nullptr) return "";
  return found->pw_name != nullptr ? found->pw_name : "";
}

std::string systemName() {
  ::utsname name{};
  if (::uname(&name) != 0) return "unknown";
  return fmt::format("{} {}, {}", name.sysname, name.release, name.machine);
}

std::string libraryVersions() {
  return fmt::format("CGAL {}, GLM {}.{}.{}, zlib {}, {}, {{fmt}} {}.{}.{}, nlohmann/json {}.{}.{}",
                     cgalVersion(), GLM_VERSION_MAJOR, GLM_VERSION_MINOR, GLM_VERSION_PATCH, ::zlibVersion(),
                     ::OpenSSL_version(OPENSSL_VERSION), FMT_VERSION / 10000, FMT_VERSION / 100 % 100,
                     FMT_VERSION % 100, NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                     NLOHMANN_JSON_VERSION_PATCH);
}

}  // namespace

ReportOrigin reportOrigin() {
  const std::string_view revision = kGitRevision;
  return {fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))),
          userName(),
          "Nearfit " NEARFIT_VERSION,
          libraryVersions(),
          systemName(),
          std::string(revision == "unknown" ? "" : revision),
          {}};
}

std::string importerOfReport() {
  try {
    return importerVersion();
  } catch (const FileError& e) {
    // Shapes that were read before are kept: a report needs no importer.
    return "unknown: " + e.problem();
  }
}

}  // namespace nearfit
