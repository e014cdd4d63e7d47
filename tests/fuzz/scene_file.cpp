// Scene files, beside two meshes and a CAD document that they may name. One that is read is written and read again as
// the same scene.
#include "core/scene/scene_file.h"

#include <string>

#include "core/base/error.h"
#include "core/files/sha256.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/documents.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/mesh_text.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::fuzz {
namespace {

struct Folder {
  Folder() {
    std::filesystem::create_directory(folder.path() / "meshes");
    folder.write("meshes/hole.obj", test::objText(test::boxMesh({2, 2, 1})));
    folder.write("meshes/peg.obj", test::objText(test::tetrahedronMesh(1)));
    folder.write("meshes/vise.step", "the vise");
  }
  std::string hashOf(const char* name) const { return sha256OfFile(folder.path() / "meshes" / name); }

  test::TemporaryFolder folder;
  /// Makes test::viseDocument() of any document: its shapes are "body" and "pin".
  test::FakeImporter importer;
};

/// Names and locks of the groups from there upwards.
std::string pathOf(const Scene& scene, std::optional<GroupId> id) {
  std::string path;
  std::size_t depth = 0;
  for (; id; id = scene.findGroup(*id)->parent) {
    require(scene.findGroup(*id) != nullptr && ++depth <= kMaxGroupDepth, "groups are a tree");
    path += scene.findGroup(*id)->name + (scene.findGroup(*id)->isLocked ? "!" : "/");
  }
  return path;
}

void checkSame(const Scene& a, const Scene& b) {
  require(a.groups().size() == b.groups().size(), "as many groups are read as were written");
  require(a.parts().size() == b.parts().size(), "as many parts are read as were written");
  require(a.movingPart().has_value() == b.movingPart().has_value(), "the moving part is read as written");
  require(a.movingGroup().has_value() == b.movingGroup().has_value() &&
              pathOf(a, a.movingGroup()) == pathOf(b, b.movingGroup()) &&
              a.movingParts().size() == b.movingParts().size(),
          "the moving group is read as written");
  require(a.haptics() == b.haptics(), "settings are read as written");
  require(a.joints().size() == b.joints().size(), "as many joints are read as were written");
  for (std::size_t i = 0; i < a.joints().size(); ++i) {
    const Joint &x = a.joints()[i], &y = b.joints()[i];
    require(x.kind == y.kind && x.isOn == y.isOn && x.onPart == y.onPart && x.onBase == y.onBase &&
                a.get(x.part).name == b.get(y.part).name && x.base.has_value() == y.base.has_value(),
            "joints are read as written");
  }
  require(a.pairRules() == b.pairRules(), "rules for pairs are read as written");
  require(a.pairRecords().size() == b.pairRecords().size(), "as many records are read as were written");
  for (std::size_t i = 0; i < a.pairRecords().size(); ++i) {
    PairRecord x = a.pairRecords()[i];
    const PairRecord& y = b.pairRecords()[i];
    require(a.get(x.pair.part).name == b.get(y.pair.part).name &&
                a.get(x.pair.other).name == b.get(y.pair.other).name,
            "records are of the parts that were written");
    x.pair = y.pair;
    require(x == y, "records are read as written");
  }
  for (std::size_t i = 0; i < a.parts().size(); ++i) {
    const Part &x = *a.parts()[i], &y = *b.parts()[i];
    require(x.name == y.name && x.geometry->sha256 == y.geometry->sha256 && x.colour == y.colour &&
                x.density == y.density && x.isVisible == y.isVisible && x.isLocked == y.isLocked &&
                x.opacity == y.opacity && x.wasVisible == y.wasVisible,
            "parts are read as written");
    require(x.geometry->shapeKey == y.geometry->shapeKey &&
                x.geometry->tessellation == y.geometry->tessellation &&
                x.geometry->repairs == y.geometry->repairs &&
                x.geometry->mesh.triangles().size() == y.geometry->mesh.triangles().size(),
            "shapes and repairs are read as written");
    require(pathOf(a, x.group) == pathOf(b, y.group), "parts stand in the groups that were written");
    require(isPose(x.worldFromPart) && x.worldFromPart.translation == y.worldFromPart.translation,
            "poses are read as written");
  }
}

void replaceAll(std::string& text, std::string_view what, const std::string& with) {
  for (std::size_t at = text.find(what); at != text.npos; at = text.find(what, at + with.size()))
    text.replace(at, what.size(), with);
}

/// "<hole>", "<peg>" and "<vise>" stand for the hashes of the files, which no fuzzer guesses.
void run(std::string text) {
  static const Folder folder;
  static const std::string kHole = folder.hashOf("hole.obj"), kPeg = folder.hashOf("peg.obj"),
                           kVise = folder.hashOf("vise.step");
  replaceAll(text, "<hole>", kHole);
  replaceAll(text, "<peg>", kPeg);
  replaceAll(text, "<vise>", kVise);
  const auto file = folder.folder.write("fit.nearfit", text);
  requireReadOrRefused<FileError>([&] {
    const Scene scene = readSceneFile(file);
    const auto again = folder.folder.path() / "again.nearfit";
    writeSceneFile(scene, again);
    checkSame(scene, readSceneFile(again));
  });
}

}  // namespace
}  // namespace nearfit::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  nearfit::fuzz::run(std::string(reinterpret_cast<const char*>(data), size));
  return 0;
}
