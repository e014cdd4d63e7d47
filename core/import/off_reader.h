#pragma once

#include "core/import/reader_input.h"

namespace nearfit {

/// True if a file's first token marks it as OFF ("OFF", "COFF", "4OFF", "STCN4OFF", "OFF8", ...).
bool startsLikeOff(std::string_view firstToken);

/// Reads vertices and faces of a text file in Geomview's Object File Format. Skips colours, normals and
/// texture coordinates. Two vertices or faces must not share a line. Throws FileError, Cancelled.
ReaderResult readOff(const ReaderInput& input);

}  // namespace nearfit
