/// Read by the leak sanitizer, where a program has one: OpenCASCADE keeps its tables of STEP and IGES until the process ends, and
/// some of them nothing points to any more. Only libraries in which such leaks were seen.
extern "C" const char*
__lsan_default_suppressions();  // NOLINT(bugprone-reserved-identifier): the sanitizer's name.

extern "C" const char* __lsan_default_suppressions() {  // NOLINT(bugprone-reserved-identifier)
  return "leak:libTKernel.so\nleak:libTKXSBase.so\n";
}
