# Writes OUTPUT, a header that names the revision of the sources in SOURCE; touched only when it changes.
cmake_minimum_required(VERSION 3.22)
execute_process(COMMAND git describe --always --dirty --abbrev=12 WORKING_DIRECTORY ${SOURCE}
                OUTPUT_VARIABLE revision OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT revision)
  set(revision "unknown")
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT
"#pragma once

namespace nearfit::bench {
inline constexpr const char* kGitRevision = \"@revision@\";
}
" @ONLY)
