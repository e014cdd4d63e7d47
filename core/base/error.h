#pragma once

#include <exception>
#include <stdexcept>
#include <string>

namespace nearfit {

/// An error with its place, the problem and a remedy.
///
/// Thrown by loading, configuring and connecting; caught once, in app. Never thrown by queries or servo code.
class Error : public std::runtime_error {
 public:
  /// @param where    The file (with line or byte), option, field or device concerned.
  /// @param problem  What is wrong, as a sentence without a full stop.
  /// @param remedy   What to do about it, as an imperative without a full stop; may be empty.
  Error(std::string where, std::string problem, std::string remedy = {});

  const std::string& where() const noexcept { return where_; }
  const std::string& problem() const noexcept { return problem_; }
  const std::string& remedy() const noexcept { return remedy_; }

 private:
  std::string where_, problem_, remedy_;
};

/// A file or path cannot be read or written.
class FileError : public Error {
 public:
  using Error::Error;
};

/// An argument or value given by a caller or user is invalid.
class UsageError : public Error {
 public:
  using Error::Error;
};

/// The user stopped long work.
class Cancelled : public Error {
 public:
  Cancelled() : Error("", "cancelled") {}
};

/// True if `error` is Cancelled; false if null.
bool isCancelled(const std::exception_ptr& error);

}  // namespace nearfit
