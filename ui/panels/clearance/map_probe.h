#pragma once

#include <QLabel>
#include <QPoint>
#include <memory>

#include "ui/panels/clearance/map_search.h"

namespace nearfit::ui {

class Viewport;

/// A label beside the pointer with the clearance of the coloured surface under it. Drags and clicks go to the view as
/// ever.
class MapProbe : public QLabel {
  Q_OBJECT

 public:
  /// @param view  The parent.
  MapProbe(Viewport& view, const Session& session);

  /// Sets the map that is shown; null: no label.
  void setMap(std::shared_ptr<const ShownMap> map);

  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void probe();
  /// Returns the label for what is seen at the pointer; empty if that is not coloured.
  QString textAt(const QPoint& position) const;

  Viewport& view_;
  const Session& session_;
  std::shared_ptr<const ShownMap> map_;
  QPoint pointer_;
  bool isQueued_ = false;
};

}  // namespace nearfit::ui
