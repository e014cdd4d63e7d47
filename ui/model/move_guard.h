#pragma once

#include <QObject>
#include <QString>
#include <vector>

#include "core/session/session.h"

namespace nearfit::ui {

class HandState;
struct PoseSubject;

/// Decides which parts may be moved now, and says why not. Every way of moving asks it: gizmo, mouse,
/// numbers, keys, drop and alignment.
class MoveGuard : public QObject {
  Q_OBJECT

 public:
  /// @param session, hand  Outlive this.
  MoveGuard(const Session& session, const HandState& hand, QObject* parent = nullptr);

  /// Set true while a recording shows the moving part away from its pose.
  void setReplaying(bool isReplaying);

  /// Returns why a part cannot be moved, as a sentence without a full stop; empty if it can.
  QString refusalOf(const Part& part) const;
  /// The same for parts moved together; empty if there are none. The part of the manual
  /// hand moves only alone.
  QString refusalOf(const std::vector<PartId>& parts) const;
  /// The same for what numbers and keys move: the group in hand is moved as one by the manual hand.
  QString refusalOf(const PoseSubject& subject) const;

 signals:
  /// Emitted when refusals changed without a change of the session.
  void changed();

 private:
  /// True if a recording shows this part.
  bool isReplayed(PartId part) const;
  QString lockOf(const Part& part) const;
  /// Returns why a part cannot be moved, whoever holds it.
  QString refusalOfScene(const Part& part) const;

  const Session& session_;
  const HandState& hand_;
  bool isReplaying_ = false;
};

}  // namespace nearfit::ui
