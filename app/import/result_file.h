#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/base/error.h"

namespace nearfit::importer {

/// Writes a program's result to a descriptor, in large pieces.
class ResultFile {
 public:
  /// @param descriptor  Not closed.
  /// @param whenFull    Thrown where nothing more can be written: the limit of the file or of memory is reached.
  ResultFile(int descriptor, Error whenFull);

  /// Throws `whenFull`.
  void add(std::span<const std::byte> bytes);
  /// Writes what is left. To be called last. Throws `whenFull`.
  void flush();

 private:
  int descriptor_;
  Error whenFull_;
  std::vector<std::byte> pending_;
};

}  // namespace nearfit::importer
