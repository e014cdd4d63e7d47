#include "app/import/step_scan.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/import/document_file.h"

namespace nearfit::importer {
namespace {

/// Parentheses within each other: lists of lists of points, and types around values, make some five.
constexpr int kMaxParentheses = 64;
/// Assemblies, or representations mapped, within each other: readers recurse into them.
constexpr std::size_t kMaxStepNesting = 200;
/// Entities in a chain of references, which readers follow by recursion: files of assemblies have some twenty, a solid
/// that is cut again and again a few more for each cut.
constexpr std::size_t kMaxReferenceDepth = 10'000;
/// Digits of an integer: readers keep them in 32 bits.
constexpr std::int64_t kMaxInteger = std::numeric_limits<std::int32_t>::max();
/// Decimal exponent of a real; beyond it a double is infinite.
constexpr int kMaxExponent = 307;

using Id = std::int64_t;

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

/// Which entities place others, and how often.
class PlacementGraph {
 public:
  void add(Id from, Id to, bool isInstance) { edges_[from].push_back({to, isInstance}); }

  /// Max number of instances below an entity, up to a limit; no value if an entity is below itself or nested too deep.
  std::optional<std::uint64_t> maxInstances() {
    std::uint64_t max = 0;
    for (const auto& edge : edges_) {
      if (!visit(edge.first)) return std::nullopt;
      max = std::max(max, below_[edge.first].count);
    }
    return max;
  }

 private:
  struct Edge {
    Id to;
    bool isInstance;
  };
  enum class State : std::uint8_t { New, Open, Done };
  struct Below {
    State state = State::New;
    std::uint64_t count = 0;
  };
  struct Frame {
    Id id;
    std::size_t next = 0;
  };

  /// Counts below one entity, depth first on a stack of its own: a file can chain a million.
  bool visit(Id root) {
    if (below_[root].state == State::Done) return true;
    std::vector<Frame> frames{{root}};
    below_[root].state = State::Open;
    while (!frames.empty()) {
      if (frames.size() > kMaxStepNesting * 3) return false;
      Frame& frame = frames.back();
      const auto edges = edges_.find(frame.id);
      if (edges == edges_.end() || frame.next == edges->second.size()) {
        below_[frame.id].state = State::Done;
        frames.pop_back();
        continue;
      }
      const Edge edge = edges->second[frame.next];
      Below& child = below_[edge.to];
      if (child.state == State::Open) return false;
      if (child.state == State::New) {
        child.state = State::Open;
        frames.push_back({edge.to});
        continue;
      }
      constexpr std::uint64_t kEnough = std::uint64_t{1} << 40;
      Below& here = below_[frame.id];
      here.count = std::min(kEnough, here.count + child.count + (edge.isInstance ? 1 : 0));
      ++frame.next;
    }
    return true;
  }

  std::unordered_map<Id, std::vector<Edge>> edges_;
  std::unordered_map<Id, Below> below_;
};

/// References between all entities.
class ReferenceChains {
 public:
  /// The references that follow are those of this entity.
  void begin(Id entity) {
    isSorted_ = isSorted_ && (entities_.empty() || entities_.back().id < entity);
    entities_.push_back({entity, targets_.size(), targets_.size()});
  }
  void add(Id target) {
    targets_.push_back(static_cast<std::int32_t>(target));
    ++entities_.back().end;
  }

  /// True if a chain is longer than kMaxReferenceDepth. Where it comes back to one of its entities, it ends.
  bool areTooLong() {
    if (!isSorted_) std::ranges::stable_sort(entities_, {}, &Entity::id);
    depth_.assign(entities_.size(), kNew);
    for (std::size_t i = 0; i < entities_.size(); ++i)
      if (depth_[i] == kNew && isTooLongFrom(i)) return true;
    return false;
  }

 private:
  struct Entity {
    Id id;
    std::size_t begin, end;  ///< Of its targets.
  };
  struct Link {
    std::size_t entity, next;
    std::uint32_t below = 0;  ///< Longest chain of those looked at.
  };
  static constexpr std::uint32_t kNew = 0, kOpen = ~std::uint32_t{0};

  /// Depth first, on a stack of its own.
  bool isTooLongFrom(std::size_t root) {
    std::vector<Link> chain{{root, entities_[root].begin}};
    depth_[root] = kOpen;
    while (!chain.empty()) {
      Link& link = chain.back();
      if (chain.size() + link.below > kMaxReferenceDepth) return true;
      if (link.next == entities_[link.entity].end) {
        const std::uint32_t depth = depth_[link.entity] = link.below + 1;
        chain.pop_back();
        if (!chain.empty()) chain.back().below = std::max(chain.back().below, depth);
        continue;
      }
      const std::optional<std::size_t> target = find(targets_[link.next++]);
      if (!target || depth_[*target] == kOpen) continue;
      if (depth_[*target] != kNew) {
        link.below = std::max(link.below, depth_[*target]);
        continue;
      }
      depth_[*target] = kOpen;
      chain.push_back({*target, entities_[*target].begin});
    }
    return false;
  }

  std::optional<std::size_t> find(Id id) const {
    const auto at = std::ranges::lower_bound(entities_, id, {}, &Entity::id);
    if (at == entities_.end() || at->id != id) return std::nullopt;
    return static_cast<std::size_t>(at - entities_.begin());
  }

  std::vector<Entity> entities_;
  std::vector<std::int32_t> targets_;
  std::vector<std::uint32_t> depth_;
  bool isSorted_ = true;
};

class StepScanner {
 public:
  StepScanner(std::span<const char> text, const std::string& name)
      : text_(text.data(), text.size()), name_(name) {}

  void scan() {
    skipByteOrderMark();
    if (!text_.substr(at_).starts_with("ISO-10303-21"))
      fail("it does not begin as a STEP file (ISO-10303-21)", "check that it is one, and export it again");
    while (at_ < text_.size())
      step();
    if (depth_ != 0 || isOpen_) fail("it is cut off", "copy or export it again");
    checkPlacements();
    checkChains();
  }

 private:
  [[noreturn]] void fail(const std::string& problem, const char* remedy) const {
    const auto line =
        1 + std::count(text_.begin(),
                       text_.begin() + static_cast<std::ptrdiff_t>(std::min(at_, text_.size())), '\n');
    throw FileError(fmt::format("{}:{}", name_, line), problem, remedy);
  }

  void skipByteOrderMark() {
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0)
      ++at_;
  }

  /// Takes what begins at the current place.
  void step() {
    const char c = text_[at_];
    if (c == '\'' || c == '"') {
      skipQuoted(c);
    } else if (c == '/' && at_ + 1 < text_.size() && text_[at_ + 1] == '*') {
      skipComment();
    } else if (c == '#') {
      takeReference();
    } else if (isDigit(c) || ((c == '-' || c == '+') && at_ + 1 < text_.size() && isDigit(text_[at_ + 1]))) {
      takeNumber();
    } else if (std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_') {
      takeWord();
    } else {
      takeSign(c);
      ++at_;
    }
  }

  /// A quote within a text is doubled, which looks like the end of one text and the begin of another.
  void skipQuoted(char quote) {
    const std::size_t end = text_.find(quote, at_ + 1);
    if (end == std::string_view::npos) fail("a text has no end", "it is cut off or damaged: export it again");
    at_ = end + 1;
  }

  void skipComment() {
    const std::size_t end = text_.find("*/", at_ + 2);
    if (end == std::string_view::npos)
      fail("a comment has no end", "it is cut off or damaged: export it again");
    at_ = end + 2;
  }

  void takeSign(char c) {
    if (c == '(') {
      if (++depth_ > kMaxParentheses)
        fail(fmt::format("parentheses are nested more than {} deep", kMaxParentheses),
             "it is damaged: export it again");
    } else if (c == ')') {
      if (--depth_ < 0) fail("a parenthesis is closed that was not opened", "it is damaged: export it again");
    } else if (c == ',' && depth_ == wordDepth_ + 1) {
      ++argument_;
    } else if (c == ';') {
      if (depth_ != 0) fail("a parenthesis is not closed", "it is cut off or damaged: export it again");
      endStatement();
    }
  }

  void takeReference() {
    std::size_t end = at_ + 1;
    Id id = 0;
    for (; end < text_.size() && isDigit(text_[end]); ++end)
      id = std::min<Id>(kMaxInteger + 1, id * 10 + (text_[end] - '0'));
    if (id > kMaxInteger) fail("the number of an entity is beyond range", "it is damaged: export it again");
    if (!isOpen_) {
      isOpen_ = true;
      id_ = id;
      chains_.begin(id);
    } else {
      chains_.add(id);
      if (references_.size() < kMaxReferences) references_.push_back({word_, argument_, id});
    }
    at_ = end;
  }

  void takeNumber() {
    std::size_t end = at_ + 1;
    std::size_t digits = isDigit(text_[at_]) && text_[at_] != '0' ? 1 : 0;
    for (; end < text_.size() && isDigit(text_[end]); ++end)
      digits += digits > 0 || text_[end] != '0' ? 1 : 0;
    const bool isReal = end < text_.size() && text_[end] == '.';
    if (!isReal) {
      checkInteger(text_.substr(at_, end - at_));
      at_ = end;
      return;
    }
    for (++end; end < text_.size() && isDigit(text_[end]);)
      ++end;
    std::int64_t exponent = 0;
    if (end < text_.size() && (text_[end] == 'E' || text_[end] == 'e')) exponent = takeExponent(end);
    if (static_cast<std::int64_t>(digits) - 1 + exponent > kMaxExponent)
      fail("a number is beyond range", "it is damaged: export it again");
    at_ = end;
  }

  /// Reads an exponent at `end`, which moves behind it.
  std::int64_t takeExponent(std::size_t& end) const {
    ++end;
    const bool isNegative = end < text_.size() && text_[end] == '-';
    if (end < text_.size() && (text_[end] == '-' || text_[end] == '+')) ++end;
    std::int64_t exponent = 0;
    for (; end < text_.size() && isDigit(text_[end]); ++end)
      exponent = std::min<std::int64_t>(100'000, exponent * 10 + (text_[end] - '0'));
    return isNegative ? -exponent : exponent;
  }

  void checkInteger(std::string_view digits) const {
    std::int64_t value = 0;
    for (const char c : digits)
      if (isDigit(c)) value = std::min(kMaxInteger + 1, value * 10 + (c - '0'));
    if (value > kMaxInteger) fail("a whole number is beyond range", "it is damaged: export it again");
  }

  void takeWord() {
    std::size_t end = at_;
    while (end < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[end])) != 0 ||
                                  text_[end] == '_' || text_[end] == '-'))
      ++end;
    const std::string_view word = text_.substr(at_, end - at_);
    // The keyword of an entity, or each of those of an entity of several types in one.
    if (isOpen_ &&
        (depth_ == 0 || (depth_ == 1 && !hasKeyword_ && end < text_.size() && text_[end] == '('))) {
      word_ = wordOf(word);
      wordDepth_ = depth_;
      argument_ = 0;
      hasKeyword_ = depth_ == 0;
    }
    // What follows is encoded, and no reader here looks at it.
    at_ = !isOpen_ && depth_ == 0 && word == "SIGNATURE" ? text_.size() : end;
  }

  enum class Word : std::uint8_t { Other, Occurrence, Relationship, MappedItem, Map, Representation };

  static Word wordOf(std::string_view word) {
    if (word == "NEXT_ASSEMBLY_USAGE_OCCURRENCE") return Word::Occurrence;
    if (word == "PRODUCT_DEFINITION_RELATIONSHIP") return Word::Relationship;
    if (word == "MAPPED_ITEM") return Word::MappedItem;
    if (word == "REPRESENTATION_MAP") return Word::Map;
    if (word.ends_with("REPRESENTATION")) return Word::Representation;
    return Word::Other;
  }

  void endStatement() {
    if (isOpen_) {
      takePlacements();
      isOpen_ = false;
    }
    references_.clear();
    word_ = Word::Other;
    hasKeyword_ = false;
    argument_ = wordDepth_ = 0;
  }

  void takePlacements() {
    Id relating = 0, related = 0;
    for (const Reference& reference : references_) {
      switch (reference.word) {
        case Word::Occurrence:
        case Word::Relationship:
          if (reference.argument == 3) relating = reference.id;
          if (reference.argument == 4) related = reference.id;
          break;
        case Word::MappedItem:
          if (reference.argument == 1) graph_.add(id_, reference.id, true);
          break;
        case Word::Map:
        case Word::Representation:
          if (reference.argument == 1) graph_.add(id_, reference.id, false);
          break;
        case Word::Other:
          break;
      }
    }
    if (relating != 0 && related != 0) graph_.add(relating, related, true);
  }

  void checkPlacements() {
    const std::optional<std::uint64_t> instances = graph_.maxInstances();
    if (!instances) {
      throw FileError(
          name_,
          fmt::format("an assembly contains itself, or is nested more than {} levels deep", kMaxStepNesting),
          "it is damaged: export it again");
    }
    if (*instances > kMaxDocumentNodes) {
      throw FileError(name_,
                      fmt::format("its assemblies stand for more than {} instances", kMaxDocumentNodes),
                      "open a part of the assembly");
    }
  }

  void checkChains() {
    if (!chains_.areTooLong()) return;
    throw FileError(
        name_,
        fmt::format("its entities are nested more than {} deep by their references", kMaxReferenceDepth),
        "it is damaged: export it again");
  }

  struct Reference {
    Word word;
    int argument;
    Id id;
  };
  /// Bound on references of statements that place something. Only representations have many: their items.
  static constexpr std::size_t kMaxReferences = 10'000'000;

  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
  int depth_ = 0;
  bool isOpen_ = false;  ///< Within the statement of an entity.
  Id id_ = 0;
  Word word_ = Word::Other;
  bool hasKeyword_ = false;  ///< It began with a keyword: words within its parentheses are types of values.
  int wordDepth_ = 0;        ///< Parentheses around the keyword.
  int argument_ = 0;         ///< Of the keyword, from 0.
  std::vector<Reference> references_;
  PlacementGraph graph_;
  ReferenceChains chains_;
};

}  // namespace

void scanStep(std::span<const char> text, const std::string& name) {
  StepScanner(text, name).scan();
}

}  // namespace nearfit::importer
