#pragma once

#include <QObject>
#include <vector>

#include "core/session/session.h"
#include "ui/view3d/joint_marks.h"

namespace nearfit::ui {

class Selection;
class Viewport;

/// Draws the joints of the moving part and of the selected parts in the view, where their bases are shown. Joints that
/// are off, and those of hidden parts, are not drawn.
class ShownJoints : public QObject {
  Q_OBJECT

 public:
  /// @param session, selection, view  Outlive this.
  ShownJoints(const Session& session, const Selection& selection, Viewport& view, QObject* parent);
  ~ShownJoints() override;

  /// Marks drawn now.
  const std::vector<JointMark>& marks() const noexcept { return marks_; }

  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void refresh();
  JointMark markOf(const Joint& joint, const Part& part) const;

  const Session& session_;
  const Selection& selection_;
  Viewport& view_;
  JointMarks drawn_;
  std::vector<JointMark> marks_;
};

}  // namespace nearfit::ui
