#!/bin/bash
# Checks that the library alone needs a compiler and the headers of Eigen and Boost, and that its wheel needs Python and numpy.
#
#   scripts/check alone [--bare]     --bare: install the wheel in a bare Debian 12, too, which needs root
#
# Headers of GMP and oneTBB are made that end the compiler at once. What is built without them runs the library's tests and examples.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../.." && pwd)
source "$root/scripts/lib/setup.sh"
case $*: in :|--bare:) ;; *) die "unknown argument $*; see --help" ;; esac
build=$root/build-alone
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

echo "Installs packages for the library, its tests and its Python module where they are missing; builds all of these for one instruction"
echo "set in build-alone, for 5 minutes on 2 idle cores. --bare fetches 60 MB for the bare system, which is gone afterwards."
say "packages"
install_packages g++ cmake ninja-build libeigen3-dev libboost-dev libgtest-dev pybind11-dev python3-dev python3-numpy python3-pip \
  python3-setuptools python3-wheel

say "headers that refuse"
refusing=$build/refusing
for header in gmp.h gmpxx.h $(grep -rhoE '<(tbb|oneapi)/[^>]*>' "$root/core" | tr -d '<>'); do
  mkdir -p "$refusing/$(dirname "$header")"
  echo "#error $header is not for the library alone" >"$refusing/$header"
  # Without this the check could pass because the compiler finds the header of the system first.
  if echo "#include <$header>" | g++ -I "$refusing" -x c++ -fsyntax-only - 2>/dev/null; then die "$header is not refused"; fi
done
(cd "$refusing" && find . -type f | sort | xargs echo)

say "build"
# oneTBB is not looked for, as where it is not installed. What is optimised little compiles in half the time.
cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE="-O1 -DNDEBUG" \
  -DCMAKE_CXX_FLAGS="-I $refusing" -DCSCD_LIBRARY_ONLY=ON -DCSCD_LIBRARY_TESTS=ON -DCSCD_UNTIMED=ON -DCSCD_ALL_ISAS=OFF \
  -DCMAKE_DISABLE_FIND_PACKAGE_TBB=ON >/dev/null
ninja -C "$build"

# needs_little FILE: a binary needs the run-time libraries of the compiler, and no others.
needs_little() {
  local needed
  needed=$(readelf -d "$1" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p' | xargs)
  echo "$(basename "$1"): needs $needed"
  for name in $needed; do
    case $name in libc.so.*|libm.so.*|libstdc++.so.*|libgcc_s.so.*|ld-linux*) ;; *) die "$(basename "$1") needs $name" ;; esac
  done
}
say "what is linked"
for binary in "$build"/libcscd.so "$build"/example_* "$build"/python/cscd/_cscd*.so; do needs_little "$binary"; done

say "tests and examples"
ctest --test-dir "$build" -j "$(nproc)" --output-on-failure | tail -n 4

say "wheel"
"$root/library/python/check" "$build"
CSCD_BUILD=$build /usr/bin/python3 -m pip wheel --quiet --no-deps --no-build-isolation --wheel-dir "$work" "$root/library/python"
wheel=$(echo "$work"/cscd-*.whl)
/usr/bin/python3 -m zipfile -e "$wheel" "$work/unpacked"
needs_little "$(find "$work/unpacked" -name '_cscd*.so')"
[ -z "$(find "$work/unpacked" -name '*.so' ! -name '_cscd*')" ] || die "the wheel holds other libraries"
[ "${1:-}" = --bare ] || exit 0

say "a bare Debian"
[ "$(id -u)" -eq 0 ] || die "--bare needs root, to make the bare system"
install_packages mmdebstrap
mmdebstrap --quiet --mode=root --variant=minbase --include=python3-venv,python3-numpy bookworm "$work/bare"
cp "$wheel" "$root/library/examples/first_contact.py" "$work/bare"
cat >"$work/bare/use" <<TEXT
set -eu
python3 -m venv --system-site-packages /environment
/environment/bin/pip install --quiet --no-index /$(basename "$wheel")
cd / && /environment/bin/python first_contact.py
TEXT
env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root chroot "$work/bare" sh /use
echo "the wheel installs and answers"
