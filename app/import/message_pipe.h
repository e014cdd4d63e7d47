#pragma once

#include <string>

namespace nearfit::importer {

/// Where the importer says how far it is and why it fails; see core/import/import_protocol.h. Thread-safe as long as
/// one thread at a time reports progress.
class MessagePipe {
 public:
  /// @param descriptor  -1: nothing is written.
  explicit MessagePipe(int descriptor) : descriptor_(descriptor) {}

  /// Writes the fraction done if it is a step further than the last one.
  void progress(double fraction);
  void failure(const std::string& where, const std::string& problem, const std::string& remedy) const;

 private:
  void writeLine(std::string line) const;

  int descriptor_;
  double written_ = -1.0;
};

}  // namespace nearfit::importer
