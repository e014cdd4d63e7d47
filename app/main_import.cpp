// Reads a CAD document in a process of its own, for core/import/document_import.cpp: what a file does to its reader, it
// does here.
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <new>
#include <span>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

#include "app/import/import_job.h"
#include "app/import/message_pipe.h"
#include "app/import/read_document.h"
#include "app/import/result_file.h"
#include "app/import/sandbox.h"
#include "core/base/error.h"
#include "core/import/document_file.h"
#include "core/import/import_protocol.h"

namespace {

namespace importer = nearfit::importer;
namespace protocol = nearfit::import_protocol;

/// Tells on stderr what each stage took.
class StageTimes {
 public:
  explicit StageTimes(bool isShown) : isShown_(isShown) {}
  void end(const char* stage) {
    const auto now = std::chrono::steady_clock::now();
    if (isShown_)
      fmt::print(stderr, "{:9s} {:7.3f} s\n", stage, std::chrono::duration<double>(now - begin_).count());
    begin_ = now;
  }

 private:
  bool isShown_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// Throws FileError if the document exceeds a limit: what its file says is too large, too far away or not finite.
void writeResult(const nearfit::CadDocument& document, const importer::ImportOptions& options) {
  try {
    importer::ResultFile result(options.result, {"", "its triangles are too many, or memory has run out",
                                                 "choose a coarser tessellation"});
    nearfit::writeDocument(document, [&](std::span<const std::byte> bytes) { result.add(bytes); });
    result.flush();
  } catch (const nearfit::Error& error) {
    // Its place is one in the document, which nobody sees.
    const bool isPlaced = !error.where().empty();
    throw nearfit::FileError(
        options.file.string(),
        isPlaced ? fmt::format("what it holds is out of range ({}: {})", error.where(), error.problem())
                 : error.problem(),
        isPlaced ? "check its units and sizes, and export it again" : error.remedy());
  }
}

int importFile(const importer::ImportOptions& options, importer::MessagePipe& messages) {
  StageTimes times(options.showsTimes);
  importer::ImportJob job = importer::openJob(options);
  importer::limitProcess(job.bytes.size());
  importer::enterSandbox(importer::readablePaths(job));
  job.progress = [&](double fraction) { messages.progress(fraction); };
  job.endStage = [&](const char* stage) { times.end(stage); };
  if (options.showsTimes) {
    job.tellEarly = [](std::size_t solids, std::size_t meshed) {
      fmt::print(stderr, "{} of {} solids meshed during the transfer\n", meshed, solids);
    };
  }
  times.end("open");
  const nearfit::CadDocument document = importer::readDocumentOf(job);
  times.end("mesh");
  if (options.showsTimes) importer::printSummary(document);
  if (options.result >= 0) {
    writeResult(document, options);
    times.end("write");
  }
  messages.progress(1.0);
  return protocol::kDone;
}

int fail(const importer::MessagePipe& messages, const std::string& where, const std::string& problem,
         const std::string& remedy) {
  messages.failure(where, problem, remedy);
  fmt::print(stderr, "nearfit-import: {}{}{}{}{}\n", where, where.empty() ? "" : ": ", problem,
             remedy.empty() ? "" : "; ", remedy);
  return protocol::kFailed;
}

int run(const importer::ImportOptions& options, importer::MessagePipe& messages) {
  try {
    return importFile(options, messages);
  } catch (const nearfit::Error& error) {
    return fail(messages, error.where(), error.problem(), error.remedy());
  } catch (const std::bad_alloc&) {
    return protocol::kOutOfMemory;
  } catch (const std::exception& error) {
    return fail(messages, "", fmt::format("it cannot be read: {}", error.what()),
                "export it again, or in another format");
  }
}

}  // namespace

int main(int argc, char** argv) {
  // A reader who has gone, and a result beyond its limit, are errors to report.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  importer::ImportOptions options;
  try {
    options = importer::parseImportOptions(argc, argv);
  } catch (const nearfit::Error& error) {
    fmt::print(stderr, "nearfit-import: {}\n", error.what());
    return protocol::kFailed;
  }
  if (options.isVersionAsked) {
    fmt::print("nearfit-import {}\nOpenCASCADE {}\nsandbox: {}\n", NEARFIT_VERSION, importer::occVersion(),
               importer::sandboxText());
    return 0;
  }
  if (options.triesSandbox) {
    fmt::print("{}", importer::trySandbox());
    return 0;
  }
  importer::MessagePipe messages(options.messages);
  const int code = run(options, messages);
  // Libraries have nothing to save, and may take long to free what they hold.
  std::fflush(nullptr);
  ::_exit(code);
}
