# shellcheck shell=bash disable=SC2016
title 'A clear day: light and colour of the sun and of the sky'
from 'R. E. Bird and C. Riordan 1986 (SPCTRAL2); CIE 15:2018; Leuven, 17 May 2005'
note 'sun@PLACE,TIME, sky@ and daylight@ are lights wherever a program takes one: spectral irradiance of a clear sky, here every quarter of an hour of one day.'

cp "$here/plot.awk" .
# From sunrise, 5:47, to sunset, 21:27.
for ((minute = 6 * 60; minute <= 21 * 60 + 15; minute += 15)); do
  printf '50.88N 4.70E,2005-05-17T%02d:%02d+02:00\n' $((minute / 60)) $((minute % 60))
done >times.txt
run 'sed "s/.*/sun@&,tilt=0/" times.txt | xargs -d "\n" specinfo --json >sun.json
sed "s/.*/sky@&/" times.txt | xargs -d "\n" specinfo --json >sky.json
sed "s/.*/daylight@&/" times.txt | xargs -d "\n" specinfo --json >daylight.json'
# table KEY SCALE: hour, and that of the three lights.
table() {
  echo '# columns: hour sun sky daylight'
  for part in sun sky daylight; do
    jq -r ".[] | .$1 // \"-\"" $part.json | awk -v scale="$2" '{ print $1 == "-" ? $1 : $1 * scale }' >$part.column
  done
  sed 's/.*T\(..\):\(..\).*/\1 \2/' times.txt | awk '{ print $1 + $2 / 60 }' | paste -d ' ' - sun.column sky.column daylight.column
}
table illuminance 1e-3 >illuminance.txt
table cct 1 >temperature.txt
picture illuminance.svg 'awk -f plot.awk -v across="hour (UTC+2)" -v up=klx -v top=100 -v step=20 -v tick=2 illuminance.txt >illuminance.svg' \
  'illuminance on the ground'
picture temperature.svg 'awk -f plot.awk -v across="hour (UTC+2)" -v up=K -v top=12000 -v step=2000 -v tick=2 temperature.txt >temperature.svg' \
  'correlated colour temperature'

# at HOUR COLUMN FILE
at() {
  awk -v hour="$1" -v column="$2" '$1 == hour { print $column }' "$3"
}
# IES Calculation Procedures Committee, Journal of the IES 13 (1984) 381-392, a fit to measurements: 127.5 klx
# exp(-0.21 / sin h), 2.3 % less on this day, and 0.8 + 15.5 sqrt(sin h) klx, for a clear sky and the sun at h.
run 'specinfo --json "daylight@50.88N 4.70E,2005-05-17T13:30+02:00" >noon.json'
check 'illuminance at noon, 13:30 [klx], and that of the IES formula' "$(at 13.5 4 illuminance.txt)" within \
  "$(jq -r .title noon.json | awk '{ h = sin($(NF - 2) * atan2(0, -1) / 180); print 127.5 * 0.977 * exp(-0.21 / h) * h + 0.8 + 15.5 * sqrt(h) }')" 5
check 'sun and sky add up, over the day: largest relative difference' \
  "$(awk '/^[0-9]/ { n++; print ($2 + $3) / $4 - 1 } END { if (n != 62) print "rows" }' illuminance.txt | largest)" at-most 1e-4
check 'colour of daylight at noon: D55 to D65 [K]' "$(at 13.5 4 temperature.txt)" within 6000 500
check 'colour of the sky at noon [K]' "$(at 13.5 3 temperature.txt)" at-least 8000
check 'colour of the sun a quarter of an hour after sunrise [K]' "$(at 6 2 temperature.txt)" at-most 3000
# Noon is at 12:00 + 2 h - 4.70/15 h - 3.65 min of the equation of time (Astronomical Almanac): 13:37.5. Forenoon
# and afternoon are alike but for 1.5 min on both sides of 13:37.5 - 3:30 and + 3:30, and the sun's declination.
check 'light at 10:15 over that at 17:00, as long before noon as after it' \
  "$(awk '$1 == 10.25 { one = $4 } $1 == 17 { two = $4 } END { print one / two }' illuminance.txt)" within 1 0.01
# P. J. Littlefair, Lighting Research and Technology 17 (1985) 162-182: 105 to 120 lm/W under clear skies.
run 'specconvert "daylight@50.88N 4.70E,2005-05-17T13:30+02:00" -o noon.spd'
check 'luminous efficacy of daylight at noon [lm/W]' \
  "$(awk -v klx="$(at 13.5 4 illuminance.txt)" '/^[0-9]/ { if (nm) sum += ($1 - nm) * ($2 + last) / 2; nm = $1; last = $2 } END { print 1e3 * klx / sum }' noon.spd)" within 110 10

run 'specconvert --grid 300:1200:5 "sun@50.88N 4.70E,2005-05-17T13:30+02:00" -o sun.spd
specconvert --grid 300:1200:5 "sky@50.88N 4.70E,2005-05-17T13:30+02:00" -o sky.spd
specconvert --grid 300:1200:5 "sun@50.88N 4.70E,2005-05-17T20:30+02:00" -o evening.spd'
picture spectra.svg 'awk -f plot.awk sun.spd sky.spd evening.spd >spectra.svg' \
  'the sun and the sky at noon, and the sun an hour before its setting, each over its greatest value'
# The sky is blue since molecules scatter as the wavelength to the power -4: bluer than sunlight by this, but for
# the aerosol, which has -1.3 here.
check 'the sky over the sun at 450 over that at 700 nm' \
  "$(awk -v one="$(value sky.spd 450 E)" -v two="$(value sun.spd 450 E)" -v three="$(value sky.spd 700 E)" -v four="$(value sun.spd 700 E)" \
    'BEGIN { print (one / two) / (three / four) }')" within 3.5 1.5
fails=$(specinfo 'daylight@50.88N 4.70E,2005-05-17T23:00+02:00' 2>&1) || true
check 'at 23:00 it is night' "${fails##* centre is }" equals '11.58 degrees below the horizon, and the light of twilight and night is not known'
