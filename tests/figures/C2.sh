# shellcheck shell=bash disable=SC2016
title 'Observers, and the chromaticity diagram'
from 'T 2.7, 2.8; W 2 and 3; CIE 15:2018; CIE 170-2:2015; Stiles and Burch 1959'
note 'The functions of five observers, and what lights, lines and displays are to that of 1931. Chromaticities are measured on pictures: an observer whose columns have other names than x, y, z is a camera to spec2rgb, which writes its three sums as they are.'

display >display.spd
cp "$here/diagram.awk" .
cmf=$spectra/cmf

# functions NAME: its three columns as files of their own.
functions() {
  local i
  for i in 2 3 4; do
    awk -v i=$i '/^[0-9]/ { print $1, $i }' "$cmf/$1.spd" >"$1.$i.spd"
  done
}
for name in cie1931 cie1964 cie2015-10 stiles-burch-1959 cie2006-lms-10; do
  functions $name
done
dark='200 0 0,0 120 0,30 60 200' pale='240 150 150,140 200 140,160 180 240'
plot cie.ppm 380:780 0:2.25 0.25 "160 160 160,160 160 160,160 160 160,$pale,$dark" \
  cie2015-10.{2,3,4}.spd cie1964.{2,3,4}.spd cie1931.{2,3,4}.spd
picture cie.png 'spec2rgb --name-map R=650nm,G=550nm,B=450nm --observer display.spd cie.ppm -o cie.png' \
  'x (red), y (green), z (blue) of the CIE of 1931; paler of 1964; grey those of 2015 for 10 degrees'
plot sensors.ppm 390:730 -0.5:3.5 0.5 "$pale,$dark" \
  cie2006-lms-10.{2,3,4}.spd stiles-burch-1959.{2,3,4}.spd
picture sensors.png 'spec2rgb --name-map R=650nm,G=550nm,B=450nm --observer display.spd sensors.ppm -o sensors.png' \
  'r, g, b of Stiles and Burch 1959, which are negative in places; paler the cones L, M, S of 2006'

# raw NAME: the observer, as a camera of three sensors.
raw() {
  echo '# columns: wavelength_nm r g b'
  grep '^[0-9]' "$cmf/$1.spd"
}
for year in 1931 1964; do
  raw cie$year >camera$year.spd
done
printf '%s\n' '# quantity: reflectance' '360 1' '830 1' >white.spd
run 'specconvert --grid 360:830:1 --patches 1x1 white.spd -o white.exr
for light in A C D50 D65 E FL2 FL7 FL11; do
  spec2rgb --observer camera1931.spd --illuminant $light white.exr -o $light-1931.exr
  spec2rgb --observer camera1964.spd --illuminant $light white.exr -o $light-1964.exr
done'

# xy FILE: the chromaticity of a picture of X, Y, Z in red, green, blue.
xy() {
  layers --print 0,0 "$1" | awk '{ of[$1] = $2; sum += $2 } END { printf "%.6f %.6f\n", of["R"] / sum, of["G"] / sum }'
}
# Published: CIE 15:2004 for A to D75 and for F at 2 degrees; the others, the table of five digits that
# is quoted everywhere (Wikipedia, "Standard illuminant").
while read -r name tolerance x y x10 y10; do
  for year in 1931 1964; do
    seen=$(xy "$name-$year.exr")
    [ $year = 1931 ] || { x=$x10; y=$y10; }
    check "$name, observer of $year: x" "${seen% *}" within "$x" "$tolerance"
    check "$name, observer of $year: y" "${seen#* }" within "$y" "$tolerance"
    [ $year = 1964 ] || echo "point $name $seen" >>points.txt
  done
done <<'END'
A 1e-4 0.44758 0.40745 0.45117 0.40594
C 1e-4 0.31006 0.31616 0.31039 0.31905
D50 1e-4 0.34567 0.35851 0.34773 0.35952
D65 1e-4 0.31272 0.32903 0.31382 0.33100
E 1e-4 0.333333 0.333333 0.333333 0.333333
FL2 3e-4 0.3721 0.3751 0.37925 0.36733
FL7 3e-4 0.3129 0.3292 0.31569 0.32960
FL11 3e-4 0.3805 0.3769 0.38541 0.37123
END

# The locus: lines of light, 1 nm wide. CIE 15:2018, spectral chromaticity coordinates to four digits.
for line in '460 0.1440 0.0297' '520 0.0743 0.8338' '580 0.5125 0.4866' '620 0.6915 0.3083'; do
  read -r nm x y <<<"$line"
  printf '%s\n' '# quantity: radiance' "$((nm - 1)) 0" "$nm 1" "$((nm + 1)) 0" >line.spd
  specconvert -q --grid 360:830:1 --extrapolate zero --patches 1x1 line.spd -o line.exr
  run "spec2rgb --observer camera1931.spd line.exr -o $nm.exr"
  seen=$(xy "$nm.exr")
  check "$nm nm: x" "${seen% *}" within "$x" 6e-5
  check "$nm nm: y" "${seen#* }" within "$y" 6e-5
done

# Primaries: IEC 61966-2-1:1999, Adobe RGB (1998), SMPTE RP 431-2:2011, ITU-R BT.2020-2, SMPTE ST 2065-1:2012.
cat >displays.txt <<'END'
triangle sRGB 0.64 0.33 0.30 0.60 0.15 0.06
triangle Adobe-RGB 0.64 0.33 0.21 0.71 0.15 0.06
triangle DCI-P3 0.680 0.320 0.265 0.690 0.150 0.060
triangle Rec.2020 0.708 0.292 0.170 0.797 0.131 0.046
triangle ACES2065-1 0.73470 0.26530 0 1 0.00010 -0.07700
END
grep -v ' FL' points.txt >whites.txt
picture diagram.svg "awk -f diagram.awk '$cmf/cie1931.spd' displays.txt whites.txt >diagram.svg" \
  'the spectrum locus of 1931 with its wavelengths, five spaces, and the whites that were measured above'
# Rec. 2020 has lines of light as primaries: 630, 532 and 467 nm.
for line in '630 2 3' '532 4 5' '467 6 7'; do
  read -r nm i j <<<"$line"
  x=$(column "$cmf/cie1931.spd" x | sed -n "$((nm - 359))p") y=$(column "$cmf/cie1931.spd" y | sed -n "$((nm - 359))p")
  z=$(column "$cmf/cie1931.spd" z | sed -n "$((nm - 359))p")
  check "Rec. 2020: distance of a primary from the locus at $nm nm" \
    "$(awk -v x="$x" -v y="$y" -v z="$z" -v i="$i" -v j="$j" '$2 == "Rec.2020" {
      s = x + y + z; print sqrt(($(i + 1) - x / s) ^ 2 + ($(j + 1) - y / s) ^ 2) }' displays.txt | largest)" at-most 2e-3
done
