#pragma once

#include "core/mesh/readers/reader_input.h"

namespace nearfit {

/// Whether a first token is that of an OFF file ("OFF", "COFF", "4OFF", "STCN4OFF", "OFF8", ...).
bool startsLikeOff(std::string_view firstToken);

/// Vertices and faces of a text file in Geomview's Object File Format; colours, normals and texture
/// coordinates are passed over. A vertex or a face must not share its line with the next one. Throws
/// FileError, Cancelled.
ReaderResult readOff(const ReaderInput& input);

}  // namespace nearfit
