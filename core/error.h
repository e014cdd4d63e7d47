#pragma once

#include <stdexcept>
#include <string>

namespace nearfit {

/// What went wrong, where, and what the user can do about it.
///
/// Thrown by loading, configuring and connecting; caught once, in app. Never thrown by queries or servo code.
class Error : public std::runtime_error {
 public:
  /// @param where    The file with line or byte, the option, the field or the device concerned.
  /// @param problem  What is wrong there, as a sentence without a full stop.
  /// @param remedy   What to do about it, as an imperative without a full stop; may be empty.
  Error(std::string where, std::string problem, std::string remedy = {});

  const std::string& where() const noexcept { return where_; }
  const std::string& problem() const noexcept { return problem_; }
  const std::string& remedy() const noexcept { return remedy_; }

 private:
  std::string where_, problem_, remedy_;
};

/// A file, or a path to one, that cannot be read or written.
class FileError : public Error {
 public:
  using Error::Error;
};

/// Arguments or values that a caller or user gave and that make no sense.
class UsageError : public Error {
 public:
  using Error::Error;
};

/// Long work that the user stopped.
class Cancelled : public Error {
 public:
  Cancelled() : Error("", "cancelled") {}
};

}  // namespace nearfit
