#pragma once

#include <QObject>
#include <functional>

namespace nearfit::ui {

/// Work on the scene that takes a while, such as loading files, as panels and tools see it.
class SceneWork : public QObject {
  Q_OBJECT

 public:
  using QObject::QObject;

  /// True while something is being loaded or prepared: nothing else may be started then.
  virtual bool isBusy() const = 0;
  /// Builds the missing hierarchies of all parts in another thread, after any work that is going on. Calls
  /// `done` at once if none is missing; isReady is false if the user cancelled or building failed.
  virtual void prepareHierarchies(std::function<void(bool isReady)> done) = 0;

 signals:
  /// Emitted when isBusy() changes.
  void busyChanged();
  /// Emitted before the scene is saved or left. Whoever holds a part must put its pose into the session now.
  void sceneNeeded();
};

}  // namespace nearfit::ui
