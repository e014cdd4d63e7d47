#pragma once

#include <QObject>
#include <filesystem>
#include <functional>
#include <vector>

#include "core/scene/feel_preset.h"
#include "ui/dialogs/error_box.h"

namespace nearfit::ui {

/// What contact feels like, by name: the usual presets and the user's own. Those are kept in a file beside
/// the settings, from one run to the next; what cannot be read of it is put aside and told, and nothing
/// fails.
class PresetStore : public QObject {
  Q_OBJECT

 public:
  /// Reads nothing yet.
  explicit PresetStore(std::filesystem::path file, QObject* parent = nullptr);
  /// In the folder of the settings.
  static std::filesystem::path usualFile();

  /// Of the file, as far as it can be read.
  void load();

  /// The usual ones, then the user's by name.
  const std::vector<FeelPreset>& presets() const noexcept { return presets_; }
  /// The one that makes the settings what they are; of several the one that was chosen last, else the first.
  /// Null: they are the scene's own.
  const FeelPreset* inForce(const HapticSettings& settings) const noexcept;
  /// It is chosen, as it is shown.
  void choose(const FeelPreset& preset);
  bool isOwn(const QString& name) const;
  /// Why a preset cannot have that name; empty when it can, one that is the user's included.
  QString refusalOf(const QString& name) const;

  /// Under a name that refusalOf has nothing against; one of that name is replaced.
  void keep(const QString& name, const HapticSettings& settings);
  void rename(const QString& from, const QString& to);
  void remove(const QString& name);

 signals:
  /// There are others.
  void changed();
  /// What inForce says may be another.
  void choiceChanged();
  void noted(const QString& text);
  void failed(const nearfit::ui::Failure& failure);

 private:
  void take(std::vector<FeelPreset> own);
  /// What another window has written since is there too.
  void edit(const std::function<void(std::vector<FeelPreset>&)>& change);
  std::vector<FeelPreset> own() const;
  void putAside(const QString& why);

  const std::filesystem::path file_;
  std::vector<FeelPreset> presets_;
  std::string chosen_;  ///< Its name.
};

/// As it is shown: the usual ones in the user's language.
QString shownName(const FeelPreset& preset);

}  // namespace nearfit::ui
