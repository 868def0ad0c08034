#!/usr/bin/env bash
# install_packages.sh GROUP...   installs the Debian or Ubuntu packages of the groups that are missing
#
# Groups: build (compile and test), scenes (make the paper's scenes), lint (format and static checks), fuzz (clang
# with libFuzzer).
# Asks before it installs. ASSUME_YES=1 or CI=true: installs without asking. SKIP_PACKAGES=1: does nothing,
# for machines whose packages come from elsewhere.
set -euo pipefail

# package[:command]; a command that is found, from wherever, counts as its package.
BUILD=(
    g++:g++
    cmake:cmake
    ninja-build:ninja
    python3:python3
    libeigen3-dev
    libtbb-dev
    libsuitesparse-dev # CHOLMOD; brings METIS
    libopenblas0       # CHOLMOD's BLAS; the reference BLAS it would take instead is several times slower
    libxxhash-dev
    libembree-dev
    libassimp-dev
    libcgal-dev        # exact predicates, triangulations; header-only
    nlohmann-json3-dev
    libtinygltf-dev    # header-only as it is used
    libpng-dev
    libjpeg-dev        # libjpeg-turbo
    libcli11-dev
    libgtest-dev
)
SCENES=(python3-numpy python3-scipy python3-skimage python3-matplotlib) # of the system's interpreter
LINT=(clang-format:clang-format clang-tidy:clang-tidy git:git)
FUZZ=(clang:clang++ libclang-rt-14-dev)
OPTIONAL=("ffmpeg:the demo also writes MP4 films" "ccache:rebuilds take seconds")

CMAKE_NEEDED=3.25
GCC_NEEDED=12

fail() {
    echo "error: $*" >&2
    exit 1
}

is_installed() { # package command
    [[ -n $2 ]] && command -v "$2" >/dev/null && return
    [[ $(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null) == installed ]]
}

collect_wanted() { # group...
    wanted=()
    local group
    for group in "$@"; do
        case $group in
        build) wanted+=("${BUILD[@]}") ;;
        scenes) wanted+=("${SCENES[@]}") ;;
        lint) wanted+=("${LINT[@]}") ;;
        fuzz) wanted+=("${FUZZ[@]}") ;;
        *) fail "unknown package group '$group'; the groups are build, scenes, lint and fuzz" ;;
        esac
    done
}

collect_missing() {
    missing=()
    local entry package command
    for entry in "${wanted[@]}"; do
        package=${entry%%:*}
        command=${entry#"$package"}
        is_installed "$package" "${command#:}" || missing+=("$package")
    done
}

agree() {
    [[ ${ASSUME_YES:-} == 1 || ${CI:-} == true ]] && return
    [[ -t 0 ]] || fail "no terminal to ask on; call again with ASSUME_YES=1, or: ${install[*]} ${missing[*]}"
    local answer
    read -r -p "Install them with '${install[*]} ...'? [Y/n] " answer
    [[ ${answer:-y} == [yY]* ]] || fail "nothing installed; by hand: ${install[*]} ${missing[*]}"
}

choose_installer() {
    as_root=()
    if ((EUID != 0)); then
        command -v sudo >/dev/null ||
            fail "neither root nor sudo here; have an administrator run: apt-get install ${missing[*]}"
        as_root=(sudo)
        # Without a terminal sudo must not wait for a password.
        [[ -t 0 ]] || as_root=(sudo -n)
    fi
    install=("${as_root[@]}" apt-get install -y --no-install-recommends)
}

run_apt() {
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=120 "$@"
}

# Package lists that are missing or older than a day name files that the mirrors may no longer hold.
lists_are_fresh() {
    compgen -G '/var/lib/apt/lists/*Packages*' >/dev/null &&
        [[ -n $(find /var/lib/apt/lists -maxdepth 0 -mmin -1440) ]]
}

install_missing() {
    if lists_are_fresh && run_apt install -y --no-install-recommends "${missing[@]}"; then
        return
    fi
    run_apt update || fail "'apt-get update' failed; check the network and /etc/apt"
    run_apt install -y --no-install-recommends "${missing[@]}" ||
        fail "apt-get could not install: ${missing[*]}; its own message stands above"
}

# at_least HAVE NEEDED: compares versions.
at_least() { [[ $(printf '%s\n' "$2" "$1" | sort -V | head -n 1) == "$2" ]]; }

check_versions() {
    local cmake_version gcc_version
    cmake_version=$(cmake --version | sed -n '1s/[^0-9]*//p')
    at_least "$cmake_version" $CMAKE_NEEDED ||
        fail "CMake is $cmake_version, $CMAKE_NEEDED or newer is needed (Debian 12, Ubuntu 24.04)"
    [[ -n ${CXX:-} ]] && return
    gcc_version=$(g++ -dumpfullversion)
    at_least "$gcc_version" $GCC_NEEDED ||
        fail "g++ is $gcc_version, $GCC_NEEDED or newer is needed (Debian 12, Ubuntu 24.04); or set CXX"
}

recommend_optional() {
    local entry
    for entry in "${OPTIONAL[@]}"; do
        command -v "${entry%%:*}" >/dev/null || echo "Optional, not installed: ${entry%%:*} (${entry#*:})"
    done
}

[[ ${SKIP_PACKAGES:-} == 1 ]] && exit 0
collect_wanted "$@"
if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
    fail "this system has no apt; install the counterparts of: ${wanted[*]%%:*}, then call with SKIP_PACKAGES=1"
fi
collect_missing
if ((${#missing[@]})); then
    echo "Missing packages: ${missing[*]}"
    choose_installer
    agree
    install_missing
    recommend_optional
fi
[[ " $* " != *" build "* ]] || check_versions
