# shellcheck shell=bash
title 'Spectra of lamps, and what a filter leaves of them'
from 'T 2.1, figures 2.1 and 2.2 (Vangorp & Yskout 2005)'
note 'A bulb and a laser, a fluorescent tube, a green card and an orange filter. The bulb is illuminant A, the tube FL11, the card patch 14 of the ColorChecker; the laser is a line at 632.8 nm and the filter a formula, both made here.'
cp "$here/plot.awk" .

# A line of 2 nm at half its height, by 0.05 nm, of 1 W; and a transmittance that is a logistic curve.
run 'awk "BEGIN {
  print \"# title: laser\n# quantity: spectral power distribution\n# unit: W/nm\n# columns: wavelength_nm S\"
  w = 2 / sqrt(8 * log(2))
  for (i = -200; i <= 200; i++) print 632.8 + i / 20, exp(-(i / 20 / w) ^ 2 / 2) / (w * sqrt(8 * atan2(1, 1)))
}" >laser.spd
awk "BEGIN {
  print \"# title: orange filter\n# quantity: transmittance\n# columns: wavelength_nm T\"
  for (nm = 390; nm <= 720; nm += 15) print nm, 0.9 / (1 + exp((560 - nm) / 10))
}" >filter.spd'

picture lamps.svg 'specconvert A -o bulb.spd
specconvert F11 --scale 6 -o tube.spd
awk -f plot.awk bulb.spd laser.spd tube.spd >lamps.svg' 'bulb, laser and tube, each over its greatest value'
picture product.svg 'specconvert 14-green -o card.spd
specconvert A --multiply filter.spd -o through.spd
specconvert tube.spd --multiply card.spd -o from-card.spd
awk -f plot.awk card.spd filter.spd through.spd from-card.spd >product.svg' \
  'the card, the filter, the bulb through the filter and the tube on the card'
picture colours.png "specconvert bulb.spd tube.spd through.spd from-card.spd --grid 390:720:1 --patches 4x1 --patch 120 --gap 8 -o colours.exr
spec2rgb -q -e -8.5 colours.exr -o colours.png" 'the colours of bulb, tube, bulb through the filter, tube on the card'

# The product on the merged grid, by straight lines between the samples of both, computed here.
# product A B: "nm a*b" at each wavelength of either within the range of both.
product() {
  awk '
    function at(f, nm, i) {
      for (i = 2; i < n[f] && x[f, i] < nm; i++);
      return y[f, i - 1] + (y[f, i] - y[f, i - 1]) * (nm - x[f, i - 1]) / (x[f, i] - x[f, i - 1])
    }
    FNR == 1 { f++ }
    /^[0-9]/ { x[f, ++n[f]] = $1 + 0; y[f, n[f]] = $2; nm[$1 + 0] = 1 }
    END {
      for (w in nm) if (w + 0 >= x[1, 1] && w + 0 >= x[2, 1] && w + 0 <= x[1, n[1]] && w + 0 <= x[2, n[2]])
        printf "%.10g %.17g\n", w, at(1, w + 0) * at(2, w + 0)
    }' "$1" "$2" | sort -g
}
for pair in 'bulb filter through' 'tube card from-card'; do
  read -r one two result <<<"$pair"
  product "$one.spd" "$two.spd" >wanted
  grep '^[0-9]' "$result.spd" >found
  check "$one times $two: wavelengths of both" "$(wc -l <found)" equals "$(wc -l <wanted)"
  check "$one times $two: largest difference from the closed form, relative" \
    "$(paste -d ' ' wanted found | awk '{ print $1 == $3 ? ($2 ? $4 / $2 - 1 : $4) : 1 }' | largest)" at-most 1e-14
done
# The other way: what passed, over the filter, is the lamp again.
specconvert through.spd --divide filter.spd -o back.spd
check 'through the filter, over the filter: largest difference from the bulb, relative' \
  "$(awk 'FNR == NR { if (/^[0-9]/) s[$1] = $2; next } /^[0-9]/ && $1 in s { print $2 / s[$1] - 1 }' bulb.spd back.spd | largest)" at-most 1e-14

# The bulb is Planck's, as the standard has it, to the digits of the table.
check 'the bulb: largest difference from the formula of the standard, relative' \
  "$(awk '/^[0-9]/ { want = 100 * (560 / $1) ^ 5 * (exp(1.435e7 / (2848 * 560)) - 1) / (exp(1.435e7 / (2848 * $1)) - 1); print $2 / want - 1 }' bulb.spd | largest)" at-most 1e-5
# A line that is narrower than the bands must not lose its power: its bins keep it, its samples do not.
power() { # power FILE STEP: the integral of bands of equal width
  awk -v step="$2" '/^[0-9]/ { sum += $2 * step } END { printf "%.15g\n", sum }' "$1"
}
run 'specconvert laser.spd --rebin --grid 627.8:637.8:10 -o rebinned.spd
specconvert laser.spd --grid 628:638:10 -o sampled.spd'
check 'the laser of 1 W, by its samples, whose numbers have six digits [W]' "$(power laser.spd 0.05)" within 1 1e-6
check 'the laser in bins of 10 nm [W]' "$(power rebinned.spd 10)" within "$(power laser.spd 0.05)" 1e-13
check 'the laser in samples of 10 nm: what is left [W]' "$(power sampled.spd 10)" within 0 1e-5
# An image goes the same way.
run 'specconvert bulb.spd --grid 390:720:10 -o bulb.exr
specconvert bulb.exr --multiply filter.spd | specconvert -f spd >image.spd
specconvert bulb.spd --grid 390:720:10 --multiply filter.spd -o curve.spd'
check 'as an image: largest difference from the curve, relative (a float has 24 bits)' \
  "$(awk 'FNR == NR { if (/^[0-9]/) s[$1] = $2; next } /^[0-9]/ { print $2 / s[$1] - 1 }' curve.spd image.spd | largest)" at-most 1.2e-7
