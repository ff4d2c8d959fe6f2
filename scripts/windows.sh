#!/usr/bin/env bash
# Cross-compiles for Windows on a Debian machine, and runs what was compiled under wine.
#
#   scripts/windows.sh CARGO-WORDS...    cargo for x86_64-pc-windows-gnu: `build -p arl2rs-cli`, `test -p arl-rt --lib`
#   scripts/windows.sh wine PROGRAM...   a program under wine, with what wine lacks
#
# rustup has no standard library for Windows where it cannot be fetched: it is compiled from the sources that Debian
# packages, by the compiler that belongs to them. Everything lies below target/windows.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)

place=$root/target/windows
system=$place/system
export WINEPREFIX=$place/prefix WINEDEBUG=-all

# Debian's packages: wine and the linker, installed; the compiler and the library, unpacked beside what is installed.
install() {
  local packages=()
  command -v wine >/dev/null || packages+=(wine wine64)
  command -v x86_64-w64-mingw32-gcc >/dev/null || packages+=(gcc-mingw-w64-x86-64)
  local administrator=()
  [ "$(id -u)" = 0 ] || administrator=(sudo -n)
  if [ ${#packages[@]} -gt 0 ] || [ ! -x "$system/usr/bin/rustc" ]; then
    "${administrator[@]}" apt-get update -q
  fi
  if [ ${#packages[@]} -gt 0 ]; then
    "${administrator[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "${packages[@]}"
  fi
  [ -x "$system/usr/bin/rustc" ] && return
  local fresh=$place/unpacked version llvm name
  rm -rf "$fresh" && mkdir -p "$fresh/packages"
  version=$(apt-cache show --no-all-versions rustc-web | sed -n 's/^Version: \([0-9]*\.[0-9]*\).*/\1/p')
  llvm=$(apt-cache show --no-all-versions "libstd-rust-web-$version" | grep -o 'libllvm[0-9]*' | head -1)
  (cd "$fresh/packages" && apt-get download -q rustc-web "libstd-rust-web-$version" libstd-rust-web-dev rust-web-src "$llvm")
  for name in "$fresh"/packages/*.deb; do
    dpkg -x "$name" "$fresh"
  done
  rm -rf "$system" "$fresh/packages"
  mv "$fresh" "$system"
}

# Wine 8 has no library that Rust takes its random numbers from: a stand-in beside each program that is run.
stand_in() {
  local library=$place/bcryptprimitives.dll
  [ -f "$library" ] && return
  cat >"$place/random.c" <<'C'
#include <windows.h>
BOOLEAN NTAPI SystemFunction036(PVOID buffer, ULONG length);
__declspec(dllexport) BOOL ProcessPrng(PBYTE data, SIZE_T length) { return SystemFunction036(data, (ULONG)length); }
C
  x86_64-w64-mingw32-gcc -shared -o "$library" "$place/random.c" -ladvapi32
}

# Programs under wine find the stand-in here, in whatever folder they work.
run() {
  WINEPATH="Z:${place//\//\\}" exec wine "$@"
}

if [ $# = 0 ]; then
  sed -n '2,5s/^# \{0,1\}//p' "$0" >&2
  exit 2
fi
if [ "$1" = wine ]; then
  shift
  run "$@"
fi
cd "$root"
mkdir -p "$place"
install
stand_in
export LD_LIBRARY_PATH=$system/usr/lib/x86_64-linux-gnu RUSTC=$system/usr/bin/rustc RUSTC_BOOTSTRAP=1
export CARGO_TARGET_X86_64_PC_WINDOWS_GNU_LINKER=x86_64-w64-mingw32-gcc
export CARGO_TARGET_X86_64_PC_WINDOWS_GNU_RUNNER="$root/scripts/windows.sh wine"
exec cargo "$1" -Zbuild-std=std,panic_abort,panic_unwind,proc_macro,test --target x86_64-pc-windows-gnu --target-dir "$place/build" "${@:2}"
