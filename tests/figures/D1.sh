# shellcheck shell=bash
title 'A compact disc and a DVD'
from 'T 7.2–7.9 and table 7.1 (Vangorp & Yskout 2005), put right'
note 'The renderer writes the light that a lamp sends to a disc of 116 mm, and its geometry; the colours are those of specdisc.'
cp "$here/cd.pbrt" .

# seen EYE LAMP: a command that prints the scene with these positions.
seen() {
  echo "sed 's/^LookAt.*/LookAt $1  0 0 0  0 0 1/; s/from\".*/from\" [ $2 ]/' cd.pbrt"
}

picture cd-1.png "$(seen '0 -.1 .32' '0 .3 .2') | specrender --defer disc | specdisc --preset cd | spec2rgb -e 6 -o cd-1.png" \
  'CD from above: the main strip across the tracks, the side strips beside it'
picture cd-2.png 'specrender --defer disc cd.pbrt -o layers.exr
specdisc --preset cd layers.exr | spec2rgb -e 6 -o cd-2.png' 'CD from the side'
picture cd-3.png "$(seen '0 -.2 .25' '0 .25 .22') | specrender --defer disc | specdisc --preset cd | spec2rgb -e 6 -o cd-3.png" \
  "CD near the lamp's mirror image"
picture dvd.png 'specdisc --preset dvd layers.exr | spec2rgb -e 7 -o dvd.png' \
  'DVD as the second CD, of the same light: tracks of 740 nm, pits 1400 nm apart'

# With one sample for each pixel and the same seed, both ways see the same points.
for disc in cd dvd; do
  run "sed 's/\"cd\"/\"$disc\"/' cd.pbrt | specrender --size 240x180 --spp 1 --gbuffer -o straight.exr
specrender --size 240x180 --spp 1 --defer disc cd.pbrt | specdisc --preset $disc -o folded.exr
specdiff --metric max,de2000-max --exposure 6 straight.exr folded.exr || [ \$? = 1 ]"
  check "$disc rendered straight: largest difference to --defer disc | specdisc [W/(m² sr nm)]" \
    "$(awk '$1 == "max" { print $2 }' <<<"$printed")" at-most 1e-4
  check "$disc rendered straight: largest difference as colours, CIEDE2000" \
    "$(awk '$1 == "de2000-max" { print $2 }' <<<"$printed")" at-most 0.01
done

# A chart's pixel is pi times T 7.9, c0 R_aniso (f^2 + g^2) + c_spec cos^alpha + c_diff, from which
# T's constants (c0 = .005, c5 = 10, beta = 2, c_diff = .001) give back f^2 and g^2. The eye is so
# far from the mirrored lamp that c_spec adds nothing.
# f^2: along the tracks, where the first side strip of 550 nm is brightest, and no spike is visible.
peak=$(awk 'BEGIN { s = 550 / 2400; printf "%.15g", atan2(s, sqrt(1 - s * s)) * 45 / atan2(1, 1) }')
run "specdisc --preset cd --azimuth 90deg --chart 'eye ${peak}deg..${peak}deg' --size 1x1 -o side.exr"
check 'side strip: f² at its first peak, 550 nm' \
  "$(pixel side.exr 0,0 | awk '$1 == 550 { u = 550 / 2400
    printf "%.7f", ($2 / atan2(0, -1) - 0.001) / (0.005 * exp(-10 * u * u)) }')" within 0.29224 5e-6
check 'side strip: brightest wavelength [nm], in bands of 5 nm' \
  "$(pixel side.exr 0,0 | sort -k 2,2g | tail -n 1 | cut -d ' ' -f 1)" equals 550

# g^2: across the tracks, where x = 0, at 20 degrees: one spike, of 1600 nm sin 20 = 547.2 nm, on
# a ground that is the same at all wavelengths. Its weight is the area above the ground.
run "specdisc --preset cd --chart 'eye 20deg..20deg' --size 1x1 -o main.exr"
pixel main.exr 0,0 | awk '
  { nm[NR] = $1; f[NR] = $2 / atan2(0, -1) }
  END {
    for (i = 2; i < NR; i++) { area += (f[i] - f[1]) * 5; moment += (f[i] - f[1]) * 5 * nm[i] }
    printf "%.4f %.6f %.4f\n", area / 0.005, f[1], moment / area
  }' >main
read -r weight ground middle <main
check 'main strip: g² at x = 0 [nm]' "$weight" within 2225.567 0.002
check 'main strip: ground, c0 c2 + c_diff [1/sr]' "$ground" within 0.00105 1e-6
check 'main strip: the spike at 20° [nm]' "$middle" within \
  "$(awk 'BEGIN { print 1600 * sin(atan2(0, -1) / 9) }')" 0.001

run "specdisc --preset dvd --chart 'eye 40deg..40deg' --size 1x1 -o dvd.exr"
check 'DVD: the spike at 40° [nm]' \
  "$(pixel dvd.exr 0,0 | awk '{ nm[NR] = $1; f[NR] = $2 }
    END { for (i in f) { area += f[i] - f[1]; moment += (f[i] - f[1]) * nm[i] } print moment / area }')" \
  within "$(awk 'BEGIN { print 740 * sin(atan2(0, -1) / 4.5) }')" 0.001
