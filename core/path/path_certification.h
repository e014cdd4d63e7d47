#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "core/base/progress.h"
#include "core/path/path_certifier.h"

namespace nearfit {

/// Files of a certification.
struct CertificationFiles {
  std::filesystem::path path;         ///< Path file (*.nfpath).
  std::filesystem::path scene;        ///< Scene file (*.nearfit).
  std::filesystem::path certificate;  ///< To be written (*.nfcert).
};

/// Result of a certification.
struct PathCertification {
  double separation = 0.0;  ///< [m]
  std::size_t poses = 0;    ///< Number of poses of the path.
  std::size_t pairs =
      0;  ///< Number of pairs of parts that were proven apart; 0 if the path is not proven free.
  std::size_t stretches = 0;              ///< Number of stretches that prove it; 0 if it is not proven free.
  std::optional<UnprovenPlace> unproven;  ///< The first such place; no value if the path is proven free.
  std::string part, other;                ///< Names of its parts.

  bool isFree() const noexcept { return !unproven.has_value(); }
};

/// Certifies a path in a scene (path_certifier.h) and writes the certificate, which names the two files, atomically; writes
/// nothing if the path is not proven free.
/// @param separation  [m]; std::nullopt: defaultSeparation().
/// Throws FileError, UsageError (also if the certificate would replace a file that is read), Cancelled.
PathCertification certifyPathFile(const CertificationFiles& files, std::optional<double> separation,
                                  const ProgressCallback& progress = {});

/// Files of a verification.
struct VerificationFiles {
  std::filesystem::path certificate;
  /// Empty: the one that the certificate names.
  std::filesystem::path scene, path;
  bool isWithoutPath = false;  ///< Check no path file that is only named in the certificate.
};

/// Result of a verification.
struct PathVerification {
  std::string problem;      ///< Why it is refused, in words; empty if everything is proven.
  double separation = 0.0;  ///< [m]
  std::size_t poses = 0, stretches = 0;
  bool hasSceneHash = false;   ///< The certificate has a hash of the scene file, not of meshes only.
  bool isPathChecked = false;  ///< A path file was compared.

  bool isProven() const noexcept { return problem.empty(); }
};

/// Proves a certificate anew (path_verifier.h) and checks that the files are those that it is about. What is wrong with the
/// content of certificate or path is a reason to refuse. Throws FileError if a file cannot be read, UsageError if no scene is
/// known, Cancelled.
PathVerification verifyCertificateFile(const VerificationFiles& files, const ProgressCallback& progress = {});

}  // namespace nearfit
