#pragma once

#include "core/import/reader_input.h"

namespace nearfit {

enum class MeshFormat { StlText, StlBinary, Obj, Ply, Off };

/// Detects the format by content if possible, else by the file name.
/// @param extension  Lower case, without the dot.
/// Throws FileError if the file is empty or in no supported format, and names the actual format if known.
MeshFormat detectMeshFormat(const ReaderInput& input, const std::string& extension);

/// Converts UTF-16 text with a byte order mark to one byte per character ('?' for non-ASCII), and removes the
/// byte order mark of UTF-8. Leaves other bytes as they are.
std::vector<char> withoutByteOrderMark(std::vector<char> bytes);

}  // namespace nearfit
