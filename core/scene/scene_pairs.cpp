// Rules for pairs of a scene's parts, and what the last check found of them.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/scene/scene.h"

namespace nearfit {

const std::vector<PairRule>& Scene::pairRules() const noexcept {
  static const std::vector<PairRule> kNone;
  return pairRules_ != nullptr ? *pairRules_ : kNone;
}

void Scene::setPairRules(std::vector<PairRule> rules) {
  checkPairRules(rules);
  pairRules_ = std::make_shared<const std::vector<PairRule>>(std::move(rules));
}

const std::vector<PairRecord>& Scene::pairRecords() const noexcept {
  static const std::vector<PairRecord> kNone;
  return pairRecords_ != nullptr ? *pairRecords_ : kNone;
}

const PairRecord* Scene::findPairRecord(const PartPair& pair) const noexcept {
  const auto& records = pairRecords();
  const auto it = std::ranges::lower_bound(records, pair, {}, &PairRecord::pair);
  return it == records.end() || it->pair != pair ? nullptr : &*it;
}

void Scene::setPairRecords(std::vector<PairRecord> records) {
  if (records.size() > kMaxPairRecords)
    throw UsageError("findings", fmt::format("there are more than {}", kMaxPairRecords), "keep the worst");
  std::ranges::sort(records, {}, &PairRecord::pair);
  for (const PairRecord& record : records) {
    checkPairRecord(record);
    get(record.pair.part);
    get(record.pair.other);
  }
  const auto twice = std::ranges::adjacent_find(records, {}, &PairRecord::pair);
  if (twice != records.end()) {
    throw UsageError(
        fmt::format("finding of \"{}\" and \"{}\"", get(twice->pair.part).name, get(twice->pair.other).name),
        "there are two", "keep one");
  }
  pairRecords_ = std::make_shared<const std::vector<PairRecord>>(std::move(records));
}

void Scene::setFindingState(const std::vector<PartPair>& pairs, FindingState state,
                            const std::string& reason) {
  std::vector<PairRecord> records = pairRecords();
  for (const PartPair& pair : pairs) {
    const auto it = std::ranges::lower_bound(records, pair, {}, &PairRecord::pair);
    if (it == records.end() || it->pair != pair)
      throw UsageError("finding", "the last check found nothing for these parts", "check the scene again");
    it->state = state;
    it->reason = reason;
  }
  setPairRecords(std::move(records));
}

void Scene::dropRecordsOf(PartId id) {
  const auto isOfIt = [id](const PairRecord& record) {
    return record.pair.part == id || record.pair.other == id;
  };
  if (std::ranges::none_of(pairRecords(), isOfIt)) return;
  std::vector<PairRecord> left = pairRecords();
  std::erase_if(left, isOfIt);
  pairRecords_ = std::make_shared<const std::vector<PairRecord>>(std::move(left));
}

void Scene::renameInRules(const std::string& from, const std::string& to) {
  const auto isIt = [&](const std::string& pattern) { return onlyNameOf(pattern) == from; };
  const auto namesIt = [&](const PairRule& rule) { return isIt(rule.part) || isIt(rule.other); };
  if (std::ranges::none_of(pairRules(), namesIt)) return;
  std::vector<PairRule> renamed = pairRules();
  for (PairRule& rule : renamed) {
    if (isIt(rule.part)) rule.part = patternOf(to);
    if (isIt(rule.other)) rule.other = patternOf(to);
  }
  pairRules_ = std::make_shared<const std::vector<PairRule>>(std::move(renamed));
}

}  // namespace nearfit
