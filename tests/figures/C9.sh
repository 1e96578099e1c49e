# shellcheck shell=bash disable=SC2016
title 'Metamers: equal in daylight, not by a bulb'
from 'T 2.3, equations 2.4 to 2.6; Wyszecki 1953; CIE 15:2018'
note 'A grey, and two reflectances that differ from it by what no eye sees in daylight: a cosine over the wavelength less three bumps with the same tristimulus values. Scaled alike, or with the same light added, they stay metamers; seen in another light they do not.'

display >display.spd
specconvert --grid 360:830:1 D65 >daylight.spd
# metamer WAVE DEGREES: 1/2 + k (cos(2 pi (nm - 400) / WAVE + DEGREES) - three bumps), within 0.02 to 0.98.
metamer() {
  awk -v wave="$1" -v phase="$2" '
    function det(a, b, c, d, e, f, g, h, i) { return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g) }
    !/^[0-9]/ { next }
    FNR == NR { light[$1] = $2; next }
    {
      pi = atan2(0, -1)
      v[$1, 0] = cos(2 * pi * ($1 - 400) / wave + phase * pi / 180)
      for (c = 1; c <= 3; c++) v[$1, c] = exp(-(($1 - (c == 1 ? 450 : c == 2 ? 540 : 610)) / 30) ^ 2 / 2)
      for (c = 0; c <= 3; c++) for (j = 1; j <= 3; j++) s[c, j] += light[$1] * v[$1, c] * $(j + 1)
    }
    END {
      d = det(s[1, 1], s[2, 1], s[3, 1], s[1, 2], s[2, 2], s[3, 2], s[1, 3], s[2, 3], s[3, 3])
      a[1] = det(s[0, 1], s[2, 1], s[3, 1], s[0, 2], s[2, 2], s[3, 2], s[0, 3], s[2, 3], s[3, 3]) / d
      a[2] = det(s[1, 1], s[0, 1], s[3, 1], s[1, 2], s[0, 2], s[3, 2], s[1, 3], s[0, 3], s[3, 3]) / d
      a[3] = det(s[1, 1], s[2, 1], s[0, 1], s[1, 2], s[2, 2], s[0, 2], s[1, 3], s[2, 3], s[0, 3]) / d
      for (nm = 360; nm <= 830; nm++) {
        black[nm] = v[nm, 0] - a[1] * v[nm, 1] - a[2] * v[nm, 2] - a[3] * v[nm, 3]
        if (black[nm] ^ 2 > most) most = black[nm] ^ 2
      }
      print "# quantity: reflectance"
      for (nm = 360; nm <= 830; nm++) printf "%d %.9f\n", nm, 0.5 + 0.48 * black[nm] / sqrt(most)
    }' daylight.spd "$spectra/cmf/cie1931.spd"
}
printf '%s\n' '# quantity: reflectance' '360 0.5' '830 0.5' >flat.spd
specconvert --grid 360:830:1 flat.spd >first.spd
metamer 150 330 >second.spd
metamer 100 90 >third.spd
plot spectra.ppm 360:830 0:1 0.2 '120 120 120,200 0 0,30 60 200' first.spd second.spd third.spd
picture spectra.png 'spec2rgb --name-map R=650nm,G=550nm,B=450nm --observer display.spd spectra.ppm -o spectra.png' \
  'a grey and two metamers of it'
run 'for name in first second third; do specconvert --patches 1x1 $name.spd -o $name.exr; done
specconvert --patches 3x1 --patch 100 first.spd second.spd third.spd -o three.exr'
for light in D65 A FL11; do
  case $light in
  D65) caption='in daylight, D65' ;;
  A) caption='by a bulb, A' ;;
  *) caption='by a fluorescent lamp, FL11' ;;
  esac
  picture $light.png "spec2rgb --illuminant $light --adapt bradford three.exr -o $light.png" "the three $caption"
done

# difference FILE FILE [OPTION...]: CIEDE2000 of one pixel; specdiff tells by its status that there is one.
difference() {
  { specdiff --metric de2000-max "${@:3}" "$1.exr" "$2.exr" || [ $? = 1 ]; } | awk '$1 == "de2000-max" { print $2 }'
}
for name in second third; do
  check "first and $name: largest difference of the reflectances" \
    "$(specconvert $name.spd | awk '/^[0-9]/ { print $2 - 0.5 }' | largest)" at-least 0.4
  check "first and $name in D65: CIEDE2000" "$(difference first $name --illuminant D65)" at-most 0.1
  check "first and $name in A: CIEDE2000" "$(difference first $name --illuminant A)" at-least 5
  # Beside specdiff, from the tables: CIELAB.
  for light in D65 A; do
    lab first.exr 0,0,1,1 $light >a.txt
    lab $name.exr 0,0,1,1 $light >b.txt
    apart=$(paste -d ' ' a.txt b.txt | awk '{ print sqrt(($3 - $8) ^ 2 + ($4 - $9) ^ 2 + ($5 - $10) ^ 2) }')
    if [ $light = D65 ]; then
      check "first and $name in $light: distance in CIELAB, from the tables" "$apart" at-most 0.001
    else
      check "first and $name in $light: distance in CIELAB, from the tables" "$apart" at-least 5
    fi
  done
done
# (2.6): what equals one and the same equals each other.
check 'second and third in D65: CIEDE2000' "$(difference second third --illuminant D65)" at-most 0.1
# (2.4), (2.5): as light, scaled by a number, and with another light added.
run 'for name in first second; do
  specconvert --multiply daylight.spd --scale 0.01 $name.spd -o $name-lit.spd
  specconvert --patches 1x1 $name-lit.spd -o $name-lit.exr
  specconvert --scale 0.3 $name-lit.exr -o $name-scaled.exr
  specconvert --scale 100 --add A --scale 0.01 $name-lit.exr -o $name-added.exr
  specconvert --extrapolate constant --multiply 07-orange $name-lit.exr -o $name-through.exr
done'
for change in lit scaled added; do
  check "light of first and second, $change: CIEDE2000" "$(difference first-$change second-$change)" at-most 0.1
done
check 'light of first and second, times the reflectance of an orange: CIEDE2000' "$(difference first-through second-through)" at-least 2
