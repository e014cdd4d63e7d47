#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/scene/document_load.h"
#include "core/scene/document_parts.h"
#include "core/verdict/scene_check.h"
#include "tests/app/import/import_fixture.h"
#include "tests/exact/exact_verdicts.h"
#include "tests/support/part_geometries.h"
#include "tests/support/places.h"
#include "tests/support/scoped_variable.h"
#include "tests/support/trial_share.h"

/// Verdicts on the parts of documents; nearfit-bench verdicts has more places of them.
namespace nearfit::import_verdicts_test {
namespace {

LoadedDocument documentOf(const std::filesystem::path& file) {
  const test::ScopedVariable program("NEARFIT_IMPORT", test::builtPath("nearfit-import"));
  return loadDocument(file, 1.0);
}

void expectAgreement(const Scene& scene, double threshold, std::size_t pairs) {
  const SceneCheckRequest request = sceneCheckRequest(scene, threshold);
  const SceneCheck check = checkScene(request);
  const test::VerdictComparison comparison = test::compareVerdicts(request, check);
  EXPECT_EQ(comparison.pairs, pairs);
  EXPECT_EQ(comparison.agree, pairs);
  for (const std::string& difference : comparison.differences)
    ADD_FAILURE() << difference;
  const test::ClashComparison clashes =
      test::compareClashes(request, check, {.maxBooleanTriangles = 1000, .maxBooleans = 2});
  EXPECT_EQ(clashes.freed, clashes.depths);
  EXPECT_EQ(clashes.least, clashes.depths);
  EXPECT_EQ(clashes.booleansAgree, clashes.booleans);
  for (const std::string& difference : clashes.differences)
    ADD_FAILURE() << difference;
}

TEST(ImportVerdicts, PartsOfTheBoxHaveTheVerdictsOfExactArithmetic) {
  const std::filesystem::path file = test::sharedModel("public/trimesh_box_assembly.STEP");
  if (!std::filesystem::exists(file)) return;
  const LoadedDocument document = documentOf(file);
  Scene drawn;
  addTo(drawn, partsOfDocument(document, drawn));
  expectAgreement(drawn, 2e-3, 45);
  for (std::size_t i = 0; i < 4 / test::kTrialShare; ++i)
    expectAgreement(test::spreadScene(drawn, i % 2 == 0 ? 1.02 : 0.95, i + 1), 2e-3, 45);
}

TEST(ImportVerdicts, ShellsOfTheViseHaveTheVerdictsOfExactArithmetic) {
  const std::filesystem::path file = test::sharedModel("public/steptools_vise.stp");
  if (!std::filesystem::exists(file)) return;
  const LoadedDocument document = documentOf(file);
  ASSERT_EQ(document.shapes.size(), 1U);
  const std::vector<TriangleMesh> shells = test::meshPieces(document.shapes[0]->mesh);
  ASSERT_GT(shells.size(), 1U);
  Scene scene;
  for (const TriangleMesh& shell : shells)
    scene.add(test::partOf(test::freshGeometryOf(shell), std::to_string(scene.parts().size() + 1).c_str()));
  expectAgreement(scene, 2e-3, shells.size() * (shells.size() - 1) / 2);
}

}  // namespace
}  // namespace nearfit::import_verdicts_test
