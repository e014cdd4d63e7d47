#include "core/haptics/contact_thinning.h"

#include <algorithm>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace nearfit::contact_thinning_test {
namespace {

constexpr std::size_t kMax = ContactThinning::kMaxKept;
const glm::dquat kUnturned{1, 0, 0, 0};

/// Through the centre of mass, so that it says nothing of turns.
BodyContact contactAlong(const glm::dvec3& direction, double distance) {
  BodyContact contact;
  contact.pair.direction = glm::normalize(direction);
  contact.pair.distance = distance;
  return contact;
}

struct Thinned {
  std::vector<BodyContact> contacts;
  double completeTo;
};

Thinned thinned(const std::vector<BodyContact>& all, std::size_t room = kMax) {
  ContactThinning thinning;
  // A selection before it leaves nothing behind.
  for (const std::span<const BodyContact> added : {std::span(all).first(all.size() / 2), std::span(all)}) {
    thinning.begin({0, 0, 0}, kUnturned, {});
    for (const BodyContact& contact : added)
      EXPECT_TRUE(thinning.add(contact));
  }
  Thinned out{std::vector<BodyContact>(room), 0.0};
  const ContactThinning::Kept kept = thinning.keep(out.contacts);
  EXPECT_LE(kept.count, room);
  out.contacts.resize(kept.count);
  out.completeTo = kept.completeTo;
  return out;
}

bool holds(const Thinned& out, const BodyContact& contact) {
  return std::ranges::any_of(out.contacts, [&](const BodyContact& c) {
    return c.pair.distance == contact.pair.distance && c.pair.direction == contact.pair.direction;
  });
}

/// So many that differ by hundredths of a degree, all about as near.
std::vector<BodyContact> bundle(std::size_t count, double distance) {
  std::vector<BodyContact> all;
  for (std::size_t i = 0; i < count; ++i) {
    const double i01 = static_cast<double>(i) / static_cast<double>(count);
    all.push_back(contactAlong({1e-3 * i01 + 1e-3, 1e-3, 1.0}, distance * (1.0 + i01)));
  }
  return all;
}

TEST(ContactThinning, WhatFitsIsKeptAsItIs) {
  const std::vector<BodyContact> all = bundle(kMax, 1e-4);
  EXPECT_EQ(thinned(all).contacts.size(), all.size());
}

TEST(ContactThinning, OfManyThatAgreeTheNearestAreKeptAndNotOneAlone) {
  // A nut's flank lies on the bolt's with hundreds of contacts, equally near and all but parallel. With one
  // of them for all a step along it was square to the others by a few degrees too little: each brought
  // another nearer, none was a gain, and the nut stood and leapt by turns.
  std::vector<BodyContact> all = bundle(2 * kMax, 1e-4);
  all.push_back(contactAlong({1, 0, 0}, 3e-4));
  const Thinned out = thinned(all);
  for (std::size_t i = 0; i < kMax / 8; ++i)
    EXPECT_TRUE(holds(out, all[i])) << i;
  EXPECT_TRUE(holds(out, all.back()));
  EXPECT_EQ(out.contacts.size(), kMax);
}

TEST(ContactThinning, OfEachDirectionTheNearestIsKeptWhereThereIsRoom) {
  std::vector<BodyContact> all = bundle(2 * kMax, 1e-4), apart;
  // Some tenth of a radian from each other, all farther away than the bundle.
  for (int x = -3; x <= 3; ++x) {
    for (int y = -3; y <= 3; ++y)
      apart.push_back(contactAlong({0.12 * x + 0.05, 0.12 * y + 0.05, -1.0}, 1e-3 + 1e-6 * x));
  }
  all.insert(all.end(), apart.begin(), apart.end());
  const Thinned out = thinned(all);
  EXPECT_EQ(std::ranges::count_if(apart, [&](const BodyContact& c) { return holds(out, c); }),
            static_cast<std::ptrdiff_t>(apart.size()));
}

TEST(ContactThinning, WhatHasNoRoomIsSaidToBeMissing) {
  std::vector<BodyContact> all;
  for (int x = 0; x < 40; ++x) {
    for (int y = 0; y < 40; ++y)
      all.push_back(contactAlong({0.1 * x - 2.0, 0.1 * y - 2.0, 1.0}, 1e-4 * (1.0 + x + 40.0 * y)));
  }
  const Thinned out = thinned(all);
  for (const BodyContact& contact : all) {
    if (contact.pair.distance < out.completeTo) {
      // It is there, or a nearer one that agrees with it.
      EXPECT_TRUE(std::ranges::any_of(out.contacts, [&](const BodyContact& c) {
        return c.pair.distance <= contact.pair.distance &&
               glm::distance(c.pair.direction, contact.pair.direction) < 0.15;
      }));
    }
  }
  EXPECT_LT(out.completeTo, all.back().pair.distance);
}

}  // namespace
}  // namespace nearfit::contact_thinning_test
