#include "core/import/step_request.h"

#include <array>

#include "core/base/error.h"
#include "core/import/document_bytes.h"
#include "core/text/utf8.h"

namespace nearfit {
namespace {

constexpr std::array<char, 8> kRequestMagic{'N', 'F', 'S', 'T', 'E', 'P', 'R', 'Q'};
/// To be raised with each change of the format: exporter and program may come from different builds.
constexpr std::uint32_t kRequestVersion = 1;
/// Reads differently on a machine of the other byte order.
constexpr std::uint32_t kRequestByteOrder = 0x01020304;
/// Limits of a unit as those of a part's, which core/scene has [m].
constexpr double kMinStepUnit = 1e-9, kMaxStepUnit = 1e4;

void requireIn(bool isSo, const char* where, const char* problem) {
  if (!isSo) throw Error(where, problem, "export again");
}

void checkStepSource(const StepSource& source) {
  const std::string file = source.file.string();
  requireIn(!file.empty() && file.size() <= kMaxStepPathBytes && file.find('\0') == file.npos, "source",
            "its path is empty or too long");
  requireIn(source.sha256.size() == 64, "source", "its checksum is no SHA-256");
  requireIn(!source.key.empty() && source.key.size() <= kMaxDocumentKeyBytes && isPrintableUtf8(source.key),
            "source", "its key is empty, too long or no printable text");
  requireIn(source.metresPerUnit >= kMinStepUnit && source.metresPerUnit <= kMaxStepUnit, "source",
            "its unit is out of range");
}

void checkStepRequest(const StepRequest& request) {
  requireIn(
      !request.name.empty() && request.name.size() <= kMaxStepNameBytes && isPrintableUtf8(request.name),
      "name", "it is empty, too long or no printable text");
  requireIn(request.sources.size() == request.document.shapes.size(), "sources",
            "there is not one for each shape");
  for (const std::optional<StepSource>& source : request.sources)
    if (source) checkStepSource(*source);
  checkDocument(request.document);
}

/// Least bytes of a source: its flag, texts and unit.
constexpr std::size_t kSourceBytes = 1;

}  // namespace

void writeStepRequest(const StepRequest& request, const DocumentSink& sink) {
  checkStepRequest(request);
  DocumentWriter out(sink);
  for (const char c : kRequestMagic)
    out.value(c);
  out.value(kRequestByteOrder);
  out.value(kRequestVersion);
  out.value(request.schema);
  out.text(request.name);
  out.value(std::uint64_t{request.sources.size()});
  for (const std::optional<StepSource>& source : request.sources) {
    out.value(static_cast<std::uint8_t>(source.has_value()));
    if (!source) continue;
    out.text(source->file.string());
    out.text(source->sha256);
    out.text(source->key);
    out.value(source->metresPerUnit);
  }
  writeDocument(request.document, sink);
}

StepRequest readStepRequest(std::span<const std::byte> bytes) {
  DocumentReader in(bytes);
  for (const char c : kRequestMagic)
    if (in.value<char>() != c) in.fail("it is no such request");
  if (in.value<std::uint32_t>() != kRequestByteOrder) in.fail("it is of another machine");
  if (in.value<std::uint32_t>() != kRequestVersion) in.fail("it is of another version of the program");
  StepRequest request;
  const auto schema = in.value<std::uint8_t>();
  if (schema > static_cast<std::uint8_t>(StepSchema::Ap242)) in.fail("there is no such schema");
  request.schema = static_cast<StepSchema>(schema);
  request.name = in.text();
  request.sources.resize(in.count(kSourceBytes));
  for (std::optional<StepSource>& source : request.sources) {
    if (!in.flag()) continue;
    source.emplace();
    source->file = in.text();
    source->sha256 = in.text();
    source->key = in.text();
    source->metresPerUnit = in.value<double>();
  }
  request.document = readDocument(in.rest(), "request");
  checkStepRequest(request);
  return request;
}

void writeStepNotes(const std::vector<std::string>& notes, const DocumentSink& sink) {
  DocumentWriter(sink).texts(notes);
}

StepResult readStepResult(std::span<const std::byte> bytes) {
  DocumentReader in(bytes);
  StepResult result;
  result.notes = in.texts();
  requireIn(result.notes.size() <= kMaxWarnings, "notes", "there are too many");
  for (std::string& note : result.notes)
    note = truncatedUtf8(printableText(note), kMaxWarningBytes);
  result.file = in.rest();
  requireIn(!result.file.empty(), "file", "it is empty");
  return result;
}

}  // namespace nearfit
