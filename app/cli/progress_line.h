#pragma once

namespace nearfit::cli {

/// Shows progress on a terminal, in one line on stderr that goes when it ends. Elsewhere shows nothing.
class ProgressLine {
 public:
  /// @param what  What is going on: "checking".
  explicit ProgressLine(const char* what);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Shows the fraction done, 0 to 1.
  void show(double fraction);

 private:
  const char* what_;
  bool isShown_;
  int percent_ = -1;
};

}  // namespace nearfit::cli
