# shellcheck shell=bash
title 'The Cornell box'
from 'T 5.11 (Vangorp & Yskout 2005); geometry and spectra as measured at Cornell, 1998; pbrt-v4'
note 'Path tracing with up to four reflections on the way from the lamp to the eye: a soft shadow, and the colours of the walls on what is white.'

# Sanitizers make all of this ten times slower.
side=256 few=32
[[ $build != */san-* ]] || side=128 few=64
cp "$here/cornell.pbrt" .

picture box.png "specrender cornell.pbrt --grid 405:695:10 --size ${side}x$side --spp $few -o box.exr
spec2rgb -e 1 box.exr -o box.png" 'all light'
picture direct.png "sed 's/maxdepth\" 5/maxdepth\" 1/' cornell.pbrt >direct.pbrt
specrender direct.pbrt --grid 405:695:10 --size ${side}x$side --spp 16 -o direct.exr
spec2rgb -e 1 direct.exr -o direct.png" 'what comes straight from the lamp, with one reflection'

# Light that comes straight from the lamp to points of the floor, from full shadow to none: the sum
# over 40 x 40 pieces of the lamp that the blocks do not hide, times the spectra, lamp and white.
run 'specrender direct.pbrt --grid 640:648:4 --crop 96,246,232,247 --spp 1024 | specconvert --band 644 | specconvert -f spd >line.spd'
grep '^[0-9]' line.spd | cut -d ' ' -f 2- | tr ' ' '\n' |
  awk -v white="$(for nm in 640 644 648; do value "$spectra/reflectance/cornell-white.spd" $nm R; done | xargs)" '
    # Whether a block stands between p on the floor and q on the lamp: its sides k and its top.
    function hides(b, px, pz, qx, qz, k, k1, ex, ez, from, to, start, end, t) {
      end = 548.3
      if (end > height[b]) end = height[b]
      start = 0; end /= 548.3
      for (k = 0; k < 4; k++) {
        k1 = (k + 1) % 4
        ex = bx[b, k1] - bx[b, k]; ez = bz[b, k1] - bz[b, k]
        from = ex * (pz - bz[b, k]) - ez * (px - bx[b, k])
        to = ex * (qz - bz[b, k]) - ez * (qx - bx[b, k])
        if (from > 0 && to > 0) return 0
        t = from != to ? from / (from - to) : 0
        if (from > 0 && t > start) start = t
        if (to > 0 && t < end) end = t
      }
      return start < end
    }
    BEGIN {
      split("130 65 82 225 240 272 290 114", low); split("423 247 265 296 314 456 472 406", high)
      for (k = 0; k < 4; k++) {
        bx[1, k] = low[2 * k + 1]; bz[1, k] = low[2 * k + 2]
        bx[2, k] = high[2 * k + 1]; bz[2, k] = high[2 * k + 2]
      }
      height[1] = 165; height[2] = 330
      pi = atan2(0, -1)
      slope = sin(39.3077 / 360 * pi) / cos(39.3077 / 360 * pi)
      lamp = 15.6 + 0.44 * (18.4 - 15.6)
      split(white, at); white = (at[1] + 6 * at[2] + at[3]) / 8 # the mean from 642 to 646 nm
    }
    NR % 4 == 1 {
      far = 273 / (slope * (246.5 - 128) / 128)
      x = 278 - slope * (96 + NR - 0.5 - 128) / 128 * far
      z = far - 800
      sum = open = 0
      for (i = 0; i < 40; i++) for (j = 0; j < 40; j++) {
        qx = 213 + 130 * (i + 0.5) / 40; qz = 227 + 105 * (j + 0.5) / 40
        square = (qx - x) ^ 2 + 548.3 ^ 2 + (qz - z) ^ 2
        part = (548.3 / square) ^ 2 * 130 * 105 / 1600
        open += part
        if (!hides(1, x, z, qx, qz) && !hides(2, x, z, qx, qz)) sum += part
      }
      print x, sum / open, $1 / (lamp * white / pi * open)
    }' >shadow
check 'points of the floor along the shadow' "$(wc -l <shadow)" equals 34
check 'of these, neither in full light nor in full shadow' "$(awk '$2 > 0.02 && $2 < 0.98' shadow | wc -l)" at-least 8
check 'share of the lamp that they see, rendered - computed: largest' "$(awk '{ print $3 - $2 }' shadow | largest)" at-most 0.02

# reddish FILE SIDE: the light of 645 nm over that of 545 nm, on the left of the back wall over its
# right; the picture is square.
reddish() {
  local part=$(($2 / 16)) column
  for column in 15 45; do
    specconvert --crop "$((column * $2 / 64)),$((17 * $2 / 64)),$((column * $2 / 64 + part)),$((17 * $2 / 64 + part))" "$1" |
      specconvert --band 545 --band 645 | specconvert -f spd |
      awk '/^[0-9]/ { for (i = 2; i <= NF; i++) sum[$1] += $i } END { print sum[645] / sum[545] }'
  done | xargs | awk '{ print $1 / $2 }'
}
check 'back wall, redness of the left over the right: by the walls beside it' "$(reddish box.exr $side)" at-least 1.4
check 'the same straight from the lamp' "$(reddish direct.exr $side)" within 1 0.001

sample=$here/../../../shared/samples/pbrt-v4_cbox.exr
if [ -f "$sample" ]; then
  note "Beside the checkout there is the same box as pbrt-v4 rendered it, with 16 samples per pixel. Its bands are the same; its light is scaled, and as some bands of its pixels got no sample, it is noisy."
  cp "$sample" pbrt.exr
  picture pbrt.png 'spec2rgb -e 4.8 pbrt.exr -o pbrt.png' 'the same by pbrt-v4'
  # Blocks of 16 x 16 of its pixels; those around the lamp's edge are left out, where a pixel has
  # more light than all others of its block. So is the band from 400 to 410 nm: lamp and walls begin
  # there so steeply that the product of their means, which the bands have, is not the product's mean.
  for file in box pbrt; do
    size=16
    [ $file = pbrt ] || size=$((side / 16))
    specconvert --downsample $size $file.exr | specconvert -f spd | grep '^[4-6][1-9]5 \|^[56]05 ' >$file.txt
  done
  paste -d ' ' box.txt pbrt.txt | awk '
    {
      for (i = 0; i < 256; i++) {
        if (int(i / 16) >= 1 && int(i / 16) <= 2 && i % 16 >= 6 && i % 16 <= 9) continue
        here[i] += $(i + 2); there[i] += $(i + 259)
        band_here[NR] += $(i + 2); band_there[NR] += $(i + 259)
        all_here += $(i + 2); all_there += $(i + 259)
      }
    }
    END {
      scale = all_here / all_there
      for (i in here) {
        off = here[i] / there[i] / scale - 1
        if (off * off > most * most) most = off
        squares += off * off; n++
      }
      for (i in band_here) {
        off = band_here[i] / band_there[i] / scale - 1
        if (off * off > most_band * most_band) most_band = off
      }
      print n, sqrt(squares / n), most, most_band, scale
    }' >pbrt
  read -r blocks all most most_band _ <pbrt
  check 'blocks beside pbrt-v4' "$blocks" equals 248
  check 'light over that of pbrt-v4, scaled: root mean square from 1' "$all" at-most 0.035
  check 'the same: largest from 1' "$(largest <<<"$most")" at-most 0.25
  check 'each of 29 bands over that of pbrt-v4: largest from 1' "$(largest <<<"$most_band")" at-most 0.05
  check 'back wall, redness by pbrt-v4: over ours' \
    "$(awk "BEGIN { print $(reddish pbrt.exr 256) / $(reddish box.exr $side) }")" within 1 0.06
else
  note 'The picture of pbrt-v4, ../shared/samples/pbrt-v4_cbox.exr, is not beside the checkout: it was not compared.'
fi
