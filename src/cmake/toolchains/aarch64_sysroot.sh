#!/usr/bin/env bash
# Unpacks Debian's arm64 packages of the libraries that gpgp links, without installing anything: for aarch64.cmake.
#
#   GPGP_SYSROOT=folder     where they go (build/aarch64-sysroot)
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
sysroot=${GPGP_SYSROOT:-$here/../../../build/aarch64-sysroot}
# libraries and their headers; those of programs, such as the X server's, are not needed to link
packages=(libzstd-dev libzstd1 zlib1g-dev zlib1g libpugixml-dev libpugixml1v5 glslang-dev spirv-tools libglm-dev
  libvulkan-dev libvulkan1 libvulkan-volk-dev libpng-dev libpng16-16 libstb-dev libstb0 libcli11-dev nlohmann-json3-dev
  libtinygltf-dev libtinygltf2d libgtest-dev libfreetype-dev libfreetype6 libharfbuzz-dev libharfbuzz0b libfribidi-dev libfribidi0
  libicu-dev libicu72 libbrotli-dev libbrotli1 libbz2-1.0 libglib2.0-dev libglib2.0-0 libgraphite2-3 libgraphite2-dev
  libpcre2-dev libpcre2-8-0)
[[ ! -e $sysroot/done ]] || exit 0
mkdir -p "$sysroot/lists/partial" "$sysroot/cache/archives/partial"
: >"$sysroot/status"
apt=(apt-get -q -o APT::Sandbox::User=root -o APT::Architecture=arm64 -o APT::Architectures=arm64
  -o "Dir::State::Lists=$sysroot/lists" -o "Dir::State::status=$sysroot/status" -o "Dir::Cache=$sysroot/cache")
"${apt[@]}" update >"$sysroot/log" 2>&1 || { cat "$sysroot/log" >&2; exit 1; }
(cd "$sysroot/cache" && "${apt[@]}" download "${packages[@]}") >>"$sysroot/log" 2>&1 || { tail -n 20 "$sysroot/log" >&2; exit 1; }
for package in "$sysroot"/cache/*.deb; do dpkg-deb -x "$package" "$sysroot"; done
rm -rf "$sysroot/cache" "$sysroot/lists"
touch "$sysroot/done"
