#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Installs by name what a bare Debian 12 lacks; does nothing, and needs no network, when all is there.
#   scripts/setup.sh              what `make run` needs
#   scripts/setup.sh --linuxcnc   what `PORT=linuxcnc make demo` needs in addition
#   scripts/setup.sh --test       what `make test` needs in addition
set -eu
cd "$(dirname "$0")/.."

packages="
  g++ cmake ninja-build ccache make pkg-config util-linux
  libfmt-dev libcli11-dev libtomlplusplus-dev nlohmann-json3-dev libeigen3-dev libboost-dev libtbb-dev
  zlib1g-dev libssl-dev libsodium-dev libsqlite3-dev libhdf5-dev
  libmodbus-dev libgpiod-dev libcomedi-dev
  libgtest-dev libgmock-dev libbenchmark-dev librapidcheck-dev
"
if [ "${1:-}" = --linuxcnc ]; then
  packages="$packages python3 linuxcnc-uspace linuxcnc-uspace-dev"
elif [ "${1:-}" = --test ]; then
  packages="$packages
    clang-19 clang-format-19 clang-tidy-19 libclang-rt-19-dev python3 python3-pymodbus python3-serial-asyncio chromium linuxcnc-uspace linuxcnc-uspace-dev
  "
fi

# A Node installed in another way is as good as Debian's.
node_major=$(node --version 2>/dev/null | sed -n 's/^v\([0-9]*\)\..*/\1/p')
if [ "${node_major:-0}" -lt 18 ] || ! command -v npm >/dev/null 2>&1; then
  packages="$packages nodejs npm"
fi

missing=
for package in $packages; do
  state=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
  [ "$state" = installed ] || missing="$missing $package"
done

if [ -n "$missing" ]; then
  as_root=
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null 2>&1; then
      echo "scripts/setup.sh: missing packages:$missing; install them as root: apt-get install$missing" >&2
      exit 1
    fi
    as_root="sudo"
  fi
  echo "Installing:$missing"
  $as_root apt-get update -q
  $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends $missing
fi

sh scripts/web-packages.sh
# Only the port `opcua` and its tests need them.
[ "${1:-}" != --test ] || sh scripts/opcua-bridge.sh
