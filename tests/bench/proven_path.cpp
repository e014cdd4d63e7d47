#include "tests/bench/proven_path.h"

#include <algorithm>
#include <random>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/parallel/parallel_for.h"
#include "core/path/certificate.h"
#include "core/path/path_certifier.h"
#include "core/path/path_verifier.h"
#include "core/scene/part_geometry.h"
#include "tests/bench/bench_clock.h"
#include "tests/exact/pose_certifier.h"
#include "tests/support/portable_random.h"

namespace nearfit::bench {
namespace {

constexpr std::size_t kPlaceBlock = 1024;

template <class Make>
std::vector<RigidTransform> posesOf(std::size_t count, Make&& make) {
  std::vector<RigidTransform> poses(count);
  parallelFor((count + kPlaceBlock - 1) / kPlaceBlock, [&](std::size_t block) {
    const std::size_t end = std::min(count, (block + 1) * kPlaceBlock);
    for (std::size_t i = block * kPlaceBlock; i < end; ++i)
      poses[i] = make(i);
  });
  return poses;
}

std::vector<RigidTransform> randomPoses(const AssemblyPath& path, std::size_t count, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::vector<double> places;
  places.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    places.push_back(path.end() * test::uniform(engine));
  // In order: poses that follow each other nearer than bodies are apart cost little.
  std::ranges::sort(places);
  return posesOf(count, [&](std::size_t i) { return poseAt(path, places[i]); });
}

test::WayVerdicts testEach(const test::PoseCertifier& certifier, std::span<const RigidTransform> poses) {
  test::WayVerdicts verdicts;
  verdicts.meetings.resize(poses.size());
  parallelFor((poses.size() + kPlaceBlock - 1) / kPlaceBlock, [&](std::size_t block) {
    const std::size_t end = std::min(poses.size(), (block + 1) * kPlaceBlock);
    for (std::size_t i = block * kPlaceBlock; i < end; ++i)
      verdicts.meetings[i] = certifier.doMeet(poses[i]) ? 1 : 0;
  });
  verdicts.tested = poses.size();
  return verdicts;
}

template <class Judge>
PlaceLooks judgePlaces(const AssemblyPath& path, const nearfit::PathBodies& bodies, std::size_t places,
                       std::uint64_t seed, Judge&& judge) {
  PlaceLooks all;
  all.places = places;
  const std::vector<RigidTransform> worldFromLead = randomPoses(path, places, seed);
  for (const PathPart& moving : bodies.moving) {
    for (const Scene::PartPtr& other : bodies.others) {
      const test::PoseCertifier certifier(other->geometry->mesh, moving.part->geometry->mesh);
      const std::vector<RigidTransform> poses =
          posesOf(places, [&](std::size_t i) { return otherFromPart(*other, worldFromLead[i], moving); });
      const test::WayVerdicts verdicts = judge(certifier, poses);
      const auto meetings = static_cast<std::size_t>(std::ranges::count(verdicts.meetings, 1));
      if (meetings > 0 && all.firstMeeting.empty())
        all.firstMeeting = fmt::format("{} meets {}", moving.part->name, other->name);
      all.looks += places;
      all.tested += verdicts.tested;
      all.measured += verdicts.measured;
      all.boxed += verdicts.boxed;
      all.meetings += meetings;
    }
  }
  return all;
}

}  // namespace

PathProofCheck proveAndVerify(const Scene& scene, const AssemblyPath& path, double separation) {
  PathProofCheck check;
  const double begin = secondsBy(BenchClock::Wall);
  const PathProof proof = PathCertifier(scene, path, separation).prove(path);
  check.certifySeconds = secondsBy(BenchClock::Wall) - begin;
  check.isCertified = proof.isFree();
  if (!check.isCertified) {
    check.problem = fmt::format("it is not proven free at {} s", proof.unproven->time);
    return check;
  }
  try {
    const Certificate certificate =
        parseCertificate(certificateText(certificateOf(scene, path, proof, {})), "certificate");
    const double start = secondsBy(BenchClock::Wall);
    const Verification verification = verifyCertificate(certificate, scene, {}, path);
    check.verifySeconds = secondsBy(BenchClock::Wall) - start;
    check.isVerified = verification.isProven();
    if (!check.isVerified) check.problem = "its certificate is refused: " + verification.problem;
  } catch (const Error& error) {
    check.problem = std::string("its certificate cannot be read: ") + error.what();
  }
  return check;
}

PlaceLooks lookAtPlaces(const AssemblyPath& path, const nearfit::PathBodies& bodies, std::size_t places,
                        std::uint64_t seed) {
  return judgePlaces(path, bodies, places, seed,
                     [](const test::PoseCertifier& certifier, std::span<const RigidTransform> poses) {
                       return certifier.along(poses);
                     });
}

PlaceLooks testPlaces(const AssemblyPath& path, const nearfit::PathBodies& bodies, std::size_t places,
                      std::uint64_t seed) {
  return judgePlaces(path, bodies, places, seed, testEach);
}

}  // namespace nearfit::bench
