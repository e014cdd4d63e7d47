#include "core/report/threemf_export.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "core/files/zip_file.h"
#include "core/report/assembly_tree.h"
#include "core/text/xml_text.h"

namespace nearfit {
namespace {

constexpr std::string_view kContentTypes =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">"
    "<Default Extension=\"rels\" ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>"
    "<Default Extension=\"model\" ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/>"
    "</Types>\n";
constexpr std::string_view kRelations =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
    "<Relationship Target=\"/3D/3dmodel.model\" Id=\"rel0\" "
    "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>\n";
/// The resource that holds all materials; objects come after it.
constexpr int kMaterials = 1;
/// Text gathered before it is compressed [bytes].
constexpr std::size_t kThreeMfBlock = std::size_t{1} << 18;

struct ThreeMfUnit {
  const char* name;
  double metres;
};
constexpr std::array<ThreeMfUnit, 6> kThreeMfUnits{{{"micron", 1e-6},
                                                    {"millimeter", 1e-3},
                                                    {"centimeter", 1e-2},
                                                    {"inch", 0.0254},
                                                    {"foot", 0.3048},
                                                    {"meter", 1.0}}};

const char* unitName(double metresPerUnit) {
  for (const ThreeMfUnit& unit : kThreeMfUnits)
    if (unit.metres == metresPerUnit) return unit.name;
  throw UsageError("3MF export", fmt::format("the format has no unit of {} m", metresPerUnit),
                   "use um, mm, cm, in, ft or m");
}

using Paint = std::tuple<CadColour, double>;

/// A mesh as it is written: a geometry in a colour.
struct PaintedMesh {
  std::int32_t geometry = -1;
  Paint paint;
  std::uint32_t uses = 0;
  const std::string* onlyName = nullptr;  ///< Of its part, if that is the only one.
  int object = 0;
};

class ThreeMfModel {
 public:
  ThreeMfModel(const AssemblyTree& tree, const std::string& title, double metresPerUnit, ZipFile& zip,
               const ProgressCallback& progress)
      : tree_(tree), title_(title), metresPerUnit_(metresPerUnit), zip_(zip), progress_(progress) {}

  void write() {
    findMeshes();
    add("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"{}\" xml:lang=\"en-US\" "
        "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n"
        "<metadata name=\"Title\">{}</metadata>\n"
        "<metadata name=\"Application\">Nearfit " NEARFIT_VERSION "</metadata>\n<resources>\n",
        unitName(metresPerUnit_), xmlText(title_));
    writeMaterials();
    int next = kMaterials + 1;
    for (PaintedMesh& mesh : meshes_) {
      mesh.object = next++;
      writeMesh(mesh);
    }
    std::vector<int> objectOf(tree_.nodes.size());
    writeParts(objectOf, next);
    writeGroups(objectOf, next);
    add("</resources>\n<build>\n");
    for (std::size_t i = 0; i < tree_.nodes.size(); ++i)
      if (tree_.nodes[i].parent < 0) writePlaced("item", objectOf[i], tree_.nodes[i]);
    add("</build>\n</model>\n");
    flush();
  }

 private:
  template <class... T>
  void add(fmt::format_string<T...> format, T&&... values) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<T>(values)...);
  }
  void flush() {
    zip_.write(text_);
    text_.clear();
  }
  /// Call after each vertex and triangle.
  void step() {
    ++done_;
    if (text_.size() < kThreeMfBlock) return;
    flush();
    if (progress_ && !progress_(static_cast<double>(done_) / static_cast<double>(std::max(done_, steps_))))
      throw Cancelled();
  }

  static Paint paintOf(const Part& part) {
    return {CadColour{part.colour.r, part.colour.g, part.colour.b}, std::clamp(part.opacity, 0.0, 1.0)};
  }

  void findMeshes() {
    std::map<std::pair<std::int32_t, Paint>, std::size_t> known;
    for (const AssemblyNode& node : tree_.nodes) {
      meshOf_.push_back(0);
      if (node.part == nullptr) continue;
      const Paint paint = paintOf(*node.part);
      const auto [at, isNew] = known.try_emplace({node.geometry, paint}, meshes_.size());
      if (isNew) {
        meshes_.push_back({node.geometry, paint, 0, &node.name, 0});
        const TriangleMesh& mesh = node.part->geometry->mesh;
        steps_ += mesh.vertices().size() + mesh.triangles().size();
      }
      ++meshes_[at->second].uses;
      meshOf_.back() = at->second;
    }
  }

  int materialOf(const Paint& paint) {
    return materials_.try_emplace(paint, static_cast<int>(materials_.size())).first->second;
  }

  /// Colour of each triangle as a material; -1 for the object's.
  std::vector<int> materialsOfFaces(const PartGeometry& geometry, double opacity) {
    std::vector<int> materials;
    for (const std::optional<CadColour>& colour : geometry.faceColours)
      materials.push_back(colour ? materialOf({*colour, opacity}) : -1);
    return materials;
  }

  void writeMaterials() {
    for (const PaintedMesh& mesh : meshes_) {
      materialOf(mesh.paint);
      materialsOfFaces(*tree_.geometries[static_cast<std::size_t>(mesh.geometry)], std::get<1>(mesh.paint));
    }
    std::vector<const Paint*> inOrder(materials_.size());
    for (const auto& [paint, index] : materials_)
      inOrder[static_cast<std::size_t>(index)] = &paint;
    add("<basematerials id=\"{}\">\n", kMaterials);
    const auto byteOf = [](double x) { return std::lround(255.0 * std::clamp(x, 0.0, 1.0)); };
    for (std::size_t i = 0; i < inOrder.size(); ++i) {
      const auto& [colour, opacity] = *inOrder[i];
      add("<base name=\"colour {}\" displaycolor=\"#{:02X}{:02X}{:02X}{:02X}\"/>\n", i + 1,
          byteOf(static_cast<double>(colour[0])), byteOf(static_cast<double>(colour[1])),
          byteOf(static_cast<double>(colour[2])), byteOf(opacity));
    }
    add("</basematerials>\n");
  }

  void writeMesh(const PaintedMesh& painted) {
    const PartGeometry& geometry = *tree_.geometries[static_cast<std::size_t>(painted.geometry)];
    const TriangleMesh& mesh = geometry.mesh;
    const bool isSolid = mesh.topology().isClosed() && mesh.topology().isOriented();
    const std::string name = painted.uses == 1 ? *painted.onlyName : geometryName(geometry);
    add("<object id=\"{}\" type=\"{}\" name=\"{}\" pid=\"{}\" pindex=\"{}\"><mesh><vertices>\n",
        painted.object, isSolid ? "model" : "surface", xmlText(name), kMaterials, materialOf(painted.paint));
    for (const glm::dvec3& vertex : mesh.vertices()) {
      const glm::dvec3 v = vertex / metresPerUnit_;
      add("<vertex x=\"{}\" y=\"{}\" z=\"{}\"/>\n", v.x, v.y, v.z);
      step();
    }
    add("</vertices><triangles>\n");
    const std::vector<int> ofFace = materialsOfFaces(geometry, std::get<1>(painted.paint));
    const bool hasColours = !ofFace.empty() && geometry.surfaces != nullptr;
    for (std::size_t i = 0; i < mesh.triangles().size(); ++i) {
      const Triangle& t = mesh.triangles()[i];
      add("<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\"", t[0], t[1], t[2]);
      const int material = hasColours ? ofFace[geometry.surfaces->faceOfTriangle[i]] : -1;
      if (material >= 0) add(" pid=\"{}\" p1=\"{}\"", kMaterials, material);
      add("/>\n");
      step();
    }
    add("</triangles></mesh></object>\n");
  }

  /// Objects that give a name to meshes of several parts.
  void writeParts(std::vector<int>& objectOf, int& next) {
    for (std::size_t i = 0; i < tree_.nodes.size(); ++i) {
      if (tree_.nodes[i].part == nullptr) continue;
      const PaintedMesh& mesh = meshes_[meshOf_[i]];
      objectOf[i] = mesh.object;
      if (mesh.uses == 1) continue;
      objectOf[i] = next++;
      add("<object id=\"{}\" name=\"{}\"><components><component objectid=\"{}\"/></components></object>\n",
          objectOf[i], xmlText(tree_.nodes[i].name), mesh.object);
    }
  }

  /// Members before the groups that they are in, as the format demands.
  void writeGroups(std::vector<int>& objectOf, int& next) {
    std::vector<std::vector<std::size_t>> members(tree_.nodes.size());
    for (std::size_t i = 0; i < tree_.nodes.size(); ++i)
      if (tree_.nodes[i].parent >= 0) members[static_cast<std::size_t>(tree_.nodes[i].parent)].push_back(i);
    for (std::size_t i = tree_.nodes.size(); i-- > 0;) {
      if (tree_.nodes[i].part != nullptr) continue;
      objectOf[i] = next++;
      add("<object id=\"{}\" name=\"{}\"><components>\n", objectOf[i], xmlText(tree_.nodes[i].name));
      for (const std::size_t member : members[i])
        writePlaced("component", objectOf[member], tree_.nodes[member]);
      add("</components></object>\n");
    }
  }

  /// The format multiplies rows: the matrix is transposed.
  void writePlaced(const char* element, int object, const AssemblyNode& node) {
    add("<{} objectid=\"{}\"", element, object);
    if (node.part != nullptr) {
      const glm::dmat4 m = node.part->worldFromPart.normalized().toMatrix();
      add(" transform=\"");
      for (int row = 0; row < 3; ++row)
        add("{} {} {} ", m[row][0], m[row][1], m[row][2]);
      add("{} {} {}\"", m[3][0] / metresPerUnit_, m[3][1] / metresPerUnit_, m[3][2] / metresPerUnit_);
    }
    add("/>\n");
  }

  const AssemblyTree& tree_;
  const std::string& title_;
  const double metresPerUnit_;
  ZipFile& zip_;
  const ProgressCallback& progress_;
  std::string text_;
  std::vector<PaintedMesh> meshes_;
  std::vector<std::size_t> meshOf_;  ///< By node.
  std::map<Paint, int> materials_;
  std::uint64_t done_ = 0, steps_ = 0;
};

}  // namespace

MeshExportSize exportThreeMf(const Scene& scene, std::span<const Scene::PartPtr> parts, double metresPerUnit,
                             const std::filesystem::path& file, const ProgressCallback& progress) {
  unitName(metresPerUnit);
  const AssemblyTree tree = assemblyTree(scene, parts);
  checkReplaceable(file);
  ZipFile zip;
  zip.begin("[Content_Types].xml");
  zip.write(kContentTypes);
  zip.begin("_rels/.rels");
  zip.write(kRelations);
  zip.begin("3D/3dmodel.model");
  ThreeMfModel(tree, assemblyName(file), metresPerUnit, zip, progress).write();
  const std::string bytes = zip.finish();
  if (progress && !progress(1.0)) throw Cancelled();
  atomicWrite(file, bytes);
  MeshExportSize size = meshExportSize(parts, MeshFileKind::StlBinary);
  size.bytes = bytes.size();
  return size;
}

}  // namespace nearfit
