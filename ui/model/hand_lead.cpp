#include "ui/model/hand_lead.h"

#include <numbers>

#include <glm/geometric.hpp>

#include "ui/widgets/format.h"

namespace nearfit::ui {
namespace {

constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;
/// A smaller turn would round to zero [degrees].
constexpr double kMinShownTurn = 0.05;

}  // namespace

HandLead handLeadOf(const ServoSnapshot& snapshot) noexcept {
  const glm::dvec3 centreInPart = snapshot.proxy.inverse().applyToPoint(snapshot.centre);
  const glm::dvec3 handCentre = snapshot.handle.applyToPoint(centreInPart);
  return {handCentre, glm::distance(handCentre, snapshot.centre),
          glm::length(turnBetween(snapshot.proxy.rotation, snapshot.handle.rotation))};
}

QString formatLead(const HandLead& lead) {
  const double degrees = lead.angle * kDegreesPerRadian;
  const QString distance = formatLength(lead.distance);
  if (degrees < kMinShownTurn) return distance;
  return distance + QStringLiteral(", %1°").arg(formatFixed(degrees, degrees < 10.0 ? 1 : 0));
}

}  // namespace nearfit::ui
