#pragma once

#include <initializer_list>
#include <stdexcept>
#include <string>

#include <dlfcn.h>

/// What the plug-ins of this tree share. Each is a module of its own and links nothing else of Nearfit.
namespace nearfit::plugin {

/// Thrown by a plug-in's own code; its text is a sentence for the user.
class PluginError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Thrown if the maker's driver is not installed or does not run; its text says what to install.
class DriverMissing : public PluginError {
 public:
  using PluginError::PluginError;
};

/// Keeps this plug-in loaded until the program ends: for a thread of its own that is left behind.
inline void keepLoaded() noexcept {
  static const char inside = 0;
  Dl_info here{};
  // One more use of the library, which nobody gives back.
  if (::dladdr(&inside, &here) != 0) ::dlopen(here.dli_fname, RTLD_NOW | RTLD_LOCAL | RTLD_NOLOAD);
}

/// A maker's library, found by the system's loader at run time. Stays loaded until the program ends: such libraries
/// have threads of their own.
class MakerLibrary {
 public:
  /// Loads the first of the names that the loader finds.
  /// @param remedy  What to install if it finds none: the text of DriverMissing.
  MakerLibrary(std::initializer_list<const char*> names, const std::string& remedy) {
    for (const char* name : names) {
      library_ = ::dlopen(name, RTLD_NOW | RTLD_LOCAL);
      if (library_ == nullptr) continue;
      name_ = name;
      return;
    }
    throw DriverMissing(remedy);
  }

  const std::string& name() const noexcept { return name_; }
  /// Finds a function; false if this version of the library has none of that name.
  template <class Function>
  bool find(Function*& function, const char* symbol) const noexcept {
    function = reinterpret_cast<Function*>(::dlsym(library_, symbol));
    return function != nullptr;
  }
  /// Finds a function. Throws DriverMissing that names it.
  /// @param remedy  What to install instead of a version without it.
  template <class Function>
  void take(Function*& function, const char* symbol, const std::string& remedy) const {
    if (!find(function, symbol))
      throw DriverMissing(name_ + " lacks " + symbol + ", so it is too old or another library: " + remedy);
  }

 private:
  void* library_ = nullptr;
  std::string name_;
};

}  // namespace nearfit::plugin
