#pragma once

#include <QWidget>

#include "core/scene/feel_preset.h"

class QAction;
class QComboBox;
class QPushButton;

namespace nearfit::ui {

class PresetStore;

/// Shows the preset in force, or "Custom" if there is none, and lets the user choose another. A menu beside
/// it saves, renames and deletes the user's own presets.
class PresetChoice : public QWidget {
  Q_OBJECT

 public:
  /// @param name     Object name of the list.
  /// @param presets  Must outlive this.
  PresetChoice(const char* name, PresetStore& presets, QWidget* parent = nullptr);

  /// Adds the menu that manages the user's own presets.
  void setManaged();
  /// Shows which preset these settings match; counts as no choice.
  void showSettings(const HapticSettings& settings);

 signals:
  /// Emitted when the user chooses a preset.
  /// @param settings  Settings that apply from now on.
  /// @param name      Name of the preset.
  void chosen(const nearfit::HapticSettings& settings, const QString& name);

 private:
  void listPresets();
  void showInForce();
  void saveAs();
  void renameChosen();
  void deleteChosen();
  /// Returns the name of the preset in force if it is the user's own; else empty.
  QString chosenOwn() const;

  PresetStore& presets_;
  QComboBox* box_;
  QPushButton* menuButton_ = nullptr;
  QAction *rename_ = nullptr, *delete_ = nullptr;
  HapticSettings settings_;
};

}  // namespace nearfit::ui
