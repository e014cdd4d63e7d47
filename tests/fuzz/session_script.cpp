// Scripts of the session's commands, beside two meshes and a CAD document that they may name. What is replayed is recorded
// meanwhile, and that record leads to the same scene.
#include "core/session/session_script.h"

#include <filesystem>
#include <string>

#include "core/base/error.h"
#include "core/scene/scene_file.h"
#include "core/session/script_recorder.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/documents.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/mesh_text.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::fuzz {
namespace {

struct ScriptFolder {
  ScriptFolder() {
    std::filesystem::create_directory(folder.path() / "meshes");
    folder.write("meshes/hole.obj", test::objText(test::boxMesh({2, 2, 1})));
    folder.write("meshes/peg.obj", test::objText(test::tetrahedronMesh(1)));
    folder.write("meshes/vise.step", "the vise");
  }

  test::TemporaryFolder folder;
  /// Makes test::viseDocument() of any document: its shapes are "body" and "pin".
  test::FakeImporter importer;
};

void run(const std::string& text) {
  static const ScriptFolder folder;
  const std::filesystem::path file = folder.folder.write("session.jsonl", text);
  const std::filesystem::path record = folder.folder.path() / "record.jsonl",
                              out = folder.folder.path() / "out";
  Session session;
  ScriptRecorder recorder(session);
  recorder.start(record);
  const Subscription changes = session.onChange(SceneEvents::Stage::Panels, [&] { recorder.follow(); });
  requireReadOrRefused<FileError>([&] { replay(readScript(file), session); });
  recorder.stop();
  Session again;
  replay(readScript(record), again);
  require(sceneFileText(session.scene(), out) == sceneFileText(again.scene(), out),
          "a record of the commands leads to the same scene");
  require(session.scene().parts().size() <= kMaxSceneFileParts, "a script does not outgrow a scene file");
}

}  // namespace
}  // namespace nearfit::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  nearfit::fuzz::run(std::string(reinterpret_cast<const char*>(data), size));
  return 0;
}
