#!/usr/bin/env bats
# What the README shows runs as it stands there, and its pictures are what the tools make.

load common

# The demo's card: 24 patches of 96 pixels with gaps of 12.
card() {
  local patches
  patches=$(cd "$ROOT/spectra/reflectance" && ls colorchecker/*.spd)
  # shellcheck disable=SC2086 # a word per patch
  specconvert --patches 6x4 --patch 96 --gap 12 --grid 380:780:5 ${patches//.spd/} -o card.exr
}

# The demo's layers, small.
layers() {
  cp "$ROOT"/tests/figures/{room,bubble}.pbrt .
  specrender room.pbrt --grid 400:700:50 --size 32x16 --spp 1 -o room.exr
  specrender bubble.pbrt --grid 400:700:50 --size 64x36 --spp 1 --defer film -o layers.exr
}

# The indented lines that begin with a tool's name.
commands() {
  sed -n 's/^    \(spec[a-z0-9]* .*\)$/\1/p' "$ROOT/README.md"
}

@test "every command of the README runs" {
  card
  layers
  commands >script
  [ "$(grep -c . script)" -ge 5 ]
  bash -e -o pipefail script
  [ -s rings.png ]
}

@test "the README's pictures are what the tools make" {
  card
  for light in D65 A; do
    spec2rgb card.exr --illuminant "$light" -o "$light.png"
    # Another compiler may round one code up that this one rounds down.
    [ "$("$TESTS/pngdiff" "$light.png" "$ROOT/tests/figures/card-$light.png")" -le 1 ]
  done
}

@test "the README shows pictures that are there" {
  [ "$(grep -c '^!\[' "$ROOT/README.md")" -ge 2 ]
  while read -r picture; do
    [ -s "$ROOT/$picture" ]
  done < <(sed -n 's/^!\[.*\](\(.*\))$/\1/p' "$ROOT/README.md")
}

@test "each tool of the README is there, and no other is missing from it" {
  for tool in "$ROOT"/cmd/*.c; do
    tool=${tool##*/}
    grep -q "^| \`${tool%.c}\` |" "$ROOT/README.md"
  done
}
