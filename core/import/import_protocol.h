#pragma once

#include <string_view>

/// Descriptors and messages shared by nearfit-import and nearfit-export with the program that starts them.
namespace nearfit::import_protocol {

/// Names of the programs, which lie in the folder of the others.
constexpr const char* kProgram = "nearfit-import";
constexpr const char* kExportProgram = "nearfit-export";

/// File descriptors that they get: one to write the result to, and one for messages; the exporter also one to read its
/// request from.
constexpr int kResultDescriptor = 3, kMessageDescriptor = 4, kRequestDescriptor = 5;

/// Messages are lines of fields with a tab between them: kProgress and the fraction done, or kFailure and where, what
/// is wrong and what to do.
constexpr std::string_view kProgress = "progress", kFailure = "failure";
/// Longest field that is shown [bytes], and longest line that is read: a broken importer may write anything.
constexpr std::size_t kMaxFieldBytes = 1000, kMaxLineBytes = 16'384;

/// Exit codes: the result is whole; a kFailure says why there is none; memory ran out.
constexpr int kDone = 0, kFailed = 1, kOutOfMemory = 3;

}  // namespace nearfit::import_protocol
