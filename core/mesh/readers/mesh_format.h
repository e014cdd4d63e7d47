#pragma once

#include "core/mesh/readers/reader_input.h"

namespace nearfit {

enum class MeshFormat { StlText, StlBinary, Obj, Ply, Off };

/// Tells the format by content where that can tell it, else by the name's ending.
/// @param extension  Lower case without the dot.
/// Throws FileError for an empty file and for what is none of the formats, saying what it is where that is
/// known.
MeshFormat detectMeshFormat(const ReaderInput& input, const std::string& extension);

/// Text in UTF-16 with a byte order mark as one byte a character, what is not ASCII as '?'; UTF-8 without its
/// byte order mark. Other bytes are left as they are.
std::vector<char> withoutByteOrderMark(std::vector<char> bytes);

}  // namespace nearfit
