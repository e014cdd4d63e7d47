#include "core/path/path_verifier.h"

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/path_scenes.h"
#include "tests/support/random_values.h"

namespace nearfit::path_verifier_test {
namespace {

using testing::HasSubstr;

const std::string kSceneHash(64, 'a');

Certificate certified(const test::PathScene& made, double separation) {
  const PathProof proof = PathCertifier(made.scene, made.path, separation).prove(made.path);
  EXPECT_TRUE(proof.isFree());
  return certificateOf(made.scene, made.path, proof, kSceneHash);
}

std::string problemOf(const Certificate& certificate, const Scene& scene) {
  return verifyCertificate(certificate, scene, kSceneHash).problem;
}

/// A certificate with one stretch for the whole path, as a liar would write it.
Certificate forged(const test::PathScene& made, double separation, double bound) {
  const Certificate honest = certified(test::cubePastCube(5.0), 0.1);
  Certificate lie = honest;
  lie.separation = separation;
  lie.path = made.path;
  lie.parts = certifiedParts(pathBodies(made.scene, made.path));
  lie.pairs = {{0, 1, {{0.0, 0.5 * made.path.end(), made.path.end(), bound}}}};
  return lie;
}

TEST(PathVerifier, ProvesWhatTheCertifierProvedOfShapesKnownByFormula) {
  const double gap = test::leastRingGap(0.95);
  for (const auto& [made, separation] :
       {std::pair(test::cubePastCube(0.01), 0.009), std::pair(test::barInRing(0.95), 0.93 * gap),
        std::pair(test::pegScrewedIn(0.95), 0.93 * gap), std::pair(test::cubePastCube(100.0), 1e-6)}) {
    const Certificate certificate = certified(made, separation);
    const Verification verified = verifyCertificate(certificate, made.scene, kSceneHash, made.path);
    EXPECT_EQ(verified.problem, "");
    EXPECT_GT(verified.stretches, 0U);
    // What was written to a file and read again is the same.
    EXPECT_EQ(problemOf(parseCertificate(certificateText(certificate), "a"), made.scene), "");
  }
}

TEST(PathVerifier, ProvesRandomMotionsThatTheCertifierProved) {
  test::RandomValues random(17);
  int free = 0;
  for (unsigned seed = 0; seed < 12; ++seed) {
    test::PathScene made;
    made.scene.add(test::partOf(test::geometryOf(test::starMesh(seed, 0.5, 2, 0.3)), "Still", random.pose()));
    made.scene.add(test::partOf(test::geometryOf(test::starMesh(seed + 50, 0.5, 2, 0.3)), "Rock"));
    std::vector<RigidTransform> poses;
    // On a ray away from the other, the first poses very near or in it.
    const glm::dvec3 away = glm::normalize(random.vector(1.0) + glm::dvec3(1e-3));
    RigidTransform pose = random.pose().normalized();
    const double start = random.in(0.8, 1.4);
    for (int i = 0; i < 20; ++i) {
      pose.translation = made.part("Still").worldFromPart.translation + (start + 0.1 * i) * away;
      pose = pose.normalized();
      poses.push_back(pose);
      pose.rotation = rotationOf(random.vector(0.3)) * pose.rotation;
    }
    made.path = test::pathThrough("Rock", poses);
    made.path.centre = random.vector(0.2);
    const double separation = 1e-3;
    const PathProof proof = PathCertifier(made.scene, made.path, separation).prove(made.path);
    if (!proof.isFree()) continue;
    ++free;
    EXPECT_EQ(problemOf(certificateOf(made.scene, made.path, proof, kSceneHash), made.scene), "") << seed;
  }
  EXPECT_GT(free, 0) << "from 1.31 m on nothing can meet";
}

TEST(PathVerifier, SaysWhatDiffersWhenTheSceneIsAnother) {
  const test::PathScene made = test::barInRing(0.9);
  const Certificate certificate = certified(made, 1e-3);
  const auto problemWith = [&](const auto& change) {
    Scene scene = made.scene;
    change(scene);
    return problemOf(certificate, scene);
  };
  const auto changed = [&](const char* name, const auto& change) {
    return problemWith([&](Scene& scene) {
      Part part = *scene.findByName(name);
      change(part);
      scene.replace(part);
    });
  };
  EXPECT_EQ(problemWith([](Scene&) {}), "");
  EXPECT_THAT(changed("Ring", [](Part& p) { p.worldFromPart.translation.x = 1e-300; }),
              HasSubstr("\"Ring\" is at another place"));
  EXPECT_THAT(changed("Ring", [](Part& p) { p.isVisible = false; }),
              HasSubstr("does not show the part \"Ring\""));
  EXPECT_THAT(changed("Ring", [](Part& p) { p.name = "Tube"; }),
              HasSubstr("\"Tube\" where the certificate has"));
  EXPECT_THAT(changed("Bar", [](Part& p) { p.name = "Rod"; }), HasSubstr("no part \"Bar\""));
  const auto withOneBitChanged = [](Part& part) {
    const TriangleMesh& mesh = part.geometry->mesh;
    std::vector<glm::dvec3> vertices(mesh.vertices().begin(), mesh.vertices().end());
    vertices[5].z = std::nextafter(vertices[5].z, 9.0);
    part.geometry =
        test::geometryOf(TriangleMesh(vertices, {mesh.triangles().begin(), mesh.triangles().end()}));
  };
  EXPECT_THAT(changed("Ring", withOneBitChanged), HasSubstr("the mesh of \"Ring\" differs"));
  EXPECT_THAT(changed("Bar", withOneBitChanged), HasSubstr("the mesh of \"Bar\" differs"));
  EXPECT_THAT(
      problemWith([](Scene& scene) {
        scene.add(test::partOf(test::geometryOf(test::boxMesh({1, 1, 1})), "New", test::at(50, 0, 0)));
      }),
      HasSubstr("shows the part \"New\""));
}

TEST(PathVerifier, SaysThatSceneFileOrPathIsAnother) {
  const test::PathScene made = test::cubePastCube(0.01);
  const Certificate certificate = certified(made, 0.009);
  EXPECT_THAT(verifyCertificate(certificate, made.scene, std::string(64, 'b')).problem,
              HasSubstr("scene file"));
  AssemblyPath path = made.path;
  path.poses[1].worldFromLead.translation.z = 1e-300;
  EXPECT_THAT(verifyCertificate(certificate, made.scene, kSceneHash, path).problem,
              HasSubstr("the path is not"));
  path = made.path;
  path.poses[1].time = std::nextafter(path.poses[1].time, 9.0);
  EXPECT_THAT(verifyCertificate(certificate, made.scene, kSceneHash, path).problem,
              HasSubstr("the path is not"));
}

TEST(PathVerifier, RefusesAProofWithAHole) {
  const test::PathScene made = test::barInRing(0.95);
  const Certificate honest = certified(made, 0.9 * test::leastRingGap(0.95));
  ASSERT_GT(honest.pairs[0].stretches.size(), 4U);
  const auto problemWith = [&](const auto& change) {
    Certificate lie = honest;
    change(lie.pairs[0].stretches);
    return problemOf(lie, made.scene);
  };
  EXPECT_EQ(problemWith([](auto&) {}), "");
  EXPECT_THAT(problemWith([](auto& s) { s.pop_back(); }), HasSubstr("ends before the path"));
  EXPECT_THAT(problemWith([](auto& s) { s.clear(); }), HasSubstr("ends before the path"));
  EXPECT_THAT(problemWith([](auto& s) { s.erase(s.begin() + 2); }), HasSubstr("does not go on"));
  EXPECT_THAT(problemWith([](auto& s) { s[2].anchor = s[2].to + 0.1; }), HasSubstr("does not go on"));
  EXPECT_THAT(problemWith([](auto& s) { s.back().to += 0.5; }), HasSubstr("ends before the path"));
  // A stretch that takes in all behind it.
  EXPECT_THAT(problemWith([](auto& s) {
                s[1].to = s.back().to;
                s.erase(s.begin() + 2, s.end());
              }),
              HasSubstr("claims too little"));
  Certificate lie = honest;
  lie.pairs.clear();
  EXPECT_THAT(problemOf(lie, made.scene), HasSubstr("no proof for \"Bar\" and \"Ring\""));
  lie = honest;
  lie.pairs.push_back(lie.pairs[0]);
  EXPECT_THAT(problemOf(lie, made.scene), HasSubstr("pairs of parts"));
}

TEST(PathVerifier, RefusesClaimsThatAreNotSo) {
  const test::PathScene made = test::barInRing(0.95);
  Certificate lie = certified(made, 0.9 * test::leastRingGap(0.95));
  lie.pairs[0].stretches[3].bound = 0.06;  // The gap is nowhere wider than 0.05 m.
  EXPECT_THAT(problemOf(lie, made.scene), HasSubstr("not proven to be 0.06 m apart"));
  lie = certified(made, 0.9 * test::leastRingGap(0.95));
  lie.separation = 0.0499;
  EXPECT_THAT(problemOf(lie, made.scene), HasSubstr("claims too little"));
}

TEST(PathVerifier, RefusesAPathThatGrazes) {
  const test::PathScene made = test::cubePastCube(0.01);
  // The way is 6 m long, so that one stretch must claim 3 m at its middle.
  EXPECT_THAT(problemOf(forged(made, 0.0101, 3.02), made.scene), HasSubstr("not proven"));
  EXPECT_THAT(problemOf(forged(made, 0.0101, 0.0101), made.scene), HasSubstr("claims too little"));
}

TEST(PathVerifier, RefusesAJumpThroughAThinPlate) {
  test::PathScene made;
  made.scene.add(test::partOf(test::geometryOf(test::boxMesh({1e-4, 2, 2})), "Plate"));
  made.scene.add(test::partOf(test::geometryOf(test::boxMesh({0.2, 0.2, 0.2})), "Cube"));
  made.path = test::pathThrough("Cube", {test::at(-1, 0, 0), test::at(1, 0, 0)});
  Certificate lie = forged(made, 1e-3, 0.0);
  // Both ends are far from the plate, and stretches around them claim no more than is so.
  lie.pairs[0].stretches = {{0.0, 0.2, 0.4, 0.41}, {0.4, 0.5, 0.6, 0.21}, {0.6, 0.8, 1.0, 0.41}};
  EXPECT_THAT(problemOf(lie, made.scene), HasSubstr("not proven"));
}

TEST(PathVerifier, RefusesWhatIsInsideThoughSurfacesAreApart) {
  test::PathScene made;
  made.scene.add(test::partOf(test::geometryOf(test::boxMesh({4, 4, 4})), "Block"));
  made.scene.add(test::partOf(test::geometryOf(test::boxMesh({1, 1, 1})), "Cube"));
  made.path = test::pathThrough("Cube", {test::at(0, 0, 0), test::at(0.5, 0, 0)});
  EXPECT_THAT(problemOf(forged(made, 1e-3, 0.3), made.scene), HasSubstr("outside each other"));
  // The other way round: the block moves about the cube.
  made.path = test::pathThrough("Block", {test::at(0, 0, 0), test::at(0.5, 0, 0)});
  EXPECT_THAT(problemOf(forged(made, 1e-3, 0.3), made.scene), HasSubstr("outside each other"));
}

TEST(PathVerifier, ABodyInACavityIsOutside) {
  test::PathScene made;
  const TriangleMesh shell = test::joined(test::boxMesh({4, 4, 4}), test::turned(test::boxMesh({3, 3, 3})));
  made.scene.add(test::partOf(test::geometryOf(shell), "Shell"));
  made.scene.add(test::partOf(test::geometryOf(test::boxMesh({1, 1, 1})), "Cube"));
  made.path = test::pathThrough("Cube", {test::at(0, 0, 0), test::at(0.5, 0, 0)});
  EXPECT_EQ(problemOf(certified(made, 0.4), made.scene), "");
}

TEST(PathVerifier, StopsWhenAsked) {
  const test::PathScene made = test::barInRing(0.95);
  const Certificate certificate = certified(made, 1e-3);
  EXPECT_THROW(verifyCertificate(certificate, made.scene, kSceneHash, {}, [](double) { return false; }),
               Cancelled);
}

}  // namespace
}  // namespace nearfit::path_verifier_test
