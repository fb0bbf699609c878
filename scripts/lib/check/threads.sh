#!/bin/bash
# Looks for races with ThreadSanitizer, and for answers that depend on the number of threads.
#
#   scripts/check threads
#
# Runs all code that shares work among threads, and fails at the first race.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../.." && pwd)
source "$root/scripts/lib/setup.sh"
[ $# -eq 0 ] || die "takes no arguments"
cd "$root"
build=build-threads
export TSAN_OPTIONS="halt_on_error=1 exitcode=66 second_deadlock_stack=1"
threads=4 # more than most machines that run this have cores, so that threads are put off in the middle of their work

echo "Builds the program, the library and some tests for ThreadSanitizer, 15 minutes on 2 idle cores, and runs them in 10."
say "packages"
install_packages "${packages_build[@]}" "${packages_compare[@]}"

say "build"
tests=(core_base core_fast_prepare core_fast_classify core_fast library bench_harness)
build $build sanitize_threads gcc cscd cscd_static "${tests[@]/%/_test}"
g++ -std=c++20 -O1 -g -fsanitize=thread -I library/include -isystem /usr/include/eigen3 library/consumer/digest.cpp \
  $build/libcscd.a -ltbb -o $build/digest

# Without this the script could pass because nothing was watched.
say "a planted race"
cat >$build/race.cpp <<'TEXT'
#include "core/base/thread_pool.h"
int main() {
  int sum = 0;
  cscd::ThreadPool(2).parallel_for(1000, [&](std::size_t part, std::size_t) { sum += int(part); });
  return sum < 0;
}
TEXT
g++ -std=c++20 -O1 -g -fsanitize=thread -I . -isystem /usr/include/eigen3 $build/race.cpp -DCSCD_TBB core/base/thread_pool.cpp -ltbb \
  -o $build/race
status=0
$build/race 2>/dev/null || status=$?
[ $status -eq 66 ] || die "the planted race ends with status $status, not with ThreadSanitizer's 66"
echo "found"

say "tests"
for name in "${tests[@]}"; do
  filter='*'
  case $name in  # the others work on one thread
    core_fast) filter='*Threads*' ;;
    library) filter='SelfCollision.SessionsOnSeveralThreadsShareOneMesh' ;;
    bench_harness) filter='Parts.AreTheSameOnAnyNumberOfThreads' ;;
  esac
  $build/"${name}_test" --gtest_brief=1 --gtest_filter="$filter" >$build/test.log 2>&1 ||
    die "$name: $(head -n 60 $build/test.log)"
  # A test that has another name now would not run.
  ! grep -q 'PASSED  ] 0 tests' $build/test.log || die "$name: has no test $filter"
  tail -n 1 $build/test.log | sed "s/^/$name: /"
done

say "answers of the library"
alone=$($build/digest 20 3 1 2>/dev/null)
for ((n = 2; n <= 2 * threads; n += 2)); do
  together=$($build/digest 20 3 $n 2>$build/digest.log) || die "$n threads: $(head -n 40 $build/digest.log)"
  [ "$together" = "$alone" ] || die "$n threads answer $together, one answers $alone"
  echo "$n threads: $together, as one"
done

say "scenes"
# Surfaces with bones and without, with contacts and without. Each row is verified against the complete reference.
while read -r scene frames bones; do
  $build/cscd run --scene "$scene" --strategy "drvbc_fast,drvbc_fast_all,drvbc_fast_complete${bones:+,drvbc_fast_bones}" \
    --frames "$frames" --repetitions 1 --threads $threads --force --json "$build/$scene.json" |
    grep -E ' (ok|FAILED) ' | sed "s/^/$scene: /"
done <<'TEXT'
rope 60:62 bones
hand_contact 60:61 bones
octopus_contact 124:126 bones
box_contact 118:120 bones
bag_contact 36:38
TEXT
echo "no race"
