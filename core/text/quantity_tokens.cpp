#include "core/text/quantity_tokens.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/text/unit_table.h"
#include "core/text/utf8.h"

namespace nearfit {
namespace {

constexpr std::array<std::string_view, 10> kFunctions = {"sqrt", "abs", "min",  "max",  "sin",
                                                         "cos",  "tan", "asin", "acos", "atan"};
/// ASCII spelling of a sign that keyboards and word processors produce.
struct Spelling {
  std::string_view sign, meaning;
};
constexpr std::array<Spelling, 6> kSpellings = {
    {{"−", "-"}, {"×", "*"}, {"·", "*"}, {"÷", "/"}, {"²", "^2"}, {"³", "^3"}}};

bool isDigit(char c) noexcept {
  return c >= '0' && c <= '9';
}
/// Letters, and bytes of multi-byte characters.
bool isNameByte(char c) noexcept {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (static_cast<unsigned char>(c) & 0x80U) != 0;
}

class Tokenizer {
 public:
  Tokenizer(std::string_view text, const Dimension& wanted) : text_(text), wanted_(wanted) {}

  QuantityTokens run() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (std::isspace(static_cast<unsigned char>(c)) != 0) {
        ++at_;
      } else if (takeSpace() || takeSpelling() || takeNumber() || takeSignUnit() || takeName()) {
        continue;
      } else if (std::string_view("+-*/^();").find(c) != std::string_view::npos) {
        takeOperator();
      } else {
        fail(at_, "“" + printableText(text_.substr(at_, 1)) + "” is not allowed here",
             "use numbers, units, + - * / ^, brackets and functions");
      }
    }
    return std::move(tokens_);
  }

 private:
  [[noreturn]] void fail(std::size_t position, const std::string& problem, const std::string& remedy) const {
    throw QuantityError(position, std::string(text_), problem, remedy);
  }
  bool startsWith(std::string_view what) const { return text_.substr(at_).starts_with(what); }

  void emit(std::string_view what, std::size_t from) {
    tokens_.expression += what == ";" ? "," : what;
    tokens_.origin.insert(tokens_.origin.end(), what.size(), from);
  }
  void emitNumber(double value, std::size_t from) {
    emit("n" + std::to_string(tokens_.numbers.size()), from);
    const bool isExponent = previous_ == '^' || (previous_ == '-' && beforePrevious_ == '^');
    tokens_.numbers.push_back({value, isExponent});
    note('n');
  }
  void note(char kind) {
    beforePrevious_ = previous_;
    previous_ = kind;
  }
  bool endsOperand() const { return previous_ == 'n' || previous_ == 'u' || previous_ == ')'; }

  /// Non-ASCII spaces: no-break, narrow no-break and thin.
  bool takeSpace() {
    for (const std::string_view space : {"\u00a0", "\u202f", "\u2009"}) {
      if (!startsWith(space)) continue;
      at_ += space.size();
      return true;
    }
    return false;
  }

  bool takeSpelling() {
    for (const Spelling& s : kSpellings) {
      if (!startsWith(s.sign)) continue;
      const std::size_t from = at_;
      at_ += s.sign.size();
      emit(s.meaning.substr(0, 1), from);
      note(s.meaning[0]);
      if (s.meaning.size() > 1) emitNumber(s.meaning[1] - '0', from);
      return true;
    }
    return false;
  }

  bool takeNumber() {
    const auto isSeparator = [](char c) { return c == '.' || c == ','; };
    const char next = at_ + 1 < text_.size() ? text_[at_ + 1] : ' ';
    if (!isDigit(text_[at_]) && !(isSeparator(text_[at_]) && isDigit(next))) return false;
    const std::size_t from = at_;
    std::string digits;
    std::size_t separators = 0;
    for (; at_ < text_.size() && (isDigit(text_[at_]) || isSeparator(text_[at_])); ++at_) {
      if (isSeparator(text_[at_]) && ++separators > 1)
        fail(at_, "a second decimal separator",
             "write thousands without a separator, and separate the arguments of a function with ;");
      digits += isSeparator(text_[at_]) ? '.' : text_[at_];
    }
    takeExponent(digits);
    double value = 0.0;
    const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (read.ec != std::errc()) fail(from, "a number out of range", "write one between 1e-300 and 1e300");
    if (endsOperand())
      fail(from, "two numbers without an operator between them", "put + - * or / between them");
    emitNumber(value, from);
    return true;
  }

  /// Takes the exponent of 1e-3, but not the names in 2 e and 3 em.
  void takeExponent(std::string& digits) {
    if (at_ >= text_.size() || (text_[at_] != 'e' && text_[at_] != 'E')) return;
    std::size_t end = at_ + 1;
    if (end < text_.size() && (text_[end] == '+' || text_[end] == '-')) ++end;
    if (end >= text_.size() || !isDigit(text_[end])) return;
    while (end < text_.size() && isDigit(text_[end]))
      ++end;
    // from_chars accepts either sign in an exponent.
    digits += text_.substr(at_, end - at_);
    at_ = end;
  }

  void emitUnit(const Unit& unit, std::size_t from) {
    if (endsOperand()) emit("*", from);
    emit("u" + std::to_string(tokens_.units.size()), from);
    tokens_.units.push_back(unit);
    note('u');
  }

  /// Takes a unit that is a sign; no separator need follow.
  bool takeSignUnit() {
    for (const std::string_view sign : {"\"", "'", "″", "′", "°", "%"}) {
      if (!startsWith(sign)) continue;
      const std::size_t from = at_;
      at_ += sign.size();
      emitUnit(*findUnit(sign), from);
      return true;
    }
    return false;
  }

  bool takeName() {
    if (!isNameByte(text_[at_])) return false;
    const std::size_t from = at_;
    // A multi-byte sign with a meaning of its own ends a name: m² is m to the power of two.
    while (at_ < text_.size() && isNameByte(text_[at_]) && !isSignHere())
      ++at_;
    if (at_ == from) ++at_;
    const std::string_view name = text_.substr(from, at_ - from);
    std::size_t behind = at_;
    while (behind < text_.size() && text_[behind] == ' ')
      ++behind;
    const bool isCall = behind < text_.size() && text_[behind] == '(';
    if (isCall && isQuantityFunction(name)) {
      if (endsOperand())
        fail(from, "an operator is missing before “" + std::string(name) + "”", "put + - * or / there");
      emit(name, from);
      note('f');
    } else if (name == "pi" || name == "π") {
      if (endsOperand()) {
        emit("*", from);
        note('*');
      }
      emitNumber(std::numbers::pi, from);
    } else if (const std::optional<Unit> unit = findUnit(name)) {
      emitUnit(*unit, from);
    } else {
      failName(from, std::string(name));
    }
    return true;
  }

  bool isSignHere() const {
    for (const std::string_view sign : {"°", "″", "′", "\u00a0", "\u202f", "\u2009"}) {
      if (startsWith(sign)) return true;
    }
    return std::any_of(kSpellings.begin(), kSpellings.end(),
                       [this](const Spelling& s) { return startsWith(s.sign); });
  }

  [[noreturn]] void failName(std::size_t from, const std::string& name) const {
    if (isQuantityFunction(name))
      fail(at_, "the function “" + name + "” has no argument",
           "put its argument in brackets: " + name + "(…)");
    const std::string units = unitNames(wanted_);
    fail(from, "“" + name + "” is neither a unit nor a function",
         units.empty() ? "leave it out" : "use one of " + units);
  }

  void takeOperator() {
    emit(text_.substr(at_, 1), at_);
    note(text_[at_]);
    ++at_;
  }

  std::string_view text_;
  Dimension wanted_;
  std::size_t at_ = 0;
  /// Kinds of the last tokens: n, u, f, or the operator itself.
  char previous_ = ' ', beforePrevious_ = ' ';
  QuantityTokens tokens_;
};

}  // namespace

bool isQuantityFunction(std::string_view name) noexcept {
  return std::find(kFunctions.begin(), kFunctions.end(), name) != kFunctions.end();
}

QuantityTokens tokenizeQuantity(std::string_view text, const Dimension& wanted) {
  return Tokenizer(text, wanted).run();
}

}  // namespace nearfit
