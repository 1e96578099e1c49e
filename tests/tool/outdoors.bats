#!/usr/bin/env bats
# specrender under the sun and the sky of a place and a time; what they are in numbers is
# tests/unit/outdoors.c.
# shellcheck disable=SC2154 # fails_cleanly leaves its line in stderr

load common

leuven='"string place" "50.88N 4.70E"'
noon='"string time" "2005-05-17T12:00:00+02:00"'
ground='AttributeBegin Translate 0 -1.5 0 Rotate -90 1 0 0 Shape "disk" "float radius" 50 AttributeEnd'
ball='AttributeBegin Translate 0 -.5 5 Shape "sphere" AttributeEnd'

# scene FILE CAMERA LINE...: of 12 x 8 pixels.
scene() {
  printf '%s\n' "$2" 'Film "rgb" "integer xresolution" 12 "integer yresolution" 8' \
    'Sampler "independent" "integer pixelsamples" 16' WorldBegin "${@:3}" >"$1"
}

render() {
  specrender --no-history --grid 400:700:100 "$@"
}

# level FILE X,Y BAND: a sample.
level() {
  "$TESTS/layers" --print "$2" "$1" | awk -v band="S0.$3,000000nm" '$1 == band { print $2 }'
}

# holds NUMBERS AWK: the condition holds for numbers a, b, c, d.
holds() {
  awk "{ a = \$1; b = \$2; c = \$3; d = \$4; exit !($2) }" <<<"$1" || complain "not $2: $1"
}

# as_good_as A B: but for the rounding of directions.
as_good_as() {
  specdiff -m rmse -t rmse=2e-4 "$1" "$2"
}

@test "sky above, ground below, the sun and the sky, scaled" {
  scene a.pbrt 'Camera "perspective" "float fov" 90' "LightSource \"daylight\" $leuven $noon" "$ground" "$ball"
  render a.pbrt -o a.exr
  # Blue above, and whiter at the horizon; the ground goes on behind the disk, with its albedo.
  holds "$(level a.exr 6,0 400) $(level a.exr 6,0 700) $(level a.exr 6,3 400) $(level a.exr 6,3 700)" 'a > 2 * b && c < 2 * d'
  holds "$(level a.exr 0,4 500) $(level a.exr 0,3 500)" 'a > 0 && a != b'
  render -j 3 a.pbrt -o b.exr
  cmp a.exr b.exr
  sed 's/"daylight"/& "bool sun" false/' a.pbrt >sky.pbrt
  render sky.pbrt -o sky.exr
  holds "$(level a.exr 0,7 600) $(level sky.exr 0,7 600)" 'a > 4 * b && b > 0'
  sed 's/"daylight"/& "float scale" 2/' a.pbrt >twice.pbrt
  render twice.pbrt -o twice.exr
  specconvert --scale 2 a.exr | specdiff -m rmse -t rmse=1e-6 - twice.exr
}

@test "turbid air is whiter, a snowy ground brighter" {
  camera='Camera "perspective" "float fov" 60'
  for turbidity in 2 8; do
    scene $turbidity.pbrt "$camera" "LightSource \"daylight\" $leuven $noon \"float turbidity\" $turbidity"
    render $turbidity.pbrt -o $turbidity.exr
  done
  holds "$(level 2.exr 6,0 400) $(level 2.exr 6,0 700) $(level 8.exr 6,0 400) $(level 8.exr 6,0 700)" 'a / b > 1.5 * c / d'
  for albedo in .1 .8; do
    scene $albedo.pbrt "$camera" "LightSource \"daylight\" $leuven $noon \"float albedo\" $albedo"
    render $albedo.pbrt -o $albedo.exr
  done
  # Eight times the albedo, and a sky that the ground makes brighter.
  holds "$(level .8.exr 6,7 500) $(level .1.exr 6,7 500)" 'a > 8 * b && a < 9.6 * b'
  holds "$(level .8.exr 6,0 500) $(level .1.exr 6,0 500)" 'a > b'
}

@test "the world's axes may be others: it is the same picture" {
  scene a.pbrt 'Camera "perspective" "float fov" 90' "LightSource \"daylight\" $leuven $noon" "$ground" "$ball"
  # z upwards and hands as most programs have them: x east, y north
  scene right.pbrt 'Scale -1 1 1 LookAt 0 0 0  0 1 0  0 0 1 Camera "perspective" "float fov" 90' \
    "LightSource \"daylight\" $leuven $noon \"vector3 up\" [ 0 0 1 ] \"vector3 north\" [ 0 1 0 ]" \
    'AttributeBegin Translate 0 0 -1.5 Shape "disk" "float radius" 50 AttributeEnd' \
    'AttributeBegin Translate 0 5 -.5 Shape "sphere" AttributeEnd'
  render -n 4096 a.pbrt -o a.exr
  render -n 4096 right.pbrt -o right.exr
  # The noise is another one where surfaces have other tangents.
  specdiff -m mae -t mae=.001 a.exr right.exr
  # The light's space turned by half: the sun comes from the other side.
  scene turned.pbrt 'Camera "perspective" "float fov" 90' AttributeBegin 'Rotate 180 0 1 0' \
    "LightSource \"daylight\" $leuven $noon" AttributeEnd "$ground" "$ball"
  render turned.pbrt -o turned.exr
  run specdiff -m mae -t mae=.01 a.exr turned.exr
  [ "$status" = 1 ]
}

@test "a camera looks towards another place" {
  lamp="LightSource \"daylight\" $leuven $noon"
  scene south.pbrt 'LookAt 0 0 0  0 0 -1  0 1 0 Camera "perspective"' "$lamp" "$ground"
  scene toward.pbrt "Camera \"perspective\" $leuven \"string toward\" \"40N 4.70E\"" "$lamp" "$ground"
  render south.pbrt -o south.exr
  render toward.pbrt -o toward.exr
  as_good_as south.exr toward.exr
  scene up.pbrt 'LookAt 0 0 0  0 1 -1  0 1 0 Camera "perspective"' "$lamp" "$ground"
  sed 's/"string toward"/"float elevation" 45 &/' toward.pbrt >raised.pbrt
  render up.pbrt -o up.exr
  render raised.pbrt -o raised.exr
  as_good_as up.exr raised.exr
  # From Leuven, Brussels is in the west, at 263 degrees.
  scene brussels.pbrt "Camera \"perspective\" $leuven \"string toward\" \"50.85N 4.35E\"" "$lamp" "$ground"
  scene west.pbrt 'LookAt 0 0 0  -.9907 0 -.1362  0 1 0 Camera "perspective"' "$lamp" "$ground"
  render brussels.pbrt -o brussels.exr
  render west.pbrt -o west.exr
  specdiff -m mae -t mae=.002 brussels.exr west.exr
  run specdiff -m mae -t mae=.002 brussels.exr south.exr
  [ "$status" = 1 ]
}

@test "the image says where and when, as the camera or else the light does" {
  scene a.pbrt '' "LightSource \"daylight\" $leuven $noon"
  render a.pbrt -o a.exr
  has_line a.exr 'latitude (type float): 50.88'
  has_line a.exr 'longitude (type float): 4.7'
  has_line a.exr 'capDate (type string): "2005:05:17 12:00:00"'
  has_line a.exr 'utcOffset (type float): -7200'
  [[ $(specinfo --sun own a.exr) = *'elevation 53.109'* ]] || complain "$(specinfo --sun own a.exr)"
  scene b.pbrt 'Camera "perspective" "string place" "10S 20W 99m" "string toward" "0N 0E"'
  render b.pbrt -o b.exr
  has_line b.exr 'latitude (type float): -10'
  has_line b.exr 'altitude (type float): 99'
  exrheader b.exr >header
  run ! grep capDate header
  scene d.pbrt 'Camera "perspective" "string place" "10S 20W 99m" "string toward" "0N 0E"' "LightSource \"daylight\" $leuven $noon"
  render d.pbrt -o d.exr
  has_line d.exr 'latitude (type float): -10'
  has_line d.exr 'capDate (type string): "2005:05:17 12:00:00"'
  scene c.pbrt ''
  render c.pbrt -o c.exr
  exrheader c.exr >header
  run ! grep -E 'latitude|utcOffset' header
}

@test "no sun, no place, no time" {
  for light in "$leuven" "$noon" "$leuven"' "string time" "2005-05-17T23:30:00+02:00"' "$leuven"' "string time" "2005-05-17T12:00:00"' \
    '"string place" "91N 0E" '"$noon" "$leuven $noon \"float turbidity\" .5" "$leuven $noon \"float albedo\" -1" \
    "$leuven $noon \"vector3 north\" [ 0 1 0 ]" "$leuven $noon \"string filename\" \"sky.exr\"" "$leuven $noon \"float power\" 3"; do
    scene a.pbrt '' "LightSource \"daylight\" $light"
    fails_cleanly specrender a.pbrt -o b.exr
    [[ $stderr = *"a.pbrt:5:"*'LightSource "daylight"'* ]] || complain "$stderr"
  done
  scene a.pbrt '' "LightSource \"daylight\" $leuven \"string time\" \"2005-05-17T23:30:00+02:00\""
  fails_cleanly specrender a.pbrt -o b.exr
  [[ $stderr = *"'time' of LightSource \"daylight\" is refused: at 50.88 N 4.7 E on 2005-05-17T23:30:00+02:00 the sun's centre is 14."*' degrees below the horizon, and the light of twilight and night is not known' ]] || complain "$stderr"
  scene a.pbrt '' "LightSource \"daylight\" $leuven $noon" 'LightSource "infinite" "float L" 1'
  fails_cleanly specrender a.pbrt -o b.exr
  [[ $stderr = *'a second infinite light cannot be rendered yet'* ]] || complain "$stderr"
  no_leftovers . a.pbrt
}
