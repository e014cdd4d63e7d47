#pragma once

#include <QDialog>

#include "core/haptics/rate_settings.h"
#include "core/haptics/servo_snapshot.h"
#include "ui/dialogs/proxy_page.h"

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

/// How contact feels: mode, the mode's own numbers, weight, and the device's way into the scene. Each change
/// counts at once; undo takes it back, and *Revert* all since the dialog was opened. Stays open beside the
/// window.
class FeelDialog : public QDialog {
  Q_OBJECT

 public:
  /// @param presets  Outlives this.
  explicit FeelDialog(PresetStore& presets, QWidget* parent = nullptr);

  /// The scene's settings, and what belongs to its moving part.
  void showScene(const Scene& scene);
  /// Says why a change was refused; empty when the last one was not.
  void showRefusal(const QString& why);
  /// How a space mouse drives; of the user, whatever the scene.
  void showRate(const RateSettings& settings);
  /// Of the device in hand, or of the usual one.
  void setDevice(const DeviceLimits& limits);
  void showSnapshot(const ServoSnapshot& snapshot);
  void clearSnapshot();

 signals:
  void presetChosen(const nearfit::HapticSettings& settings, const QString& name);
  void settingsEdited(const nearfit::HapticSettings& settings);
  void rateEdited(const nearfit::RateSettings& settings);

 private:
  void showEvent(QShowEvent* event) override;
  QWidget* makeHead(PresetStore& presets);
  QWidget* makeButtons();
  void edit(const HapticSettings& settings);
  void refresh();
  /// Texts that wrap may need more room than the dialog has.
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
