#include "core/text/json_text.h"

#include <array>
#include <charconv>

namespace nearfit {
namespace {

bool isPlain(const nlohmann::ordered_json& value) {
  if (!value.is_array()) return !value.is_object() || value.empty();
  for (const auto& element : value) {
    if (element.is_structured()) return false;
  }
  return true;
}

/// Recurses to the depth of `value`, which this program made.
void append(const nlohmann::ordered_json& value, std::size_t indent, std::string& text) {
  if (isPlain(value)) {
    if (!value.is_array()) {
      text += value.dump();
      return;
    }
    for (const auto& element : value) {
      text += &element == &value.front() ? "[" : ", ";
      text += element.dump();
    }
    text += value.empty() ? "[]" : "]";
    return;
  }
  const std::string margin(indent + 2, ' ');
  bool isFirst = true;
  text += value.is_object() ? '{' : '[';
  for (const auto& item : value.items()) {
    text += (isFirst ? "\n" : ",\n") + margin;
    isFirst = false;
    if (value.is_object()) text += nlohmann::json(item.key()).dump() + ": ";
    append(item.value(), indent + 2, text);
  }
  text += '\n' + std::string(indent, ' ') + (value.is_object() ? '}' : ']');
}

}  // namespace

std::string prettyJson(const nlohmann::ordered_json& value) {
  std::string text;
  append(value, 0, text);
  return text + '\n';
}

double shortestDouble(float value) {
  std::array<char, 64> digits{};
  const char* const end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  double shortest = 0.0;
  std::from_chars(digits.data(), end, shortest);
  return shortest;
}

}  // namespace nearfit
