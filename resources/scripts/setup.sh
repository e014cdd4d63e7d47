# Sourced by ./run and ./test: what Debian 12, Debian 13 and Ubuntu 24.04 need to build Nearfit, and how it gets there.

nearfit_packages=(
  g++ cmake ninja-build pkg-config ccache
  libvtk9-qt-dev qtbase5-dev libqt5svg5-dev libopenmesh-dev libglm-dev
  libfmt-dev nlohmann-json3-dev libcli11-dev libssl-dev libxxhash-dev libmuparser-dev libgtest-dev libgmock-dev libfcl-dev
  libcgal-dev libboost-dev libompl-dev libusb-1.0-0-dev libqcustomplot-dev
  python3 zlib1g-dev libocct-data-exchange-dev libtbb-dev libfontconfig-dev lib3mf-dev liburdfdom-dev libseccomp-dev
)
nearfit_test_packages=(
  xvfb xauth libgl1-mesa-dri umockdev libumockdev-dev python3 python3-dev python3-venv git zsh desktop-file-utils appstream shared-mime-info man-db
)
# For resources/scripts/package.
nearfit_package_packages=(dpkg-dev file lintian git)
# For ./test --all and tests/fuzz/run: sanitizers, formatting and clang-tidy.
nearfit_check_packages=(clang-19 libclang-rt-19-dev llvm-19 clang-format-19 clang-tidy-19)
# For tests/usb/qemu/run alone.
nearfit_qemu_packages=(qemu-system-x86 busybox-static cpio xz-utils python3)

# missing_packages NAME... : prints those that are not installed.
missing_packages() {
  local name
  for name in "$@"; do
    [[ "$(dpkg-query -W -f='${Status}' "$name" 2>/dev/null)" == "install ok installed" ]] || printf '%s\n' "$name"
  done
}

# require_packages [NAME...] : installs what the build needs, and the named ones, where anything is missing.
require_packages() {
  if ! command -v dpkg-query >/dev/null; then
    echo "This is not Debian or Ubuntu: install the equivalents of these packages yourself if the build fails:" >&2
    echo "  ${nearfit_packages[*]} $*" >&2
    return
  fi
  local missing
  mapfile -t missing < <(missing_packages "${nearfit_packages[@]}" "$@")
  [[ ${#missing[@]} -gt 0 ]] || return 0
  echo "Missing packages: ${missing[*]}"
  local apt=(env DEBIAN_FRONTEND=noninteractive apt-get)
  if [[ "$(id -u)" != 0 ]]; then
    if [[ ! -t 0 ]]; then
      echo "Install them (sudo apt-get install ${missing[*]}) and run this again." >&2
      exit 1
    fi
    local answer
    read -r -p "Install them with sudo apt-get? [y/N] " answer
    [[ "$answer" == [yY]* ]] || { echo "Nothing was installed." >&2; exit 1; }
    apt=(sudo "${apt[@]}")
  fi
  "${apt[@]}" update -q
  "${apt[@]}" install -q -y --no-install-recommends "${missing[@]}"
}
