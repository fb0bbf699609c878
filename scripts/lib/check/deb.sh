#!/bin/bash
# Uses Debian's packages as a stranger would, in a bare Debian: C++, Python and the program.
#
#   scripts/check deb [BUILD-FOLDER]   of a build to pack; default a new one, in build-deb; in Debian 12
#   scripts/check deb --debian 13      a bare Debian 13 makes the build, too, and runs the tests of the core, the library and the
#                                      baselines; 12 likewise
#
# C++ is used through find_package, static and shared. Nothing of the repository is known in the bare system.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../.." && pwd)
source "$root/scripts/lib/setup.sh"
debian=12 build=
case ${1:-} in
  --debian) debian=${2:-} ;;
  ?*) build=$1; [ -e "$build/CPackConfig.cmake" ] || die "$1: no build folder; usage: scripts/check deb [BUILD-FOLDER]" ;;
esac
case $debian in 12) suite=bookworm ;; 13) suite=trixie ;; *) die "--debian needs 12 or 13" ;; esac
[ "$(id -u)" -eq 0 ] || die "needs root, to make the bare system"
work=$(mktemp -d)
mounted=()
trap '{ [ ${#mounted[@]} -eq 0 ] || umount "${mounted[@]}"; } && rm -rf "$work"' EXIT
chmod 755 "$work"

# bare NAME: makes a bare Debian in $work/NAME; inside NAME COMMAND: runs a command in it.
bare() {
  say "a bare Debian $debian"
  mmdebstrap --quiet --mode=root --variant=minbase "$suite" "$work/$1"
  mount -t proc proc "$work/$1/proc"  # where a program asks for its own place
  mounted+=("$work/$1/proc")
  # Where a proxy signs what npm fetches, its certificate is needed in there, too.
  [ -z "${NODE_EXTRA_CA_CERTS:-}" ] || cp "$NODE_EXTRA_CA_CERTS" "$work/$1/certificates"
}
inside() {
  local name=$1; shift
  env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root NODE_EXTRA_CA_CERTS=/certificates chroot "$work/$name" "$@"
}

if [ "${1:-}" = --debian ]; then
  echo "Makes two bare Debian $debian below ${TMPDIR:-/tmp} and builds in one of them: half an hour on 2 idle cores, 4 GB, gone"
  echo "afterwards. Installs mmdebstrap where it is missing."
  install_packages mmdebstrap
  bare builder
  mkdir "$work/builder/cscd"
  git -C "$root" ls-files -z | tar -C "$root" --null --ignore-failed-read -T - -c | tar -C "$work/builder/cscd" -x
  say "set-up, build, tests and packages"
  cat >"$work/builder/build" <<'TEXT'
set -euo pipefail
root=/cscd
source $root/scripts/lib/setup.sh
install_packages "${packages_build[@]}" "${packages_compare[@]}" pybind11-dev python3-dev python3-numpy dpkg-dev file >/log 2>&1 ||
  { tail -n 20 /log; exit 1; }
# The packages need what is named here, and none of the other test programs.
cmake -S $root -B /b -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_SKIP_INSTALL_ALL_DEPENDENCY=ON
mapfile -t tests < <(ninja -C /b -t targets all | grep -oE '^(core|library|baselines)[a-z_]*_test:' | tr -d :)
ninja -k 0 -C /b cscd cscd-import cscd_manual cscd_static cscd_shared cscd_python "${tests[@]}"
for test in "${tests[@]}"; do "/b/$test" --gtest_brief=1; done
cd /b
cpack -B /packages
TEXT
  inside builder bash /build
  packed=$work/builder/packages
else
  echo "Installs what a build takes, mmdebstrap and dpkg-dev where they are missing; builds the program,"
  echo "and the library for each instruction set, unless a build is named; makes a Debian 12 below ${TMPDIR:-/tmp} (three minutes,"
  echo "some hundred megabytes to fetch, gone afterwards)."
  install_packages "${packages_build[@]}" pybind11-dev python3-dev mmdebstrap dpkg-dev file
  if [ -z "$build" ]; then
    say "build"
    build=$root/build-deb
    cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DBUILD_TESTING=OFF >/dev/null
    ninja -C "$build"
  fi
  say "packages"
  packed=$work/packages
  (cd "$build" && cpack -B "$packed" >"$work/log" 2>&1) || { cat "$work/log"; die "cpack fails"; }
fi

mkdir "$work/stranger"
mv "$packed"/*.deb "$work/stranger"
cp "$root"/library/consumer/CMakeLists.txt "$root"/library/examples/first_contact.{cpp,py} "$work/stranger"
for package in "$work"/stranger/*.deb; do
  echo "${package##*/}: $(dpkg-deb -f "$package" Installed-Size) kB; needs $(dpkg-deb -f "$package" Depends)"
done

cat >"$work/stranger/use" <<'TEXT'
set -eu
cd /stranger
export DEBIAN_FRONTEND=noninteractive
fails() { echo "FAILED: $*"; exit 1; }
apt-get update -q >log 2>&1 || { tail -n 20 log; fails "no package lists"; }
apt-get install -y -q --no-install-recommends ./*.deb >log 2>&1 || { tail -n 20 log; fails "the packages do not install"; }
echo "installed: $(dpkg-query -W -f '${Package} ' libcscd-dev 'cscd*' python3-cscd 2>/dev/null)"
if [ -e /usr/bin/cscd ]; then
  cscd --version
  cscd list >log || fails "cscd list"
  cscd query urchin --json urchin.json || fails "cscd query urchin"
  for set in baseline avx2 avx512; do
    CSCD_ISA=$set cscd --version >out 2>&1 && grep "CSCD_ISA=$set" out || echo "the program, $set: refused: $(cat out)"
  done
  if CSCD_ISA=none cscd list >log 2>&1; then fails "CSCD_ISA=none is taken"; else [ $? -eq 2 ] || fails "another exit status"; fi
fi
if dpkg-query -W python3-cscd >/dev/null 2>&1; then
  python3 first_contact.py || fails "the Python example"
  python3 -c 'import cscd; print("Python uses", cscd.instruction_set())' || fails "cscd.instruction_set()"
  apt-get purge -y -q python3-cscd >log 2>&1 && [ ! -e /usr/lib/python3/dist-packages/cscd ] || fails "removing leaves files of Python"
fi
apt-get install -y -q --no-install-recommends cmake g++ make >log 2>&1 || { tail -n 20 log; fails "no compiler"; }
for shared in OFF ON; do
  cmake -S . -B build -DEXAMPLE=first_contact.cpp -DSHARED=$shared -DCMAKE_BUILD_TYPE=Release >log 2>&1 &&
    cmake --build build >>log 2>&1 || { cat log; fails "the consumer does not build"; }
  ./build/consumer
  for set in baseline avx2 avx512; do
    CSCD_ISA=$set ./build/consumer >out 2>&1 && echo "$set: $(cat out)" || echo "$set: refused: $(cat out)"
  done
done
apt-get purge -y -q 'libcscd-dev' >log 2>&1 && [ ! -e /usr/include/cscd ] || fails "removing leaves files"
echo "a stranger can use the packages"
TEXT
bare user
mv "$work/stranger" "$work/user/stranger"
inside user sh /stranger/use
