#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/cli/arguments.h"
#include "app/cli/commands.h"
#include "app/cli/document_info.h"
#include "app/cli/document_options.h"
#include "app/cli/joints_text.h"
#include "app/cli/output.h"
#include "core/base/error.h"
#include "core/scene/document_load.h"
#include "core/scene/part_geometry.h"
#include "core/scene/scene.h"
#include "core/scene/scene_file.h"
#include "core/text/utf8.h"

namespace nearfit::cli {
namespace {

using Json = nlohmann::ordered_json;

struct InfoOptions {
  std::vector<std::string> meshes;
  std::string unit;
  TessellationOptions tessellation;
  std::optional<double> density;  ///< [kg/m^3]
  bool isJson = false;
};

const char* yesNo(bool value) {
  return value ? "yes" : "no";
}

std::string pointText(const glm::dvec3& p) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x, p.y, p.z);
}

std::string topologyText(const MeshTopology& topology, std::size_t edges) {
  return fmt::format(
      "  closed      {}\n"
      "  oriented    {}\n"
      "  components  {}\n"
      "  edges       {}: {} open, {} non-manifold, {} inconsistent\n",
      yesNo(topology.isClosed()), yesNo(topology.isOriented()), topology.components, edges,
      topology.openEdges, topology.nonManifoldEdges, topology.inconsistentEdges);
}

std::string featureText(const TriangleMesh& mesh, const NormalConeTree& tree) {
  const FeatureCounts kept = tree.keptFeatures(), all = featuresOf(mesh);
  return fmt::format("  features    {} kept of {}: {} of {} vertices, {} of {} edges, {} of {} faces\n",
                     kept.total(), all.total(), kept.vertices, all.vertices, kept.edges, all.edges,
                     kept.faces, all.faces);
}

std::string sizeText(const PartGeometry& geometry) {
  const Aabb& bounds = geometry.mesh.bounds();
  const MassProperties& mass = geometry.mass;
  return fmt::format(
      "  bounds      {} to {} m, diagonal {:.6g} m\n"
      "  mass        by {}: volume {:.6g} m^3, centre {} m\n",
      pointText(bounds.lower), pointText(bounds.upper), bounds.diagonal(), nameOf(mass.basis), mass.volume,
      pointText(mass.centre));
}

std::string massText(const MassProperties& mass, double density) {
  std::string text =
      fmt::format("  weighs      {:.6g} kg at {:.6g} kg/m^3\n", density * mass.volume, density);
  const glm::dmat3 inertia = density * mass.inertia;
  // By rows: glm's matrices are columns, but this one is symmetric.
  for (int i = 0; i < 3; ++i) {
    text += fmt::format("  {}{} kg m^2\n", i == 0 ? "inertia     " : "            ", pointText(inertia[i]));
  }
  return text;
}

/// Returns the origin of its hierarchy, which is made now if it does not exist yet.
HierarchyOrigin originOf(const PartGeometry& geometry) {
  geometry.tree();
  return *geometry.hierarchy->origin();
}

/// Memory of the hierarchy, with its mesh unless that is the part's own.
std::size_t bytesOf(const TriangleMesh& mesh, const NormalConeTree& tree) {
  return tree.byteSize() + (tree.mesh().sharesArraysOf(mesh) ? 0 : tree.mesh().byteSize());
}

std::string infoText(const std::string& name, const PartGeometry& geometry, std::optional<double> density) {
  const TriangleMesh& mesh = geometry.mesh;
  std::string text = fmt::format("{}\n  triangles   {}\n  vertices    {}\n", oneLine(name),
                                 mesh.triangles().size(), mesh.vertices().size());
  text += topologyText(mesh.topology(), mesh.edges().size()) + featureText(mesh, geometry.tree()) +
          sizeText(geometry);
  const NormalConeTree& tree = geometry.tree();
  text += fmt::format("  searched    {} triangles, once flats are merged; within {:.3g} m of the mesh\n",
                      tree.mesh().triangles().size(), tree.deviation());
  if (density) text += massText(geometry.mass, *density);
  const HierarchyOrigin origin = originOf(geometry);
  text += fmt::format(
      "  hierarchy   {} in {:.3g} ms\n"
      "  bytes       {}: {} mesh, {} hierarchy\n"
      "  SHA-256     {}\n",
      origin.isFromCache ? "from the cache" : "built", 1e3 * origin.seconds,
      mesh.byteSize() + bytesOf(mesh, tree), mesh.byteSize(), bytesOf(mesh, tree), geometry.sha256);
  for (const std::string& warning : geometry.report.warnings)
    text += "  warning     " + oneLine(warning) + "\n";
  return text;
}

Json countsJson(const FeatureCounts& counts) {
  return {{"vertices", counts.vertices},
          {"edges", counts.edges},
          {"faces", counts.faces},
          {"total", counts.total()}};
}

Json pointJson(const glm::dvec3& p) {
  return {p.x, p.y, p.z};
}

Json massJson(const MassProperties& mass, std::optional<double> density) {
  Json json = {{"basis", nameOf(mass.basis)}, {"volume", mass.volume}, {"centre", pointJson(mass.centre)}};
  if (!density) return json;
  const glm::dmat3 inertia = *density * mass.inertia;
  json["density"] = *density;
  json["mass"] = *density * mass.volume;
  json["inertia"] = {pointJson(inertia[0]), pointJson(inertia[1]), pointJson(inertia[2])};
  return json;
}

Json infoJson(const std::string& name, const PartGeometry& geometry, std::optional<double> density) {
  const TriangleMesh& mesh = geometry.mesh;
  const MeshTopology& topology = mesh.topology();
  Json json;
  json["file"] = isUtf8(name) ? name : printableText(name);
  json["sha256"] = geometry.sha256;
  json["metresPerUnit"] = geometry.metresPerUnit;
  json["triangles"] = mesh.triangles().size();
  json["vertices"] = mesh.vertices().size();
  json["closed"] = topology.isClosed();
  json["oriented"] = topology.isOriented();
  json["components"] = topology.components;
  json["edges"] = {{"total", mesh.edges().size()},
                   {"open", topology.openEdges},
                   {"nonManifold", topology.nonManifoldEdges},
                   {"inconsistent", topology.inconsistentEdges},
                   {"stitched", geometry.report.stitchedEdges}};
  json["features"] = {{"kept", countsJson(geometry.tree().keptFeatures())},
                      {"all", countsJson(featuresOf(mesh))}};
  json["searched"] = {{"triangles", geometry.tree().mesh().triangles().size()},
                      {"deviation", geometry.tree().deviation()}};
  json["bounds"] = {{"lower", pointJson(mesh.bounds().lower)}, {"upper", pointJson(mesh.bounds().upper)}};
  json["mass"] = massJson(geometry.mass, density);
  const HierarchyOrigin origin = originOf(geometry);
  json["hierarchy"] = {{"from", origin.isFromCache ? "cache" : "building"}, {"seconds", origin.seconds}};
  json["bytes"] = {{"mesh", mesh.byteSize()}, {"hierarchy", bytesOf(mesh, geometry.tree())}};
  json["turnedInsideOut"] = geometry.report.turnedInsideOut;
  json["warnings"] = geometry.report.warnings;
  return json;
}

bool isSceneFile(const std::string& name) {
  return std::filesystem::path(name).extension() == ".nearfit";
}

std::string movingName(const Scene& scene) {
  if (scene.movingGroup())
    return fmt::format("group {}, led by {}", scene.findGroup(*scene.movingGroup())->name,
                       scene.get(*scene.movingPart()).name);
  return scene.movingPart() ? scene.get(*scene.movingPart()).name : std::string("none");
}

std::string sceneText(const std::string& name, const Scene& scene) {
  return fmt::format("{}\n  parts       {}\n  groups      {}\n  moving      {}\n  joints      {}\n",
                     oneLine(name), scene.parts().size(), scene.groups().size(), oneLine(movingName(scene)),
                     scene.joints().size()) +
         jointsText(scene);
}

Json sceneJson(const std::string& name, const Scene& scene) {
  Json json;
  json["file"] = isUtf8(name) ? name : printableText(name);
  json["parts"] = scene.parts().size();
  json["groups"] = scene.groups().size();
  json["moving"] = scene.movingPart() ? Json(scene.get(*scene.movingPart()).name) : Json();
  json["movingGroup"] = scene.movingGroup() ? Json(scene.findGroup(*scene.movingGroup())->name) : Json();
  json["joints"] = jointsJson(scene);
  return json;
}

std::string reportOn(const std::string& name, double metresPerUnit, const InfoOptions& options) {
  if (isSceneFile(name)) {
    const Scene scene = readSceneFile(name);
    return options.isJson ? sceneJson(name, scene).dump() + "\n" : sceneText(name, scene);
  }
  const FileArgument argument = fileArgumentOf(name);
  if (isDocumentFile(argument.file) && argument.shape.empty()) {
    const LoadedDocument document =
        loadDocument(argument.file, metresPerUnit, tessellationOf(options.tessellation));
    return options.isJson ? documentJson(name, document, options.density).dump() + "\n"
                          : documentText(name, document, options.density);
  }
  const PartGeometryPtr geometry =
      loadArgument(argument, metresPerUnit, tessellationOf(options.tessellation));
  return options.isJson ? infoJson(name, *geometry, options.density).dump() + "\n"
                        : infoText(name, *geometry, options.density);
}

void runInfo(const InfoOptions& options) {
  tessellationOf(options.tessellation);
  std::vector<std::string> files;
  for (const std::string& name : options.meshes) {
    if (!isSceneFile(name)) files.push_back(fileArgumentOf(name).file);
  }
  const double metresPerUnit = unitOfFiles(options.unit, files);
  if (options.density) checkDensity(*options.density);
  printCacheWarnings();
  reportEach(options.meshes, [&](const std::string& name) { print(reportOn(name, metresPerUnit, options)); });
}

}  // namespace

void addInfoCommand(CLI::App& program) {
  const auto options = std::make_shared<InfoOptions>();
  CLI::App* command = program.add_subcommand("info",
                                             "Prints the size, mass and topology of meshes, and where they "
                                             "are open or inconsistent; of CAD documents, their "
                                             "shapes and tree; of scenes, their parts and joints.");
  command
      ->add_option(
          "mesh", options->meshes,
          "Mesh files (STL, OBJ, PLY, OFF), CAD documents (STEP, IGES, BREP, glTF, 3MF, URDF) or scene files "
          "(*.nearfit)")
      ->required()
      ->type_name("FILE");
  command->add_option("--unit", options->unit, kFileUnitHelp);
  addTessellationOptions(*command, options->tessellation);
  command->add_option("--density", options->density, "Also print mass and inertia, for this density [kg/m^3]")
      ->type_name("D");
  command->add_flag("--json", options->isJson, "Print one JSON object per file, each on its own line");
  command->footer(
      "closed       Every edge has two faces; open edges have one, non-manifold ones three or more.\n"
      "oriented     The two faces of each edge agree on which side is outside (else: inconsistent).\n"
      "components   Sets of faces that are connected through edges.\n"
      "features     Vertices, edges and faces that can carry a local minimum distance, out of all;\n"
      "             the hierarchy leaves the others out.\n"
      "searched     Triangles once each flat is cut into as few as its outline needs, and how far that\n"
      "             mesh can be from the file's: some roundings of the file's numbers.\n"
      "mass         By volume integrals if the mesh is closed and oriented, else by its oriented\n"
      "             bounding box.\n"
      "inertia      About the centre, in the mesh's frame, by rows; for the given density.\n"
      "hierarchy    What distance queries search: built now, or read from the cache (see nearfit-cli "
      "cache).\n"
      "bytes        Memory that it takes.\n"
      "shape        Of a CAD document: key, instances, triangles, tessellation in effect, and volume of its "
      "mesh\n"
      "             (and of the exact solid). FILE#KEY reports on the mesh of one shape in full.\n"
      "tree         Of a CAD document: assemblies, and instances with the keys of their shapes.\n"
      "joint N      Of a scene: what keeps a part, with the number that nearfit-cli scene release takes.\n"
      "kept         Of a scene: how far a part is off its joints.\n"
      "Lengths are in metres. A file that cannot be read gets a line on stderr, the others are still "
      "reported,\n"
      "and the exit code is 1.\n"
      "Example: nearfit-cli info --unit mm peg.stl hole.stl\n"
      "         nearfit-cli info vise.step");
  command->callback([options] { runInfo(*options); });
}

}  // namespace nearfit::cli
