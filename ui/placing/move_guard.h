#pragma once

#include <QObject>
#include <QString>
#include <vector>

#include "core/session.h"

namespace nearfit::ui {

/// Says which parts may be moved now, and why not: every way of moving asks here, whether by gizmo, mouse,
/// number, key, drop or alignment.
class MoveGuard : public QObject {
  Q_OBJECT

 public:
  /// Who moves the part in hand.
  enum class Holder { Nobody, ManualHand, ScriptedHand, Device };

  /// @param session  Outlives this.
  explicit MoveGuard(const Session& session, QObject* parent = nullptr);

  void setHolder(Holder holder);
  /// Whether a recording shows the part in hand somewhere else than it is.
  void setReplaying(bool isReplaying);
  /// Whether a recording shows this part.
  bool isReplayed(PartId part) const;

  /// Why a part cannot be moved, as a sentence without a full stop; empty when it can.
  QString refusalOf(const Part& part) const;
  /// The same of parts that are moved together; empty for none. The manual hand leads its part alone.
  QString refusalOf(const std::vector<PartId>& parts) const;

 signals:
  /// The answers are others, and the session is not.
  void changed();

 private:
  QString lockOf(const Part& part) const;

  const Session& session_;
  Holder holder_ = Holder::Nobody;
  bool isReplaying_ = false;
};

}  // namespace nearfit::ui
