# shellcheck shell=bash disable=SC2016
title 'A soap bubble in a room'
from 'T 6.5 and 6.13 (Vangorp & Yskout 2005, after Jaszkowski & Rzeszut)'
note 'The room is a spectral image, rendered too. A film drains from 530 nm at the top to 730 nm at the bottom; its colours can be put on while the bubble is rendered, or afterwards.'

# Sanitizers make all of this ten times slower.
around=512x256 few=9 many=32
[[ $build != */san-* ]] || around=256x128 few=4 many=16
cp "$here/room.pbrt" "$here/bubble.pbrt" .

picture room.png "specrender room.pbrt --grid 400:700:10 --size $around -o room.exr
spec2rgb -e 1.5 room.exr -o room.png" 'the room, seen all around'
run "specrender bubble.pbrt --grid 400:700:10 --size 480x270 --crop 96,0,384,270 --spp $few --defer film -o layers.exr"
picture bubble.png \
  'specfilm --stack "air | 1.33 * | air" --thickness "gravity 530nm..730nm" layers.exr -o bubble.exr
spec2rgb -e 1.5 bubble.exr -o bubble.png' 'the films put on afterwards: specrender --defer film | specfilm'
picture straight.png \
  "specrender bubble.pbrt --grid 400:700:10 --size 480x270 --crop 96,0,384,270 --spp $many --seed 1 -o straight.exr
spec2rgb -e 1.5 straight.exr -o straight.png" 'rendered straight: every path chooses at a film, which is noisier'

# strips FILE: the 128 x 128 pixels in the middle as means of 2 x 2, three bands: "strip nm values"
# for each 16 lines.
strips() {
  local strip
  for strip in {0..7}; do
    specconvert --crop "80,$((70 + 16 * strip)),208,$((86 + 16 * strip))" "$1" | specconvert --downsample 2 |
      specconvert --band 450 --band 550 --band 650 | specconvert -f spd | sed -n "s/^[0-9]/$strip &/p"
  done
}

# Blocks of 16 x 16 pixels that lie within 85 % of the bubble's radius, of 84 pixels; the standard
# error of a block's mean is that of its 64 values.
strips bubble.exr >folded.txt
strips straight.exr | paste -d ' ' folded.txt - | awk '
  {
    n = (NF - 4) / 2
    for (i = 0; i < n; i++) {
      column = int(i % 64 / 8)
      if (sqrt((column - 3.5) ^ 2 + ($1 - 3.5) ^ 2) * 16 + 11.4 > 0.85 * 84) continue
      block = column " " $1 SUBSEP $2
      off = $(i + 5 + n) - $(i + 3)
      sum[block] += off; squares[block] += off * off; count[block]++
      folded += $(i + 3); straight += $(i + 5 + n)
    }
  }
  END {
    for (block in sum) {
      mean = sum[block] / count[block]
      sigma = sqrt((squares[block] / count[block] - mean * mean) / (count[block] - 1))
      off = mean / sigma
      if (off * off > most * most) most = off
      all += off * off; blocks++
      split(block, part, SUBSEP)
      error[part[1]] += sigma * count[block] # the bands have their paths in common
    }
    for (place in error) variance += error[place] ^ 2
    print blocks, most, sqrt(all / blocks), straight / folded, 4 * sqrt(variance) / folded
  }' >off.txt
read -r blocks most all ratio error <off.txt
check 'blocks of 16 × 16 pixels, times 3 bands' "$blocks" equals 132
check 'straight - afterwards, largest of a block [its standard error]' "$(largest <<<"$most")" at-most 4.5
check 'root mean square of these: 1 where there is noise alone' "$all" within 1 0.25
check 'straight over afterwards, all blocks together, within 4 standard errors' "$ratio" within 1 "$error"
check 'these errors' "$error" at-most 0.04

# The front film of one pixel in a picture of 4800 x 2700: what it changes is R (mirror - through),
# and R is 0 where 2 n d cos (inside) is three waves.
run "specrender bubble.pbrt --grid 400:700:1 --size 4800x2700 --crop 2400,1800,2401,1801 --spp 64 --defer film --films 1 -o pixel.exr
specfilm --stack 'air | 1.33 * | air' --thickness 'gravity 530nm..730nm' pixel.exr -o film.exr
specfilm --stack 'air | air' pixel.exr -o nothing.exr"
layers --print 0,0 pixel.exr | awk '/^film1.mirror/ { mirror[++n] = $2 } /^through/ { print mirror[++i] - $2 }' >contrast
pixel nothing.exr 0,0 | paste -d ' ' - contrast >nothing
# "height cosine" of the point: 0 at the bottom; the bubble is 4 cm around 0.
awk '
  BEGIN {
    degree = atan2(0, -1) / 180
    tilt = (1 - 2 * 1800.5 / 2700) * sin(14 * degree) / cos(14 * degree)
    far = sqrt(0.26 ^ 2 + 0.02 ^ 2)
    y = (0.26 + tilt * 0.02) / far; z = (-0.02 + tilt * 0.26) / far
    length_ = sqrt(y * y + z * z); y /= length_; z /= length_
    half = 0.26 * y - 0.02 * z
    t = half - sqrt(half * half - far * far + 0.04 ^ 2)
    py = -0.26 + t * y; pz = 0.02 + t * z
    print (pz / 0.04 + 1) / 2, -(py * y + pz * z) / 0.04
  }' >place
read -r height cosine <place
check 'a pixel below the middle: thickness [nm], from its darkest wavelength' \
  "$(pixel film.exr 0,0 | paste -d ' ' - nothing | awk -v cosine="$cosine" '
    $1 >= 450 && $1 <= 620 { r = ($2 - $4) / $5; if (least == "" || r < least) { least = r; nm = $1 } }
    END { print 3 * nm / (2 * sqrt(1.33 ^ 2 - 1 + cosine * cosine)) }')" \
  within "$(awk -v height="$height" 'BEGIN { print 530 * (730 / 530) ^ (1 - height) }')" 0.7
