#pragma once

#include <QWidget>

#include "core/scene/feel_preset.h"

class QAction;
class QComboBox;
class QPushButton;

namespace nearfit::ui {

class PresetStore;

/// Which preset is in force, "Custom" when none is, and the choice of another; with a menu beside it that
/// saves, renames and deletes the user's own.
class PresetChoice : public QWidget {
  Q_OBJECT

 public:
  /// @param name  Of the list, as an object.   @param presets  Outlives this.
  PresetChoice(const char* name, PresetStore& presets, QWidget* parent = nullptr);

  /// Adds the menu.
  void setManaged();
  /// Is no choice.
  void showSettings(const HapticSettings& settings);

 signals:
  /// These are to count from now on.
  /// @param name  Of the preset.
  void chosen(const nearfit::HapticSettings& settings, const QString& name);

 private:
  void listPresets();
  void showInForce();
  void saveAs();
  void renameChosen();
  void deleteChosen();
  /// The name of the user's own that is in force; else empty.
  QString chosenOwn() const;

  PresetStore& presets_;
  QComboBox* box_;
  QPushButton* menuButton_ = nullptr;
  QAction *rename_ = nullptr, *delete_ = nullptr;
  HapticSettings settings_;
};

}  // namespace nearfit::ui
