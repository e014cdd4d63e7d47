#pragma once

#include <span>
#include <string>

namespace nearfit::importer {

/// Bytes as a file in memory, for readers that take a path.
class MemoryFile {
 public:
  /// Throws Error if memory has run out.
  explicit MemoryFile(std::span<const char> bytes);
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::string path() const;

 private:
  int descriptor_ = -1;
};

}  // namespace nearfit::importer
