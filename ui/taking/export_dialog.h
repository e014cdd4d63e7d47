#pragma once

#include <QDialog>

#include "core/report/scene_export.h"

class QComboBox;
class QLabel;
class QRadioButton;

namespace nearfit::ui {

/// Asks what is taken away of the scene (format, parts, unit), and says what will be in the file. Remembers
/// the choices from one time to the next.
class ExportDialog : public QDialog {
  Q_OBJECT

 public:
  /// @param scene     With the moving part where it is now.
  /// @param selected  Parts that are selected; may be empty.
  ExportDialog(Scene scene, std::vector<PartId> selected, QWidget* parent);

  SceneExport choice() const;

 private:
  void setUpFields();
  void restore();
  void remember() const;
  void showSummary();
  QString meshSummary(MeshFileKind kind) const;
  QString placementSummary() const;

  const Scene scene_;
  const std::vector<PartId> selected_;
  QComboBox *kind_, *unit_;
  QRadioButton *visible_, *chosen_;
  QLabel *unitLabel_, *partsLabel_, *summary_;
};

}  // namespace nearfit::ui
