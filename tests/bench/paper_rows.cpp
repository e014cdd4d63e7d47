#include "tests/bench/paper_rows.h"

#include <algorithm>
#include <numbers>
#include <random>

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>

#include "tests/bench/portable_random.h"
#include "tests/bench/query_method.h"
#include "tests/bench/selection.h"

namespace nearfit::bench {
namespace {

using std::numbers::pi;

/// Beside a tooth gap, the web of the gear and its bore, in the gear's frame: axis on z, teeth from -0.16 to 0,
/// tips at 0.335, bore of 0.08 (the gear's diagonal is 1; the disc's radius is 0.072).
const glm::dvec3 kToothGap{0.36, 0.0, -0.08}, kGearFace{0.2, 0.0, -0.2}, kGearBore{0.0};

std::array<PaperRow, 6> makeRows() {
  constexpr double kUsual = kUsualCutoffFraction;
  // The bore's play is a sixth of the usual cutoff, at which all of the rim would be near.
  constexpr double kInBoreCutoff = 0.01;
  return {{
      {"a",
       "paper-gear-disc",
       "near a gap",
       512,
       6302,
       PaperRow::Printed{3, 176.25},
       kUsual,
       kToothGap,
       {0.06, 0.05, 0.08},
       pi,
       {{0.9774314392493684, -0.07000502298998258, 0.12039569778710058, -0.158845693292067},
        {0.41944880255413486, 0.03210720424614384, -0.015557815813361908}}},
      {"b",
       "paper-gear-disc",
       "near a face",
       512,
       6302,
       PaperRow::Printed{1, 1506.76},
       kUsual,
       kGearFace,
       {0.05, 0.05, 0.03},
       0.3,
       {{0.9934686572433363, 0.037447936309525726, -0.0922258448260271, 0.055785954212557054},
        {0.1848888724259062, -0.013669142773247612, -0.19402479932087643}}},
      {"c",
       "paper-gear-disc",
       "within the bore",
       512,
       6302,
       PaperRow::Printed{10, 121.0},
       kInBoreCutoff,
       kGearBore,
       {0.008, 0.008, 0.1},
       0.1,
       {{0.9992496973129021, 0.034956189000347956, 0.015179483535880597, -0.006905834506359612},
        {-0.0027205125411778664, -0.006076303094827624, -0.048037181012472834}}},
      {"d",
       "paper-bunny-sphere",
       "",
       128,
       2204,
       PaperRow::Printed{2, 337.0},
       kUsual,
       {0.0, 0.0, 0.0},
       {0.8, 0.8, 0.8},
       pi,
       {{0.14661137896920548, 0.5507987707233546, 0.6142099439082508, 0.5457764767105787},
        {0.12907186771233548, 0.34384310794551215, -0.36761275479997785}}},
      {"e",
       "paper-spring-teapot",
       "",
       5648,
       23578,
       PaperRow::Printed{2, 181.0},
       kUsual,
       {0.0, 0.0, 0.0},
       {0.8, 0.8, 0.8},
       pi,
       {{0.9544969092630927, -0.28395553683049224, -0.08857549332535145, -0.02143094241233672},
        {0.23973226413936022, -0.17591579216433342, 0.5711228459326396}}},
      {"f",
       "paper-crankshaft-disc",
       "",
       512,
       12802,
       PaperRow::Printed{2, 318.0},
       kUsual,
       {0.0, 0.0, 0.0},
       {0.5, 0.3, 0.3},
       pi,
       {{0.9544969092630927, -0.28395553683049224, -0.08857549332535145, -0.02143094241233672},
        {0.14983266508710014, -0.06596842206162502, 0.21417106722473983}}},
  }};
}

PaperRow makeScanRow() {
  return {"scan",
          "scan-bunny-armadillo",
          "",
          29170,
          69666,
          std::nullopt,
          kUsualCutoffFraction,
          {0.0, 0.0, 0.0},
          {0.8, 0.8, 0.8},
          pi,
          {{0.36303586402552873, 0.2980327160593818, -0.46590108376628686, -0.7498784179684765},
           {-0.5319812985328544, -0.06027173584818595, -0.0116682292660224}}};
}

double within(std::mt19937_64& random, double half) {
  return half * (2.0 * uniform(random) - 1.0);
}

RigidTransform randomPoseIn(const PaperRow& row, const glm::dvec3& partCentre, std::mt19937_64& random) {
  const double turn = within(random, row.maxTurn);
  const glm::dquat rotation = glm::angleAxis(turn, randomDirection(random));
  glm::dvec3 centre = row.regionCentre;
  for (int k = 0; k < 3; ++k)
    centre[k] += within(random, row.regionHalf[k]);
  return {rotation, centre - rotation * partCentre};
}

}  // namespace

const std::array<PaperRow, 6>& paperRows() {
  static const std::array<PaperRow, 6> rows = makeRows();
  return rows;
}

const PaperRow& scanRow() {
  static const PaperRow row = makeScanRow();
  return row;
}

BenchScene paperScene(const PaperRow& row, const std::filesystem::path& folder) {
  BenchScene meshes = chosen(sharedScenes(folder), {row.scene}, "row").front().make();
  meshes.name = row.printed ? fmt::format("{} {}", row.name, row.scene) : row.scene;
  meshes.start = row.pose;
  meshes.range.reset();
  return meshes;
}

std::optional<RigidTransform> searchPose(const PaperRow& row, const BenchScene& meshes) {
  const PaperHierarchy scene(meshes.scene, PaperRule::NormalSpans), part(meshes.part, PaperRule::NormalSpans);
  PaperQuery query(scene, part);
  const double cutoff = row.cutoffFraction * meshes.size();
  const glm::dvec3 partCentre = meshes.part.bounds().centre();
  std::mt19937_64 random(kPoseSeed);
  for (std::size_t i = 0; i < kMaxPoses; ++i) {
    const RigidTransform pose = randomPoseIn(row, partCentre, random);
    const auto found = query.find(pose, cutoff);
    const bool isWanted = row.printed ? found.size() == row.printed->minima : !found.empty();
    if (isWanted && !query.isTouching() && found.front().distance >= kMinGap * cutoff) return pose;
  }
  return std::nullopt;
}

}  // namespace nearfit::bench
