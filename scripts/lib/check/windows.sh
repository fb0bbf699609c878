#!/bin/bash
# Builds the library for Windows, and runs its tests, its examples and a program that links it under wine.
#
#   scripts/check windows
#
# Builds with Debian's mingw-w64, static and shared. Answers have to be those of a build for this machine.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../.." && pwd)
source "$root/scripts/lib/setup.sh"
[ $# -eq 0 ] || die "takes no arguments"
build=$root/build-windows
export CSCD_WINDOWS=$root/.cache/windows

echo "Installs g++-mingw-w64-x86-64-posix, wine64, cmake, ninja-build and headers where they are missing (700 MB). Builds the library"
echo "and its tests, for 10 minutes on 2 idle cores, in build-windows, and GoogleTest in .cache/windows."
say "packages"
install_packages g++ g++-mingw-w64-x86-64-posix wine64 cmake ninja-build libeigen3-dev libboost-dev libgtest-dev
mkdir -p "$CSCD_WINDOWS/include" "$build"
# The compiler's own folders hold no Boost, and those of this system hold headers of its C library, too.
ln -sfn /usr/include/boost "$CSCD_WINDOWS/include/boost"
configure() {  # SOURCE FOLDER OPTION...
  local source=$1 folder=$2
  shift 2
  cmake -S "$source" -B "$folder" -G Ninja -DCMAKE_TOOLCHAIN_FILE="$root/scripts/cmake/windows.cmake" -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_INSTALL_PREFIX="$CSCD_WINDOWS" -DEigen3_DIR=/usr/share/eigen3/cmake "$@" >/dev/null
}
if [ ! -e "$CSCD_WINDOWS/lib/libgtest.a" ]; then
  configure /usr/src/googletest "$build/googletest" -DBUILD_GMOCK=OFF
  ninja -C "$build/googletest" install >/dev/null
fi

# wine finds the run-time libraries of the compiler and the shared library in these folders.
export WINEPREFIX=$build/wine WINEDEBUG=-all WINEPATH
WINEPATH="$(dirname "$(x86_64-w64-mingw32-g++-posix -print-file-name=libstdc++-6.dll)");/usr/x86_64-w64-mingw32/lib;$CSCD_WINDOWS/bin"

say "build"
configure "$root" "$build" -DCSCD_LIBRARY_ONLY=ON -DCSCD_LIBRARY_TESTS=ON -DCSCD_UNTIMED=ON
ninja -C "$build" all
digest=$root/library/consumer/digest.cpp
x86_64-w64-mingw32-g++-posix -std=c++20 -O2 -I "$root/library/include" -isystem /usr/include/eigen3 "$digest" "$build/libcscd.a" \
  -o "$build/digest.exe"

under_wine() { /usr/lib/wine/wine64 "$@" 2>"$build/wine.log" | tr -d '\r'; }

say "examples"
for example in "$build"/example_*.exe; do
  under_wine "$example" >"$build/example.log" || die "$(basename "$example") fails: $(cat "$build/example.log" "$build/wine.log")"
  echo "$(basename "$example"): $(tail -n 1 "$build/example.log")"
done

say "a program that links the library"
cmake --install "$build" --component library >/dev/null
for shared in OFF ON; do
  configure "$root/library/consumer" "$build/consumer-$shared" -DEXAMPLE="$root/library/examples/first_contact.cpp" -DSHARED=$shared
  ninja -C "$build/consumer-$shared" >/dev/null
  under_wine "$build/consumer-$shared/consumer.exe" | grep "touch at t = 0.5" || die "the consumer fails: $(cat "$build/wine.log")"
  # Functions are taken from the shared library where that is asked for, and from nowhere else.
  imported=$(x86_64-w64-mingw32-objdump -p "$build/consumer-$shared/consumer.exe" | grep -c 'DLL Name: libcscd' || true)
  [ "$imported" -eq "$([ $shared = ON ] && echo 1 || echo 0)" ] || die "SHARED=$shared: the consumer imports $imported libraries of cscd"
done

say "answers"
native=$root/build-alone
[ -e "$native/CMakeCache.txt" ] || cmake -S "$root" -B "$native" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCSCD_LIBRARY_ONLY=ON \
  -DCSCD_UNTIMED=ON -DCSCD_ALL_ISAS=OFF -DCMAKE_DISABLE_FIND_PACKAGE_TBB=ON >/dev/null
ninja -C "$native" cscd_static
g++ -std=c++20 -O2 -I "$root/library/include" -isystem /usr/include/eigen3 "$digest" "$native/libcscd.a" -o "$native/digest"
here=$("$native/digest" 500 5 2>/dev/null)
there=$(under_wine "$build/digest.exe" 500 5)
[ "$here" = "$there" ] || die "answers differ: $here here, $there under wine"
echo "$there, as on this system"

say "tests"
under_wine "$build/library_test.exe" --gtest_brief=1
