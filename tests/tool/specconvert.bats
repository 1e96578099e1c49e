#!/usr/bin/env bats
# specconvert: every option does what it says and nothing else.
# shellcheck disable=SC2154 # fails_cleanly leaves its line in stderr

load common

# attributes FILE: all that exrheader prints but the file's name, the channels and the windows.
attributes() {
  exrheader "$1" | grep -vE '^file |^    .*, (16|32)-bit|^(data|display)Window '
}

# has_numbers FILE LINE...
has_numbers() {
  local found wanted
  found=$(numbers "$1")
  shift
  wanted=$(printf '%s\n' "$@")
  [ "$found" = "$wanted" ] || complain "has:" "$found" "instead of:" "$wanted"
}

# same A B: specdiff finds no difference.
same() {
  specdiff "$1" "$2" || return 1
}

# last_uints FILE LINES BYTES: of an uncompressed file, the last sample of each line.
last_uints() {
  local lines=$2 chunk=$(($3 + 8)) at size i
  size=$(wc -c <"$1")
  at=$((size - lines * chunk))
  for ((i = 1; i <= lines; i++)); do
    tail -c +$((at + i * chunk - 3)) "$1" | od -An -v -tu4 -N4
  done | xargs
}

# Without options

@test "without options the pixels stay as they are" {
  spectral a.exr --pattern noise
  specconvert a.exr -o b.exr
  same a.exr b.exr
}

@test "a file, standard input, '-' and a process substitution are read alike" {
  spectral a.exr
  specconvert --no-history a.exr -o file.exr
  specconvert --no-history <a.exr -o redirected.exr
  specconvert --no-history - < <(cat a.exr) -o dash.exr
  specconvert --no-history <(cat a.exr) -o substituted.exr
  for other in redirected dash substituted; do
    cmp file.exr $other.exr
  done
}

@test "tiles and HALF and UINT channels come out as they went in" {
  spectral lines.exr --size 37x21 --half --uint-id --extra Z
  exrmaketiled -t 8 4 lines.exr tiles.exr
  specconvert tiles.exr -o b.exr
  same lines.exr b.exr
  exrheader b.exr | grep -q 'S0.400,000000nm, 16-bit floating-point'
  exrheader b.exr | grep -q 'id, 32-bit unsigned'
  exrheader b.exr | grep -q 'Z, 32-bit floating-point'
}

@test "NaN and infinities pass through" {
  spectral a.exr --pattern nan:2,3,4 --pattern inf:5,6,7
  specconvert a.exr -o b.exr
  same a.exr b.exr
}

# --grid and --extrapolate

@test "--grid between the bands of what is linear in them is exact" {
  # The ramp grows by 0.1 a band: on a grid 4 times as fine 0.025, which --pattern cannot make
  # itself; coarser grids it can: every other band is band / 2 of a ramp of 0.2.
  spectral a.exr --size 1x1 --grid 400:500:20
  specconvert --grid 400:480:10 a.exr -o b.exr
  specconvert --grid 400:480:20 b.exr -o c.exr
  specconvert --band 400 --band 420 --band 440 --band 460 --band 480 a.exr -o d.exr
  specdiff --tolerance max=1e-6 c.exr d.exr
  numbers b.exr | awk '
    { want = 0.001 + ($1 - 400) * 0.005 }
    $2 - want > 1e-6 || want - $2 > 1e-6 { print "at " $1 ": " $2 " instead of " want; bad = 1 }
    END { exit bad || NR != 9 }'
}

@test "--grid of the same wavelengths changes nothing" {
  spectral a.exr --pattern noise
  specconvert --grid 400:700:20 a.exr -o b.exr
  same a.exr b.exr
}

@test "--grid of some of the wavelengths takes them as they are" {
  spectral a.exr --pattern noise
  specconvert --grid 440:640:40 a.exr -o grid.exr
  specconvert --band 440 --band 480 --band 520 --band 560 --band 600 --band 640 a.exr -o bands.exr
  same grid.exr bands.exr
}

@test "a wavelength within 0.001 nm of a band is that band, a farther one lies between" {
  printf '%s\n' '500 0' '501 1000' '502 0' >steep.spd
  specconvert steep.spd -o a.exr
  specconvert --grid 500.0009:500.0009:1 a.exr -o same.exr
  specconvert --grid 500.002:500.002:1 a.exr -o between.exr
  has_numbers same.exr '500.0009 0'
  has_numbers between.exr '500.002 2'
}

@test "--grid serves every Stokes component" {
  spectral a.exr --size 2x2 --kind stokes --pattern constant:1
  spectral want.exr --size 2x2 --kind stokes --pattern constant:1 --grid 405:695:10
  specconvert --grid 405:695:10 a.exr -o b.exr
  same want.exr b.exr
}

@test "--grid outside the bands is an error that names the range" {
  spectral a.exr
  for grid in 390:700:10 400:710:10 800:900:10; do
    fails_cleanly specconvert --grid $grid a.exr -o b.exr
    [[ $stderr = *'400..700 nm'*--extrapolate* ]] || complain "$stderr"
  done
  no_leftovers . a.exr
}

@test "--extrapolate zero and constant" {
  spectral a.exr --size 1x1 --grid 500:520:20
  specconvert --grid 480:540:20 --extrapolate zero a.exr -o zero.exr
  has_numbers zero.exr '480 0' '500 0.001' '520 0.101' '540 0'
  specconvert --grid 480:540:20 --extrapolate constant a.exr -o constant.exr
  has_numbers constant.exr '480 0.001' '500 0.001' '520 0.101' '540 0.101'
  fails_cleanly specconvert --grid 480:540:20 --extrapolate refuse a.exr -o refuse.exr
  fails_cleanly specconvert --extrapolate linear a.exr -o linear.exr
}

@test "a reversed grid, and every other that is none, is refused" {
  spectral a.exr
  for grid in 700:400:5 400:700:0 400:700:-5 400:700 400:700:7 a:b:c 400:700:5x 400:700:1e-9 ''; do
    fails_cleanly specconvert --grid "$grid" a.exr -o b.exr
  done
  fails_cleanly specconvert --grid 700:400:5 a.exr -o b.exr
  [[ $stderr = *700:400:5*reversed* ]]
  no_leftovers . a.exr
}

@test "--grid does not leave the bins of another grid behind" {
  spectral a.exr --bins
  specconvert --grid 410:690:20 a.exr -o b.exr
  run ! grep spec:bins <<<"$(attributes b.exr)"
  specconvert a.exr -o c.exr
  same a.exr c.exr
}

@test "--grid of a bispectral image is refused" {
  spectral a.exr --channel T.400,0nm --channel T.500,0nm --channel T.400,0nm.500,0nm
  for bands in '--grid 400:500:50' '--band 400'; do
    # shellcheck disable=SC2086 # words
    fails_cleanly specconvert $bands a.exr -o b.exr
    [[ $stderr = *bispectral* ]] || complain "$stderr"
  done
}

# --band

@test "--band keeps the bands that are named, in their order" {
  spectral a.exr --size 1x1
  specconvert --band 0.6um --band 440nm --band 500 a.exr -o b.exr
  # bands 2, 5 and 10 of the ramp
  has_numbers b.exr '440 0.201' '500 0.501' '600 1.001'
}

@test "--band that is not there names the nearest" {
  spectral a.exr
  fails_cleanly specconvert --band 551 a.exr -o b.exr
  [ "$stderr" = 'specconvert: a.exr: has no band at 551 nm; the nearest is at 560 nm (--grid interpolates)' ]
}

@test "--band of one bin keeps its edges" {
  spectral a.exr --bins
  specconvert --band 500 a.exr -o b.exr
  has_line b.exr 'spec:bins (type string): "490 510"'
}

@test "--band given twice is one band" {
  spectral a.exr
  specconvert --band 500 --band 500 a.exr -o b.exr
  has_channels b.exr S0.500,000000nm
}

@test "--grid and --band exclude each other" {
  spectral a.exr
  fails_cleanly specconvert --band 500 --grid 400:500:10 a.exr -o b.exr
}

# --scale, --multiply, --illuminate

@test "--scale multiplies every band" {
  spectral a.exr --pattern constant:0.5
  spectral want.exr --pattern constant:-1
  specconvert --scale -2 a.exr -o b.exr
  same want.exr b.exr
}

@test "--scale leaves foreign channels alone" {
  spectral a.exr --pattern constant:0.5 --extra A --extra Z --uint-id
  specconvert --scale 3 a.exr -o b.exr
  specconvert --scale 0.25 a.exr -o c.exr
  specconvert --scale 12 c.exr -o d.exr
  same b.exr d.exr
  run specdiff --metric max a.exr b.exr
  [[ $output = "max        1 at 0,0 in 'S0.400,000000nm': 0.5 and 1.5" ]] || complain "$output"
}

@test "--scale that is no number is refused" {
  spectral a.exr
  for scale in nan inf 2x '' 1e999; do
    fails_cleanly specconvert --scale "$scale" a.exr -o b.exr
  done
}

@test "--multiply takes a curve, linear between its points" {
  spectral a.exr --size 1x1 --grid 400:700:150 --pattern constant:2
  printf '%s\n' '400 0.25' '700 0.75' >curve.spd
  specconvert --multiply curve.spd a.exr -o b.exr
  has_numbers b.exr '400 0.5' '550 1' '700 1.5'
}

@test "--multiply twice multiplies twice" {
  spectral a.exr --size 1x1 --grid 400:700:150 --pattern constant:2
  printf '%s\n' '400 0.25' '700 0.75' >curve.spd
  printf '%s\n' '400 4' '700 4' >four.spd
  specconvert --multiply curve.spd --multiply four.spd --scale 0.5 a.exr -o b.exr
  has_numbers b.exr '400 1' '550 2' '700 3'
}

@test "--multiply by a curve that is too short is an error that names its range" {
  spectral a.exr
  printf '%s\n' '500 1' '600 1' >short.spd
  fails_cleanly specconvert --multiply short.spd a.exr -o b.exr
  [[ $stderr = *500*600* ]] || complain "$stderr"
  specconvert --extrapolate constant --multiply short.spd a.exr -o b.exr
  same a.exr b.exr
}

@test "--multiply by what is not there suggests the nearest name" {
  spectral a.exr
  fails_cleanly specconvert --multiply D665 a.exr -o b.exr
  [[ $stderr = *D65* ]]
  fails_cleanly specconvert --multiply missing/file.spd a.exr -o b.exr
}

@test "--illuminate makes light of reflectance" {
  spectral a.exr --kind T --pattern constant:0.25
  spectral want.exr --kind S0 --pattern constant:0.5 --quantity 'radiance per nm'
  printf '%s\n' '300 2' '800 2' >two.spd
  specconvert --illuminate two.spd a.exr -o b.exr
  same want.exr b.exr
  has_line b.exr 'emissiveUnits (type string): "W.m^-2.sr^-1"'
}

@test "--illuminate on a fluorescent image adds what is reradiated" {
  # at 500 nm: T.500 times the light there, and T.400.500 times the light at 400 nm
  spectral a.exr --size 1x1 --channel T.400,0nm --channel T.500,0nm --channel T.400,0nm.500,0nm
  printf '%s\n' '400 10' '500 1' >light.spd
  specconvert --illuminate light.spd a.exr -o b.exr
  # the ramp by the order of --channel: 0.001, 0.101, 0.201
  numbers b.exr | awk '
    $1 == 400 { one = $2 - 0.01 } $1 == 500 { two = $2 - (0.101 + 2.01) }
    END { exit NR != 2 || one * one > 1e-14 || two * two > 1e-12 }'
}

@test "--illuminate on light is refused" {
  spectral a.exr
  fails_cleanly specconvert --illuminate D65 a.exr -o b.exr
  [[ $stderr = *reflectance* ]]
}

@test "a preview is dropped when the values change, and kept when they do not" {
  spectral a.exr --grid 500:510:10 --extra R --extra G --extra B --extra A
  specconvert --scale 2 a.exr -o scaled.exr
  has_channels scaled.exr A S0.500,000000nm S0.510,000000nm
  specconvert --crop 1,1,3,3 a.exr -o cropped.exr
  has_channels cropped.exr A B G R S0.500,000000nm S0.510,000000nm
}

# --crop and --downsample

@test "--crop counts from the data window; the display window stays" {
  spectral a.exr --data 10,20 --display 0,0,50,50
  specconvert --crop 2,3,6,7 a.exr -o b.exr
  has_line b.exr 'dataWindow (type box2i): (12 23) - (15 26)'
  has_line b.exr 'displayWindow (type box2i): (0 0) - (49 49)'
}

@test "--crop keeps the pixels as they are" {
  spectral a.exr --grid 500:520:20 --size 16x8
  specconvert --crop 2,3,4,5 a.exr -o b.exr
  # (x + 1) 0.001 + y 0.01 of x 2..3, y 3..4
  has_numbers b.exr '500 0.033 0.034 0.043 0.044' '520 0.133 0.134 0.143 0.144'
}

@test "two crops one after the other are one" {
  spectral a.exr --pattern noise --uint-id --data -7,-3
  specconvert --crop 2,1,14,8 a.exr | specconvert --crop 3,2,9,6 - -o twice.exr
  specconvert --crop 5,3,11,7 a.exr -o once.exr
  same once.exr twice.exr
}

@test "--crop of everything changes nothing" {
  spectral a.exr --pattern noise
  specconvert --crop 0,0,16,8 a.exr -o b.exr
  same a.exr b.exr
}

@test "a crop that is empty, outside or no crop is refused" {
  spectral a.exr
  for crop in 0,0,17,8 0,0,16,9 3,3,3,5 5,0,3,8 -1,0,3,3 1,2,3 1,2,3,4,5 1,2,3,x '' 1.5,0,3,3; do
    fails_cleanly specconvert --crop "$crop" a.exr -o b.exr
  done
  no_leftovers . a.exr
}

@test "--downsample takes the mean" {
  spectral a.exr --grid 500:520:20 --size 4x2
  specconvert --downsample 2 a.exr -o b.exr
  # x 0..1: 0.0015, x 2..3: 0.0035; y 0..1: 0.005
  numbers b.exr | awk '
    { base = $1 == 500 ? 0 : 0.1; one = $2 - base - 0.0065; two = $3 - base - 0.0085
      if (one * one > 1e-14 || two * two > 1e-14 || NF != 3) bad = 1 }
    END { exit bad || NR != 2 }'
}

@test "--downsample halves the windows" {
  spectral a.exr --data -4,-2 --display -5,-5,11,11 --pattern constant:0.5
  specconvert --downsample 2 a.exr -o b.exr
  has_line b.exr 'dataWindow (type box2i): (-2 -1) - (5 2)'
  # what the display window covers in part stays in it: -2.5..5.5
  has_line b.exr 'displayWindow (type box2i): (-3 -3) - (5 5)'
  spectral want.exr --size 8x4 --data -2,-1 --display -3,-3,6,6 --pattern constant:0.5
  same want.exr b.exr
}

@test "--downsample by 1 changes nothing, by all leaves one pixel" {
  spectral a.exr --size 8x8 --pattern noise
  specconvert --downsample 1 a.exr -o one.exr
  same a.exr one.exr
  specconvert --downsample 8 a.exr -o all.exr
  has_line all.exr 'dataWindow (type box2i): (0 0) - (0 0)'
}

@test "--downsample of what is no whole number of blocks is refused, and --crop named" {
  spectral a.exr --size 15x8
  fails_cleanly specconvert --downsample 2 a.exr -o b.exr
  [[ $stderr = *--crop* ]]
  specconvert --crop 0,0,14,8 --downsample 2 a.exr -o b.exr
  has_line b.exr 'dataWindow (type box2i): (0 0) - (6 3)'
  # Each of the four sides counts.
  for window in '16x7 0,0' '16x8 1,0' '15x8 1,0' '16x8 0,1' '16x7 0,1'; do
    spectral c.exr --size "${window% *}" --data "${window#* }" --grid 500:500:1
    fails_cleanly specconvert --downsample 2 c.exr -o d.exr
  done
}

@test "--downsample gives whole numbers the one that most pixels have" {
  spectral a.exr --size 2x2 --grid 500:500:1 --uint-id --compression none
  [ "$(last_uints a.exr 2 16)" = '1 65537' ]
  # 9 65537 / 65536 9: the rest are one each
  size=$(wc -c <a.exr)
  poke a.exr $((size - 4)) "$(little 4 9)"
  poke a.exr $((size - 24 - 8)) "$(little 4 9)"
  specconvert --downsample 2 --compression none a.exr -o b.exr
  [ "$(last_uints b.exr 1 8)" = 9 ] || complain "$(last_uints b.exr 1 8)"
}

@test "--downsample gives whole numbers the first where none leads" {
  spectral a.exr --size 4x4 --grid 500:500:1 --uint-id
  specconvert --downsample 2 --compression none a.exr -o b.exr
  # 0 2 / 131072 131074, of which the last of each line
  [ "$(last_uints b.exr 2 16)" = '2 131074' ] || complain "$(last_uints b.exr 2 16)"
}

@test "a factor that is none is refused" {
  spectral a.exr
  for factor in 0 -2 1.5 x '' 65537; do
    fails_cleanly specconvert --downsample "$factor" a.exr -o b.exr
  done
  [[ $stderr = *'the factor is outside 1..65536'* ]] || complain "$stderr"
}

# Curves

@test "a curve goes through as text" {
  printf '%s\n' '# title: mine' '# quantity: reflectance' '# columns: wavelength_nm R' '400 0.1' '700 0.3' >a.spd
  specconvert a.spd -o b.spd
  specconvert b.spd -o c.spd
  cmp b.spd c.spd
  grep -qx '# title: mine' b.spd
  has_numbers b.spd '400 0.1' '700 0.3'
}

@test "a curve on standard input, by name and from a process substitution" {
  printf '%s\n' '400 0.1' '700 0.3' >a.spd
  specconvert a.spd >file.spd
  specconvert <a.spd >redirected.spd
  specconvert - < <(cat a.spd) >piped.spd
  specconvert <(cat a.spd) >substituted.spd
  for other in redirected piped substituted; do
    cmp file.spd $other.spd
  done
  specconvert illuminants/D65 | cmp - <(specconvert "$ROOT/spectra/illuminants/D65.spd")
}

@test "what an operand is, its name and its first byte say" {
  for name in missing.exr missing.tif ./D65 "$PWD/D65"; do
    fails_cleanly specconvert "$name"
    [[ $stderr = "specconvert: unable to open '$name': No such file or directory" ]] || complain "$stderr"
  done
  printf '\xef\xbb\xbf400 0.1\n700 0.3\n' | specconvert -o marked.spd
  printf '\n400 0.1\n700 0.3\n' | specconvert - -o blank.spd
  for file in marked blank; do
    has_numbers $file.spd '400 0.1' '700 0.3'
  done
  fails_cleanly specconvert D65 -o b.png
  [[ $stderr = *"no image format for '.png'"* ]] || complain "$stderr"
  no_leftovers . marked.spd blank.spd
}

@test "--grid, --multiply and --scale work on curves" {
  printf '%s\n' '400 0' '700 3' >a.spd
  printf '%s\n' '300 2' '800 2' >two.spd
  specconvert --grid 400:600:100 --multiply two.spd --scale 10 a.spd -o b.spd
  has_numbers b.spd '400 0' '500 20' '600 40'
  fails_cleanly specconvert --grid 300:600:100 a.spd
  [[ $stderr = *400*700* ]]
}

@test "a curve becomes an image of one pixel, and that the same curve" {
  printf '%s\n' '400.125 0.1' '512.5 1e-7' '700 123456' >a.spd
  specconvert a.spd -o a.exr
  has_channels a.exr S0.400,125000nm S0.512,500000nm S0.700,000000nm
  has_line a.exr 'dataWindow (type box2i): (0 0) - (0 0)'
  specconvert a.exr -o b.spd
  has_numbers b.spd '400.125 0.1' '512.5 1e-07' '700 123456' ||
    has_numbers b.spd '400.125 0.1' '512.5 1e-7' '700 123456'
}

@test "a curve of reflectance becomes T" {
  printf '%s\n' '# quantity: reflectance' '400 0.1' '700 0.3' >a.spd
  specconvert a.spd -o a.exr
  has_channels a.exr T.400,000000nm T.700,000000nm
  has_line a.exr 'spec:quantity (type string): "reflectance"'
  sed 's/reflectance/transmittance/' a.spd | specconvert --patches 1x1 -o t.exr
  has_channels t.exr T.400,000000nm T.700,000000nm
  has_line t.exr 'spec:quantity (type string): "transmittance"'
  specconvert --half a.spd -o half.exr
  [ "$(exrheader half.exr | grep -c '^    T.*16-bit')" -eq 2 ]
  grep -v quantity a.spd | specconvert --patches 1x1 -o s.exr
  has_line s.exr 'emissiveUnits (type string): "W.m^-2.sr^-1"'
}

@test "several curves become patches" {
  printf '%s\n' '400 1' '700 2' >one.spd
  printf '%s\n' '300 3' '800 3' >two.spd
  printf '%s\n' '300 5' '800 5' >three.spd
  specconvert --patches 2x2 --patch 3 --gap 1 one.spd two.spd three.spd -o chart.exr
  # 1 + 3 + 1 + 3 + 1 pixels each way
  has_line chart.exr 'dataWindow (type box2i): (0 0) - (8 8)'
  specconvert --crop 0,2,9,3 chart.exr -o line.exr
  has_numbers line.exr '400 0 1 1 1 0 3 3 3 0' '700 0 2 2 2 0 3 3 3 0'
  specconvert --crop 0,6,9,7 chart.exr -o line.exr
  has_numbers line.exr '400 0 5 5 5 0 0 0 0 0' '700 0 5 5 5 0 0 0 0 0'
  specconvert --crop 0,4,9,5 chart.exr -o line.exr
  has_numbers line.exr '400 0 0 0 0 0 0 0 0 0' '700 0 0 0 0 0 0 0 0 0'
}

@test "several curves without --patches stand in a row" {
  printf '%s\n' '400 1' '700 2' >one.spd
  printf '%s\n' '300 3' '800 3' >two.spd
  specconvert one.spd two.spd -o row.exr
  has_numbers row.exr '400 1 3' '700 2 3'
}

@test "a chart that does not fit its curves is refused" {
  printf '%s\n' '400 1' '700 2' >one.spd
  printf '%s\n' '# quantity: reflectance' '400 1' '700 2' >paint.spd
  fails_cleanly specconvert --patches 1x1 one.spd one.spd -o chart.exr
  fails_cleanly specconvert --patches 2x1 one.spd paint.spd -o chart.exr
  for patches in 0x1 1x 2 x axb -1x2; do
    fails_cleanly specconvert --patches $patches one.spd -o chart.exr
  done
  fails_cleanly specconvert --patches 2x1 --patch 0 one.spd -o chart.exr
  fails_cleanly specconvert --patches 2x1 --gap -1 one.spd -o chart.exr
  for patches in '1025x1 --patch 1024' '1x1025 --gap 1024'; do
    # shellcheck disable=SC2086 # words
    fails_cleanly specconvert -g 500:500:1 --patches $patches one.spd -o chart.exr
    [[ $stderr = *'pixels is too large' ]] || complain "$stderr"
  done
  fails_cleanly specconvert --patches 4097x1 one.spd -o chart.exr
  mapfile -t many < <(yes one.spd | head -n 4097)
  fails_cleanly specconvert "${many[@]}" -o chart.exr
  [[ $stderr = *'more than 4096 curves' ]] || complain "$stderr"
  fails_cleanly specconvert Au -o chart.exr
  [[ $stderr = *'is a refractive index: an image holds light, reflectance or transmittance' ]] || complain "$stderr"
  no_leftovers . one.spd paint.spd
}

@test "a bad line of a curve is told by its number" {
  printf '%s\n' '400 1' '700 two' >bad.spd
  fails_cleanly specconvert bad.spd -o out.exr
  [[ $stderr = *bad.spd:2:* ]]
  no_leftovers . bad.spd
}

@test "what is for images is refused with curves, and the other way round" {
  printf '%s\n' '400 1' '700 2' >one.spd
  spectral a.exr
  fails_cleanly specconvert --crop 0,0,1,1 one.spd -o out.exr
  fails_cleanly specconvert --downsample 2 one.spd -o out.exr
  fails_cleanly specconvert --band 400 one.spd -o out.exr
  fails_cleanly specconvert --illuminate D65 one.spd -o out.exr
  fails_cleanly specconvert --patches 1x1 a.exr -o out.exr
  fails_cleanly specconvert a.exr a.exr -o out.exr
  fails_cleanly specconvert a.exr one.spd -o out.exr
  fails_cleanly specconvert one.spd a.exr -o out.exr
  no_leftovers . a.exr one.spd
}

@test "a text of too many pixels is refused" {
  spectral a.exr --size 65x64 --grid 500:510:10
  fails_cleanly specconvert a.exr -o a.spd
  [[ $stderr = *--crop* ]]
  no_leftovers . a.exr
}

@test "a text is of the image as it is: what changes it goes before" {
  spectral a.exr
  for change in '--crop 0,0,1,1' '--downsample 2' '--grid 400:700:20' '--band 500' --bands-only '--scale 2' '--per band' --to-air '--from-rgb basis'; do
    # shellcheck disable=SC2086 # words
    fails_cleanly specconvert $change a.exr -o a.spd
    [[ $stderr = *'change the image first, then make it text'* ]] || complain "$change: $stderr"
  done
  no_leftovers . a.exr
}

@test "the text of polarised light is that of S0, of reradiation the diagonal" {
  spectral stokes.exr --size 1x1 --kind stokes --grid 500:500:1
  has_numbers stokes.exr '500 0.001'
  spectral glow.exr --size 1x1 --channel T.400nm --channel T.500nm --channel T.400nm.500nm
  has_numbers glow.exr '400 0.001' '500 0.101'
}

@test "a text of what is not finite is refused, and its place named" {
  for pattern in nan:2,3,4 inf:2,3,4; do
    spectral a.exr --pattern $pattern
    fails_cleanly specconvert a.exr -o a.spd
    [ "$stderr" = 'specconvert: a.exr: pixel 2,3 is not finite at 480 nm' ] || complain "$stderr"
  done
  no_leftovers . a.exr
}

# What it does not understand passes through

@test "attributes of every type pass through" {
  spectral a.exr --attribute 'own:text=two words' --attribute 'empty='
  exrstdattr -owner me -longitude 5.25 -capDate '2026:01:02 03:04:05' -framesPerSecond 24 1 \
    -chromaticities 0.64 0.33 0.3 0.6 0.15 0.06 0.3127 0.329 -keyCode 1 2 3 4 5 4 64 \
    -timeCode 1 2 -wrapmodes clamp -float own:float 1.5 -int own:int -7 \
    -screenWindowWidth 2.5 -screenWindowCenter 0.25 -0.5 -pixelAspectRatio 1.25 a.exr b.exr
  specconvert --no-history b.exr -o c.exr
  [ "$(attributes b.exr)" = "$(attributes c.exr)" ] ||
    complain "$(diff <(attributes b.exr) <(attributes c.exr))"
  specconvert --no-history --scale 2 --crop 1,1,5,5 b.exr -o d.exr
  [ "$(attributes b.exr)" = "$(attributes d.exr)" ] ||
    complain "$(diff <(attributes b.exr) <(attributes d.exr))"
}

@test "light that states no unit gets one" {
  spectral a.exr --without emissiveUnits
  run ! grep emissiveUnits <<<"$(exrheader a.exr)"
  specconvert a.exr -o b.exr
  has_line b.exr 'emissiveUnits (type string): "W.m^-2.sr^-1"'
  spectral t.exr --kind T --without emissiveUnits
  specconvert t.exr -o c.exr
  run ! grep emissiveUnits <<<"$(exrheader c.exr)"
}

@test "names of more than 31 bytes pass through" {
  long=a-channel-with-a-name-of-more-than-thirty-one-bytes
  spectral a.exr --extra $long --attribute "$long=text"
  specconvert a.exr -o b.exr
  same a.exr b.exr
  has_line b.exr "$long (type string): \"text\""
}

@test "windows pass through, negative ones too" {
  spectral a.exr --data -7,-300 --display -1000,5,20,4000
  specconvert a.exr -o b.exr
  has_line b.exr 'dataWindow (type box2i): (-7 -300) - (8 -293)'
  has_line b.exr 'displayWindow (type box2i): (-1000 5) - (19 3999)'
}

@test "foreign channels pass through with their bits" {
  spectral a.exr --extra P.X --extra A --extra cosine --uint-id --pattern noise
  specconvert --grid 410:690:10 a.exr -o b.exr
  specconvert --grid 410:690:10 b.exr -o c.exr
  same b.exr c.exr
  has_channels b.exr A P.X "$(channels b.exr | grep '^S0')" cosine id
}

@test "an image without bands can be cropped, but not scaled" {
  spectral rgb.exr --channel R --channel G --channel B
  specconvert --crop 1,1,3,3 rgb.exr -o b.exr
  has_channels b.exr B G R
  for change in '--scale 2' '--grid 500:500:1' '--band 500' --to-air '--per band'; do
    # shellcheck disable=SC2086 # words
    fails_cleanly specconvert $change rgb.exr -o c.exr
    [[ $stderr = *'no spectral channel'* ]] || complain "$stderr"
  done
}

@test "a part is chosen by number or name, its name stays" {
  spectral a.exr --pattern noise
  spectral b.exr --pattern constant:1
  exrmultipart -combine -i a.exr b.exr -o both.exr >/dev/null
  specconvert --part 1 both.exr -o one.exr
  same b.exr one.exr
  fails_cleanly specconvert both.exr -o none.exr
  [[ $stderr = *--part* ]]
}

# History

@test "spec:history has a line for each tool" {
  spectral a.exr --size 1x1 --grid 500:510:10
  specconvert --scale 2 a.exr -o b.exr
  "$BIN/specconvert" --crop 0,0,1,1 b.exr -o c.exr
  history=$(exrheader c.exr | sed -n '/^spec:history/,/^[^s]/p')
  version=$(specconvert --version | sed 's/.* //')
  [ "$history" = "spec:history (type string): \"specconvert --scale 2 a.exr -o b.exr  # spectools $version
specconvert --crop 0,0,1,1 b.exr -o c.exr  # spectools $version
\"" ] || complain "$history"
}

@test "spec:history quotes arguments for the shell" {
  spectral "it's a.exr" --size 1x1
  specconvert --scale 2 "it's a.exr" -o 'b c.exr'
  exrheader 'b c.exr' | grep -qF "specconvert --scale 2 'it'\\''s a.exr' -o 'b c.exr'  #"
}

@test "--no-history records nothing" {
  spectral a.exr
  specconvert --no-history --scale 2 a.exr -o b.exr
  run ! grep history <<<"$(exrheader b.exr)"
}

# Storage

@test "every lossless compression gives the same pixels back" {
  spectral a.exr --size 33x37 --pattern grain --uint-id --extra Z
  for compression in none rle zips zip piz; do
    specconvert --compression $compression a.exr -o $compression.exr
    same a.exr $compression.exr
  done
  has_line none.exr 'compression (type compression): none'
  has_line rle.exr 'compression (type compression): run-length encoding'
  has_line zips.exr 'compression (type compression): zip, individual scanlines'
  has_line zip.exr 'compression (type compression): zip, multi-scanline blocks'
  has_line piz.exr 'compression (type compression): piz'
}

@test "pxr24 keeps 15 bits of a float's fraction, and all of HALF and UINT" {
  spectral a.exr --size 33x37 --pattern grain --uint-id
  specconvert --compression pxr24 a.exr -o pxr24.exr
  # grain stays below 0.34: half a step of 2^-15 of its power of two, 0.25, is 3.8e-6
  run specdiff --tolerance max=4e-6 a.exr pxr24.exr
  [ "$status" -eq 0 ] || complain "$output"
  spectral half.exr --size 33x37 --pattern grain --half
  specconvert --compression pxr24 half.exr -o pxr24.exr
  same half.exr pxr24.exr
}

@test "b44 and b44a keep FLOAT and UINT, and HALF nearly" {
  spectral a.exr --size 33x37 --uint-id
  spectral half.exr --size 33x37 --half
  for compression in b44 b44a; do
    specconvert --compression $compression a.exr -o b.exr
    same a.exr b.exr
    specconvert --compression $compression half.exr -o b.exr
    # 4 x 4 pixels share their exponent; the ramp's differ by at most 0.033
    specdiff --tolerance max=0.033 half.exr b.exr
    has_line b.exr "compression (type compression): $compression"
  done
}

@test "dwaa and dwab are refused, and the reason given" {
  spectral a.exr
  for compression in dwaa dwab; do
    fails_cleanly specconvert --compression $compression a.exr -o b.exr
    [[ $stderr = *$compression*OpenEXRCore* ]] || complain "$stderr"
  done
  no_leftovers . a.exr
}

@test "a compression that is none is refused" {
  spectral a.exr
  fails_cleanly specconvert --compression lzw a.exr -o b.exr
  [[ $stderr = *lzw*'none rle zips zip piz pxr24 b44 b44a'* ]]
}

@test "--half and --compression are for images in OpenEXR, and not passed over elsewhere" {
  spectral a.exr
  for option in --half '--compression zip'; do
    for output in 'a.exr -o b.spd' 'a.exr -f csv' D65 'F2 --to fourier:9' 'E --strip 2 -o b.exr' 'a.exr -o b.tif'; do
      # shellcheck disable=SC2086 # words
      fails_cleanly specconvert $option $output
      [[ $stderr = *"${option% *} is for "*'OpenEXR alone, not for '* ]] || complain "$stderr"
    done
  done
  fails_cleanly specconvert --half --atlas -g 400:700:5 D65 -o b.exr
  [[ $stderr = *'not for an atlas' ]] || complain "$stderr"
  specconvert --compression rle --atlas -g 400:700:5 D65 -o b.exr
  has_line b.exr 'compression (type compression): run-length encoding'
  no_leftovers . a.exr b.exr
}

@test "--half stores the bands as HALF, rounded to nearest" {
  spectral a.exr --uint-id --extra Z
  spectral want.exr --uint-id --extra Z --half
  specconvert --half a.exr -o b.exr
  same want.exr b.exr
  exrheader b.exr | grep -q 'S0.400,000000nm, 16-bit'
  exrheader b.exr | grep -q 'Z, 32-bit'
}

@test "new bands are HALF where the old ones are, and bands of whole numbers become FLOAT" {
  spectral half.exr --half --extra Z
  specconvert --grid 410:610:100 half.exr -o b.exr
  [ "$(exrheader b.exr | grep -c '^    S0.*16-bit floating-point')" -eq 3 ]
  spectral whole.exr --size 2x1 --grid 500:500:1 --uint S0.600,0nm
  specconvert whole.exr -o c.exr
  exrheader c.exr | grep -q 'S0.600,000000nm, 32-bit floating-point'
  has_numbers c.exr '500 0.001 0.002' '600 0 1'
  specconvert --half whole.exr -o d.exr
  exrheader d.exr | grep -q 'S0.600,000000nm, 16-bit floating-point'
}

@test "threads are 1 to 256" {
  spectral a.exr --size 2x2
  for threads in 0 257 1.5 x ''; do
    fails_cleanly specconvert --threads "$threads" a.exr -o b.exr
  done
  specconvert --threads 256 a.exr -o b.exr
}

@test "every number of threads writes the same bytes" {
  spectral a.exr --size 61x67 --pattern grain --uint-id
  for compression in none zip piz; do
    specconvert --no-history --compression $compression --grid 405:695:10 -j 1 a.exr -o one.exr
    for threads in 2 3; do
      specconvert --no-history --compression $compression --grid 405:695:10 -j $threads a.exr -o more.exr
      cmp one.exr more.exr
    done
  done
}

# Other programs' names

@test "pbrt-v4's three decimals become six" {
  spectral a.exr --size 1x1 --half --channel S0.374,688nm --channel S0.404,063nm --channel R --channel G --channel B
  specconvert a.exr -o b.exr
  has_channels b.exr B G R S0.374,688000nm S0.404,063000nm
  same a.exr b.exr
}

@test "colour-science's single decimal becomes six" {
  spectral a.exr --size 1x1 --channel S0.300,0nm --channel S0.780,0nm
  specconvert a.exr -o b.exr
  has_channels b.exr S0.300,000000nm S0.780,000000nm
  has_numbers b.exr '300 0.001' '780 0.101'
}

@test "Mitsuba 0.6's edges become bins" {
  spectral a.exr --size 1x1 --channel 400.00-410.00nm --channel 410.00-425.00nm
  specconvert a.exr -o b.exr
  has_channels b.exr S0.405,000000nm S0.417,500000nm
  has_line b.exr 'spec:bins (type string): "400 410 425"'
  has_numbers b.exr '405 0.001' '417.5 0.101'
}

@test "ISET3d's numbers become wavelengths from 400 to 700 nm" {
  names=()
  for ((i = 1; i <= 31; i++)); do
    names+=(--channel "Radiance.C$(printf %02d $i)")
  done
  spectral a.exr --size 2x2 "${names[@]}" --pattern noise
  spectral want.exr --size 2x2 --grid 400:700:10 --pattern noise
  specconvert a.exr -o b.exr
  same want.exr b.exr
  [ "$(channels b.exr)" = "$(channels want.exr)" ]
}

@test "KAIST's wavelengths become reflectance" {
  spectral a.exr --size 1x1 --channel w420nm --channel w430nm --channel w720nm
  specconvert a.exr -o b.exr
  has_channels b.exr T.420,000000nm T.430,000000nm T.720,000000nm
  has_numbers b.exr '420 0.001' '430 0.101' '720 0.201'
}

@test "terahertz and micrometres become nanometres, in ascending order" {
  # 299792.458 / 500 = 599.584916
  spectral a.exr --size 1x1 --channel S0.0,55um --channel S0.500THz --channel S0.4e-7m
  specconvert a.exr -o b.exr
  has_channels b.exr S0.400,000000nm S0.550,000000nm S0.599,584916nm
  has_numbers b.exr '400 0.201' '550 0.001' '599.584916 0.101'
}

@test "names that only resemble a band pass through" {
  spectral a.exr --size 1x1 --channel S0.500nm --channel S4.500nm --channel S0.500 --channel T500nm --channel w420
  specconvert a.exr -o b.exr
  has_channels b.exr S0.500 S0.500,000000nm S4.500nm T500nm w420
}

# Output

@test "a failed run leaves the old file as it was, and nothing else" {
  spectral a.exr --size 64x64
  head -c 20000 a.exr >short.exr
  for compression in none zip; do
    echo old >out.exr
    fails_cleanly specconvert --compression $compression short.exr -o out.exr
    [ "$(cat out.exr)" = old ]
  done
  no_leftovers . a.exr short.exr out.exr
}

@test "an image may be written over itself" {
  spectral a.exr
  cp a.exr before.exr
  specconvert --scale 2 a.exr -o a.exr
  specconvert --scale 0.5 a.exr -o a.exr
  same before.exr a.exr
}

@test "a full device fails, as image and as text" {
  spectral a.exr
  fails_cleanly specconvert a.exr -o /dev/full
  printf '%s\n' '400 1' '700 2' >one.spd
  fails_cleanly specconvert one.spd -o /dev/full
  for input in a.exr one.spd; do
    code=0
    specconvert $input >/dev/full 2>err || code=$?
    [ "$code" -eq 2 ]
    [ "$(wc -l <err)" -eq 1 ]
  done
}

@test "a format that is none is refused" {
  spectral a.exr
  fails_cleanly specconvert --format png a.exr -o b.exr
  fails_cleanly specconvert a.exr -o b.png
  [[ $stderr = *"no image format for '.png' (.exr .hdr .img .bsq .bil .bip .hsr .tif .tiff)" ]] || complain "$stderr"
  no_leftovers . a.exr
}

@test "--progress shows lines on standard error, whatever is made, and -q none" {
  spectral a.exr
  spectral rgb.exr --channel R --channel G --channel B --pattern constant:0.5
  for made in 'a.exr --scale 2' 'a.exr --to fourier:3' 'a.exr --projection octahedral' 'rgb.exr --from-rgb basis' \
    'rgb.exr --vectors N' 'D65 --patches 2x1' 'D65 --atlas -g 400:700:5'; do
    # shellcheck disable=SC2086 # words
    specconvert --progress $made -o b.exr 2>said
    grep -q '100% .* lines/s' said || complain "$made: $(cat said)"
    # shellcheck disable=SC2086 # words
    specconvert -q --progress $made -o b.exr 2>said
    [ ! -s said ] || complain "$made: $(cat said)"
    # shellcheck disable=SC2086 # words
    specconvert $made -o b.exr 2>said
    [ ! -s said ] || complain "$made: $(cat said)"
  done
}

@test "each limit is refused by name" {
  spectral a.exr
  for limit in pixels=127 channels=15 header=500 memory=1k; do
    fails_cleanly specconvert --limit $limit a.exr -o b.exr
    [[ $stderr = *"--limit ${limit%=*}="* ]] || complain "$limit: $stderr"
  done
  no_leftovers . a.exr
}

@test "--help, --version and options that are not there" {
  [[ $(specconvert --help) = 'usage: specconvert [OPTION]... [FILE|SPD]...'* ]]
  [[ $(specconvert -V) =~ ^specconvert\ \(spectools\)\ [0-9.]+$ ]]
  fails_cleanly specconvert --grd 400:700:10
  [[ $stderr = *"did you mean '--grid'?" ]] || complain "$stderr"
}

@test "bands a thousandth of a nm apart stay what they are" {
  spectral a.exr --size 2x1 --channel S0.589,0000nm --channel S0.589,0010nm \
    --channel S0.589,0014nm --channel S0.589,0020nm
  specconvert a.exr -o b.exr
  specdiff a.exr b.exr
  specconvert --band 589.001 a.exr | specconvert -f spd | grep '^589' >found
  [ "$(cat found)" = '589.001 0.101 0.102' ] || complain "$(cat found)"
}

@test "bins stay where neighbouring bands stay" {
  spectral a.exr --grid 400:700:100 --bins
  specconvert --grid 400:700:100 a.exr -o b.exr
  specdiff a.exr b.exr
  specconvert --band 500 --band 600 a.exr -o c.exr
  exrheader c.exr | grep -q '^spec:bins (type string): "450 550 650"$'
  specconvert --band 400 --band 600 a.exr -o d.exr
  [ "$(exrheader d.exr | grep -c '^spec:bins')" -eq 0 ]
}

@test "samples too large for 16 bits are told" {
  spectral a.exr --pattern constant:70000 --size 2x2 --grid 400:500:100
  specconvert --half a.exr -o b.exr 2>said
  [ "$(cat said)" = 'specconvert: warning: b.exr: 8 samples are too large for 16 bits and became infinite' ] ||
    complain "$(cat said)"
  specconvert -q --half a.exr -o b.exr 2>said
  [ ! -s said ]
}

@test "a product says what it is" {
  specconvert 15-red --multiply D65 >product.spd
  grep -qx '# quantity: spectral power distribution' product.spd
  grep -qx '# title: ColorChecker patch 15 red times CIE standard illuminant D65' product.spd
  [ "$(grep -c '^# unit' product.spd)" -eq 0 ]
  specconvert D65 --multiply 15-red | grep -qx '# quantity: spectral power distribution'
  specconvert 15-red --multiply 16-yellow | grep -qx '# quantity: reflectance'
  specconvert D65 --scale 2 >scaled.spd
  [ "$(grep -c '^# unit' scaled.spd)" -eq 0 ]
}

@test "an index is neither light nor a factor" {
  spectral a.exr --kind T
  fails_cleanly specconvert --illuminate Au a.exr -o b.exr
  [[ $stderr = *"'Au' is a refractive index, not light" ]] || complain "$stderr"
  fails_cleanly specconvert --multiply N-BK7 a.exr -o b.exr
  [[ $stderr = *'refractive index'* ]] || complain "$stderr"
  fails_cleanly specconvert --illuminate 15-red a.exr -o b.exr
}

@test "every column of a curve is a patch, and comes back as a column" {
  printf '# quantity: reflectance\n400 .1 .2 .3\n500 .4 .5 .6\n' >three.spd
  specconvert three.spd -o chart.exr
  specconvert chart.exr -f spd | grep -v '^#' >found
  [ "$(cat found)" = '400 0.1 0.2 0.3
500 0.4 0.5 0.6' ] || complain "$(cat found)"
}

@test "the layout of patches is refused where the output is text" {
  fails_cleanly specconvert --patch 8 15-red
  fails_cleanly specconvert --patches 2x2 -f spd 15-red
}

@test "values per band are not interpolated" {
  spectral a.exr --grid 500:600:50 --quantity 'radiance per band'
  fails_cleanly specconvert --grid 500:600:25 a.exr -o b.exr
  specconvert --scale 2 a.exr -o b.exr
}

# ---- representations ----

# energy FILE: the integral of a curve that is linear between its rows.
energy() {
  specconvert -f spd "$1" | awk '!/^#/ { if (n++) sum += ($1 - nm) * ($2 + value) / 2; nm = $1; value = $2 } END { printf "%.6f\n", sum }'
}

@test "a lamp keeps its energy in every representation" {
  specconvert F2 >table.spd
  energy table.spd >wanted
  for kind in composite:4 composite:4,9 fourier:201 sampled:380:780:5 tabulated; do
    specconvert --to "$kind" F2 -o "$kind.spd"
    specconvert --to tabulated "$kind.spd" -o back.spd
    energy back.spd >found
    [ "$kind" = fourier:201 ] || cmp found wanted || complain "$kind: $(cat found)"
  done
  # The series' energy is a0 / 2 times its range: that of its samples is to their trapezoids.
  a0=$(awk '$1 == "0" { print $2 }' fourier:201.spd)
  awk -v a0="$a0" '{ exit !(a0 * 200 - $1 < 1e-6 * $1 && $1 - a0 * 200 < 1e-6 * $1) }' wanted
}

@test "lines are named by --to composite and survive --multiply and --scale" {
  printf '%s\n' '# title: lamp' '400 1' '500 1' '500.5 1' '501 31' '501.5 1' '502 1' '700 1' >lamp.spd
  printf '%s\n' '# title: filter' '# quantity: transmittance' '400 0' '600 1' '800 1' >filter.spd
  specconvert --to composite:2 lamp.spd -o lines.spd
  [ "$(grep ^line lines.spd)" = 'line 501 15' ] || complain "$(cat lines.spd)"
  specconvert --to composite:2 --scale 2 --multiply filter.spd lines.spd -o product.spd
  [ "$(grep ^line product.spd)" = 'line 501 15.15' ] || complain "$(cat product.spd)"
  grep -qx '# title: lamp times filter' product.spd
  cp lines.spd again.spd
  specconvert --to composite:2 - <lines.spd | cmp - again.spd
  fails_cleanly specconvert --to composite:0 lines.spd
  [[ $stderr = *"'lamp' has 1 line, more than the 0 asked for" ]] || complain "$stderr"
}

@test "a peak is a line where its feet are 30 nm apart or the rows beside it" {
  line() {
    specconvert --to composite:1 "$1" | sed -n 's/^line //p'
  }
  # Triangles with feet 30 and 32 nm apart: the area is half of their width times 10.
  printf '%s\n' '400 1' '485 1' '500 11' '515 1' '600 1' >rows.spd
  specconvert -g 400:600:1 rows.spd >narrow.spd
  [ "$(line narrow.spd)" = '500 150' ] || complain "$(line narrow.spd)"
  sed 's/^485/484/; s/^515/516/' rows.spd | specconvert -g 400:600:1 >broad.spd
  [ -z "$(line broad.spd)" ] || complain "$(line broad.spd)"
  printf '%s\n' '400 1' '450 1' '500 11' '550 1' '600 1' >coarse.spd
  [ "$(line coarse.spd)" = '500 500' ] || complain "$(line coarse.spd)"
}

@test "a spectrum of another kind is read as a curve wherever one is wanted" {
  printf '%s\n' '# representation: fourier' '# range: 400 700' '0 2 0' '1 .5 0' >series.spd
  [ "$(specconvert series.spd | grep -vc '^#')" = 301 ]
  specconvert -g 400:700:150 series.spd | grep -v '^#' >found
  printf '%s\n' '400 1.5' '550 0.5' '700 1.5' | cmp - found || complain "$(cat found)"
  specconvert -g 400:700:100 15-red -o red.exr
  specconvert --illuminate series.spd red.exr -o lit.exr
  has_channels lit.exr S0.400,000000nm S0.500,000000nm S0.600,000000nm S0.700,000000nm
  for change in --to-air '--input-unit um' '--rebin -g 400:700:50'; do
    # shellcheck disable=SC2086 # words
    fails_cleanly specconvert $change series.spd
    [[ $stderr = *'series.spd: units, media and bins are for tables'* ]] || complain "$stderr"
  done
}

@test "--interp says what lies between the rows" {
  printf '%s\n' '400 0 5' '410 1 5' '420 8 5' '430 27 5' '440 64 5' '450 125 5' '460 216 5' >cubes.spd
  check() {
    specconvert --interp "$1" -g 422.5:425:2.5 cubes.spd | grep -v '^#' >found
    printf '%s\n' "${@:2}" | cmp - found || complain "$1:" "$(cat found)"
  }
  check linear '422.5 12.75 5' '425 17.5 5'
  check nearest '422.5 8 5' '425 27 5'
  check left '422.5 8 5' '425 8 5'
  specconvert --interp sprague -g 422.5:425:2.5 cubes.spd | grep -v '^#' |
    awk '{ x = ($1 - 400) / 10; if ($2 - x ^ 3 > 1e-12 || x ^ 3 - $2 > 1e-12 || $3 != 5) exit 1; n++ } END { exit n != 2 }'
  # It is written where the rows stay, and holds for who reads them.
  specconvert --interp left --to tabulated cubes.spd -o left.spd
  grep -qx '# interpolation: left' left.spd
  specconvert -g 422.5:425:2.5 left.spd | grep -v '^#' >found
  printf '%s\n' '422.5 8 5' '425 8 5' | cmp - found
}

@test "what --to and --interp cannot do is said" {
  spectral a.exr
  wrong() {
    fails_cleanly specconvert "${@:2}" || return 1
    [[ $stderr = *"$1"* ]] || complain "$stderr"
  }
  wrong 'is not sampled:LO:HI:STEP, tabulated, fourier:N' --to wavelet:3 F2
  wrong 'odd number of coefficients' --to fourier:8 F2
  wrong "'Au' has 2 columns" --to fourier:9 Au
  wrong 'is not linear, nearest, left or sprague' --interp cubic F2
  wrong "Sprague's interpolation needs equidistant samples" --interp sprague -g 400:410:5 Ag
  wrong 'covers 380..780 nm, not 300 nm' --to sampled:300:700:100 F2
  wrong '--to makes text' --to tabulated F2 -o a2.exr
  wrong '--interp is for --grid' --interp left a.exr
  wrong '--grid and --to exclude each other' -g 400:700:10 --to tabulated F2
  wrong 'has the image'"'"'s own bands' --to sampled:400:700:10 a.exr
}
