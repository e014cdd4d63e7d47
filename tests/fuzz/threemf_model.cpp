// Models as lib3mf reads them from 3MF files, with any objects, placements and numbers, and components that may contain
// each other: there is a document within the limits, or an Error. lib3mf itself is reached by import_process.
#include "app/import/threemf_model.h"

#include <array>
#include <cstdint>
#include <string>
#include <utility>

#include "tests/fuzz/byte_source.h"
#include "tests/fuzz/document_checks.h"

namespace nearfit::importer {
namespace {

/// The model that stands for the file.
ThreeMfModel& modelOfFile() {
  static ThreeMfModel model;
  return model;
}

}  // namespace

ThreeMfModel loadThreeMf(const ImportJob& /*job*/) {
  return modelOfFile();
}

}  // namespace nearfit::importer

namespace nearfit::fuzz {
namespace {

using importer::ThreeMfModel;
using importer::ThreeMfObject;
using importer::ThreeMfPlacement;

constexpr std::size_t kMaxObjects = 6;

ThreeMfPlacement somePlacement(ByteSource& bytes) {
  ThreeMfPlacement placement;
  // One more than there are: the last is missing.
  placement.object = static_cast<std::uint32_t>(bytes.below(kMaxObjects + 1));
  switch (bytes.below(3)) {
    case 0:
      break;
    case 1:
      placement.translation = bytes.vector();
      break;
    default:
      for (int column = 0; column < 3; ++column)
        placement.map[column] = bytes.vector();
      placement.translation = bytes.vector();
  }
  return placement;
}

ThreeMfObject someObject(ByteSource& bytes) {
  constexpr std::array<const char*, 5> kNames{"", "pin", "H\xC3\xBClse", "\xFF\x01", "pin"};
  ThreeMfObject object;
  object.name = kNames[bytes.below(kNames.size())];
  for (std::size_t i = bytes.below(4); i > 0; --i)
    object.components.push_back(somePlacement(bytes));
  if (bytes.flag()) {
    object.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    object.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  }
  for (std::size_t i = bytes.below(6); i > 0; --i)
    object.vertices.push_back(bytes.vector());
  for (std::size_t i = bytes.below(6); i > 0; --i) {
    Triangle& t = object.triangles.emplace_back();
    for (std::uint32_t& corner : t)
      corner = static_cast<std::uint32_t>(bytes.below(object.vertices.size() + 1));
  }
  constexpr CadColour kRed{1.0F, 0.0F, 0.0F}, kBlue{0.0F, 0.0F, 1.0F};
  if (bytes.flag()) object.colour = kRed;
  for (std::size_t i = bytes.flag() ? object.triangles.size() : 0; i > 0; --i) {
    const std::size_t colour = bytes.below(3);
    object.triangleColours.add(colour == 0 ? std::nullopt : std::optional(colour == 1 ? kRed : kBlue));
  }
  return object;
}

ThreeMfModel someModel(ByteSource& bytes) {
  ThreeMfModel model;
  model.metresPerUnit = importer::threeMfUnit(static_cast<std::uint32_t>(bytes.below(8))).value_or(1e-3);
  for (std::size_t i = 0, count = bytes.below(kMaxObjects + 1); i < count; ++i)
    model.objects[static_cast<std::uint32_t>(i)] = someObject(bytes);
  for (std::size_t i = bytes.below(4); i > 0; --i)
    model.items.push_back(somePlacement(bytes));
  return model;
}

void run(ByteSource& bytes) {
  importer::ImportJob job;
  job.file = "set.3mf";
  job.stem = "set";
  job.sha256 = std::string(64, 'a');
  job.format = importer::DocumentFormat::ThreeMf;
  job.progress = [](double fraction) {
    require(fraction >= 0.0 && fraction <= 1.0, "progress is a fraction");
  };
  job.endStage = [](const char*) {};
  if (bytes.byte() == 0) job.onlyShapes = {"pin"};
  importer::modelOfFile() = someModel(bytes);
  requireReadOrRefused<Error>([&] {
    const CadDocument document = importer::readThreeMf(job);
    // What exceeds a limit is refused where it is written.
    requireReadAsWritten(document);
    requireDocument(document);
    require(!document.shapes.empty() && !document.nodes.empty(), "a document holds something");
  });
}

}  // namespace
}  // namespace nearfit::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  nearfit::fuzz::ByteSource bytes(data, size);
  nearfit::fuzz::run(bytes);
  return 0;
}
