#!/bin/bash
# Checks that every instruction set gives the same answers, bit by bit, here and under qemu-user.
#
#   scripts/check isas
#
# Builds the library for all sets that CSCD_ISA names, and asks processors without AVX-512 and without AVX, too.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../.." && pwd)
source "$root/scripts/lib/setup.sh"
[ $# -eq 0 ] || die "takes no arguments"
all=$root/build-isas

echo "Installs qemu-user where it is missing; builds the library for three instruction sets, which takes about 10 minutes on 2 idle cores."
say "packages"
install_packages g++ cmake ninja-build libeigen3-dev libboost-dev libtbb-dev qemu-user

say "build"
cmake -S "$root" -B "$all" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCSCD_LIBRARY_ONLY=ON >/dev/null
ninja -C "$all" cscd_static cscd_shared
digest=$root/library/consumer/digest.cpp
link() {  # OUT LIBRARY...
  local out=$1
  shift
  g++ -std=c++20 -O2 -I "$root/library/include" -isystem /usr/include/eigen3 "$digest" "$@" -ltbb -o "$out"
}
link "$all/digest" "$all/libcscd.a"
link "$all/digest-shared" "$all/libcscd.so" -Wl,-rpath,"$all"

say "answers"
failed=0 first=""
same() {  # NAME PROGRAM...
  local name=$1 answers
  shift
  if ! answers=$("$@" 2>&1); then
    case $answers in
      *"this machine lacks it"*) echo "$name: this machine lacks it, passed over" ;;
      *) echo "$name: FAILED: $answers"; failed=1 ;;
    esac
    return
  fi
  echo "$name: $(tail -n 1 <<<"$answers"), $(head -n 1 <<<"$answers")"
  answers=$(grep contacts <<<"$answers")
  first=${first:-$answers}
  if [ "$answers" != "$first" ]; then
    echo "$name: FAILED: other answers than $first"
    failed=1
  fi
}
for set in baseline avx2 avx512; do
  same "$set" env CSCD_ISA=$set "$all/digest" 2000 20
  same "$set, shared" env CSCD_ISA=$set "$all/digest-shared" 2000 20
done
# Two processors that lack AVX-512, and one that lacks AVX too. An instruction that they lack would end the program.
first=""
for processor in max,-avx512f Haswell Nehalem; do
  same "qemu, $processor" qemu-x86_64 -cpu "$processor" "$all/digest" 50 1
done
same "this machine" "$all/digest" 50 1
if answer=$(CSCD_ISA=mmx "$all/digest" 1 1 2>&1) || [[ $answer != *"no such instruction set"* ]]; then
  echo "CSCD_ISA=mmx: FAILED: not refused as it should be: $answer"
  failed=1
fi
exit $failed
