#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/report/html/page_sections.h"

namespace nearfit {
namespace {

std::string pathText(const std::filesystem::path& file) {
  return file.string();
}

void putGeometryCells(ReportPageWriter& page, const Part& part) {
  const PartGeometry& geometry = *part.geometry;
  page.cell([&] {
    page.putName(pathText(geometry.file.filename()));
    if (!geometry.shapeKey.empty()) {
      page.put(", shape ");
      page.putName(geometry.shapeKey);
    }
    page.put(" ");
    page.putHash(geometry.sha256);
  });
  page.cell([&] {
    page.put(countOf(geometry.mesh.triangles().size(), "triangle", "triangles"));
    if (geometry.surfaces)
      page.put(fmt::format(", {}", countOf(geometry.surfaces->faces.size(), "face", "faces")));
  });
  page.cell([&] {
    const Aabb& box = geometry.mesh.bounds();
    if (box.isEmpty()) return;
    const glm::dvec3 size = 1e3 * (box.upper - box.lower);
    page.put(fmt::format("{:.5g} × {:.5g} × {:.5g} mm", size.x, size.y, size.z));
  });
  page.numberCell([&] {
    const bool isKnown = part.density != kDefaultDensity && geometry.mass.basis == MassBasis::VolumeIntegrals;
    if (isKnown) page.putNumber(massOf(part), fmt::format("{:.5g} kg", massOf(part)));
  });
}

void putPartRow(ReportPageWriter& page, const Scene& scene, const Part& part) {
  page.cell([&] {
    page.putName(part.name);
    if (!part.isVisible) page.put(" (hidden)");
    if (scene.isMoving(part.id)) page.put(" (moving)");
  });
  if (!part.geometry) {
    for (int column = 0; column < 4; ++column)
      page.textCell("");
  } else {
    putGeometryCells(page, part);
  }
  page.cell([&] {
    const glm::dvec3& t = part.worldFromPart.translation;
    const glm::dquat& q = part.worldFromPart.rotation;
    page.put(fmt::format("({:.6g}, {:.6g}, {:.6g}) mm; ({:.6g}, {:.6g}, {:.6g}, {:.6g})", 1e3 * t.x,
                         1e3 * t.y, 1e3 * t.z, q.w, q.x, q.y, q.z));
  });
}

void putInputRow(ReportPageWriter& page, std::string_view kind, const std::string& file,
                 const std::string& sha256) {
  page.element("tr", [&] {
    page.textCell(kind);
    page.cell([&] { page.putName(file); });
    page.cell([&] { sha256.empty() ? page.put("not as saved") : page.putHash(sha256); });
  });
}

}  // namespace

void putParts(ReportPageWriter& page, const Scene& scene) {
  const std::vector<Scene::PartPtr>& parts = scene.parts();
  if (parts.empty()) return page.sentence("There are none.");
  const std::size_t shown = std::min(parts.size(), kMaxPartRows);
  page.table({"Part", "Source and its SHA-256", "Surface", "Size", "Mass", "Placement"}, [&] {
    for (std::size_t i = 0; i < shown; ++i)
      page.element("tr", [&] { putPartRow(page, scene, *parts[i]); });
  });
  page.leftOutNote(parts.size(), shown, "parts");
  page.sentence(
      "Size: of the box along the axes of the part's own frame. Mass: where a density is set and the mesh "
      "is closed. "
      "Placement: position, and unit quaternion w x y z, of the part's frame in the world.");
}

void putSettings(ReportPageWriter& page, const FitReportRequest& request, const FitReport& report) {
  const SceneCheckRequest& check = request.check;
  page.element("dl", [&] {
    page.term("Threshold", [&] { page.putLength(check.threshold); });
    page.textTerm("Minima", check.maxMinima == 0
                                ? std::string("all of a pair")
                                : fmt::format("up to {} of a pair, the nearest", check.maxMinima));
    page.textTerm("Volumes", check.maxVolumeTriangles == 0
                                 ? std::string("not computed")
                                 : fmt::format("of pairs of up to {} triangles", check.maxVolumeTriangles));
    page.textTerm("Depths", check.hasDepths ? "of clashes" : "not computed");
    page.textTerm("Touching", "a gap or depth of up to a millionth of the smaller part, at most 0.001 mm");
    if (report.path && report.path->range > 0.0)
      page.term("Range along path", [&] { page.putLength(report.path->range); });
  });
  page.add("h3", "Rules");
  if (check.rules.empty())
    return page.sentence("There are none: all pairs are checked, and every clash counts.");
  page.element("ol", [&] {
    for (const PairRule& rule : check.rules)
      page.element("li", [&] { page.putRule(rule); });
  });
}

void putInputs(ReportPageWriter& page, const FitReportRequest& request) {
  std::map<std::string, std::pair<std::string, std::string>> files;  // Kind and hash by file.
  for (const Scene::PartPtr& part : request.scene.parts()) {
    if (!part->geometry) continue;
    files.try_emplace(pathText(part->geometry->file), "geometry", part->geometry->sha256);
    if (!part->geometry->companions) continue;
    for (const CompanionFile& companion : *part->geometry->companions)
      files.try_emplace(pathText(companion.file), "companion", companion.sha256);
  }
  std::size_t shown = 0;
  page.table({"Kind", "File", "SHA-256"}, [&] {
    for (const ReportInput& input : request.inputs)
      putInputRow(page, input.kind, pathText(input.file), input.sha256);
    for (const auto& [file, kindAndHash] : files) {
      if (shown == kMaxPartRows) break;
      putInputRow(page, kindAndHash.first, file, kindAndHash.second);
      ++shown;
    }
  });
  page.leftOutNote(files.size(), shown, "files");
  if (request.sceneSha256.empty())
    page.sentence(
        "The scene was not saved as it is here: no hash stands for its parts' places and its rules.");
}

void putVersions(ReportPageWriter& page, const ReportOrigin& origin) {
  page.element("dl", [&] {
    page.textTerm("Program", origin.program);
    if (!origin.revision.empty()) page.textTerm("Revision", origin.revision);
    if (!origin.importer.empty()) page.textTerm("Reader of CAD documents", origin.importer);
    page.textTerm("Libraries", origin.libraries);
    page.textTerm("System", origin.system);
  });
}

}  // namespace nearfit
