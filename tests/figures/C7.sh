# shellcheck shell=bash disable=SC2016
title 'Spectra as samples, series and lines'
from 'T 3.1–3.5 and fig. 3.1 (Vangorp & Yskout 2005); Sun, Fracchia & Drew 1998'
note 'A spectrum that begins and ends steeply is no sum of a few waves: nine coefficients of its Fourier series leave light where it has none, which a filter then shows. Lines that stand beside a smooth part keep their energy and their place.'

# The box of T's figure; its edges are a millionth of a nm wide.
printf '%s\n' '# title: 500 to 600 nm' '# quantity: spectral power distribution' '# columns: wavelength_nm S' \
  '360 0' '499.999999 0' '500 1' '600 1' '600.000001 0' '830 0' >box.spd
{
  printf '%s\n' '# title: a red filter' '# quantity: transmittance' '# columns: wavelength_nm T' '360 0' '600.000001 0' '600.000002 1'
  awk 'BEGIN { for (nm = 600.25; nm <= 830; nm += 0.25) print nm, 1 }'
} >filter.spd
run 'specconvert --to fourier:9 box.spd -o series.spd
cat series.spd'

# T 3.2 and 3.3 of a box from p to q, parts of a turn: what they come to is written out. The box of the
# file is 1e-6 nm wider, of which a value has at most 9 / 470.
series='BEGIN { pi = atan2(0, -1); p = 2 * pi * (500 - 360) / 470; q = 2 * pi * (600 - 360) / 470 }
  function a(n) { return n ? (sin(n * q) - sin(n * p)) / (pi * n) : 2 * 100 / 470 }
  function b(n) { return n ? (cos(n * p) - cos(n * q)) / (pi * n) : 0 }
  function at(nm, n, u, sum) {
    u = 2 * pi * (nm - 360) / 470; sum = a(0) / 2
    for (n = 1; n <= 4; n++) sum += a(n) * cos(n * u) + b(n) * sin(n * u)
    return sum
  }
  function integral(from, to, n, u, v, sum) {
    u = 2 * pi * (from - 360) / 470; v = 2 * pi * (to - 360) / 470; sum = a(0) / 2 * (to - from)
    for (n = 1; n <= 4; n++)
      sum += 470 / (2 * pi * n) * (a(n) * (sin(n * v) - sin(n * u)) - b(n) * (cos(n * v) - cos(n * u)))
    return sum
  }'
check 'coefficients: largest error' \
  "$(awk "$series"' /^[0-9]/ { print $2 - a($1), $3 - b($1); n++ } END { if (n != 5) print "none" }' series.spd | largest)" at-most 2e-8

run 'specconvert --grid 360:830:1 series.spd -o waves.spd
specconvert --grid 360:830:1 box.spd -o steps.spd
specconvert --multiply filter.spd series.spd -o passed.spd'
plot plot.ppm 360:830 -0.2:1.2 0.2 '150 150 150,200 0 0,30 60 200' box.spd passed.spd <(awk '!/^[0-9]/ || $1 < 600' waves.spd)
display >display.spd
picture plot.png 'spec2rgb --name-map R=650nm,G=550nm,B=450nm --observer display.spd plot.ppm -o plot.png' \
  'a box from 500 to 600 nm (grey) and its Fourier series of 9 coefficients; what a filter from 600 nm on passes is red'
check 'series: largest error of 471 values' \
  "$(awk "$series"' /^[0-9]/ { print $2 - at($1) }' waves.spd | largest)" at-most 2e-8
# By trapezia of a quarter of a nm; the series is that smooth.
sum='{ if (n++ && nm) sum += ($1 - nm) * ($2 + last) / 2; nm = $1; last = $2 } END { printf "%.9f\n", sum }'
leak=$(grep '^[0-9]' passed.spd | awk "$sum")
check 'light of the series through the filter, of 100 nm' "$leak" within "$(awk "$series"' BEGIN { print integral(600, 830) }')" 1e-3
check 'the same: it is not nothing' "$leak" at-least 4
run 'specconvert --multiply filter.spd box.spd -o nothing.spd'
check 'light of the box through the filter' "$(grep '^[0-9]' nothing.spd | awk "$sum")" at-most 1e-5

picture patches.png 'specconvert --grid 360:830:1 --patches 2x2 --patch 96 --gap 8 box.spd series.spd nothing.spd passed.spd -o patches.exr
spec2rgb --exposure -0.5 patches.exr -o patches.png' \
  'above, the box and its series as lights; below, both through the filter'
check 'box through the filter: codes' "$(rgb patches.exr 50,150 -e -0.5)" equals '0 0 0'
check 'series through the filter: code of red' "$(rgb patches.exr 150,150 -e -0.5 | cut -d ' ' -f 1)" at-least 60

# A line of mercury, which no series holds.
run 'specconvert --to composite:3,9 F2 -o lamp.spd
grep ^line lamp.spd
specconvert --to fourier:9 F2 -o blurred.spd
specconvert --to tabulated lamp.spd -o table.spd
specconvert --to sampled:380:780:5 lamp.spd -o samples.spd
specconvert --to tabulated F2 -o measured.spd'
energy=$(grep '^[0-9]' measured.spd | awk "$sum")
for name in table samples; do
  check "$name: energy of the lamp with its lines, over that measured" \
    "$(grep '^[0-9]' $name.spd | awk "$sum" | awk -v wanted="$energy" '{ print $1 / wanted }')" within 1 1e-6
done
# around FILE: what a curve has within 6 nm of the blue line, 435.8 nm.
around() {
  specconvert --grid 430:442:0.25 "$1" | grep '^[0-9]' | awk "$sum"
}
near=$(around measured.spd)
check 'energy within 6 nm of 436 nm: table of the composite over that measured' \
  "$(awk -v had="$(around table.spd)" -v wanted="$near" 'BEGIN { print had / wanted }')" within 1 0.05
check 'the same of the series alone: the line is elsewhere' \
  "$(awk -v had="$(around blurred.spd)" -v wanted="$near" 'BEGIN { print had / wanted }')" at-most 0.6
plot lamp.ppm 380:780 0:40 10 '150 150 150,30 60 200,200 0 0' measured.spd <(specconvert --grid 380:780:1 blurred.spd) <(grep -v '^line' lamp.spd >smooth.spd; specconvert --grid 380:780:1 smooth.spd)
picture lamp.png 'spec2rgb --name-map R=650nm,G=550nm,B=450nm --observer display.spd lamp.ppm -o lamp.png' \
  'a fluorescent lamp, F2 (grey), its series of 9 coefficients (blue), and the series of 9 beside three lines (red)'

# A line at any place between two samples: its weight and its place stay.
printf '%s\n' '# quantity: spectral power distribution' '# representation: constant' '# columns: level' '0.5' 'line 546.1 30' >line.spd
run 'specconvert --to sampled:380:780:5 line.spd -o sampled.spd'
grep '^[0-9]' sampled.spd | awk '{ w += 5 * ($2 - 0.5); m += 5 * ($2 - 0.5) * $1 } END { printf "%.9f %.9f\n", w, m / w }' >line.txt
check 'a line of weight 30 among samples of 5 nm: weight' "$(cut -d ' ' -f 1 line.txt)" within 30 1e-9
check 'its place [nm]' "$(cut -d ' ' -f 2 line.txt)" within 546.1 1e-9

# What lies between the rows of a table.
printf '%s\n' '# quantity: reflectance' '# columns: wavelength_nm R' '400 0.2' '450 0.8' '500 0.3' '550 0.5' '600 0.9' '650 0.4' '700 0.6' >rows.spd
run 'for way in linear nearest left sprague; do
  specconvert --interp $way --grid 400:700:0.5 rows.spd -o $way.spd
done'
plot between.ppm 400:700 0:1 0.2 '150 150 150,200 0 0,30 60 200,0 130 60' linear.spd nearest.spd left.spd sprague.spd
picture between.png 'spec2rgb --name-map R=650nm,G=550nm,B=450nm --observer display.spd between.ppm -o between.png' \
  'between seven rows: linear (grey), nearest (red), left (blue), polynomials of degree 5 (green)'
check 'linear, nearest, left at 430 nm' \
  "$(for way in linear nearest left; do value $way.spd 430 R; done | xargs)" equals '0.56 0.8 0.2'
check 'degree 5 at its rows: largest difference' \
  "$(for nm in 400 450 500 550 600 650 700; do echo "$(value sprague.spd $nm R) $(value linear.spd $nm R)"; done | awk '{ print $1 - $2 }' | largest)" at-most 1e-12

# Operators, on the samples of patches, against the same on their numbers.
run "specconvert --grid 400:700:10 15-red -o a.exr
specconvert --grid 400:700:10 16-yellow -o b.exr
speccomp --expr 'clamp(sqrt(a) * exp(-b) / (a + 0.5) ^ 2 - b, -0.1, 0.2)' a.exr b.exr -o c.exr"
check 'sum, difference, product, quotient, power, root, exponential, clamp: largest error of 31 bands' \
  "$(paste -d ' ' <(pixel a.exr 0,0) <(pixel b.exr 0,0) <(pixel c.exr 0,0) | awk '
    NF == 6 { v = sqrt($2) * exp(-$4) / ($2 + 0.5) ^ 2 - $4; v = v < -0.1 ? -0.1 : v > 0.2 ? 0.2 : v; print $6 - v; n++ }
    END { if (n != 31) print "bands" }' | largest)" at-most 1e-7
