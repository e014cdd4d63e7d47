#include <algorithm>
#include <system_error>

#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "core/scene/feel_preset.h"
#include "core/scene/scene_file_haptics.h"
#include "core/text/json_text.h"

namespace nearfit {
namespace {

constexpr const char* kFormat = "nearfit feel presets";
constexpr int kVersion = 1;

FeelPreset readPreset(const JsonField& field) {
  FeelPreset preset;
  preset.name = field.at("name").text(kMaxFeelPresetNameBytes);
  preset.settings = readHaptics(field.at("haptics"));
  try {
    checkFeelPreset(preset);
  } catch (const UsageError& e) {
    field.at("name").fail(e.problem(), e.remedy());
  }
  return preset;
}

void requireFormat(const JsonField& root) {
  if (root.at("format").text(64) != kFormat) root.at("format").fail("this is not a file of feel presets");
  if (root.at("version").number() != kVersion)
    root.at("version").fail("the file was written by another version of Nearfit", "update Nearfit");
}

}  // namespace

FeelPresetFile readFeelPresets(const std::filesystem::path& file) {
  FeelPresetFile result;
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return result;
  const nlohmann::json json = readJsonFile(file);
  const JsonField root(json, file);
  requireFormat(root);
  const JsonField entries = root.at("presets");
  const std::size_t count = std::min(entries.size(), kMaxFeelPresets);
  for (std::size_t i = 0; i < count; ++i) {
    try {
      FeelPreset preset = readPreset(entries.at(i));
      if (std::ranges::find(result.presets, preset.name, &FeelPreset::name) != result.presets.end())
        entries.at(i).at("name").fail("another preset has this name");
      result.presets.push_back(std::move(preset));
    } catch (const Error& error) {
      result.problems.emplace_back(error.what());
    }
  }
  if (entries.size() > count) result.problems.emplace_back("there are too many presets");
  return result;
}

void writeFeelPresets(const std::filesystem::path& file, std::span<const FeelPreset> presets) {
  nlohmann::ordered_json json{
      {"format", kFormat}, {"version", kVersion}, {"presets", nlohmann::ordered_json::array()}};
  for (const FeelPreset& preset : presets)
    json["presets"].push_back({{"name", preset.name}, {"haptics", hapticsJson(preset.settings)}});
  std::error_code ignored;
  std::filesystem::create_directories(file.parent_path(), ignored);
  atomicWrite(file, prettyJson(json));
}

}  // namespace nearfit
