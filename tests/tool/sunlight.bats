#!/usr/bin/env bats
# sunlight.bats - the light of a place and a time where a spectrum is named
load common

noon='50.88N 4.70E,2005-05-17T13:37+02:00'

# A grey and a white, two pixels.
make_card() {
  printf '%s\n' '# quantity: reflectance' '380 .18' '780 .18' >grey.spd
  printf '%s\n' '# quantity: reflectance' '380 .9' '780 .9' >white.spd
  specconvert --grid 380:780:10 --patches 2x1 grey.spd white.spd -o card.exr
}

# illuminance NAME: in lx, by V(lambda) and 1 nm.
illuminance() {
  specconvert --grid 360:830:1 "$1" |
    awk 'FNR == NR { if (/^[0-9]/) v[$1] = $2; next } /^[0-9]/ { sum += 683 * v[$1] * $2 } END { printf "%.0f\n", sum }' \
      "$ROOT/spectra/cmf/v-photopic.spd" -
}

@test "sun and sky add up to daylight" {
  [ "$(illuminance "daylight@$noon")" -gt 80000 ]
  [ "$(illuminance "daylight@$noon")" -lt 110000 ]
  specconvert --add "sky@$noon" "sun@$noon,tilt=0" -o sum.spd
  specconvert --divide "daylight@$noon" sum.spd | awk '/^[0-9]/ { n++; if ($2 < 1 - 1e-9 || $2 > 1 + 1e-9) exit 1 } END { exit n != 122 }'
  [ "$(specconvert "sky@$noon" | grep '^# unit')" = '# unit: W m-2 nm-1' ]
}

@test "every tool that takes a light takes it" {
  make_card
  specinfo "daylight@$noon" >said
  [[ $(<said) = *'the sun 58.54 degrees high'* ]]
  specconvert --illuminate "sky@$noon" card.exr -o lit.exr
  spec2rgb --illuminant "sun@$noon" card.exr -o seen.png
  specdiff --metric de2000 --illuminant "daylight@$noon" card.exr card.exr
  specconvert --multiply 15-red "daylight@$noon" -o red.spd
  cat >scene.pbrt <<END
LookAt 0 0 3  0 0 0  0 1 0
Camera "perspective" "float fov" 1
Film "rgb" "integer xresolution" 3 "integer yresolution" 3
WorldBegin
LightSource "distant" "spectrum L" "sun@$noon" "point3 from" [0 0 1] "point3 to" [0 0 0]
Material "diffuse" "float reflectance" 0.5
Shape "disk"
END
  specrender --grid 449:451:1 -n 1 scene.pbrt -o scene.exr
  specconvert --crop 1,1,2,2 scene.exr | specconvert -f spd | grep '^[0-9]' >got
  # A plane sends back its irradiance times reflectance over pi; means over 1 nm bend less than that.
  specconvert --grid 449:451:1 "sun@$noon" | grep '^[0-9]' | paste -d ' ' - got |
    awk '/^[0-9]/ { n++; if ($4 / $2 < .1590 || $4 / $2 > .1593) exit 1 } END { exit n != 3 }'
}

@test "blue sky, yellow sun: what the names stand for is seen in pixels" {
  make_card
  specconvert --illuminate "sky@$noon" card.exr | spec2rgb --exposure auto -f ppm | tail -c 3 | od -A n -t u1 >sky
  specconvert --illuminate "sun@$noon" card.exr | spec2rgb --exposure auto -f ppm | tail -c 3 | od -A n -t u1 >sun
  read -r red _ blue <sky
  [ "$blue" -gt "$red" ]
  read -r red _ blue <sun
  [ "$blue" -lt "$red" ]
}

@test "the night has no such light, and faults are pointed at" {
  fails_cleanly specconvert 'daylight@50.88N 4.70E,2005-05-17T23:00+02:00'
  [[ $stderr = *"the sun's centre is 11.58 degrees below the horizon"* ]]
  fails_cleanly specinfo 'sun@50.88N 4.70E,2005-05-17T23:00+02:00'
  fails_pointing 41 specconvert "sky@$noon,albdo=.2"
  [[ $stderr = *"'albdo' is none of"* ]]
  fails_pointing 5 specconvert 'sky@Leuven,2005-05-17T23:00Z'
}
