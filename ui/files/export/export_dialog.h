#pragma once

#include <QDialog>
#include <optional>

#include "core/report/scene_export.h"

class QComboBox;
class QLabel;
class QRadioButton;

namespace nearfit::ui {

/// Asks what to export (format, parts, unit, schema of a STEP file), and says what the file will hold. Remembers the choices from
/// one time to the next.
class ExportDialog : public QDialog {
  Q_OBJECT

 public:
  /// @param scene     Holds the moving part where it is now.
  /// @param selected  Selected parts; may be empty.
  /// @param kind      Offered at first; nullopt: the one exported last.
  ExportDialog(Scene scene, std::vector<PartId> selected, QWidget* parent,
               std::optional<ExportKind> kind = std::nullopt);

  /// Returns what the user chose.
  SceneExport choice() const;

 private:
  void setUpFields();
  void restore();
  void remember() const;
  void showSummary();
  QString meshSummary(MeshFileKind kind) const;
  QString assemblySummary(ExportKind kind) const;
  QString placementSummary() const;
  QString mapSummary() const;

  const Scene scene_;
  const std::vector<PartId> selected_;
  QComboBox *kind_, *unit_, *schema_;
  QRadioButton *visible_, *chosen_;
  QLabel *unitLabel_, *schemaLabel_, *partsLabel_, *summary_;
};

}  // namespace nearfit::ui
