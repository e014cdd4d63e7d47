// The importer's own look at STEP files before OpenCASCADE reads them: any text; and assemblies, which are refused if and
// only if one contains itself or stands for too many instances, by another count. Texts in STEP's encoding of
// characters too.
#include "app/import/step_scan.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "app/import/step_text.h"
#include "core/base/error.h"
#include "core/import/document_file.h"
#include "core/text/utf8.h"
#include "tests/fuzz/byte_source.h"
#include "tests/fuzz/fuzz_target.h"

namespace nearfit::fuzz {
namespace {

/// The problem of a file that is refused; none for one that is not.
std::optional<std::string> problemOf(const std::string& text) {
  try {
    importer::scanStep(text, "a file");
    return std::nullopt;
  } catch (const FileError& error) {
    require(!error.problem().empty() && !error.remedy().empty(),
            "an error says what is wrong and what to do");
    require(error.where().starts_with("a file"), "an error names the file");
    return error.problem();
  }
}

void checkText(const std::string& text) {
  const std::string decoded = importer::decodedStepText(text);
  require(decoded.size() <= text.size(), "what is decoded is no longer than its code");
  require(!isUtf8(text) || isUtf8(decoded), "UTF-8 is decoded to UTF-8");
}

void checkAnyText(ByteSource& bytes) {
  const std::span<const std::uint8_t> rest = bytes.rest();
  const std::string text(rest.begin(), rest.end());
  require(problemOf(text) == problemOf(text), "the same file is judged the same");
  checkText(text);
}

constexpr std::size_t kMaxProducts = 16, kMaxPlacements = 48;

struct Placement {
  std::size_t parent, child;
};

/// Instances below each product; none if one contains itself.
std::optional<std::array<double, kMaxProducts>> instancesBelow(const std::vector<Placement>& placements) {
  std::array<double, kMaxProducts> below{};
  std::array<std::size_t, kMaxProducts> open{};
  for (const Placement& placement : placements)
    ++open[placement.parent];
  // From those without children upwards.
  std::vector<std::size_t> done;
  for (std::size_t i = 0; i < kMaxProducts; ++i)
    if (open[i] == 0) done.push_back(i);
  for (std::size_t at = 0; at < done.size(); ++at) {
    for (const Placement& placement : placements) {
      if (placement.child != done[at]) continue;
      below[placement.parent] += 1.0 + below[done[at]];
      if (--open[placement.parent] == 0) done.push_back(placement.parent);
    }
  }
  return done.size() == kMaxProducts ? std::optional(below) : std::nullopt;
}

/// By relations between products, as most files have them.
std::string occurrences(const std::vector<Placement>& placements) {
  std::string text;
  for (std::size_t i = 0; i < placements.size(); ++i)
    text += fmt::format("#{}=NEXT_ASSEMBLY_USAGE_OCCURRENCE('{}','it''s',$,#{},#{},$);\n", 3000 + i, i,
                        1000 + placements[i].parent, 1000 + placements[i].child);
  return text;
}

/// By items that map other representations.
std::string mappedItems(const std::vector<Placement>& placements) {
  std::string text;
  for (std::size_t product = 0; product < kMaxProducts; ++product) {
    std::string items = "#9";
    for (std::size_t i = 0; i < placements.size(); ++i)
      if (placements[i].parent == product) items += fmt::format(",#{}", 3000 + i);
    text += fmt::format("#{0}=SHAPE_REPRESENTATION('',({1}),#8);\n#{2}=REPRESENTATION_MAP(#9,#{0});\n",
                        1000 + product, items, 2000 + product);
  }
  for (std::size_t i = 0; i < placements.size(); ++i)
    text += fmt::format("#{}=MAPPED_ITEM('',#{},#9);\n", 3000 + i, 2000 + placements[i].child);
  return text;
}

void checkAssembly(ByteSource& bytes) {
  const bool isMapped = bytes.flag();
  std::vector<Placement> placements(bytes.below(kMaxPlacements + 1));
  for (Placement& placement : placements) {
    placement.parent = bytes.below(kMaxProducts);
    placement.child = bytes.below(kMaxProducts);
  }
  const auto instances = instancesBelow(placements);
  const bool isTooMuch = !instances || std::ranges::max(*instances) > static_cast<double>(kMaxDocumentNodes);
  const std::optional<std::string> problem = problemOf(
      "ISO-10303-21;\nDATA;\n#8=X();\n#9=Y((1.,2.));\n" +
      (isMapped ? mappedItems(placements) : occurrences(placements)) + "ENDSEC;\nEND-ISO-10303-21;\n");
  require(problem.has_value() == isTooMuch,
          "an assembly is refused if it contains itself or is too large, and only then");
  if (problem)
    require(problem->find(instances ? "instances" : "contains itself") != problem->npos,
            "the error says which");
}

/// A character in one of the ways in which STEP has it, and in UTF-8.
void appendCharacter(ByteSource& bytes, std::string& encoded, std::string& plain) {
  const std::uint32_t code = 1 + bytes.raw<std::uint32_t>() % 0x10FFFF;
  if (code >= 0xD800 && code <= 0xDFFF) return;
  switch (bytes.below(4)) {
    case 0:
      encoded += fmt::format("\\X4\\{:08X}\\X0\\", code);
      break;
    case 1:
      if (code < 0x10000)
        encoded += fmt::format("\\X2\\{:04X}\\X0\\", code);
      else
        encoded += fmt::format("\\X2\\{:04X}{:04X}\\X0\\", 0xD800 + ((code - 0x10000) >> 10),
                               0xDC00 + ((code - 0x10000) & 0x3FF));
      break;
    case 2:
      if (code > 0xFF) return;
      encoded += fmt::format("\\X\\{:02X}", code);
      break;
    default:
      if (code < 0xA0 || code > 0xFF) return;
      encoded += fmt::format("\\S\\{}", static_cast<char>(code - 0x80));
  }
  const auto add = [&plain](std::uint32_t byte) { plain += static_cast<char>(byte); };
  if (code >= 0x10000) add(0xF0 + code / 0x40000);
  if (code >= 0x800) add(code >= 0x10000 ? 0x80 + code / 0x1000 % 0x40 : 0xE0 + code / 0x1000);
  if (code >= 0x80) add(code >= 0x800 ? 0x80 + code / 0x40 % 0x40 : 0xC0 + code / 0x40);
  add(code >= 0x80 ? 0x80 + code % 0x40 : code);
}

void checkCharacters(ByteSource& bytes) {
  std::string encoded, plain;
  while (!bytes.isEmpty())
    appendCharacter(bytes, encoded, plain);
  require(importer::decodedStepText(encoded) == plain, "characters are decoded to what they stand for");
}

void run(ByteSource& bytes) {
  switch (bytes.below(3)) {
    case 0:
      return checkAnyText(bytes);
    case 1:
      return checkAssembly(bytes);
    default:
      return checkCharacters(bytes);
  }
}

}  // namespace
}  // namespace nearfit::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  nearfit::fuzz::ByteSource bytes(data, size);
  nearfit::fuzz::run(bytes);
  return 0;
}
