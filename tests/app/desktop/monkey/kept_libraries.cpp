// Under the address sanitizer libraries stay until the end: of what one kept that is gone (a driver of
// OpenGL) nobody can say whose it was, so that no suppression matches.
#if defined(__SANITIZE_ADDRESS__)

extern "C" int dlclose(void* library) noexcept {
  static_cast<void>(library);
  return 0;
}

#endif
