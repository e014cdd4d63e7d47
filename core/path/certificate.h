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
///       "certificate": 1,                         format version
///       "program": "Nearfit 0.1.0",               that proved it
///       "separation": 1e-06,                      kept everywhere on the path [m]
///       "scene": "9f86d0...",                     SHA-256 of the scene file; empty if it was not saved
///       "path": {"parts": ["Peg"], "centre": [0, 0, 0.05], "poses": [[...]]},   as in a path file (path_file.h)
///       "pathSha256": "9f86d0...",                of the text of "path"
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
  AssemblyPath path;
  std::vector<CertifiedPart> parts;
  std::vector<CertifiedPair> pairs;
};

/// SHA-256 of a mesh's geometry: coordinates of its vertices and indices of its triangles, as bits.
std::string meshSha256(const TriangleMesh& mesh);

/// The parts that a certificate of these bodies is about, in its order. Hashes each geometry once, in parallel.
std::vector<CertifiedPart> certifiedParts(const PathBodies& bodies);

/// A certificate of a proof that is free.
/// @param sceneSha256  Of the scene file; empty if there is none.
Certificate certificateOf(const Scene& scene, const AssemblyPath& path, const PathProof& proof,
                          std::string sceneSha256);

/// Text of the file; always the same for the same certificate.
std::string certificateText(const Certificate& certificate);

/// Reads the text of a certificate and trusts nothing in it: a byte that differs from what was written is refused by
/// the hash at its end; numbers are finite, indices valid, the path passes checkPath().
/// @param file  For messages.
/// Throws FileError.
Certificate parseCertificate(std::string_view text, const std::filesystem::path& file);

}  // namespace nearfit
