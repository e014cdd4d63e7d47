// URDF by urdfdom: links where they are when all joints are at zero.
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <Message_ProgressRange.hxx>
#include <Standard_Failure.hxx>
#include <Standard_OutOfMemory.hxx>
#include <TopoDS_Shape.hxx>
#include <TopoDS_Solid.hxx>
#include <console_bridge/console.h>
#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>
#include <gp_Ax2.hxx>
#include <gp_Dir.hxx>
#include <gp_Pnt.hxx>
#include <urdf_model/link.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include "app/import/companion_list.h"
#include "app/import/document_builder.h"
#include "app/import/gltf_scan.h"
#include "app/import/import_job.h"
#include "app/import/placed_mesh.h"
#include "app/import/shape_mesher.h"
#include "app/import/solid_bodies.h"
#include "core/base/error.h"
#include "core/files/input_file.h"
#include "core/files/sha256.h"
#include "core/import/companion_files.h"
#include "core/import/document_file.h"
#include "core/import/mesh_file_check.h"
#include "core/import/mesh_import.h"
#include "core/text/utf8.h"

namespace nearfit::importer {
namespace {

/// OpenCASCADE's units of a metre: its tolerances suit millimetres.
constexpr double kMillimetres = 1000.0;
/// Elements within each other: a robot has five. A parser of XML recurses into them.
constexpr int kMaxXmlDepth = 200;

/// Keeps the last error that the parser tells.
class LastError : public console_bridge::OutputHandler {
 public:
  void log(const std::string& text, console_bridge::LogLevel level, const char* /*file*/,
           int /*line*/) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR) text_ = text;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

void checkXmlDepth(const ImportJob& job) {
  int depth = 0;
  for (std::size_t i = 0; i + 1 < job.bytes.size(); ++i) {
    if (job.bytes[i] == '/' && job.bytes[i + 1] == '>') --depth;
    if (job.bytes[i] != '<') continue;
    const char next = job.bytes[i + 1];
    if (next == '/') {
      --depth;
    } else if (next != '!' && next != '?' && ++depth > kMaxXmlDepth) {
      throw FileError(job.file.string(),
                      fmt::format("its elements are nested more than {} deep", kMaxXmlDepth),
                      "it is damaged");
    }
  }
}

RigidTransform transformOf(const urdf::Pose& pose) {
  const glm::dquat rotation(pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z);
  const RigidTransform transform{rotation, {pose.position.x, pose.position.y, pose.position.z}};
  return transform.isFinite() ? transform.normalized() : RigidTransform{};
}

std::string lowerExtension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension.empty() ? extension : extension.substr(1);
}

bool isGltf(const std::filesystem::path& mesh) {
  const std::string extension = lowerExtension(mesh);
  return extension == "gltf" || extension == "glb";
}

/// A glTF file as if it were imported by itself, without a sign of its progress and without its hash.
ImportJob gltfJob(const std::filesystem::path& file) {
  ImportJob job;
  job.file = file;
  job.format = DocumentFormat::Gltf;
  job.stem = file.stem().string();
  checkMeshFile(file);
  job.bytes = readWholeFile(file);
  job.progress = [](double) {};
  job.endStage = [](const char*) {};
  return job;
}

/// Triangles of all that a glTF file places: some gigabyte of them.
constexpr std::size_t kMaxPlacedTriangles = 10'000'000;

/// All that a document of triangles places, as one mesh.
struct PlacedTriangles {
  std::vector<glm::dvec3> vertices;
  std::vector<Triangle> triangles;
  TriangleColours colours;
};

/// The colour of a triangle's face; std::nullopt: it has the colour of its node.
std::optional<CadColour> ownColour(const CadShape& shape, std::size_t triangle) {
  return shape.faceColours.empty() ? std::nullopt
                                   : shape.faceColours[shape.surfaces.faceOfTriangle[triangle]];
}

/// Throws FileError if it is too much.
PlacedTriangles placedTriangles(const CadDocument& document, const std::filesystem::path& file) {
  PlacedTriangles all;
  std::vector<RigidTransform> meshFromNode;
  for (const CadNode& node : document.nodes) {
    const RigidTransform parent =
        node.parent < 0 ? RigidTransform{} : meshFromNode[static_cast<std::size_t>(node.parent)];
    const RigidTransform placed = (parent * node.parentFromNode).normalized();
    meshFromNode.push_back(placed);
    if (node.shape < 0) continue;
    const CadShape& shape = document.shapes[static_cast<std::size_t>(node.shape)];
    if (all.triangles.size() + shape.triangles.size() > kMaxPlacedTriangles ||
        all.vertices.size() + shape.vertices.size() > 3 * kMaxPlacedTriangles)
      throw FileError(file.string(), fmt::format("it places more than {} triangles", kMaxPlacedTriangles),
                      "export it coarser");
    const auto first = static_cast<std::uint32_t>(all.vertices.size());
    for (const glm::dvec3& vertex : shape.vertices)
      all.vertices.push_back(placed.applyToPoint(vertex));
    for (std::size_t i = 0; i < shape.triangles.size(); ++i) {
      const Triangle& t = shape.triangles[i];
      all.triangles.push_back({first + t[0], first + t[1], first + t[2]});
      const std::optional<CadColour> own = ownColour(shape, i);
      all.colours.add(own ? own : node.colour);
    }
  }
  return all;
}

/// Geometry of a link, with its place in it.
struct LinkGeometry {
  urdf::GeometrySharedPtr geometry;
  RigidTransform linkFromGeometry;
  std::optional<CadColour> colour;
};

std::optional<CadColour> colourOf(const urdf::MaterialSharedPtr& material) {
  if (!material) return std::nullopt;
  CadColour colour{material->color.r, material->color.g, material->color.b};
  for (float& c : colour)
    c = std::isfinite(c) ? std::clamp(c, 0.0F, 1.0F) : 0.0F;
  return colour;
}

std::vector<LinkGeometry> visualsOf(const urdf::Link& link) {
  std::vector<LinkGeometry> all;
  for (const urdf::VisualSharedPtr& visual : link.visual_array)
    if (visual && visual->geometry)
      all.push_back({visual->geometry, transformOf(visual->origin), colourOf(visual->material)});
  return all;
}

std::vector<LinkGeometry> collisionsOf(const urdf::Link& link) {
  std::vector<LinkGeometry> all;
  for (const urdf::CollisionSharedPtr& collision : link.collision_array)
    if (collision && collision->geometry)
      all.push_back({collision->geometry, transformOf(collision->origin), std::nullopt});
  return all;
}

class UrdfReader {
 public:
  explicit UrdfReader(const ImportJob& job)
      : job_(job), files_(job.file, {job.bytes.data(), job.bytes.size()}), builder_(job) {}

  CadDocument read() {
    checkXmlDepth(job_);
    const urdf::ModelInterfaceSharedPtr model = parse();
    CadNode robot;
    robot.name = cleanName(model->getName());
    const std::int32_t top = builder_.addNode(robot);
    // On a list of its own: a chain of links may be of any length.
    std::vector<std::pair<urdf::LinkConstSharedPtr, RigidTransform>> links{
        {model->getRoot(), RigidTransform{}}};
    for (std::size_t i = 0; i < links.size(); ++i) {
      const auto [link, robotFromLink] = links[i];
      if (i >= kMaxDocumentNodes)
        throw FileError(job_.file.string(), "its links form a loop, or are too many", "check its joints");
      addLink(*link, robotFromLink, top);
      for (const urdf::JointSharedPtr& joint : link->child_joints) {
        const urdf::LinkConstSharedPtr child = joint ? model->getLink(joint->child_link_name) : nullptr;
        if (child)
          links.emplace_back(
              child, (robotFromLink * transformOf(joint->parent_to_joint_origin_transform)).normalized());
      }
      job_.progress(static_cast<double>(i + 1) / static_cast<double>(links.size()));
    }
    CadDocument document = builder_.take();
    std::move(companions_).giveTo(document);
    return document;
  }

 private:
  urdf::ModelInterfaceSharedPtr parse() const {
    LastError error;
    console_bridge::useOutputHandler(&error);
    const urdf::ModelInterfaceSharedPtr model =
        urdf::parseURDF(std::string(job_.bytes.begin(), job_.bytes.end()));
    console_bridge::restorePreviousOutputHandler();
    job_.endStage("read");
    if (model && model->getRoot()) return model;
    throw FileError(job_.file.string(),
                    "it is no URDF file" +
                        (error.text().empty() ? std::string() : " (" + printableText(error.text()) + ")"),
                    "check it by check_urdf; expand templates by xacro first");
  }

  void addLink(const urdf::Link& link, const RigidTransform& robotFromLink, std::int32_t top) {
    const std::string name = cleanName(link.name);
    const std::vector<LinkGeometry> visuals = visualsOf(link), collisions = collisionsOf(link);
    // All of them, whatever is wanted and can be read, so that each run lists the same.
    for (const std::vector<LinkGeometry>* all : {&visuals, &collisions})
      for (const LinkGeometry& each : *all)
        noteMesh(*each.geometry);
    std::vector<std::pair<LinkGeometry, std::int32_t>> shapes = shapesOf(visuals, name);
    if (shapes.empty()) shapes = shapesOf(collisions, name);
    if (shapes.empty()) return;
    CadNode node;
    node.parent = top;
    node.name = name;
    node.parentFromNode = robotFromLink;
    if (shapes.size() == 1) {
      node.parentFromNode = (robotFromLink * shapes[0].first.linkFromGeometry).normalized();
      node.shape = shapes[0].second;
      node.colour = shownColour(shapes[0].first, shapes[0].second);
      builder_.addNode(node);
      return;
    }
    const std::int32_t group = builder_.addNode(node);
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      CadNode child;
      child.parent = group;
      child.name = cleanName(fmt::format("{} {}", name, i + 1));
      child.parentFromNode = shapes[i].first.linkFromGeometry;
      child.shape = shapes[i].second;
      child.colour = shownColour(shapes[i].first, shapes[i].second);
      builder_.addNode(child);
    }
  }

  /// The URDF file's colour of a mesh goes before the mesh's own.
  std::optional<CadColour> shownColour(const LinkGeometry& geometry, std::int32_t shape) const {
    const auto own = meshColours_.find(shape);
    return geometry.colour || own == meshColours_.end() ? geometry.colour : std::optional(own->second);
  }

  std::vector<std::pair<LinkGeometry, std::int32_t>> shapesOf(const std::vector<LinkGeometry>& all,
                                                              const std::string& link) {
    std::vector<std::pair<LinkGeometry, std::int32_t>> shapes;
    for (const LinkGeometry& geometry : all)
      if (const std::int32_t shape = shapeOf(geometry, link); shape >= 0)
        shapes.emplace_back(geometry, shape);
    return shapes;
  }

  std::int32_t shapeOf(const LinkGeometry& of, const std::string& link) {
    const urdf::Geometry& geometry = *of.geometry;
    switch (geometry.type) {
      case urdf::Geometry::MESH:
        return meshShape(static_cast<const urdf::Mesh&>(geometry), of.colour.has_value(), link);
      case urdf::Geometry::BOX: {
        const urdf::Vector3& size = static_cast<const urdf::Box&>(geometry).dim;
        const glm::dvec3 mm = glm::dvec3(size.x, size.y, size.z) * kMillimetres;
        if (!(mm.x > 0.0 && mm.y > 0.0 && mm.z > 0.0)) return refused(link, "a box");
        return solidShape(
            BRepPrimAPI_MakeBox(gp_Pnt(-mm.x / 2, -mm.y / 2, -mm.z / 2), mm.x, mm.y, mm.z).Shape(),
            link + " box");
      }
      case urdf::Geometry::CYLINDER: {
        const auto& cylinder = static_cast<const urdf::Cylinder&>(geometry);
        const double radius = cylinder.radius * kMillimetres, length = cylinder.length * kMillimetres;
        if (!(radius > 0.0 && length > 0.0)) return refused(link, "a cylinder");
        const gp_Ax2 axis(gp_Pnt(0.0, 0.0, -length / 2), gp_Dir(0.0, 0.0, 1.0));
        return solidShape(BRepPrimAPI_MakeCylinder(axis, radius, length).Shape(), link + " cylinder");
      }
      case urdf::Geometry::SPHERE: {
        const double radius = static_cast<const urdf::Sphere&>(geometry).radius * kMillimetres;
        if (!(radius > 0.0)) return refused(link, "a sphere");
        return solidShape(BRepPrimAPI_MakeSphere(radius).Shape(), link + " sphere");
      }
    }
    return -1;
  }

  std::int32_t refused(const std::string& link, const char* what) {
    builder_.warn(fmt::format("Link \"{}\": {} of impossible size is left out.", link, what));
    return -1;
  }

  std::int32_t solidShape(const TopoDS_Shape& solid, const std::string& key) {
    const std::int32_t shape = builder_.addShape(key);
    if (!builder_.isWanted(shape)) return shape;
    MeshRequest request;
    request.body = bodiesOf(solid).front();
    request.isSolid = true;
    request.map = glm::dmat3(1.0 / kMillimetres);
    request.wanted = job_.tessellation;
    builder_.setShape(shape, meshBody(request, Message_ProgressRange()));
    return shape;
  }

  /// Lists the file of a mesh, once.
  void noteMesh(const urdf::Geometry& geometry) {
    if (geometry.type != urdf::Geometry::MESH) return;
    const std::string& name = static_cast<const urdf::Mesh&>(geometry).filename;
    if (noted_.insert(name).second) noteFiles(name);
  }

  void noteFiles(const std::string& name) {
    const FoundFile found = files_.find(name);
    // A file that is never read decides nothing.
    if (found.problem.empty() && !isMeshForUrdf(found.path)) return;
    companions_.add(name, found);
    if (!found.problem.empty() || !isGltf(found.path)) return;
    try {
      const std::string folder = name.substr(0, name.rfind('/') + 1);
      for (const std::string& buffer : scanGltf(gltfJob(found.path)))
        companions_.add(folder + buffer, files_.find(folder + buffer));
    } catch (const FileError&) {
      // The mesh is left out, as its bytes decide; whoever reads it tells why.
    }
  }

  /// @param isPainted  The URDF file gives it a colour.
  std::int32_t meshShape(const urdf::Mesh& mesh, bool isPainted, const std::string& link) {
    // Other formats have no colours of their own that a shape could have without them.
    const bool dropsColours = isPainted && isGltf(mesh.filename);
    const auto [at, isNew] =
        meshes_.try_emplace({mesh.filename, mesh.scale.x, mesh.scale.y, mesh.scale.z, dropsColours}, -1);
    if (!isNew) return at->second;
    const auto leftOut = [&](const std::string& problem) {
      builder_.warn(fmt::format("Link \"{}\": the mesh {} is left out: {}.", link, mesh.filename, problem));
      return -1;
    };
    const FoundFile found = files_.find(mesh.filename);
    if (!found.problem.empty()) return leftOut(found.problem);
    if (!isMeshForUrdf(found.path)) {
      const std::string extension = lowerExtension(found.path);
      return leftOut((extension == "dae" ? "COLLADA (.dae)" : '.' + extension) +
                     " is not read; convert it to glTF, STL or OBJ");
    }
    const glm::dmat3 scale(mesh.scale.x, 0.0, 0.0, 0.0, mesh.scale.y, 0.0, 0.0, 0.0, mesh.scale.z);
    if (!splitMap(scale)) return leftOut("its scale is zero or not finite");
    at->second = builder_.addShape(mesh.filename);
    if (!builder_.isWanted(at->second)) return at->second;
    try {
      builder_.setShape(at->second, isGltf(found.path)
                                        ? gltfShape(found.path, scale, at->second, dropsColours)
                                        : meshFileShape(found.path, scale));
      noteFiles(mesh.filename);
    } catch (const FileError& error) {
      return leftOut(error.problem());
    } catch (const Standard_OutOfMemory&) {
      throw;
    } catch (const Standard_Failure& failure) {
      return leftOut(fmt::format("OpenCASCADE cannot read it: {}", failure.GetMessageString()));
    }
    return at->second;
  }

  static CadShape meshFileShape(const std::filesystem::path& file, const glm::dmat3& scale) {
    const ImportedMesh imported = importMesh(file, MeshBuildOptions{});
    CadShape shape = triangleShape(imported.mesh.vertices(), imported.mesh.triangles(), scale);
    for (const std::string& warning : imported.report.warnings)
      addWarning(shape.warnings, warning);
    return shape;
  }

  /// One shape of all nodes. A colour that they share is noted for the nodes of the shape.
  CadShape gltfShape(const std::filesystem::path& file, const glm::dmat3& scale, std::int32_t index,
                     bool dropsColours) {
    ImportJob job = gltfJob(file);
    job.sha256 = sha256OfBytes(job.bytes);
    const CadDocument document = readGltf(job);
    PlacedTriangles placed = placedTriangles(document, file);
    const std::optional<CadColour> common = placed.colours.common();
    if (common) meshColours_[index] = *common;
    if (common || dropsColours) placed.colours = {};
    CadShape shape = triangleShape(placed.vertices, placed.triangles, scale, placed.colours);
    for (const std::string& warning : document.warnings)
      addWarning(shape.warnings, warning);
    return shape;
  }

  const ImportJob& job_;
  UrdfFiles files_;
  DocumentBuilder builder_;
  CompanionList companions_;
  std::set<std::string> noted_;
  std::map<std::tuple<std::string, double, double, double, bool>, std::int32_t> meshes_;
  std::map<std::int32_t, CadColour> meshColours_;  ///< Colour of all triangles of a shape.
};

}  // namespace

CadDocument readUrdf(const ImportJob& job) {
  return UrdfReader(job).read();
}

}  // namespace nearfit::importer
