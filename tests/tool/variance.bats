#!/usr/bin/env bats
# Variances from specrender, and what becomes of them in the tools behind it.
# shellcheck disable=SC2154 # fails_cleanly leaves its line in stderr

load common

render() {
  specrender --no-history --grid 400:700:100 "$@"
}

# A lamp of 1 to 4 W m^-2 sr^-1 nm^-1, whose edge goes through half of the pixels.
lamp() {
  cat >"$1" <<END
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 6 "integer yresolution" 4
WorldBegin
AreaLightSource "diffuse" "spectrum L" [ 400 1 700 4 ] "float scale" ${2:-1}
Translate .1 .07 3
Rotate 180 1 0 0
Shape "disk" "float radius" .8
END
}

# A ball and its shadow, lit by a lamp aside, brighter by a factor.
ball() {
  cat >"$1" <<END
LookAt 0 0 -3  0 0 0  0 1 0
Camera "perspective" "float fov" 45
Film "rgb" "integer xresolution" 16 "integer yresolution" 16
WorldBegin
AttributeBegin
  AreaLightSource "diffuse" "spectrum L" "D65" "float scale" $2
  Translate 0 2 -4
  Shape "disk" "float radius" 2.5
AttributeEnd
Material "diffuse" "spectrum reflectance" "15-red"
Shape "sphere"
Translate 0 -1 0
Rotate 90 1 0 0
Shape "disk" "float radius" 5
END
}

@test "a variance beside every band, FLOAT with --half too, and the bands as without it" {
  lamp a.pbrt
  render a.pbrt -o plain.exr
  render --variance a.pbrt -o a.exr
  has_channels a.exr S0.{4,5,6,7}00,000000nm variance.S0.{4,5,6,7}00,000000nm
  for x in 0 1 2 3 4 5; do
    pixel_holds plain.exr a.exr $x,1 'for (name in from) if (from[name] != to[name]) wrong(name)'
  done
  render -j 3 --variance a.pbrt -o b.exr
  cmp a.exr b.exr
  render --half --variance a.pbrt -o half.exr
  has_channels half.exr S0.{4,5,6,7}00,000000nm variance.S0.{4,5,6,7}00,000000nm
  has_line half.exr '    S0.400,000000nm, 16-bit floating-point, sampling 1 1'
  has_line half.exr '    variance.S0.400,000000nm, 32-bit floating-point, sampling 1 1'
  render --variance --gbuffer a.pbrt -o g.exr
  for x in 0 1 2 3 4 5; do
    pixel_holds a.exr g.exr $x,1 'for (name in from) if (from[name] != to[name]) wrong(name)
      if (!("cover" in to)) wrong("no geometry")'
  done
}

# What k of n samples see has the mean p L, p = k / n, and s^2 / n is L^2 p (1 - p) / (n - 1); 8
# samples are batches of one.
@test "of what is seen or not it is that of a proportion" {
  lamp a.pbrt
  specrender --no-history --grid 450:650:100 --variance --spp 8 a.pbrt -o a.exr
  for y in 0 1 2 3; do
    for x in 0 1 2 3 4 5; do
      pixel_holds a.exr a.exr $x,$y '
        for (L = 1.5; L < 4; L++) {
          name = "S0." (L * 100 + 300) ",000000nm"
          p = from[name] / L; wanted = L * L * p * (1 - p) / 7; has = from["variance." name]
          if (!(has >= wanted - 1e-6 && has <= wanted + 1e-6)) wrong(name ": " has " and not " wanted)
        }'
    done
  done
  numbers a.exr | awk '{ for (i = 2; i <= NF; i++) edges += $i > .01 && $i < 1.49 } END { exit edges < 8 }'
}

@test "other seeds are the same within 3 sigma, a scene brighter by 3 % is not" {
  ball a.pbrt .1
  ball brighter.pbrt .103
  for seed in 1 2 3 4; do
    render --variance --spp 64 --seed $seed a.pbrt -o $seed.exr
  done
  render --variance --spp 64 --seed 5 brighter.pbrt -o brighter.exr
  for seed in 2 3 4; do
    specdiff -q --same-within 3sigma 1.exr $seed.exr || complain "seeds 1 and $seed differ"
    run specdiff --same-within 3sigma $seed.exr brighter.exr
    [ "$status" = 1 ] || complain "seed $seed is as bright: $output"
    [[ $output = *'noise from the channels variance'* ]] || complain "$output"
  done
}

@test "one sample has no variance, and light layers neither" {
  lamp a.pbrt
  fails_cleanly specrender --variance --spp 1 a.pbrt -o b.exr
  [[ $stderr = *'a variance needs 2 samples per pixel or more (--spp N)' ]] || complain "$stderr"
  render --variance --spp 2 a.pbrt -o a.exr
  for defer in film disc film,disc; do
    fails_cleanly specrender --variance --defer $defer a.pbrt -o b.exr
    [[ $stderr = *'--variance and --defer exclude each other'* ]] || complain "$stderr"
  done
  fails_cleanly specrender --variance=1 a.pbrt -o b.exr
  no_leftovers . a.pbrt a.exr
}

# scaled A B X,Y FACTOR: every variance in that pixel of B is that of A times the factor, of which
# some are not 0.
scaled() {
  pixel_holds "$1" "$2" "$3" '
    for (name in to) if (name ~ /^variance/) {
      if (!near(to[name], from[name] * '"$4"', 1e-5)) wrong(name ": " to[name] " of " from[name])
      if (to[name] > 0) some = 1
    }
    if (!some) wrong("no variance")'
}

@test "specconvert: variances follow factors, crops and smaller pictures" {
  ball a.pbrt .1
  render --variance --spp 16 a.pbrt -o a.exr
  specconvert --scale 3 a.exr -o scaled.exr
  scaled a.exr scaled.exr 8,12 9
  specconvert --multiply D65 a.exr -o lit.exr
  pixel_holds a.exr lit.exr 8,12 '
    for (name in to) if (name ~ /^variance/) {
      band = substr(name, 10); factor = to[band] / from[band]
      if (!near(to[name], from[name] * factor * factor, 1e-4)) wrong(name ": " to[name] " of " from[name])
      count++
    }
    if (count != 4) wrong(count)'
  # Light that is added has no noise.
  specconvert --add D65 a.exr -o added.exr
  scaled a.exr added.exr 8,12 1
  specconvert --band 500 a.exr -o band.exr
  has_channels band.exr S0.500,000000nm variance.S0.500,000000nm
  scaled a.exr band.exr 8,12 1
  specconvert --downsample 2 a.exr -o small.exr
  for x in 8 9; do
    for y in 12 13; do
      "$TESTS/layers" --print $x,$y a.exr
    done
  done | awk '$1 ~ /^variance/ { sum[$1] += $2 / 16 } END { for (name in sum) print name, sum[name] }' >wanted
  "$TESTS/layers" --print 4,6 small.exr | awk '
    FNR == NR { wanted[$1] = $2; next }
    $1 ~ /^variance/ { rows++; if ($2 <= 0 || ($2 / wanted[$1] - 1) ^ 2 > 1e-8) exit 1 } END { if (rows != 4) exit 1 }' wanted - ||
    complain "$(cat wanted)" "$("$TESTS/layers" --print 4,6 small.exr)"
}

@test "specconvert: where bands are mixed or bent, variances go, with a note" {
  lamp a.pbrt
  render --variance a.pbrt -o a.exr
  for change in '--grid 450:650:100' '--raise 2' '--clamp 0..1' '--bands-only'; do
    # shellcheck disable=SC2086 # two words
    specconvert $change a.exr -o b.exr 2>said
    channels b.exr >names
    run ! grep variance names
    [ "$change" = --bands-only ] || grep -q 'without the variances' said || complain "$change: $(cat said)"
  done
}

@test "speccomp: renders that are merged are known better, and other things not at all" {
  ball a.pbrt .1
  render --variance --spp 16 --seed 1 a.pbrt -o 1.exr
  render --variance --spp 48 --seed 2 a.pbrt -o 2.exr
  speccomp --merge 1.exr 2.exr -o merged.exr
  # By their samples: 1/4 and 3/4 of the means.
  for name in variance.S0.{4,5,6,7}00,000000nm; do
    for file in 1 2 merged; do
      "$TESTS/layers" --print 8,12 $file.exr | awk -v name="$name" '$1 == name { print $2 }'
    done | xargs | awk '{ wanted = $1 / 16 + $2 * 9 / 16; exit !($3 > 0 && ($3 / wanted - 1) ^ 2 < 1e-10) }' || complain "$name"
  done
  speccomp --op subtract 2.exr 2.exr -o zero.exr
  scaled 2.exr zero.exr 8,12 2
  speccomp --op mean 2.exr 2.exr -o mean.exr
  scaled 2.exr mean.exr 8,12 .5
  specconvert --scale 1 2.exr --bands-only -o bare.exr
  for made in "--op max 1.exr 2.exr" "--op multiply 1.exr D65.exr" "--merge 1.exr bare.exr"; do
    specconvert --reflectance-of D65 bare.exr -o D65.exr
    # shellcheck disable=SC2086 # several words
    speccomp $made -o b.exr
    channels b.exr >names
    run ! grep variance names
  done
  # What is known better tells smaller differences.
  specdiff -q --same-within 3sigma 1.exr merged.exr
}

@test "a crop has the variances of the whole picture" {
  ball a.pbrt .1
  render --variance --spp 16 a.pbrt -o a.exr
  render --variance --spp 16 --crop 6,10,9,13 a.pbrt -o part.exr
  specconvert --crop 6,10,9,13 a.exr -o cut.exr
  specdiff -q --exact part.exr cut.exr
  # 64 times the samples: less than a sixteenth of the variance, and more than nothing.
  render --variance --spp 1024 a.pbrt -o fine.exr
  "$TESTS/layers" --print 8,12 a.exr >few
  "$TESTS/layers" --print 8,12 fine.exr | awk '
    FNR == NR { few[$1] = $2; next }
    /^variance/ { rows++; if ($2 <= 0 || $2 > few[$1] / 16) exit 1 } END { if (rows != 4) exit 1 }' few - ||
    complain "$(cat few)" "$("$TESTS/layers" --print 8,12 fine.exr)"
}
