/// What the sanitizers are to leave out, for programs with the rig: GLib locks with futexes of its own, which
/// the thread sanitizer does not see, so that everything umockdev hands from thread to thread looks raced
/// for; libudev seeds its hashes in any thread.
// The sanitizer's own name. NOLINTNEXTLINE(bugprone-reserved-identifier)
extern "C" const char* __tsan_default_suppressions() {
  return "called_from_lib:libumockdev.so\n"
         "called_from_lib:libglib-2.0.so\n"
         "called_from_lib:libgobject-2.0.so\n"
         "called_from_lib:libgio-2.0.so\n"
         "called_from_lib:libudev.so\n"
         "race:libglib-2.0.so\n"
         "race:libgio-2.0.so\n"
         "race:libgobject-2.0.so\n"
         "race:libudev.so\n"
         "race:libusb-1.0.so\n"
         "race:libumockdev.so\n";
}

// The sanitizer's own name. NOLINTNEXTLINE(bugprone-reserved-identifier)
extern "C" const char* __lsan_default_suppressions() {
  // Types and the main context, kept till the end.
  return "leak:libglib-2.0.so\n"
         "leak:libgobject-2.0.so\n"
         "leak:libgio-2.0.so\n"
         "leak:libumockdev.so\n";
}
