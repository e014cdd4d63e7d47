#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "core/import/reader_input.h"

/// A reader for each mesh format; importMesh() chooses among them. Each has a source file of its own, such as
/// obj_reader.cpp.
namespace nearfit {

/// Sizes in a binary STL file [bytes]; the header includes the facet count.
constexpr std::size_t kStlHeaderBytes = 84, kStlFacetBytes = 50;

/// Number of facets according to the header of a binary STL file. `bytes` has at least kStlHeaderBytes.
std::uint32_t stlFacetCount(std::span<const char> bytes);

/// Reads the facets of a binary STL file, each with three vertices of its own; MeshBuilder welds them. Throws
/// FileError, Cancelled.
ReaderResult readStlBinary(const ReaderInput& input);

/// Reads the facets of all solids in an ASCII STL file. Keywords may have any case, `#` starts a comment,
/// normals are skipped. Throws FileError, Cancelled.
ReaderResult readStlText(const ReaderInput& input);

/// Reads vertices and faces of a Wavefront OBJ file. Skips everything else and opens no other file. Handles
/// line continuations, negative indices and extra numbers after a vertex. Throws FileError, Cancelled.
ReaderResult readObj(const ReaderInput& input);

/// Reads vertices and faces of a PLY file, text or binary in either byte order. Skips other elements and
/// properties. Throws FileError, Cancelled.
ReaderResult readPly(const ReaderInput& input);

/// True if a file's first token marks it as OFF ("OFF", "COFF", "4OFF", "STCN4OFF", "OFF8", ...).
bool startsLikeOff(std::string_view firstToken);

/// Reads vertices and faces of a text file in Geomview's Object File Format. Skips colours, normals and
/// texture coordinates. Two vertices or faces must not share a line. Throws FileError, Cancelled.
ReaderResult readOff(const ReaderInput& input);

}  // namespace nearfit
