#include "core/path/certificate.h"

#include <map>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/files/input_file.h"
#include "core/files/sha256.h"
#include "core/parallel/parallel_for.h"
#include "core/path/path_file.h"
#include "core/scene/mesh_hash.h"
#include "core/text/json_file.h"
#include "core/text/json_text.h"
#include "core/text/utf8.h"

namespace nearfit {
namespace {

using CertificateJson = nlohmann::ordered_json;

/// Version that is written, and oldest that is read.
constexpr int kCertificateVersion = 2, kOldestCertificateVersion = 1;
/// Digits of a SHA-256.
constexpr std::size_t kHashDigits = 64;
/// Text before and after the hash at the end.
constexpr std::string_view kBeforeHash = ",\n  \"sha256\": \"", kAfterHash = "\"\n}\n";
/// Max length of a file's name: longer than any that Linux opens.
constexpr std::size_t kMaxFileNameBytes = 4096;
/// Max numbers of parts and of stretches of all pairs.
constexpr std::size_t kMaxCertifiedParts = 20'000, kMaxStretches = 8'000'000;
/// Room for these and for a path of kMaxPathPoses poses.
constexpr JsonLimits kCertificateLimits{.maxBytes = 1U << 30U, .maxDepth = 8, .maxValues = 60'000'000};
constexpr const char* kMakeAnew = "certify the path again";

CertificateJson partJsonOf(const CertifiedPart& part) {
  const glm::dvec3& t = part.pose.translation;
  const glm::dquat& q = part.pose.rotation;
  CertificateJson json;
  json["name"] = part.name;
  json["moving"] = part.isMoving;
  json["sha256"] = part.meshSha256;
  json["position"] = {t.x, t.y, t.z};
  json["quaternion"] = {q.w, q.x, q.y, q.z};
  return json;
}

CertificateJson pairJsonOf(const CertifiedPair& pair) {
  CertificateJson json;
  json["part"] = pair.part;
  json["other"] = pair.other;
  CertificateJson stretches = CertificateJson::array();
  for (const ProvenStretch& stretch : pair.stretches)
    stretches.push_back({stretch.anchor, stretch.to, stretch.bound});
  json["stretches"] = std::move(stretches);
  return json;
}

std::string hashOfPath(const AssemblyPath& path) {
  return sha256OfBytes(prettyJson(pathJson(path)));
}

std::string hashField(const JsonField& json, bool mayBeEmpty) {
  const std::string text = json.text(kHashDigits);
  const bool isHash = text.size() == kHashDigits && text.find_first_not_of("0123456789abcdef") == text.npos;
  if (!isHash && !(mayBeEmpty && text.empty())) json.fail("it is no SHA-256", kMakeAnew);
  return text;
}

std::size_t indexField(const JsonField& json, std::size_t count) {
  const double number = json.numberWithin(0.0, static_cast<double>(count) - 1.0);
  const auto index = static_cast<std::size_t>(number);
  if (static_cast<double>(index) != number) json.fail("it is no index", kMakeAnew);
  return index;
}

RigidTransform poseField(const JsonField& part) {
  const JsonField t = part.at("position"), q = part.at("quaternion");
  t.requireSize(3);
  q.requireSize(4);
  return {glm::dquat(q.at(0).number(), q.at(1).number(), q.at(2).number(), q.at(3).number()),
          glm::dvec3(t.at(0).number(), t.at(1).number(), t.at(2).number())};
}

/// Absolute, with symbolic links resolved as far as the file is there.
std::filesystem::path resolved(const std::filesystem::path& file) {
  std::error_code failure;
  const std::filesystem::path absolute = std::filesystem::absolute(file, failure);
  const std::filesystem::path real = std::filesystem::weakly_canonical(absolute, failure);
  return failure ? absolute : real;
}

/// Reads the name of a file that has a hash if it is named.
std::string nameField(const JsonField& json, const std::string& sha256) {
  std::string name = json.text(kMaxFileNameBytes);
  if (!name.empty() && sha256.empty()) json.fail("a file is named, and no hash of it", kMakeAnew);
  return name;
}

CertifiedPart partField(const JsonField& json) {
  return {json.at("name").text(kMaxPartNameBytes), json.at("moving").isTrue(),
          hashField(json.at("sha256"), false), poseField(json)};
}

CertifiedPair pairField(const JsonField& json, const Certificate& certificate, std::size_t& room) {
  CertifiedPair pair;
  pair.part = indexField(json.at("part"), certificate.parts.size());
  pair.other = indexField(json.at("other"), certificate.parts.size());
  const JsonField stretches = json.at("stretches");
  const std::size_t count = stretches.size();
  if (count > room) stretches.fail(fmt::format("there are more than {} stretches", kMaxStretches));
  room -= count;
  double from = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const JsonField stretch = stretches.at(i);
    stretch.requireSize(3);
    pair.stretches.push_back({from, stretch.at(0).number(), stretch.at(1).number(), stretch.at(2).number()});
    from = pair.stretches.back().to;
  }
  return pair;
}

/// Throws FileError unless the text ends with the hash of what comes before.
void checkHashAtEnd(std::string_view text, const std::filesystem::path& file) {
  const std::size_t tail = kBeforeHash.size() + kHashDigits + kAfterHash.size();
  const bool hasTail = text.size() > tail && text.ends_with(kAfterHash) &&
                       text.substr(text.size() - tail).starts_with(kBeforeHash);
  if (!hasTail) throw FileError(file.string(), "it does not end as a certificate does", kMakeAnew);
  const std::string_view body = text.substr(0, text.size() - tail);
  const std::string_view hash = text.substr(text.size() - tail + kBeforeHash.size(), kHashDigits);
  if (sha256OfBytes(body) != hash)
    throw FileError(file.string(),
                    "it was changed after it was written: its bytes do not have the hash at its end",
                    kMakeAnew);
}

}  // namespace

std::vector<CertifiedPart> certifiedParts(const PathBodies& bodies) {
  std::vector<CertifiedPart> parts;
  std::vector<const PartGeometry*> geometryOf;
  for (const PathPart& moving : bodies.moving) {
    parts.push_back({moving.part->name, true, {}, moving.leadFromPart});
    geometryOf.push_back(moving.part->geometry.get());
  }
  for (const Scene::PartPtr& other : bodies.others) {
    parts.push_back({other->name, false, {}, other->worldFromPart});
    geometryOf.push_back(other->geometry.get());
  }
  std::map<const PartGeometry*, std::string> hashes;
  for (const PartGeometry* geometry : geometryOf)
    hashes.emplace(geometry, std::string());
  std::vector<std::pair<const PartGeometry* const, std::string>*> entries;
  for (auto& entry : hashes)
    entries.push_back(&entry);
  parallelFor(entries.size(),
              [&](std::size_t i) { entries[i]->second = meshSha256(entries[i]->first->mesh); });
  for (std::size_t i = 0; i < parts.size(); ++i)
    parts[i].meshSha256 = hashes.at(geometryOf[i]);
  return parts;
}

Certificate certificateOf(const Scene& scene, const AssemblyPath& path, const PathProof& proof,
                          std::string sceneSha256) {
  const PathBodies bodies = pathBodies(scene, path);
  Certificate certificate;
  certificate.program = "Nearfit " NEARFIT_VERSION;
  certificate.separation = proof.separation;
  certificate.sceneSha256 = std::move(sceneSha256);
  certificate.path = path;
  certificate.parts = certifiedParts(bodies);
  std::map<PartId, std::size_t> indices;
  for (const PathPart& moving : bodies.moving)
    indices.emplace(moving.part->id, indices.size());
  for (const Scene::PartPtr& other : bodies.others)
    indices.emplace(other->id, indices.size());
  for (const PairProof& pair : proof.pairs)
    certificate.pairs.push_back({indices.at(pair.part), indices.at(pair.other), pair.stretches});
  return certificate;
}

std::string certifiedName(const std::filesystem::path& file, const std::filesystem::path& certificate) {
  const std::filesystem::path whole = resolved(file);
  const std::filesystem::path relative = whole.lexically_relative(resolved(certificate).parent_path());
  std::string name = (relative.empty() ? whole : relative).generic_string();
  return isUtf8(name) && name.size() <= kMaxFileNameBytes ? name : std::string();
}

std::filesystem::path fileOfCertifiedName(const std::string& name, const std::filesystem::path& certificate) {
  return resolved(certificate).parent_path() / name;
}

std::string certificateText(const Certificate& certificate) {
  CertificateJson json;
  json["certificate"] = kCertificateVersion;
  json["program"] = certificate.program;
  json["separation"] = certificate.separation;
  json["scene"] = certificate.sceneSha256;
  json["sceneFile"] = certificate.sceneFile;
  json["path"] = pathJson(certificate.path);
  json["pathSha256"] = hashOfPath(certificate.path);
  json["pathFile"] = certificate.pathFile;
  json["pathFileSha256"] = certificate.pathFileSha256;
  json["parts"] = CertificateJson::array();
  for (const CertifiedPart& part : certificate.parts)
    json["parts"].push_back(partJsonOf(part));
  json["pairs"] = CertificateJson::array();
  for (const CertifiedPair& pair : certificate.pairs)
    json["pairs"].push_back(pairJsonOf(pair));
  std::string text = prettyJson(json);
  // The last line and its break give way to the hash.
  text.resize(text.size() - std::string_view("\n}\n").size());
  const std::string hash = sha256OfBytes(text);
  text += kBeforeHash;
  text += hash;
  text += kAfterHash;
  return text;
}

std::vector<char> readCertificateFile(const std::filesystem::path& file) {
  InputFile input(file);
  if (input.size() > kCertificateLimits.maxBytes) {
    throw FileError(file.string(), fmt::format("it is larger than {} bytes", kCertificateLimits.maxBytes),
                    "check that it is a certificate");
  }
  return input.readAll();
}

Certificate parseCertificate(std::string_view text, const std::filesystem::path& file) {
  checkHashAtEnd(text, file);
  const nlohmann::json json = readJsonText(text, file, kCertificateLimits);
  const JsonField root(json, file);
  const double version = root.at("certificate").number();
  if (version != kCertificateVersion && version != kOldestCertificateVersion)
    root.at("certificate").fail("this version of certificates is not known", "use a newer Nearfit");
  Certificate certificate;
  certificate.program = root.at("program").text(kMaxPartNameBytes);
  certificate.separation = root.at("separation").number();
  if (!(certificate.separation > 0.0)) root.at("separation").fail("it is not above zero", kMakeAnew);
  certificate.sceneSha256 = hashField(root.at("scene"), true);
  certificate.path = pathOfJson(root.at("path"));
  if (hashField(root.at("pathSha256"), false) != hashOfPath(certificate.path))
    root.at("pathSha256").fail("the path does not have this hash", kMakeAnew);
  if (version >= kCertificateVersion) {
    certificate.sceneFile = nameField(root.at("sceneFile"), certificate.sceneSha256);
    certificate.pathFileSha256 = hashField(root.at("pathFileSha256"), true);
    certificate.pathFile = nameField(root.at("pathFile"), certificate.pathFileSha256);
  }
  const JsonField parts = root.at("parts"), pairs = root.at("pairs");
  if (parts.size() > kMaxCertifiedParts)
    parts.fail(fmt::format("it has more than {} elements", kMaxCertifiedParts));
  for (std::size_t i = 0; i < parts.size(); ++i)
    certificate.parts.push_back(partField(parts.at(i)));
  std::size_t room = kMaxStretches;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    certificate.pairs.push_back(pairField(pairs.at(i), certificate, room));
  return certificate;
}

}  // namespace nearfit
