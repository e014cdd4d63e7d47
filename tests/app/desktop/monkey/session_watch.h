#pragma once

#include <QObject>
#include <QStringList>
#include <map>
#include <string>

#include "core/session/session.h"
#include "tests/app/desktop/desktop_driver.h"
#include "tests/exact/pose_certifier.h"

namespace nearfit::test {

/// Looks at each state that a session comes to, and tells what must never be: knows each by its serial, so
/// that undo and redo have to bring back just what was there, and asks exact predicates whether what was
/// moved solidly has come to meet something.
class SessionWatch {
 public:
  /// @param driver  Outlives this.
  explicit SessionWatch(DesktopDriver& driver);
  SessionWatch(const SessionWatch&) = delete;
  SessionWatch& operator=(const SessionWatch&) = delete;

  /// Once nothing is under way: selection, title, and the way to the oldest state and to the newest and back.
  void check();
  /// All so far.
  const QStringList& faults() const noexcept { return faults_; }

 private:
  void see();
  void seeSolidMove(const Scene& before, const Scene& after);
  void checkSelection();
  void checkTitle();
  void checkHistory();
  bool doMeet(const Part& a, const Part& b);
  void expect(bool isTrue, const QString& fault);

  DesktopDriver& d_;
  std::map<std::uint64_t, std::string> known_;  ///< States by their serials.
  Scene last_;
  std::size_t lastIndex_ = 0;
  bool wasSolid_ = false;  ///< Since the last state.
  /// Of pairs of geometries, which it keeps so that no other has their address.
  struct Pair {
    PartGeometryPtr a, b;
    PoseCertifier certifier;
  };
  std::map<std::pair<const PartGeometry*, const PartGeometry*>, Pair> pairs_;
  QStringList faults_;
  QObject context_;  ///< Of the connections to this.
  Subscription changes_;
};

/// All of a scene that its user could tell from another.
std::string textOf(const Scene& scene);

}  // namespace nearfit::test
