#!/bin/bash
# Checks that answers are the same bits whatever the compiler, optimisation and instruction set.
#
#   scripts/check stability BUILD FOLDER          a folder with a build of the whole project; where to build
#   scripts/check stability BUILD FOLDER --all    four ways more, in three minutes more
#
# Builds digest.cpp without optimisation, as few translation units as names allow, and compares what it and BUILD's own print on the
# hard suite. With --all, it is built in further ways.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../.." && pwd)
source "$root/scripts/lib/setup.sh"
if [ $# -lt 2 ] || [ $# -gt 3 ] || [ "${3:---all}" != --all ]; then die "usage: scripts/check stability BUILD FOLDER [--all]"; fi
build=$(realpath "$1")
[ -x "$build/answers_digest" ] || die "$1 holds no program answers_digest; build the whole project there"
mkdir -p "$2/queries"
cd "$2"

# Queries take long without optimisation, so the suite asks half as many.
queries=6; [ -z "${3:-}" ] || queries=12
"$build/cscd" hardcases --out queries --queries $queries --force > /dev/null

parts=()
part() {
  local name=$1
  shift
  printf '#include "%s.cpp"\n' "$@" > "$name.cpp"
  parts+=("$name")
}
part rows core/elementary/{additive,cubic,inclusion,newton,catalogue} scenes/queries/query_file
part certified core/elementary/certified/{close_doubles,close_integers,exact_lanes,filtered_exact,integer_roots,integer_signs,integer_contact}
part exact core/elementary/exact/{exact,algebraic,closeness,integer,polynomial,static_contact,touch} core/base/{memory,thread_pool} \
  core/hierarchy/{bounds,loose_vertices,scalar_bounds,tree,vertex_bounds} core/mesh/triangle_mesh
part detect core/detect/{carried_pairs,compose,contact,distance_filter,double_filter,exclusions,feature_owners,filter_block} \
  core/detect/{no_contact_before,plain_sign,single_filter} core/geometry/feature_distance
part digest scripts/lib/check/digest

variants=("g++ -O0")
if [ -n "${3:-}" ]; then
  variants+=("g++ -O3 -march=native")
  ! command -v clang++ >/dev/null || variants+=("clang++ -O2" "clang++ -O3 -march=native")
  # Registers of 32 bytes, where the machine has larger ones. Without --all, scripts/check isas alone asks for them.
  ! grep -qw avx512f /proc/cpuinfo || variants+=("g++ -O2 -march=x86-64-v3")
fi
failed=0 first=""
compare() {  # NAME KEY PROGRAM
  "$3" queries/*.csv > "$2.txt"
  first=${first:-$2}
  if cmp -s "$first.txt" "$2.txt"; then
    echo "$1: $(wc -l < "$2.txt") digests"
  else
    failed=1
    echo "$1: answers differ from those of ${variants[0]}:"
    diff "$first.txt" "$2.txt" | head -n 20 || true
  fi
}
for variant in "${variants[@]}"; do
  read -r -a words <<< "$variant"
  key=${variant//[^a-z0-9+=]/}
  objects=()
  flags=(-std=c++20 -DNDEBUG -DCSCD_TBB -DBOOST_NO_CXX98_FUNCTION_BASE -ffp-contract=off -w -Wno-psabi -I "$root" -isystem /usr/include/eigen3)
  # Headers that nearly every part includes are parsed once.
  printf '#include <%s>\n' algorithm array boost/multiprecision/cpp_int.hpp cmath Eigen/Geometry functional map optional span string vector > parsed.h
  rm -f parsed.h.?ch
  pch=parsed.h.gch; [[ ${words[0]} = g++ ]] || pch=parsed.h.pch
  "${words[@]}" "${flags[@]}" -x c++-header parsed.h -o $pch
  for name in "${parts[@]}"; do
    ${CMAKE_CXX_COMPILER_LAUNCHER:-} "${words[@]}" "${flags[@]}" -include parsed.h -c "$name.cpp" -o "$key-$name.o"
    objects+=("$key-$name.o")
  done
  "${words[@]}" "${objects[@]}" -lgmpxx -lgmp -ltbb -o "digest-$key"
  compare "$variant" "$key" "./digest-$key"
done
compare "the build" build "$build/answers_digest"
exit $failed
