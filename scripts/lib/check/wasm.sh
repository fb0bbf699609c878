#!/bin/bash
# Builds the npm package of library/js for WebAssembly, and the page that takes a file (build-wasm/check.html), and tests both in
# Node and in Chromium. With BUILD, `cscd view --with-engine` of BUILD gets its page, BUILD/share/cscd/engine_view.html, too.
#
#   scripts/check wasm [BUILD [--all]]
#
# BUILD is a folder with a build of the whole project. With it, the package and the library of BUILD have to give the same
# answers to some steps of two scenes, bit by bit; with --all, to all steps of all scenes. The page has to give the verdicts of
# `cscd query` on the glTF files of $CSCD_MODELS (../shared/models). scripts/record sets takes times.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../.." && pwd)
source "$root/scripts/lib/setup.sh"
[ $# -le 2 ] && [[ ${2:---all} == --all ]] || die "takes a build folder, and --all; see --help"
native=${1:-} mode=${2:-}
[ -z "$native" ] || [ -x "$native/cscd" ] || die "$native holds no program cscd; build the whole project there"
[ -z "$native" ] || native=$(cd "$native" && pwd)
build=$root/build-wasm
package=$build/js

if [ -n "${CSCD_NO_INSTALL:-}" ]; then  # as a test, which has to change nothing of the system
  dpkg-query -W "${packages_wasm[@]}" >/dev/null 2>&1 || { echo "skipped: needs ${packages_wasm[*]}"; exit 77; }
else
  echo "Installs ${packages_wasm[*]}, cmake, ninja-build, Eigen's and Boost's headers, Node and chromium where they"
  echo "are missing. On 2 idle cores it takes 2 minutes."
  say "packages"
  node=(); command -v node >/dev/null || node=(nodejs)
  install_packages cmake ninja-build libeigen3-dev libboost-dev chromium "${node[@]}" "${packages_wasm[@]}"
fi

say "build"
cmake -S "$root" -B "$build" -G Ninja -DCMAKE_TOOLCHAIN_FILE="$root/scripts/cmake/wasm.cmake" -DCMAKE_BUILD_TYPE=Release \
  -DCSCD_LIBRARY_ONLY=ON -DCSCD_WARNINGS_AS_ERRORS=ON >/dev/null
ninja -C "$build" cscd_wasm
size=$(stat -c %s "$package/cscd.wasm") packed=$(gzip -9 <"$package/cscd.wasm" | wc -c)
echo "cscd.wasm: $size bytes, $packed compressed"
[ "$size" -le 1500000 ] && [ "$packed" -le 500000 ] || die "the package is larger than its README says"

say "tests"
node --test "$package/test/cscd.test.mjs"
packages=$native/page  # where npm has put what the tests need
if [ ! -e "$packages/node_modules/typescript" ]; then
  packages=$build/page
  cmake -D NPM=npm -D FROM="$root/page" -D TO="$packages" -D DEV=ON -D STAMP="$packages/packages.stamp" -P "$root/scripts/cmake/npm_packages.cmake"
fi
node "$packages/node_modules/typescript/bin/tsc" --noEmit --strict --target es2022 --module nodenext "$package/test/types.ts"
status=0
node "$root/library/js/test/check_page.mjs" "$packages" "$package" || status=$?
[ $status -eq 0 ] || [ $status -eq 77 ] || exit 1  # 77: there is no Chromium

say "the page that takes a file"
node "$root/page/build.mjs" "$packages" "$build/check.html" "$package" check
size=$(stat -c %s "$build/check.html")
echo "$build/check.html: $size bytes"
[ "$size" -le 3000000 ] || die "the page is larger than 3 MB"
[ -n "$native" ] || exit 0
status=0
node "$root/page/test/check_file.mjs" "$packages" "$build/check.html" "$native/cscd" "${CSCD_MODELS:-$root/../shared/models}" || status=$?
[ $status -eq 0 ] || [ $status -eq 77 ] || exit 1

say "the viewer with the engine"
page=$native/share/cscd/engine_view.html
mkdir -p "${page%/*}"
node "$root/page/build.mjs" "$packages" "$page.part" "$package" again
mv "$page.part" "$page"
echo "$page: $(stat -c %s "$page") bytes"
inputs=("hand_contact --frames 40:70")
models=${CSCD_MODELS:-$root/../shared/models}
for input in "horse.glb --clip Walk" "shiba_inu.glb --clip AnimalArmature|Eating" cesium_man.glb; do
  [ ! -e "$models/${input%% *}" ] || inputs+=("$models/$input")
done
status=0
node "$root/page/test/check_again.mjs" "$packages" "$native/cscd" "${inputs[@]}" || status=$?
[ $status -eq 0 ] || [ $status -eq 77 ] || exit 1

say "answers of the package and of $native"
clips=("hand_contact 47 54" "urchin_contact 8 15")
if [ -n "$mode" ]; then
  clips=()
  for scene in rope hand octopus man box urchin fold sheet skirt bag; do clips+=("$scene 0 1000" "${scene}_contact 0 1000"); done
fi
failed=0
for words in "${clips[@]}"; do
  read -r scene from to <<<"$words"
  clip=$build/$scene.bin ours=$build/native.json theirs=$build/package.json
  PYTHONPATH=$native/python /usr/bin/python3 "$root/library/js/test/digest.py" "$clip" 0 "$native/cscd" "$scene" "$from" "$to" >"$ours"
  node "$package/test/digest.mjs" "$clip" 0 >"$theirs"
  /usr/bin/python3 - "$scene" "$ours" "$theirs" <<'TEXT' || failed=1
import json, sys
scene, native, package = sys.argv[1], *(json.load(open(path)) for path in sys.argv[2:])
same = native["digest"] == package["digest"]
print(f"{scene}, {native['contacts']} contacts: {'the same answers' if same else 'FAILED: other answers'}")
sys.exit(not same)
TEXT
  rm "$clip"
done
exit $failed
