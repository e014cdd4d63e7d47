#include "core/path/path_certification.h"

#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "core/files/input_file.h"
#include "core/files/sha256.h"
#include "core/path/certificate.h"
#include "core/path/path_file.h"
#include "core/path/path_verifier.h"
#include "core/scene/part_files.h"
#include "core/scene/scene_file.h"

namespace nearfit {
namespace {

/// Progress once the certifier has its hierarchies.
constexpr double kCertifierMade = 0.3;

/// Throws UsageError if the certificate would replace an input.
void checkCertificateTarget(const CertificationFiles& files, const Scene& scene) {
  std::vector<std::filesystem::path> inputs = partFiles(scene);
  inputs.insert(inputs.end(), {files.path, files.scene});
  checkTarget(files.certificate, inputs);
}

/// Says why a certificate is refused.
class CertificateRefused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Calls `read`. What is wrong with a file's content is a reason to refuse.
template <class Read>
auto orRefuse(const Read& read) -> decltype(read()) {
  try {
    return read();
  } catch (const FileError& e) {
    throw CertificateRefused(e.what());
  }
}

/// The file that the certificate names. Throws FileError, with what to give instead, unless an ordinary file is there.
std::filesystem::path namedInput(const VerificationFiles& files, const std::string& name,
                                 const char* instead) {
  const std::filesystem::path file = fileOfCertifiedName(name, files.certificate);
  try {
    static_cast<void>(InputFile(file));
  } catch (const FileError& e) {
    throw FileError(e.where(), "the certificate names this file, and " + e.problem(), instead);
  }
  return file;
}

/// The scene to prove the certificate in. Throws UsageError if neither names one.
std::filesystem::path sceneToVerify(const VerificationFiles& files, const Certificate& certificate) {
  if (!files.scene.empty()) return files.scene;
  if (!certificate.sceneFile.empty())
    return namedInput(files, certificate.sceneFile, "say where the scene is: nearfit-cli verify CERT SCENE");
  throw UsageError(files.certificate.string(),
                   certificate.sceneSha256.empty()
                       ? "it holds no hash of a scene file: the scene was not saved when it was made"
                       : "it does not name its scene file",
                   "give the scene: nearfit-cli verify CERT SCENE");
}

/// Hash of the scene file. Throws CertificateRefused if it is not the certified one.
std::string checkedSceneHash(const std::filesystem::path& scene, const Certificate& certificate) {
  const bool isTooLarge = InputFile(scene).size() > kMaxSceneFileBytes;
  std::string sha256 = isTooLarge ? std::string() : sha256OfFile(scene);
  if (isTooLarge || (!certificate.sceneSha256.empty() && certificate.sceneSha256 != sha256))
    throw CertificateRefused("the scene file is not the one that was certified: its bytes differ");
  return sha256;
}

/// The path of the path file, or std::nullopt if none is to be checked. Throws CertificateRefused if it is not the
/// certified one.
std::optional<AssemblyPath> pathToVerify(const VerificationFiles& files, const Certificate& certificate) {
  std::filesystem::path file = files.path;
  if (file.empty()) {
    if (files.isWithoutPath || certificate.pathFile.empty()) return std::nullopt;
    file =
        namedInput(files, certificate.pathFile,
                   "say where the path is: nearfit-cli verify CERT SCENE PATH; or leave it out: --no-path");
  }
  // A file that is not there is a failure, not a verdict.
  static_cast<void>(InputFile(file));
  AssemblyPath path = orRefuse([&] { return readPathFile(file); });
  if (!certificate.pathFileSha256.empty() && sha256OfFile(file) != certificate.pathFileSha256)
    throw CertificateRefused("the path file is not the one that was certified: its bytes differ");
  return path;
}

PathVerification verified(const VerificationFiles& files, const ProgressCallback& progress) {
  const std::vector<char> text = readCertificateFile(files.certificate);
  const Certificate certificate =
      orRefuse([&] { return parseCertificate({text.data(), text.size()}, files.certificate); });
  const std::filesystem::path sceneFile = sceneToVerify(files, certificate);
  const std::optional<AssemblyPath> path = pathToVerify(files, certificate);
  const std::string sceneSha256 = checkedSceneHash(sceneFile, certificate);
  std::vector<std::filesystem::path> changed;
  const Scene scene = readSceneFile(sceneFile, {}, &changed);
  if (!changed.empty())
    throw CertificateRefused("the mesh file " + changed.front().string() + " was changed");
  const Verification proof = verifyCertificate(certificate, scene, sceneSha256, path, progress);
  return {.problem = proof.problem,
          .separation = certificate.separation,
          .poses = certificate.path.poses.size(),
          .stretches = proof.stretches,
          .hasSceneHash = !certificate.sceneSha256.empty(),
          .isPathChecked = path.has_value()};
}

}  // namespace

PathCertification certifyPathFile(const CertificationFiles& files, std::optional<double> separation,
                                  const ProgressCallback& progress) {
  if (!isJsonFile(files.path)) {
    throw FileError(files.path.string(), "it is not a path file",
                    "make one of a recording (nearfit-cli path RECORDING SCENE -o OUT.nfpath)");
  }
  const std::string pathFileSha256 = sha256OfFile(files.path);
  const AssemblyPath path = readPathFile(files.path);
  const std::string sceneSha256 = sha256OfFile(files.scene);
  const Scene scene = readSceneFile(files.scene);
  checkCertificateTarget(files, scene);
  PathCertification result;
  result.separation = separation ? *separation : defaultSeparation(scene, path);
  result.poses = path.poses.size();
  const PathCertifier certifier(scene, path, result.separation, stageCallback(progress, 0.0, kCertifierMade));
  const PathProof proof = certifier.prove(path, stageCallback(progress, kCertifierMade, 1.0));
  if (!proof.isFree()) {
    result.unproven = proof.unproven;
    result.part = scene.get(proof.unproven->part).name;
    result.other = scene.get(proof.unproven->other).name;
    return result;
  }
  Certificate certificate = certificateOf(scene, path, proof, sceneSha256);
  certificate.sceneFile = certifiedName(files.scene, files.certificate);
  certificate.pathFile = certifiedName(files.path, files.certificate);
  certificate.pathFileSha256 = pathFileSha256;
  atomicWrite(files.certificate, certificateText(certificate));
  result.pairs = proof.pairs.size();
  for (const PairProof& pair : proof.pairs)
    result.stretches += pair.stretches.size();
  return result;
}

PathVerification verifyCertificateFile(const VerificationFiles& files, const ProgressCallback& progress) {
  try {
    return verified(files, progress);
  } catch (const CertificateRefused& refusal) {
    PathVerification refused;
    refused.problem = refusal.what();
    return refused;
  }
}

}  // namespace nearfit
