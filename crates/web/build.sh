#!/usr/bin/env bash
# Builds the module for pages, delone.js and the compiled core beside it, into target/web.
#
# It needs a compiler for wasm32-unknown-unknown and the command wasm-bindgen. The first of these is
# taken that is there, or can be made:
#
#   1. a Rust that has the target, with wasm-bindgen of the version in Cargo.toml
#   2. a tree of Debian sid in the cache folder, made before
#   3. a Rust that has the target, or to which rustup adds it; wasm-bindgen is compiled once, into the
#      cache folder (some minutes)
#   4. as root on Debian, a tree of sid that debootstrap makes (two to three minutes, 1.7 GB)
#
# It does nothing while sources and output are those of the last build.
#
#   DELONE_WEB_OUT      the folder of the result
#   DELONE_WEB_CACHE    the folder of tools and intermediate files, ~/.cache/delone-web
#   DELONE_WEB_OFFLINE  if set, nothing is fetched: without the tools, exit code 3
#   DELONE_WEB_TOOLS    "rust" or "sid": only 1 and 3, or only 2 and 4
set -euo pipefail
cd "$(dirname "$0")/../.."

root=$PWD
target=wasm32-unknown-unknown
out=${DELONE_WEB_OUT:-$root/target/web}
cache=${DELONE_WEB_CACHE:-${XDG_CACHE_HOME:-$HOME/.cache}/delone-web}
sid=$cache/sid
offline=${DELONE_WEB_OFFLINE:-}
tools=${DELONE_WEB_TOOLS:-any}

say() { echo "web: $*" >&2; }
give_up() {
    say "$@"
    exit 3
}

# macOS has this under another name.
digests() { if command -v sha256sum >/dev/null; then sha256sum "$@"; else shasum -a 256 "$@"; fi; }

# Runs a command whose output is shown only if it fails.
quietly() {
    local log=$cache/log
    "$@" >"$log" 2>&1 && return
    tail -n 20 "$log" >&2
    say "failed: $*; all of its output is in $log"
    return 1
}

# What the result depends on.
sources() {
    find crates/web crates/core crates/predicates -type f \
        \( -name '*.rs' -o -name '*.toml' -o -name 'Cargo.lock' -o -name '*.js' -o -name '*.ts' \) \
        -not -path '*/target/*'
    echo Cargo.toml
    echo crates/web/build.sh
}
digest=$(sources | LC_ALL=C sort | while read -r file; do digests "$file"; done | digests | cut -d ' ' -f 1)
if [ "$(cat "$out/.inputs" 2>/dev/null)" = "$digest" ] && [ -s "$out/delone_web_bg.wasm" ]; then
    say "$out is up to date"
    exit 0
fi

# Several trees may share the cache: one build at a time.
mkdir -p "$cache"
exec 9>"$cache/lock"
if command -v flock >/dev/null; then flock 9; fi

# Whether the compiler in the path can build for the target.
has_target() {
    local sysroot
    sysroot=$(rustc --print sysroot 2>/dev/null) && [ -d "$sysroot/lib/rustlib/$target/lib" ]
}

# The crate and the command wasm-bindgen must have the same version.
pinned=$(sed -n 's/^wasm-bindgen = "=\(.*\)"/\1/p' crates/web/Cargo.toml)
has_bindgen() {
    [ "$(PATH="$cache/bin:$PATH" wasm-bindgen --version 2>/dev/null)" = "wasm-bindgen $pinned" ]
}

# The first Debian mirror among the sources of apt.
mirror() {
    sed -n -e 's/^URIs: *\([^ ]*\/debian\/*\)\( .*\)\{0,1\}$/\1/p' \
        -e 's/^deb \(\[[^]]*\] \)\{0,1\}\([^ ]*\/debian\/*\) .*/\2/p' \
        /etc/apt/sources.list.d/* /etc/apt/sources.list 2>/dev/null | head -n 1
}

# A tree of Debian sid with everything that the build needs.
make_sid() {
    local from packages=rustc,cargo,libstd-rust-dev-wasm32,lld,gcc,libc6-dev,binaryen,ca-certificates
    from=$(mirror)
    if [ -z "$from" ] || ! command -v debootstrap >/dev/null || [ "$(id -u)" -ne 0 ]; then
        give_up "no compiler for $target: run \`rustup target add $target\`, or, as root on Debian," \
            "\`apt install debootstrap\`"
    fi
    say "making a tree of Debian sid in $sid"
    rm -rf "$sid"
    # The chain stops at what fails: `set -e` does not reach into `choose`.
    quietly debootstrap --variant=minbase --include="$packages" sid "$sid" "$from" &&
        quietly chroot "$sid" apt-get -qq -o Acquire::Check-Valid-Until=false update &&
        quietly chroot "$sid" apt-get -qq -o Acquire::Check-Valid-Until=false install -y \
            --no-install-recommends wasm-bindgen &&
        # Packages that are installed need no archives.
        rm -rf "$sid/var/cache/apt/archives" "$sid/var/lib/apt/lists" &&
        touch "$sid/ready"
}

# Rust with the target and wasm-bindgen; rustup may not manage the Rust in the path.
make_rust() {
    if ! has_target; then
        command -v rustup >/dev/null && quietly rustup target add "$target" && has_target || return 1
    fi
    has_bindgen && return
    say "installing wasm-bindgen $pinned"
    quietly cargo install --locked --root "$cache" --version "$pinned" wasm-bindgen-cli
}

# Prints which tools there are, at last.
choose() {
    if [ "$tools" != sid ] && has_target && has_bindgen; then
        echo rust
    elif [ "$tools" != rust ] && [ -e "$sid/ready" ]; then
        echo sid
    elif [ -n "$offline" ]; then
        give_up "the tools for $target are missing, and nothing may be fetched"
    elif [ "$tools" != sid ] && make_rust; then
        echo rust
    elif [ "$tools" != rust ]; then
        make_sid || exit 1
        echo sid
    else
        give_up "no Rust with the target $target, or no wasm-bindgen"
    fi
}

# Where commands run, and the folder of the build, which they see as `seen`.
mode=$(choose)
if [ "$mode" = sid ]; then
    work=$sid/build seen=/build
else
    work=$cache/build seen=$cache/build
    export PATH="$cache/bin:$PATH"
fi
within() {
    # Debian has the linker under its own name.
    if [ "$mode" = sid ]; then
        chroot "$sid" env HOME=/root PATH=/usr/bin:/bin \
            CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER=wasm-ld "$@"
    else
        "$@"
    fi
}

# A copy of the sources, whose lock file may change. The configuration of the last build would send
# cargo to packages where only the tree has them.
rm -rf "$work/crates" "$work/.cargo"
mkdir -p "$work/crates/web" "$work/.cargo"
cp -p Cargo.toml Cargo.lock "$work"
cp -rp crates/predicates crates/core crates/bindings "$work/crates"
cp -rp crates/web/Cargo.toml crates/web/Cargo.lock crates/web/src "$work/crates/web"

# Debian may have another version of the command.
command=$(within wasm-bindgen --version | cut -d ' ' -f 2)
if [ "$command" != "$pinned" ]; then
    sed "s/^wasm-bindgen = .*/wasm-bindgen = \"=$command\"/" crates/web/Cargo.toml >"$work/crates/web/Cargo.toml"
    (cd "$work/crates/web" && quietly cargo update wasm-bindgen --precise "$command")
fi

# The tree of Debian needs no network: the packages are copied into it.
(cd "$work/crates/web" && quietly cargo vendor ${offline:+--offline} --locked "$work/vendor")
cat >"$work/.cargo/config.toml" <<CONFIG
[source.crates-io]
replace-with = "vendored-sources"
[source.vendored-sources]
directory = "$seen/vendor"
CONFIG

version=$(sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -n 1)
say 'compiling'
within env DELONE_VERSION="$version" CARGO_TARGET_DIR="$seen/target" \
    sh -c "cd '$seen/crates/web' && cargo build --quiet --release --offline --target $target"
within wasm-bindgen --target web --no-typescript --out-dir "$seen/out" \
    "$seen/target/$target/release/delone_web.wasm"
if within sh -c 'command -v wasm-opt' >/dev/null; then
    # Smaller and faster, but not needed: an old one may not know all features.
    if within wasm-opt -O3 --all-features -o "$seen/out/small.wasm" "$seen/out/delone_web_bg.wasm"; then
        mv "$work/out/small.wasm" "$work/out/delone_web_bg.wasm"
    else
        say 'wasm-opt failed: the module is used as it was compiled'
    fi
fi

mkdir -p "$out"
rm -f "$out/.inputs"
cp "$work/out/delone_web.js" "$work/out/delone_web_bg.wasm" crates/web/js/*.js crates/web/js/*.ts "$out"
echo "$digest" >"$out/.inputs"
say "$out: $(wc -c <"$out/delone_web_bg.wasm") bytes," \
    "$(gzip -9 -c "$out/delone_web_bg.wasm" | wc -c) compressed"
