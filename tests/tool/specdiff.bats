#!/usr/bin/env bats
# specdiff: what is the same, what is not, and by how much. Other tests rely on its answers.
# shellcheck disable=SC2154 # fails_cleanly leaves its line in stderr

load common

# How far any number may be off before it counts: beyond what images hold. Angles end at pi.
generous='rmse=1e300 max=1e300 sam=4 sam-max=4 psnr=0 gfc=0 gfc-min=0 de2000=1e300 de2000-max=1e300'

# answers STATUS COMMAND...: its exit status; what it prints is left in $answer.
answers() {
  local wanted=$1 code=0
  shift
  answer=$("$@" 2>&1) || code=$?
  [ "$code" -eq "$wanted" ] || complain "exit $code instead of $wanted: $*" "$answer"
}

# same A B: no difference, either way round.
same() {
  answers 0 specdiff "$1" "$2"
  answers 0 specdiff "$2" "$1"
}

# always_differ A B: either way round, and whatever is tolerated.
always_differ() {
  local tolerance all=()
  answers 1 specdiff "$1" "$2"
  answers 1 specdiff "$2" "$1"
  for tolerance in $generous; do
    answers 1 specdiff --tolerance "$tolerance" "$1" "$2"
    all+=(--tolerance "$tolerance")
  done
  answers 1 specdiff "${all[@]}" "$2" "$1"
}

# prints LINE: it is among those of the answer.
prints() {
  grep -qxF -e "$1" <<<"$answer" || complain "no line '$1' in:" "$answer"
}

# last_sample FILE BYTES: the last of an uncompressed file, 4 bytes, becomes another.
last_sample() {
  poke "$1" $(($(wc -c <"$1") - 4)) "$2"
}

# What is the same

@test "a file and itself are the same, and all is printed" {
  spectral a.exr
  answers 0 specdiff a.exr a.exr
  [ "$answer" = 'rmse       0
max        0
sam        0 rad
sam-max    0 rad
psnr       inf dB
gfc        1
gfc-min    1
de2000     0
de2000-max 0' ] || complain "$answer"
}

@test "the same pixels in every lossless compression are the same" {
  spectral none.exr --compression none
  for compression in rle zips zip piz; do
    spectral $compression.exr --compression $compression
    same none.exr $compression.exr
  done
}

@test "the same numbers as HALF and as FLOAT are the same" {
  spectral float.exr --pattern constant:0.625
  spectral half.exr --pattern constant:0.625 --half
  same float.exr half.exr
}

@test "numbers that HALF rounds are not the same" {
  spectral float.exr
  spectral half.exr --half
  answers 1 specdiff float.exr half.exr
}

@test "tiles and lines of the same pixels are the same" {
  spectral lines.exr --size 37x21 --data 3,-5
  exrmaketiled -t 8 4 lines.exr tiles.exr
  same lines.exr tiles.exr
}

@test "a part of a file and a file of its own are the same" {
  spectral a.exr
  spectral b.exr --pattern constant:1
  exrmultipart -combine -i a.exr b.exr -o both.exr >/dev/null
  specconvert --part 1 both.exr -o part.exr
  answers 0 specdiff part.exr b.exr
  answers 1 specdiff part.exr a.exr
}

@test "the last line first in the file is the same image" {
  spectral a.exr --compression none
  reverse_lines a.exr b.exr 8 $((16 * 16 * 4))
  run ! cmp -s a.exr b.exr
  same a.exr b.exr
}

@test "band names of six and of three decimals are the same band" {
  spectral six.exr --size 2x2 --channel S0.410,125000nm --channel S0.420,000000nm
  spectral three.exr --size 2x2 --channel S0.410,125nm --channel S0.420,0nm
  same six.exr three.exr
}

@test "NaN and infinity at the same place on both sides are the same" {
  spectral a.exr --pattern nan:2,3,4 --pattern inf:5,6,7
  cp a.exr b.exr
  same a.exr b.exr
}

@test "bands and edges of bins nearer than 0.001 nm are the same" {
  spectral a.exr --channel S0.500,0nm --channel S0.600,0nm
  spectral b.exr --channel S0.500,0009nm --channel S0.600,0nm
  same a.exr b.exr
  spectral b.exr --channel S0.500,0011nm --channel S0.600,0nm
  answers 1 specdiff a.exr b.exr
  spectral a.exr --grid 500:540:20 --attribute 'spec:bins=490 510 530 550'
  spectral b.exr --grid 500:540:20 --attribute 'spec:bins=490 510.0009 530 550'
  same a.exr b.exr
  spectral b.exr --grid 500:540:20 --attribute 'spec:bins=490 510.0011 530 550'
  answers 1 specdiff a.exr b.exr
}

@test "attributes that say nothing about the samples make no difference" {
  spectral a.exr --attribute 'owner=somebody'
  spectral b.exr --attribute 'comments=something'
  same a.exr b.exr
}

@test "the quantity that is understood may as well be written" {
  spectral implied.exr
  spectral written.exr --quantity 'radiance per nm'
  same implied.exr written.exr
}

@test "pictures without bands are compared by their channels" {
  spectral a.exr --channel R --channel G --channel B
  spectral b.exr --channel R --channel G --channel B --pattern negative
  same a.exr a.exr
  answers 1 specdiff --metric max a.exr b.exr
  # B is band 2 of the ramp: 0.016 + 0.07 + 0.2 at the last pixel; -0.286 on the other side
  prints "max        0.572 at 15,7 in 'B': 0.286000013 and -0.286000013"
}

# What always differs

@test "NaN on one side always differs" {
  spectral a.exr
  spectral b.exr --pattern nan:2,3,4
  always_differ a.exr b.exr
}

@test "NaN on one side of a channel that is no band always differs" {
  spectral a.exr --extra Z
  spectral b.exr --extra Z --pattern nan:2,3,16
  always_differ a.exr b.exr
}

@test "infinity on one side always differs" {
  spectral a.exr
  spectral b.exr --pattern inf:15,7,15
  always_differ a.exr b.exr
}

@test "infinity and NaN at one place always differ" {
  spectral a.exr --pattern nan:0,0,0
  spectral b.exr --pattern inf:0,0,0
  always_differ a.exr b.exr
}

@test "a missing band always differs" {
  spectral a.exr --grid 400:700:20
  spectral b.exr --grid 400:680:20
  always_differ a.exr b.exr
  prints 'bands differ: 15 and 16, the second has 700 nm, the first has not'
}

@test "another band in place of one always differs" {
  spectral a.exr --channel S0.500nm --channel S0.600nm
  spectral b.exr --channel S0.500nm --channel S0.601nm
  always_differ a.exr b.exr
}

@test "an extra channel on one side always differs" {
  spectral a.exr
  spectral b.exr --extra Z
  always_differ a.exr b.exr
  prints "channel 'Z' is only in the first"
}

@test "another name of a channel always differs" {
  spectral a.exr --extra Y
  spectral b.exr --extra Z
  always_differ a.exr b.exr
}

@test "a shifted data window always differs" {
  spectral a.exr --display 0,0,20,20
  spectral b.exr --display 0,0,20,20 --data 1,0
  always_differ a.exr b.exr
  prints 'data windows differ: 1,0,17,8 and 0,0,16,8'
}

@test "a data window of another height always differs" {
  spectral a.exr --display 0,0,20,20
  spectral b.exr --display 0,0,20,20 --size 16x9
  always_differ a.exr b.exr
}

@test "another display window always differs" {
  spectral a.exr --display 0,0,16,8
  spectral b.exr --display 0,0,16,9
  always_differ a.exr b.exr
  prints 'display windows differ: 0,0,16,9 and 0,0,16,8'
}

@test "light and reflectance always differ" {
  spectral a.exr --kind S0
  spectral b.exr --kind T
  always_differ a.exr b.exr
}

@test "another spec:quantity always differs" {
  spectral a.exr --quantity 'radiance per nm'
  spectral b.exr --quantity 'radiance per band'
  always_differ a.exr b.exr
  prints "quantities differ: 'radiance per band' and 'radiance per nm'"
}

@test "reflectance and transmittance always differ" {
  spectral a.exr --kind T
  spectral b.exr --kind T --quantity transmittance
  always_differ a.exr b.exr
}

@test "bins and points always differ" {
  spectral a.exr
  spectral b.exr --bins
  always_differ a.exr b.exr
}

@test "other bins always differ" {
  spectral a.exr --grid 500:540:20 --attribute 'spec:bins=490 510 530 550'
  spectral b.exr --grid 500:540:20 --attribute 'spec:bins=490 510 530 551'
  always_differ a.exr b.exr
  prints 'bins differ: an edge at 551 nm and at 550 nm'
}

@test "other Stokes components always differ" {
  spectral a.exr --kind S0
  spectral b.exr --kind stokes
  always_differ a.exr b.exr
  prints 'Stokes components differ: 4 and 1'
}

@test "images of no common channel always differ" {
  spectral a.exr --channel R
  spectral b.exr --kind T
  always_differ a.exr b.exr
}

@test "ids that differ by 1 where floats no longer tell always differ" {
  # The last id is 2^24; the one after it is the same float.
  spectral a.exr --size 1x257 --grid 500:520:20 --uint-id --compression none
  cp a.exr b.exr
  last_sample b.exr '\x01\x00\x00\x01'
  always_differ a.exr b.exr
}

@test "whole numbers on one side of a channel always differ" {
  spectral a.exr --size 2x2 --uint Z
  spectral b.exr --size 2x2 --extra Z
  always_differ a.exr b.exr
  prints "channel 'Z' holds whole numbers on one side"
}

@test "ids are printed as they are" {
  spectral a.exr --size 1x257 --grid 500:520:20 --uint-id --compression none
  cp a.exr b.exr
  last_sample b.exr '\x01\x00\x00\x01'
  answers 1 specdiff --metric max a.exr b.exr
  prints "max        1 at 0,256 in 'id': 16777216 and 16777217"
}

@test "ids that differ by 1 at the end of 32 bits differ" {
  spectral a.exr --size 1x1 --uint-id --compression none
  cp a.exr b.exr
  last_sample a.exr '\xff\xff\xff\xff'
  last_sample b.exr '\xfe\xff\xff\xff'
  answers 1 specdiff a.exr b.exr
  answers 1 specdiff b.exr a.exr
}

@test "metrics are printed under other display windows, and not under other data windows" {
  spectral a.exr --display 0,0,20,20
  spectral b.exr --display 0,0,20,21
  answers 1 specdiff -m max a.exr b.exr
  prints 'max        0'
  spectral b.exr --display 0,0,20,20 --data 1,0
  answers 1 specdiff -m max a.exr b.exr
  [ "$answer" = 'data windows differ: 0,0,16,8 and 1,0,17,8' ] || complain "$answer"
}

# Numbers in closed form

@test "1 and 1.5 everywhere: rmse 0.5, max 0.5, sam 0, psnr 20 log10 2" {
  spectral a.exr --pattern constant:1
  spectral b.exr --pattern constant:1.5
  answers 1 specdiff a.exr b.exr
  prints 'rmse       0.5'
  prints "max        0.5 at 0,0 in 'S0.400,000000nm': 1 and 1.5"
  prints 'sam        0 rad'
  prints 'sam-max    0 rad'
  prints 'psnr       6.0206 dB'
  prints 'gfc        1'
  prints 'gfc-min    1'
}

@test "the extremes of pixels have their places, and a NaN is one" {
  spectral a.exr --size 4x3 --grid 500:600:50 --pattern constant:1
  spectral nan.exr --size 4x3 --grid 500:600:50 --pattern nan:2,1,0
  spectral ramp.exr --size 4x3 --grid 500:600:50
  extremes=sam-max,gfc-min,gfc-p0,de2000-max,de76-max
  answers 1 specdiff -m $extremes a.exr nan.exr
  for name in sam-max gfc-min gfc-p0 de2000-max de76-max; do
    grep -qE "^$name +-?inf( rad)? at 2,1\$" <<<"$answer" || complain "$answer"
  done
  # The first pixel of the ramp is the farthest from grey.
  answers 1 specdiff -m $extremes a.exr ramp.exr
  for name in sam-max gfc-min gfc-p0; do
    grep -qE "^$name +[0-9.e-]+( rad)? at 0,0\$" <<<"$answer" || complain "$answer"
  done
  answers 0 specdiff -m $extremes a.exr a.exr
  [[ $answer != *" at "* ]]
}

@test "the peak of psnr is the first image's, or what --peak says" {
  spectral a.exr --pattern constant:1
  spectral b.exr --pattern constant:1.5
  answers 1 specdiff --metric psnr b.exr a.exr
  prints 'psnr       9.54243 dB' # 20 log10(1.5 / 0.5)
  answers 1 specdiff --metric psnr --peak 50 a.exr b.exr
  prints 'psnr       40 dB' # 20 log10(50 / 0.5)
  # of -4: 20 log10(4 / (5 / sqrt(16 * 8 * 16)))
  spectral a.exr --pattern constant:1 --compression none
  cp a.exr b.exr
  last_sample a.exr '\x00\x00\x80\xc0'
  answers 1 specdiff --metric psnr a.exr b.exr
  prints 'psnr       31.1751 dB'
}

@test "one sample off by 1 of 2048: rmse 1/sqrt(2048), and its place" {
  spectral a.exr --compression none
  cp a.exr b.exr
  last_sample a.exr '\x00\x00\x00\x40' # 2
  last_sample b.exr '\x00\x00\x40\x40' # 3
  answers 1 specdiff --metric rmse,max a.exr b.exr
  [ "$answer" = "rmse       0.0220971
max        1 at 15,7 in 'S0.700,000000nm': 2 and 3" ] || complain "$answer"
}

@test "the place of the worst sample counts from the data window's corner" {
  spectral a.exr --data 100,-20 --compression none
  cp a.exr b.exr
  last_sample a.exr '\x00\x00\x00\x40'
  last_sample b.exr '\x00\x00\x40\x40'
  answers 1 specdiff --metric max a.exr b.exr
  prints "max        1 at 15,7 in 'S0.700,000000nm': 2 and 3"
}

@test "the first sample that is not finite is told, with their number" {
  spectral a.exr
  spectral b.exr --pattern nan:2,3,4 --pattern inf:1,5,0
  answers 1 specdiff --metric max a.exr b.exr
  # the ramp at 2,3 in band 4: 0.003 + 0.03 + 0.4
  prints "max        inf at 2,3 in 'S0.480,000000nm': 0.432999998 and nan, the first of 2 that are not finite"
}

@test "the angle between (0.001, 0.101) and (1, 1) is pi/4 - atan(0.001 / 0.101)" {
  spectral a.exr --size 1x1 --grid 500:600:100
  spectral b.exr --size 1x1 --grid 500:600:100 --pattern constant:1
  answers 1 specdiff --metric sam,gfc a.exr b.exr
  # 0.785398 - 0.009901 = 0.775497; gfc is its cosine, 0.714073
  [ "$answer" = 'sam        0.775497 rad
gfc        0.714073' ] || complain "$answer"
}

@test "opposite spectra have the angle pi and fit" {
  spectral a.exr
  spectral b.exr --pattern negative
  answers 1 specdiff --metric sam,sam-max,gfc a.exr b.exr
  [ "$answer" = 'sam        3.14159 rad
sam-max    3.14159 rad at 0,0
gfc        1' ] || complain "$answer"
}

@test "two spectra of zeros fit and have no angle; zeros and another do not, at pi/2" {
  spectral a.exr --pattern constant:0
  spectral b.exr --pattern constant:1
  answers 0 specdiff -m sam,gfc a.exr a.exr
  [ "$answer" = 'sam        0 rad
gfc        1' ] || complain "$answer"
  answers 1 specdiff -m sam,gfc a.exr b.exr
  [ "$answer" = 'sam        1.5708 rad
gfc        0' ] || complain "$answer"
}

@test "what is reradiated counts in max alone" {
  spectral a.exr --size 1x1 --channel T.500nm --channel T.600nm --channel T.600nm.500nm \
    --pattern constant:0 --compression none
  cp a.exr b.exr
  last_sample b.exr '\x00\x00\x80\x3f'
  answers 1 specdiff -m rmse,max a.exr b.exr
  [ "$answer" = "rmse       0
max        1 at 0,0 in 'T.600nm.500nm': 0 and 1" ] || complain "$answer"
}

@test "two greys are as far apart as CIEDE2000 has it" {
  # On the observer's whole range a constant T is a grey of luminance T: L* = 116 T^(1/3) - 16,
  # here 50.0000 and 51.5191. Of greys CIEDE2000 leaves dL / S_L, with M = L' - 50 = 0.7596 of
  # their mean L' and S_L = 1 + 0.015 M^2 / sqrt(20 + M^2) = 1.001908: 1.5162584.
  spectral a.exr --kind T --grid 360:830:5 --pattern constant:0.1841865
  spectral b.exr --kind T --grid 360:830:5 --pattern constant:0.1972
  answers 1 specdiff --metric de2000 a.exr b.exr
  [ "$answer" = 'de2000     1.51626' ] || complain "$answer"
}

# Tolerances and metrics

@test "a tolerance just above the difference passes, one just below does not" {
  spectral a.exr --pattern constant:1
  spectral b.exr --pattern constant:1.5
  for metric in rmse max; do
    answers 0 specdiff --tolerance $metric=0.500001 a.exr b.exr
    answers 0 specdiff --tolerance $metric=0.5 a.exr b.exr
    answers 1 specdiff --tolerance $metric=0.499999 a.exr b.exr
  done
}

@test "a tolerance of psnr and of gfc is the least that passes" {
  spectral a.exr --size 1x1 --grid 500:600:100
  spectral b.exr --size 1x1 --grid 500:600:100 --pattern constant:1
  answers 0 specdiff --tolerance gfc=0.714072 a.exr b.exr
  answers 1 specdiff --tolerance gfc=0.714074 a.exr b.exr
  spectral c.exr --pattern constant:1
  spectral d.exr --pattern constant:1.5
  answers 0 specdiff --tolerance psnr=6.0205 c.exr d.exr
  answers 1 specdiff --tolerance psnr=6.0206 c.exr d.exr # 6.02059991
}

@test "one tolerance that is broken is enough" {
  spectral a.exr --pattern constant:1
  spectral b.exr --pattern constant:1.5
  answers 1 specdiff --tolerance rmse=1 --tolerance max=0.1 a.exr b.exr
  prints "max        0.5 at 0,0 in 'S0.400,000000nm': 1 and 1.5 (beyond 0.1)"
  prints 'rmse       0.5'
}

@test "a tolerance of 0 passes what is the same" {
  spectral a.exr
  answers 0 specdiff --tolerance max=0 --tolerance rmse=0 a.exr a.exr
}

@test "a tolerance of what cannot be measured fails" {
  # no observer sees 1000 nm
  spectral a.exr --grid 1000:1100:50
  run ! specdiff --tolerance de2000=1 a.exr a.exr
}

@test "--observer: the CIE's of 2015, and a curve of x, y and z alone" {
  spectral a.exr --kind T --pattern constant:0.5
  spectral b.exr --kind T
  answers 1 specdiff --observer 2015-10 a.exr b.exr
  tall=$(grep '^de2000 ' <<<"$answer")
  answers 1 specdiff --observer cie2015-10 a.exr b.exr
  prints "$tall"
  answers 1 specdiff --observer 1964 a.exr b.exr
  [[ $answer != *"$tall"* ]]
  for sensors in cie2006-lms-2 stiles-burch-1959 v-scotopic; do
    fails_cleanly specdiff --observer $sensors a.exr b.exr
    [[ $stderr = *"need x, y, z" ]] || complain "$stderr"
  done
}

@test "only the metrics that are named are printed" {
  spectral a.exr
  answers 0 specdiff --metric max,rmse a.exr a.exr
  [ "$answer" = 'rmse       0
max        0' ] || complain "$answer"
}

@test "what is printed does not change what is different" {
  spectral a.exr --pattern constant:1
  spectral b.exr --pattern constant:1.5
  answers 1 specdiff --metric sam a.exr b.exr
  [ "$answer" = 'sam        0 rad' ] || complain "$answer"
}

@test "bands that nobody sees are compared without de2000" {
  spectral a.exr --grid 1000:1100:50
  answers 0 specdiff a.exr a.exr
  run ! grep de2000 <<<"$answer"
}

@test "every number of threads prints the same" {
  spectral a.exr --size 61x67 --pattern noise
  spectral b.exr --size 61x67 --pattern grain
  answers 1 specdiff -j 1 a.exr b.exr
  one=$answer
  for threads in 2 3; do
    answers 1 specdiff -j $threads a.exr b.exr
    [ "$answer" = "$one" ] || complain "with $threads threads:" "$answer" "with one:" "$one"
  done
}

# More metrics, in closed form

@test "1 and 1.5 everywhere: mae 0.5, relative 0.5, energy 0.5, and -1/3 the other way round" {
  spectral a.exr --pattern constant:1
  spectral b.exr --pattern constant:1.5
  answers 1 specdiff --metric mae,relative,energy a.exr b.exr
  [ "$answer" = 'mae        0.5
relative   0.5
energy     0.5' ] || complain "$answer"
  answers 1 specdiff --metric energy b.exr a.exr
  prints 'energy     -0.333333'
  answers 0 specdiff --tolerance energy=0.3334 b.exr a.exr
  answers 1 specdiff --tolerance energy=0.3333 b.exr a.exr
}

@test "the energy is an integral: what a wide band has counts as wide as it is" {
  # bins of 100 and 10 nm; 0.5 more in the second: 5 of the first's 100 + 10
  spectral a.exr --size 1x1 --channel S0.450,000000nm --channel S0.505,000000nm \
    --attribute 'spec:bins=400 500 510' --pattern constant:1 --compression none
  cp a.exr b.exr
  last_sample b.exr '\x00\x00\xc0\x3f' # 1.5
  answers 1 specdiff --metric energy a.exr b.exr
  prints 'energy     0.0454545'
}

@test "the energy of points ends half-way between them, that of bands is theirs, and S0's alone" {
  # widths 100, 150 and 200 nm; 0.5 more in the last
  for quantity in nm band; do
    spectral a.exr --size 1x1 --channel S0.500nm --channel S0.600nm --channel S0.800nm \
      --quantity "radiance per $quantity" --pattern constant:1 --compression none
    cp a.exr b.exr
    last_sample b.exr '\x00\x00\xc0\x3f'
    answers 1 specdiff -m energy a.exr b.exr
    case $quantity in nm) prints 'energy     0.222222' ;; *) prints 'energy     0.166667' ;; esac
  done
  spectral a.exr --size 1x1 --kind stokes --pattern constant:1 --compression none
  cp a.exr b.exr
  last_sample b.exr '\x00\x00\xc0\x3f'
  answers 1 specdiff -m energy a.exr b.exr
  prints 'energy     0'
}

@test "the information divergence of (0.001, 0.101) and (1, 1) is 2.262314" {
  # p = (1, 101) / 102, q = (1, 1) / 2: the sum of (p - q) ln(p / q)
  spectral a.exr --size 1x1 --grid 500:600:100
  spectral b.exr --size 1x1 --grid 500:600:100 --pattern constant:1
  answers 1 specdiff --metric sid,sid-max a.exr b.exr
  prints 'sid        2.26231'
  answers 0 specdiff --tolerance sid=0 a.exr a.exr
  spectral dark.exr --size 1x1 --grid 500:600:100 --pattern constant:0
  answers 1 specdiff --metric sid a.exr dark.exr
  prints 'sid        inf'
}

@test "the information divergence takes what is below 0 for 0" {
  spectral a.exr --size 1x1 --grid 500:600:100 --pattern constant:1 --compression none
  cp a.exr b.exr
  last_sample a.exr '\x00\x00\x80\xbf'
  last_sample b.exr '\x00\x00\x00\x00'
  answers 1 specdiff -m sid,max a.exr b.exr
  prints 'sid        0'
}

@test "colours of light: white is the illuminant's, and 2^-EV; values per band are those of their nm" {
  spectral one.exr --kind T --grid 360:830:5 --pattern constant:1
  specconvert --illuminate A one.exr -o a.exr
  specconvert --scale 0.5 a.exr -o b.exr
  # greys beside the white of A, where CIE94 is CIELAB's distance; not beside that of D65
  answers 1 specdiff -m de76,de94 -e -7 --illuminant A a.exr b.exr
  awk '{ d[NR] = $2 } END { exit !(d[1] > 10 && (d[1] - d[2]) ^ 2 < 1e-4) }' <<<"$answer" || complain "$answer"
  answers 1 specdiff -m de76,de94 -e -7 a.exr b.exr
  awk '{ d[NR] = $2 } END { exit !(d[1] - d[2] > 1) }' <<<"$answer" || complain "$answer"
  spectral a.exr --grid 360:830:5 --pattern constant:0.2
  spectral b.exr --grid 360:830:5 --pattern constant:0.1
  answers 1 specdiff -m de2000 -e 1 a.exr b.exr
  wanted=$answer
  spectral a.exr --grid 360:830:5 --pattern constant:2 --quantity 'radiance per band'
  spectral b.exr --grid 360:830:5 --pattern constant:1 --quantity 'radiance per band'
  answers 1 specdiff -m de2000 a.exr b.exr
  awk -v wanted="${wanted##* }" '{ exit !(wanted > 10 && ($2 / wanted - 1) ^ 2 < 1e-8) }' <<<"$answer" || complain "$answer" "$wanted"
}

@test "two greys are as far apart in CIELAB and CIE94 as their lightness" {
  # L* = 116 T^(1/3) - 16: 50.00000 and 51.51914
  spectral a.exr --kind T --grid 360:830:5 --pattern constant:0.1841865
  spectral b.exr --kind T --grid 360:830:5 --pattern constant:0.1972
  answers 1 specdiff --metric de76,de94,de94-max a.exr b.exr
  grep -qE '^de76       1\.5191' <<<"$answer" || complain "$answer"
  grep -qE '^de94       1\.5191' <<<"$answer" || complain "$answer"
}

@test "the largest of a metric is its last percentile" {
  spectral a.exr --pattern grain
  spectral b.exr
  answers 1 specdiff -m sam-max,sid-max,de76-max,de94-max,de2000-max,sid-p100,de76-p100,de94-p100 a.exr b.exr
  for metric in sid de76 de94; do
    prints "$(printf '%-10s %s' $metric-max "$(sed -n "s/^$metric-p100 *//p" <<<"$answer")")"
  done
}

@test "percentiles are those of the pixels, by nearest rank" {
  spectral a.exr --size 10x1 --grid 500:600:100 --pattern constant:0
  spectral b.exr --size 10x1 --grid 500:600:100
  # the largest of pixel x is (x + 1) * 0.001 + 0.1
  answers 1 specdiff --metric max-p50,max-p51,max-p100,max-p0,max-p10 a.exr b.exr
  prints 'max-p50    0.105 at 4,0'
  prints 'max-p51    0.106 at 5,0'
  prints 'max-p100   0.11 at 9,0'
  prints 'max-p0     0.101 at 0,0'
  prints 'max-p10    0.101 at 0,0'
  answers 0 specdiff --tolerance max-p50=0.1051 a.exr b.exr
  answers 1 specdiff --tolerance max-p50=0.1049 a.exr b.exr
  # of 100 pixels N percent are N, exactly
  spectral c.exr --size 100x1 --grid 500:600:100 --pattern constant:0
  spectral d.exr --size 100x1 --grid 500:600:100
  answers 1 specdiff --metric max-p7,max-p28,max-p29,max-p57,max-p99 c.exr d.exr
  prints 'max-p7     0.107 at 6,0'
  prints 'max-p28    0.128 at 27,0'
  prints 'max-p29    0.129 at 28,0'
  prints 'max-p57    0.157 at 56,0'
  prints 'max-p99    0.199 at 98,0'
  fails_cleanly specdiff --metric max-p101 a.exr b.exr
  fails_cleanly specdiff --metric psnr-p50 a.exr b.exr
  fails_cleanly specdiff --metric max-p a.exr b.exr
}

@test "a NaN on one side is beyond every percentile's tolerance and makes every mean infinite" {
  spectral a.exr
  spectral b.exr --pattern nan:2,3,4
  for metric in mae relative energy sid de76 de94 max-p1 de2000-p50; do
    answers 1 specdiff --tolerance $metric=1e300 a.exr b.exr
  done
  answers 1 specdiff --metric mae,sid,max-p100 a.exr b.exr
  prints 'mae        inf'
  prints 'sid        inf'
  prints 'max-p100   inf at 2,3'
}

@test "--bands tells them one by one" {
  spectral a.exr --size 2x1 --grid 500:600:100 --pattern constant:0
  spectral b.exr --size 2x1 --grid 500:600:100
  # 0.001 0.002 and 0.101 0.102
  answers 1 specdiff --metric rmse --bands a.exr b.exr
  [ "$(tail -n 3 <<<"$answer" | tr -s ' ')" = 'band rmse mae max relative psnr
S0.500,000000nm 0.00158114 0.0015 0.002 inf -inf
S0.600,000000nm 0.101501 0.1015 0.102 inf -inf' ] || complain "$answer"
  # The other way round: all of a is the difference, and the peak 0.102 is that of both bands.
  answers 1 specdiff --metric psnr --bands b.exr a.exr
  [ "$(tr -s ' ' <<<"$answer")" = 'psnr 3.05182 dB
band rmse mae max relative psnr
S0.500,000000nm 0.00158114 0.0015 0.002 1 36.1926
S0.600,000000nm 0.101501 0.1015 0.102 1 0.042577' ] || complain "$answer"
  answers 1 specdiff --metric max --bands --peak 10.2 b.exr a.exr
  grep -q ' 76\.1926$' <<<"$answer" || complain "$answer"
  answers 1 specdiff --json --bands b.exr a.exr
  [ "$(jq -c '[.bands[1].relative, (.bands[0].psnr * 1000 | round)]' <<<"$answer")" = '[1,36193]' ] ||
    complain "$answer"
}

@test "--same-within: the tile that says most ends with the image, and nothing has no tile" {
  spectral a.exr --channel S0.500nm --size 18x10
  spectral b.exr --channel S0.500nm --size 18x10 --pattern constant:0
  answers 1 specdiff --same-within 3 --crop 2,0,18,9 a.exr b.exr
  # All d have one sign: z of the band is that of its only tile, which comes first.
  grep -qF "at 2,0 to 18,9, z" <<<"$answer" || complain "$answer"
  specconvert --scale 1e30 a.exr | specconvert --scale 1e30 -o inf.exr
  specdiff -m max --same-within 3 --bands inf.exr inf.exr >out
  grep -qx 'the same within.*differences' out || complain "$(cat out)"
}

@test "--json tells all of it" {
  spectral a.exr --pattern constant:1
  spectral b.exr --pattern constant:1.5
  answers 1 specdiff --json --bands -m all,max-p99 -t max=0.1 -t rmse=1 a.exr b.exr
  [ "$(jq -c '[.same, .measured, .metrics.max.value, .metrics.max.at, .metrics.max.within,
    .metrics.rmse.within, .metrics.rmse.tolerance, .metrics.psnr.unit, .metrics.max.wavelength_nm,
    .images[1].bands, .region, .pixels, (.bands | length), .bands[15].wavelength_nm, .bands[3].mae,
    .metrics["max-p99"].value]' <<<"$answer")" = \
    '[false,true,0.5,[0,0],false,true,1,"dB",400,16,[0,0,16,8],128,16,700,0.5,0.5]' ] ||
    complain "$answer"
  answers 0 specdiff --json a.exr a.exr
  [ "$(jq -c '[.same, .metrics.psnr.value, .metrics.psnr.infinite, .structure]' <<<"$answer")" = \
    '[true,null,"+",[]]' ] || complain "$answer"
  spectral c.exr --grid 400:500:20
  answers 1 specdiff --json a.exr c.exr
  [ "$(jq -c '[.same, .measured, (.structure | length), .metrics]' <<<"$answer")" = \
    '[false,false,2,null]' ] || complain "$answer"
}

@test "--json: what is not finite, bits, another grid and the noise" {
  spectral a.exr
  spectral b.exr --pattern nan:2,3,4 --pattern inf:1,5,0
  answers 1 specdiff --json -m all,max-p50 --exact --same-within 3sigma a.exr b.exr
  [ "$(jq -c '[(.metrics | length), .metrics.max.infinite, .metrics.max.not_finite, .metrics.max.at, .metrics.max.channel,
    .metrics.psnr.infinite, .metrics["gfc-min"].infinite, .exact.differing, .exact.at,
    .images[0].file, .images[0].width, .images[0].height, .images[0].low_nm, .images[0].high_nm, .notes]' <<<"$answer")" = \
    '[19,"+",2,[2,3],"S0.480,000000nm","-","-",2,[2,3],"a.exr",16,8,400,700,[]]' ] || complain "$answer"
  spectral b.exr --pattern constant:1
  answers 1 specdiff --json --exact --same-within 3sigma a.exr b.exr
  [ "$(jq -c '[.exact.differing, .exact.at, .exact.channel, .exact.b, .same_within.kind, .same_within.channel, .same_within.wavelength_nm,
    .same_within.at, .same_within.statistics, .same_within.alarm > 0.00269, .same_within.alarm < 0.0027,
    .same_within.mean_difference < 0]' <<<"$answer")" = \
    '[2048,[0,0],"S0.400,000000nm",1,"tile","S0.400,000000nm",400,[0,0],48,true,true,true]' ] || complain "$answer"
  specconvert --grid 410:690:10 a.exr -o fine.exr
  answers 0 specdiff --json --resample -t max=2e-7 a.exr fine.exr
  [ "$(jq -c .notes <<<"$answer")" = '["resampled to the first'"'"'s grid: 420 to 680 nm in 14 bands of 16 and 29"]' ] || complain "$answer"
  # values per band are on no other grid
  spectral a.exr --quantity 'radiance per band'
  spectral fine.exr --grid 410:690:10 --quantity 'radiance per band'
  answers 1 specdiff --json --resample a.exr fine.exr
  [ "$(jq -c .measured <<<"$answer")" = false ] || complain "$answer"
}

# Other grids, formats and pictures

@test "different grids are refused with both named, and compared over their overlap on request" {
  spectral a.exr
  specconvert --grid 410:690:10 a.exr -o fine.exr
  answers 1 specdiff a.exr fine.exr
  prints 'grids: 400 to 700 nm in 16 bands and 410 to 690 nm in 29 (--resample compares their overlap)'
  # the ramp is straight in wavelength: nothing is lost between the bands
  answers 0 specdiff --resample --tolerance max=2e-7 a.exr fine.exr
  prints "resampled to the first's grid: 420 to 680 nm in 14 bands of 16 and 29"
  answers 0 specdiff --resample --tolerance max=2e-7 fine.exr a.exr
  prints "resampled to the second's grid: 420 to 680 nm in 14 bands of 29 and 16"
  specconvert --scale 1.1 fine.exr -o more.exr
  answers 1 specdiff --resample -m relative,max a.exr more.exr
  prints 'relative   0.1'
  # the last band of the overlap: 1.4 + 0.016 + 0.07, a tenth of it
  grep -qF "at 15,7 in 'S0.680,000000nm': 1.48599994 and 1.634" <<<"$answer" || complain "$answer"
}

@test "bins are compared by the energy in what they share" {
  spectral a.exr --grid 410:690:20 --bins
  specconvert --grid 430:670:60 --rebin a.exr -o wide.exr
  answers 0 specdiff --resample --tolerance max=2e-7 a.exr wide.exr
  prints "resampled to the second's grid: 430 to 670 nm in 5 bands of 15 and 5"
  specconvert --scale 1.1 a.exr -o more.exr
  answers 1 specdiff --resample --tolerance max=0.01 more.exr wide.exr
}

@test "grids without an overlap, and bins against points, stay different" {
  spectral a.exr
  spectral far.exr --grid 900:1000:20
  answers 1 specdiff --resample a.exr far.exr
  prints 'no band of the coarser grid lies in the other'
  spectral bins.exr --bins
  answers 1 specdiff --resample a.exr bins.exr
  prints 'bands differ: one has bins, the other has point samples'
}

@test "ENVI, TIFF and hsr are compared with EXR" {
  spectral a.exr
  spectral b.exr --bins
  specconvert a.exr -o a.img
  specconvert a.exr -o a.tif
  specconvert b.exr -o b.hsr
  same a.exr a.img
  same a.exr a.tif
  specconvert b.hsr -o d.exr # its own bins
  same d.exr b.hsr
  specconvert --scale 1.5 a.exr -o c.img
  answers 1 specdiff -m relative a.tif c.img
  prints 'relative   0.5'
}

@test "pictures have colour differences: of sRGB's R, G and B" {
  # red 255,0,0 and green 0,255,0: CIELAB 53.24, 80.09, 67.20 and 87.73, -86.18, 83.18 (Lindbloom)
  printf 'P6 1 1 255\n\377\000\000' >red.ppm
  printf 'P6 1 1 255\n\000\377\000' >green.ppm
  if command -v oiiotool >/dev/null; then
    oiiotool red.ppm -o red.png && oiiotool green.ppm -o green.png
  else
    skip 'no oiiotool to make a PNG'
  fi
  answers 1 specdiff -m de76,max red.png green.png
  grep -qE '^de76       170\.5' <<<"$answer" || complain "$answer"
  grep -qE "^max        1 at 0,0 in 'G': 0 and 1" <<<"$answer" || complain "$answer"
}

@test "pictures have the colours of their chromaticities, at the exposure that is given" {
  spectral a.exr --kind T
  spectral b.exr --kind T --pattern constant:0.4
  for side in a b; do
    spec2rgb $side.exr -o $side.srgb.exr
    spec2rgb -e -3 $side.exr -o $side.dark.exr
    spec2rgb --space p3 $side.exr -o $side.p3.exr
  done
  answers 1 specdiff -m de76 a.srgb.exr b.srgb.exr
  wanted=${answer##* }
  for pair in 'dark -e 3' 'p3 -e 0'; do
    # shellcheck disable=SC2086 # several words
    answers 1 specdiff -m de76 ${pair#* } "a.${pair%% *}.exr" "b.${pair%% *}.exr"
    awk -v wanted="$wanted" '{ exit !(wanted > 10 && ($2 / wanted - 1) ^ 2 < 1e-8) }' <<<"$answer" ||
      complain "$pair: $answer instead of $wanted"
  done
}

@test "a picture is compared with what an image shows" {
  for kind in T S0; do
    spectral a.exr --kind $kind --pattern constant:0.4
    spec2rgb a.exr --observer 1964 --illuminant A -e -1 --space p3 -o b.exr
    options=(--observer 1964 --illuminant A -e -1 -t de2000-max=1e-4 -t max=1e-6)
    answers 0 specdiff "${options[@]}" a.exr b.exr
    [[ $answer == "the first as spec2rgb shows it, in the primaries of the second; "* ]] || complain "$answer"
    answers 0 specdiff "${options[@]}" b.exr a.exr
    [[ $answer == "the second as spec2rgb shows it, in the primaries of the first; "* ]] || complain "$answer"
    answers 0 specdiff -m rmse -t max=1e-6 "${options[@]:0:6}" a.exr b.exr
    answers 1 specdiff -t de2000-max=1 "${options[@]:0:4}" -e 0 a.exr b.exr
    answers 1 specdiff -t de2000-max=0.05 --illuminant A -e -1 a.exr b.exr
  done
}

@test "what an image shows is as far from a picture as its own picture is" {
  spectral a.exr --kind T
  spectral b.exr --kind T --pattern constant:0.4
  spec2rgb -e 2 a.exr -o a.shown.exr
  spec2rgb b.exr -o b.shown.exr
  answers 1 specdiff -m de2000,max-p50,rmse a.shown.exr b.shown.exr
  wanted=$answer
  answers 1 specdiff -e 2 -m de2000,max-p50,rmse a.exr b.shown.exr
  [ "${answer#*$'\n'}" = "$wanted" ] || complain "$answer instead of $wanted"
}

@test "a picture of 8 bits is as near to its image as codes are; its primaries count" {
  spectral a.exr --kind T --pattern constant:0.4
  spec2rgb a.exr -o a.png
  answers 0 specdiff -t max=0.0032 -t de2000-max=1 a.exr a.png
  spec2rgb a.exr --space rec2020 --bits 16 -o b.png
  answers 0 specdiff -t max=2e-5 -t de2000-max=0.01 a.exr b.png
  specdiff --bands --json a.exr b.png >said || true
  [ "$(jq -r '[.bands[].channel] | join(" ")' said)" = 'R G B' ] || complain "$(<said)"
}

@test "a picture bit for bit, of another size, or without colours is no picture of the image" {
  spectral a.exr --kind T
  spec2rgb a.exr -o a.png
  answers 1 specdiff --exact a.exr a.png
  [[ $answer == 'bands differ: '*', of different kinds'* ]] || complain "$answer"
  specconvert --crop 0,0,8,8 a.exr -o b.exr
  answers 1 specdiff b.exr a.png
  [[ $answer == 'data windows differ: '* && $answer != *rmse* ]] || complain "$answer"
  for channels in '--channel Y' '--channel G --channel B --uint R'; do
    # shellcheck disable=SC2086 # several words
    spectral b.exr $channels
    answers 1 specdiff a.exr b.exr
    [[ $answer == 'bands differ: '* ]] || complain "$channels: $answer"
  done
}

# Regions

@test "--crop: what lies outside does not count" {
  spectral a.exr --compression none
  cp a.exr b.exr
  last_sample b.exr '\x00\x00\x40\x40'
  answers 1 specdiff a.exr b.exr
  answers 0 specdiff --crop 0,0,15,8 a.exr b.exr
  answers 0 specdiff --crop 0,0,16,7 a.exr b.exr
  answers 1 specdiff -m max,max-p100 --crop 15,7,16,8 a.exr b.exr
  prints "max        1.414 at 15,7 in 'S0.700,000000nm': 1.58599997 and 3"
  prints 'max-p100   1.414 at 15,7'
  fails_cleanly specdiff --crop 0,0,17,8 a.exr b.exr
  fails_cleanly specdiff --crop 3,3,3,4 a.exr b.exr
}

@test "--mask: what lies outside does not count" {
  # id is x + 65536 y: 458767 at 15,7
  spectral a.exr --size 16x8 --uint-id --compression none
  spectral b.exr --size 16x8 --uint-id --compression none --pattern inf:15,7,15
  answers 1 specdiff a.exr b.exr
  answers 1 specdiff --mask id=458767 a.exr b.exr
  prints "max        inf at 15,7 in 'S0.700,000000nm': 1.58599997 and inf, the first of 1 that are not finite"
  answers 0 specdiff --mask id=458766 a.exr b.exr
  answers 1 specdiff --mask id a.exr b.exr
  spectral mask.exr --channel Y --channel Z --pattern constant:1 --compression none
  answers 1 specdiff --mask mask.exr:Y a.exr b.exr
  last_sample mask.exr '\x00\x00\x00\x00'
  answers 0 specdiff --mask mask.exr:Z a.exr b.exr
  answers 1 specdiff --mask mask.exr:Y a.exr b.exr
  fails_cleanly specdiff --mask id=458768 a.exr b.exr
  [[ $stderr = *'leaves no pixel'* ]]
  spectral small.exr --size 8x8 --channel Y
  fails_cleanly specdiff --mask small.exr a.exr b.exr
  fails_cleanly specdiff --mask nothing a.exr b.exr
}

@test "--mask: the one channel of a file, whole numbers of one, and the first's own by its name" {
  spectral a.exr --size 4x2
  spectral b.exr --size 4x2 --pattern inf:2,1,3
  spectral one.exr --size 4x2 --channel mask --pattern constant:1 --compression none
  answers 1 specdiff --mask one.exr a.exr b.exr
  spectral ids.exr --size 4x2 --channel Z --uint id
  answers 1 specdiff -m max-p100 --mask ids.exr:id=65538 a.exr b.exr
  prints 'max-p100   inf at 2,1'
  answers 0 specdiff --mask ids.exr:id=65539 a.exr b.exr
  fails_cleanly specdiff --mask ids.exr a.exr b.exr
  [[ $stderr = *"ids.exr: which of its 2 channels is the mask? (--mask FILE:CHANNEL)" ]]
  fails_cleanly specdiff --mask ids.exr:Z=1 a.exr b.exr
  [[ $stderr = *"its channel 'Z' holds no whole numbers (UINT)" ]]
}

# Bit for bit

@test "--exact: one ULP, the sign of 0 and the bits of a NaN count, whatever is tolerated" {
  spectral a.exr --size 1x1 --compression none
  last_sample a.exr '\x00\x00\x80\x3f'
  answers 0 specdiff --exact a.exr a.exr
  prints 'exact      all bits are the same'
  cp a.exr b.exr
  last_sample b.exr '\x01\x00\x80\x3f'
  answers 0 specdiff -t max=1 a.exr b.exr
  answers 1 specdiff --exact -t max=1 a.exr b.exr
  prints "exact      1 samples differ, the first at 0,0 in 'S0.700,000000nm': 1 (0x3f800000) and 1.00000012 (0x3f800001)"
  last_sample a.exr '\x00\x00\x00\x80'
  last_sample b.exr '\x00\x00\x00\x00'
  answers 0 specdiff a.exr b.exr
  answers 1 specdiff --exact a.exr b.exr
  last_sample a.exr '\x00\x00\xc0\x7f'
  last_sample b.exr '\x01\x00\xc0\x7f'
  answers 0 specdiff a.exr b.exr
  answers 1 specdiff --exact a.exr b.exr
  last_sample b.exr '\x00\x00\xc0\x7f'
  answers 0 specdiff --exact a.exr b.exr
}

@test "another unit always differs" {
  spectral a.exr --attribute 'emissiveUnits=W.m^-2.sr^-1'
  spectral b.exr --attribute 'emissiveUnits=mW.m^-2.sr^-1'
  always_differ a.exr b.exr
  prints "units differ: 'mW.m^-2.sr^-1' and 'W.m^-2.sr^-1'"
  spectral c.exr --without emissiveUnits
  same a.exr c.exr
}

# Within the noise

@test "--same-within: two seeds are the same, another scale or colour is not" {
  cat >scene.pbrt <<'END'
LookAt 0 0 -3  0 0 0  0 1 0
Camera "perspective" "float fov" 45
Film "rgb" "integer xresolution" 40 "integer yresolution" 40
WorldBegin
AttributeBegin
  AreaLightSource "diffuse" "spectrum L" "D65" "float scale" 0.1
  Translate 0 2 -4
  Shape "disk" "float radius" 2.5
AttributeEnd
Material "diffuse" "spectrum reflectance" "15-red"
Shape "sphere"
END
  sed 's/15-red/14-green/' scene.pbrt >green.pbrt
  for seed in 1 2; do
    specrender --spp 4 --seed $seed scene.pbrt -o $seed.exr
  done
  specrender --spp 4 --seed 2 green.pbrt -o green.exr
  specconvert --scale 1.1 2.exr -o brighter.exr
  answers 1 specdiff 1.exr 2.exr
  answers 0 specdiff --same-within 3sigma 1.exr 2.exr
  grep -q '^the same within 3 sigma: p .*noise from the differences' <<<"$answer" || complain "$answer"
  answers 0 specdiff --same-within 2 2.exr 1.exr
  answers 1 specdiff --same-within 3sigma 1.exr brighter.exr
  grep -q '^not the same within 3 sigma: p ' <<<"$answer" || complain "$answer"
  answers 1 specdiff --same-within 3sigma --json 1.exr green.exr
  [ "$(jq -c '.same_within | [.sigma, .same, .noise, .p < 1e-9]' <<<"$answer")" = \
    '[3,false,"differences",true]' ] || complain "$answer"
  one=$answer
  answers 1 specdiff -j 3 --same-within 3sigma --json 1.exr green.exr
  [ "$answer" = "$one" ] || complain "$answer" 'instead of' "$one"
}

@test "--same-within: variances that the files have tell what is noise" {
  # 128 differences of 0.5 have one sign; with variances 1 and 1.5 z is 3.58 of 3.93
  for value in 1 1.5 2; do
    spectral plain$value.exr --channel S0.500nm --pattern constant:$value
    spectral $value.exr --channel S0.500nm --extra variance.S0.500nm --pattern constant:$value
  done
  answers 1 specdiff --same-within 3sigma plain1.exr plain1.5.exr
  answers 0 specdiff --same-within 3sigma 1.exr 1.5.exr
  grep -q 'noise from the channels variance.*, z -3.58, mean difference -0.5' <<<"$answer" || complain "$answer"
  answers 1 specdiff --same-within 3sigma 1.exr 2.exr
}

@test "--noise: from the differences though there are variances, or from these alone" {
  for value in 1 1.5; do
    spectral plain$value.exr --channel S0.500nm --pattern constant:$value
    spectral $value.exr --channel S0.500nm --extra variance.S0.500nm --pattern constant:$value
  done
  answers 0 specdiff --same-within 3 --noise variance 1.exr 1.5.exr
  answers 1 specdiff --same-within 3 --noise differences 1.exr 1.5.exr
  grep -q 'noise from the differences; .*, z -11.3, mean' <<<"$answer" || complain "$answer"
  fails_cleanly specdiff --same-within 3 --noise variance plain1.exr plain1.5.exr
  [[ $stderr = *'not both images have variances of all bands'* ]] || complain "$stderr"
  fails_cleanly specdiff --noise variance 1.exr 1.5.exr
  fails_cleanly specdiff --same-within 3 --noise white 1.exr 1.5.exr
}

# Before they were left out, all of them, and what was left was the same.
@test "--same-within: variances below 0, and such that are not finite, are refused" {
  band='--channel S0.500nm --extra variance.S0.500nm'
  # shellcheck disable=SC2086 # words
  for value in -1 -9; do
    spectral $value.exr $band --pattern constant:$value
    fails_cleanly specdiff --same-within 3sigma -- -1.exr $value.exr
    [[ $stderr = 'specdiff: the noise of 128 samples is not known'* ]] || complain "$stderr"
  done
  # Channel 1 is the variance.
  # shellcheck disable=SC2086
  spectral nan.exr $band --pattern nan:2,3,1
  fails_cleanly specdiff --same-within 3sigma nan.exr nan.exr
  [[ $stderr = 'specdiff: the noise of 1 samples is not known'* ]] || complain "$stderr"
}

@test "--same-within: a NaN differs, and too few pixels are told" {
  spectral a.exr
  spectral b.exr --pattern nan:2,3,4
  answers 1 specdiff --same-within 9sigma a.exr b.exr
  fails_cleanly specdiff --same-within 3sigma --crop 0,0,3,3 a.exr b.exr
  [[ $stderr = *'9 pixels are too few for a test at 3 sigma'* ]]
  for sigma in 0 x 3sig -1 '' 11; do
    fails_cleanly specdiff --same-within "$sigma" a.exr b.exr
  done
}

# Pictures of the differences

# ppm_pixel FILE X Y: its red, green and blue.
ppm_pixel() {
  local width
  width=$(head -c 40 "$1" | grep -a -m 1 -oE '^[0-9]+ ' | tr -d ' ')
  tail -c "$(($(ppm_height "$1") * width * 3))" "$1" | od -An -v -tu1 -w3 |
    awk -v at=$(($3 * width + $2)) 'NR == at + 1 { print $1, $2, $3; exit }'
}

ppm_height() {
  head -c 40 "$1" | grep -a -m 1 -oE '^[0-9]+ [0-9]+' | cut -d ' ' -f 2
}

@test "--heatmap: dark where alike, yellow at the largest, magenta at infinity, a legend below" {
  spectral a.exr --size 300x20 --grid 500:600:100 --pattern constant:0 --pattern inf:7,0,0
  spectral b.exr --size 300x20 --grid 500:600:100 --pattern constant:0
  spectral ramp.exr --size 300x20 --grid 500:600:100
  answers 1 specdiff -m max --heatmap map.ppm --heatmap-metric max b.exr ramp.exr
  [ "$(ppm_height map.ppm)" = 54 ] || complain "$(ppm_height map.ppm)"
  # the largest, 0.3 + 0.19 + 0.1, is in the last corner; the first pixel has 0.101 of it
  [ "$(ppm_pixel map.ppm 299 19)" = '253 231 37' ] || complain "$(ppm_pixel map.ppm 299 19)"
  [ "$(ppm_pixel map.ppm 4 24)" = '68 1 84' ] || complain "$(ppm_pixel map.ppm 4 24)" # the legend
  [ "$(ppm_pixel map.ppm 295 24)" = '253 231 37' ]
  # 0.101 / 0.59 of 51 steps: 8.7305, between (.270595 .214069 .507052) and (.263663 .237631 .518762)
  [ "$(ppm_pixel map.ppm 0 0)" = '68 59 131' ] || complain "$(ppm_pixel map.ppm 0 0)"
  answers 1 specdiff -m max --heatmap map.ppm --heatmap-metric max --heatmap-max 0.101 b.exr ramp.exr
  [ "$(ppm_pixel map.ppm 0 0)" = '253 231 37' ]
  answers 1 specdiff --heatmap inf.ppm a.exr b.exr
  [ "$(ppm_pixel inf.ppm 7 0)" = '255 0 255' ]
  [ "$(ppm_pixel inf.ppm 8 0)" = '68 1 84' ]
  answers 0 specdiff --heatmap same.png b.exr b.exr
  [ -s same.png ]
}

# 0.9991 and 0.9994 are 0.999 by three digits, and what is half-way from there to 1 would be 1.
@test "--heatmap: the legend tells numbers apart that are nearly 1" {
  spectral a.exr --grid 500:600:50
  for most in 9 6; do
    answers 0 specdiff --heatmap-metric gfc --heatmap-max 0.000$most --heatmap $most.ppm a.exr a.exr
  done
  run ! cmp 9.ppm 6.ppm
}

@test "--heatmap: grey outside the mask" {
  spectral a.exr --uint-id
  answers 0 specdiff --mask id=3 --heatmap map.ppm a.exr a.exr
  [ "$(ppm_pixel map.ppm 2 0)" = '128 128 128' ]
  [ "$(ppm_pixel map.ppm 3 0)" = '68 1 84' ]
}

@test "--side-by-side: what spec2rgb shows of both, and the map" {
  spectral a.exr --size 100x8
  spectral b.exr --size 100x8 --pattern constant:0.5
  answers 1 specdiff --side-by-side both.ppm -e -1 --heatmap-metric rmse a.exr b.exr
  for side in a b; do
    spec2rgb -e -1 $side.exr -o $side.ppm
  done
  for x in 0 50 99; do
    for y in 0 7; do
      [ "$(ppm_pixel both.ppm $x $y)" = "$(ppm_pixel a.ppm $x $y)" ] ||
        complain "$(ppm_pixel both.ppm $x $y)" "$(ppm_pixel a.ppm $x $y)"
      [ "$(ppm_pixel both.ppm $((x + 104)) $y)" = "$(ppm_pixel b.ppm $x $y)" ]
    done
  done
  [ "$(ppm_pixel both.ppm 101 3)" = '255 255 255' ]
}

@test "--heatmap: de2000 unless another is named; gfc from 1 down" {
  spectral a.exr --size 300x4 --pattern constant:1 --compression none
  cp a.exr b.exr
  last_sample b.exr '\x00\x00\x00\x40'
  for metric in gfc max de2000; do
    answers 1 specdiff --heatmap $metric.ppm --heatmap-metric $metric a.exr b.exr
    [ "$(ppm_pixel $metric.ppm 0 0)" = '68 1 84' ] || complain "$metric: $(ppm_pixel $metric.ppm 0 0)"
    [ "$(ppm_pixel $metric.ppm 299 3)" = '253 231 37' ] || complain "$metric: $(ppm_pixel $metric.ppm 299 3)"
  done
  answers 1 specdiff --heatmap usual.ppm a.exr b.exr
  cmp usual.ppm de2000.ppm
  run ! cmp -s usual.ppm max.ppm
}

@test "--side-by-side: adapted from the white of the illuminant" {
  spectral a.exr --kind T --size 100x4
  spectral b.exr --kind T --size 100x4 --pattern constant:0.5
  answers 1 specdiff --side-by-side both.ppm --illuminant A --observer 1964 a.exr b.exr
  for side in a b; do
    spec2rgb --illuminant A --observer 1964 --adapt bradford $side.exr -o $side.ppm
  done
  for x in 0 50 99; do
    [ "$(ppm_pixel both.ppm $x 2)" = "$(ppm_pixel a.ppm $x 2)" ]
    [ "$(ppm_pixel both.ppm $((x + 104)) 2)" = "$(ppm_pixel b.ppm $x 2)" ]
  done
}

@test "pictures: a format that is not known, colours that are not there, a full device" {
  spectral a.exr
  fails_cleanly specdiff --heatmap map.xyz a.exr a.exr
  fails_cleanly specdiff --heatmap map.png --heatmap-metric psnr a.exr a.exr
  spectral far.exr --grid 1000:1100:50
  fails_cleanly specdiff --heatmap map.png --heatmap-metric de94 far.exr far.exr
  fails_cleanly specdiff --side-by-side map.png far.exr far.exr
  answers 0 specdiff --heatmap map.png far.exr far.exr
  fails_cleanly specdiff --heatmap - a.exr a.exr
  [[ $stderr = *"two outputs would both be written to '-'" ]]
  fails_cleanly specdiff --heatmap map.png --side-by-side map.png a.exr a.exr
  fails_cleanly specdiff -o map.png --side-by-side map.png a.exr a.exr
  fails_cleanly specdiff --heatmap nowhere/map.png a.exr a.exr
  no_leftovers . a.exr far.exr map.png
  # images that cannot be measured leave no picture
  answers 1 specdiff --heatmap other.png a.exr far.exr
  no_leftovers . a.exr far.exr map.png
}

# Input, output and usage

@test "either image can come from standard input" {
  spectral a.exr
  cp a.exr b.exr
  spectral c.exr --pattern negative
  answers 0 specdiff - a.exr <b.exr
  answers 0 specdiff a.exr - <b.exr
  answers 0 specdiff a.exr - < <(cat a.exr)
  answers 1 specdiff - c.exr < <(cat a.exr)
}

@test "both images on standard input are refused" {
  fails_cleanly specdiff - -
}

@test "both images can come from process substitutions" {
  spectral a.exr
  answers 0 specdiff <(cat a.exr) <(cat a.exr)
}

@test "one image or three are refused" {
  spectral a.exr
  fails_cleanly specdiff a.exr
  fails_cleanly specdiff a.exr a.exr a.exr
  fails_cleanly specdiff
}

@test "what is said of pictures is refused where there are none" {
  spectral a.exr
  for option in --heatmap-metric=max --heatmap-max=1; do
    fails_cleanly specdiff $option a.exr a.exr
    [[ $stderr = *"${option%=*} is for --heatmap and --side-by-side"* ]] || complain "$stderr"
    answers 0 specdiff $option --side-by-side a.png a.exr a.exr
    answers 0 specdiff $option --heatmap a.png a.exr a.exr
  done
}

@test "an unknown metric is refused by name" {
  spectral a.exr
  fails_cleanly specdiff --metric rmse,rsme a.exr a.exr
  [[ $stderr = *rsme* ]]
  fails_cleanly specdiff --tolerance rsme=1 a.exr a.exr
  [[ $stderr = *rsme* ]]
  fails_cleanly specdiff --metric '' a.exr a.exr
}

@test "a tolerance that is no number is refused" {
  spectral a.exr
  for value in '' 1x nan inf -1; do
    fails_cleanly specdiff --tolerance "max=$value" a.exr a.exr
  done
  fails_cleanly specdiff --tolerance max a.exr a.exr
}

@test "numbers outside of their ranges are refused" {
  spectral a.exr
  for option in '--peak 0' '--peak -1' '--peak 1e301' '--heatmap-max 0' '--heatmap-max 1e301' '-e 100.1' '-e -101' \
    '-t max=1e301' '--same-within 0.09' '-m max-p-1' '--crop 0,0,0,1'; do
    # shellcheck disable=SC2086 # several words
    fails_cleanly specdiff $option a.exr a.exr
  done
  fails_cleanly specdiff --exact --resample a.exr a.exr
  answers 0 specdiff -t max=1e300 --peak 1e300 -e 100 a.exr a.exr
  spectral big.exr --size 300x2000 --grid 500:600:100 --pattern constant:1 --compression none
  answers 0 specdiff --limit memory=4M -m max-p50 big.exr big.exr
  fails_cleanly specdiff --limit memory=4M -m max-p50,mae-p50 big.exr big.exr
  [[ $stderr = *'2 values for each of 600000 pixels are more than the limit memory=4194304 (--limit)' ]]
}

@test "-o is not passed over: the answer goes there, or the option is refused" {
  spectral a.exr
  if specdiff -o out.txt a.exr a.exr >printed 2>err; then
    [ -s out.txt ]
    [ ! -s printed ]
  else
    fails_cleanly specdiff -o out.txt a.exr a.exr
  fi
}

@test "a missing file is trouble, on either side" {
  spectral a.exr
  fails_cleanly specdiff a.exr missing.exr
  [[ $stderr = *missing.exr* ]]
  fails_cleanly specdiff missing.exr a.exr
}

@test "a short file is trouble, on either side" {
  spectral a.exr
  head -c 3000 a.exr >short.exr
  fails_cleanly specdiff a.exr short.exr
  [[ $stderr = *short.exr* ]]
  fails_cleanly specdiff short.exr a.exr
}

@test "a full device is trouble, with the same and with different images" {
  spectral a.exr
  spectral b.exr --pattern negative
  for other in a b; do
    code=0
    specdiff a.exr $other.exr >/dev/full 2>err || code=$?
    [ "$code" -eq 2 ]
    [ "$(cat err)" = "specdiff: unable to write '<stdout>': No space left on device" ]
  done
}

@test "--help, --version and a wrong option" {
  answers 0 specdiff --help
  [[ $answer = 'usage: specdiff [OPTION]... FILE1 FILE2'* ]]
  answers 0 specdiff --version
  [[ $answer =~ ^specdiff\ \(spectools\)\ [0-9.]+$ ]]
  fails_cleanly specdiff --tolerence max=1 a b
  [[ $stderr = *"did you mean '--tolerance'?" ]]
}

@test "bins and points are not measured against each other" {
  spectral a.exr --bins
  spectral b.exr
  run --separate-stderr specdiff a.exr b.exr
  [ "$status" -eq 1 ]
  [ "$output" = 'bands differ: one has bins, the other has point samples' ] || complain "$output"
}

@test "values per band and per nm are not measured against each other" {
  spectral a.exr --quantity 'radiance per band'
  spectral b.exr --quantity 'radiance per nm'
  run --separate-stderr specdiff a.exr b.exr
  [ "$status" -eq 1 ]
  [ "$output" = "quantities differ: 'radiance per band' and 'radiance per nm'" ] || complain "$output"
}

@test "images of different kinds: kind, bands and channels are told" {
  spectral a.exr --kind T --grid 400:500:50
  spectral b.exr --channel R --channel G --channel Z
  run --separate-stderr specdiff a.exr b.exr
  [ "$status" -eq 1 ]
  [[ $output = *'bands differ: 3 and 0'*"'reflectance' and 'no bands'"*"channel 'R' is only in the second"* ]] ||
    complain "$output"
}

@test "a difference that is seen at once lets the upstream finish" {
  spectral a.exr --size 64x400 --compression none
  spectral b.exr
  cat a.exr | specdiff - b.exr >report || true
  codes=("${PIPESTATUS[@]}")
  [ "$(cat a.exr | { specdiff - b.exr >report; }; echo "${PIPESTATUS[0]}")" = 0 ] || complain "${codes[*]}"
}
