#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "core/path/assembly_path.h"

// clang-format off
/// The path file `*.nfpath`, JSON in UTF-8:
///
///     {
///       "path": 1,                                format version
///       "program": "Nearfit 0.1.0",               that wrote it
///       "parts": ["Peg", "Jaw"],                  names of the parts that move as one; the first leads
///       "centre": [0, 0, 0.05],                   moves straight between poses; in the frame of the part that leads [m]
///       "poses": [[0.25, 0, 0, 0.05, 1, 0, 0, 0]] time [s], then worldFromLead: position [m], quaternion w x y z, unit
///     }
///
/// Numbers have enough digits to read back as the same double.
// clang-format on
namespace nearfit {

class JsonField;

/// Text of a path file.
std::string pathFileText(const AssemblyPath& path);
/// Writes a path file atomically. Throws FileError.
void writePathFile(const AssemblyPath& path, const std::filesystem::path& file);

/// Reads a path file and trusts nothing in it: the result passes checkPath(). Throws FileError.
AssemblyPath readPathFile(const std::filesystem::path& file);

/// True if a file begins as JSON does, and so cannot be a recording. Throws FileError if it cannot be read.
bool isJsonFile(const std::filesystem::path& file);

/// Parts, centre and poses as JSON, for files that hold a path; and back, checked by checkPath(). Throws FileError.
nlohmann::ordered_json pathJson(const AssemblyPath& path);
AssemblyPath pathOfJson(const JsonField& json);

/// The poses as CSV (UTF-8): `t_s`, then tx, ty, tz [m], qw, qx, qy, qz of worldFromLead.
std::string pathCsv(const AssemblyPath& path);

}  // namespace nearfit
