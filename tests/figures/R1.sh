# shellcheck shell=bash
title 'A glass ball on a checkerboard'
from 'T 8.3 (a) (Vangorp & Yskout 2005)'
note 'Without dispersion: the index is 1.5 at all wavelengths. The ball shows the board upside down and the other way round.'

# Sanitizers make all of this ten times slower.
few=64 many=256
[[ $build != */san-* ]] || few=8 many=64
cp "$here/glass.pbrt" .

picture glass.png "specrender glass.pbrt --grid 400:700:10 --spp $few -o glass.exr
spec2rgb -e 0.5 glass.exr -o glass.png" \
  'a ball of 14 cm and squares of 6 cm, under a round lamp; the bright spot is the lamp through the ball'

# Where the eye's ray through a point of the picture ends, by Snell's law, written beside the
# suite: trace(x, y), in pixels, is 1 on a white square, 0 on a black one and -1 elsewhere.
# inside: whether it goes through the ball.
# shellcheck disable=SC2016
tracer='
function dot(a, b) {
  return a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
}
function unit(a, size, i) {
  size = sqrt(dot(a, a))
  for (i = 1; i <= 3; i++) a[i] /= size
}
# Left-handed: up by forward is to the right.
function across(a, b, c) {
  c[1] = a[2] * b[3] - a[3] * b[2]; c[2] = a[3] * b[1] - a[1] * b[3]; c[3] = a[1] * b[2] - a[2] * b[1]
}
# n looks to where d comes from; ratio: index there over index beyond.
function refract(d, n, ratio, cosine, along, i) {
  cosine = -dot(d, n)
  along = ratio * cosine - sqrt(1 - ratio * ratio * (1 - cosine * cosine))
  for (i = 1; i <= 3; i++) d[i] = ratio * d[i] + along * n[i]
}
function trace(x, y, p, d, n, from, half, rest, t, i, column, line) {
  for (i = 1; i <= 3; i++) {
    p[i] = eye[i]
    d[i] = forward[i] + slope / 270 * ((2 * x - 360) * right[i] + (270 - 2 * y) * up[i])
  }
  unit(d)
  for (i = 1; i <= 3; i++) from[i] = p[i] - middle[i]
  half = -dot(from, d)
  rest = half * half - dot(from, from) + 0.07 ^ 2
  inside = rest > 0
  if (inside) {
    t = half - sqrt(rest)
    for (i = 1; i <= 3; i++) { p[i] += t * d[i]; n[i] = (p[i] - middle[i]) / 0.07 }
    refract(d, n, 1 / 1.5)
    t = -2 * 0.07 * dot(n, d)
    for (i = 1; i <= 3; i++) { p[i] += t * d[i]; n[i] = (middle[i] - p[i]) / 0.07 }
    refract(d, n, 1.5)
  }
  if (d[3] >= 0) return -1
  t = -p[3] / d[3]
  column = (p[1] + t * d[1]) / 0.06 + 4
  line = (p[2] + t * d[2]) / 0.06 + 4
  if (column < 0 || column >= 8 || line < 0 || line >= 8) return -1
  return (int(column) + int(line)) % 2
}
BEGIN {
  degree = atan2(0, -1) / 180
  slope = sin(15 * degree) / cos(15 * degree)
  split("0 -.5 .32", eye)
  split("0 .5 -.275", forward)
  split("0 0 .07", middle)
  split("0 0 1", z)
  unit(forward)
  across(z, forward, right)
  unit(right)
  across(forward, right, up)
}'

# All pixels that show one square alone through the ball: black ones are darker than .1 at 550 nm,
# but for the two places that mirror the lamp.
for strip in {0..15}; do
  specconvert --crop "116,$((50 + 8 * strip)),244,$((58 + 8 * strip))" glass.exr | specconvert --band 550 |
    specconvert -f spd | grep '^[0-9]' | cut -d ' ' -f 2- | tr ' ' '\n'
done | awk "$tracer"'
  {
    x = 116 + (NR - 1) % 128; y = 50 + int((NR - 1) / 128)
    white = trace(x, y)
    if (white < 0 || !inside) next
    for (i = 1; i < 4; i++) if (trace(x + i % 2, y + int(i / 2)) != white || !inside) next
    pixels++
    agree += white == ($1 > 0.1)
  }
  END { print pixels, 100 * agree / pixels }' >seen
read -r pixels agree <seen
check 'pixels that show one square through the ball' "$pixels" at-least 6000
check 'of these, as black or white as the square where their ray ends [%]' "$agree" at-least 96

# A line through the ball, of a picture four times as large: where black and white meet.
run "specrender glass.pbrt --grid 540:560:10 --size 1440x1080 --crop 480,418,960,419 --spp $many | specconvert --band 550 | specconvert -f spd >line.spd"
grep '^[0-9]' line.spd | cut -d ' ' -f 2- | tr ' ' '\n' | awk '
  { if (NR > 1 && ($1 > 0.19) != (last > 0.19)) print (480 + NR - 1.5 + (0.19 - last) / ($1 - last)) / 4; last = $1 }' >measured
awk "$tracer"'
  BEGIN {
    for (x = 120; x < 240; x += 0.01) {
      white = trace(x, 418.5 / 4)
      if (x > 120 && white != last) print x - 0.005
      last = white
    }
  }' >wanted
check 'edges along a line through the ball' "$(wc -l <measured)" equals "$(wc -l <wanted)"
check 'their places: largest difference [pixels]' "$(paste measured wanted | awk '{ print $1 - $2 }' | largest)" at-most 0.1
