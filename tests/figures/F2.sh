# shellcheck shell=bash disable=SC2016
title "Newton's rings on a soap bubble"
from 'T 6.6 and 6.13 (Vangorp & Yskout 2005, after Jaszkowski & Rzeszut)'
note 'A film that drains from 200 nm at the top to 1500 nm at the bottom, and others on the same layers: the bubble is rendered once.'

# Sanitizers make all of this ten times slower.
around=384x192 few=9
[[ $build != */san-* ]] || around=192x96 few=4
cp "$here/room.pbrt" "$here/bubble.pbrt" "$here/rings.pbrt" .

run "specrender room.pbrt --grid 400:700:10 --size $around -o room.exr
specrender bubble.pbrt --grid 400:700:10 --size 480x270 --crop 96,0,384,270 --spp $few --defer film -o layers.exr"
picture bubble.png \
  'specfilm --stack "air | 1.33 * | air" --thickness "gravity 200nm..1500nm" layers.exr | spec2rgb -e 1.5 -o bubble.png' \
  '200 nm to 1500 nm'
picture drained.png \
  'specfilm --stack "air | 1.33 * | air" --thickness "gravity 10nm..800nm" layers.exr | spec2rgb -e 1.5 -o drained.png' \
  'later, 10 nm to 800 nm: the top has become black'
picture rings.png \
  "specrender rings.pbrt --grid 400:700:10 --size 480x270 --crop 150,45,330,225 --spp $few --defer film |
  specfilm --stack 'air | 1.33 * | air' --thickness 'gravity 200nm..1500nm' | spec2rgb -o rings.png" \
  'the front of 200 nm to 1500 nm alone: around a black ball, in even light'

# Pixels of that ball in a picture of 4800 x 2700, rendered straight, have the film's reflectance
# up to a factor. It is 0 where 2 n d cos (inside) is a whole number of waves, so from one such
# wavelength number 1/nm has a step of 1 / (2 n d cos) to the next.
for line in 750 1350 1900; do
  run "specrender rings.pbrt --grid 300:1200:2 --size 4800x2700 --crop 2400,$line,2401,$((line + 1)) --spp 256 | specconvert -f spd >$line.spd"
  # "height cosine" of the point: 0 at the bottom; the ball is 4 cm around 0.
  awk -v line=$line '
    BEGIN {
      degree = atan2(0, -1) / 180
      tilt = (1 - 2 * (line + 0.5) / 2700) * sin(14 * degree) / cos(14 * degree)
      far = sqrt(0.26 ^ 2 + 0.02 ^ 2)
      y = (0.26 + tilt * 0.02) / far; z = (-0.02 + tilt * 0.26) / far
      size = sqrt(y * y + z * z); y /= size; z /= size
      half = 0.26 * y - 0.02 * z
      t = half - sqrt(half * half - far * far + 0.04 ^ 2)
      py = -0.26 + t * y; pz = 0.02 + t * z
      print (pz / 0.04 + 1) / 2, -(py * y + pz * z) / 0.04
    }' >place
  read -r height cosine <place
  check "$(awk "BEGIN { printf \"%.2f\", $height }") of the height: thickness [nm], from its dark wavelengths" \
    "$(awk -v cosine="$cosine" '
      /^[0-9]/ { nm[++n] = $1; r[n] = $2 }
      END {
        for (i = 2; i < n; i++)
          if (r[i] < r[i - 1] && r[i] <= r[i + 1]) { # the vertex of a parabola
            last = nm[i] + (r[i - 1] - r[i + 1]) / (r[i - 1] - 2 * r[i] + r[i + 1])
            if (!found++) first = last
          }
        steps = 1 / first - 1 / last
        if (steps > 0) print (found - 1) / steps / (2 * sqrt(1.33 ^ 2 - 1 + cosine * cosine))
      }' $line.spd)" \
    within "$(awk "BEGIN { print 200 * (1500 / 200) ^ (1 - $height) }")" 0.5
done

# One sample for each pixel within the ball, and the same seed: rendered straight, by chance it is
# black or all bands are those put on afterwards times 1 over the chance.
run 'specrender rings.pbrt --grid 400:700:10 --size 128x72 --crop 48,20,80,52 --spp 1 -o straight.exr
specrender rings.pbrt --grid 400:700:10 --size 128x72 --crop 48,20,80,52 --spp 1 --defer film |
  specfilm --stack "air | 1.33 * | air" --thickness "gravity 200nm..1500nm" -o folded.exr'
specconvert -f spd folded.exr | grep '^[0-9]' >folded.txt
specconvert -f spd straight.exr | grep '^[0-9]' | paste -d ' ' folded.txt - | awk '
  {
    n = NF / 2 - 1
    for (i = 1; i <= n; i++) {
      if (!($(i + 2 + n) > 0) || $(i + 1) < 1e-3) continue
      share = $(i + 2 + n) / $(i + 1)
      if (!(i in least) || share < least[i]) least[i] = share
      if (share > most[i]) most[i] = share
    }
  }
  END { for (i in least) print most[i] / least[i] - 1 }' >spread
check 'samples that are not black' "$(wc -l <spread)" at-least 30
check 'their spectra, straight over afterwards: largest difference between two bands' "$(largest <spread)" at-most 1e-4
