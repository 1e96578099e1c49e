# shellcheck shell=bash disable=SC2016
title 'From spectra to the matrix of a display, and metamers on it'
from 'T 2.3 to 2.6, equations 2.13 to 2.16; SMPTE RP 177:1993; CIE 170-1:2006, 170-2:2015'
note 'The spectra of three phosphors, seen by an observer, are the columns of the matrix from RGB to XYZ; its inverse gives the mixture of the three that looks like another spectrum. The phosphors are made up, with the shapes of those of a cathode ray tube: two broad ones, and lines in the red. To whom a mixture looks the same, it also excites the cones alike; who has other functions sees a difference.'

display >display.spd
# Bands and lines: "centre width height" in nm, as Gaussian functions.
phosphor() {
  printf '%s\n' '# quantity: spectral power distribution' '# columns: wavelength_nm L'
  awk -v bands="$1" 'BEGIN {
    n = split(bands, b, " ")
    for (nm = 380; nm <= 730; nm++) {
      v = 0
      for (i = 1; i < n; i += 3) v += b[i + 2] * exp(-((nm - b[i]) / b[i + 1]) ^ 2 / 2)
      printf "%d %.9g\n", nm, v
    }
  }'
}
phosphor '588 3 .1 594 3 .15 611 4 .35 619 6 .25 627 3 1 651 8 .12 686 6 .15 706 4 .4' >red.spd
phosphor '527 36 .32' >green.spd
phosphor '450 26 .42' >blue.spd
plot phosphors.ppm 380:730 0:1.2 0.2 '200 0 0,0 120 0,30 60 200' red.spd green.spd blue.spd
picture phosphors.png 'spec2rgb --name-map R=650nm,G=550nm,B=450nm --observer display.spd phosphors.ppm -o phosphors.png' \
  'three phosphors (made up)'

# Observers as cameras: their three sums are red, green and blue, as they are.
raw() {
  echo '# columns: wavelength_nm r g b'
  grep '^[0-9]' "$spectra/cmf/$1.spd"
}
raw cie1931 >1931.spd
raw cie2015-2 >2015.spd
raw cie2006-lms-2 >cones.spd
# sums FILE [X]: red, green and blue of a pixel, by default of the first.
sums() {
  layers --print "${2:-0},0" "$1" | awk '{ of[$1] = $2 } END { printf "%.9g %.9g %.9g\n", of["R"], of["G"], of["B"] }'
}
run 'specconvert --add green.spd --add blue.spd red.spd -o white.spd
specconvert --patches 4x1 red.spd green.spd blue.spd white.spd -o screen.exr
for observer in 1931 2015 cones; do
  spec2rgb --observer $observer.spd screen.exr -o $observer.exr
done'

# matrix OBSERVER: the XYZ of red, green and blue in columns (2.14, 2.16), nine numbers by rows.
matrix() {
  { sums "$1.exr" 0; sums "$1.exr" 1; sums "$1.exr" 2; } |
    awk '{ for (i = 1; i <= 3; i++) m[i, NR] = $i } END { for (i = 1; i <= 3; i++) print m[i, 1], m[i, 2], m[i, 3] }' | xargs
}
# The same from chromaticities alone (SMPTE RP 177): the primaries are as bright as makes their sum white.
from_primaries() {
  for x in 0 1 2 3; do sums "$1.exr" $x; done | awk '
    { s = $1 + $2 + $3; x[NR] = $1 / s; y[NR] = $2 / s; z[NR] = $3 / s; Y = $2 }
    END {
      # Cramer: the amounts c of the three whose sum is x/y, 1, z/y of white.
      wx = x[4] / y[4]; wz = z[4] / y[4]
      d = det(x[1], x[2], x[3], y[1], y[2], y[3], z[1], z[2], z[3])
      c[1] = det(wx, x[2], x[3], 1, y[2], y[3], wz, z[2], z[3]) / d
      c[2] = det(x[1], wx, x[3], y[1], 1, y[3], z[1], wz, z[3]) / d
      c[3] = det(x[1], x[2], wx, y[1], y[2], 1, z[1], z[2], wz) / d
      for (i = 1; i <= 3; i++) { c[i] *= Y; X = X c[i] * x[i] " "; M = M c[i] * y[i] " "; Z = Z c[i] * z[i] " " }
      print X M Z
    }
    function det(a, b, c, d, e, f, g, h, i) { return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g) }'
}
for observer in 1931 2015; do
  check "observer of $observer: matrix of the phosphors less that of their chromaticities and white" \
    "$(echo "$(matrix $observer) $(from_primaries $observer)" | awk 'NF == 18 { for (i = 1; i <= 9; i++) print $i - $(i + 9) }' | largest)" at-most 2e-6
done
# The columns by sums over the tables themselves.
for colour in red green blue; do
  awk 'FNR == NR && /^[0-9]/ { s[$1] = $2; next } /^[0-9]/ { y += $3; if ($1 in s) { X += $2 * s[$1]; Y += $3 * s[$1]; Z += $4 * s[$1] } }
    END { printf "%.9g %.9g %.9g\n", X / y, Y / y, Z / y }' $colour.spd "$spectra/cmf/cie1931.spd"
done >columns.txt
check 'observer of 1931: matrix less the sums over the tables' \
  "$(for x in 0 1 2; do sums 1931.exr $x; done | paste -d ' ' - columns.txt | awk '{ for (i = 1; i <= 3; i++) print $i - $(i + 3) }' | largest)" at-most 2e-7

# Metamers of four patches in daylight, for the observers of 1931 and 2015.
patches=(02-light-skin 14-green 13-blue 22-neutral-5)
run "for patch in ${patches[*]}; do
  specconvert --grid 380:730:1 --multiply D65 --scale 0.008 \$patch -o \$patch.spd
  specconvert --patches 1x1 \$patch.spd -o \$patch.exr
done"
# mixture OBSERVER PATCH: r, g, b, the inverse of the matrix times the patch's XYZ (2.13).
mixture() {
  spec2rgb --observer "$1.spd" "$2.exr" -o seen.exr
  echo "$(matrix "$1") $(sums seen.exr)" | awk '
    function det(a, b, c, d, e, f, g, h, i) { return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g) }
    {
      d = det($1, $2, $3, $4, $5, $6, $7, $8, $9)
      printf "%.12g %.12g %.12g\n", det($10, $2, $3, $11, $5, $6, $12, $8, $9) / d, \
        det($1, $10, $3, $4, $11, $6, $7, $12, $9) / d, det($1, $2, $10, $4, $5, $11, $7, $8, $12) / d
    }'
}
for observer in 1931 2015; do
  for patch in "${patches[@]}"; do
    read -r r g b <<<"$(mixture $observer "$patch")"
    echo "$r $g $b" >>amounts-$observer.txt
    specconvert --scale "$g" green.spd -o g.spd
    specconvert --scale "$b" blue.spd -o b.spd
    specconvert --scale "$r" --add g.spd --add b.spd red.spd -o "$patch-$observer.spd"
    specconvert --patches 1x1 "$patch-$observer.spd" -o "$patch-$observer.exr"
  done
done
check 'amounts of the phosphors: the least' "$(xargs -n 1 <amounts-1931.txt | sort -g | head -n 1)" at-least 0

# difference FILE FILE OBSERVER: CIEDE2000 of two images of light; specdiff tells by its status that there is one.
difference() {
  { specdiff --metric de2000-max --observer "$3" "$1" "$2" || [ $? = 1 ]; } | awk '$1 == "de2000-max" { print $2 }'
}
for patch in "${patches[@]}"; do
  check "$patch and its metamer for 1931: CIEDE2000 to that observer" "$(difference "$patch.exr" "$patch-1931.exr" 1931)" at-most 0.002
  check "$patch and its metamer for 1931: to the observer of 10 degrees" "$(difference "$patch.exr" "$patch-1931.exr" 1964)" at-least 0.5
  check "$patch and its metamer for 2015: to that observer" "$(difference "$patch.exr" "$patch-2015.exr" 2015-2)" at-most 0.002
  for kind in '' -2015; do spec2rgb --observer cones.spd "$patch$kind.exr" -o "cones$kind.exr"; done
  check "$patch and its metamer for 2015: what the cones L, M, S get, largest relative difference" \
    "$(echo "$(sums cones.exr) $(sums cones-2015.exr)" | awk '{ for (i = 1; i <= 3; i++) print $(i + 3) / $i - 1 }' | largest)" at-most 2e-5
done
plot spectra.ppm 380:730 0:1.6 0.2 '200 0 0,0 120 0,30 60 200,240 150 150,140 200 140,160 180 240' \
  {02-light-skin,14-green,13-blue}-1931.spd 02-light-skin.spd 14-green.spd 13-blue.spd
picture spectra.png 'spec2rgb --name-map R=650nm,G=550nm,B=450nm --observer display.spd spectra.ppm -o spectra.png' \
  'skin (red), green and blue patches in daylight (pale), and what looks the same on the screen'
picture pairs.png "specconvert --patches 4x2 --patch 80 ${patches[*]/%/.spd} ${patches[*]/%/-1931.spd} -o pairs.exr
spec2rgb pairs.exr -o pairs.png" 'above the patches, below their metamers, to the observer of 1931'
picture pairs-1964.png 'spec2rgb --observer 1964 pairs.exr -o pairs-1964.png' 'the same to that of 1964'
