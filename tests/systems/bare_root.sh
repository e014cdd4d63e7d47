# For scripts that try what is installed in a bare Debian. Sourced, with `name` set to that Debian, from the project's folder.

# in_own_mounts SCRIPT ARGUMENT... : starts the script again, once, as root with mounts and processes of its own. They end with it.
in_own_mounts() {
  if [[ -z "${NEARFIT_SYSTEM_ALONE:-}" ]]; then
    [[ "$(id -u)" == 0 ]] || { echo "systems: run this as root, because it mounts into the system that it makes" >&2; exit 1; }
    command -v debootstrap >/dev/null || { echo "systems: debootstrap is missing (package debootstrap)" >&2; exit 1; }
    NEARFIT_SYSTEM_ALONE=1 exec unshare --mount --pid --fork --kill-child "tests/systems/$1" "${@:2}"
  fi
}

# begin_in_bare_root WHAT ARGUMENT... : in mounts of its own (in_own_mounts), and sets
#   root     build/systems/NAME-WHAT, where the bare Debian is to be
#   log      all output of the steps
#   results  tests/systems/results/WHAT-NAME.log, what was tried
begin_in_bare_root() {
  local what="$1"
  in_own_mounts "$@"
  folder="$PWD/build/systems"
  root="$folder/$name-$what"
  log="$root.log"
  results=tests/systems/results/$what-$name.log
  mkdir -p "$folder" "$(dirname "$results")"
  : >"$log"
  rm -rf --one-file-system "$root"
  good=true
  lines=()
}

# within ROOT USER COMMAND... : in a root, with nothing of this environment.
within() {
  chroot "$1" /usr/sbin/runuser -u "$2" -- /usr/bin/env -i HOME="$([[ $2 == root ]] && echo /root || echo "/home/$2")" USER="$2" \
    PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive LIBGL_ALWAYS_SOFTWARE=1 CCACHE_DISABLE=1 \
    bash -c 'cd && exec "$@"' bash "${@:3}" </dev/null
}
admin() { within "$root" root "$@"; }
user() { within "$root" tester "$@"; }

# step WHAT COMMAND... : a line of the results, with the last lines that the command printed.
step() {
  local result=0
  echo "== $1" | tee -a "$log"
  "${@:2}" >"$root.step" 2>&1 || result=$?
  cat "$root.step" >>"$log"
  lines+=("$([[ $result -eq 0 ]] && echo ok || echo "FAILED ($result)")  $1")
  mapfile -t -O "${#lines[@]}" lines < <(tail -n 3 "$root.step" | cut -c1-160 | sed 's/^/      /')
  [[ $result -eq 0 ]] || { tail -n 20 "$root.step"; echo "systems: '$1' failed on $name; see $log"; good=false; }
  return $result
}

# lend_network ROOT : proxies, mirrors and certificates of this machine serve the root too.
lend_network() {
  cp /etc/resolv.conf "$1/etc/resolv.conf"
  find /etc/apt/apt.conf.d -name '*proxy*' -exec cp {} "$1/etc/apt/apt.conf.d/" \;
  [[ ! -f /etc/pip.conf ]] || cp /etc/pip.conf "$1/etc/pip.conf"
  mkdir -p "$1/usr/local/share/ca-certificates"
  find /usr/local/share/ca-certificates -name '*.crt' -exec cp {} "$1/usr/local/share/ca-certificates/" \;
  chroot "$1" /usr/sbin/update-ca-certificates >/dev/null
}

# serve ROOT : with that, and with devices.
serve() {
  lend_network "$1" || return
  mount --rbind /dev "$1/dev" && mount --rbind /sys "$1/sys" && mount -t proc proc "$1/proc"
}

# make_bare_root PACKAGE... : a minimal system with these and the user `tester`.
make_bare_root() {
  debootstrap --variant=minbase --include=ca-certificates "$name" "$root" || return
  # Minimal systems may leave out what is to be looked at here.
  rm -f "$root"/etc/dpkg/dpkg.cfg.d/*
  serve "$root" || return
  admin useradd --create-home --shell /bin/bash tester || return
  admin apt-get update -q || return
  admin apt-get install -q -y --no-install-recommends "$@"
}

# is_this_system : whether this is that Debian.
is_this_system() { [[ "$(sed -n 's/^VERSION_CODENAME=//p' /etc/os-release)" == "$name" ]]; }

# head_in_builder : the system that tests/systems/run has left gets HEAD, whatever its clone was made from. Sets `builder`.
head_in_builder() {
  builder="$folder/$name"
  [[ -d "$builder/root/nearfit" ]] || { echo "there is no $builder: run tests/systems/run $name first, or name a file"; return 1; }
  serve "$builder" || return
  git bundle create -q "$builder/root/head.bundle" HEAD || return
  within "$builder" root bash -c 'cd nearfit && git fetch -q ../head.bundle HEAD && git checkout -q --force --detach FETCH_HEAD'
}

# end_in_bare_root WHAT FILE ARGUMENT... : writes the results on that file, and exits 1 if a step has failed.
end_in_bare_root() {
  local what="$1" file="$2"
  shift 2
  {
    echo "# tests/systems/$what $*"
    echo "# revision: $(git rev-parse HEAD)"
    echo "# date: $(date -u +%Y-%m-%dT%H:%M:%SZ)"
    echo "# file: $(basename "${file:-none}"), $(stat -c %s "${file:-/dev/null}") bytes, SHA-256 $(sha256sum <"${file:-/dev/null}" | cut -d' ' -f1)"
    echo "# system: $(sed -n 's/^PRETTY_NAME="\(.*\)"/\1/p' "$root/etc/os-release" 2>/dev/null), $(cat "$root/etc/debian_version" 2>/dev/null)"
    printf '%s\n' "${lines[@]}"
  } >"$results"
  echo "systems: $what on $name $($good && echo passed || echo failed); $results"
  $good
}
