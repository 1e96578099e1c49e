# shellcheck shell=bash
title 'Interference colours over thickness and angle'
from 'W 4.3 (Schiffner 2008); Quincke 1866 and Michel-Lévy 1888 for the order of the colours'
note 'A film between two equal media reflects nearly as sin²(πΓ/λ), Γ being twice its optical thickness: as a crystal of retardation Γ shines between crossed polarisers.'

run 'specfilm --stack "air | 1.33 * | air" --chart "thickness 0nm..1500nm, angle 0deg..80deg" --size 751x321 -o chart.exr'
picture chart.png 'spec2rgb chart.exr -e 2 -o chart.png' \
  'soap film, reflected: thickness 0 to 1500 nm to the right, angle 0 to 80° downwards'
# 4/3 makes 750 nm a retardation of 2000 nm, and a pixel 1 nm.
picture orders.png \
  'specfilm --stack "air | 1.3333333333333333 * | air" --chart "thickness 0nm..750nm, angle 0deg..0deg" --size 2001x200 -o orders.exr
spec2rgb orders.exr -e 3.5 -o orders.png' \
  'its colours over the retardation, 0 to 2000 nm: four orders'
picture passed.png \
  'specfilm --stack "air | 1.33 * | air" --chart "thickness 0nm..1500nm, angle 0deg..80deg" --of transmittance --size 751x321 | spec2rgb -e -0.5 -o passed.png' \
  'the same film, transmitted: pale, in complementary colours'

# The brightest that the film can be becomes white.
white=$(awk 'BEGIN { r = (1 / 7) ^ 2; printf "%.9g", (1 + r) ^ 2 / (4 * r) }')
specconvert --crop 0,0,2001,1 orders.exr | specconvert --scale "$white" -o strip.exr
# "retardation name" for each pixel, by sectors of CIELAB's hue.
hues strip.exr 0,0,2001,1 D65 | awk '{
  if ($4 < 20) name = $5 < 10 ? "black" : $5 < 90 ? "grey" : "white"
  else if ($3 < 40 || $3 >= 312) name = "red"
  else if ($3 < 75) name = "orange"
  else if ($3 < 115) name = "yellow"
  else if ($3 < 200) name = "green"
  else if ($3 < 300) name = "blue"
  else name = "violet"
  print $1, name }' >names
check 'colours from 0 to 1550 nm of retardation, in their order' \
  "$(awk '$1 <= 1550 && $2 != last { last = $2; print }' names | cut -d ' ' -f 2 | xargs)" \
  equals 'black grey white yellow orange red violet blue green yellow orange red violet blue green yellow orange red'
# Quincke: black 0, lavender grey 97, almost pure white 259, bright yellow 332, red 536, violet 575,
# indigo 589, sky blue 664, green 747, pure yellow 910, orange 948, bright orange-red 998, dark
# violet red 1101, greenish blue 1258 to brilliant green 1376, carmine 1534.
check "colours at Quincke's retardations" \
  "$(for at in 0 97 259 332 536 575 589 664 747 910 948 998 1101 1376 1534; do
    awk -v at=$at '$1 == at { print $2 }' names
  done | xargs)" \
  equals 'black grey white yellow red violet blue blue green yellow orange red red green red'

# Where 2 n d cos (inside) is four waves, nothing comes back: 504.7 nm at 1000 nm and 60 degrees.
pixel chart.exr 500,240 >dark
check '1000 nm at 60°: darkest wavelength from 450 to 560 nm' \
  "$(awk '$1 >= 450 && $1 <= 560 && (least == "" || $2 < least) { least = $2; nm = $1 } END { print nm }' dark)" \
  within "$(awk 'BEGIN { s = sin(atan2(0, -1) / 3) / 1.33; print 2 * 1.33 * 1000 * sqrt(1 - s * s) / 4 }')" 2.5
run 'specfilm --stack "air | 1.33 1000nm | air" --spectrum --angle 60deg --grid 380:780:25'
check '1000 nm at 60°: largest difference of the chart to the spectrum as text' \
  "$(awk 'FNR == NR { r[$1] = $2; next } /^[0-9]/ { print $2 - r[$1] }' dark - <<<"$printed" | largest)" at-most 6e-8
check '0 nm is black: largest reflectance' "$(pixel chart.exr 0,160 | cut -d ' ' -f 2 | largest)" at-most 1e-12
