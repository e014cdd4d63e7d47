#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "core/import/cad_document.h"

namespace nearfit {

/// Limits of a document. The importer keeps them, and readDocument() refuses what exceeds them.
///
/// Of nodes a tree of parts shows tens of thousands at best, and a file of some lines can ask for a billion.
constexpr std::size_t kMaxDocumentNodes = 100'000;
/// Of levels, the top one included: below those of a scene's groups.
constexpr std::size_t kMaxDocumentDepth = 30;
/// Of a node's name, as parts and groups of a scene have it, and of a shape's key [bytes of UTF-8].
constexpr std::size_t kMaxNodeNameBytes = 200, kMaxDocumentKeyBytes = 1000;
/// Of a warning [bytes of UTF-8], and of warnings in a list.
constexpr std::size_t kMaxWarningBytes = 1000, kMaxWarnings = 100;
/// Of a coordinate or a length, in the document's unit: farther than the moon in millimetres, and its square and cube
/// are far from overflow.
constexpr double kMaxDocumentLength = 1e12;
/// Least and largest unit that a file may state [m]: from nanometres to beyond miles.
constexpr double kMinStatedUnit = 1e-9, kMaxStatedUnit = 1e4;
/// Max size of the result file: some 100 million triangles at 32 bytes each.
constexpr std::uint64_t kMaxDocumentBytes = std::uint64_t{4} << 30;

/// Throws Error, whose place is within the document, if it exceeds a limit or contradicts itself: an index out of
/// range, a parent behind its child, a number that is not finite, a direction that is no unit vector, a text that is no
/// printable UTF-8, a key that repeats.
void checkDocument(const CadDocument& document);

/// Takes bytes of a result file, in order; may throw.
using DocumentSink = std::function<void(std::span<const std::byte>)>;

/// Writes a document as the result file of the importer, in the byte order of this machine. Throws as checkDocument()
/// does, and what `sink` throws.
void writeDocument(const CadDocument& document, const DocumentSink& sink);

/// Reads a result file. Nothing in it is trusted: counts are compared with the bytes that are there before any memory is
/// taken, and the whole is checked as checkDocument() does.
/// @param name  Stands in messages for the file.
/// Throws FileError.
CadDocument readDocument(std::span<const std::byte> bytes, const std::string& name);

}  // namespace nearfit
