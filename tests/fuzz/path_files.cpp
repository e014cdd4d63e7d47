// Path files, and certificates of paths whose hash at the end is right: what is read can be followed and is written as it
// was read, or there is a FileError.
#include <cmath>
#include <string>

#include "core/base/error.h"
#include "core/files/sha256.h"
#include "core/path/certificate.h"
#include "core/path/path_file.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::fuzz {
namespace {

void requireFollowable(const AssemblyPath& path) {
  require(!path.parts.empty() && path.poses.size() >= 2, "a path has parts and poses");
  for (const PathPose& pose : path.poses)
    require(std::isfinite(pose.time) && isPose(pose.worldFromLead),
            "poses are finite, their quaternions unit");
  for (const double share : {0.0, 0.3, 1.0})
    require(isPose(poseAt(path, share * path.end())), "between poses there are poses");
}

void readPath(const std::filesystem::path& file) {
  const AssemblyPath path = readPathFile(file);
  requireFollowable(path);
  writePathFile(path, file);
  require(isSamePath(readPathFile(file), path), "what is read is written the same");
}

void readCertificate(const std::string& body) {
  const std::string sealed = body + ",\n  \"sha256\": \"" + sha256OfBytes(body) + "\"\n}\n";
  const Certificate certificate = parseCertificate(sealed, "a.nfcert");
  requireFollowable(certificate.path);
  require(std::isfinite(certificate.separation) && certificate.separation > 0.0,
          "the separation is a length");
  for (const CertifiedPair& pair : certificate.pairs) {
    require(pair.part < certificate.parts.size() && pair.other < certificate.parts.size(),
            "indices are valid");
    for (const ProvenStretch& s : pair.stretches)
      require(
          std::isfinite(s.from) && std::isfinite(s.anchor) && std::isfinite(s.to) && std::isfinite(s.bound),
          "stretches are finite");
  }
  const std::string text = certificateText(certificate);
  require(certificateText(parseCertificate(text, "a.nfcert")) == text, "what is read is written the same");
}

void run(std::string_view text) {
  static const test::TemporaryFolder folder;
  requireReadOrRefused<FileError>([&] { readPath(folder.write("a.nfpath", text)); });
  requireReadOrRefused<FileError>([&] { readCertificate(std::string(text)); });
}

}  // namespace
}  // namespace nearfit::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  nearfit::fuzz::run({reinterpret_cast<const char*>(data), size});
  return 0;
}
