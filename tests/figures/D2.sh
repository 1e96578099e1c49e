# shellcheck shell=bash
title 'Where the orders of a compact disc go'
from 'T 7.2, 7.3, 7.5 and 7.6 (Vangorp & Yskout 2005)'

picture orders.png \
  'specdisc --preset cd --model orders --chart "eye -80deg..80deg, lamp -60deg..60deg" --size 640x240 | spec2rgb -e -4 -o orders.png' \
  'main strip, by scalar diffraction: eye -80° to 80° to the right, lamp -60° to 60° downwards; the white line is the mirrored lamp'
picture strips.png \
  'specdisc --preset cd --chart "eye -45deg..45deg, azimuth 0deg..90deg" --size 640x240 | spec2rgb -e 6 -o strips.png' \
  "main and side strips, by T's model: eye -45° to 45° to the right, from across the tracks down to along them"

run 'specdisc --preset cd --orders --angle 0deg --grid 532:532:1'
check 'angles of orders 1, 2, 3 at normal incidence and 532 nm' \
  "$(awk '!/^#/ && $1 > 0 { printf "%d %.2f\n", $1, $3 }' <<<"$printed" | sort -n | cut -d ' ' -f 2 | xargs)" \
  equals '19.42 41.68 85.95'
check 'orders at normal incidence and 532 nm' \
  "$(awk '!/^#/ { print $1 }' <<<"$printed" | sort -n | xargs)" equals '-3 -2 -1 0 1 2 3'

run 'specdisc --preset cd --orders --angle 0deg --grid 380:780:1 >normal.txt'
check 'longest wavelength with an order 3 [nm]' \
  "$(awk '!/^#/ && $1 == 3 && $2 > most { most = $2 } END { print most }' normal.txt)" equals 533

# The grating equation itself; the lamp is on the side of azimuth 0, the mirrored one on that of 180.
run 'specdisc --preset cd --orders --angle 30deg --grid 385:775:10 >oblique.txt'
awk '
  BEGIN { degree = atan2(0, -1) / 180 }
  !/^#/ {
    s = $1 * $2 / 1600 - sin(30 * degree)
    print ($4 == 0 ? $3 : $4 == 180 ? -$3 : "nowhere") - atan2(s, sqrt(1 - s * s)) / degree
  }' oblique.txt >off
check 'lamp at 30°, 40 wavelengths: orders' "$(wc -l <off)" equals \
  "$(awk 'BEGIN { for (nm = 385; nm <= 775; nm += 10) for (m = -9; m <= 9; m++) {
    s = m * nm / 1600 - 0.5; if (s >= -1 && s <= 1) n++ } print n }')"
check 'lamp at 30°, sin(eye) + sin(lamp) = m λ / 1600 nm: largest error of an angle [°]' \
  "$(largest <off)" at-most 1e-7

# The side strips are brightest where 2400 nm sin(eye) = n wavelength.
run "specdisc --preset cd --chart 'eye 10deg..16deg' --azimuth 90deg --size 3x1 -o side.exr"
for x in 0 1 2; do
  angle=$((10 + 3 * x))
  check "side strip 1 at $angle°: brightest wavelength [nm]" \
    "$(pixel side.exr "$x,0" | sort -k 2,2g | tail -n 1 | cut -d ' ' -f 1)" within \
    "$(awk "BEGIN { print 2400 * sin($angle * atan2(0, -1) / 180) }")" 2.5
done
