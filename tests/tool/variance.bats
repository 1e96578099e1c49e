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
    [[ $stderr = *'--variance and --defer do not go together'* ]] || complain "$stderr"
  done
  fails_cleanly specrender --variance=1 a.pbrt -o b.exr
  no_leftovers . a.pbrt a.exr
}
