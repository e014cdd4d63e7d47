#pragma once

#include <sys/types.h>
#include <unistd.h>

namespace nearfit::test {

/// While it lives, an administrator works as nobody, for whom permissions count; other users as themselves.
class Unprivileged {
 public:
  static constexpr ::uid_t kNobody = 65534;

  Unprivileged() : wasRoot_(::geteuid() == 0), isTaken_(!wasRoot_ || ::seteuid(kNobody) == 0) {}
  ~Unprivileged() {
    if (wasRoot_ && isTaken_ && ::seteuid(0) != 0) ::_exit(1);
  }
  Unprivileged(const Unprivileged&) = delete;
  Unprivileged& operator=(const Unprivileged&) = delete;

  /// False where the system does not let an administrator do so.
  bool isTaken() const noexcept { return isTaken_; }

 private:
  bool wasRoot_, isTaken_;
};

}  // namespace nearfit::test
