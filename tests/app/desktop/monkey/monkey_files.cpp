#include "tests/app/desktop/monkey/monkey_files.h"

#include <QFile>
#include <QFileInfo>
#include <string>

#include "core/scene/scene_file.h"
#include "tests/app/desktop/desktop_driver.h"

namespace nearfit::test {
namespace {

/// Few triangles each: a user is fast only where the program is.
TriangleMesh shape(int which) {
  switch (which) {
    case 0:
      return boxMesh(glm::dvec3(0.04));
    case 1:
      return boxMesh(glm::dvec3(0.02), {0.0, 0.0, 0.035});
    case 2:
      return icosphereMesh(0.015, 1);
    case 3:
      return torusMesh(0.03, 0.008, 12, 6);
    case 4:
      return tubeMesh(0.012, 0.02, 0.04, 12);
    case 5:
      return starMesh(7, 0.02, 1, 0.3);
    default:
      return squareMesh(0.05, 2);
  }
}
constexpr int kShapes = 7;

}  // namespace

MonkeyFiles::MonkeyFiles() {
  std::filesystem::create_directories(folder_.path() / "saved");
  std::filesystem::create_directories(folder_.path() / "empty");
  writeParts();
  writeScene();
  writeDamaged();
}

QString MonkeyFiles::path(const char* name) const {
  return QString::fromStdString((folder_.path() / name).string());
}

void MonkeyFiles::writeParts() {
  for (int i = 0; i < kShapes; ++i)
    parts_ << writeOff(folder_.path() / ("part" + std::to_string(i) + ".off"), shape(i));
}

void MonkeyFiles::writeScene() {
  Scene made;
  for (const int i : {0, 3, 4}) {
    Part part;
    part.geometry = loadPartGeometry(parts_[i].toStdString(), 1e-3);
    part.name = "piece " + std::to_string(i);
    part.worldFromPart.translation.x = 0.1 * i;
    const PartId id = made.add(part);
    if (i == 3) made.setMovingPart(id);
  }
  writeSceneFile(made, scene().toStdString());
}

void MonkeyFiles::writeDamaged() {
  const std::string whole = readBytes(parts_[5].toStdString());
  const std::string text = readBytes(scene().toStdString());
  folder_.write("cut.off", whole.substr(0, whole.size() / 2));
  folder_.write("empty.stl", "");
  using namespace std::string_literals;
  folder_.write("noise.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 99\0\1\2"s);
  folder_.write("nan.off", "OFF\n3 1 0\nnan 0 0\n1 inf 0\n0 1 0\n3 0 1 2\n");
  folder_.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  folder_.write("cut.nearfit", text.substr(0, text.size() / 2));
  folder_.write("other.nearfit", "{\"nearfit\": 99}");
  folder_.write("hand.csv", "time,handle_tx\n0,nan\n");
  for (const char* name : {"cut.off", "empty.stl", "noise.ply", "nan.off", "flat.obj", "cut.nearfit",
                           "other.nearfit", "hand.csv", "not there.stl", "empty", "saved"})
    odd_ << path(name);
}

QString MonkeyFiles::any(RandomValues& random) const {
  const QStringList& from = random.flip(0.6) ? parts_ : odd_;
  if (random.flip(0.1)) return scene();
  return from[static_cast<int>(random.in(0.0, from.size()))];
}

QStringList MonkeyFiles::some(RandomValues& random) const {
  QStringList files;
  do {
    files << any(random);
  } while (files.size() < 4 && random.flip(0.4));
  return files;
}

QString MonkeyFiles::forSaving(const QString& suffix, RandomValues& random) const {
  if (random.flip(0.05)) return path("saved");  // A folder.
  const QString name = QStringLiteral("saved/%1").arg(static_cast<int>(random.in(0.0, 4.0)));
  return path(qPrintable(suffix.isEmpty() ? name : name + QChar('.') + suffix));
}

QString MonkeyFiles::change(RandomValues& random) {
  const QString file = parts_[static_cast<int>(random.in(0.0, parts_.size()))];
  if (random.flip(0.15)) {
    QFile::remove(file);
    return QStringLiteral("remove ") + QFileInfo(file).fileName();
  }
  const int which = static_cast<int>(random.in(0.0, kShapes));
  writeOff(file.toStdString(), shape(which));
  if (random.flip(0.15)) QFile::resize(file, QFileInfo(file).size() / 2);
  return QStringLiteral("write shape %1 to %2").arg(which).arg(QFileInfo(file).fileName());
}

}  // namespace nearfit::test
