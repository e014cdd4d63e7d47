#include "core/haptics/contact_thinning.h"

#include <algorithm>
#include <limits>

#include "core/haptics/step_rows.h"
#include "core/math/mixed_bits.h"

namespace nearfit {
namespace {

/// Cell size of the grid of directions; the length of a direction is about 1.
constexpr double kCell = 0.08;
/// Makes cells' numbers positive, so that cutting off the fraction rounds down.
constexpr double kCellsBelowZero = 1024.0;
/// One part in this many of the room is reserved for the nearest of those that agree with a nearer one. Of
/// two contacts equally near, a step perpendicular to one brings the other nearer by as much as they differ.
/// A proxy that does not know the other gains from no step, and stands until it is pulled off in a leap.
constexpr std::size_t kShareOfOthers = 4;
/// Slots of the hash table, of which at most half are in use.
constexpr std::size_t kSlots = 2 * ContactThinning::kMaxTaken;

bool isNearerContact(const BodyContact& a, const BodyContact& b) noexcept {
  return a.pair.distance < b.pair.distance;
}

std::ptrdiff_t at(std::size_t i) noexcept {
  return static_cast<std::ptrdiff_t>(i);
}

}  // namespace

ContactThinning::ContactThinning() : taken_(kMaxTaken), cells_(kMaxTaken), table_(kSlots) {}

void ContactThinning::begin(const glm::dvec3& centre, const glm::dquat& principalFromWorld,
                            const MassMetric& metric) noexcept {
  centre_ = centre;
  const glm::dvec3 inverse = 1.0 / metric.gyration;
  turnFromWorld_ = glm::dmat3({inverse.x, 0, 0}, {0, inverse.y, 0}, {0, 0, inverse.z}) *
                   glm::mat3_cast(principalFromWorld);
  count_ = distinct_ = 0;
  // When the number comes round, slots of long ago must not count as filled.
  if (++selection_ == 0) {
    std::fill(table_.begin(), table_.end(), Slot{});
    selection_ = 1;
  }
}

bool ContactThinning::add(const BodyContact& contact) noexcept {
  if (count_ == kMaxTaken) return false;
  taken_[count_++] = contact;
  if (count_ == kMaxKept + 1) {
    for (std::size_t i = 0; i < count_; ++i)
      place(i);
  } else if (count_ > kMaxKept) {
    place(count_ - 1);
  }
  return true;
}

std::uint64_t ContactThinning::cellOf(const ContactPair& pair) const noexcept {
  std::uint64_t cell = 0;
  // The components of stepRow(), to rounding.
  const glm::dvec3 &d = pair.direction, turn = turnFromWorld_ * glm::cross(pair.point - centre_, d);
  for (const double x : {d.x, d.y, d.z, turn.x, turn.y, turn.z}) {
    // Ten bits each: rotational components are at most the radius over the min gyration, some twenty.
    const auto step = static_cast<std::int64_t>(x * (1.0 / kCell) + kCellsBelowZero) & 0x3FF;
    cell = cell << 10U | static_cast<std::uint64_t>(step);
  }
  return cell;
}

void ContactThinning::place(std::size_t i) noexcept {
  const std::uint64_t cell = cellOf(taken_[i].pair);
  std::size_t slot = mixedBits(cell) % kSlots;
  while (table_[slot].selection == selection_ && cells_[table_[slot].contact] != cell)
    slot = (slot + 1) % kSlots;
  if (table_[slot].selection != selection_) {
    // The first contact of each cell moves to the front.
    table_[slot] = {selection_, static_cast<std::uint32_t>(distinct_)};
    cells_[distinct_] = cell;
    std::swap(taken_[distinct_++], taken_[i]);
  } else if (isNearerContact(taken_[i], taken_[table_[slot].contact])) {
    std::swap(taken_[table_[slot].contact], taken_[i]);
  }
}

ContactThinning::Kept ContactThinning::keep(std::span<BodyContact> out) noexcept {
  Kept kept{count_, std::numeric_limits<double>::infinity()};
  if (count_ <= std::min(kMaxKept, out.size())) {
    std::copy_n(taken_.begin(), count_, out.begin());
    return kept;
  }
  // With less room than usual, they are not sorted yet.
  if (count_ <= kMaxKept) {
    for (std::size_t i = 0; i < count_; ++i)
      place(i);
  }
  const std::size_t room = std::min(kMaxKept, out.size());
  const std::size_t forOthers = std::min(count_ - distinct_, room / kShareOfOthers);
  const auto begin = taken_.begin(), others = begin + at(distinct_);
  const std::size_t own = std::min(distinct_, room - forOthers);
  if (own < distinct_) {
    std::nth_element(begin, begin + at(own), others, isNearerContact);
    kept.completeTo = taken_[own].pair.distance;
  }
  const auto rest = std::copy_n(begin, own, out.begin());
  const std::size_t more = std::min(room - own, count_ - distinct_);
  std::nth_element(others, others + at(more), begin + at(count_), isNearerContact);
  std::copy_n(others, more, rest);
  kept.count = own + more;
  return kept;
}

}  // namespace nearfit
