#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/cli/arguments.h"
#include "app/cli/commands.h"
#include "app/cli/document_options.h"
#include "app/cli/output.h"
#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "core/mesh/check/unrepaired.h"
#include "core/report/scene_export.h"
#include "core/scene/document_load.h"
#include "core/scene/part_check.h"
#include "core/text/utf8.h"

namespace nearfit::cli {
namespace {

using CheckJson = nlohmann::ordered_json;

struct CheckOptions {
  std::vector<std::string> meshes;
  std::string unit, out;
  TessellationOptions tessellation;
  std::string crack, weld, stitch, drop, fill;
  bool clean = false, orient = false, isJson = false;
};

constexpr const char* kCheckFooter =
    "Prints a line for each place: kind, severity, count, length, point in the mesh's frame [m].\n"
    "openEdges            Edges with one face, by loop; the length is that of the loop.\n"
    "hairlineCracks       Open borders nearer to each other than --crack; the length is the max width.\n"
    "nonManifoldEdges     Edges with three faces or more.\n"
    "nonManifoldVertices  Vertices in which sheets of the surface touch.\n"
    "selfIntersections    Pairs of faces that cross or touch elsewhere than where they are joined.\n"
    "invertedShells       Closed components that face the wrong way, by their faces.\n"
    "inconsistentEdges    Edges whose two faces disagree on which side is outside.\n"
    "degenerateFaces, duplicateFaces  Faces without area; faces that repeat others. Those of the file that\n"
    "                     loading left out are mended: the part does not have them.\n"
    "Severity: serious: contact may be wrong there; warning: it is slower, or felt from both sides; note: it "
    "is\n"
    "as it should be.\n"
    "A line for each kind that cannot be repaired, or that the repairs have left, says why.\n"
    "Repairs are made to a copy in this order: weld, clean, stitch, drop, orient, fill. --repair writes it "
    "in\n"
    "the unit of the file, or of --unit (else in metres) for a CAD document; OUT is .stl, .obj or .ply.\n"
    "Lengths are in metres, or have a unit: --weld 0.01mm. Of a CAD document each shape is checked, or that "
    "of\n"
    "FILE#KEY; the mesh is then that of its tessellation.\n"
    "The exit code does not depend on what is found.\n"
    "Example: nearfit-cli check --unit mm lid.stl --repair lid-closed.stl --stitch 0.05mm --fill 2mm "
    "--orient";

/// Nullopt for an empty text.
std::optional<double> lengthOf(const std::string& option, const std::string& text) {
  return text.empty() ? std::nullopt : std::optional(parseLength(option, text));
}

MeshRepairs chosenRepairs(const CheckOptions& options) {
  RepairChoice choice;
  choice.weld = lengthOf("--weld", options.weld);
  choice.stitch = lengthOf("--stitch", options.stitch);
  choice.drop = lengthOf("--drop", options.drop);
  choice.fill = lengthOf("--fill", options.fill);
  choice.clean = options.clean;
  choice.orient = options.orient;
  MeshRepairs repairs = repairsOf(choice);
  checkRepairs(repairs);
  return repairs;
}

MeshFileKind repairedKind(const std::string& out) {
  const std::optional<ExportKind> kind = exportKindOf(out);
  const std::optional<MeshFileKind> mesh = kind ? meshKindOf(*kind) : std::nullopt;
  if (!mesh)
    throw UsageError(out, "its suffix is not that of a mesh that can be written", "use .stl, .obj or .ply");
  return *mesh;
}

std::string findingText(const MeshFinding& finding) {
  std::string text =
      fmt::format("  {:<20} {:<8} {}", wordOf(finding.kind), wordOf(finding.severity), finding.count);
  if (finding.length > 0.0) fmt::format_to(std::back_inserter(text), ", length {:.6g} m", finding.length);
  const glm::dvec3& p = finding.point;
  if (finding.hasPlace)
    fmt::format_to(std::back_inserter(text), ", at ({:.6g}, {:.6g}, {:.6g})", p.x, p.y, p.z);
  return text + (finding.isMended ? ", mended on loading\n" : "\n");
}

/// @param made  Repairs before the check.
std::string findingsText(const MeshCheck& check, const MeshRepairs& made) {
  std::string text = check.findings.empty() ? "  no findings\n" : "";
  for (const MeshFinding& finding : check.findings)
    text += findingText(finding);
  for (std::size_t i = 0; i < kFindingKinds; ++i) {
    const FindingTotal& total = check.totals[i];
    const std::string_view kind = wordOf(static_cast<FindingKind>(i));
    if (total.places > MeshCheck::kMaxPlaces)
      fmt::format_to(std::back_inserter(text), "  {} has {} places, {} in all\n", kind, total.places,
                     total.count);
    if (total.isCut)
      fmt::format_to(std::back_inserter(text), "  {}: the search ended at a limit; there may be more\n",
                     kind);
  }
  for (const UnrepairedKind& left : unrepairedKinds(check, made)) {
    fmt::format_to(std::back_inserter(text), "  {}: {}cannot be repaired: {}\n", wordOf(left.kind),
                   left.areAll ? "" : "some ", left.reason);
  }
  return text;
}

std::string volumeText(const std::optional<double>& volume) {
  return volume ? fmt::format("{:.6g} m^3", *volume) : std::string("none");
}

std::string repairText(const GeometryRepair& repair) {
  std::string text = "repaired\n";
  for (const RepairStep& step : repair.steps) {
    fmt::format_to(std::back_inserter(text), "  {:<11} {} changed, {} faces added, {} removed, {} left\n",
                   wordOf(step.repair.kind), step.changed, step.addedFaces, step.removedFaces, step.left);
    if (step.wallFaces > 0)
      fmt::format_to(std::back_inserter(text), "              {} of the removed faces were walls inside\n",
                     step.wallFaces);
  }
  const MeshChange& change = repair.change;
  fmt::format_to(std::back_inserter(text),
                 "  moved       {:.6g} m at most{}\n"
                 "  triangles   {} to {}\n"
                 "  area        {:.6g} to {:.6g} m^2\n"
                 "  volume      {} to {}\n",
                 change.maxDistance, change.isSampled ? " at samples" : "", change.before.triangles,
                 change.after.triangles, change.before.area, change.after.area,
                 volumeText(change.before.volume), volumeText(change.after.volume));
  return text;
}

CheckJson findingPointJson(const glm::dvec3& p) {
  return {p.x, p.y, p.z};
}

CheckJson findingJson(const MeshFinding& finding) {
  CheckJson json;
  json["kind"] = wordOf(finding.kind);
  json["severity"] = wordOf(finding.severity);
  json["mended"] = finding.isMended;
  json["count"] = finding.count;
  json["length"] = finding.length;
  json["point"] = finding.hasPlace ? findingPointJson(finding.point) : CheckJson();
  json["box"] = finding.hasPlace ? CheckJson{{"lower", findingPointJson(finding.box.lower)},
                                             {"upper", findingPointJson(finding.box.upper)}}
                                 : CheckJson();
  json["edges"] = CheckJson::array();
  for (const auto& [from, to] : finding.edges)
    json["edges"].push_back(CheckJson::array({findingPointJson(from), findingPointJson(to)}));
  json["triangles"] = CheckJson::array();
  for (const TriangleCorners& t : finding.triangles) {
    json["triangles"].push_back(
        CheckJson::array({findingPointJson(t[0]), findingPointJson(t[1]), findingPointJson(t[2])}));
  }
  return json;
}

CheckJson checkJson(const MeshCheck& check) {
  CheckJson json;
  json["crackTolerance"] = check.crackTolerance;
  json["totals"] = CheckJson::object();
  for (std::size_t i = 0; i < kFindingKinds; ++i) {
    const FindingTotal& total = check.totals[i];
    json["totals"][std::string(wordOf(static_cast<FindingKind>(i)))] = {
        {"count", total.count}, {"places", total.places}, {"complete", !total.isCut}};
  }
  json["findings"] = CheckJson::array();
  for (const MeshFinding& finding : check.findings)
    json["findings"].push_back(findingJson(finding));
  return json;
}

CheckJson sideJson(const MeshChange::Side& side) {
  return {{"triangles", side.triangles},
          {"openEdges", side.openEdges},
          {"components", side.components},
          {"area", side.area},
          {"volume", side.volume ? CheckJson(*side.volume) : CheckJson()}};
}

CheckJson repairJson(const GeometryRepair& repair) {
  CheckJson json;
  json["steps"] = CheckJson::array();
  for (const RepairStep& step : repair.steps) {
    json["steps"].push_back({{"kind", wordOf(step.repair.kind)},
                             {"size", step.repair.size},
                             {"changed", step.changed},
                             {"addedFaces", step.addedFaces},
                             {"removedFaces", step.removedFaces},
                             {"wallFaces", step.wallFaces},
                             {"left", step.left}});
  }
  json["maxDistance"] = repair.change.maxDistance;
  json["before"] = sideJson(repair.change.before);
  json["after"] = sideJson(repair.change.after);
  return json;
}

void writeRepaired(const PartGeometryPtr& geometry, double metresPerUnit, const std::string& out) {
  Part part;
  part.name = "Repaired";
  part.geometry = geometry;
  const std::vector<Scene::PartPtr> parts{std::make_shared<const Part>(std::move(part))};
  exportMesh(parts, repairedKind(out), metresPerUnit, out);
}

/// @param name  That of the file, with the key of a shape of a document.
void reportCheck(const std::string& name, const PartGeometryPtr& geometry, double metresPerUnit,
                 const MeshRepairs& repairs, const CheckOptions& options) {
  const MeshCheckOptions checking{lengthOf("--crack", options.crack).value_or(0.0)};
  const MeshCheck before = checkPart(*geometry, checking);
  CheckJson json;
  json["file"] = isUtf8(name) ? name : printableText(name);
  json["triangles"] = geometry->mesh.triangles().size();
  json["check"] = checkJson(before);
  json["warnings"] = geometry->report.warnings;
  std::string text =
      fmt::format("{}\n  triangles            {}\n", oneLine(name), geometry->mesh.triangles().size()) +
      findingsText(before, geometry->repairs);
  for (const std::string& warning : geometry->report.warnings)
    text += "  on loading           " + oneLine(warning) + "\n";
  if (!repairs.empty()) {
    const GeometryRepair repair = repairGeometry(*geometry, repairs);
    const PartGeometryPtr& after = repair.geometry ? repair.geometry : geometry;
    if (!options.out.empty()) writeRepaired(after, metresPerUnit, options.out);
    const MeshCheck left = checkMesh(after->mesh, checking);
    json["repair"] = repairJson(repair);
    json["checkAfter"] = checkJson(left);
    text += repairText(repair) + findingsText(left, repairs);
    if (!options.out.empty()) text += oneLine(fmt::format("wrote {}", options.out)) + "\n";
  }
  print(options.isJson ? json.dump() + "\n" : text);
}

/// Checks a mesh file, a shape of a document, or each shape of one.
void checkFile(const std::string& name, double metresPerUnit, const MeshRepairs& repairs,
               const CheckOptions& options) {
  const FileArgument argument = fileArgumentOf(name);
  const Tessellation tessellation = tessellationOf(options.tessellation);
  // A repaired mesh needs a file of its own: several shapes are refused then.
  if (!isDocumentFile(argument.file) || !argument.shape.empty() || !options.out.empty()) {
    reportCheck(name, loadArgument(argument, metresPerUnit, tessellation), metresPerUnit, repairs, options);
    return;
  }
  const LoadedDocument document = loadDocument(argument.file, metresPerUnit, tessellation);
  for (const std::string& warning : document.warnings)
    printError(fmt::format("warning: {}: {}", name, warning));
  for (const PartGeometryPtr& shape : document.shapes) {
    if (shape == nullptr) continue;
    const bool isOne = document.shapes.size() == 1;
    reportCheck(isOne ? name : fmt::format("{}#{}", name, shape->shapeKey), shape, metresPerUnit, repairs,
                options);
  }
}

void checkCheckOptions(const CheckOptions& options, const MeshRepairs& repairs) {
  tessellationOf(options.tessellation);
  if (options.out.empty()) return;
  if (repairs.empty())
    throw UsageError("--repair", "no repair is chosen",
                     "add --weld, --stitch, --clean, --drop, --orient or --fill");
  if (options.meshes.size() > 1)
    throw UsageError("--repair", "there is more than one file to repair", "repair one file at a time");
  repairedKind(options.out);
  const std::filesystem::path mesh = fileArgumentOf(options.meshes.front()).file;
  checkTarget(options.out, std::span(&mesh, 1));
}

void runCheck(const CheckOptions& options) {
  std::vector<std::string> files;
  for (const std::string& name : options.meshes)
    files.push_back(fileArgumentOf(name).file);
  const double metresPerUnit = unitOfFiles(options.unit, files);
  const MeshRepairs repairs = chosenRepairs(options);
  checkCheckOptions(options, repairs);
  printCacheWarnings();
  reportEach(options.meshes,
             [&](const std::string& name) { checkFile(name, metresPerUnit, repairs, options); });
}

}  // namespace

void addCheckCommand(CLI::App& program) {
  const auto options = std::make_shared<CheckOptions>();
  CLI::App* command = program.add_subcommand(
      "check", "Finds what is wrong with meshes, and where; repairs a copy, and says what that changed.");
  command
      ->add_option(
          "mesh", options->meshes,
          "Mesh files (STL, OBJ, PLY, OFF), CAD documents (STEP, IGES, BREP, glTF, 3MF, URDF), or shapes of "
          "these (FILE#KEY)")
      ->required()
      ->type_name("FILE");
  command->add_option("--unit", options->unit, kFileUnitHelp);
  addTessellationOptions(*command, options->tessellation);
  command->add_flag("--json", options->isJson, "Print one JSON object per file, each on its own line");
  const auto addLength = [command](const char* name, std::string& value, const char* help) {
    command->add_option(name, value, help)->type_name("LENGTH");
  };
  addLength("--crack", options->crack,
            "Max width of a hairline crack; default: a ten thousandth of the diagonal");
  command->add_option("--repair", options->out, "Write the repaired mesh")->type_name("OUT");
  addLength("--weld", options->weld, "Merge vertices nearer than this");
  addLength("--stitch", options->stitch, "Close cracks: join open borders nearer than this");
  command->add_flag("--clean", options->clean, "Remove faces without area and faces that repeat others");
  addLength("--drop", options->drop, "Remove components whose box has a diagonal of at most this");
  command->add_flag("--orient", options->orient, "Make faces agree, and turn closed shells outside out");
  addLength("--fill", options->fill, "Fill holes whose box has a diagonal of at most this");
  command->footer(kCheckFooter);
  command->callback([options] { runCheck(*options); });
}

}  // namespace nearfit::cli
