#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/path/assembly_path.h"
#include "core/path/path_bodies.h"
#include "core/path/path_certifier.h"

// clang-format off
/// The certificate file `*.nfcert` of a path, JSON in UTF-8:
///
///     {
///       "certificate": 2,                         format version
///       "program": "Nearfit 0.1.0",               that proved it
///       "separation": 1e-06,                      kept everywhere on the path [m]
///       "scene": "9f86d0...",                     SHA-256 of the scene file; empty if it was not saved
///       "sceneFile": "fit.nearfit",               its name; empty if it is not known
///       "path": {"parts": ["Peg"], "centre": [0, 0, 0.05], "poses": [[...]]},   as in a path file (path_file.h)
///       "pathSha256": "9f86d0...",                of the text of "path"
///       "pathFile": "in.nfpath",                  name of the path file; empty if it is not known
///       "pathFileSha256": "9f86d0...",            of its bytes; empty if no file holds the path
///       "parts": [{                               the moving parts, then all others that it may not meet
///         "name": "Peg",
///         "moving": true,
///         "sha256": "9f86d0...",                  of its mesh: meshSha256()
///         "position": [0, 0, 0],                  a moving part's place in the frame of the one that leads, another
///         "quaternion": [1, 0, 0, 0]              part's in the world
///       }],
///       "pairs": [{                               each moving part with each other, in the order of "parts"
///         "part": 0, "other": 1,                  indices in "parts"
///         "stretches": [[0.5, 1, 0.002]]          anchor, end, bound; the first begins at place 0, each later one where
///                                                 the one before ends (ProvenStretch)
///       }],
///       "sha256": "9f86d0..."                     of all bytes before this member
///     }
///
/// Names of files begin at the certificate's folder, with `/` between names, or are absolute where they cannot. They only
/// say where to look: a file counts if it has the hash beside its name. Version 1, which has no such names, can still be read.
///
/// The last hash tells damage, not who wrote the file: what a certificate claims counts once it is proven anew
/// (path_verifier.h).
// clang-format on
namespace nearfit {

/// A part that a certificate is about.
struct CertifiedPart {
  std::string name;
  bool isMoving = false;
  std::string meshSha256;
  RigidTransform pose;  ///< leadFromPart of a moving part, worldFromPart of another.
};

/// Stretches of a path on which a moving part was proven free of another.
struct CertifiedPair {
  std::size_t part = 0, other = 0;  ///< Indices in Certificate::parts.
  std::vector<ProvenStretch> stretches;
};

/// A proof that a path keeps a separation, with all that it depends on.
struct Certificate {
  std::string program;
  double separation = 0.0;  ///< [m]
  std::string sceneSha256;  ///< SHA-256 of the scene file; empty if there was none.
  std::string sceneFile;    ///< As certifiedName() gives it; empty if not known.
  AssemblyPath path;
  std::string pathFile;        ///< The same of the path file.
  std::string pathFileSha256;  ///< SHA-256 of the path file; empty if none holds the path.
  std::vector<CertifiedPart> parts;
  std::vector<CertifiedPair> pairs;
};

/// The parts that a certificate of these bodies is about, in its order. Hashes each geometry once, in parallel.
std::vector<CertifiedPart> certifiedParts(const PathBodies& bodies);

/// A certificate of a proof that is free, without names of files.
/// @param sceneSha256  Of the scene file; empty if there is none.
Certificate certificateOf(const Scene& scene, const AssemblyPath& path, const PathProof& proof,
                          std::string sceneSha256);

/// Name of a file for a certificate that is written to `certificate`: from that folder on, or absolute. Empty if it is not
/// UTF-8, or too long to be read again.
std::string certifiedName(const std::filesystem::path& file, const std::filesystem::path& certificate);
/// The file that a name in a certificate means, which need not be there. Not to be trusted: check its hash.
std::filesystem::path fileOfCertifiedName(const std::string& name, const std::filesystem::path& certificate);

/// Text of the file; always the same for the same certificate.
std::string certificateText(const Certificate& certificate);

/// Bytes of a file with a certificate. Throws FileError, also if it is larger than one can be.
std::vector<char> readCertificateFile(const std::filesystem::path& file);

/// Reads the text of a certificate and trusts nothing in it: a byte that differs from what was written is refused by
/// the hash at its end; numbers are finite, indices valid, the path passes checkPath().
/// @param file  For messages.
/// Throws FileError.
Certificate parseCertificate(std::string_view text, const std::filesystem::path& file);

}  // namespace nearfit
