# shellcheck shell=bash
title 'One scene through a day'
from 'L. Hosek and A. Wilkie 2012 and 2013; I. Reda and A. Andreas, NREL/TP-560-34302 (2008), appendix A.5; R. E. Bird and C. Riordan 1986'
note 'Leuven, 17 May 2005, looking west towards Brussels: a chalk ball, a silver ball and an orange wall in the light of the sun and a clear sky, each time metered. In the morning and in the evening it is the sun that is red, since its light comes through ten times as much air; the sky above stays blue.'

# Sanitizers make all of this ten times slower.
side=256x144 few=48
[[ $build != */san-* ]] || side=128x72 few=8
cp "$here/day.pbrt" .
for hour in 06:10 13:40 21:05; do
  case $hour in
  06:10) caption='ten past six: the sun rose twenty minutes ago, behind the eye' ;;
  13:40) caption='noon, on the left' ;;
  *) caption='five past nine: twenty minutes more of sun' ;;
  esac
  picture "${hour%:*}.png" "sed s/13:40/$hour/ day.pbrt | specrender --grid 380:730:10 --size $side --spp $few |
spec2rgb --exposure auto -o ${hour%:*}.png" "$caption"
done

# The sky right above; and the sun's disc, a picture all around of .1 degrees a pixel being cut out
# where it stands, less the sky beside it.
printf '%s\n' 'LookAt 0 0 0  0 1 0  0 0 1' 'Camera "perspective" "float fov" 5' \
  'Film "rgb" "integer xresolution" 1 "integer yresolution" 1' WorldBegin \
  'LightSource "daylight" "bool sun" true "string place" "50.88N 4.70E" "string time" "2005-05-17T13:40+02:00"' >above.pbrt
sed '/^LookAt/d; s/^Camera.*/Camera "spherical" "string mapping" "equirectangular"/' above.pbrt >round.pbrt
for hour in 06:10 13:40 21:05; do
  case $hour in
  06:10) part=273,862,303,892 ;;
  13:40) part=2674,300,2704,330 ;;
  *) part=1496,861,1526,891 ;;
  esac
  run "sed s/13:40/$hour/ above.pbrt | specrender --grid 380:780:5 -o above${hour%:*}.exr
sed s/13:40/$hour/ round.pbrt | specrender --grid 380:780:5 --size 3600x1800 --crop $part --spp 4 -o round${hour%:*}.exr"
done
kelvins() {
  specinfo --probe 0,0 "$1" | awk '$3 == "temperature" { print $4 }'
}
# disc FILE: the spectrum of the brightest pixel less the darkest.
disc() {
  specconvert -f spd "$1" | awk '/^[0-9]/ {
    most = 0; least = $2
    for (i = 2; i <= NF; i++) { if ($i > most) most = $i; if ($i < least) least = $i }
    print $1, most - least
  }'
}
for hour in 06 13 21; do
  { echo '# quantity: radiance per nm'; disc round$hour.exr; } >sun$hour.spd
  specconvert --patches 1x1 sun$hour.spd -o sun$hour.exr
done
for hour in 06 21; do
  check "the sun's own light at $hour: correlated colour temperature [K]" "$(kelvins sun$hour.exr)" at-most 2500
  check 'the sky right above then' "$(kelvins above$hour.exr)" at-least 8000
done
check "the sun's own light at noon: correlated colour temperature [K]" "$(kelvins sun13.exr)" within 5300 300
check 'the sky right above then' "$(kelvins above13.exr)" at-least 12000

# Why: Beer's law. Where the sun stands, beside the suite: to .01 degrees without refraction (The
# Astronomical Almanac, C5), which lifts it by 1.02' / tan(h + 10.3 / (h + 5.11)) (Saemundsson
# 1986). Prints its height [degrees] and the mass of the air (Kasten and Young 1989).
# shellcheck disable=SC2016
sun='
  function tangent(x) { return sin(x) / cos(x) }
  function arcsine(x) { return atan2(x, sqrt(1 - x * x)) }
  function height(hour, n, g, l, e, declination, right, turn, h) { # of UTC on 17 May 2005
    n = 1962.5 + hour / 24
    g = (357.528 + .9856003 * n) * degree
    l = (280.460 + .9856474 * n + 1.915 * sin(g) + .020 * sin(2 * g)) * degree
    e = (23.439 - .0000004 * n) * degree
    declination = arcsine(sin(e) * sin(l))
    right = atan2(cos(e) * sin(l), cos(l))
    turn = (280.46062 + 360.98564737 * n + 4.70) * degree - right
    h = arcsine(sin(declination) * sin(50.88 * degree) + cos(declination) * cos(50.88 * degree) * cos(turn)) / degree
    return h + 1.02 / 60 / tangent((h + 10.3 / (h + 5.11)) * degree)
  }
  function mass(h) { return 1 / (sin(h * degree) + .50572 * (h + 6.07995) ^ -1.6364) }
  BEGIN { degree = atan2(0, -1) / 180; low = height(4 + 10 / 60); high = height(11 + 40 / 60) }'
# place WIDTH X0 Y0 FILE: bearing and angle from the zenith of the middle of what is bright in a
# picture all around, cut out from X0, Y0 on and so wide, of .1 degrees a pixel.
place() {
  specconvert --band 550 "$4" | specconvert -f spd | awk -v width="$1" -v x0="$2" -v y0="$3" '/^550/ {
    for (i = 2; i <= NF; i++) if ($i > most) most = $i
    for (i = 2; i <= NF; i++) if ($i > most / 20) {
      sum += $i; x += $i * (x0 + (i - 2) % width + .5); y += $i * (y0 + int((i - 2) / width) + .5)
    }
    print (450 - x / sum / 10) % 360, y / sum / 10
  }'
}
read -r _ zenith < <(place 30 273 862 round06.exr)
check 'height of the sun in the picture of ten past six [degrees]' "$(awk "BEGIN { print 90 - $zenith }")" \
  within "$(awk "$sun"' BEGIN { print low }')" 0.03
read -r _ zenith < <(place 30 2674 300 round13.exr)
check 'height of the sun in the picture of noon' "$(awk "BEGIN { print 90 - $zenith }")" \
  within "$(awk "$sun"' BEGIN { print high }')" 0.03
check 'air on the way of its light, of that at noon' "$(awk "$sun"' BEGIN { print mass(low) / mass(high) }')" at-least 10
# From the light at both times the optical depth of the air right above: that of its molecules
# (Hansen and Travis 1974), and of aerosol with Angstrom's exponent 1.3, as much as 700 nm says.
# shellcheck disable=SC2016
depths='
  function molecules(um) { return .008569 * um ^ -4 * (1 + .0113 * um ^ -2 + .00013 * um ^ -4) }
  { light[$1, FILENAME] = $2 }
  function depth(nm) { return log(light[nm, "sun13.spd"] / light[nm, "sun06.spd"]) / (mass(low) - mass(high)) }
  function wanted(nm) { return molecules(nm / 1000) + (depth(700) - molecules(.7)) * (nm / 700) ^ -1.3 }'
check 'optical depth of aerosol at 700 nm' "$(awk "$sun$depths"' END { print depth(700) - molecules(.7) }' sun06.spd sun13.spd)" \
  within 0.05 0.03
for nm in 400 450; do
  check "optical depth of the air at $nm nm, from the sun at ten past six and at noon" \
    "$(awk "$sun$depths END { print depth($nm) }" sun06.spd sun13.spd)" \
    within "$(awk "$sun$depths END { print wanted($nm) }" sun06.spd sun13.spd)" 0.02
done

# The place and time of Reda and Andreas.
printf '%s\n' 'Camera "spherical" "string mapping" "equirectangular"' WorldBegin 'LightSource "daylight"' \
  '"string place" "39.742476N 105.1786W 1830.14m" "string time" "2003-10-17T12:30:30-07:00"' >golden.pbrt
run 'specrender --grid 550:551:1 --size 3600x1800 --crop 2526,471,2586,531 --spp 64 golden.pbrt -o golden.exr'
read -r azimuth zenith < <(place 60 2526 471 golden.exr)
check 'azimuth of the sun over Golden, Colorado [degrees]' "$azimuth" within 194.34024 0.02
check 'its angle from the zenith' "$zenith" within 50.11162 0.02
