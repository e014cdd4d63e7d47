#include "core/report/placement_table.h"

#include <iterator>

#include <fmt/format.h>

#include "core/report/csv_text.h"
#include "core/report/mesh_export.h"
#include "core/text/utf8.h"

namespace nearfit {
namespace {

constexpr const char* kHeader =
    "part,mesh,sha256,metres_per_unit,visible,moving,tx,ty,tz,qw,qx,qy,qz,"
    "m00,m01,m02,m03,m10,m11,m12,m13,m20,m21,m22,m23,m30,m31,m32,m33\n";

void appendRow(std::string& text, const Part& part, bool isMoving) {
  const std::string mesh = part.geometry->file.string();
  const RigidTransform& pose = part.worldFromPart;
  fmt::format_to(std::back_inserter(text), "{},{},{},{},{:d},{:d}", csvField(part.name),
                 csvField(isUtf8(mesh) ? mesh : printableText(mesh)), part.geometry->sha256,
                 part.geometry->metresPerUnit, part.isVisible, isMoving);
  const glm::dvec3& t = pose.translation;
  const glm::dquat& q = pose.rotation;
  for (const double value : {t.x, t.y, t.z, q.w, q.x, q.y, q.z})
    fmt::format_to(std::back_inserter(text), ",{}", value);
  const glm::dmat4 m = pose.toMatrix();
  for (glm::length_t row = 0; row < 4; ++row) {
    for (glm::length_t column = 0; column < 4; ++column)
      fmt::format_to(std::back_inserter(text), ",{}", m[column][row]);
  }
  text += '\n';
}

}  // namespace

std::string matrixText(const RigidTransform& worldFromPart) {
  const glm::dmat4 m = worldFromPart.toMatrix();
  std::string text;
  for (glm::length_t row = 0; row < 4; ++row)
    fmt::format_to(std::back_inserter(text), "{} {} {} {}\n", m[0][row], m[1][row], m[2][row], m[3][row]);
  return text;
}

std::string placementCsv(const Scene& scene, const RigidTransform& worldFromMoving) {
  const Scene placed = placedScene(scene, worldFromMoving);
  std::string text = kHeader;
  for (const Scene::PartPtr& part : placed.parts())
    appendRow(text, *part, placed.isMoving(part->id));
  return text;
}

}  // namespace nearfit
