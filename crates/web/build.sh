#!/usr/bin/env bash
# Builds the module for pages, delone.js and the compiled core beside it, into target/web.
#
# Where rustup has the target wasm32-unknown-unknown, or can fetch it, that compiler is used, and the
# command wasm-bindgen is compiled once (some minutes). Elsewhere a tree of Debian sid with compiler, target and the command wasm-bindgen is made once by debootstrap
# (as root; two to three minutes, 1.7 GB) in the cache folder. It does nothing while sources and output
# are those of the last build.
#
#   DELONE_WEB_OUT      the folder of the result
#   DELONE_WEB_CACHE    the folder of tools and intermediate files, ~/.cache/delone-web
#   DELONE_WEB_OFFLINE  if set, nothing is installed: without a compiler for the target, exit code 3
set -euo pipefail
cd "$(dirname "$0")/../.."

root=$PWD
target=wasm32-unknown-unknown
out=${DELONE_WEB_OUT:-$root/target/web}
cache=${DELONE_WEB_CACHE:-${XDG_CACHE_HOME:-$HOME/.cache}/delone-web}
sid=$cache/sid

say() { echo "web: $*" >&2; }

# What the result depends on.
sources() {
    find crates/web crates/delone crates/core crates/predicates -type f \
        \( -name '*.rs' -o -name '*.toml' -o -name 'Cargo.lock' -o -name '*.js' -o -name '*.ts' \) \
        -not -path '*/target/*'
    echo Cargo.toml
    echo crates/web/build.sh
}
digest=$(sources | LC_ALL=C sort | xargs sha256sum | sha256sum | cut -d ' ' -f 1)
if [ "$(cat "$out/.inputs" 2>/dev/null)" = "$digest" ] && [ -s "$out/delone_web_bg.wasm" ]; then
    say "$out is up to date"
    exit 0
fi

# Whether the compiler in the path can build for the target.
has_target() { [ -d "$(rustc --print sysroot)/lib/rustlib/$target/lib" ]; }

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
        say "no compiler for $target: run \`rustup target add $target\`, or, as root on Debian," \
            "\`apt install debootstrap\`"
        exit 3
    fi
    say "making a tree of Debian sid in $sid"
    mkdir -p "$cache"
    rm -rf "$sid"
    debootstrap --variant=minbase --include="$packages" sid "$sid" "$from" >"$cache/debootstrap.log"
    chroot "$sid" apt-get -qq -o Acquire::Check-Valid-Until=false update
    chroot "$sid" apt-get -qq -o Acquire::Check-Valid-Until=false install -y \
        --no-install-recommends wasm-bindgen >>"$cache/debootstrap.log" 2>&1
    touch "$sid/ready"
}

# The compiler: `inside` is the command that runs others where it is, `work` the folder it sees.
inside=() work=$cache/build seen=$cache/build
if ! has_target && [ ! -e "$sid/ready" ]; then
    if [ -n "${DELONE_WEB_OFFLINE:-}" ]; then
        say "no compiler for $target, and none may be installed"
        exit 3
    fi
    timeout 60 rustup target add "$target" >/dev/null 2>&1 || make_sid
fi
if [ -e "$sid/ready" ]; then
    # Debian has the linker under its own name.
    inside=(chroot "$sid" env HOME=/root PATH=/usr/bin:/bin
        CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER=wasm-ld)
    work=$sid/build seen=/build
fi

# Several trees may share the cache: one build at a time.
mkdir -p "$work"
exec 9>"$cache/lock"
if command -v flock >/dev/null; then flock 9; fi

# A copy of the sources, whose lock file may change.
rm -rf "$work/crates"
mkdir "$work/crates"
cp -p Cargo.toml Cargo.lock "$work"
cp -rp crates/predicates crates/core crates/delone crates/bindings "$work/crates"
mkdir "$work/crates/web"
cp -rp crates/web/Cargo.toml crates/web/Cargo.lock crates/web/src "$work/crates/web"

# The crate and the command wasm-bindgen must have the same version.
pinned=$(sed -n 's/^wasm-bindgen = "=\(.*\)"/\1/p' crates/web/Cargo.toml)
if [ ${#inside[@]} -eq 0 ]; then
    export PATH="$cache/bin:$PATH"
    if [ "$(wasm-bindgen --version 2>/dev/null)" != "wasm-bindgen $pinned" ]; then
        if [ -n "${DELONE_WEB_OFFLINE:-}" ]; then
            say "the command wasm-bindgen $pinned is missing, and may not be installed"
            exit 3
        fi
        say "installing wasm-bindgen $pinned"
        cargo install --quiet --root "$cache" --version "$pinned" wasm-bindgen-cli
    fi
fi
command=$("${inside[@]}" wasm-bindgen --version | cut -d ' ' -f 2)
if [ "$command" != "$pinned" ]; then
    sed -i "s/^wasm-bindgen = .*/wasm-bindgen = \"=$command\"/" "$work/crates/web/Cargo.toml"
    (cd "$work/crates/web" && cargo update --quiet wasm-bindgen --precise "$command")
fi

# The tree of Debian needs no network: its dependencies are copied into it.
mkdir -p "$work/.cargo"
(cd "$work/crates/web" && cargo vendor --quiet --locked "$work/vendor" >/dev/null 2>&1)
cat >"$work/.cargo/config.toml" <<CONFIG
[source.crates-io]
replace-with = "vendored-sources"
[source.vendored-sources]
directory = "$seen/vendor"
CONFIG

version=$(sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -n 1)
say 'compiling'
"${inside[@]}" env DELONE_VERSION="$version" CARGO_TARGET_DIR="$seen/target" \
    sh -c "cd $seen/crates/web && cargo build --quiet --release --offline --target $target"
"${inside[@]}" wasm-bindgen --target web --no-typescript --out-dir "$seen/out" \
    "$seen/target/$target/release/delone_web.wasm"
if "${inside[@]}" sh -c 'command -v wasm-opt' >/dev/null; then
    "${inside[@]}" wasm-opt -O3 --all-features -o "$seen/out/small.wasm" "$seen/out/delone_web_bg.wasm"
    mv "$work/out/small.wasm" "$work/out/delone_web_bg.wasm"
fi

mkdir -p "$out"
rm -f "$out/.inputs"
cp "$work/out/delone_web.js" "$work/out/delone_web_bg.wasm" crates/web/js/*.js crates/web/js/*.ts "$out"
echo "$digest" >"$out/.inputs"
say "$out: $(wc -c <"$out/delone_web_bg.wasm") bytes," \
    "$(gzip -9 -c "$out/delone_web_bg.wasm" | wc -c) compressed"
