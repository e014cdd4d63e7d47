#include "ui/model/preset_store.h"

#include <QFileInfo>
#include <QSettings>
#include <algorithm>
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "ui/widgets/paths.h"

namespace nearfit::ui {
namespace {

bool isSameName(const QString& a, const QString& b) {
  return a.compare(b, Qt::CaseInsensitive) == 0;
}

auto named(std::string name) {
  return [name = std::move(name)](const FeelPreset& preset) { return preset.name == name; };
}

}  // namespace

QString shownName(const FeelPreset& preset) {
  const QString name = QString::fromStdString(preset.name);
  if (!preset.isOfStiffnessAlone) return name;
  // The names in usualFeelPresets().
  const std::pair<const char*, QString> names[] = {{"Soft", PresetStore::tr("Soft")},
                                                   {"Medium", PresetStore::tr("Medium")},
                                                   {"Stiff", PresetStore::tr("Stiff")}};
  for (const auto& [usual, shown] : names) {
    if (preset.name == usual) return shown;
  }
  return name;
}

PresetStore::PresetStore(std::filesystem::path file, QObject* parent)
    : QObject(parent), file_(std::move(file)) {
  take({});
}

std::filesystem::path PresetStore::usualFile() {
  return toPath(QFileInfo(QSettings().fileName()).absolutePath()) / "feel-presets.json";
}

void PresetStore::load() {
  try {
    FeelPresetFile read = readFeelPresets(file_);
    if (!read.problems.empty()) putAside(QString::fromStdString(read.problems.front()));
    take(std::move(read.presets));
  } catch (const Error& error) {
    putAside(QString::fromStdString(error.problem()));
    take({});
  }
}

void PresetStore::putAside(const QString& why) {
  std::filesystem::path aside = file_;
  aside.replace_extension(".damaged.json");
  std::error_code error;
  std::filesystem::copy_file(file_, aside, std::filesystem::copy_options::overwrite_existing, error);
  QString text = tr("Some feel presets could not be read (%1).").arg(why);
  if (!error) text += QChar(' ') + tr("The old file is kept as %1.").arg(fromPath(aside));
  emit noted(text);
}

void PresetStore::take(std::vector<FeelPreset> own) {
  std::ranges::sort(own, [](const FeelPreset& a, const FeelPreset& b) {
    return QString::localeAwareCompare(QString::fromStdString(a.name), QString::fromStdString(b.name)) < 0;
  });
  std::vector<FeelPreset> all(usualFeelPresets().begin(), usualFeelPresets().end());
  all.insert(all.end(), own.begin(), own.end());
  presets_ = std::move(all);
  emit changed();
}

std::vector<FeelPreset> PresetStore::own() const {
  return {presets_.begin() + static_cast<std::ptrdiff_t>(usualFeelPresets().size()), presets_.end()};
}

const FeelPreset* PresetStore::inForce(const HapticSettings& settings) const noexcept {
  const FeelPreset* first = nullptr;
  for (const FeelPreset& preset : presets_) {
    if (!isInForce(preset, settings)) continue;
    if (preset.name == chosen_) return &preset;
    if (first == nullptr) first = &preset;
  }
  return first;
}

void PresetStore::choose(const FeelPreset& preset) {
  chosen_ = preset.name;
  emit choiceChanged();
}

bool PresetStore::isOwn(const QString& name) const {
  const std::vector<FeelPreset> all = own();
  return std::ranges::any_of(all, named(name.toStdString()));
}

QString PresetStore::refusalOf(const QString& name) const {
  for (const FeelPreset& preset : usualFeelPresets()) {
    if (isSameName(name, shownName(preset)) || isSameName(name, QString::fromStdString(preset.name)))
      return tr("A built-in preset has this name.");
  }
  if (!isOwn(name) && own().size() >= kMaxFeelPresets) return tr("There are too many presets: delete one.");
  try {
    checkFeelPreset({name.toStdString(), {}});
  } catch (const UsageError& error) {
    QString problem = QString::fromStdString(error.problem());
    problem[0] = problem[0].toUpper();
    return problem + QChar('.');
  }
  return {};
}

void PresetStore::edit(const std::function<void(std::vector<FeelPreset>&)>& change) {
  load();
  std::vector<FeelPreset> next = own();
  change(next);
  try {
    writeFeelPresets(file_, next);
  } catch (...) {
    emit failed(describe(tr("The feel presets could not be saved."), std::current_exception()));
    return;
  }
  take(std::move(next));
}

void PresetStore::keep(const QString& name, const HapticSettings& settings) {
  edit([&](std::vector<FeelPreset>& presets) {
    std::erase_if(presets, named(name.toStdString()));
    presets.push_back({name.toStdString(), settings});
    chosen_ = name.toStdString();
  });
}

void PresetStore::rename(const QString& from, const QString& to) {
  if (from == to) return;
  edit([&](std::vector<FeelPreset>& presets) {
    std::erase_if(presets, named(to.toStdString()));
    for (FeelPreset& preset : presets) {
      if (preset.name == from.toStdString()) preset.name = to.toStdString();
    }
    chosen_ = to.toStdString();
  });
}

void PresetStore::remove(const QString& name) {
  edit([&](std::vector<FeelPreset>& presets) { std::erase_if(presets, named(name.toStdString())); });
}

}  // namespace nearfit::ui
