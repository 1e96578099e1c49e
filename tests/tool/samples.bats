#!/usr/bin/env bats
# Spectral images that other programs wrote; ../shared/samples/README.md says which.
# shellcheck disable=SC2030,SC2031 # each test is a subshell, and its variables its own

load common

setup() {
  in_own_folder
  samples
}

# blue_green_red FILE CHANNELS: of an uncompressed image of one pixel, all channels FLOAT, the
# first three, which in the order of their names are B, G and R.
blue_green_red() {
  tail -c $((4 * $2)) "$1" | od -An -v -tf4 -N12 | xargs
}

# within RELATIVE "A..." "B...": each number of A is that of B but for a part of B.
within() {
  awk -v most="$1" -v a="$2" -v b="$3" 'BEGIN {
    count = split(a, x, " ")
    if (count == 0 || count != split(b, y, " ")) exit 1
    for (i = 1; i <= count; i++) {
      off = (x[i] - y[i]) / y[i]
      if (!(off <= most && off >= -most)) { print a " and " b ": off by " off; bad = 1 }
    }
    exit bad
  }'
}

# preview FILE X Y: the file's own preview, and what spec2rgb makes of its bands.
preview() {
  local channels
  channels=$(exrheader "$1" | grep -c 'floating-point, sampling')
  specconvert --compression none --crop "$2,$3,$(($2 + 1)),$(($3 + 1))" "$1" -o pixel.exr
  theirs=$(blue_green_red pixel.exr "$channels")
  spec2rgb pixel.exr -o rgb.exr
  specconvert --compression none rgb.exr -o plain.exr
  ours=$(blue_green_red plain.exr 3)
}

@test "there are samples" {
  [ "$(find "$SAMPLES" -name '*.exr' | wc -l)" -ge 6 ]
}

@test "specconvert keeps every sample as it is, from a file and through pipes" {
  for file in "$SAMPLES"/*.exr; do
    specconvert "$file" -o copy.exr
    specdiff "$file" copy.exr
    specconvert - < <(cat "$file") | specconvert --compression zip | specdiff "$file" -
  done
}

@test "specconvert keeps the attributes of every sample" {
  for file in "$SAMPLES"/*.exr; do
    specconvert --no-history "$file" -o copy.exr
    # bands are renamed; the compression is ours; a version of the layout is always written
    diff <(exrheader "$file" | grep -vE '^file |sampling|^(compression|emissiveUnits|spectralLayoutVersion) ') \
      <(exrheader copy.exr | grep -vE '^file |sampling|^(compression|emissiveUnits|spectralLayoutVersion) ')
  done
}

@test "every sample differs from what it is scaled to" {
  for file in "$SAMPLES"/*.exr; do
    specconvert --scale 1.01 "$file" -o scaled.exr
    run specdiff --metric rmse "$file" scaled.exr
    [ "$status" -eq 1 ] || complain "$file: $output"
  done
}

@test "spec2rgb makes a picture of every sample, the same from a file and a pipe" {
  for file in "$SAMPLES"/*.exr; do
    spec2rgb -q "$file" -o file.png
    spec2rgb -q - < <(cat "$file") >pipe.png
    cmp file.png pipe.png
    [ "$(od -An -v -tx1 -N8 file.png | tr -d ' ')" = 89504e470d0a1a0a ]
  done
}

@test "every number of threads makes the same of every sample" {
  for file in "$SAMPLES"/*.exr; do
    specconvert --no-history -j 1 "$file" -o one.exr
    specconvert --no-history -j 3 "$file" -o three.exr
    cmp one.exr three.exr
    spec2rgb -q -j 1 "$file" -o one.ppm
    spec2rgb -q -j 3 "$file" -o three.ppm
    cmp one.ppm three.ppm
  done
}

@test "every sample comes out in the layout's names, six decimals each" {
  for file in "$SAMPLES"/*.exr; do
    specconvert "$file" -o copy.exr
    run ! grep -vE '^    (([ST][0-3]?)(\.[0-9]+,[0-9]{6}nm){1,2}|[ABGR]), ' <(exrheader copy.exr | grep sampling)
  done
}

@test "Macbeth.exr: the 24 patches are those of its own preview" {
  # spectral-exr summed them over the same tables (CIE 1931, D65) with sRGB's matrix of four
  # decimals; the most that was measured is 2.9e-4, in red. Cyan has a red of less than
  # nothing, which the preview has clipped: its blue and green are compared.
  for y in 50 150 250 350; do
    for x in 50 150 250 350 450 550; do
      preview "$SAMPLES/Macbeth.exr" $x $y
      if [ "${theirs##* }" = 0 ]; then
        awk -v red="${ours##* }" 'BEGIN { exit !(red < 0 && red > -0.03) }'
        theirs=${theirs% *} ours=${ours% *}
      fi
      within 4e-4 "$ours" "$theirs" || complain "the patch at $x,$y"
    done
  done
}

@test "D65.exr is white" {
  # Its 5 nm steps end at 825 nm; a white of (0.3127, 0.3290) is D65's to four decimals, and
  # red, green and blue differ by 6e-4. Its preview is in candela over 683: it lacks the
  # integral of the observer's y, 106.856895, that a luminance of 1 is relative to.
  preview "$SAMPLES/D65.exr" 0 0
  read -r blue green red <<<"$ours"
  within 7e-4 "$blue $red" "$green $green"
  read -r blue green red <<<"$theirs"
  within 4e-4 "$ours" "$(awk -v b="$blue" -v g="$green" -v r="$red" \
    'BEGIN { y = 106.856895; printf "%.9g %.9g %.9g", b / y, g / y, r / y }')"
}

@test "D65.exr is the D65 of spectra/ at 5 nm, digit for digit" {
  specconvert --format spd "$SAMPLES/D65.exr" | grep -v '^#' >file
  specconvert --grid 380:825:5 D65 | grep -v '^#' >table
  diff file table
}

@test "BiSpectral.exr becomes light when it is illuminated" {
  specconvert --illuminate E --extrapolate constant "$SAMPLES/BiSpectral.exr" -o light.exr
  run ! grep -q ' T\.' <(exrheader light.exr)
  spec2rgb -q light.exr -o light.png
  fails_cleanly specconvert --grid 400:600:10 "$SAMPLES/BiSpectral.exr" -o grid.exr
}

@test "Polarised.exr has four Stokes components, and its alpha stays" {
  specconvert --scale 2 "$SAMPLES/Polarised.exr" -o scaled.exr
  for component in S0 S1 S2 S3; do
    [ "$(exrheader scaled.exr | grep -c "^    $component\\.")" -eq 8 ]
  done
  exrheader scaled.exr | grep -q '^    A, '
  specconvert --scale 0.5 scaled.exr -o back.exr
  run specdiff --metric max "$SAMPLES/Polarised.exr" back.exr
  [ "$output" = "channel 'B' is only in the first
channel 'G' is only in the first
channel 'R' is only in the first
max        0" ] || complain "$output"
}

@test "D65_colour.exr stays HALF" {
  specconvert "$SAMPLES/D65_colour.exr" -o copy.exr
  [ "$(exrheader copy.exr | grep -c '^    S0.*16-bit')" -eq 97 ]
}
