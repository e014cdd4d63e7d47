// A HID report descriptor and reports of the device that sends it: fields lie within what they promise, and a
// space mouse's deflections within their limits.
#include <cstdlib>

#include "device/hid/report_descriptor.h"
#include "device/spacemouse/spacemouse_reader.h"
#include "tests/fuzz/byte_source.h"
#include "tests/fuzz/fuzz_target.h"

namespace nearfit::fuzz {
namespace {

void checkFields(const HidReports& reports) {
  require(reports.fields.size() <= kMaxHidFields, "no more fields than allowed");
  for (const HidField& field : reports.fields) {
    require(field.bitCount >= 1 && field.bitCount <= 32, "a value has 1 to 32 bits");
    require(field.bitOffset + field.bitCount <= 8 * (kMaxReportBytes + 1), "a value lies within a report");
    require(reports.hasNumbers || field.reportId == 0, "no numbers where there are none");
  }
}

void checkState(const SpaceMouseState& state) {
  for (const double axis : state.axes)
    require(std::abs(axis) <= 1.0, "deflections are within -1 to 1");
}

void run(std::span<const std::uint8_t> data) {
  ByteSource source(data.data(), data.size());
  const std::size_t reportSize = source.below(70);
  // One after the other: arguments have no order.
  const std::size_t wanted = source.raw<std::uint16_t>();
  const std::size_t descriptorSize = std::min(wanted, source.rest().size());
  const std::span<const std::byte> rest = std::as_bytes(source.rest());
  const std::span<const std::byte> descriptor = rest.first(descriptorSize);
  std::span<const std::byte> sent = rest.subspan(descriptorSize);
  if (const std::optional<HidReports> reports = parseReportDescriptor(descriptor)) {
    checkFields(*reports);
    for (const HidField& field : reports->fields)
      readField(sent.first(std::min(reportSize, sent.size())), field, reports->hasNumbers);
  }
  const std::optional<SpaceMouseReader> described = SpaceMouseReader::fromDescriptor(descriptor);
  const SpaceMouseReader known = SpaceMouseReader::withKnownLayout();
  SpaceMouseState byDescriptor, byLayout;
  while (!sent.empty()) {
    const std::span<const std::byte> report = sent.first(std::clamp<std::size_t>(reportSize, 1, sent.size()));
    sent = sent.subspan(report.size());
    if (described) described->read(report, byDescriptor);
    known.read(report, byLayout);
    checkState(byDescriptor);
    checkState(byLayout);
  }
  if (described) {
    if (const auto light = described->ledReport(true))
      require(light->size >= 1 && light->size <= light->bytes.size(), "the light's report has its bytes");
  }
}

}  // namespace
}  // namespace nearfit::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  nearfit::fuzz::run({data, size});
  return 0;
}
