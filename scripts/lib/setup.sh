# shellcheck shell=bash disable=SC2034,SC2154
# Sourced by the other scripts: what they need from Debian, in one place, and how they build.
# Each package has its line of reason in scripts/README.md.

packages_build=(g++ cmake ninja-build git libeigen3-dev libboost-dev nlohmann-json3-dev libcli11-dev libvalijson-dev libhdf5-dev
                libgmp-dev libtbb-dev libassimp-dev libtinygltf-dev libmeshoptimizer-dev libdraco-dev zlib1g-dev
                libpugixml-dev libcgal-dev libssl-dev libgtest-dev python3)
# The viewer's bundler. Whoever has a Node already keeps it.
if ! command -v node >/dev/null || ! command -v npm >/dev/null; then packages_build+=(nodejs npm); fi
packages_compare=(libembree-dev libfcl-dev)
packages_figures=(python3-matplotlib)
packages_real=(python3-h5py)
packages_counters=(valgrind)
packages_kernels=(libbenchmark-dev)
packages_tests=(assimp-testmodels chromium clang-format pybind11-dev python3-dev python3-numpy python3-h5py
                python3-pip python3-setuptools python3-wheel doxygen pkg-config)
packages_clang=(clang)
packages_wasm=(clang-19 lld-19 libc++-19-dev-wasm32 libc++abi-19-dev-wasm32 libclang-rt-19-dev-wasm32 wasi-libc)

say() { printf '\n== %s\n' "$*"; }
die() { printf '%s: %s\n' "${CSCD_SCRIPT:-${0##*/}}" "$*" >&2; exit 2; }  # Python scripts set CSCD_SCRIPT

# Installs those of the given packages that are missing; touches nothing when none is.
install_packages() {
  local missing=() package
  command -v dpkg-query >/dev/null || die "needs Debian 12 or a system like it; install by hand: $*"
  for package in "$@"; do
    dpkg-query -W -f '${db:Status-Abbrev}' "$package" 2>/dev/null | grep -q '^ii' || missing+=("$package")
  done
  if [ ${#missing[@]} -eq 0 ]; then echo "all ${#} packages are there"; return; fi
  echo "installing ${missing[*]}"
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || die "neither root nor sudo; install by hand: apt-get install ${missing[*]}"
    as_root=(sudo)
  fi
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get update -q </dev/null
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -q --no-install-recommends "${missing[@]}" </dev/null
}

# build FOLDER CACHE-FILE COMPILER TARGET...: configures and builds below the repository's root.
build() {
  local folder=$1 cache=$2 compiler=$3
  shift 3
  local cxx=g++ cc=gcc
  [ "$compiler" = clang ] && cxx=clang++ cc=clang
  # Of a folder that was configured with another compiler CMake forgets the cache file's settings, silently.
  local known=$root/$folder/CMakeCache.txt
  if [ -e "$known" ] && ! grep -Eq "^CMAKE_CXX_COMPILER:[A-Z]+=(.*/)?$cxx\$" "$known"; then rm "$known"; fi
  cmake -S "$root" -B "$root/$folder" -G Ninja -C "$root/scripts/cmake/$cache.cmake" \
    -DCMAKE_CXX_COMPILER="$cxx" -DCMAKE_C_COMPILER="$cc" >/dev/null
  ninja -C "$root/$folder" "$@"
}

# new_results SUFFIX: makes a folder results/DATE-MACHINE-COMMIT[-SUFFIX]... below the working folder, which must be the
# repository's root. `out` is its name; until `keep_results` it is called $out.part, and goes if the script ends before.
new_results() {
  local machine commit folder i
  machine=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1 | tr '[:upper:]' '[:lower:]' |
            sed -E 's/\((r|tm)\)//g; s/[^a-z0-9]+/-/g; s/^-|-$//g' | cut -c 1-40)
  commit=$(git rev-parse --short=10 HEAD 2>/dev/null || echo no-commit)
  folder=results/$(date -u +%F)-${machine:-unknown}-$(nproc)core-$commit${1:+-$1}
  out=$folder
  for ((i = 2; ; i++)); do  # what stands there is never overwritten
    [ -e "$out" ] || break
    out=$folder-$i
  done
  mkdir -p results "$out.part"
  trap 'rm -rf "$root/$out.part"' EXIT
}
keep_results() { mv "$out.part" "$out"; }
