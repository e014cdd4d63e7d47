// NOLINTBEGIN(bugprone-reserved-identifier): the name is the sanitizer's.
extern "C" const char* __lsan_default_suppressions();

/// Read by the leak sanitizer, where a program has one: OpenCASCADE keeps its tables of STEP and IGES until the process ends, and
/// some of them nothing points to any more. Only libraries in which such leaks were seen.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libTKernel.so\nleak:libTKXSBase.so\n";
}
// NOLINTEND(bugprone-reserved-identifier)
