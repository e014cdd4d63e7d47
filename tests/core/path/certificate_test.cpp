#include "core/path/certificate.h"

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/files/sha256.h"
#include "core/scene/mesh_hash.h"
#include "tests/support/path_scenes.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::certificate_test {
namespace {

using testing::HasSubstr;

Certificate certified(const test::PathScene& made, double separation) {
  const PathProof proof = PathCertifier(made.scene, made.path, separation).prove(made.path);
  EXPECT_TRUE(proof.isFree());
  Certificate certificate = certificateOf(made.scene, made.path, proof, std::string(64, 'a'));
  certificate.sceneFile = "../fit.nearfit";
  certificate.pathFile = "in.nfpath";
  certificate.pathFileSha256 = std::string(64, 'b');
  return certificate;
}

std::string refusal(const std::string& text) {
  try {
    parseCertificate(text, "a.nfcert");
  } catch (const FileError& e) {
    return e.what();
  }
  return "no error";
}

/// A text with another hash at its end, as one who changes a certificate and knows how it is made would write it.
std::string sealed(std::string text) {
  constexpr std::size_t kTail = 64 + 4;
  const std::size_t hash = text.size() - kTail;
  const std::size_t body = text.rfind(",\n  \"sha256\"");
  return text.replace(hash, 64, sha256OfBytes({text.data(), body}));
}

/// The same certificate as version 1 has it, which names no files.
std::string asVersionOne(const std::string& text) {
  std::istringstream lines(text);
  std::string old;
  for (std::string line; std::getline(lines, line);) {
    const bool isNew = line.starts_with("  \"sceneFile\"") || line.starts_with("  \"pathFile");
    if (!isNew) old += line + "\n";
  }
  const std::string version = "\"certificate\": 2";
  const std::size_t at = old.find(version);
  EXPECT_NE(at, std::string::npos);
  return sealed(old.replace(at, version.size(), "\"certificate\": 1"));
}

TEST(Certificate, ReadsBackTheSame) {
  const test::PathScene made = test::cubePastCube(0.01);
  const Certificate written = certified(made, 0.009);
  const std::string text = certificateText(written);
  const Certificate read = parseCertificate(text, "a.nfcert");
  EXPECT_EQ(certificateText(read), text);
  EXPECT_TRUE(isSamePath(read.path, made.path));
  EXPECT_EQ(read.separation, 0.009);
  EXPECT_EQ(read.sceneSha256, std::string(64, 'a'));
  EXPECT_EQ(read.sceneFile, "../fit.nearfit");
  EXPECT_EQ(read.pathFile, "in.nfpath");
  EXPECT_EQ(read.pathFileSha256, std::string(64, 'b'));
  ASSERT_EQ(read.parts.size(), 2U);
  EXPECT_EQ(read.parts[0].name, "Cube");
  EXPECT_TRUE(read.parts[0].isMoving);
  EXPECT_EQ(read.parts[1].name, "Post");
  EXPECT_FALSE(read.parts[1].isMoving);
  ASSERT_EQ(read.pairs.size(), 1U);
  ASSERT_EQ(read.pairs[0].stretches.size(), written.pairs[0].stretches.size());
  EXPECT_EQ(read.pairs[0].stretches.back().to, 1.0);
}

TEST(Certificate, IsRefusedWhicheverByteChanges) {
  const std::string written = certificateText(certified(test::cubePastCube(0.1), 0.05));
  ASSERT_THAT(written, HasSubstr("\"sceneFile\": \"../fit.nearfit\""));
  for (const std::string& text : {written, asVersionOne(written)}) {
    for (std::size_t i = 0; i < text.size(); ++i) {
      std::string changed = text;
      changed[i] = static_cast<char>(changed[i] ^ 1);
      ASSERT_NE(refusal(changed), "no error") << "byte " << i;
    }
    EXPECT_NE(refusal(text + "\n"), "no error");
    EXPECT_NE(refusal(text.substr(0, text.size() - 1)), "no error");
    EXPECT_EQ(refusal(text), "no error");
  }
  EXPECT_NE(refusal(""), "no error");
}

TEST(Certificate, AFileLargerThanOneCanBeIsNotReadIntoMemory) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.write("a.nfcert", "{");
  std::filesystem::resize_file(file, std::uintmax_t{1} << 42U);
  EXPECT_THAT([&] { static_cast<void>(readCertificateFile(file)); },
              testing::ThrowsMessage<FileError>(testing::HasSubstr("larger than")));
}

TEST(Certificate, OneOfVersionOneIsReadAndNamesNoFiles) {
  const Certificate written = certified(test::cubePastCube(0.1), 0.05);
  const Certificate read = parseCertificate(asVersionOne(certificateText(written)), "a.nfcert");
  EXPECT_EQ(read.sceneSha256, written.sceneSha256);
  EXPECT_TRUE(isSamePath(read.path, written.path));
  EXPECT_EQ(read.pairs.size(), written.pairs.size());
  EXPECT_EQ(read.sceneFile, "");
  EXPECT_EQ(read.pathFile, "");
  EXPECT_EQ(read.pathFileSha256, "");
}

TEST(Certificate, NamesOfFilesBeginAtItsFolder) {
  const test::TemporaryFolder folder;
  const std::filesystem::path inner = folder.path() / "proofs";
  std::filesystem::create_directory(inner);
  const std::filesystem::path certificate = inner / "in.nfcert", scene = folder.write("fit.nearfit", "{}");
  EXPECT_EQ(certifiedName(scene, certificate), "../fit.nearfit");
  EXPECT_EQ(certifiedName(inner / "in.nfpath", certificate), "in.nfpath");
  EXPECT_EQ(certifiedName(inner / ".." / "fit.nearfit", certificate), "../fit.nearfit");
  EXPECT_EQ(certifiedName(folder.path() / "\xff.nearfit", certificate), "") << "it is not UTF-8";
  EXPECT_TRUE(std::filesystem::equivalent(fileOfCertifiedName("../fit.nearfit", certificate), scene));
  EXPECT_EQ(fileOfCertifiedName("/none/fit.nearfit", certificate), "/none/fit.nearfit");
  // As by a link to the folder.
  std::filesystem::create_directory_symlink(inner, folder.path() / "link");
  EXPECT_EQ(certifiedName(scene, folder.path() / "link" / "in.nfcert"), "../fit.nearfit");
}

TEST(Certificate, NothingInItIsTrustedThoughItsHashIsRight) {
  const std::string text = certificateText(certified(test::cubePastCube(0.1), 0.05));
  const auto refusedWith = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    const std::size_t at = changed.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    if (at == std::string::npos) return std::string();
    return refusal(sealed(changed.replace(at, from.size(), to)));
  };
  EXPECT_EQ(refusedWith("Nearfit", "Nearfit"), "no error");
  EXPECT_THAT(refusedWith("\"certificate\": 2", "\"certificate\": 9"), HasSubstr("version"));
  EXPECT_THAT(refusedWith("\"separation\": 0.05", "\"separation\": 0"), HasSubstr("above zero"));
  EXPECT_THAT(refusedWith("\"separation\": 0.05", "\"separation\": 1e999"), HasSubstr("JSON"));
  EXPECT_THAT(refusedWith("\"part\": 0", "\"part\": 2"), HasSubstr("pairs[0].part"));
  EXPECT_THAT(refusedWith("\"part\": 0", "\"part\": 0.5"), HasSubstr("index"));
  EXPECT_THAT(refusedWith("\"other\": 1", "\"other\": -1"), HasSubstr("pairs[0].other"));
  EXPECT_THAT(refusedWith(std::string(64, 'a'), std::string(64, 'x')), HasSubstr("SHA-256"));
  EXPECT_THAT(refusedWith("\"moving\": true", "\"moving\": 1"), HasSubstr("moving"));
  EXPECT_THAT(refusedWith("\"scene\": \"" + std::string(64, 'a'), "\"scene\": \""),
              HasSubstr("no hash of it"));
  EXPECT_THAT(refusedWith(std::string(64, 'b'), ""), HasSubstr("no hash of it"));
  EXPECT_THAT(refusedWith(std::string(64, 'b'), "b"), HasSubstr("SHA-256"));
  EXPECT_THAT(refusedWith("in.nfpath", "in\\u0000.nfpath"), HasSubstr("pathFile"));
  EXPECT_THAT(refusedWith("in.nfpath", std::string(4097, 'x')), HasSubstr("pathFile"));
  EXPECT_THAT(refusedWith("\"../fit.nearfit\"", "1"), HasSubstr("sceneFile"));
  EXPECT_THAT(refusedWith("-3.0", "-2.5"), HasSubstr("does not have this hash"));
}

TEST(MeshHash, DiffersWithEachBitOfTheGeometry) {
  const TriangleMesh mesh = test::boxMesh({1, 1, 1});
  const std::string hash = meshSha256(mesh);
  EXPECT_EQ(hash.size(), 64U);
  EXPECT_EQ(meshSha256(test::boxMesh({1, 1, 1})), hash);
  std::vector<glm::dvec3> vertices(mesh.vertices().begin(), mesh.vertices().end());
  std::vector<Triangle> triangles(mesh.triangles().begin(), mesh.triangles().end());
  vertices[3].y = std::nextafter(vertices[3].y, 9.0);
  EXPECT_NE(meshSha256(TriangleMesh(vertices, triangles)), hash);
  vertices[3] = mesh.vertices()[3];
  std::swap(triangles[0], triangles[1]);
  EXPECT_NE(meshSha256(TriangleMesh(vertices, triangles)), hash);
  std::swap(triangles[0], triangles[1]);
  EXPECT_EQ(meshSha256(TriangleMesh(vertices, triangles)), hash);
}

}  // namespace
}  // namespace nearfit::certificate_test
