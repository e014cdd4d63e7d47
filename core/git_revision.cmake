# Writes OUTPUT, a header that names the revision of the sources in SOURCE; touched only when it changes.
cmake_minimum_required(VERSION 3.22)
# "-dirty" where the sources differ from the commit. Results and pages made from them are not what is measured; the same list
# is in resources/scripts/figure_sources/heads.py.
execute_process(COMMAND git rev-parse --short=12 HEAD WORKING_DIRECTORY ${SOURCE}
                OUTPUT_VARIABLE revision OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE result)
execute_process(COMMAND git status --porcelain --untracked-files=no -- . ":(exclude)tests/*/results/*" ":(exclude)*.md"
                WORKING_DIRECTORY ${SOURCE}
                OUTPUT_VARIABLE changes OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT result EQUAL 0 OR NOT revision)
  set(revision "unknown")
elseif(changes)
  string(APPEND revision "-dirty")
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT
"#pragma once

namespace nearfit {
/// Revision of the sources; \"-dirty\" where they differ from it, \"unknown\" without git.
inline constexpr const char* kGitRevision = \"@revision@\";
}
" @ONLY)
