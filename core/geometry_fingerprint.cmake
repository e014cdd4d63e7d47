# Writes OUTPUT, a header with one hash over the files in SOURCES (separated by commas) and COMPILER; touched only when
# it changes. Cached hierarchies carry it: what other sources or another compiler made is never taken for what these would.
cmake_minimum_required(VERSION 3.22)
string(REPLACE "," ";" files "${SOURCES}")
set(hashes "${COMPILER}")
foreach(file IN LISTS files)
  file(SHA256 ${file} hash)
  string(APPEND hashes " ${hash}")
endforeach()
string(SHA256 fingerprint "${hashes}")
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT
"#pragma once

namespace nearfit {
/// Of the sources that derive meshes and hierarchies, in hexadecimal.
inline constexpr char kGeometryFingerprint[] = \"@fingerprint@\";
}  // namespace nearfit
" @ONLY)
