# SPDX-License-Identifier: BSD-3-Clause
# Sourced by ./demo and ./check: installs the Debian packages that are missing, configures and builds.
# shellcheck shell=sh

lintel_root=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)

# say WORDS…: what is going on, apart from the output of the tools.
say() { printf '\n== %s\n' "$*"; }

# die WORDS…: one line on stderr, then exit 1.
die() { printf '%s: %s\n' "$(basename -- "$0")" "$*" >&2; exit 1; }

# packages_for MARK…: the names in packaging/dependencies that carry one of the marks.
packages_for() {
  awk -v wanted="$*" '
    BEGIN { n = split(wanted, w, " ") }
    /^#/ || NF == 0 { next }
    { for (i = 1; i <= n; i++) if (("," $2 ",") ~ ("," w[i] ",")) { print $1; next } }
  ' "$lintel_root/packaging/dependencies"
}

# missing_packages MARK…: those of them that are not installed.
missing_packages() {
  for package in $(packages_for "$@"); do
    case $(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null) in
      installed) ;;
      *) printf '%s\n' "$package" ;;
    esac
  done
}

# as_root COMMAND…: runs it as root, by sudo if need be.
as_root() {
  if [ "$(id -u)" -eq 0 ]; then "$@"
  elif command -v sudo >/dev/null 2>&1; then sudo "$@"
  else die "packages are missing and need root or sudo to be installed: apt-get install $packages"
  fi
}

# install_packages MARK…: installs what is missing; asks the archive for its list only then.
install_packages() {
  command -v apt-get >/dev/null 2>&1 || die "needs Debian 12 (apt-get); elsewhere install what packaging/dependencies names and use cmake"
  packages=$(missing_packages "$@" | tr '\n' ' ')
  [ -n "$packages" ] || return 0
  say "Installing $packages"
  as_root apt-get update -q || die "apt-get update failed; check the network and the sources in /etc/apt"
  # shellcheck disable=SC2086 # a list of names
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends $packages ||
    die "apt-get install failed; see above"
}

# build PRESET TARGET…: configures build/PRESET once and builds the targets (all of them without a name).
# CMake itself notices later changes of its files.
build() {
  preset=$1; shift
  cd "$lintel_root" || exit 1
  if [ ! -f "build/$preset/build.ninja" ]; then
    say "Configuring build/$preset"
    launcher=
    # what ccache's manual asks for where there are precompiled headers
    command -v ccache >/dev/null 2>&1 &&
      launcher='-DCMAKE_CXX_COMPILER_LAUNCHER=env;CCACHE_SLOPPINESS=pch_defines,time_macros;ccache'
    cmake --preset "$preset" ${launcher:+"$launcher"} || die "configuring failed; see above"
  fi
  say "Building build/$preset"
  cmake --build "build/$preset" ${1:+--target "$@"} || die "the build failed; see above"
}
