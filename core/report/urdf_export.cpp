#include "core/report/urdf_export.h"

#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <memory>
#include <numbers>
#include <set>
#include <string>
#include <system_error>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "core/files/sha256.h"
#include "core/report/assembly_tree.h"
#include "core/report/mesh_export.h"
#include "core/scene/names.h"
#include "core/text/xml_text.h"

namespace nearfit {
namespace {

namespace fs = std::filesystem;

/// Max length of a name of a mesh file without its digest [bytes]; file systems take 255.
constexpr std::size_t kMaxMeshNameBytes = 60;
/// Digits of a digest in a name: two meshes of one name in one folder share them once in 10^14 times.
constexpr std::size_t kDigestDigits = 12;
/// Max length of a link's or joint's name [bytes]: a part's with some words behind it.
constexpr std::size_t kMaxLinkNameBytes = kMaxPartNameBytes + 30;

/// A name that every file system, URI and tool takes: letters, digits and _ - .
std::string fileNameOf(const std::string& name) {
  std::string result;
  for (const char c : name) {
    const bool isPlain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                         c == '-' || c == '_' || (c == '.' && !result.empty());
    // One for each run of others, also for the bytes of a character.
    if (isPlain) {
      result += c;
    } else if (!result.ends_with('_')) {
      result += '_';
    }
  }
  return result.substr(0, kMaxMeshNameBytes);
}

template <class T>
std::string digestOf(std::span<const T> values) {
  return sha256OfBytes({reinterpret_cast<const char*>(values.data()), values.size_bytes()});
}

std::string digestOf(const TriangleMesh& mesh) {
  const std::string both = digestOf(mesh.vertices()) + digestOf(mesh.triangles());
  return sha256OfBytes(both).substr(0, kDigestDigits);
}

/// Mesh files, by geometry: none twice, and none that a part of the scene was read from.
std::vector<fs::path> meshFiles(const AssemblyTree& tree, const fs::path& folder) {
  std::set<fs::path> taken;
  for (const PartGeometryPtr& geometry : tree.geometries)
    taken.insert(geometry->file);
  std::vector<fs::path> files;
  for (const PartGeometryPtr& geometry : tree.geometries) {
    std::string name = fileNameOf(geometryName(*geometry)) + "-" + digestOf(geometry->mesh);
    while (!taken.insert(normalisedPath(folder / (name + ".stl"))).second)
      name += "_";
    files.push_back(folder / (name + ".stl"));
  }
  return files;
}

void makeFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directory(folder, error);
  if (error)
    throw FileError(folder.string(), "the folder for meshes cannot be made: " + error.message(),
                    "choose another folder to export to");
}

/// The geometry as a part whose frame is the world's.
Scene::PartPtr unplaced(const PartGeometryPtr& geometry) {
  auto part = std::make_shared<Part>();
  part->geometry = geometry;
  return part;
}

class UrdfText {
 public:
  UrdfText(const AssemblyTree& tree, const fs::path& file, const std::vector<fs::path>& meshes)
      : tree_(tree), meshes_(meshes), links_(kMaxLinkNameBytes), joints_(kMaxLinkNameBytes) {
    add("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<!-- Nearfit " NEARFIT_VERSION
        "; metres, radians, kilograms -->\n"
        "<robot name=\"{}\">\n",
        xmlText(assemblyName(file)));
  }

  std::string text() {
    nameLinks();
    addMaterials();
    add("  <link name=\"{}\"/>\n", xmlText(root_));
    for (std::size_t i = 0; i < tree_.nodes.size(); ++i) {
      addLink(i);
      addJoint(i);
    }
    return text_ + "</robot>\n";
  }

 private:
  template <class... T>
  void add(fmt::format_string<T...> format, T&&... values) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<T>(values)...);
  }

  /// Parts keep their names, which are unique; groups and the root take what is left.
  void nameLinks() {
    for (const AssemblyNode& node : tree_.nodes)
      if (node.part != nullptr) links_.add(node.name);
    root_ = links_.takeFree("world");
    for (const AssemblyNode& node : tree_.nodes)
      names_.push_back(node.part != nullptr ? node.name : links_.takeFree(node.name));
  }

  using Paint = std::tuple<float, float, float, double>;
  static Paint paintOf(const Part& part) {
    return {part.colour.r, part.colour.g, part.colour.b, part.opacity};
  }

  void addMaterials() {
    for (const AssemblyNode& node : tree_.nodes) {
      if (node.part == nullptr) continue;
      const Paint paint = paintOf(*node.part);
      const auto [at, isNew] = materials_.emplace(paint, materials_.size() + 1);
      if (!isNew) continue;
      const auto& [r, g, b, a] = paint;
      add("  <material name=\"colour {}\"><color rgba=\"{} {} {} {}\"/></material>\n", at->second, r, g, b,
          a);
    }
  }

  void addLink(std::size_t index) {
    const AssemblyNode& node = tree_.nodes[index];
    if (node.part == nullptr) {
      add("  <link name=\"{}\"/>\n", xmlText(names_[index]));
      return;
    }
    const fs::path& mesh = meshes_[static_cast<std::size_t>(node.geometry)];
    const std::string geometry =
        fmt::format("<geometry><mesh filename=\"{}\"/></geometry>",
                    xmlText(mesh.parent_path().filename().string() + "/" + mesh.filename().string()));
    add("  <link name=\"{}\">\n", xmlText(names_[index]));
    addInertia(*node.part);
    add("    <visual>{}<material name=\"colour {}\"/></visual>\n", geometry,
        materials_.at(paintOf(*node.part)));
    add("    <collision>{}</collision>\n  </link>\n", geometry);
  }

  void addInertia(const Part& part) {
    const MassProperties& mass = part.geometry->mass;
    if (part.density == kDefaultDensity || mass.basis != MassBasis::VolumeIntegrals) return;
    const glm::dvec3& c = mass.centre;
    const glm::dmat3 inertia = part.density * mass.inertia;
    add("    <inertial><origin xyz=\"{} {} {}\" rpy=\"0 0 0\"/><mass value=\"{}\"/>", c.x, c.y, c.z,
        massOf(part));
    add("<inertia ixx=\"{}\" ixy=\"{}\" ixz=\"{}\" iyy=\"{}\" iyz=\"{}\" izz=\"{}\"/></inertial>\n",
        inertia[0][0], inertia[1][0], inertia[2][0], inertia[1][1], inertia[2][1], inertia[2][2]);
  }

  void addJoint(std::size_t index) {
    const AssemblyNode& node = tree_.nodes[index];
    const std::string& parent = node.parent < 0 ? root_ : names_[static_cast<std::size_t>(node.parent)];
    add("  <joint name=\"{}\" type=\"fixed\">", xmlText(joints_.takeFree(names_[index] + " joint")));
    if (node.part != nullptr) {
      const RigidTransform pose = node.part->worldFromPart.normalized();
      const auto [roll, pitch, yaw] = rollPitchYaw(pose.rotation);
      const glm::dvec3& t = pose.translation;
      add("<origin xyz=\"{} {} {}\" rpy=\"{} {} {}\"/>", t.x, t.y, t.z, roll, pitch, yaw);
    }
    add("<parent link=\"{}\"/><child link=\"{}\"/></joint>\n", xmlText(parent), xmlText(names_[index]));
  }

  const AssemblyTree& tree_;
  const std::vector<fs::path>& meshes_;
  TakenNames links_, joints_;
  std::string root_;
  std::vector<std::string> names_;  ///< Of links, by node.
  std::map<Paint, std::size_t> materials_;
  std::string text_;
};

/// An angle within a turn, from -pi to pi.
double withinTurn(double angle) {
  return std::remainder(angle, 2.0 * std::numbers::pi);
}

}  // namespace

std::array<double, 3> rollPitchYaw(const glm::dquat& q) {
  // Sums in which half the pitch stands alone: with yaw * pitch * roll multiplied out, they are sin(pitch / 2 + pi / 4)
  // and cos(pitch / 2 + pi / 4) times cosine and sine of half of yaw - roll and of yaw + roll.
  const double cosDifference = q.w + q.y, sinDifference = q.z - q.x;
  const double cosSum = q.w - q.y, sinSum = q.z + q.x;
  const double pitch =
      2.0 * std::atan2(std::hypot(cosDifference, sinDifference), std::hypot(cosSum, sinSum)) -
      std::numbers::pi / 2.0;
  const double halfSum = std::atan2(sinSum, cosSum),
               halfDifference = std::atan2(sinDifference, cosDifference);
  return {withinTurn(halfSum - halfDifference), pitch, withinTurn(halfSum + halfDifference)};
}

UrdfExport exportUrdf(const Scene& scene, std::span<const Scene::PartPtr> parts,
                      const std::filesystem::path& file, const ProgressCallback& progress) {
  const AssemblyTree tree = assemblyTree(scene, parts);
  checkReplaceable(file);
  UrdfExport result;
  result.folder = file.parent_path() / (fileNameOf(file.stem().string()) + "_meshes");
  makeFolder(result.folder);
  result.meshes = meshFiles(tree, result.folder);
  const auto count = static_cast<double>(tree.geometries.size());
  for (std::size_t i = 0; i < tree.geometries.size(); ++i) {
    const Scene::PartPtr part = unplaced(tree.geometries[i]);
    const auto at = static_cast<double>(i);
    exportMesh({&part, 1}, MeshFileKind::StlBinary, 1.0, result.meshes[i],
               stageCallback(progress, at / count, (at + 1.0) / count));
    if (progress && !progress((at + 1.0) / count)) throw Cancelled();
  }
  atomicWrite(file, UrdfText(tree, file, result.meshes).text());
  return result;
}

}  // namespace nearfit
