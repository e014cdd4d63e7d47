#pragma once

#include <QFrame>

namespace nearfit::ui {

/// What a tool asks for and tells, in a frame over the lower edge of the view. Several that are shown stand
/// over each other, the oldest lowest.
class ViewBar : public QFrame {
  Q_OBJECT

 public:
  /// @param name  Of the object; its style goes by that.
  ViewBar(QWidget* view, const QString& name);

  bool eventFilter(QObject* watched, QEvent* event) override;

 protected:
  void showEvent(QShowEvent* event) override;
  void hideEvent(QHideEvent* event) override;
  /// Its content has changed: as large as that needs, and in its place.
  void place();

 private:
  void placeAll();
};

}  // namespace nearfit::ui
