#!/bin/bash
# Runs tests of the core on 64-bit ARM under qemu-user, and counts instructions beside those of a processor without AVX.
#
#   scripts/check aarch64 [ROOM...]     the rooms whose tests run, such as core_geometry; without any, those listed below
#
# Builds with Debian's cross compiler. Instructions are those of library/consumer/digest.cpp, preparation included, whose answers
# have to be the same on both.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../.." && pwd)
source "$root/scripts/lib/setup.sh"
rooms=(core_base core_mesh core_geometry core_elementary_exact core_elementary_certified core_elementary core_hierarchy
       core_fast_classify core_fast scenes_queries)
[ $# -gt 0 ] && rooms=("$@")
build=$root/build-aarch64
export CSCD_SYSROOT=${CSCD_SYSROOT:-$root/.cache/aarch64}

echo "Installs g++-aarch64-linux-gnu, qemu-user, mmdebstrap, cmake and ninja-build where they are missing. Unpacks arm64"
echo "packages of Debian 12 (libc, libstdc++, Eigen, Boost, oneTBB, GMP, GoogleTest; 140 MB) into .cache/aarch64, and changes nothing"
echo "else of the system. On 2 idle cores it takes about 25 minutes, most of it for compiling."
say "packages"
install_packages g++ g++-aarch64-linux-gnu qemu-user mmdebstrap cmake ninja-build libeigen3-dev libboost-dev libtbb-dev
if [ ! -e "$CSCD_SYSROOT" ]; then
  mkdir -p "$root/.cache"
  mmdebstrap --quiet --variant=extract --architectures=arm64 \
    --include=libc6-dev,libstdc++-12-dev,libeigen3-dev,libboost-dev,libgmp-dev,libtbb-dev,libgtest-dev bookworm "$CSCD_SYSROOT.part"
  mv "$CSCD_SYSROOT.part" "$CSCD_SYSROOT"
fi

say "build"
cmake -S "$root" -B "$build" -G Ninja -DCMAKE_TOOLCHAIN_FILE="$root/scripts/cmake/aarch64.cmake" \
  -DCMAKE_BUILD_TYPE=Release -DCSCD_LIBRARY_ONLY=ON -DCSCD_CORE_TESTS=ON >/dev/null
ninja -C "$build" cscd_static cscd_shared "${rooms[@]/%/_test}"

say "tests under qemu"
# An emulated test takes many times as long as one on the machine itself, so each gets at most `limit` seconds of processor time.
export limit=60 build
one() {
  local room=${1%%/*} test=${1#*/} log=$build/tests/${1//\//-}.log status=0
  (ulimit -H -t "$((limit + 5))"; ulimit -S -t "$limit"; exec qemu-aarch64 -L "$CSCD_SYSROOT" "$build/${room}_test" --gtest_brief=1 --gtest_filter="$test") \
    >"$log" 2>&1 || status=$?
  case $status in
    0) echo "passed $room" ;;
    152) echo "unfinished $room $test" ;;  # SIGXCPU; whatever else ends it is a failure
    *) echo "failed $room $test; see $log" ;;
  esac
}
export -f one
mkdir -p "$build/tests"
for room in "${rooms[@]}"; do
  qemu-aarch64 -L "$CSCD_SYSROOT" "$build/${room}_test" --gtest_list_tests |
    awk -v room="$room" '/^[^ ].*\.( |$)/ { suite = $1 } /^  / { print room "/" suite $1 }'
done >"$build/names.txt"  # a program that cannot list its tests ends the script here
xargs -P "$(nproc)" -I{} bash -c 'one {}' <"$build/names.txt" | tee "$build/tests.txt" | grep -v ^passed || true
for room in "${rooms[@]}"; do
  echo "$room: $(grep -c "^passed $room\$" "$build/tests.txt" || true) tests pass," \
    "$(grep -c "^unfinished $room " "$build/tests.txt" || true) unfinished after $limit s," \
    "$(grep -c "^failed $room " "$build/tests.txt" || true) fail"
done
[ "$(wc -l <"$build/tests.txt")" -eq "$(wc -l <"$build/names.txt")" ] || die "not every test of $build/names.txt was run"
! grep -q ^failed "$build/tests.txt" || exit 1

say "instructions"
plain=$root/build-baseline
cmake -S "$root" -B "$plain" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCSCD_LIBRARY_ONLY=ON -DCSCD_ALL_ISAS=OFF >/dev/null
ninja -C "$plain" cscd_static
gcc -shared -fPIC -O2 "$root/scripts/lib/check/instructions.c" -o "$build/instructions.so"
# On ARM, gcc fuses multiplications and additions unless it is told not to: the positions that are asked would be others.
source=(-std=c++20 -O2 -ffp-contract=off -I "$root/library/include" "$root/library/consumer/digest.cpp")
aarch64-linux-gnu-g++ --sysroot="$CSCD_SYSROOT" -isystem "$CSCD_SYSROOT/usr/include/eigen3" "${source[@]}" "$build/libcscd.a" -ltbb -o "$build/digest"
g++ -isystem /usr/include/eigen3 "${source[@]}" "$plain/libcscd.a" -ltbb -o "$plain/digest"
declare -A answers counts
run() {  # NAME EMULATOR...
  local name=$1
  shift
  answers[$name]=$("$@" 50 20 2>"$build/count.txt" | grep contacts)
  counts[$name]=$(sed -n 's/^instructions //p' "$build/count.txt")
  echo "$name: ${answers[$name]}, $((counts[$name] / 1000000)) million instructions"
}
run NEON qemu-aarch64 -L "$CSCD_SYSROOT" -plugin "$build/instructions.so" "$build/digest"
run SSE2 qemu-x86_64 -plugin "$build/instructions.so" "$plain/digest"
awk -v neon="${counts[NEON]}" -v sse="${counts[SSE2]}" 'BEGIN { printf "NEON takes %.2f times the instructions of SSE2\n", neon / sse }'
[ "${answers[NEON]}" = "${answers[SSE2]}" ] || die "other answers on 64-bit ARM"
