// Under the address sanitizer libraries stay until the end: of what one kept that is gone (a driver of
// OpenGL) nobody can say whose it was, so that no suppression matches.
#ifdef NEARFIT_SANITIZED_ADDRESS

extern "C" int dlclose(void* library) noexcept {
  static_cast<void>(library);
  return 0;
}

#endif
