#!/usr/bin/env bats
# Places, times and the sun: specinfo --sun, and what files say of where and when.
load common

golden='39.742476 N 105.1786 W 1830.14 m'
noonish=2003-10-17T12:30:30-07:00

# at PLACE TIME FILTER: what specinfo --json tells, through jq.
at() {
  specinfo --json --sun "$1" --time "$2" | jq -r "$3"
}

# nearly GOT WANTED TOLERANCE
nearly() {
  awk -v got="$1" -v wanted="$2" -v tolerance="$3" \
    'BEGIN { off = got - wanted; exit !(got ~ /[0-9]/ && off <= tolerance && -off <= tolerance) }' ||
    complain "got $1 instead of $2 +- $3"
}

# Reda & Andreas 2003, table A5.1 and appendix A.4; 1.1" as the unit test explains.
@test "the sun of the paper of the solar position algorithm" {
  specinfo --json --sun "$golden" --time $noonish --air 820,11 >sun.json
  nearly "$(jq .zenith_deg sun.json)" 50.127954 .00031
  nearly "$(jq .zenith_refracted_deg sun.json)" 50.11162 .00031
  nearly "$(jq .azimuth_deg sun.json)" 194.34024 .0004
  nearly "$(jq .distance_au sun.json)" .9965422974 2e-7
  nearly "$(jq .equation_of_time_min sun.json)" 14.638 .001
  nearly "$(jq .antisolar.azimuth_deg sun.json)" 14.34024 .0004
  nearly "$(jq .antisolar.elevation_deg sun.json)" -39.88838 .0004
  # Kasten & Young 1989 at that zenith, by hand.
  nearly "$(jq .airmass sun.json)" 1.5570 1e-4
  nearly "$(jq .airmass_absolute sun.json)" 1.2600 1e-4
  [ "$(jq -r '[.sunrise, .noon, .sunset] | join(" ")' sun.json)" = \
    '2003-10-17T06:12:44-07:00 2003-10-17T11:46:05-07:00 2003-10-17T17:18:51-07:00' ]
  [ "$(jq -r '[.utc, .day_of_year, .tai_utc_s, .leap_seconds] | join(" ")' sun.json)" = \
    '2003-10-17T19:30:30.000Z 290 32 known' ]
}

@test "the equation of time is in minutes and seconds, of which none is 60" {
  # -0.99987 min
  specinfo --sun '50N 4E' --time 2026-04-11T12:50:00Z | grep -qF '  equation      -1 min 00.0 s, apparent'
  specinfo --sun '50N 4E' --time 2026-04-11T13:10:00Z | grep -qE '  equation      -0 min 59.8 s, apparent'
}

@test "one place in every spelling" {
  # shellcheck disable=SC1111 # marks of minutes and seconds, not quotes
  for place in '39.742476 -105.1786 1830.14m' "39d44'32.9136\"N 105d10'42.96\"W 1.83014km" \
    '105:10:42.96W, 39:44:32.9136N, 1830.14m' "39° 44′ 32.9136″ N, 105° 10′ 42.96″ W, 1830.14 m"; do
    [ "$(at "$place" $noonish '.place.mgrs, .azimuth_deg')" = "$(at "$golden" $noonish '.place.mgrs, .azimuth_deg')" ]
  done
  nearly "$(at '13n 484698 4399190 1830.14m' $noonish .azimuth_deg)" 194.34024 .0005
  nearly "$(at '13SDD8469799190 1830.14m' $noonish .azimuth_deg)" 194.34024 .0005
}

@test "for people" {
  specinfo --sun "$golden" --time $noonish >sun.txt
  grep -qx '  place         39.742476 -105.178600, 1830.14 m' sun.txt
  grep -qx '  MGRS          13SDD8469799190' sun.txt
  grep -qx '  UTC           2003-10-17T19:30:30Z, Julian date 2452930.312847' sun.txt
  grep -q '^  sun           azimuth 194.34015, zenith 50.12792,' sun.txt
  grep -q '(Saemundsson 1986; 81[0-9][.][0-9] hPa, 3.1 C)' sun.txt
  grep -qx '  noon          2003-10-17T11:46:05-07:00, elevation 40.953 deg' sun.txt
}

# Karney 2013, table 2: 10000 km from 40 N, 0 E at 30 degrees.
@test "the way to another place" {
  specinfo --json --sun '40N 0E' --time $noonish --toward '41.79331020506 137.84490004377' >way.json
  nearly "$(jq .toward.bearing_deg way.json)" 30 1e-9
  nearly "$(jq .toward.distance_m way.json)" 10000000 1e-4
  nearly "$(jq .toward.arrival_deg way.json)" 149.09016931807 1e-9
  [ "$(jq '.toward.east_north_up_m | length' way.json)" = 3 ]
}

@test "polar day, polar night, the poles and the antimeridian" {
  [ "$(at '71.17N 25.78E' 2026-06-20T12:00+02:00 '.day, .sunrise, .sunset' | xargs)" = 'polar day null null' ]
  [ "$(at '71.17N 25.78E' 2026-12-20T12:00+01:00 '.day, .sunrise, .airmass' | xargs)" = 'polar night null null' ]
  specinfo --sun '71.17N 25.78E' --time 2026-12-20T12:00+01:00 >night.txt
  grep -qx '  sunrise       none: polar night' night.txt
  grep -qx '  air mass      none: the sun is below the horizon' night.txt
  # The sun stands as high over the pole as north of the equator.
  nearly "$(at '90N 0E' 2026-06-20T12:00Z '.elevation_deg - .declination_deg')" 0 1e-4
  nearly "$(at '90S 0E' 2026-06-20T12:00Z '.elevation_deg + .declination_deg')" 0 1e-4
  nearly "$(at '10N 180E' 2026-05-01T12:00+12:00 .zenith_deg)" "$(at '10N 180W' 2026-05-01T00:00Z .zenith_deg)" 1e-9
}

@test "ends of the table of leap seconds" {
  [ "$(at '40N 0E' 2016-12-31T23:59:60Z '.utc, .tai_utc_s, .leap_seconds' | xargs)" = '2016-12-31T23:59:60.000Z 36 known' ]
  [ "$(at '40N 0E' 2099-01-01T12:00Z .leap_seconds)" = 'beyond the table' ]
  [ "$(at '40N 0E' 1920-01-01T12:00Z .leap_seconds)" = 'before UTC' ]
  specinfo --sun '40N 0E' --time 2099-01-01T12:00Z | grep -q "too old to know of this year's"
}

@test "now is a time" {
  TZ=NPT-5:45 at '40N 0E' now .time | grep -qE '^20[0-9]{2}-.*T.*\+05:45$'
}

# trouble TEXT COMMAND...: it fails cleanly, and says that.
trouble() {
  local text=$1
  shift
  fails_cleanly "$@"
  [[ $stderr = *"$text"* ]] || complain "not '$text' but: $stderr"
}

@test "no place, no time, nonsense" {
  trouble "--sun needs a --time" specinfo --sun "$golden"
  trouble "--time, --toward and --air are for --sun" specinfo --time $noonish
  trouble "'nowhere' is no place" specinfo --sun nowhere --time $noonish
  trouble "'91N 5E' is no place: Latitude 91d not in [-90d, 90d]" specinfo --sun '91N 5E' --time $noonish
  trouble "is half a place" specinfo --sun 39.74 --time $noonish
  trouble "is no place" specinfo --sun '' --time $noonish
  trouble "the altitude" specinfo --sun '40 50 900km' --time $noonish
  trouble "does not say in which zone" specinfo --sun "$golden" --time 2003-10-17T12:30:30
  trouble "has no time of day" specinfo --sun "$golden" --time 2003-10-17
  trouble "the calendar has no such day" specinfo --sun "$golden" --time 2003-02-29T12:00Z
  trouble "that was no leap second" specinfo --sun "$golden" --time 2003-12-31T23:59:60Z
  trouble "known from 1900 to 2100, not in 1850" specinfo --sun "$golden" --time 1850-02-28T12:00Z
  trouble "is not PRESSURE,TEMPERATURE" specinfo --sun "$golden" --time $noonish --air 820
  trouble "the air's pressure" specinfo --sun "$golden" --time $noonish --air -1,10
  trouble "is no place" specinfo --sun "$golden" --time $noonish --toward 'over there'
  trouble "tells of no file" specinfo --sun "$golden" --time $noonish a.exr
  trouble "exclude each other" specinfo --sun "$golden" --time $noonish --check
  trouble "--plot draws nothing of" specinfo --sun "$golden" --time $noonish --plot a.png
  trouble "no --time" specinfo --sun own --time $noonish a.exr
}

@test "without its plugin one line says so" {
  mkdir -p bin lib/spectools
  cp "$BIN/specinfo" bin
  trouble 'this needs the plugin places.so, which cannot be loaded' bin/specinfo --sun "$golden" --time $noonish
}

@test "the sun of a file's own place and time" {
  spectral a.exr --number longitude=-105.1786 --number latitude=39.742476 --number altitude=1830.14 \
    --number utcOffset=25200 --attribute 'capDate=2003:10:17 12:30:30'
  specinfo --json --sun own a.exr >own.json
  [ "$(jq -r '.file, .time' own.json | xargs)" = 'a.exr 2003-10-17T12:30:30.000-07:00' ]
  nearly "$(jq .azimuth_deg own.json)" 194.34024 .0005
  specinfo --json --sun own <a.exr | jq -e '.file == "<stdin>"' >/dev/null
  [ "$(specinfo --json --sun own a.exr a.exr | jq length)" = 2 ]
  specinfo --sun own a.exr | head -n 1 | grep -qx a.exr
}

@test "a file that does not say where or when" {
  spectral a.exr
  trouble 'a.exr: does not say where it was taken' specinfo --sun own a.exr
  spectral a.exr --number longitude=5 --number latitude=50
  trouble 'a.exr: does not say when it was taken' specinfo --sun own a.exr
  spectral a.exr --number longitude=5 --number latitude=50 --attribute 'capDate=2003:10:17 12:30:30'
  trouble 'a.exr: does not say in which zone it was taken' specinfo --sun own a.exr
  spectral a.exr --number longitude=5 --number latitude=95 --attribute 'capDate=2003:10:17 12:30:30'
  trouble 'a.exr: a latitude is from -90 to 90 degrees, not 95' specinfo --sun own a.exr
  spectral a.exr --number longitude=5 --number latitude=50 --attribute 'capDate=yesterday'
  trouble "a.exr: its capDate, 'yesterday', is not YYYY:MM:DD hh:mm:ss" specinfo --sun own a.exr
  trouble "'D65' is a curve, and --sun own is for images" specinfo --sun own D65
}

@test "specconvert says where and when" {
  spectral a.exr --grid 400:700:20 --number altitude=7
  specconvert --place "$golden" --time $noonish a.exr -o b.exr
  exrheader b.exr >header
  grep -q '^longitude (type float): -105.179$' header
  grep -q '^latitude (type float): 39.7425$' header
  grep -q '^altitude (type float): 1830.14$' header
  grep -q '^capDate (type string): "2003:10:17 12:30:30"$' header
  grep -q '^utcOffset (type float): 25200$' header
  specinfo --check b.exr
  [ "$(specinfo b.exr | tail -n 1)" = '  taken         2003-10-17T12:30:30-07:00 at 39.74248 N 105.1786 W, 1830.14 m' ]
  # Samples stay; a place alone is told, too, and of charts and other representations.
  cmp <(specconvert -f spd a.exr) <(specconvert -f spd b.exr)
  specconvert --place '10N 20E' b.exr -o c.exr
  exrheader c.exr >header
  grep -q '^longitude (type float): 20$' header
  grep -q '^capDate (type string): "2003:10:17 12:30:30"$' header
  run ! grep -q ^altitude header
  [ "$(specinfo c.exr | tail -n 1)" = '  taken         2003-10-17T12:30:30-07:00 at 10 N 20 E' ]
  run ! grep -q taken <(specinfo a.exr)
  specconvert --place "$golden" --patches 1x1 D65 -o d.exr
  exrheader d.exr | grep -q '^longitude (type float): -105.179$'
  specconvert --place "$golden" --to fourier:5 a.exr -o e.exr
  exrheader e.exr | grep -q '^longitude (type float): -105.179$'
}

@test "what has no place for a place" {
  spectral a.exr --grid 400:700:20
  trouble 'only OpenEXR files say where and when' specconvert --place "$golden" a.exr -o a.hdr
  trouble 'only OpenEXR files say where and when' specconvert --time $noonish a.exr -o a.spd
  trouble 'only OpenEXR files say where and when' specconvert --place "$golden" D65
  trouble 'is no place' specconvert --place elsewhere a.exr
  trouble 'does not say in which zone' specconvert --time 2003-10-17T12:30:30 a.exr
  no_leftovers . a.exr
}

# A white matt surface has the reflectance 1 in the light of its own place and time; the light is
# that of the names of spd(5), 1/pi of it.
@test "reflectance in the light of a file's own place and time" {
  printf '%s\n' '# quantity: reflectance' '380 1' '780 1' >white.spd
  specconvert -g 400:700:20 --patches 1x1 white.spd --place '50.875N 4.75E' --time 2005-05-17T12:00+02:00 -o white.exr
  specconvert --illuminate daylight white.exr -o lit.exr
  specconvert -f spd lit.exr | grep '^[0-9]' >lit
  specconvert -g 400:700:20 --scale 0.3183098861837907 'daylight@50.875N 4.75E,2005-05-17T12:00+02:00' |
    grep '^[0-9]' >wanted
  paste lit wanted | awk '{ off = $2 / $4 - 1; if (off > 1e-6 || off < -1e-6) exit 1 } END { exit NR != 16 }'
  specconvert --reflectance-of daylight lit.exr | specconvert -f spd | grep '^[0-9]' |
    awk '{ off = $2 - 1; if (off > 2e-7 || off < -2e-7) exit 1 } END { exit NR != 16 }'
  # Options of the light change it, and other things than light are no daylight.
  specconvert --illuminate daylight,turbidity=6 white.exr | specconvert -f spd | grep '^[0-9]' >murky
  run ! cmp -s lit murky
  trouble "no spectrum 'daylight'" specconvert --multiply daylight lit.exr
  trouble 'turbidity is outside 1..10' specconvert --illuminate daylight,turbidity=60 white.exr
  trouble "white.exr: 'mist' is none of turbidity" specconvert --illuminate daylight,mist white.exr
  trouble "white.exr: 'water' needs a value" spec2rgb --illuminant daylight,water white.exr -o a.png
}

@test "daylight where there is none" {
  spectral a.exr --grid 400:700:20
  trouble 'a.exr: does not say where it was taken' specconvert --reflectance-of daylight a.exr
  specconvert --place '50N 5E' a.exr -o b.exr
  trouble 'b.exr: does not say when it was taken' specconvert --reflectance-of daylight b.exr
  trouble "the sun's centre is" specconvert --time 2005-05-17T23:00+02:00 --reflectance-of daylight b.exr
  [[ $stderr = *'degrees below the horizon'* ]]
  trouble "the sun's centre is" specconvert --place '80N 5E' --time 2005-12-17T12:00Z --reflectance-of daylight a.exr
  no_leftovers . a.exr b.exr
}

# white TIME: white.exr, a white surface, and lit.exr, its light in the daylight of that time.
white() {
  printf '%s\n' '# quantity: reflectance' '380 1' '780 1' >white.spd
  specconvert -g 380:780:5 --patches 1x1 white.spd --place '50.875N 4.75E' --time "$1" -o white.exr
  specconvert --illuminate daylight white.exr -o lit.exr
}

# colour OPTION...: the picture's linear R, G and B, over their sum.
colour() {
  spec2rgb "$@" --transfer linear -f ppm --bits 16 | tail -c 6 | od -A n -t u2 --endian=big |
    awk '{ sum = $1 + $2 + $3; printf "%.4f %.4f %.4f\n", $1 / sum, $2 / sum, $3 / sum }'
}

@test "spec2rgb adapts light from the daylight of its own place and time" {
  white 2005-05-17T12:00+02:00
  # At 5756 K it is redder than the white of sRGB.
  read -r red _ blue < <(colour lit.exr)
  nearly "$(awk "BEGIN { print ($red > 1.2 * $blue) }")" 1 0
  for adapt in daylight daylight:cat16 daylight:vonkries daylight:bradford daylight:cat02; do
    read -r red green blue < <(colour --adapt $adapt lit.exr)
    nearly "$red" .33333 .0002
    nearly "$green" .33333 .0002
    nearly "$blue" .33333 .0002
  done
  # A coloured surface tells Bradford's from the others, and that other air is another light.
  specconvert -g 380:780:5 --extrapolate constant --patches 1x1 15-red --place '50.875N 4.75E' \
    --time 2005-05-17T12:00+02:00 | specconvert --illuminate daylight - -o red.exr
  for adapt in daylight daylight:bradford daylight:cat16 daylight,turbidity=9 daylight,turbidity=9:bradford; do
    spec2rgb --adapt $adapt red.exr -o "$adapt.exr"
  done
  answers() { layers --print 0,0 "$1.exr" | cut -d ' ' -f 2 | xargs; }
  [ "$(answers daylight)" = "$(answers daylight:bradford)" ]
  [ "$(answers daylight)" != "$(answers daylight:cat16)" ]
  [ "$(answers daylight)" != "$(answers daylight,turbidity=9)" ]
  [ "$(answers daylight,turbidity=9)" = "$(answers daylight,turbidity=9:bradford)" ]
  specconvert --illuminate daylight,turbidity=9 white.exr -o turbid.exr
  read -r red green blue < <(colour --adapt daylight,turbidity=9 turbid.exr)
  nearly "$red" .33333 .0002
  nearly "$green" .33333 .0002
  nearly "$blue" .33333 .0002
  # Under that light as the illuminant, reflectance has the same colour, and is adapted as ever.
  nearly "$(colour -e -1 --illuminant daylight white.exr | cut -d ' ' -f 1)" \
    "$(colour lit.exr | cut -d ' ' -f 1)" .0005
  nearly "$(colour -e -1 --illuminant daylight --adapt bradford white.exr | cut -d ' ' -f 1)" .33333 .0002
}

@test "spec2rgb adapts light from any light, and says where it has none to" {
  printf '%s\n' '# quantity: reflectance' '360 1' '830 1' >white.spd
  specconvert -g 360:830:5 --patches 1x1 white.spd -o white.exr
  for light in A blackbody:2700K daylight:5000K FL2; do
    specconvert --illuminate "$light" --extrapolate zero white.exr -o lit.exr
    for method in '' :vonkries :bradford :cat02 :cat16; do
      read -r red green blue < <(colour -e -7 --adapt "$light$method" lit.exr)
      nearly "$red" .33333 .0002
      nearly "$green" .33333 .0002
      nearly "$blue" .33333 .0002
    done
  done
  # A colour in that light is that of the surface under it, adapted so.
  specconvert -g 380:780:5 --patches 1x1 15-red -o red.exr
  specconvert --illuminate A red.exr | specconvert --scale .01 - -o lit.exr
  spec2rgb --illuminant A --adapt cat16 red.exr -o under.exr
  spec2rgb --adapt A:cat16 lit.exr -o lit-cat16.exr
  spec2rgb --adapt A lit.exr -o lit-bradford.exr
  ratios() { layers --print 0,0 "$1" | sort | awk '{ v[NR] = $2 } END { printf "%.3f %.3f\n", v[1] / v[2], v[3] / v[2] }'; }
  read -r a b < <(ratios under.exr)
  read -r c d < <(ratios lit-cat16.exr)
  nearly "$a" "$c" .001
  nearly "$b" "$d" .02
  read -r c d < <(ratios lit-bradford.exr)
  awk "BEGIN { exit !(($b - $d) ^ 2 > 1) }"
  spec2rgb lit.exr -o plain.png 2>said
  [ ! -s said ]
  spec2rgb --adapt cat16 lit.exr -o same.png 2>said
  [ "$(<said)" = 'spec2rgb: warning: lit.exr: light is adapted from a light alone, as by --adapt A:cat16' ]
  cmp plain.png same.png
  spec2rgb -q --adapt cat16 lit.exr -o same.png 2>said
  [ ! -s said ]
  trouble 'red.exr: A adapts light; reflectance is lit' spec2rgb --adapt A red.exr -o a.png
  trouble "outside 100..1e+06" spec2rgb --adapt blackbody:3K lit.exr -o a.png
  trouble "'blackbody:3000' is no light" spec2rgb --adapt blackbody:3000 lit.exr -o a.png
  trouble "unknown adaptation 'cat97'" spec2rgb --adapt A:cat97 lit.exr -o a.png
}

@test "light that cannot be adapted from its daylight" {
  white 2005-05-17T12:00+02:00
  trouble 'white.exr: daylight adapts light' spec2rgb --adapt daylight white.exr -o a.png
  trouble "unknown adaptation 'best'" spec2rgb --adapt daylight:best lit.exr -o a.png
  trouble "unknown adaptation 'best': expected none, vonkries, bradford, cat02 or cat16, or daylight or another light" \
    spec2rgb --adapt best lit.exr -o a.png
  specconvert --time 2005-05-17T23:00+02:00 lit.exr -o night.exr
  trouble 'degrees below the horizon' spec2rgb --adapt daylight night.exr -o a.png
  spectral nowhere.exr --grid 400:700:20
  trouble 'nowhere.exr: does not say where it was taken' spec2rgb --adapt daylight nowhere.exr -o a.png
  trouble 'nowhere.exr: does not say where it was taken' spec2rgb --illuminant daylight nowhere.exr -o a.png
  no_leftovers . lit.exr night.exr nowhere.exr white.exr white.spd
}
