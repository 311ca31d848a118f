#!/usr/bin/env bash
# One script for everything: see usage below, or ./build.sh --help.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

usage() {
  cat <<'END'
usage: ./build.sh WORD

  demo            install the packages that are missing, build, drape a cloth from an OBJ over a body into out/demo
  test            the same, then build and run every test
  build           install what is missing and build the program, build/release/drape
  python          build the Python module into build/release/python and say how to use it
  bench           build and run the benchmarks, and what `fabrics` does: more than an hour
  fabrics         measure what docs/fabrics.md says of fabrics and meshes: cantilevers, moduli, garments on the floor, sheets on a
                  ball, drape tests; half an hour
  pictures        run the scenes of the gallery into out/pictures and draw them into data/pictures
  compare         compare solvers and integrators on gallery scenes and generated sheets, into out/compare
  lint [--all | --since REVISION]
                  check the formatting, then clang-tidy: the files that differ from the last commit of origin (when that is the one
                  checked out, from the one before), from REVISION, or all
  format          format the sources in place; format --check only looks
  sanitize        build with the address and undefined-behaviour sanitizers and run the tests, but for the slow ones
  soak            look for a way through cloth in 1,000,000 motions and 1,000 drops of garments: an hour or two
  debug           build with assertions, for a debugger, and run the quick tests
  clang           build with clang and run the quick tests
  odr             build the program as for debug, for any processor, and check, when linking, that no two source files mean
                  different things by one name
  docs            make a site of the pages in docs/ and of the C++ interface, build/docs/site, and look for dead links in it
  install PREFIX  build, then install the program, the library and its headers under PREFIX

Missing Debian or Ubuntu packages are installed with apt-get, through sudo when not root; elsewhere they are only named.
DRAPE_JOBS=N sets the number of compile jobs; otherwise it follows from the processors and the free memory.
END
}

say() { printf '== %s\n' "$*"; }
warn() { printf 'build.sh: %s\n' "$*" >&2; }
die() {
  warn "$*"
  exit 1
}

# --- packages ---------------------------------------------------------------------------------------------------------------

required=(g++ cmake ninja-build libeigen3-dev libspectra-dev libembree-dev libtoml11-dev libcli11-dev nlohmann-json3-dev libudunits2-dev libcsv-dev
  libboost-dev libsvgpp-dev libpugixml-dev libpng-dev libfreetype-dev fonts-dejavu-core zlib1g-dev)
optional=(libsuitesparse-dev libopenblas0-pthread libsundials-dev libopenvdb-dev libbullet-dev)
for_viewer=(nodejs npm)
for_docs=(python3 python3-sphinx python3-myst-parser furo doxygen linkchecker)
for_python=(python3-dev pybind11-dev python3-numpy)
for_quick_tests=(catch2 libtinyobjloader-dev libstb-dev)
for_tests=("${for_quick_tests[@]}" "${for_docs[@]}"
  "${for_python[@]}" python3-scipy python3-matplotlib python3-venv python3-pip python3-setuptools python3-wheel mypy)
for_browser_tests=(chromium-headless-shell)
for_export_tests=(python3-numpy python3-meshio python3-vtk9 blender chromium-headless-shell nodejs npm)  # readers of what is exported, writers of what is read
for_format=(clang-format)
for_lint=(clang-tidy)
for_clang=(clang)

installed() {
  case "$1" in  # a tool counts wherever it comes from
    g++) [[ -n "${CXX:-}" ]] || command -v g++ >/dev/null ;;
    clang) command -v clang++ >/dev/null ;;
    cmake | clang-format | clang-tidy | npm) command -v "$1" >/dev/null ;;
    ninja-build) command -v ninja >/dev/null ;;
    nodejs) command -v node >/dev/null || command -v nodejs >/dev/null ;;
    chromium-headless-shell) command -v chromium-headless-shell chromium chromium-browser google-chrome >/dev/null ;;
    blender) command -v "$1" >/dev/null ;;
    *) command -v dpkg-query >/dev/null && [[ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" == installed ]] ;;
  esac
}

missing() {
  local package
  for package in "$@"; do
    installed "$package" || printf '%s\n' "$package"
  done
}

as_root() {
  if [[ $EUID -eq 0 ]]; then "$@"; else sudo "$@"; fi
}

apt_install() {
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install --yes --no-install-recommends "$@"
}

apt_knows() {  # every one of these packages
  local package
  for package in "$@"; do
    [[ -n "$(apt-cache show --no-all-versions "$package" 2>/dev/null)" ]] || return 1
  done
}

apt_update() {
  say "updating the list of packages"
  as_root apt-get update
}

# Installs those of the packages that are missing. Fails only when the package manager does.
get() {
  local -a needed
  mapfile -t needed < <(missing "$@")
  [[ ${#needed[@]} -gt 0 ]] || return 0
  if ! command -v apt-get >/dev/null; then
    warn "there is no apt-get here; this needs what Debian calls: ${needed[*]}"
    return 0
  fi
  if [[ $EUID -ne 0 ]] && ! command -v sudo >/dev/null; then
    warn "not root, and there is no sudo; to be installed: apt-get install ${needed[*]}"
    return 0
  fi
  say "installing the missing packages: ${needed[*]}"
  if ! apt_knows "${needed[@]}"; then
    apt_update || return 1
    apt_install "${needed[@]}"
  else
    # A list that has grown old names files that are gone.
    apt_install "${needed[@]}" || { apt_update && apt_install "${needed[@]}"; }
  fi
}

get_required() {
  get "$@" || die "these packages could not be installed: $(missing "$@" | tr '\n' ' ')"
}

get_for_build() {
  get_required "${required[@]}"
  get "${optional[@]}" || warn "going on without: $(missing "${optional[@]}" | tr '\n' ' ')"
  get "${for_viewer[@]}" || warn "going on without the viewer, for there is no $(missing "${for_viewer[@]}" | tr '\n' ' ')"
}

# The packages of the folder's package-lock.json, when they are not there yet.
get_from_npm() {
  local installed=$1/node_modules/.package-lock.json
  command -v npm >/dev/null || { warn "there is no npm: tests that need $1/node_modules are skipped"; return 0; }
  [[ -f "$installed" && ! "$1/package-lock.json" -nt "$installed" ]] && return 0
  say "installing the packages of $1/package-lock.json"
  npm ci --prefix "$1" --no-audit --no-fund || warn "npm could not install them: tests that need them are skipped"
}

# What only reads what is exported: a test whose reader is missing is skipped and says so.
get_for_export_tests() {
  get "${for_export_tests[@]}" || warn "going on without: $(missing "${for_export_tests[@]}" | tr '\n' ' ')"
  get_from_npm tests/exports
}

# --- building ---------------------------------------------------------------------------------------------------------------

# As many compile jobs as there are processors, and at most one for every 1.5 GB of free memory.
jobs() {
  if [[ -n "${DRAPE_JOBS:-}" ]]; then
    printf '%s\n' "$DRAPE_JOBS"
    return
  fi
  local processors free_kb limit
  processors=$(nproc 2>/dev/null || echo 1)
  free_kb=$(awk '/^MemAvailable:/ { print $2 }' /proc/meminfo 2>/dev/null || true)
  limit=$(cat /sys/fs/cgroup/memory.max 2>/dev/null || true)  # of a container
  if [[ "$limit" =~ ^[0-9]+$ ]] && ((limit / 1024 < ${free_kb:-0})); then free_kb=$((limit / 1024)); fi
  awk -v p="$processors" -v kb="${free_kb:-0}" 'BEGIN { m = kb > 0 ? int(kb / 1572864) : p; n = m < p ? m : p; print n < 1 ? 1 : n }'
}

# configure PRESET [OPTION...]
configure() {
  local preset=$1
  shift
  local -a options=("$@")
  if command -v ccache >/dev/null; then
    export CCACHE_SLOPPINESS=pch_defines,time_macros  # else it serves no file with precompiled headers, as its manual says
    local flags=-fpch-preprocess
    [[ "$preset" != clang ]] || flags="-Xclang -fno-pch-timestamp"
    options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache "-DCMAKE_CXX_FLAGS=$flags")
  fi
  say "configuring build/$preset"
  cmake --preset "$preset" ${options[@]+"${options[@]}"} || die "configuring failed, see above"
}

# compile PRESET [TARGET]
compile() {
  local preset=$1
  shift
  say "building build/$preset"
  cmake --build --preset "$preset" --parallel "$(jobs)" ${1:+--target "$@"} || die "building failed, see above"
}

# One tree serves every word. A new one is made without the tests; one that has them keeps them.
configure_program() {
  if [[ -f build/release/CMakeCache.txt ]]; then configure release; else configure release -DDRAPE_TESTS=OFF; fi
}

# run_tests PRESET [CTEST OPTION...]
run_tests() {
  local preset=$1
  shift
  say "running the tests of build/$preset"
  ctest --test-dir "build/$preset" --output-on-failure --parallel "$(nproc)" "$@" || die "tests failed, see above"
}

# --- words ------------------------------------------------------------------------------------------------------------------

build() {
  get_for_build
  configure_program
  compile release drape_program
}

demo() {
  local scene=data/scenes/poncho.toml out=out/demo
  build
  say "draping $scene into $out"
  build/release/drape simulate "$scene" --out "$out" || die "the demo failed, see above"
  say "written:"
  find "$out" -type f -printf '%10s bytes  %p\n' | sort -k3
}

run_all_tests() {
  get_for_build
  get_required "${for_tests[@]}"
  get "${for_browser_tests[@]}" || warn "going on without a browser: the tests of the viewer will be skipped"
  get_for_export_tests
  configure release -DDRAPE_TESTS=ON -DDRAPE_PYTHON=ON
  compile release
  run_tests release
}

sanitize() {
  get_for_build
  get_required "${for_tests[@]}"
  configure sanitize -DDRAPE_TESTS=ON -DDRAPE_PYTHON=ON
  compile sanitize
  run_tests sanitize --label-exclude slow
}

soak() {
  with_quick_tests release
  say "looking for a way through cloth"
  build/release/tests/drape_tests "[soak]"
}

# with_quick_tests PRESET: the program and the tests
with_quick_tests() {
  get_for_build
  get_required "${for_quick_tests[@]}"
  configure "$1" -DDRAPE_TESTS=ON
  compile "$1" drape_program drape_tests
}

# quick_tests PRESET: of the library and the program
quick_tests() {
  with_quick_tests "$1"
  run_tests "$1" --label-regex quick
}

debug() { quick_tests debug; }
# What a test defines for itself stands in no named namespace (tests/test_layering.cpp): it need not be built here.
odr() {
  get_for_build
  configure odr -DDRAPE_TESTS=OFF
  compile odr drape_program
}

clang() {
  get_required "${for_clang[@]}"
  quick_tests clang
}

bench() {
  get_for_build
  configure_program
  compile release drape_bench drape_bench_contact drape_bench_motion drape_bench_pattern drape_bench_positions drape_bench_solvers
  build/release/drape_bench "$@"
  [[ $# -eq 0 ]] || return 0
  build/release/drape_bench_contact
  build/release/drape_bench_motion 32 100 200 400  # half an hour
  build/release/drape_bench_pattern
  build/release/drape_bench_positions
  fabrics
  build/release/drape_bench_solvers 32 100
}

# A measurement that fails is told at the end; the others go on.
fabrics() {
  local out=out/fabrics python=/usr/bin/python3 model name
  local -a failed=()
  get_for_build
  get_required python3-numpy python3-scipy
  configure_program
  compile release drape_program drape_bench_fabric
  build/release/drape_bench_fabric || failed+=(drape_bench_fabric)
  mkdir -p "$out"
  printf '%s\n' 'area_density = 0.15' 'stretch = 500' 'bend = 1e-5' 'compression = 1' >"$out/plain.toml"
  for model in noh-jung woven; do
    say "moduli, $model"
    build/release/drape test-fabric "$out/plain.toml" --tests tensile,shear --mesh 14mm,10mm,5mm --model "$model" --out "$out/$model" || failed+=("moduli of $model")
  done
  say "garments dropped on the floor"
  "$python" tests/compare/garments_on_floor.py || failed+=(garments_on_floor.py)
  for model in noh-jung woven; do
    say "sheets on a ball, $model"
    "$python" tests/compare/two_meshes.py --edges 15,10,7.5,5 --starts 1 --model "$model" || failed+=("two_meshes.py of $model")
  done
  for name in polyester-twill polyester-plain cotton-broad polyester-tropical wool-polyester-twill polyester-elastane-plain; do
    say "drape test, $name: woven with friction"
    build/release/drape test-fabric "$name" --tests drape --repeats 2 --hysteresis --out "$out/$name" || failed+=("the drape of $name")
    say "drape test, $name: noh-jung"
    build/release/drape test-fabric "$name" --tests drape --repeats 2 --model noh-jung --out "$out/$name-springs" || failed+=("the drape of $name with springs")
  done
  [[ ${#failed[@]} -eq 0 ]] || die "failed: ${failed[*]}"
}

python_module() {
  get_for_build
  get_required "${for_python[@]}"
  if [[ -f build/release/CMakeCache.txt ]]; then configure release -DDRAPE_PYTHON=ON
  else configure release -DDRAPE_TESTS=OFF -DDRAPE_PYTHON=ON; fi
  compile release drape_python
  local python
  python=$(sed -n 's/^Python_EXECUTABLE:[A-Z]*=//p' build/release/CMakeCache.txt)
  say "built for $python; to use it:"
  printf '  PYTHONPATH=%s %s app/python/examples/single_step.py\n' build/release/python "$python"
  printf '  DRAPE_BUILD_DIR=build/release pip install --no-build-isolation .      # into a virtual environment of that python\n'
}

# A difference between solvers is shown at the end; the other comparisons go on.
compare() {
  local out=out/compare python=/usr/bin/python3 name
  local -a failed=()
  build
  get python3-matplotlib || warn "going on without the plots"
  for name in flag sheet-on-ball; do
    say "comparing solvers and integrators on $name into $out/$name"
    build/release/drape compare "data/scenes/$name.toml" --integrators implicit-euler --out "$out/$name" || failed+=("$name")
  done
  say "comparing solvers on generated sheets into $out/sizes"
  build/release/drape compare --sizes 1k,4k --out "$out/sizes" || failed+=(sizes)
  if installed python3-matplotlib; then
    "$python" tests/compare/plot_compare.py "$out"/*/compare.json --out "$out/plots" || failed+=(plots)
  fi
  [[ ${#failed[@]} -eq 0 ]] || die "these comparisons failed or differ, see above: ${failed[*]}"
}

# Every picture of data/pictures again.
pictures() {
  local out=out/pictures python=/usr/bin/python3 scene
  build
  get_required python3-scipy
  say "making the motion of a body"
  "$python" data/meshes/make_motion.py || die "the motion could not be made, see above"
  for scene in bias boxes-stack choi-ko-{100,200} dressed-turn fast-ball funnel layers ls-ball-{0,09} nails net net-on-table noh-jung-{100,200} poncho poncho-sewn rope-{box,chain,drum,on-sheet,sheet} rotating-ball sheet-{clusters,torn} skirt-sewn sleeve-twist \
    soft-{bowl,sphere,stack} stack tablecloth-pull tee towel; do
    say "running $scene into $out/$scene"
    build/release/drape simulate "data/scenes/$scene.toml" --out "$out/$scene" || die "$scene failed, see above"
  done
  for scene in noh-jung woven; do
    build/release/drape drop data/meshes/tee.obj --onto plane --duration 1.5 --set "cloth.0.model=$scene" --out "$out/dropped/$scene" \
      || die "dropping the shirt failed, see above"
    build/release/drape drop data/meshes/dress.obj --onto plane --duration 1.5 --set "cloth.0.model=$scene" \
      --out "$out/dropped-dress/$scene" || die "dropping the dress failed, see above"
  done
  say "drawing into data/pictures"
  draw poncho 1100x580 -25,10 '' tee poncho
  draw noh-jung 900x400 -25,18 '' noh-jung-{200,100}
  draw choi-ko 900x400 -25,18 '' choi-ko-{200,100}
  draw poncho-sewn 1280x420 -25,14 1,6,13,last poncho-sewn
  draw skirt-sewn 1280x300 -25,20 1,6,13,last skirt-sewn
  draw soft 800x700 -25,18 12,24 soft-{sphere,bowl}
  draw net 1280x330 -20,14 1,18,25,last net
  draw rope-box 1200x440 -15,5 1,20,40,last rope-box
  draw rope-chain 1200x500 -15,5 1,20,40,last rope-chain
  draw rope-drum 1200x440 -25,10 1,75,120,last rope-drum
  draw rope-on-sheet 1200x440 30,30 1,25,38,last rope-on-sheet
  draw net-on-table 1200x440 30,20 1,25,100,last net-on-table
  draw rope-sheet 1200x440 -25,14 1,20,40,last rope-sheet
  draw sheet-clusters 1200x400 -25,14 10,25,35,last sheet-clusters
  draw sheet-torn 1200x400 120,50 1,21,24,last sheet-torn
  draw boxes-stack 1200x440 -25,14 1,20,40,last boxes-stack
  draw rotating-ball 1200x340 -20,10 76,101,114,last rotating-ball
  draw tablecloth-pull 1100x440 -20,14 50,80,90,last tablecloth-pull
  draw ls-ball 800x600 -20,14 14,20 ls-ball-{0,09}
  draw dressed-turn 1100x420 15,8 1,41,59,last dressed-turn
  draw dropped-shirt 1000x360 -25,30 '' dropped/noh-jung dropped/woven
  draw dropped-dress 1000x460 -25,30 '' dropped-dress/noh-jung dropped-dress/woven
  draw layers 1200x440 -25,14 4,9,16,last layers
  draw soft-stack 1200x400 -25,14 8,14,22,last soft-stack
  draw nails 1200x700 -25,14 5,12,38,last nails
  draw fast-ball 1200x800 60,10 1,8,14,26 fast-ball
  draw funnel 1200x800 -20,35 1,50,80,last funnel
  draw sleeve-twist 1200x800 -20,15 1,40,70,last sleeve-twist
  draw stack 1200x700 -25,14 1,15,30,last stack
  draw towel 1200x400 -25,14 8,14,20,last towel
  draw bias 900x480 -35,12 last bias
  draw strain 640x480 -25,14 last poncho --color strain
}

# draw NAME SIZE VIEW FRAMES RUN... [OPTION...]: several frames or runs side by side
draw() {
  local name=$1 size=$2 view=$3 frames=$4
  shift 4
  local -a words=(--size "$size" "--view=$view" --force -o "../../data/pictures/$name.png")
  [[ -z "$frames" ]] || words+=(--frame "$frames")
  [[ "$frames" != *,* ]] || words+=(--grid)
  (cd out/pictures && ../../build/release/drape picture "$@" "${words[@]}") || die "drawing $name failed, see above"
}

# The tables of keys, fabrics and solvers are written anew first: the program has them.
docs() {
  build
  get_required "${for_docs[@]}"
  say "writing what the program knows into docs/"
  /usr/bin/python3 tests/docs/made.py --program build/release/drape --write docs/*.md || die "docs/ could not be written, see above"
  say "making build/docs/site"
  /usr/bin/python3 docs/make.py build/docs/site || die "the site has mistakes, see above"
}

install_into() {
  [[ $# -eq 1 ]] || { warn "install needs one folder: ./build.sh install PREFIX"; exit 2; }
  build
  compile release drape
  cmake --install build/release --prefix "$1" || die "installing under $1 failed, see above"
}

sources() {  # the tracked ones, or in a copy without git all of them
  git ls-files -- '*.h' '*.cpp' 2>/dev/null | grep . || find mesh constraints solver app tests -name '*.h' -o -name '*.cpp' | sort
}

# Another version of clang-format breaks lines elsewhere: only this one decides.
format_version=14

format() {
  get_required "${for_format[@]}"
  local version
  version=$(clang-format --version | sed -n 's/.*version \([0-9]*\)\..*/\1/p')
  local -a files
  mapfile -t files < <(sources)
  if [[ "$version" != "$format_version" ]]; then
    warn "formatting is as clang-format $format_version does it, and this is version $version: not done"
  elif [[ "${1:-}" == --check ]]; then
    say "checking the format of ${#files[@]} files"
    clang-format --dry-run -Werror "${files[@]}" || die "not formatted, see above; ./build.sh format puts it right"
  else
    clang-format -i "${files[@]}"
  fi
}

# changed_sources REVISION: those that differ from it; for a header also what includes it in its own room, else one of the files that do.
changed_sources() {
  local changed users
  git diff --name-only --diff-filter=d "$1" -- '*.h' '*.cpp' | while read -r changed; do
    [[ "$changed" == *.h ]] || { printf '%s\n' "$changed"; continue; }
    users=$(git grep -lF "#include \"$changed\"" -- "${changed%/*}/*.cpp" || true)
    [[ -n "$users" ]] || users=$(git grep -lF "#include \"$changed\"" -- '*.cpp' | sed -n 1p || true)
    printf '%s\n' "$users"
  done | grep . | sort -u
}

# The last commit of origin; when that is the one checked out, the one before. Empty: there is none.
last_of_origin() {
  local branch
  for branch in origin/HEAD origin/main; do
    git rev-parse --verify --quiet "$branch^{commit}" >/dev/null 2>&1 || continue
    if git merge-base --is-ancestor HEAD "$branch"; then git rev-parse --verify --quiet HEAD^ || true
    else git merge-base HEAD "$branch" || true; fi
    return
  done
}

# Of the files on its input those that build/lint compiles: not the ones of other options, nor those of tests/outside.
compiled_here() {
  grep '\.cpp$' | while read -r file; do
    ! grep -qF "\"file\": \"$PWD/$file\"" build/lint/compile_commands.json || printf '%s\n' "$file"
  done
}

lint() {
  local since
  case "${1:-}" in
    '') since=$(last_of_origin) ;;
    --all) since= ;;
    --since) since=$(git rev-parse --verify --quiet "${2:-}^{commit}") || die "lint --since: there is no revision '${2:-}' here" ;;
    *) warn "lint takes nothing more, --all, or --since REVISION, but got: $*"; exit 2 ;;
  esac
  format --check
  get_for_build
  get_required "${for_tests[@]}" "${for_lint[@]}"
  configure lint -DDRAPE_TESTS=ON -DDRAPE_PYTHON=ON
  local -a files
  mapfile -t files < <(if [[ -n "$since" ]]; then changed_sources "$since"; else sources; fi | compiled_here)
  say "clang-tidy on ${#files[@]} files"
  [[ ${#files[@]} -eq 0 ]] || tidy "${files[@]}" || die "clang-tidy has findings, see above"
}

# The analyzer is for the library: in app/ and tests/ it would spend minutes in the headers of the command line, TOML and Catch.
tidy() {
  local -a arguments=(--quiet -p build/lint --extra-arg=-w) library others
  mapfile -t library < <(printf '%s\n' "$@" | grep -E '^(mesh|constraints|solver)/')
  mapfile -t others < <(printf '%s\n' "$@" | grep -vE '^(mesh|constraints|solver)/')
  local status=0
  [[ ${#library[@]} -eq 0 ]] || printf '%s\n' "${library[@]}" | xargs -P "$(jobs)" -n 1 clang-tidy "${arguments[@]}" || status=1
  [[ ${#others[@]} -eq 0 ]] || printf '%s\n' "${others[@]}" | xargs -P "$(jobs)" -n 1 clang-tidy "${arguments[@]}" '--checks=-clang-analyzer-*' || status=1
  return $status
}

word=${1:-}
[[ $# -eq 0 ]] || shift
case "$word" in
  demo | build | docs | pictures | compare | sanitize | soak | debug | clang | odr)
    [[ $# -eq 0 ]] || { warn "'$word' takes nothing more, but got: $*"; exit 2; }
    "$word"
    ;;
  test)
    [[ $# -eq 0 ]] || { warn "'test' takes nothing more, but got: $*"; exit 2; }
    run_all_tests
    ;;
  bench) bench "$@" ;;
  fabrics)
    [[ $# -eq 0 ]] || { warn "'fabrics' takes nothing more, but got: $*"; exit 2; }
    fabrics
    ;;
  lint) lint "$@" ;;
  format) format "$@" ;;
  python)
    [[ $# -eq 0 ]] || { warn "'python' takes nothing more, but got: $*"; exit 2; }
    python_module
    ;;
  install) install_into "$@" ;;
  -h | --help | help) usage ;;
  *)
    [[ -z "$word" ]] || warn "there is no '$word'"
    usage >&2
    exit 2
    ;;
esac
