#include "device/plugin/device_plugin.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <system_error>
#include <utility>

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/auxv.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/files/user_folders.h"
#include "device/interface/device_error.h"

namespace nearfit {
namespace {

namespace fs = std::filesystem;

using ErrorText = std::array<char, 512>;

std::string textOf(const ErrorText& error) {
  const std::string text(error.data(), ::strnlen(error.data(), error.size()));
  return text.empty() ? "its plug-in gives no reason" : text;
}

[[noreturn]] void refuse(const fs::path& file, std::string problem, std::string remedy) {
  throw DeviceError(DeviceProblem::Unsupported, file.string(), std::move(problem), std::move(remedy));
}

/// A file or folder that is open.
class Opened {
 public:
  explicit Opened(int descriptor) : descriptor_(descriptor) {}
  ~Opened() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  Opened(const Opened&) = delete;
  Opened& operator=(const Opened&) = delete;

  int descriptor() const noexcept { return descriptor_; }
  int release() noexcept { return std::exchange(descriptor_, -1); }

 private:
  int descriptor_;
};

struct stat statusOf(const Opened& opened, const fs::path& file) {
  struct stat status{};
  if (opened.descriptor() < 0 || ::fstat(opened.descriptor(), &status) != 0)
    refuse(file, std::strerror(errno), "check the path");
  return status;
}

bool isTrusted(const struct stat& status) noexcept {
  return status.st_uid == 0 || status.st_uid == ::geteuid();
}

/// The plug-in's code runs as the user, so nobody else may have written it.
/// @param what   "it", the file, or "its folder".
/// @param place  Path of either.
void checkOwner(const struct stat& status, const fs::path& file, const std::string& what,
                const fs::path& place) {
  if (!isTrusted(status))
    refuse(file, what + " belongs to another user", "have it installed by root, or copy it yourself");
  if ((status.st_mode & (S_IWGRP | S_IWOTH)) != 0)
    refuse(file, "other users can write to " + what, "run: chmod go-w " + place.string());
}

/// Whoever may write to a folder above can put another folder in the place of what is in it. In a sticky one, as /tmp,
/// nobody can but the owner of what is replaced.
/// @param folder  Checked by itself; those above it are checked here.
/// @param place   Its path without links.
void checkFoldersAbove(const fs::path& file, const Opened& folder, const fs::path& place) {
  // By "..", not by name: no link leads past a folder.
  const Opened above(::openat(folder.descriptor(), "..", O_PATH | O_DIRECTORY | O_CLOEXEC));
  const struct stat status = statusOf(above, file), statusBelow = statusOf(folder, file);
  const bool isRoot = status.st_dev == statusBelow.st_dev && status.st_ino == statusBelow.st_ino;
  if (isRoot) return;
  const fs::path name = place.parent_path();
  const std::string what = "the folder " + name.string() + " above it";
  if (!isTrusted(status))
    refuse(file, what + " belongs to another user", "have it installed by root, or copy it yourself");
  const bool isSticky = (status.st_mode & S_ISVTX) != 0 && isTrusted(statusBelow);
  if ((status.st_mode & (S_IWGRP | S_IWOTH)) != 0 && !isSticky)
    refuse(file, "other users can write to " + what, "run: chmod go-w " + name.string());
  checkFoldersAbove(file, above, name);
}

/// Opens a plug-in's file and checks it and its folders through descriptors: names may stand for other files a
/// moment later. Returns the file's descriptor.
int openChecked(const fs::path& file) {
  const fs::path whole = fs::absolute(file);
  const Opened folder(::open(whole.parent_path().c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
  const struct stat folderStatus = statusOf(folder, file);
  // Without O_NONBLOCK a pipe would wait for its other end.
  Opened opened(::openat(folder.descriptor(), whole.filename().c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  const struct stat status = statusOf(opened, file);
  if (!S_ISREG(status.st_mode)) refuse(file, "it is not a file", "put the plug-in file there");
  checkOwner(status, file, "it", file);
  checkOwner(folderStatus, file, "its folder", whole.parent_path());
  checkFoldersAbove(file, folder, fs::weakly_canonical(whole.parent_path()));
  return opened.release();
}

/// Name by which the loader opens, and from then on knows, the file of a descriptor.
std::string loaderName(int descriptor) {
  return "/proc/self/fd/" + std::to_string(descriptor);
}

/// True if the loader still has a library of this name, such as one that must not be unloaded.
bool isKnownToLoader(int descriptor) {
  void* library = ::dlopen(loaderName(descriptor).c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NOLOAD);
  if (library != nullptr) ::dlclose(library);
  return library != nullptr;
}

/// The loader's last message, with the file's own name.
std::string loaderProblem(const fs::path& file, int descriptor) {
  const char* const said = ::dlerror();
  std::string text = said != nullptr ? said : "the loader gives no reason";
  const std::string name = loaderName(descriptor);
  if (text.starts_with(name)) text.replace(0, name.size(), file.string());
  return text;
}

void checkFunctions(const fs::path& file, const NearfitDevicePlugin* functions) {
  if (functions == nullptr)
    refuse(file, "the plug-in offers no functions", "ask its maker for a working version");
  if (functions->version != NEARFIT_DEVICE_VERSION || functions->size != sizeof(NearfitDevicePlugin)) {
    refuse(file,
           "it is made for version " + std::to_string(functions->version) +
               " of the plug-in interface, but this is version " + std::to_string(NEARFIT_DEVICE_VERSION),
           "install the plug-in for this version of Nearfit");
  }
  const bool isWhole =
      functions->name != nullptr && functions->count != nullptr && functions->describe != nullptr &&
      functions->open != nullptr && functions->close != nullptr && functions->details != nullptr &&
      functions->set_forces != nullptr && functions->read != nullptr && functions->write != nullptr;
  if (!isWhole) refuse(file, "it lacks required functions", "ask its maker for a working version");
}

template <std::size_t n>
void endText(char (&text)[n]) noexcept {
  text[n - 1] = '\0';
}

}  // namespace

std::string descriptionProblem(NearfitDeviceDescription& device) {
  endText(device.name);
  endText(device.serial);
  const std::array<double, 8> numbers = {device.max_force,          device.max_torque, device.damping,
                                         device.rotational_damping, device.mass,       device.inertia,
                                         device.max_speed,          device.rate};
  if (!std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x) && x >= 0.0; }))
    return "a number is negative or not finite";
  if (device.rate != 0.0 && !(device.rate >= kMinPluginRate && device.rate <= kMaxPluginRate)) {
    return fmt::format("its rate is {:g} Hz, but has to be 0 or from {:g} to {:g} Hz", device.rate,
                       kMinPluginRate, kMaxPluginRate);
  }
  if (device.force_axes != 0 && device.force_axes != 3 && device.force_axes != 6)
    return fmt::format("it pushes along {} axes, but has to along 0, 3 or 6", device.force_axes);
  if (device.sensed_axes != 3 && device.sensed_axes != 6)
    return fmt::format("it senses {} axes, but has to sense 3 or 6", device.sensed_axes);
  return {};
}

std::shared_ptr<const DevicePlugin> DevicePlugin::load(const fs::path& file) {
  std::shared_ptr<DevicePlugin> plugin(new DevicePlugin);
  plugin->file_ = file;
  plugin->descriptor_ = openChecked(file);
  plugin->library_ = ::dlopen(loaderName(plugin->descriptor_).c_str(), RTLD_NOW | RTLD_LOCAL);
  if (plugin->library_ == nullptr)
    refuse(file, "it cannot be loaded: " + loaderProblem(file, plugin->descriptor_),
           "install the libraries that it needs, or remove it");
  using Entry = const NearfitDevicePlugin* (*)();
  const auto entry = reinterpret_cast<Entry>(::dlsym(plugin->library_, "nearfit_device_plugin"));
  if (entry == nullptr)
    refuse(file, "it is a library, but not a device plug-in", "remove it from this folder");
  const NearfitDevicePlugin* functions = entry();
  checkFunctions(file, functions);
  plugin->functions_ = functions;
  return plugin;
}

DevicePlugin::~DevicePlugin() {
  if (library_ != nullptr) ::dlclose(library_);
  // For the next file with this descriptor the loader would return a library that it still knows by its name.
  if (descriptor_ >= 0 && !isKnownToLoader(descriptor_)) ::close(descriptor_);
}

std::vector<NearfitDeviceDescription> DevicePlugin::devices() const {
  ErrorText error{};
  const std::int32_t count = functions_->count(error.data(), error.size());
  if (count == NEARFIT_DEVICE_NO_DRIVER) {
    throw DeviceError(DeviceProblem::NoDriver, name(), "its maker's driver is not installed or does not run",
                      textOf(error));
  }
  if (count < 0)
    throw DeviceError(DeviceProblem::Failed, name(), textOf(error),
                      "check that its maker's driver is installed");
  std::vector<NearfitDeviceDescription> found;
  for (std::int32_t i = 0; i < count; ++i) {
    NearfitDeviceDescription& device = found.emplace_back();
    if (functions_->describe(i, &device, error.data(), error.size()) != 0)
      throw DeviceError(DeviceProblem::Failed, name(), textOf(error), "plug the device in again");
    if (const std::string problem = descriptionProblem(device); !problem.empty()) {
      throw DeviceError(DeviceProblem::Unsupported, name(),
                        std::string("its description of ") + device.name + " is not valid: " + problem,
                        "ask the plug-in's maker for a working version");
    }
  }
  return found;
}

PluginSearch loadPlugins(const std::vector<fs::path>& folders) {
  PluginSearch search;
  for (const fs::path& folder : folders) {
    std::error_code error;
    std::vector<fs::path> files;
    for (fs::directory_iterator i(folder, error), end; !error && i != end; i.increment(error)) {
      if (i->path().extension() == ".so") files.push_back(i->path());
    }
    std::sort(files.begin(), files.end());
    for (const fs::path& file : files) {
      try {
        search.plugins.push_back(DevicePlugin::load(file));
      } catch (const Error& problem) {
        search.problems.emplace_back(problem.what());
      }
    }
  }
  return search;
}

std::vector<fs::path> pluginFolders() {
  return pluginFolders(::getauxval(AT_SECURE) != 0);
}

std::vector<fs::path> pluginFolders(bool isPrivileged) {
  std::vector<fs::path> folders;
  // A program with more rights than its caller lets nobody's environment name code to load.
  if (const char* named = isPrivileged ? nullptr : ::secure_getenv("NEARFIT_PLUGINS")) {
    std::istringstream list(named);
    for (std::string folder; std::getline(list, folder, ':');) {
      if (!folder.empty()) folders.emplace_back(folder);
    }
    return folders;
  }
  if (const fs::path data = userFolder(UserFiles::Data); !isPrivileged && !data.empty())
    folders.push_back(data / "plugins");
  std::error_code error;
  if (const fs::path program = fs::read_symlink("/proc/self/exe", error); !error) {
    // Where the build puts them, and where they are once it is installed, whatever the prefix is.
    const fs::path here = program.parent_path();
    for (const fs::path& folder : {here / "plugins", here.parent_path() / "lib" / "nearfit" / "plugins"})
      folders.push_back(folder);
  }
  for (const char* folder : {"/usr/local/lib/nearfit/plugins", "/usr/lib/nearfit/plugins"}) {
    if (std::find(folders.begin(), folders.end(), folder) == folders.end()) folders.emplace_back(folder);
  }
  return folders;
}

}  // namespace nearfit
