#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

/// Documents with changes in them, for readers that a fuzzer cannot look into.
namespace nearfit::fuzz {

/// A file of a CAD document.
struct DocumentBytes {
  std::string name;  ///< Its extension tells the format.
  std::string bytes;
};

/// The documents among files and in folders, by name. A file *.model is the model of a 3MF file, to be packed into one.
/// Files larger than `maxBytes` are left out.
std::vector<DocumentBytes> documentsIn(std::span<const std::filesystem::path> paths, std::uintmax_t maxBytes);

/// The document of a seed as a file: packed if it is a model of 3MF.
DocumentBytes packed(DocumentBytes document);

/// One of the seeds with some changes: numbers, references and names replaced by others, statements dropped and repeated,
/// bytes changed, the end cut off. The same numbers give the same document.
/// @param seeds  At least one.
DocumentBytes changedDocument(std::span<const DocumentBytes> seeds, std::uint64_t seed, std::uint64_t index);

}  // namespace nearfit::fuzz
