#pragma once

#include <QDialog>

#include "core/haptics/rate_settings.h"
#include "core/servo/servo_snapshot.h"
#include "ui/panels/feel/proxy_page.h"

class QComboBox;
class QLabel;
class QPushButton;
class QStackedWidget;

namespace nearfit::ui {

class PresetChoice;
class PresetStore;
class SpaceMousePage;
class SpringPage;
class WeightPage;
class WorkspacePage;

/// Edits how contact feels: mode, the mode's own numbers, weight, and the device's workspace. Each
/// change applies at once; undo takes one back, *Revert* all since the dialog was opened. Stays open
/// beside the window.
class FeelDialog : public QDialog {
  Q_OBJECT

 public:
  /// @param presets  Must outlive this.
  explicit FeelDialog(PresetStore& presets, QWidget* parent = nullptr);

  /// Shows the scene's settings, and what depends on its moving part.
  void showScene(const Scene& scene);
  /// Says why a change was refused; empty: the last one was accepted.
  void showRefusal(const QString& why);
  /// Shows how a space mouse drives the hand: a setting of the user's, whatever the scene.
  void showRate(const RateSettings& settings);
  /// Sets the limits of the device in hand, or of the usual one.
  void setDevice(const DeviceLimits& limits);
  /// Shows what is in force while the servo runs.
  void showSnapshot(const ServoSnapshot& snapshot);
  /// Shows the nominal values again, once the servo has stopped.
  void clearSnapshot();

 signals:
  /// Emitted when the user chooses a preset or edits a setting.
  void presetChosen(const nearfit::HapticSettings& settings, const QString& name);
  void settingsEdited(const nearfit::HapticSettings& settings);
  void rateEdited(const nearfit::RateSettings& settings);

 private:
  void showEvent(QShowEvent* event) override;
  QWidget* makeHead(PresetStore& presets);
  QWidget* makeButtons();
  void edit(const HapticSettings& settings);
  void refresh();
  /// Makes room for texts that wrap.
  void growToContent();
  void showMovingPart(const Scene& scene);
  void showBasis();

  HapticSettings settings_, opened_;
  CouplingBasis basis_;
  PartGeometryPtr moving_;
  PresetChoice* preset_;
  QComboBox* mode_;
  QLabel *explanation_, *refusal_;
  QPushButton* revert_;
  FeelPage* cutoff_;
  QStackedWidget* contact_;
  ProxyPage* proxy_;
  SpringPage* springs_;
  WeightPage* weight_;
  WorkspacePage* workspace_;
  SpaceMousePage* spaceMouse_;
};

}  // namespace nearfit::ui
