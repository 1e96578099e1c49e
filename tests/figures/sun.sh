# shellcheck shell=bash disable=SC2016
title 'The sun through a year'
from 'I. Reda and A. Andreas, NREL/TP-560-34302 (2003, revised 2008); The Astronomical Almanac for 2024; J. Meeus, Astronomical Algorithms (1998)'
note 'specinfo --sun has the apparent sun of any place and time, with refraction and air mass, and when it rises, culminates and sets: here every fifth day of 2024.'

cp "$here/plot.awk" .
for ((day = 1; day <= 366; day += 5)); do
  printf '2024-%03dT12:00+01:00\n' $day
done >times.txt
run 'for time in $(cat times.txt); do specinfo --json --sun "50.88N 4.70E" --time $time; done >leuven.json
for time in $(cat times.txt); do specinfo --json --sun "66.0N 4.70E" --time $time; done >north.json'
# hours FILE: sunrise, noon and sunset as hours, over the day of the year; beyond 24 in the next day.
hours() {
  echo '# columns: day sunrise noon sunset'
  jq -r '[.day_of_year, (.sunrise, .noon, .sunset | .[11:19] // "-")] | join(" ")' "$1" | sed 's/:/ /g' |
    awk '{
      if ($2 == "-") { print $1, "-", $3 + $4 / 60, "-"; next }
      noon = $5 + $6 / 60 + $7 / 3600; sunset = $8 + $9 / 60 + $10 / 3600
      print $1, $2 + $3 / 60 + $4 / 3600, noon, sunset < noon ? sunset + 24 : sunset
    }'
}
hours leuven.json >leuven.txt
hours north.json >north.txt
{ echo '# columns: day equation'; jq -r '[.day_of_year, .equation_of_time_min] | join(" ")' leuven.json; } >equation.txt
picture leuven.svg 'awk -f plot.awk -v across="day of 2024" -v up="hour (UTC+1)" -v top=24 -v step=4 -v tick=30 leuven.txt >leuven.svg' \
  'Leuven, 50.88 degrees north'
picture north.svg 'awk -f plot.awk -v across="day of 2024" -v up="hour (UTC+1)" -v top=26 -v step=2 -v tick=30 north.txt >north.svg' \
  'a place on its meridian, 66 degrees north, half a degree from the polar circle'
picture equation.svg 'awk -f plot.awk -v across="day of 2024" -v up="minutes" -v bottom=-20 -v top=20 -v step=5 -v tick=30 equation.txt >equation.svg' \
  'equation of time: how far the sundial is ahead of the clock'

# The case that the paper works out, table A5.1 and appendix A.4, without refraction and with it.
run 'specinfo --json --sun "39.742476N 105.1786W 1830.14m" --time 2003-10-17T12:30:30-07:00 --air 820,11 >golden.json'
for key in 'zenith_deg 50.127954' 'zenith_refracted_deg 50.11162' 'declination_deg -9.316179'; do
  check "${key% *} of Reda and Andreas, to 1.1\" [degrees]" "$(jq ".${key% *}" golden.json)" within "${key#* }" 0.00031
done
check 'azimuth_deg of Reda and Andreas, to 1.1" on the sky' "$(jq .azimuth_deg golden.json)" within 194.34024 0.0004
check 'distance_au of theirs' "$(jq .distance_au golden.json)" within 0.9965422974 2e-7

# The almanac's instants are rounded to the minute, in which the declination changes by 1"; the
# sun's latitude, up to 1.2", is in it, too.
sun() {
  specinfo --json --sun '0N 0E' --time "$1" | jq "$2"
}
check 'declination at the equinox of 20 March 2024, 3:06 UT ["]' "$(sun 2024-03-20T03:06Z '.declination_deg * 3600')" within 0 1.7
check 'and at that of 22 September, 12:44 UT' "$(sun 2024-09-22T12:44Z '.declination_deg * 3600')" within 0 1.7
check 'distance at perihelion, 3 January 2024 [au]' "$(sun 2024-01-03T00:39Z .distance_au)" within 0.983307 1e-6
check 'distance at aphelion, 5 July 2024 [au]' "$(sun 2024-07-05T05:06Z .distance_au)" within 1.016725 1e-6
check 'least equation of time of the year, about 11 February [min]' "$(jq .equation_of_time_min leuven.json | sort -g | head -n 1)" within -14.2 0.1
check 'greatest, about 3 November' "$(jq .equation_of_time_min leuven.json | sort -g | tail -n 1)" within 16.4 0.1
# What the paper computes for three days beside the almanac, rounded to whole seconds; it leaves out the
# sun's parallax, .8 s.
seconds() {
  specinfo --json --sun "$1" --time "$2T12:00Z" | jq -r ".$3" | sed 's/.*T\(..\):\(..\):\(..\)Z/\1 \2 \3/' | awk '{ print $1 * 3600 + $2 * 60 + $3 }'
}
check 'sunrise at 35 N on 2 January 1994, 7:08:12.8 [s]' "$(seconds '35N 0E' 1994-01-02 sunrise)" within 25692.8 1.5
check 'sunset there, 16:59:55.9' "$(seconds '35N 0E' 1994-01-02 sunset)" within 61195.9 1.5
check 'sunrise at 35 S on 5 July 1996, 7:08:15.4' "$(seconds '35S 0E' 1996-07-05 sunrise)" within 25695.4 1.5
check 'sunset at 35 S on 4 December 2004, 19:02:02.5' "$(seconds '35S 0E' 2004-12-04 sunset)" within 68522.5 1.5
