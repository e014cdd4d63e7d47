#pragma once

#include <QObject>
#include <filesystem>
#include <functional>
#include <vector>

#include "core/scene/feel_preset.h"
#include "ui/widgets/error_box.h"

namespace nearfit::ui {

/// Feel presets by name: the usual ones and the user's own. The user's own are kept between runs in a file
/// beside the settings. What cannot be read of it is put aside with a note; nothing fails.
class PresetStore : public QObject {
  Q_OBJECT

 public:
  /// Reads nothing yet.
  explicit PresetStore(std::filesystem::path file, QObject* parent = nullptr);
  /// Returns the usual file, in the folder of the settings.
  static std::filesystem::path usualFile();

  /// Reads the file as far as possible.
  void load();

  /// Returns the usual presets, then the user's own by name.
  const std::vector<FeelPreset>& presets() const noexcept { return presets_; }
  /// Returns the preset that the settings match: of several the one chosen last, else the first. Null if the
  /// settings match none.
  const FeelPreset* inForce(const HapticSettings& settings) const noexcept;
  /// Makes a preset the one chosen last.
  void choose(const FeelPreset& preset);
  /// True if the user has a preset of that name.
  bool isOwn(const QString& name) const;
  /// Returns why a preset cannot have that name; empty if it can, even if one of the user's own has it.
  QString refusalOf(const QString& name) const;

  /// Keeps settings under a name that refusalOf() accepts; replaces a preset of that name.
  void keep(const QString& name, const HapticSettings& settings);
  /// Renames a preset of the user's own; replaces one named `to`.
  void rename(const QString& from, const QString& to);
  /// Deletes a preset of the user's own.
  void remove(const QString& name);

 signals:
  /// Emitted when the list of presets changed.
  void changed();
  /// Emitted when inForce() may return another preset.
  void choiceChanged();
  /// Emitted with a short note for the status bar.
  void noted(const QString& text);
  /// Emitted when something failed that the user must see.
  void failed(const nearfit::ui::Failure& failure);

 private:
  void take(std::vector<FeelPreset> own);
  /// Reads the file again, to keep what another window has written, applies `change` and writes it.
  void edit(const std::function<void(std::vector<FeelPreset>&)>& change);
  std::vector<FeelPreset> own() const;
  void putAside(const QString& why);

  const std::filesystem::path file_;
  std::vector<FeelPreset> presets_;
  std::string chosen_;  ///< Name of the preset chosen last.
};

/// Returns the name to show: the usual presets have one in the user's language.
QString shownName(const FeelPreset& preset);

}  // namespace nearfit::ui
