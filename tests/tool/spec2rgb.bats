#!/usr/bin/env bats
# spec2rgb: the right colours, in every format, from every source, and no half a picture.
# shellcheck disable=SC2154 # fails_cleanly leaves its line in stderr

load common

# pixel FILE.ppm X Y: red, green and blue of a binary PPM, whose header has three lines.
pixel() {
  local width most header samples
  read -r width _ < <(sed -n 2p "$1" | tr -d '\0')
  most=$(sed -n 3p "$1" | tr -d '\0')
  header=$(head -n 3 "$1" | wc -c)
  samples=$((3 * ($3 * width + $2)))
  if [ "$most" = 255 ]; then
    tail -c +$((header + samples + 1)) "$1" | od -An -v -tu1 -N3
  else
    tail -c +$((header + 2 * samples + 1)) "$1" | od -An -v -tu2 --endian=big -N6
  fi | xargs
}

# is PIXEL FILE.ppm X Y
is() {
  local found
  found=$(pixel "$2" "$3" "$4")
  [ "$found" = "$1" ] || complain "$2 has $found at $3,$4, not $1"
}

# begins FILE HEX: its first bytes.
begins() {
  local found
  found=$(od -An -v -tx1 -N$((${#2} / 2)) "$1" | tr -d ' \n')
  [ "$found" = "$2" ] || complain "$1 begins with $found, not $2"
}

png=89504e470d0a1a0a

# quiet COMMAND...: it succeeds and says nothing on stderr.
quiet() {
  "$@" 2>quiet.err
  [ ! -s quiet.err ] || complain "$(cat quiet.err)"
  rm quiet.err
}

# Colours

@test "the perfect reflector under D65 is white" {
  spectral white.exr --kind T --grid 360:830:5 --pattern constant:1
  quiet spec2rgb white.exr -o white.ppm
  [ "$(head -c 12 white.ppm | head -n 3 | xargs)" = 'P6 16 8 255' ]
  [ "$(wc -c <white.ppm)" -eq $((12 + 16 * 8 * 3)) ]
  for y in 0 7; do
    is '255 255 255' white.ppm 0 $y
    is '255 255 255' white.ppm 15 $y
  done
}

@test "half the light is sRGB 188" {
  # 255 (1.055 * 0.5^(1/2.4) - 0.055) = 187.516. The white of D65's table is not quite
  # (0.3127, 0.3290), which takes 2 parts in 10000 from blue: 0.502, which is 187.86, has room.
  spectral grey.exr --kind T --grid 360:830:5 --pattern constant:0.502
  quiet spec2rgb grey.exr -o grey.ppm
  is '188 188 188' grey.ppm 3 2
}

@test "no light is black" {
  spectral black.exr --pattern constant:0
  quiet spec2rgb black.exr -o black.ppm
  is '0 0 0' black.ppm 3 2
}

@test "equal energy of radiance 1 is the sum of the rows of sRGB's matrix" {
  # X = Y = Z = 1: IEC 61966-2-1 has R = 3.2406 - 1.5372 - 0.4986 = 1.2048,
  # G = -0.9689 + 1.8758 + 0.0415 = 0.9484, B = 0.0557 - 0.2040 + 1.0570 = 0.9087. Encoded and
  # times 255: R is clipped, G 249.13. At half the light 203.79, 183.11, 179.63.
  spectral e.exr --grid 360:830:5 --pattern constant:1
  quiet spec2rgb e.exr -o e.ppm
  [[ $(pixel e.ppm 0 0) = '255 249 24'[45] ]] || complain "$(pixel e.ppm 0 0)"
  spectral half.exr --grid 360:830:5 --pattern constant:0.5
  quiet spec2rgb half.exr -o half.ppm
  is '204 183 180' half.ppm 0 0
}

@test "light has its luminance whatever the step of the grid" {
  for step in 1 2 5 10; do
    spectral e.exr --grid 360:830:$step --pattern constant:0.5
    quiet spec2rgb e.exr -o e.ppm
    is '204 183 180' e.ppm 0 0
  done
}

@test "a band mean is integrated over its bin" {
  spectral e.exr --grid 365:825:10 --bins --pattern constant:0.5
  quiet spec2rgb e.exr -o e.ppm
  is '204 183 180' e.ppm 0 0
}

@test "radiance per band is not multiplied by the step again" {
  # 95 bands of 5 nm with 2.5 each: 0.5 per nm; the ends count half a step more than 360..830.
  spectral e.exr --grid 360:830:5 --pattern constant:2.5 --quantity 'radiance per band'
  quiet spec2rgb e.exr -o e.ppm
  is '204 183 180' e.ppm 0 0
}

@test "a pixel has the place it had" {
  # red at 2,1 alone: the ramp is black elsewhere by a NaN's picture; 620 nm is band 11
  spectral spot.exr --pattern constant:0 --pattern inf:2,1,11
  spec2rgb -q spot.exr -o spot.ppm
  is '0 0 0' spot.ppm 1 1
  is '0 0 0' spot.ppm 2 0
  [ "$(pixel spot.ppm 2 1)" != '0 0 0' ]
}

@test "the data window's bands of S0 are what is shown, and nothing beside them" {
  spectral plain.exr
  spectral moved.exr --data 3,-5 --display 0,0,40,40 --extra A --extra R --extra preview.X --number EV=3
  speccomp --expr 'a' plain.exr -o s0.exr
  spectral four.exr --kind stokes
  speccomp --expr 'stokes == 0 ? 0.001 * (x + 1) + 0.01 * y + 0.1 * (nm - 400) / 20 : 7' four.exr -o stokes.exr
  speccomp --expr '0.001 * (x + 1) + 0.01 * y + 0.1 * (nm - 400) / 20' plain.exr -o s0.exr
  for look in '' '-e auto' '--lod 2'; do
    # shellcheck disable=SC2086 # several words or none
    for image in plain moved stokes s0; do spec2rgb $look $image.exr -o $image.ppm; done
    cmp plain.ppm moved.ppm
    cmp s0.ppm stokes.ppm
  done
  spec2rgb --model hsv plain.exr -o plain.hsv.exr
  spec2rgb --model hsv moved.exr -o moved.hsv.exr
  exrheader moved.hsv.exr | grep -A1 '^dataWindow' | xargs | grep -qF '(3 -5) - (18 2)' || complain "$(exrheader moved.hsv.exr)"
  cmp <(layers --print 5,2 plain.hsv.exr) <(layers --print 5,2 moved.hsv.exr)
}

@test "light takes no illuminant, and values per band are no reflectance" {
  spectral light.exr
  spec2rgb light.exr -o plain.ppm
  spec2rgb --illuminant A light.exr -o a.ppm
  cmp plain.ppm a.ppm
  for adapt in vonkries bradford cat02 cat16; do
    spec2rgb --illuminant A --adapt $adapt light.exr -o a.ppm
    cmp plain.ppm a.ppm
  done
  spectral each.exr --kind T --quantity 'reflectance per band'
  fails_cleanly spec2rgb each.exr -o x.png
  [[ $stderr = *'each.exr: values per band are light already and take no illuminant' ]]
}

@test "an illuminant is linear between its samples and zero outside its data" {
  spectral white.exr --kind T --grid 360:830:1 --pattern constant:1
  spectral blue.exr --kind T --grid 360:499:1 --pattern constant:1
  printf '%s\n' '# quantity: spectral power distribution' '500 1' '600 3' >short.spd
  # The same by 1 nm, and zero written out.
  { echo '# quantity: spectral power distribution'; seq 360 499 | sed 's/$/ 0/'
    seq 500 600 | awk '{ print $1, 1 + ($1 - 500) / 50 }'; seq 601 830 | sed 's/$/ 0/'; } >long.spd
  [ "$(xyz_of white.exr -q --illuminant short.spd)" = "$(xyz_of white.exr -q --illuminant long.spd)" ]
  [ "$(xyz_of blue.exr -q --illuminant short.spd)" = '0 0 0' ]
}

@test "--observer 1964 sees another picture than 1931" {
  spectral ramp.exr
  spec2rgb ramp.exr -o default.ppm
  spec2rgb --observer 1931 ramp.exr -o 1931.ppm
  spec2rgb --observer 1964 ramp.exr -o 1964.ppm
  cmp default.ppm 1931.ppm
  run ! cmp -s 1931.ppm 1964.ppm
}

@test "--observer takes a table of one's own" {
  spectral ramp.exr
  spec2rgb --observer 1931 ramp.exr -o name.ppm
  spec2rgb --observer "$ROOT/spectra/cmf/cie1931.spd" ramp.exr -o path.ppm
  cmp name.ppm path.ppm
}

# A camera: the sensitivities of three sensors that have one shape, as high as the arguments, with
# a row at each further argument and the corners.
camera() {
  local red=$1 green=$2 blue=$3
  shift 3
  printf '%s\n' 430 500 600 660 "$@" | sort -nu |
    awk -v r="$red" -v g="$green" -v b="$blue" 'BEGIN { print "# columns: wavelength_nm r g b" }
      { v = $1 < 500 ? ($1 - 430) / 70 : $1 > 600 ? (660 - $1) / 60 : 1; printf "%s %.17g %.17g %.17g\n", $1, r * v, g * v, b * v }'
}

# xyz_of FILE OPTION...: X, Y and Z of the first pixel.
xyz_of() {
  spec2rgb --space xyz "${@:2}" "$1" -o xyz_of.exr
  "$TESTS/layers" --print 0,0 xyz_of.exr | awk '{ print $2 }' | xargs
}

@test "bispectral images under any light, with their fluorescence" {
  local plain=() light
  for nm in {400..700..10}; do
    plain+=(--channel "T.$nm,000000nm")
  done
  # 410 nm come back at 550 nm, too, and 500 nm at 600 nm: 0.3 of each.
  spectral glow.exr --size 2x1 "${plain[@]}" --channel T.410,000000nm.550,000000nm \
    --channel T.500,000000nm.600,000000nm --pattern constant:0.3
  spectral grey.exr --size 2x1 "${plain[@]}" --pattern constant:0.3
  spectral white.exr --size 2x1 "${plain[@]}" --pattern constant:1
  # Linear between the bands, so that the sums of both ways are the same.
  printf '%s\n' '# quantity: spectral power distribution' '380 0' '400 0' '410 2' '420 0' '780 0' >violet.spd
  printf '%s\n' '# quantity: spectral power distribution' '380 1' '780 3' >slope.spd
  for light in violet slope; do
    # The light that the image sends back, seen as light; Y = 1 is the perfect reflector's.
    for image in glow grey white; do
      specconvert --illuminate $light.spd $image.exr -o lit.exr
      echo "$(xyz_of $image.exr --illuminant $light.spd) $(xyz_of lit.exr)"
    done >$light.txt
    awk -v light=$light '
      { for (i = 1; i <= 6; i++) v[NR, i] = $i }
      END {
        unit = v[3, 5] / v[3, 2]
        for (line = 1; line <= 3; line++) for (i = 1; i <= 3; i++) {
          off = v[line, i + 3] / unit / v[line, i] - 1
          if (off * off > 1e-10) { print light, line, i, off; bad = 1 }
        }
        # 550 nm have x = .30; and the less there is to glow by, the less it glows.
        glow = (v[1, 2] - v[2, 2]) / v[2, 2]
        x = (v[1, 1] - v[2, 1]) / (v[1, 1] + v[1, 2] + v[1, 3] - v[2, 1] - v[2, 2] - v[2, 3])
        print light, "glows", glow, "times, x =", x
        if (light == "violet" && !(glow > 300 && x > .29 && x < .31)) bad = 1
        if (light == "slope" && !(glow > .05 && glow < .2)) bad = 1
        exit bad
      }' $light.txt >said || complain "$(cat said)"
  done
  # In the picture: violet light makes grey a dark violet, and what glows a green.
  spec2rgb -e -8 --illuminant violet.spd glow.exr -o glow.ppm
  spec2rgb -e -8 --illuminant violet.spd grey.exr -o grey.ppm
  read -r red green blue < <(pixel glow.ppm 0 0)
  ((green > red && green > blue)) || complain "$red $green $blue"
  read -r red green blue < <(pixel grey.ppm 0 0)
  ((blue > red && blue > green)) || complain "$red $green $blue"
}

@test "reflective images under any light: the product with it, seen as light" {
  spectral paint.exr --kind T --size 2x1 --grid 400:700:5
  for light in A F11 HP1 blackbody:2000K daylight:9000K; do
    specconvert --illuminate $light paint.exr -o lit.exr
    spectral white.exr --kind T --size 2x1 --grid 400:700:5 --pattern constant:1
    specconvert --illuminate $light white.exr -o source.exr
    # Between bands of 5 nm the lines of lamps are not quite those of their tables.
    echo "$(xyz_of paint.exr --illuminant $light) $(xyz_of white.exr --illuminant $light) $(xyz_of lit.exr) $(xyz_of source.exr)" |
      awk '{ for (i = 1; i <= 3; i++) { off = ($(i + 6) / $(i + 9)) / ($i / $(i + 3)) - 1; if (off * off > 1e-4) { print i, off; bad = 1 } } } END { exit bad }' ||
      complain $light
  done
}

@test "lights by formula: daylight and black bodies" {
  spectral white.exr --kind T --grid 360:830:5 --pattern constant:0.5
  spec2rgb --illuminant D65 white.exr -o table.ppm
  spec2rgb --illuminant daylight:6503.616K white.exr -o formula.ppm
  cmp table.ppm formula.ppm
  spec2rgb --illuminant A white.exr -o table.ppm
  spec2rgb --illuminant blackbody:2855.496K white.exr -o formula.ppm
  cmp table.ppm formula.ppm
  # The same curve in every tool that takes a light.
  specconvert blackbody:3000K >3000.spd
  specconvert --illuminate blackbody:3000K white.exr -o a.exr
  specconvert --illuminate 3000.spd white.exr -o b.exr
  specdiff --metric max --tolerance max=0 a.exr b.exr
  fails_cleanly spec2rgb --illuminant daylight:3000K white.exr -o no.ppm
  [[ $stderr = *"outside 4000..25000: '3000'" ]]
  fails_cleanly spec2rgb --illuminant daylight:6504 white.exr -o no.ppm
  [[ $stderr = *"as in daylight:6504K" ]]
  [ ! -e no.ppm ]
}

@test "--observer takes a camera's curves, and gives their signals raw" {
  spectral half.exr --kind T --grid 400:700:10 --pattern constant:0.5
  # shellcheck disable=SC2046
  camera 2 1 0.5 $(seq 430 10 660) >regular.spd
  camera 2 1 0.5 437.5 >unequal.spd
  spec2rgb --observer regular.spd half.exr -o a.exr
  spec2rgb --observer unequal.spd half.exr -o b.exr
  # The perfect reflector has a green of 1 under any light.
  spec2rgb --observer unequal.spd --illuminant A half.exr -o c.exr
  for file in a b c; do
    layers --print 0,0 $file.exr | sort | paste -sd ' ' >$file.txt
    awk '{ exit !(($2 - .25) ^ 2 < 1e-13 && ($4 - .5) ^ 2 < 1e-13 && ($6 - 1) ^ 2 < 1e-13) }' $file.txt ||
      complain "$(<$file.txt)"
  done
  fails_cleanly spec2rgb --observer unequal.spd --adapt bradford half.exr -o d.png
  [[ $stderr = *"no X, Y and Z"* ]]
}

@test "--observer: unequal steps become those of 1 nm" {
  spectral ramp.exr
  # shellcheck disable=SC2046
  camera 2 1 0.5 $(seq 430 660) >regular.spd
  camera 2 1 0.5 437.5 >unequal.spd
  for curve in regular unequal; do
    spec2rgb --observer $curve.spd ramp.exr -o $curve.exr
    layers --print 7,3 $curve.exr | sort | awk '{ print $2 }' | paste -sd ' ' >$curve.txt
  done
  read -r b g r <regular.txt
  awk -v r="$r" -v g="$g" -v b="$b" '{ exit !(r > 0.1 && ($1 / b - 1) ^ 2 < 1e-12 && ($2 / g - 1) ^ 2 < 1e-12 && ($3 / r - 1) ^ 2 < 1e-12) }' unequal.txt ||
    complain "$(<unequal.txt) instead of $(<regular.txt)"
}

@test "signals of sensors are of no space, and their curve is called by its file" {
  spectral half.exr --kind T --grid 400:700:10 --pattern constant:0.5
  printf '%s\n' wavelength,red,green,blue 400,0,0,1 500,0,1,0 600,1,0,0 >camera.csv
  printf '%s\n' '# quantity: spectral sensitivity' '400 0' '500 1' '600 0' >grey.csv
  printf '%s\n' '400 1' '700 2' >lamp.csv
  spec2rgb -v --observer camera.csv --illuminant lamp.csv half.exr -o raw.exr 2>said
  grep -q '; observer camera.csv, by 100 nm; illuminant lamp.csv; ' said
  exrheader raw.exr | { run ! grep chromaticities; }
  spec2rgb --observer camera.csv half.exr -o raw.png
  [ -z "$(chunk raw.png sRGB)$(chunk raw.png gAMA)$(chunk raw.png cHRM)$(chunk raw.png iCCP)" ]
  spec2rgb --observer camera.csv --space p3 half.exr -o raw.ppm 2>said
  [ ! -s said ]
  spec2rgb --observer grey.csv half.exr -o grey.exr
  exrheader grey.exr | grep -q chromaticities
  spec2rgb --observer grey.csv half.exr -o grey.png
  [ -n "$(chunk grey.png sRGB)" ]
}

@test "--observer v-scotopic sees greys, cie2006-lms-2 its cones" {
  spectral ramp.exr
  spec2rgb --observer v-scotopic ramp.exr -o night.exr
  layers --print 0,0 night.exr | awk '{ v[NR] = $2 } END { exit !(NR == 3 && v[1] > 0 && v[1] == v[2] && v[2] == v[3]) }'
  # CIE 170-2:2015: X, Y, Z are sums of L, M, S by this matrix, to the digits of the tables.
  spec2rgb --observer cie2006-lms-2 ramp.exr -o lms.exr
  spec2rgb --observer 2015-2 ramp.exr -o 2015.exr
  printf '# columns: wavelength_nm r g b\n' >xyz.spd
  grep '^[0-9]' "$ROOT/spectra/cmf/cie2015-2.spd" >>xyz.spd
  spec2rgb --observer xyz.spd ramp.exr -o xyz.exr
  paste -d ' ' <(layers --print 0,0 lms.exr | sort | cut -d ' ' -f 2 | paste -sd ' ') \
    <(layers --print 0,0 xyz.exr | sort | cut -d ' ' -f 2 | paste -sd ' ') |
    awk '{ s = $1; m = $2; l = $3
      # Ratios, since what the signals are relative to is not the same: the second sum.
      x = 1.94735469 * l - 1.41445123 * m + 0.36476327 * s
      y = 0.68990272 * l + 0.34832189 * m
      z = 1.93485343 * s
      exit !((x / y - $6 / $5) ^ 2 < 1e-8 && (z / y - $4 / $5) ^ 2 < 1e-8) }'
}

@test "--observer: columns without names are x, y and z; a sensitivity gives greys" {
  spectral ramp.exr
  grep '^[0-9]' "$ROOT/spectra/cmf/cie1931.spd" >bare.spd
  spec2rgb ramp.exr -o 1931.ppm
  spec2rgb --observer bare.spd ramp.exr -o bare.ppm
  cmp 1931.ppm bare.ppm
  printf '%s\n' '# quantity: spectral sensitivity' '400 0' '550 1' '700 0' >film.spd
  spec2rgb --observer film.spd ramp.exr -o film.exr
  layers --print 3,2 film.exr | awk '{ v[NR] = $2 } END { exit !(NR == 3 && v[1] > 0 && v[1] == v[2] && v[2] == v[3]) }'
  sed '1s/sensitivity/radiance/' film.spd >other.spd
  fails_cleanly spec2rgb --observer other.spd ramp.exr -o x.png
}

@test "--observer refuses what is none" {
  spectral a.exr
  fails_cleanly spec2rgb --observer D65 a.exr -o a.png
  [[ $stderr = *"'D65' is no observer"* ]]
  fails_cleanly spec2rgb --observer Au a.exr -o a.png
  printf '%s\n' '550 1 1 1' >one.spd
  fails_cleanly spec2rgb --observer one.spd a.exr -o a.png
  [[ $stderr = *"one wavelength alone"* ]]
  printf '%s\n' '550 1 1 1' '551 1 1 1' '1e300 1 1 1' >wide.spd
  fails_cleanly spec2rgb --observer wide.spd a.exr -o a.png
  [[ $stderr = *"unequal steps"* ]]
  fails_cleanly spec2rgb --observer v-phot a.exr -o a.png
  [[ $stderr = *"did you mean 'v-photopic'"* ]]
}

@test "--illuminant A is warmer than D65" {
  spectral white.exr --kind T --grid 360:830:5 --pattern constant:0.5
  spec2rgb --illuminant A white.exr -o a.ppm
  read -r red green blue < <(pixel a.ppm 0 0)
  [ "$red" -gt 188 ]
  [ "$green" -lt 188 ]
  [ "$blue" -lt 100 ]
}

@test "--adapt makes a white of every illuminant's white" {
  spectral white.exr --kind T --grid 360:830:5 --pattern constant:0.5
  for adapt in vonkries bradford cat02 cat16; do
    quiet spec2rgb --illuminant A --adapt $adapt white.exr -o $adapt.ppm
    is '188 188 188' $adapt.ppm 0 0
  done
}

@test "--exposure 1 doubles, and so does twice the light" {
  spectral one.exr --pattern constant:0.2
  spectral two.exr --pattern constant:0.4
  spec2rgb --exposure 1 one.exr -o one.ppm
  spec2rgb two.exr -o two.ppm
  cmp one.ppm two.ppm
  spec2rgb -e -1 two.exr -o half.ppm
  spec2rgb one.exr -o plain.ppm
  cmp half.ppm plain.ppm
}

@test "--bits 16 holds finer steps" {
  # 65535 (1.055 * 0.5^(1/2.4) - 0.055) = 48191.7; a white of D65's table is off by 1e-4 at most
  spectral grey.exr --kind T --grid 360:830:5 --pattern constant:0.5
  spec2rgb --bits 16 grey.exr -o grey.ppm
  [ "$(sed -n 3p grey.ppm | tr -d '\0')" = 65535 ]
  for channel in $(pixel grey.ppm 0 0); do
    [ "$channel" -ge 48180 ]
    [ "$channel" -le 48203 ]
  done
  spec2rgb --bits 16 grey.exr -o grey.png
  begins <(tail -c +25 grey.png) 10 # the depth in IHDR
}

@test "an OpenEXR picture is linear and not clipped" {
  # Twice the light is twice the sample, exactly: the picture of 2^3 times the light of one
  # image is, bit for bit, that of another with 8 times the radiance.
  spectral dark.exr --grid 360:830:5 --pattern constant:0.5
  spectral bright.exr --grid 360:830:5 --pattern constant:4
  spec2rgb --exposure 3 dark.exr -o dark.rgb.exr
  spec2rgb bright.exr -o bright.rgb.exr
  specdiff --metric max dark.rgb.exr bright.rgb.exr
  # R, whose last sample is the file's last, is 4 times 1.2048, the sum of its row in sRGB's
  # matrix of four decimals; the observer's sums are equal to 2e-4.
  specconvert --compression none bright.rgb.exr -o plain.exr
  tail -c 4 plain.exr | od -An -tf4 | awk '{ exit !($1 > 4.8175 && $1 < 4.8210) }'
  exrheader bright.rgb.exr | grep -q ' R, 32-bit'
}

@test "NaN, infinity and negative light: one warning, and a picture" {
  spectral odd.exr --pattern nan:2,3,4 --pattern inf:5,6,7
  spec2rgb odd.exr -o odd.ppm 2>err
  [ "$(wc -l <err)" -eq 1 ]
  [[ $(cat err) = 'spec2rgb: warning: odd.exr: 2 pixels are not finite, the first at 2,3' ]] || complain "$(cat err)"
  is '0 0 0' odd.ppm 2 3
  spectral negative.exr --pattern negative
  quiet spec2rgb negative.exr -o negative.ppm
  is '0 0 0' negative.ppm 15 7
}

@test "more than 1 % of the luminance outside the bands is worth a warning" {
  spectral narrow.exr --grid 500:600:10
  spec2rgb narrow.exr -o narrow.png 2>err
  [ "$(wc -l <err)" -eq 1 ]
  [[ $(cat err) =~ ^'spec2rgb: warning: narrow.exr: '[0-9.]+' % of the luminance lies outside its bands'$ ]] ||
    complain "$(cat err)"
}

@test "less than 1 % of the luminance outside the bands is not" {
  spectral wide.exr --grid 400:700:20
  quiet spec2rgb wide.exr -o wide.png
}

@test "-q silences the warnings" {
  spectral odd.exr --grid 500:600:10 --pattern nan:2,3,4
  quiet spec2rgb -q odd.exr -o odd.png
  begins odd.png $png
}

# Formats and places

@test "a file, standard input and '-' give the same PNG on standard output" {
  spectral a.exr
  spec2rgb a.exr >file.png
  spec2rgb <a.exr >redirected.png
  spec2rgb - < <(cat a.exr) >piped.png
  begins file.png $png
  cmp file.png redirected.png
  cmp file.png piped.png
}

@test "-o and standard output hold the same PNG" {
  spectral a.exr
  spec2rgb a.exr -o file.png
  spec2rgb a.exr | cat >piped.png
  cmp file.png piped.png
}

@test "every suffix has its format" {
  spectral a.exr
  for pair in png:$png PNG:$png ppm:50360a pnm:50360a exr:762f3101 jpg:ffd8ff tif:49492a00 bmp:424d hdr:233f; do
    quiet spec2rgb a.exr -o "out.${pair%%:*}"
    begins "out.${pair%%:*}" "${pair#*:}"
  done
}

@test "an unknown suffix, or none, is refused before anything is written" {
  spectral a.exr
  fails_cleanly spec2rgb a.exr -o a.nothing
  [[ $stderr = *nothing* ]]
  fails_cleanly spec2rgb a.exr -o nosuffix
  no_leftovers . a.exr
}

@test "a missing plugin is told, and hurts no native format" {
  mkdir bin
  cp "$BIN/spec2rgb" bin/
  ln -s "$ROOT/spectra" spectra
  spectral a.exr
  export SPECTRA_PATH=$PWD/spectra
  for suffix in png ppm pnm exr; do quiet bin/spec2rgb a.exr -o b.$suffix; done
  for suffix in jpg tif hdr bmp; do fails_cleanly bin/spec2rgb a.exr -o c.$suffix; done
  no_leftovers . a.exr b.png b.ppm b.pnm b.exr bin spectra
}

@test "bits that a format cannot hold are refused" {
  spectral a.exr
  fails_cleanly spec2rgb --bits 32 a.exr -o a.png
  fails_cleanly spec2rgb --bits 16 a.exr -o a.jpg
  fails_cleanly spec2rgb --bits 12 a.exr -o a.png
  no_leftovers . a.exr
}

@test "a terminal as output is refused" {
  spectral a.exr
  shuns_terminal 'spec2rgb a.exr'
}

@test "--bits: what each format holds" {
  spectral image.exr
  while read -r suffix held refused; do
    for bits in ${held//,/ }; do spec2rgb --bits "$bits" image.exr -o "a.$suffix"; done
    for bits in ${refused//,/ }; do fails_cleanly spec2rgb --bits "$bits" image.exr -o "x.$suffix"; done
    [ ! -e "x.$suffix" ]
  done <<'END'
png 8,16 32
ppm 8,16 32
exr 32,16 8
tif 8,16,32 24
tiff 8,16,32 12
hdr 32 8,16
rgbe 32 8,16
bmp 8 16,32
END
  exrheader a.exr | grep -q ' R, 16-bit floating-point'
}

@test "a folder that is not there" {
  spectral a.exr
  fails_cleanly spec2rgb a.exr -o missing/a.png
  [[ $stderr = *missing/a.png* ]]
}

@test "a folder as output" {
  spectral a.exr
  mkdir folder.png
  fails_cleanly spec2rgb a.exr -o folder.png
}

@test "a full device fails in every format" {
  spectral a.exr --size 64x64
  for suffix in png ppm exr jpg tif; do
    ln -s /dev/full full.$suffix
    fails_cleanly spec2rgb a.exr -o full.$suffix
    [[ $stderr = *'No space left on device' ]] || complain "$suffix: $stderr"
    [ -L full.$suffix ]
  done
}

@test "a full standard output fails" {
  spectral a.exr
  code=0
  spec2rgb a.exr >/dev/full 2>err || code=$?
  [ "$code" -eq 2 ]
  [ "$(wc -l <err)" -eq 1 ]
}

@test "a failed run leaves the old picture as it was, and nothing else" {
  spectral a.exr --size 64x64
  head -c 20000 a.exr >short.exr
  for suffix in png ppm exr jpg; do
    echo old >out.$suffix
    fails_cleanly spec2rgb short.exr -o out.$suffix
    [ "$(cat out.$suffix)" = old ]
  done
  no_leftovers . a.exr short.exr out.png out.ppm out.exr out.jpg
}

@test "a failed run makes no new picture" {
  spectral a.exr --size 64x64
  head -c 20000 a.exr >short.exr
  for suffix in png ppm exr jpg; do
    fails_cleanly spec2rgb short.exr -o out.$suffix
  done
  no_leftovers . a.exr short.exr
}

@test "a failed run leaves no half a file on standard output" {
  spectral a.exr --size 64x64
  head -c 20000 a.exr >short.exr
  run ! spec2rgb short.exr >out.png
  [ ! -s out.png ]
}

@test "a symbolic link as output stays one, and its target is replaced" {
  spectral a.exr
  mkdir real
  echo old >real/a.png
  ln -s real/a.png link.png
  spec2rgb a.exr -o link.png
  [ -L link.png ]
  begins real/a.png $png
  no_leftovers real a.png
}

@test "a link to nothing as output: its target is made" {
  spectral a.exr
  ln -s target.png link.png
  spec2rgb a.exr -o link.png
  [ -L link.png ]
  begins target.png $png
}

@test "a replaced picture keeps its permissions, a new one obeys umask" {
  spectral a.exr
  echo old >old.png
  chmod 604 old.png
  umask 027
  spec2rgb a.exr -o old.png
  spec2rgb a.exr -o new.png
  [ "$(stat -c %a old.png)" = 604 ]
  [ "$(stat -c %a new.png)" = 640 ]
}

@test "every number of threads makes the same picture" {
  spectral a.exr --size 61x67 --pattern grain
  for suffix in png ppm exr; do
    spec2rgb -j 1 a.exr -o one.$suffix
    for threads in 2 3; do
      spec2rgb -j $threads a.exr -o more.$suffix
      cmp one.$suffix more.$suffix
    done
  done
  for look in '-e auto' '-e auto:70%' '--gamut scale -e 1' '--gamut scale -e auto:90% --dither' '--gamut perceptual -e 1'; do
    # shellcheck disable=SC2086 # several words
    for threads in 1 2 3; do spec2rgb $look -j $threads a.exr -o look$threads.ppm; done
    cmp look1.ppm look2.ppm
    cmp look1.ppm look3.ppm
  done
}

# What cannot be shown

@test "an image without bands" {
  spectral rgb.exr --channel R --channel G --channel B
  fails_cleanly spec2rgb rgb.exr -o rgb.png
  [ "$stderr" = 'spec2rgb: rgb.exr: has no spectral channel' ]
}

@test "a single band has no width, unless it is a bin" {
  spectral point.exr --channel S0.550nm
  fails_cleanly spec2rgb point.exr -o point.png
  spectral bin.exr --channel S0.550nm --attribute 'spec:bins=545 555'
  spec2rgb -q bin.exr -o bin.png
  begins bin.png $png
}

@test "bands that nobody sees" {
  spectral infrared.exr --grid 1000:1100:50
  fails_cleanly spec2rgb infrared.exr -o infrared.png
}

@test "each limit is refused by name" {
  spectral a.exr
  for limit in pixels=127 channels=15 header=500 memory=1k; do
    fails_cleanly spec2rgb --limit $limit a.exr -o a.png
    [[ $stderr = *"--limit ${limit%=*}="* ]] || complain "$limit: $stderr"
  done
  spec2rgb --limit pixels=128 --limit channels=16 a.exr -o a.png
}

@test "wrong values of options are refused, and the option is told" {
  spectral a.exr
  fails_cleanly spec2rgb --exposure 1x a.exr -o a.png
  [[ $stderr = *exposure* ]]
  for value in nan 100.1 -101; do fails_cleanly spec2rgb --exposure $value a.exr -o a.png; done
  fails_cleanly spec2rgb --bits eight a.exr -o a.png
  fails_cleanly spec2rgb --observer 1932 a.exr -o a.png
  [[ $stderr = *1932* ]]
  fails_cleanly spec2rgb --illuminant D66 a.exr -o a.png
  [[ $stderr = *D66* ]]
  fails_cleanly spec2rgb --adapt wrong a.exr -o a.png
  fails_cleanly spec2rgb --threads 0 a.exr -o a.png
  fails_cleanly spec2rgb --limit pixels a.exr -o a.png
  fails_cleanly spec2rgb --limit colours=3 a.exr -o a.png
  fails_cleanly spec2rgb --exposure
  no_leftovers . a.exr
}

@test "two images are one too many" {
  spectral a.exr
  fails_cleanly spec2rgb a.exr a.exr
}

@test "--help, --version and options that are not there" {
  [[ $(spec2rgb --help) = 'usage: spec2rgb [OPTION]... [FILE]'* ]]
  [[ $(spec2rgb -V) =~ ^spec2rgb\ \(spectools\)\ [0-9.]+$ ]]
  fails_cleanly spec2rgb --exposre 1
  [[ $stderr = *"did you mean '--exposure'?" ]]
  fails_cleanly spec2rgb -x
  fails_cleanly spec2rgb --quiet=1
}

@test "--format without a suffix, on a pipe too" {
  spectral a.exr
  spec2rgb a.exr -o a.ppm
  spec2rgb -f ppm a.exr | cmp - a.ppm
  spec2rgb --format ppm a.exr -o /dev/stdout | cmp - a.ppm
  run -2 spec2rgb --format nothing a.exr -o b.png
  [ "$output" = "spec2rgb: unable to write 'b.png': no picture format for '.nothing'" ]
  fails_cleanly spec2rgb -f nothing a.exr -o b
}

@test "only light lights" {
  spectral a.exr --kind T
  for name in Au cie1931 15-red; do
    fails_cleanly spec2rgb --illuminant "$name" a.exr -o a.png
  done
  no_leftovers . a.exr
}

@test "progress shows bar, rate and time left when it is asked for, and not otherwise" {
  spectral a.exr --size 16x64
  spec2rgb --progress a.exr -o a.png 2>said
  grep -q '\] 100%.* lines/s .* s left' said || complain "$(cat said)"
  spec2rgb a.exr -o a.png 2>said
  [ ! -s said ]
  spec2rgb -q --progress a.exr -o a.png 2>said
  [ ! -s said ]
}

# Red and green over blue and white, as light of three bands under an observer of three steps.
four() {
  printf '%s\n' '# quantity: spectral power distribution' '# columns: wavelength_nm a b c d' \
    '400 0 0 0 0' '450 0 0 1 1' '500 0 0 1 1' '550 0 1 0 1' '600 0 1 0 1' '650 1 0 0 1' '700 1 0 0 1' '750 0 0 0 0' >four.spd
  specconvert four.spd --patches 2x2 -o four.exr
}

@test "--model: a colour's components as channels of floats" {
  local linear
  four
  spec2rgb four.exr -o rgb.exr
  spec2rgb --model hsv four.exr -o hsv.exr
  spec2rgb --model hsl four.exr -o hsl.exr
  spec2rgb --model yuv four.exr -o yuv.exr
  spec2rgb --model cmyk -j 1 four.exr | cat >cmyk.exr
  has_channels hsv.exr H S V
  has_channels hsl.exr H L S
  has_channels yuv.exr U V Y
  has_channels cmyk.exr C K M Y
  for at in 0,0 1,0 0,1 1,1; do
    linear=$(layers --print $at rgb.exr)
    # The definitions, from the codes of sRGB, clipped.
    {
      echo "$linear"
      echo hsv; layers --print $at hsv.exr
      echo hsl; layers --print $at hsl.exr
      echo yuv; layers --print $at yuv.exr
      echo cmyk; layers --print $at cmyk.exr
    } | awk '
      function code(v) {
        v = v < 0 ? 0 : v > 1 ? 1 : v
        return v <= 0.0031308 ? 12.92 * v : 1.055 * exp(log(v) / 2.4) - 0.055
      }
      function off(a, b) { if (a - b > 2e-6 || b - a > 2e-6) { print model, a, b; bad = 1 } seen++ }
      NF == 1 { model = $1; next }
      { of[model $1] = $2 }
      END {
        r = code(of["R"]); g = code(of["G"]); b = code(of["B"])
        most = r > g ? r : g; most = most > b ? most : b
        least = r < g ? r : g; least = least < b ? least : b
        off(of["hsvV"], most); off(of["hsvS"], (most - least) / most)
        off(of["hslL"], (most + least) / 2)
        h = most == r ? (g - b) / (most - least) : most == g ? 2 + (b - r) / (most - least) : 4 + (r - g) / (most - least)
        h = h < 0 ? 60 * h + 360 : 60 * h
        off(of["hsvH"] / 360, h / 360); off(of["hslH"], of["hsvH"])
        y = 0.299 * r + 0.587 * g + 0.114 * b
        off(of["yuvY"], y); off(of["yuvU"], 0.493 * (b - y)); off(of["yuvV"], 0.877 * (r - y))
        off(of["cmykK"], 1 - most); off((1 - of["cmykC"]) * most, r); off((1 - of["cmykY"]) * most, b)
        exit bad || seen != 11
      }' || complain "at $at" "$linear"
  done
}

@test "--model: what is not finite, and what does not go with it" {
  spectral a.exr --size 16x8 --pattern nan:3,2,5
  spec2rgb --model yuv a.exr -o yuv.exr 2>said
  [ "$(<said)" = 'spec2rgb: warning: a.exr: 1 pixel is not finite, the first at 3,2' ]
  layers --print 3,2 yuv.exr | grep -qi 'Y.*nan'
  run ! grep -qi nan <(layers --print 2,2 yuv.exr)
  spec2rgb -q --model yuv -j 4 a.exr -o four.exr
  for y in 0 3 7; do
    [ "$(layers --print 5,$y four.exr)" = "$(layers --print 5,$y yuv.exr)" ]
  done
  fails_cleanly spec2rgb --model lab a.exr -o x.exr
  [[ $stderr = *"'lab' is not hsv, hsl, yuv or cmyk" ]]
  fails_cleanly spec2rgb --model hsv --bits 16 a.exr -o x.exr
  fails_cleanly spec2rgb --model hsv -f png a.exr -o x.exr
  fails_cleanly spec2rgb --model hsv a.exr -o x.png
  fails_cleanly spec2rgb --model hsv a.exr -o x.tif
  no_leftovers . a.exr yuv.exr four.exr said
}

# Spaces

# near WANTED TOLERANCE NAME...: the channels of a pixel, as 'layers --print' has them on stdin.
near() {
  local wanted=$1 tolerance=$2
  shift 2
  awk -v wanted="$wanted" -v tolerance="$tolerance" -v names="$*" '
    { of[$1] = $2 }
    END {
      n = split(wanted, want, " "); split(names, name, " ")
      for (i = 1; i <= n; i++) {
        off = of[name[i]] - want[i]
        if (!(name[i] in of) || !(off <= tolerance && off >= -tolerance)) { print name[i], of[name[i]], want[i]; bad = 1 }
      }
      exit bad
    }' >&2
}

@test "--space: the same light in every space, by the matrices of the standards" {
  four
  spec2rgb --space xyz four.exr -o xyz.exr
  has_channels xyz.exr X Y Z
  spec2rgb --space xyy four.exr -o xyy.exr
  has_channels xyy.exr Y x y
  spec2rgb --space p3 four.exr -o p3.exr
  spec2rgb --space acescg four.exr -o acescg.exr
  spec2rgb --space '.68,.32 .265,.69 .15,.06 .3127,.329' four.exr -o own.exr
  exrheader own.exr >own; exrheader p3.exr >p3
  cmp <(grep -A4 chroma own) <(grep -A4 chroma p3)
  run ! grep chroma <(exrheader xyz.exr)
  for at in 0,0 1,0 0,1 1,1; do
    read -r x y z < <(layers --print $at xyz.exr | awk '{ of[$1] = $2 } END { print of["X"], of["Y"], of["Z"] }')
    layers --print $at xyy.exr | near "$(awk -v x="$x" -v y="$y" -v z="$z" 'BEGIN { s = x + y + z; print x / s, y / s, y }')" 1e-5 x y Y
    # From XYZ: SMPTE EG 432-1 with D65, and Academy S-2014-004's inverse, as printed.
    layers --print $at p3.exr | near "$(awk -v x="$x" -v y="$y" -v z="$z" 'BEGIN {
      print 2.4934969 * x - 0.9313836 * y - 0.4027108 * z, -0.8294890 * x + 1.7626641 * y + 0.0236247 * z,
        0.0358458 * x - 0.0761724 * y + 0.9568845 * z }')" 1e-5 R G B
    layers --print $at acescg.exr | near "$(awk -v x="$x" -v y="$y" -v z="$z" 'BEGIN {
      print 1.6410233797 * x - 0.3248032942 * y - 0.2364246952 * z, -0.6636628587 * x + 1.6153315917 * y + 0.0167563477 * z,
        0.0117218943 * x - 0.0082844420 * y + 0.9883948585 * z }')" 1e-5 R G B
    cmp <(layers --print $at own.exr) <(layers --print $at p3.exr)
  done
}

@test "--space lab: white is 100 0 0 under every light, half of it L* 76.07" {
  spectral half.exr --kind T --grid 360:830:5 --pattern constant:0.5
  spectral light.exr --grid 360:830:5 --pattern constant:0.5
  # 116 * 0.5^(1/3) - 16 = 76.0693
  for option in '--illuminant A' '--illuminant D65' '--illuminant A --adapt cat02'; do
    # shellcheck disable=SC2086 # several words
    spec2rgb $option --space lab half.exr -o lab.exr
    has_channels lab.exr L a b
    layers --print 0,0 lab.exr | near '76.0693 0 0' 2e-2 L a b
  done
  spec2rgb --space lab light.exr -o lab.exr
  layers --print 0,0 lab.exr | near '76.0693 0 0' 2e-2 L a b
  spec2rgb --space xyy --illuminant A --adapt vonkries half.exr -o xyy.exr
  layers --print 0,0 xyy.exr | near '0.34567 0.35851 0.5' 2e-4 x y Y
}

@test "--transfer and the spaces' own functions, on half the light" {
  # At 16 bits: 65535 times 0.5^(1/2.6), 0.5^(256/563), 1.099 * 0.5^0.45 - 0.099, 0.5; D65's table
  # and the spaces' white differ by 2e-4.
  spectral grey.exr --kind T --grid 360:830:5 --pattern constant:0.5
  for pair in dci:50199 adobe:47818 rec709:46236 rec2020:46233 linear:32768 srgb:48192; do
    spec2rgb --space p3 --transfer "${pair%:*}" --adapt bradford --bits 16 grey.exr -o grey.ppm
    for code in $(pixel grey.ppm 0 0); do
      [ $((code - ${pair#*:})) -le 2 ] && [ $((${pair#*:} - code)) -le 2 ] || complain "$pair: $code"
    done
  done
  for pair in dci-p3:dci adobe:adobe rec709:rec709 rec2020:rec2020 aces:linear acescg:linear p3:srgb; do
    spec2rgb --space "${pair%:*}" --bits 16 grey.exr -o own.ppm
    spec2rgb --space "${pair%:*}" --transfer "${pair#*:}" --bits 16 grey.exr -o named.ppm
    cmp own.ppm named.ppm
  done
}

@test "spaces, functions and adaptations that are refused" {
  spectral a.exr
  fails_cleanly spec2rgb --space prophoto a.exr -o a.png
  [[ $stderr = *"'prophoto'"*acescg* ]]
  fails_cleanly spec2rgb --space '.64,.33 .3,.6 .15,.06' a.exr -o a.png
  fails_cleanly spec2rgb --space '.1,.1 .2,.2 .3,.3 .3,.3' a.exr -o a.png
  for space in xyz lab xyy; do
    fails_cleanly spec2rgb --space $space a.exr -o a.png
    fails_cleanly spec2rgb --space $space a.exr -o a.tif
    [[ $stderr = *'only OpenEXR'* ]]
  done
  fails_cleanly spec2rgb --transfer gamma a.exr -o a.png
  fails_cleanly spec2rgb --transfer dci a.exr -o a.exr.exr
  [[ $stderr = *'floats stay linear' ]]
  fails_cleanly spec2rgb --adapt cat97 a.exr -o a.png
  fails_cleanly spec2rgb --model hsv --space p3 a.exr -o x.exr
  fails_cleanly spec2rgb --model hsv --transfer linear a.exr -o x.exr
  no_leftovers . a.exr
}

# chunk FILE.png NAME: the bytes of a chunk before the pixels, in hexadecimal.
chunk() {
  od -An -v -tx1 -w1 "$1" | awk -v name="$(printf %s "$2" | od -An -tx1 | tr -d ' \n')" '
    function number(at) { return strtonum16(b[at]) * 16777216 + strtonum16(b[at + 1]) * 65536 + strtonum16(b[at + 2]) * 256 + strtonum16(b[at + 3]) }
    function strtonum16(two) { return 16 * (index("0123456789abcdef", substr(two, 1, 1)) - 1) + index("0123456789abcdef", substr(two, 2, 1)) - 1 }
    { b[n++] = $1 }
    END {
      for (at = 8; at < n; at += 12 + size) {
        size = number(at)
        kind = b[at + 4] b[at + 5] b[at + 6] b[at + 7]
        if (kind == "49444154") exit
        if (kind != name) continue
        for (i = 0; i < size; i++) printf "%s", b[at + 8 + i]
        print ""
      }
    }'
}

@test "a PNG says its space: cICP, gAMA and cHRM beside a profile; sRGB by one chunk" {
  spectral a.exr
  # H.273: 12 and 13, 9 and 14, 1 and 1; gamma 1/2.2, 1/2.19921875, 1/2.6; whites of D65 and of DCI.
  while read -r space code gamma white; do
    spec2rgb --space "$space" a.exr -o a.png
    [ "$(chunk a.png cICP)" = "${code#-}" ] || complain "$space: cICP $(chunk a.png cICP)"
    [ "$(chunk a.png gAMA)" = "${gamma#-}" ] || complain "$space: gAMA $(chunk a.png gAMA)"
    [ "$(chunk a.png cHRM | head -c 16)" = "${white#-}" ] || complain "$space: cHRM $(chunk a.png cHRM)"
    [ -n "$(chunk a.png iCCP)" ] || complain "$space has no profile"
    [ -z "$(chunk a.png sRGB)" ]
  done <<'END'
p3 0c0d0001 0000b18f 00007a2600008084
rec2020 090e0001 - 00007a2600008084
rec709 01010001 - 00007a2600008084
adobe - 0000b19f 00007a2600008084
dci-p3 - 0000963e 00007aa80000891c
aces - 000186a0 -
acescg - 000186a0 -
END
}

@test "custom primaries and other functions are told in a PNG, too" {
  spectral a.exr
  spec2rgb --space '.9,.05 -.1,1.2 .1,-.3 .3,.3' a.exr -o far.png
  [ -n "$(chunk far.png iCCP)" ]
  [ -z "$(chunk far.png cHRM)$(chunk far.png cICP)" ]
  # White outside its primaries.
  spec2rgb --space '.6,.3 .3,.6 .5,.3 .15,.1' a.exr -o odd.png
  [ -n "$(chunk odd.png iCCP)" ]
  # A quarter of the light is code 118.05 by ROMM RGB's power, whose gAMA is 1/1.8.
  spectral quarter.exr --kind T --pattern constant:0.25
  spec2rgb --space '.7347,.2653 .1596,.8404 .0366,.0001 .3457,.3585' --adapt bradford --transfer gamma:1.8 -f ppm quarter.exr 2>/dev/null |
    tail -c 3 | od -An -tu1 | grep -qx ' 118 118 118'
  spec2rgb --transfer gamma:1.8 quarter.exr -o romm.png
  [ "$(chunk romm.png gAMA)" = 0000d904 ]
  spec2rgb --transfer gamma:2.2 quarter.exr -o m.png
  [ "$(chunk m.png cICP)" = 01040001 ]
  fails_cleanly spec2rgb --transfer gamma:2.7 quarter.exr -o x.png
  spec2rgb --transfer linear a.exr -o linear.png
  [ "$(chunk linear.png cICP)" = 01080001 ]
  [ -z "$(chunk linear.png sRGB)" ]
  spec2rgb a.exr -o plain.png
  spec2rgb --space srgb --transfer srgb a.exr -o srgb.png
  cmp plain.png srgb.png
  [ -n "$(chunk srgb.png sRGB)" ]
  [ -z "$(chunk srgb.png iCCP)$(chunk srgb.png cICP)" ]
}

@test "other programs find the profile in PNG, TIFF and JPEG" {
  command -v oiiotool >/dev/null || skip 'no oiiotool'
  spectral a.exr
  for suffix in png tif jpg; do
    spec2rgb --space p3 a.exr -o p3.$suffix
    oiiotool --info -v p3.$suffix | grep -q 'ICCProfile:profile_description: "Display P3"' || complain "$suffix"
    spec2rgb --space rec2020 a.exr -o wide.$suffix
    oiiotool --info -v wide.$suffix | grep -q 'ICCProfile:profile_description: "ITU-R BT.2020"' || complain "$suffix"
  done
  for suffix in png jpg; do
    spec2rgb a.exr -o srgb.$suffix
    oiiotool --info -v srgb.$suffix | { run ! grep ICCProfile; }
  done
  # TIFF has no other word for it.
  spec2rgb a.exr -o srgb.tif
  oiiotool --info -v srgb.tif | grep -q 'ICCProfile:profile_description: "sRGB"'
  spec2rgb --bits 32 a.exr -o srgb.tif
  oiiotool --info -v srgb.tif | grep -q 'ICCProfile:profile_description: "sRGB, linear"'
  spec2rgb --space acescg --bits 32 a.exr -o linear.tif
  oiiotool --info -v linear.tif | grep -q 'ICCProfile:profile_description: "ACEScg"'
}

@test "--space xyy: the black of light is that of equal energy, of reflectance that of the illuminant" {
  spectral light.exr --grid 360:830:5 --pattern constant:0
  spectral card.exr --kind T --grid 360:830:5 --pattern constant:0
  spec2rgb --space xyy light.exr -o black.exr
  layers --print 0,0 black.exr | near '0.33333 0.33333 0' 1e-4 x y Y
  spec2rgb --space xyy --illuminant A card.exr -o black.exr
  layers --print 0,0 black.exr | near '0.44757 0.40745 0' 1e-4 x y Y
  spec2rgb --space xyy --illuminant A --adapt cat02 card.exr -o black.exr
  layers --print 0,0 black.exr | near '0.34567 0.35851 0' 1e-5 x y Y
}

@test "HDR holds floats of all sizes, and nothing below 0" {
  command -v oiiotool >/dev/null || skip 'no oiiotool'
  four
  spec2rgb -e 20 four.exr -o four.exr.exr
  spec2rgb -e 20 four.exr -o four.hdr
  layers --print 0,0 four.exr.exr | awk '$2 < -1e4 { below = 1 } END { exit !below }'
  oiiotool --info --stats four.hdr >stats
  grep -q 'Stats Min: 0.0* 0.0* 0.0* ' stats || complain "$(<stats)"
  # Radiance's mantissa has 8 bits.
  for name in R G B; do
    for at in 0,0 1,0 0,1 1,1; do layers --print $at four.exr.exr | awk -v n=$name '$1 == n { print $2 }'; done | sort -g | tail -n 1
  done | paste -sd ' ' >most
  sed -n 's/.*Stats Max: \([^(]*\).*/\1/p' stats | paste -d ' ' - most |
    awk '{ for (i = 1; i <= 3; i++) { off = $i / $(i + 3) - 1; if (off * off > 1e-4) exit 1 } }' || complain "$(<stats)" "$(<most)"
}

@test "a format that cannot tell the picture's space: one warning" {
  spectral a.exr
  spec2rgb --space p3 a.exr -o a.ppm 2>said
  [ "$(<said)" = "spec2rgb: warning: the format cannot tell the space, Display P3: who reads it takes it for sRGB" ]
  spec2rgb --transfer linear a.exr -o a.bmp 2>said
  [ "$(<said)" = "spec2rgb: warning: the format cannot tell the space, sRGB, transfer function linear: who reads it takes it for sRGB" ]
  for format in hdr webp tga; do
    spec2rgb --space rec2020 a.exr -o a.$format 2>said
    [ "$(wc -l <said)" -eq 1 ] || complain "$format"
    spec2rgb a.exr -o a.$format 2>said
    [ ! -s said ] || complain "$format"
  done
  # The floats of HDR are linear, and Rec.709 has sRGB's primaries.
  spec2rgb --space rec709 a.exr -o a.hdr 2>said
  [ ! -s said ]
  for format in png tif jpg exr; do
    spec2rgb --space p3 a.exr -o told.$format 2>said
    [ ! -s said ] || complain "$format"
  done
  spec2rgb -q --space p3 a.exr -o a.ppm 2>said
  [ ! -s said ]
}

# Exposure, tone, gamut, dither

# Grey of 4, 1, 0.25 and 0.0625 in four pixels, as light.
greys() {
  printf '%s\n' '# quantity: spectral power distribution' '# columns: wavelength_nm a b c d' \
    '360 4 1 0.25 0.0625' '830 4 1 0.25 0.0625' >greys.spd
  specconvert -g 360:830:5 greys.spd --patches 4x1 -o greys.exr
}

@test "--exposure auto: the mean logarithm of luminance becomes that of 0.18" {
  greys
  # The geometric mean is 0.5, so Y becomes 1.44, 0.36, 0.09, 0.0225.
  spec2rgb --space xyz --exposure auto greys.exr -o auto.exr
  for pair in 0:1.44 1:0.36 2:0.09 3:0.0225; do
    layers --print "${pair%:*},0" auto.exr | near "${pair#*:}" 1e-5 Y
  done
  # The same of a pipe, of any number of threads, and of a darker image.
  spec2rgb --space xyz --exposure auto -j 1 - < <(cat greys.exr) >piped.exr -f exr
  cmp auto.exr piped.exr
  specconvert --scale 0.125 greys.exr | spec2rgb --space xyz -e auto - -o scaled.exr
  cmp <(layers --print 2,0 auto.exr) <(layers --print 2,0 scaled.exr)
}

@test "--exposure auto:P%: the percentile of luminance becomes 1" {
  greys
  for pair in 100:1 75:4 50:16 25:64 1:64; do
    spec2rgb --space xyz --exposure "auto:${pair%:*}%" greys.exr -o auto.exr
    layers --print 0,0 auto.exr | near "${pair#*:}" "$(awk -v y="${pair#*:}" 'BEGIN { print y * 1e-3 }')" Y
  done
}

@test "--exposure auto of black, of NaN, and on a full TMPDIR" {
  spectral black.exr --pattern constant:0
  quiet spec2rgb -e auto black.exr -o black.ppm
  is '0 0 0' black.ppm 3 3
  spectral odd.exr --pattern nan:2,3,4 --pattern inf:5,6,7
  spec2rgb -e auto odd.exr -o odd.ppm 2>err
  [ "$(cat err)" = 'spec2rgb: warning: odd.exr: 2 pixels are not finite, the first at 2,3' ] || complain "$(cat err)"
  is '0 0 0' odd.ppm 2 3
  TMPDIR=$PWD/missing fails_cleanly spec2rgb -e auto black.exr -o new.png
  no_leftovers . black.exr black.ppm odd.exr odd.ppm err
}

@test "--tone: luminance by the curve, and the components by one factor" {
  greys
  for pair in reinhard:0.8 reinhard:4:1 filmic:0.91803; do
    spec2rgb --space xyz --tone "${pair%:*}" greys.exr -o tone.exr
    # Y of 4: 4/5; W itself; h(8) = (8 * 1.25 + 0.004) / (8 * 1.7 + 0.06) - 1/15 = 0.665691 over h(11.2) = 0.725129.
    layers --print 0,0 tone.exr | near "${pair##*:}" 1e-3 Y
  done
  four
  spec2rgb four.exr -o plain.exr
  spec2rgb --tone reinhard four.exr -o tone.exr
  read -r r g b < <(layers --print 1,0 plain.exr | awk '{ of[$1] = $2 } END { print of["R"], of["G"], of["B"] }')
  layers --print 1,0 tone.exr | near "$(awk -v r="$r" -v g="$g" -v b="$b" 'BEGIN {
    y = 0.2126390 * r + 0.7151687 * g + 0.0721923 * b; print r / (1 + y), g / (1 + y), b / (1 + y) }')" 1e-5 R G B
}

@test "--gamut: nothing stays outside, and what each map keeps is kept" {
  four
  spec2rgb four.exr -o clip.exr
  layers --print 1,0 clip.exr | awk '$2 < 0 { outside = 1 } END { exit !outside }'
  for gamut in desaturate perceptual scale; do
    spec2rgb --gamut $gamut four.exr -o $gamut.exr
    spec2rgb --gamut $gamut -j 1 four.exr | cmp - <(spec2rgb --gamut $gamut -j 3 <four.exr)
    for at in 0,0 1,0 0,1 1,1; do
      layers --print $at $gamut.exr | awk '$1 ~ /^[RGB]$/ { seen++; if ($2 < -1e-6 || $2 > 1 + 1e-6) bad = 1 } END { exit bad || seen != 3 }' ||
        complain "$gamut at $at" "$(layers --print $at $gamut.exr)"
    done
  done
  # Luminance stays where it was, of desaturate.
  for at in 0,0 1,0 0,1; do
    layers --print $at clip.exr desaturate.exr >both || { layers --print $at clip.exr; layers --print $at desaturate.exr; } >both
    awk '
      $1 == "R" { y[n[$1]++] += 0.2126390 * $2 } $1 == "G" { y[n[$1]++] += 0.7151687 * $2 } $1 == "B" { y[n[$1]++] += 0.0721923 * $2 }
      END { d = y[0] - y[1]; exit !(n["R"] == 2 && d < 1e-5 && d > -1e-5) }' both || complain "$at" "$(cat both)"
  done
}

@test "--dither: the mean of many pixels is between two codes, and the same in every run" {
  spectral grey.exr --kind T --grid 360:830:5 --size 64x64 --pattern constant:0.502
  spec2rgb --dither grey.exr -o one.ppm
  spec2rgb --dither -j 1 grey.exr -o two.ppm
  cmp one.ppm two.ppm
  # 187.86 as in "half the light is sRGB 188": both codes are there.
  tail -c $((64 * 64 * 3)) one.ppm | od -An -v -tu1 -w1 | awk '
    { sum += $1; seen[$1 + 0]++ } END { mean = sum / NR; exit !(mean > 187.7 && mean < 188 && seen[187] && seen[188] && seen[187] + seen[188] == NR) }'
  spec2rgb --dither --exposure auto:50% grey.exr -o three.ppm
}

@test "exposure, tone, gamut and dither that are refused" {
  spectral a.exr
  for value in auto: auto:0% auto:101% auto:50 automatic; do
    fails_cleanly spec2rgb --exposure $value a.exr -o a.png
  done
  fails_cleanly spec2rgb --tone hable a.exr -o a.png
  fails_cleanly spec2rgb --tone reinhard:0 a.exr -o a.png
  fails_cleanly spec2rgb --gamut oklch a.exr -o a.png
  fails_cleanly spec2rgb --gamut desaturate --space lab a.exr -o a.rgb.exr
  fails_cleanly spec2rgb --dither --bits 16 a.exr -o a.png
  fails_cleanly spec2rgb --dither a.exr -o a.rgb.exr
  for option in '--exposure auto' '--tone filmic' '--gamut scale' '--dither'; do
    # shellcheck disable=SC2086 # several words
    fails_cleanly spec2rgb --model hsv $option a.exr -o x.exr
  done
  no_leftovers . a.exr
}

# Rules of integration, and what Y is

# xyz FILE OPTION...: X, Y and Z of its first pixel.
xyz() {
  local file=$1
  shift
  spec2rgb --space xyz "$@" "$file" -o of.exr || return 1
  layers --print 0,0 of.exr | sort | awk '{ printf "%s%s", s, $2; s = " " } END { print "" }'
}

# close TOLERANCE WANTED FOUND: numbers, each within the relative tolerance.
close() {
  awk -v tolerance="$1" -v wanted="$2" -v found="$3" 'BEGIN {
    n = split(wanted, w); if (split(found, f) != n) exit 1
    for (i = 1; i <= n; i++) { off = f[i] - w[i]; if (off < 0) off = -off; if (!(off <= tolerance * w[i])) exit 1 }
  }' || complain "$3 instead of $2"
}

@test "--rule: the perfect reflector by every rule, from 400 to 700 nm" {
  spectral white.exr --kind T --grid 400:700:10 --pattern constant:1
  # By the CIE's sums what lies outside is missing: 4.02e-4 of Y under D65. The weights of ASTM E308
  # collect it, and make its white point, 95.047 100 108.883; the trapezoid divides by its own sum.
  close 1e-5 '94.8731 99.9598 108.5623' "$(xyz white.exr --white 100 --rule cie)"
  close 1e-5 '94.8731 99.9598 108.5623' "$(xyz white.exr --white 100)"
  close 2e-5 '95.047 100 108.883' "$(xyz white.exr --white 100 --rule astm)"
  close 1e-6 '0.948602 1 1.084602' "$(xyz white.exr --rule grid)"
  # X of A by 20 nm and the observer of 1964: the sum of that column of ASTM E308-15, 111.146.
  spectral wide.exr --kind T --grid 360:780:20 --pattern constant:1
  close 2e-5 '111.144 100 35.200' "$(xyz wide.exr --white 100 --rule astm --observer 1964 --illuminant A)"
}

@test "--rule grid: light is the trapezoid, over the observer's sum of 106.8569" {
  spectral light.exr --grid 540:560:10 --pattern constant:1
  # y of 540, 550, 560 nm: .954, .99495, .995; half a step at the ends.
  y=$(xyz light.exr --rule grid -q | cut -d ' ' -f 2)
  close 1e-6 "$(awk 'BEGIN { printf "%.9f", (5 * .954 + 10 * .9949501 + 5 * .995) / 106.8569 }')" "$y"
  spectral bins.exr --grid 550:560:10 --bins --pattern constant:1
  y=$(xyz bins.exr --rule grid -q | cut -d ' ' -f 2)
  close 1e-6 "$(awk 'BEGIN { printf "%.9f", (10 * .9949501 + 10 * .995) / 106.8569 }')" "$y"
}

@test "--rule grid: what is reradiated is relative to the same sum" {
  spectral b.exr --channel T.400nm --channel T.500nm --channel T.600nm --channel T.400nm.500nm --pattern constant:1
  # y and D65 at 400, 500, 600 nm: .000396 .323 .631, 82.7549 109.354 90.0062; by 50, 100, 50 nm.
  close 2e-5 "$(awk 'BEGIN {
    all = 50 * .000396 * 82.7549 + 100 * .323 * 109.354 + 50 * .631 * 90.0062
    printf "%.7f", 1 + 100 * .323 * 82.7549 / all }')" "$(xyz b.exr -q --rule grid | cut -d ' ' -f 2)"
  fails_cleanly spec2rgb --rule astm b.exr -o x.png
  [[ $stderr = *'b.exr: the weights of ASTM E308 are not for bispectral images' ]]
}

@test "--absolute: candelas per square metre, by the efficacy of each observer" {
  spectral light.exr --grid 360:830:1 --pattern constant:1
  # 683 lm/W times 106.8569 nm; the spectrum of equal energy has nearly X = Y = Z.
  close 1e-6 72983.27 "$(xyz light.exr --absolute | cut -d ' ' -f 2)"
  close 1e-6 72983.27 "$(xyz light.exr --absolute --rule grid | cut -d ' ' -f 2)"
  # 1700.06 lm/W times the sum of V' by 1 nm.
  sum=$(awk '/^[0-9]/ { sum += $2 } END { printf "%.6f", sum * 1700.06 }' "$ROOT/spectra/cmf/v-scotopic.spd")
  close 1e-5 "$sum" "$(xyz light.exr --space srgb --absolute --observer v-scotopic | cut -d ' ' -f 2)"
  # A line of 540 THz, here of 0.016 nm times 1000, has 683 cd/m^2 per W m^-2 sr^-1 to every observer.
  printf '%s\n' '# quantity: radiance' '# unit: W m^-2 sr^-1 nm^-1' '555 0' '555.016 1000' '555.032 0' >line.spd
  specconvert -g 555:555.032:0.016 --patches 1x1 line.spd -o line.exr
  for observer in 1931 1964 2015-2 2015-10; do
    y=$(xyz line.exr --absolute --rule grid --observer $observer -q | cut -d ' ' -f 2)
    close 5e-6 10928 "$y"
  done
}

@test "--absolute: radiance per band, per nm and in bins have one luminance" {
  # 0.5 W m^-2 sr^-1 nm^-1 from 500 to 600 nm; of bands of 10 nm, 5 in each.
  spectral bins.exr --grid 505:595:10 --bins --pattern constant:0.5
  spectral each.exr --grid 505:595:10 --bins --quantity 'radiance per band' --pattern constant:5
  wanted=$(awk '/^5[0-9][0-9] |^600 / { y = $3; if ($1 == 500 || $1 == 600) y /= 2; sum += y } END { printf "%.6f", 683 * 0.5 * sum }' \
    "$ROOT/spectra/cmf/cie1931.spd")
  for image in bins each; do
    close 2e-6 "$wanted" "$(xyz $image.exr -q --absolute | cut -d ' ' -f 2)"
    close 2e-3 "$wanted" "$(xyz $image.exr -q --absolute --rule grid | cut -d ' ' -f 2)"
  done
}

@test "--absolute: reflectance under a light of known radiance" {
  spectral half.exr --kind T --grid 360:830:5 --pattern constant:0.5
  fails_cleanly spec2rgb --absolute half.exr -o x.exr
  [[ $stderr = *'half.exr: reflectance has a luminance only under a radiance, or a power in W m-2 nm-1, and the illuminant '*D65*' tells ratios alone' ]]
  printf '%s\n' '# quantity: radiance' '# unit: W m^-2 sr^-1 nm^-1' '360 0.02' '830 0.02' >lamp.spd
  for rule in cie grid; do
    close 1e-5 "$(awk 'BEGIN { print 683 * 106.8569 * 0.01 }')" "$(xyz half.exr --absolute --rule $rule --illuminant lamp.spd | cut -d ' ' -f 2)"
  done
  # Of an irradiance, 1/pi of the illuminance.
  noon='daylight@50.88N 4.70E,2005-05-17T12:00Z'
  lux=$(specinfo --json "$noon" | jq .illuminance)
  close 1e-5 "$(awk -v lux="$lux" 'BEGIN { print 0.5 * lux / atan2(0, -1) }')" "$(xyz half.exr --absolute --illuminant "$noon" | cut -d ' ' -f 2)"
}

@test "-v tells the sums, also in OpenEXR with the luminance of white" {
  spectral light.exr --grid 360:830:5 --pattern constant:1
  spectral card.exr --kind T --grid 400:700:10 --pattern constant:1
  spec2rgb -v -e 1 light.exr -o x.exr 2>said
  grep -qx "spec2rgb: light.exr: rule cie, sums by the observer's steps (CIE 15:2018); observer CIE 1931 .*, by 1 nm; Y = 1: 1 per nm at all wavelengths, 72983.27 cd/m^2 by 683 lm/W; outside: 0.00 % of Y" said
  exrheader x.exr >header
  grep -q '^spec:integration (type string): "rule cie, .*72983.27 cd/m^2 by 683 lm/W; outside: 0.00 % of Y"$' header
  grep -qx 'whiteLuminance (type float): 36491.6' header
  specinfo --check x.exr | grep -v 'note: file: ' | { run ! grep .; }
  spec2rgb -v --absolute light.exr -o x.exr 2>said
  grep -q '; Y in cd/m^2, by 683 lm/W; ' said
  exrheader x.exr | grep -qx 'whiteLuminance (type float): 1'
  # Only of RGB.
  spec2rgb -v --absolute --space xyz light.exr -o x.exr 2>said
  exrheader x.exr | { run ! grep whiteLuminance; }
  # Reflectance has none, and a tone curve leaves none; whole numbers say nothing of it.
  spec2rgb -v --rule astm --illuminant A card.exr -o x.exr 2>said
  grep -qx "spec2rgb: card.exr: rule astm, .*; illuminant CIE standard illuminant A; Y = 1: the perfect reflector; outside: 0\... % of Y" said
  exrheader x.exr | { run ! grep whiteLuminance; }
  spec2rgb -v --tone reinhard light.exr -o x.exr 2>said
  exrheader x.exr | { run ! grep whiteLuminance; }
  for option in '-e auto' '--gamut scale'; do
    # shellcheck disable=SC2086 # two words
    spec2rgb -v $option light.exr -o x.exr 2>said
    exrheader x.exr | { run ! grep whiteLuminance; }
  done
  spec2rgb -v light.exr -o x.png 2>said
  [ "$(wc -l <said)" -eq 1 ]
  spec2rgb light.exr -o y.png
  cmp x.png y.png
  spec2rgb light.exr -o x.exr
  exrheader x.exr | { run ! grep -e spec:integration -e whiteLuminance; }
}

@test "samples beyond the floats of 16 bits are counted" {
  # 72983 cd/m^2, of which all three components are above 65504.
  spectral light.exr --size 2x1 --grid 360:830:5 --pattern constant:1
  spec2rgb --absolute --bits 16 light.exr -o x.exr 2>said
  [ "$(<said)" = 'spec2rgb: warning: x.exr: 6 samples are too large for 16 bits and became infinite' ]
  layers --print 1,0 x.exr | grep -q '^R inf'
  spec2rgb -q --absolute --bits 16 light.exr -o x.exr 2>said
  [ ! -s said ]
  spec2rgb --absolute light.exr -o x.exr 2>said
  [ ! -s said ]
  spec2rgb --bits 16 light.exr -o x.exr 2>said
  [ ! -s said ]
}

@test "rules and scales that are refused" {
  spectral light.exr --grid 400:700:10
  spectral five.exr --kind T --grid 400:700:5
  spectral odd.exr --kind T --grid 405:695:10
  spectral bins.exr --kind T --grid 400:700:10 --bins
  fails_cleanly spec2rgb --rule trapezoid light.exr -o x.png
  [[ $stderr = *"'trapezoid' is no rule of integration: cie, grid or astm" ]]
  fails_cleanly spec2rgb --rule astm light.exr -o x.png
  [[ $stderr = *'light.exr: the weights of ASTM E308 are for reflectance and transmittance, not for light' ]]
  fails_cleanly spec2rgb --rule astm five.exr -o x.png
  [[ $stderr = *'five.exr: ASTM E308 has weights for bands 10 or 20 nm apart, not for these' ]]
  fails_cleanly spec2rgb --rule astm odd.exr -o x.png
  [[ $stderr = *'odd.exr: bands at 405, 415, … nm are not among those of the table of ASTM E308, 360, 370, … nm' ]]
  fails_cleanly spec2rgb --rule astm bins.exr -o x.png
  [[ $stderr = *'bins.exr: the weights of ASTM E308 are for samples at points, not for means over bins' ]]
  fails_cleanly spec2rgb --white 10 light.exr -o x.exr
  [[ $stderr = *"the Y of white is 1 or 100, not '10'" ]]
  fails_cleanly spec2rgb --white 1 --absolute light.exr -o x.exr
  for option in --absolute '--white 100'; do
    for other in '-e 1' '-e auto' '--tone filmic' '--gamut scale' '--space lab' '--model hsv'; do
      # shellcheck disable=SC2086 # several words
      fails_cleanly spec2rgb $option $other light.exr -o x.exr
    done
    # shellcheck disable=SC2086 # several words
    fails_cleanly spec2rgb $option light.exr -o x.png
    [[ $stderr = *'are for floats, such as those of OpenEXR: whole numbers end at 1' ]]
  done
  fails_cleanly spec2rgb --absolute --observer cie2006-lms-2 light.exr -o x.exr
  [[ $stderr = *'has no luminous efficiency, and so no luminance' ]]
  spectral ratio.exr --grid 400:700:10 --quantity absorptance
  fails_cleanly spec2rgb --absolute ratio.exr -o x.exr
  no_leftovers . light.exr five.exr odd.exr bins.exr ratio.exr
}
