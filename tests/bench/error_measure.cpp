#include "tests/bench/error_measure.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/exponential.hpp>
#include <glm/geometric.hpp>

namespace nearfit::bench {
namespace {

constexpr double kMatchFactor = 2.0;

double squared(double x) {
  return x * x;
}

double positionError(const Lmd& lmd, const TrueContact& contact) {
  return std::max(glm::distance(lmd.scenePoint, contact.scenePoint),
                  glm::distance(lmd.partPoint, contact.partPoint));
}

/// The true minimum that a method's belongs to; their number for none.
std::size_t ownerOf(const Lmd& lmd, std::span<const TrueContact> contacts, double edge) {
  const auto nearest =
      std::min_element(contacts.begin(), contacts.end(), [&](const TrueContact& a, const TrueContact& b) {
        return positionError(lmd, a) < positionError(lmd, b);
      });
  if (nearest == contacts.end() || positionError(lmd, *nearest) > matchBound(*nearest, edge))
    return contacts.size();
  return static_cast<std::size_t>(nearest - contacts.begin());
}

/// @param nearestOf  Of each true minimum, the method's that answers for it, or null.
void setMatchErrors(std::span<const TrueContact> contacts, std::span<const Lmd* const> nearestOf,
                    AnswerErrors& errors) {
  glm::dvec3 squares(0.0);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (nearestOf[i] == nullptr) {
      ++errors.missed;
      continue;
    }
    const Lmd& lmd = *nearestOf[i];
    ++errors.matched;
    squares +=
        glm::dvec3(squared(lmd.distance - contacts[i].distance), squared(positionError(lmd, contacts[i])),
                   squared(glm::distance(lmd.direction, contacts[i].direction)));
  }
  if (errors.matched == 0) return;
  const glm::dvec3 roots = glm::sqrt(squares / static_cast<double>(errors.matched));
  errors.distance = roots.x;
  errors.position = roots.y;
  errors.direction = roots.z;
}

void countMembers(const ContactAnswer& answer, std::span<const TrueContact> contacts, double edge,
                  AnswerErrors& errors) {
  std::vector<const Lmd*> nearestOf(contacts.size(), nullptr);
  for (const Lmd& lmd : answer.minima) {
    const std::size_t owner = ownerOf(lmd, contacts, edge);
    if (owner == contacts.size()) {
      ++errors.spurious;
      continue;
    }
    errors.extra += nearestOf[owner] != nullptr ? 1 : 0;
    if (nearestOf[owner] == nullptr || lmd.distance < nearestOf[owner]->distance) nearestOf[owner] = &lmd;
  }
  setMatchErrors(contacts, nearestOf, errors);
}

}  // namespace

double matchBound(const TrueContact& contact, double edge) {
  return kMatchFactor * contact.spread * edge + contact.reach;
}

AnswerErrors errorsOf(const ContactAnswer& answer, const ErrorPose& pose, const SpringParameters& springs,
                      double edge) {
  AnswerErrors errors;
  countMembers(answer, pose.contacts, edge, errors);
  const Wrench truth =
      trueWrench(pose.contacts, springs.cutoff, springs.stiffness, pose.sceneFromPart.translation);
  errors.force = glm::distance(answer.wrench.force, truth.force);
  errors.torque = glm::distance(answer.wrench.torque, truth.torque);
  return errors;
}

}  // namespace nearfit::bench
