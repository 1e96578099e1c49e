# shellcheck shell=bash disable=SC2016
title 'Lights by formula, and the colours of displays'
from 'P and W: Planck, Stefan and Boltzmann, Wien, Kirchhoff; CIE 15:2018, equations 4.7 to 4.10; SI Brochure 2019; SMPTE RP 177:1993, of primaries'
note 'A name such as blackbody:3000K or daylight:6504K is a light wherever a program takes one.'
note 'No display shows all colours. Bands of light of 30 nm, with ever more white, are brought into sRGB in three ways: each component is clipped by itself; every colour goes towards the grey of its luminance as far as it must; or the whole picture loses light and saturation by two factors.'

cp "$here/plot.awk" .
temperatures=(1500 2042 2856 4000 6504 10000)
run "for t in ${temperatures[*]}; do specconvert blackbody:\${t}K -o \${t}K.spd; done"
run 'for t in 1500 2856 6504; do specconvert --grid 300:2000:10 ${t}K.spd -o black-${t}K.spd; done'
picture black.svg 'awk -f plot.awk black-1500K.spd black-2856K.spd black-6504K.spd >black.svg' \
  'black bodies, each over its greatest value'

# Constants of the SI: h [J s], c [m/s], k [J/K], exact. planck(nm, T) is in W m^-2 sr^-1 nm^-1.
planck='
  function planck(nm, t, m) {
    m = nm * 1e-9
    return 1e-9 * 2 * 6.62607015e-34 * 299792458 ^ 2 / m ^ 5 / (exp(6.62607015e-34 * 299792458 / (m * 1.380649e-23 * t)) - 1)
  }
  # The part of sigma T^4 / pi below a wavelength: 15 / pi^4 times the integral of x^3 / (e^x - 1) from x on.
  function below(nm, t, x, n, sum) {
    x = 6.62607015e-34 * 299792458 / (nm * 1e-9 * 1.380649e-23 * t)
    for (n = 1; (n - 1) * x < 50; n++) sum += exp(-n * x) * (x ^ 3 / n + 3 * x ^ 2 / n ^ 2 + 6 * x / n ^ 3 + 6 / n ^ 4)
    return 15 / (atan2(0, -1)) ^ 4 * sum
  }'
for t in "${temperatures[@]}"; do
  # Simpson, over 2300 steps of 1 nm; what lies outside 200 to 2500 nm is added by its closed form.
  check "$t K: integral of Planck's law over sigma T^4 / pi (CODATA 2018)" \
    "$(awk -v t="$t" "$planck"' /^[0-9]/ { v[n++] = $2 * planck(560, t) / 100 }
      END {
        for (i = 0; i < n; i++) sum += v[i] * (i == 0 || i == n - 1 ? 1 : i % 2 ? 4 : 2) / 3
        all = 5.670374419e-8 * t ^ 4 / atan2(0, -1)
        if (n == 2301) printf "%.9f\n", sum / all + 1 - below(2500, t) + below(200, t)
      }' "${t}K.spd")" within 1 1e-6
  # Wien: 2.897771955e-3 m K; the rows are 1 nm apart.
  check "$t K: wavelength of the peak [nm]" \
    "$(awk '/^[0-9]/ && $2 > most { most = $2; nm = $1 } END { print nm }' "${t}K.spd")" within "$(awk -v t="$t" 'BEGIN { printf "%.3f\n", 2.897771955e6 / t }')" 0.51
done

# Luminous efficacy: 683 lm/W (SI Brochure 2019; 683.002 for V(lambda) in air, CIE S 010) times what V sees, over
# all power. The sum of V by 1 nm is 106.8569.
run 'specconvert --grid 360:830:1 --patches 6x1 1500K.spd 2042K.spd 2856K.spd 4000K.spd 6504K.spd 10000K.spd -o bodies.exr
spec2rgb --observer v-photopic bodies.exr -o luminances.exr'
sum=$(column "$spectra/cmf/v-photopic.spd" V | awk '{ sum += $1 } END { printf "%.9f\n", sum }')
i=0
for t in "${temperatures[@]}"; do
  layers --print $i,0 luminances.exr | awk -v t="$t" -v sum="$sum" "$planck"' $1 == "G" {
    luminance = 683 * $2 * sum * planck(560, t) / 100
    printf "%d %.6g %.6f\n", t, luminance, luminance * atan2(0, -1) / (5.670374419e-8 * t ^ 4) }'
  i=$((i + 1))
done >efficacies.txt
# Until 1979 the candela was so defined: 60 cd/cm^2 at the freezing point of platinum, 2042 K.
check 'luminance at the freezing point of platinum, 2042 K [cd/m^2]' "$(awk '$1 == 2042 { print $2 }' efficacies.txt)" within 600000 6000
for t in "${temperatures[@]}"; do
  check "$t K: luminous efficacy [lm/W], less that by sums over V and Planck's law" \
    "$(awk -v t="$t" "$planck"' FNR == NR { if ($1 == t) seen = $3; next } /^[0-9]/ { sum += $2 * planck($1, t) }
      END { print seen - 683 * sum * atan2(0, -1) / (5.670374419e-8 * t ^ 4) }' efficacies.txt "$spectra/cmf/v-photopic.spd" | largest)" at-most 1e-4
done
check 'the most efficacious of these [K]' "$(sort -g -k 3 efficacies.txt | tail -n 1 | cut -d ' ' -f 1)" equals 6504

# Kirchhoff: a body sends out what a black one would, times what it absorbs.
run "specfilm --stack 'air | Au 200nm | air' --spectrum --grid 400:830:5 >gold.txt
grep '^[0-9]' gold.txt | awk '{ print \$1, \$4 }' >absorbs.spd
specconvert --grid 400:830:5 --multiply absorbs.spd 1500K.spd -o glow.spd"
check 'glowing gold, and what it reflects and lets through of a black body: largest relative difference to that body' \
  "$(paste -d ' ' <(grep '^[0-9]' gold.txt) <(grep '^[0-9]' glow.spd) <(specconvert --grid 400:830:5 1500K.spd | grep '^[0-9]') |
    awk 'NF == 8 { n++; print ($6 + ($2 + $3) * $8) / $8 - 1 } END { if (n != 87) print "rows" }' | largest)" at-most 1e-6
check 'gold absorbs blue: its emissivity at 450 over that at 650 nm' \
  "$(awk '$1 == 450 { blue = $4 } $1 == 650 { red = $4 } END { print blue / red }' gold.txt)" at-least 5

# Daylight.
run "for t in 4000 5000 6500 8000 12000 25000; do specconvert daylight:\${t}K -o day-\$t.spd; done
specconvert daylight:6503.616K -o d65.spd"
picture daylight.svg 'awk -f plot.awk day-4000.spd day-6500.spd day-25000.spd >daylight.svg' 'daylight of 4000, 6500 and 25000 K'
check 'daylight of 6503.616 K less the table of D65, from 300 to 830 nm' \
  "$(paste -d ' ' <(grep '^[0-9]' d65.spd) <(grep '^[0-9]' "$spectra/illuminants/D65.spd") | awk 'NF == 4 && $1 == $3 { n++; print $2 - $4 } END { if (n != 107) print "rows" }' | largest)" at-most 1e-3
printf '%s\n' '# columns: wavelength_nm r g b' >1931.spd
grep '^[0-9]' "$spectra/cmf/cie1931.spd" >>1931.spd
run 'specconvert --grid 360:830:1 --patches 6x1 day-4000.spd day-5000.spd day-6500.spd day-8000.spd day-12000.spd day-25000.spd -o day.exr
spec2rgb --observer 1931.spd day.exr -o day-xyz.exr'
i=0
for t in 4000 5000 6500 8000 12000 25000; do
  # The factors of the components are made for this chromaticity, and rounded.
  check "daylight of $t K: x and y, largest difference to those of the temperature" \
    "$(layers --print $i,0 day-xyz.exr | awk -v t=$t '{ of[$1] = $2; sum += $2 }
      END {
        x = t <= 7000 ? -4.6070e9 / t ^ 3 + 2.9678e6 / t ^ 2 + 99.11 / t + 0.244063 : -2.0064e9 / t ^ 3 + 1.9018e6 / t ^ 2 + 247.48 / t + 0.237040
        print of["R"] / sum - x, of["G"] / sum - (-3 * x ^ 2 + 2.87 * x - 0.275)
      }' | largest)" at-most 3e-4
  i=$((i + 1))
done

# sRGB's matrix, from primaries and white, as the picture has it.
run 'spec2rgb day.exr -o day-rgb.exr'
check 'linear sRGB of the six less the matrix of IEC 61966-2-1:1999 times X, Y, Z (R, G, B about 100)' \
  "$(for i in 0 1 2 3 4 5; do echo "$(layers --print $i,0 day-xyz.exr | sort | xargs) $(layers --print $i,0 day-rgb.exr | sort | xargs)"; done | awk 'NF == 12 {
    X = $6; Y = $4; Z = $2
    print $12 - ( 3.2409699419 * X - 1.5373831776 * Y - 0.4986107603 * Z)
    print $10 - (-0.9692436363 * X + 1.8759675015 * Y + 0.0415550574 * Z)
    print  $8 - ( 0.0556300797 * X - 0.2039769589 * Y + 1.0569715142 * Z)
  }' | largest)" at-most 5e-5
picture lights.png "specconvert --grid 360:830:5 --patches 6x2 --patch 60 ${temperatures[*]/%/K.spd} \\
  day-4000.spd day-5000.spd day-6500.spd day-8000.spd day-12000.spd day-25000.spd --scale 0.006 -o lights.exr
spec2rgb lights.exr -o lights.png" 'above, black bodies of 1500 to 10000 K; below, daylight of 4000 to 25000 K; all alike at 560 nm'

# Other spaces: their matrices follow from chromaticities alone.
# spectra: Gaussian bands of 400 to 685 nm, in 20 columns, with 0, 1/4, 1/2 and 3/4 of white, in rows.
awk 'BEGIN {
  print "# quantity: spectral power distribution"
  printf "# columns: wavelength_nm"
  for (i = 0; i < 80; i++) printf " c%d", i
  for (nm = 360; nm <= 830; nm += 5) {
    printf "\n%d", nm
    for (i = 0; i < 80; i++) {
      white = int(i / 20) / 4
      printf " %.6g", 1.5 * white + 2.4 * (1 - white) * exp(-((nm - 400 - 15 * (i % 20)) / 13) ^ 2 / 2)
    }
  }
  print ""
}' >bands.spd
# components FILE: red, green and blue, or X, Y and Z, of each pixel, by rows of the image.
components() {
  specconvert --name-map "${2:-R=650nm,G=550nm,B=450nm}" "$1" | specconvert -f spd |
    awk '/^[0-9]/ { n = NF; for (i = 2; i <= NF; i++) of[i] = $i " " of[i] } END { for (i = 2; i <= n; i++) print of[i] }'
}
run 'specconvert --patches 20x4 bands.spd -o bands.exr
spec2rgb --space xyz bands.exr -o xyz.exr
for space in srgb p3 dci-p3 rec2020 aces adobe; do spec2rgb --space $space bands.exr -o $space.exr; done'
components xyz.exr X=650nm,Y=550nm,Z=450nm >xyz.txt
while read -r space primaries; do
  components "$space.exr" >"$space.txt"
  # The nine numbers that take R, G, B of all pixels to X, Y, Z best (least squares).
  check "$space: its matrix in the picture, less that of its primaries and white; over the largest number" \
    "$(paste -d ' ' "$space.txt" xyz.txt | awk -v primaries="$primaries" '
      function det(a, b, c, d, e, f, g, h, i) { return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g) }
      # Cramer: the amounts c[0..2] of three columns whose sum is r.
      function solve(a0, a1, a2, b0, b1, b2, c0, c1, c2, r0, r1, r2, d) {
        d = det(a0, b0, c0, a1, b1, c1, a2, b2, c2)
        c[0] = det(r0, b0, c0, r1, b1, c1, r2, b2, c2) / d
        c[1] = det(a0, r0, c0, a1, r1, c1, a2, r2, c2) / d
        c[2] = det(a0, b0, r0, a1, b1, r1, a2, b2, r2) / d
      }
      NF == 6 { n++; for (i = 1; i <= 3; i++) for (j = 1; j <= 6; j++) of[i, j] += $i * $j }
      END {
        if (n != 80) exit
        split(primaries, p, " ")
        for (k = 0; k < 4; k++) { x[k, 0] = p[2 * k + 1]; x[k, 1] = p[2 * k + 2]; x[k, 2] = 1 - x[k, 0] - x[k, 1] }
        solve(x[0, 0], x[0, 1], x[0, 2], x[1, 0], x[1, 1], x[1, 2], x[2, 0], x[2, 1], x[2, 2], x[3, 0] / x[3, 1], 1, x[3, 2] / x[3, 1])
        for (k = 0; k < 3; k++) for (i = 0; i < 3; i++) {
          wanted[k, i] = c[k] * x[k, i]
          if (wanted[k, i] > most) most = wanted[k, i]
        }
        for (i = 0; i < 3; i++) {
          solve(of[1, 1], of[2, 1], of[3, 1], of[1, 2], of[2, 2], of[3, 2], of[1, 3], of[2, 3], of[3, 3], of[1, i + 4], of[2, i + 4], of[3, i + 4])
          for (k = 0; k < 3; k++) print (c[k] - wanted[k, i]) / most
        }
      }' | largest)" at-most 1e-7
done <<'SPACES'
srgb .64 .33 .30 .60 .15 .06 .3127 .3290
p3 .68 .32 .265 .69 .15 .06 .3127 .3290
dci-p3 .68 .32 .265 .69 .15 .06 .314 .351
rec2020 .708 .292 .170 .797 .131 .046 .3127 .3290
aces .7347 .2653 0 1 .0001 -.077 .32168 .33767
adobe .64 .33 .21 .71 .15 .06 .3127 .3290
SPACES
check 'components of sRGB below 0 or above 1, of 240' "$(awk '{ for (i = 1; i <= 3; i++) n += $i < 0 || $i > 1 } END { print n }' srgb.txt)" at-least 60
check 'those of ACES2065-1, which has all colours, below 0' "$(awk '{ for (i = 1; i <= 3; i++) n += $i < 0 } END { print n + 0 }' aces.txt)" equals 0

# Into the gamut. Luminance is Y of sRGB'\''s matrix.
picture clip.png 'specconvert --patches 20x4 --patch 24 bands.spd -o large.exr
spec2rgb large.exr -o clip.png' 'clipped: hues change, and highlights lose their colour'
picture desaturate.png 'spec2rgb --gamut desaturate large.exr -o desaturate.png' 'towards grey, as far as needed'
picture scale.png 'spec2rgb --gamut scale large.exr -o scale.png' 'all by two factors'
run 'spec2rgb bands.exr -o clip.ppm
for gamut in desaturate scale; do spec2rgb --gamut $gamut bands.exr -o $gamut.exr; done'
check 'clip: codes that are not those of each component by itself (IEC 61966-2-1:1999)' \
  "$(tail -c 240 clip.ppm | od -A n -v -t u1 -w3 | paste -d ' ' - srgb.txt | awk '
    function code(v) {
      v = v < 0 ? 0 : v > 1 ? 1 : v
      return int(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * exp(log(v) / 2.4) - 0.055) + 0.5)
    }
    NF == 6 { n++; for (i = 1; i <= 3; i++) bad += $i != code($(i + 3)) }
    END { if (n == 80) print bad + 0 }')" equals 0
for gamut in desaturate scale; do components $gamut.exr >$gamut.txt; done
check 'desaturate: largest difference to the farthest point from grey that is in the space' \
  "$(paste -d ' ' srgb.txt desaturate.txt | awk '
    NF == 6 {
      n++
      grey = 0.2126390059 * $1 + 0.7151686788 * $2 + 0.0721923154 * $3
      part = 1
      for (i = 1; i <= 3; i++) {
        if ($i < 0 && grey / (grey - $i) < part) part = grey / (grey - $i)
        if ($i > 1 && (1 - grey) / ($i - grey) < part) part = (1 - grey) / ($i - grey)
      }
      if (grey >= 1) { part = 0; grey = 1 }
      for (i = 1; i <= 3; i++) print grey + part * ($i - grey) - $(i + 3)
    }
    END { if (n != 80) print "pixels" }' | largest)" at-most 2e-7
check 'scale: largest difference to all over the largest component, with saturation that the worst of all allows' \
  "$(awk -v most=1 -v part=1 '
    FNR == NR { for (i = 1; i <= 3; i++) if ($i > most) most = $i; next }
    FILENAME == "srgb.txt" && ++line {
      grey = 0.2126390059 * $1 + 0.7151686788 * $2 + 0.0721923154 * $3
      for (i = 1; i <= 3; i++) { of[line, i] = $i; if ($i < 0 && grey / (grey - $i) < part) part = grey / (grey - $i) }
      Y[line] = grey
      next
    }
    { n++; for (i = 1; i <= 3; i++) print (Y[n] + part * (of[n, i] - Y[n])) / most - $i }
    END { if (n != 80) print "pixels" }' srgb.txt srgb.txt scale.txt | largest)" at-most 2e-7
for gamut in desaturate scale; do
  check "$gamut: components outside the space" "$(awk '{ for (i = 1; i <= 3; i++) n += $i < -1e-7 || $i > 1 + 1e-7 } END { if (NR == 80) print n + 0 }' $gamut.txt)" equals 0
done
