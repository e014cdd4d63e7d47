#include "core/path/certificate.h"

#include <cmath>
#include <functional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/files/sha256.h"
#include "tests/support/path_scenes.h"

namespace nearfit::certificate_test {
namespace {

using testing::HasSubstr;

Certificate certified(const test::PathScene& made, double separation) {
  const PathProof proof = PathCertifier(made.scene, made.path, separation).prove(made.path);
  EXPECT_TRUE(proof.isFree());
  return certificateOf(made.scene, made.path, proof, std::string(64, 'a'));
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

TEST(Certificate, ReadsBackTheSame) {
  const test::PathScene made = test::cubePastCube(0.01);
  const Certificate written = certified(made, 0.009);
  const std::string text = certificateText(written);
  const Certificate read = parseCertificate(text, "a.nfcert");
  EXPECT_EQ(certificateText(read), text);
  EXPECT_TRUE(isSamePath(read.path, made.path));
  EXPECT_EQ(read.separation, 0.009);
  EXPECT_EQ(read.sceneSha256, std::string(64, 'a'));
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
  const std::string text = certificateText(certified(test::cubePastCube(0.1), 0.05));
  for (std::size_t i = 0; i < text.size(); ++i) {
    std::string changed = text;
    changed[i] = static_cast<char>(changed[i] ^ 1);
    ASSERT_NE(refusal(changed), "no error") << "byte " << i;
  }
  EXPECT_NE(refusal(text + "\n"), "no error");
  EXPECT_NE(refusal(text.substr(0, text.size() - 1)), "no error");
  EXPECT_NE(refusal(""), "no error");
  EXPECT_EQ(refusal(text), "no error");
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
  EXPECT_THAT(refusedWith("\"certificate\": 1", "\"certificate\": 9"), HasSubstr("version"));
  EXPECT_THAT(refusedWith("\"separation\": 0.05", "\"separation\": 0"), HasSubstr("above zero"));
  EXPECT_THAT(refusedWith("\"separation\": 0.05", "\"separation\": 1e999"), HasSubstr("JSON"));
  EXPECT_THAT(refusedWith("\"part\": 0", "\"part\": 2"), HasSubstr("pairs[0].part"));
  EXPECT_THAT(refusedWith("\"part\": 0", "\"part\": 0.5"), HasSubstr("index"));
  EXPECT_THAT(refusedWith("\"other\": 1", "\"other\": -1"), HasSubstr("pairs[0].other"));
  EXPECT_THAT(refusedWith(std::string(64, 'a'), std::string(64, 'x')), HasSubstr("SHA-256"));
  EXPECT_THAT(refusedWith("\"moving\": true", "\"moving\": 1"), HasSubstr("moving"));
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
