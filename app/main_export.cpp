// Writes a STEP file in a process of its own, for core/import/import_process.cpp: it takes a request, reads again the
// files that have exact surfaces, and returns the bytes of a STEP file.
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Standard_Failure.hxx>
#include <Standard_OutOfMemory.hxx>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "app/export/exact_sources.h"
#include "app/export/faceted_shape.h"
#include "app/export/step_writer.h"
#include "app/import/message_pipe.h"
#include "app/import/occ_progress.h"
#include "app/import/read_document.h"
#include "app/import/result_file.h"
#include "app/import/sandbox.h"
#include "core/base/error.h"
#include "core/import/import_protocol.h"
#include "core/import/step_request.h"

namespace {

namespace exporter = nearfit::exporter;
namespace importer = nearfit::importer;
namespace protocol = nearfit::import_protocol;

/// Progress once the sources are read, and once all shapes are there.
constexpr double kSourcesRead = 0.4, kShapesMade = 0.5;

std::vector<std::byte> readRequestBytes() {
  struct ::stat status{};
  if (::fstat(protocol::kRequestDescriptor, &status) != 0 || !S_ISREG(status.st_mode))
    throw nearfit::UsageError("nearfit-export", "there is no request",
                              "nearfit starts this program by itself");
  std::vector<std::byte> bytes(static_cast<std::size_t>(status.st_size));
  for (std::size_t done = 0; done < bytes.size();) {
    const ::ssize_t count = ::pread(protocol::kRequestDescriptor, bytes.data() + done, bytes.size() - done,
                                    static_cast<::off_t>(done));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) throw nearfit::Error("", "its request cannot be read", "export again");
    done += static_cast<std::size_t>(count);
  }
  return bytes;
}

/// Exact geometry where there is one, facets elsewhere.
std::vector<exporter::ProductShape> shapesOf(const nearfit::StepRequest& request,
                                             exporter::ExactSources& sources,
                                             importer::MessagePipe& messages) {
  std::vector<exporter::ProductShape> shapes;
  std::size_t facets = 0;
  const auto& all = request.document.shapes;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (std::optional<exporter::ProductShape> exact = sources.take(i)) {
      shapes.push_back(*std::move(exact));
    } else {
      shapes.push_back(exporter::facetedShape(all[i], facets));
    }
    messages.progress(kSourcesRead + (kShapesMade - kSourcesRead) * static_cast<double>(i + 1) /
                                         static_cast<double>(all.size()));
  }
  return shapes;
}

int exportRequest(importer::MessagePipe& messages) {
  const std::vector<std::byte> bytes = readRequestBytes();
  const nearfit::StepRequest request = nearfit::readStepRequest(bytes);
  exporter::ExactSources sources(request);
  importer::limitProcess(bytes.size() + sources.bytes());
  importer::enterSandbox({});
  importer::setUpOcc();
  sources.read([&](double fraction) { messages.progress(kSourcesRead * fraction); });
  std::vector<exporter::ProductShape> shapes = shapesOf(request, sources, messages);
  importer::ResultFile result(
      protocol::kResultDescriptor,
      {"", "the file would be too large, or memory has run out", "export fewer parts"});
  nearfit::writeStepNotes(sources.notes(), [&](std::span<const std::byte> some) { result.add(some); });
  exporter::writeStep(
      request, shapes,
      [&](double fraction) { messages.progress(kShapesMade + (1.0 - kShapesMade) * fraction); },
      [&](std::string_view text) { result.add(std::as_bytes(std::span(text))); });
  result.flush();
  messages.progress(1.0);
  return protocol::kDone;
}

int fail(const importer::MessagePipe& messages, const std::string& where, const std::string& problem,
         const std::string& remedy) {
  messages.failure(where, problem, remedy);
  fmt::print(stderr, "nearfit-export: {}{}{}{}{}\n", where, where.empty() ? "" : ": ", problem,
             remedy.empty() ? "" : "; ", remedy);
  return protocol::kFailed;
}

int run(importer::MessagePipe& messages) {
  constexpr const char* kRemedy = "export fewer parts to find the one that fails, or in another format";
  try {
    return exportRequest(messages);
  } catch (const nearfit::Error& error) {
    return fail(messages, error.where(), error.problem(), error.remedy());
  } catch (const std::bad_alloc&) {
    return protocol::kOutOfMemory;
  } catch (const Standard_OutOfMemory&) {
    return protocol::kOutOfMemory;
  } catch (const Standard_Failure& failure) {
    return fail(messages, "", fmt::format("OpenCASCADE cannot write it: {}", failure.GetMessageString()),
                kRemedy);
  } catch (const std::exception& error) {
    return fail(messages, "", fmt::format("it cannot be written: {}", error.what()), kRemedy);
  }
}

}  // namespace

int main(int argc, char** argv) {
  // A reader who has gone, and a result beyond its limit, are errors to report.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  if (argc == 2 && std::string_view(argv[1]) == "--version") {
    fmt::print("nearfit-export {}\nOpenCASCADE {}\nsandbox: {}\n", NEARFIT_VERSION, importer::occVersion(),
               importer::sandboxText());
    return 0;
  }
  if (argc > 1) {
    fmt::print(
        stderr,
        "nearfit-export: it takes no arguments but --version; nearfit starts this program by itself\n");
    return protocol::kFailed;
  }
  // Started by hand, it has no messages to write: what is open there is not its own.
  struct ::stat status{};
  const bool hasPipe = ::fstat(protocol::kMessageDescriptor, &status) == 0 && S_ISFIFO(status.st_mode);
  importer::MessagePipe messages(hasPipe ? protocol::kMessageDescriptor : -1);
  const int code = run(messages);
  // Libraries have nothing to save, and may take long to free what they hold.
  std::fflush(nullptr);
  ::_exit(code);
}
