#!/usr/bin/env bats
# specfilm: films fold into images as the physics has it, computed again by awk; spectra and
# charts of them; and everything else stays as it was.
# shellcheck disable=SC2154 # fails_cleanly leaves its line in stderr

load common
load physics

soap='air | 1.33 500nm | air'
glass='air | 1.38 120nm | 1.5'

functions=$film_functions

# film_image FILE [ARGUMENT...]: an image of the least that a film needs, at 500 nm; every sample is
# 1/2, the cosine too, or what another --pattern says.
film_image() {
  spectral "$1" --channel S0.500nm --channel film1.mirror.S0.500nm --channel film1.cosine \
    --channel through.S0.500nm --pattern constant:0.5 "${@:2}"
}

# spectrum ARGUMENT...: the lines of --spectrum that are numbers.
spectrum() {
  specfilm --spectrum "$@" | grep -v '^#'
}

# spectrum_holds AWK: the statements hold on each line of a spectrum that comes in, $1 nm, $2 R,
# $3 T, $4 A; and there is one.
spectrum_holds() {
  awk "$statements$functions"'
    { lines++; '"$1"' }
    END { exit failed || !lines }' >said || complain "$(cat said)"
}

# The command line

@test "--help, --version and options that are not there" {
  [[ $(specfilm --help) = 'usage: specfilm --stack STACK [OPTION]... [FILE]'* ]]
  [[ $(specfilm -V) =~ ^specfilm\ \(spectools\)\ [0-9.]+$ ]]
  fails_cleanly specfilm --stak "$soap"
  [[ $stderr = *"did you mean '--stack'?" ]] || complain "$stderr"
  fails_cleanly specfilm --stack "$soap" -x
  for option in stack thickness mask polarisation chart of size angle grid extrapolate output; do
    fails_cleanly specfilm --stack "$soap" --$option
    [[ $stderr = *"option '--$option' needs an argument"* ]] || complain "$stderr"
  done
  no_leftovers .
}

@test "one image at a time, and not without a stack" {
  layers -o a.exr
  fails_cleanly specfilm --stack "$soap" a.exr a.exr -o b.exr
  [[ $stderr = *'one image at a time'* ]] || complain "$stderr"
  fails_cleanly specfilm a.exr -o b.exr
  [[ $stderr = *'no --stack' ]] || complain "$stderr"
  no_leftovers . a.exr
}

@test "what does not go together is refused" {
  layers -o a.exr
  refused() {
    fails_cleanly specfilm "$@" -o b.exr
    [ ! -e b.exr ] || complain "an image was made: $*"
  }
  refused --spectrum
  refused --chart 'angle 0..9'
  refused --thickness 5nm a.exr
  refused --mask 3 a.exr
  refused --mask 3 --stack "$soap" --mask 7 a.exr
  refused --stack "$soap" --thickness 5nm --thickness 6nm a.exr
  refused --stack "$soap" --spectrum --chart 'angle 0..9'
  for alone in --spectrum --chart=angle\ 0..9; do
    refused --stack "$soap" "$alone" a.exr
    refused --stack "$soap" "$alone" -
    refused --stack "$soap" "$alone" --mask 3
    refused --stack "$soap" "$alone" --keep
    refused --stack "$soap" "$alone" --stack "$soap"
  done
  for option in --angle=3 --grid=500:500:1 --size=3x3 --of=reflectance; do
    refused --stack "$soap" $option a.exr
  done
  refused --stack "$soap" --spectrum --size 3x3
  refused --stack "$soap" --spectrum --of reflectance
  # what an axis gives is not given twice
  refused --stack "$soap" --chart 'thickness 0..9' --thickness 5nm
  refused --stack "$soap" --chart 'angle 0..9, thickness 0..9' --thickness 5nm
  refused --stack "$soap" --chart 'thickness 0..9, angle 0..9' --angle 5
}

@test "values that are none are refused" {
  layers -o a.exr
  for option in --polarisation=x --polarisation= --extrapolate=zero --mask=x --mask=-1 \
    --mask=4294967296 --mask=1.5 --mask= --threads=0 --threads=257 --compression=dwaa; do
    fails_cleanly specfilm --stack "$soap" $option a.exr -o b.exr
  done
  for option in --angle=91 --angle=-1 --angle=x --angle=2rad --grid=600:500:1 --grid=500 --grid=0:5:1; do
    fails_cleanly specfilm --stack "$soap" --spectrum $option
  done
  for option in --of=x --size=0x5 --size=5 --size=5x --size=40000x5 --size=32769x1 --size=1x32769 --size=-3x3 \
    --angle=91; do
    fails_cleanly specfilm --stack "$soap" --chart 'angle 0..9' $option -o b.exr
  done
  no_leftovers . a.exr
}

@test "two stacks for one surface are refused" {
  layers -o a.exr
  fails_cleanly specfilm --stack "$soap" --stack "$glass" a.exr -o b.exr
  [[ $stderr = *'two stacks are for all surfaces'* ]] || complain "$stderr"
  fails_cleanly specfilm --stack "$soap" --mask 3 --stack "$glass" --mask 3 a.exr -o b.exr
  [[ $stderr = *'two stacks are for the id 3' ]] || complain "$stderr"
  no_leftovers . a.exr
}

# faulty BEFORE AFTER MESSAGE: the stack BEFORE AFTER is refused, with a caret under the first byte
# of AFTER.
faulty() {
  fails_pointing $((${#1} + 1)) specfilm --spectrum --stack "$1$2"
  [ "$stderr" = "specfilm: $3" ] || complain "$1$2: $stderr"
}

@test "a stack that is none is shown with a caret under the fault" {
  faulty '' '' 'expected the ambient medium, but the stack ends'
  faulty 'air' '' "expected '|', but the stack ends"
  faulty 'air |' '' 'expected a layer, a group or the substrate, but the stack ends'
  faulty '' '| air' "expected the ambient medium, not '|'"
  faulty 'air |' '| air' "expected a layer, a group or the substrate, not '|'"
  faulty 'air ' '5nm | air' "expected '|': the first medium, the ambient, has no thickness"
  faulty 'air | 1.33 ' '500nm' 'the last medium, the substrate, has no thickness'
  faulty 'air | 1.33 ' '| air' "expected a thickness, not '|'"
  faulty 'air | 1.33 500 ' 'nm | air' "expected '|', not 'nm'"
  faulty 'air | 1.33 ' '5kg | air' "the thickness is not a length in nm, um, mm, cm or m: '5kg'"
  faulty 'air | 1.33 ' '2m | air' "the thickness is more than 1 m: '2m'"
  faulty 'air | 1.33 500nm | air |' '' 'expected a layer, a group or the substrate, but the stack ends' ||
    faulty 'air | 1.33 500nm | air ' '|' "expected a thickness, not '|'"
  for negative in -5nm -0.1; do
    fails_pointing 12 specfilm --spectrum --stack "air | 1.33 $negative | air"
  done
}

@test "groups that are none are shown with a caret under the fault" {
  faulty 'air | (1.5 5nm | 1.6 6nm) ' '| air' "expected '^' and the number of repeats, not '|'"
  faulty 'air | (1.5 5nm)^' '0 | air' "the number of repeats is outside 1..10000: '0'"
  faulty 'air | (1.5 5nm)^' 'x | air' "the number of repeats is not a whole number: 'x'"
  faulty 'air | (1.5 5nm)^' '| air' "expected the number of repeats, not '|'"
  faulty 'air | ((1.5 5nm)^200)^' '200 | air' 'the stack has more than 10000 layers'
  faulty 'air | 1.5 5nm' ')^3 | air' "a ')' without a '('"
  faulty 'air | ' '(1.5 5nm | air' "expected a thickness, not the end" ||
    faulty 'air | ' '(1.5 5nm' "a '(' without a ')'"
  faulty 'air | (' ')^3 | air' "expected a layer or a group, not ')'"
  faulty 'air | cauchy' '(1.5 | air' "a '(' without a ')'"
}

@test "media that are none are shown with a caret under the fault" {
  faulty 'air | 1.5+0.1' 'j 5nm | air' "'1.5+0.1j' is not an index n or n+ki, such as 1.33 or 1.5+0.01i"
  faulty 'air | ' '0 5nm | air' "'0' is not a refractive index: n and k are both 0"
  faulty 'air | ' 'D65 5nm | air' "'D65' is a spectral power distribution, not a refractive index"
  faulty 'air | cauchy(' ') 5nm | air' 'coefficient 1 of cauchy is not a number'
  fails_pointing 7 specfilm --spectrum --stack 'air | watr 5nm | air'
  [[ $stderr = *"did you mean 'water'?" ]] || complain "$stderr"
  fails_pointing 7 specfilm --spectrum --stack 'air | ./none.spd 5nm | air'
}

@test "a medium outside its data is shown, and its range told" {
  fails_pointing 19 specfilm --spectrum --grid 200:300:100 --stack 'air | 1.38 99nm | N-BK7'
  [[ $stderr = *'300..1100 nm, not 200 nm' ]] || complain "$stderr"
  layers --grid 250:300:50 -o a.exr
  fails_pointing 7 specfilm --stack 'air | N-BK7' a.exr -o b.exr
  no_leftovers . a.exr
}

@test "of a long stack the part around the fault is shown" {
  before=air$(printf ' | 1.5 5nm%.0s' {1..30}) after=$(printf ' | 1.6 6nm%.0s' {1..30})
  code=0
  specfilm --spectrum --stack "$before | 1.4 5kg$after | air" 2>said || code=$?
  [ "$code" -eq 2 ] && [ "$(wc -l <said)" -eq 3 ]
  [ "$(awk '{ if (length() > n) n = length() } END { print n < 80 }' said)" = 1 ]
  caret=$(sed -n 3p said)
  shown=$(sed -n 2p said)
  [[ ${shown:${#caret}-1} = '5kg '* ]] || complain "$(cat said)"
}

@test "a '*' needs a --thickness, and a --thickness one layer" {
  fails_pointing 12 specfilm --spectrum --stack 'air | 1.33 * | air'
  fails_pointing 13 specfilm --spectrum --stack 'air | (1.33 *)^3 | air'
  fails_pointing 20 specfilm --spectrum --stack 'air | 1.33 * | 1.5 * | air'
  fails_cleanly specfilm --spectrum --stack 'air | 1.33 5nm | 1.5 5nm | air' --thickness 5nm
  [[ $stderr = *'2 layers; write * '* ]] || complain "$stderr"
  fails_cleanly specfilm --spectrum --stack 'air | Au' --thickness 5nm
  [[ $stderr = *'no layer'* ]] || complain "$stderr"
}

@test "an ambient that absorbs is refused" {
  for ambient in Au 1.5+0.1i; do
    fails_cleanly specfilm --spectrum --stack "$ambient | 1.5 5nm | air"
    [[ $stderr = *'first medium absorbs'* ]] || complain "$stderr"
  done
}

# thickness_faulty BEFORE AFTER
thickness_faulty() {
  layers --grid 500:500:1 -o a.exr
  fails_pointing $((${#1} + 1)) specfilm --stack 'air | 1.33 * | air' --thickness "$1$2" a.exr -o b.exr
  no_leftovers . a.exr
}

@test "a thickness that is none is shown with a caret under the fault" {
  for text in '' x -5nm gravity Gravity\ 5..6 '500 nm' 500kg; do
    thickness_faulty '' "$text"
  done
  thickness_faulty 'gravity ' '530nm'
  thickness_faulty 'gravity ' '..530nm'
  thickness_faulty 'gravity 530nm..' ''
  thickness_faulty 'gravity ' '0nm..530nm'
  thickness_faulty 'gravity 530nm..' '0nm x'
  thickness_faulty 'gravity ' '5kg..7nm'
  thickness_faulty 'gravity 5nm..' '7kg'
  thickness_faulty 'gravity 5nm..7nm ' 'q'
  thickness_faulty 'gravity 5nm..7nm ' '+z'
  thickness_faulty 'gravity 5nm..7nm ' 'z z'
}

@test "--thickness takes the lengths that a stack takes" {
  spectrum --grid 400:700:100 --stack 'air | 1.33 .5um | air' >want
  for length in 500nm 500 0.5um 5e2nm .5um +.5um; do
    spectrum --grid 400:700:100 --stack 'air | 1.33 * | air' --thickness $length >found
    cmp found want || complain "$length"
  done
  spectrum --stack 'air | 1.33 * | 1.5' --thickness 0nm | cmp - <(spectrum --stack 'air | 1.5')
}

@test "--thickness ends at 1 m, as a stack does" {
  spectrum --stack 'air | 1.33 * | air' --thickness 1m | cmp - <(spectrum --stack 'air | 1.33 1m | air')
  thickness_faulty '' 2m
  thickness_faulty 'gravity ' '2m..1nm'
  thickness_faulty 'gravity 1nm..' '2m'
}

@test "a thickness of too many digits is refused, not cut short" {
  zeros=$(printf '0%.0s' {1..70})
  layers --grid 500:500:1 -o a.exr
  for made in a.exr --spectrum; do
    code=0
    specfilm --stack 'air | 1.33 * | air' --thickness "1.${zeros}um" $made -o b 2>said || code=$?
    [ "$code" -eq 2 ] || complain "exit $code: $made" "$(cat said)"
  done
  code=0
  specfilm --stack "$soap" --chart "thickness 0..1.${zeros}um" -o b 2>said || code=$?
  [ "$code" -eq 2 ] || complain "exit $code: axes" "$(cat said)"
}

# axes_faulty BEFORE AFTER
axes_faulty() {
  fails_pointing $((${#1} + 1)) specfilm --stack "$soap" --chart "$1$2" -o c.exr
  no_leftovers .
}

@test "axes that are none are shown with a caret under the fault" {
  for text in '' x 'lamp 0..9' 'Angle 0..9' ','; do
    axes_faulty '' "$text"
  done
  axes_faulty 'thickness' ''
  axes_faulty 'thickness ' '5'
  axes_faulty 'thickness ' '..5'
  axes_faulty 'thickness 5..' ''
  axes_faulty 'thickness 0..' '9deg'
  axes_faulty 'thickness ' '-5nm..5nm'
  axes_faulty 'thickness 0..' '2m'
  axes_faulty 'angle ' '0 .. 9'
  axes_faulty 'angle ' 'a..b'
  axes_faulty 'angle 0..' '9nm'
  axes_faulty 'angle 0..' '91'
  axes_faulty 'angle ' '-1..9'
  axes_faulty 'angle 0..9,' ''
  axes_faulty 'angle 0..9,' ',thickness 0..9'
  axes_faulty 'angle 0..9 ' 'thickness 0..9'
  axes_faulty 'angle 0..9, thickness 0..9' ', angle 3..4'
  axes_faulty 'angle 0..9,' 'angle 0..8'
}

@test "of two axes that are the same the second is shown" {
  axes_faulty 'angle 0..9, ' 'angle 0..8'
}

# What comes in

@test "a stack at fault is told before a pipe is waited for" {
  mkfifo pipe.exr # which nobody writes
  code=0
  timeout 10 specfilm --stack 'air |' pipe.exr -o b.exr 2>said || code=$?
  [ "$code" -eq 2 ] || complain "exit $code" "$(cat said)"
}

@test "a file, standard input, '-' and a process substitution are read alike" {
  layers --grid 500:600:50 -o a.exr
  specfilm --no-history --stack "$soap" a.exr -o file.exr
  specfilm --no-history --stack "$soap" <a.exr -o redirected.exr
  specfilm --no-history --stack "$soap" - < <(cat a.exr) -o dash.exr
  specfilm --no-history --stack "$soap" <(cat a.exr) -o substituted.exr
  for other in redirected dash substituted; do
    cmp file.exr $other.exr
  done
}

@test "what is no image is refused, and the file there was stays" {
  : >empty.exr
  echo 'not an image, but longer than a magic number' >text.exr
  mkdir folder
  echo old >out.exr
  for file in empty.exr text.exr folder missing.exr; do
    fails_cleanly specfilm --stack "$soap" $file -o out.exr
    [[ $stderr = *$file* ]] || complain "$stderr"
  done
  fails_cleanly specfilm --stack "$soap" -o out.exr </dev/null
  [[ $stderr = *'is empty' ]] || complain "$stderr"
  [ "$(cat out.exr)" = old ]
  no_leftovers . empty.exr text.exr folder out.exr
}

@test "an image cut off anywhere is refused, and the file there was stays" {
  echo old >out.exr
  for compression in none zip; do
    layers --size 9x35 --grid 500:520:20 --compression $compression -o a.exr
    size=$(wc -c <a.exr)
    for percent in 0 1 5 20 50 80 99; do
      head -c $((size * percent / 100)) a.exr >short.exr
      fails_cleanly specfilm --stack "$soap" short.exr -o out.exr
      fails_cleanly specfilm --stack "$soap" - -o out.exr < <(cat short.exr)
    done
  done
  [ "$(cat out.exr)" = old ]
  no_leftovers . a.exr short.exr out.exr
}

@test "a part is chosen by number" {
  layers --grid 500:500:1 -o a.exr
  spectral b.exr --grid 500:500:1 --pattern constant:1
  exrmultipart -combine -i b.exr a.exr -o both.exr >/dev/null
  specfilm --stack "$soap" a.exr -o want.exr
  specfilm --stack "$soap" --part 1 both.exr -o part.exr
  specdiff want.exr part.exr
  fails_cleanly specfilm --stack "$soap" --part 0 both.exr -o none.exr
  fails_cleanly specfilm --stack "$soap" both.exr -o none.exr
  [[ $stderr = *--part* ]] || complain "$stderr"
  fails_cleanly specfilm --stack "$soap" --part 2 both.exr -o none.exr
  [ ! -e none.exr ]
}

@test "each limit is refused by name" {
  layers -o a.exr
  for limit in pixels=127 channels=15 header=500 memory=1k; do
    fails_cleanly specfilm --stack "$soap" --limit $limit a.exr -o b.exr
    [[ $stderr = *"--limit ${limit%=*}="* ]] || complain "$limit: $stderr"
  done
  no_leftovers . a.exr
}

@test "tiles, and lines from the last on, are read" {
  layers --scene sphere --samples 2 --size 16x8 --grid 500:500:1 --compression none -o a.exr
  exrmaketiled -t 8 4 a.exr tiles.exr
  specfilm --no-history --stack "$soap" a.exr -o want.exr
  specfilm --no-history --stack "$soap" tiles.exr -o b.exr
  specdiff want.exr b.exr
  reverse_lines a.exr reversed.exr 8 $((16 * 4 * $(channels a.exr | wc -l)))
  specfilm --no-history --stack "$soap" reversed.exr -o c.exr
  specdiff want.exr c.exr
}

# What comes out

@test "an image may be written over itself" {
  layers --grid 500:600:50 -o a.exr
  specfilm --no-history --stack "$soap" a.exr -o want.exr
  specfilm --no-history --stack "$soap" a.exr -o a.exr
  cmp a.exr want.exr
}

@test "a full device fails, and leaves nothing" {
  layers -o a.exr
  mkdir tmp
  export TMPDIR=$PWD/tmp
  for made in '--chart=angle 0..9' --spectrum a.exr; do
    fails_cleanly specfilm --stack "$soap" "$made" -o /dev/full
    code=0
    specfilm --stack "$soap" "$made" >/dev/full 2>err || code=$?
    [ "$code" -eq 2 ] && [ "$(wc -l <err)" -eq 1 ] || complain "$made: exit $code" "$(cat err)"
  done
  fails_cleanly specfilm --stack "$soap" a.exr -o missing/b.exr
  no_leftovers tmp
  no_leftovers . a.exr err tmp
}

@test "no image is written to a terminal, but a spectrum is" {
  layers -o a.exr
  for made in "--chart 'angle 0..9'" a.exr; do
    shuns_terminal "specfilm --stack '$soap' $made"
  done
  script -qec "specfilm --stack '$soap' --spectrum" typescript </dev/null >seen
  grep -q '^550 0' seen
}

@test "every number of threads writes the same bytes" {
  layers --scene noise --films 3 --size 61x67 --grid 400:700:20 -o a.exr
  for compression in none zip; do
    specfilm --no-history -j 1 --compression $compression --stack "$soap" a.exr -o 1.exr
    specfilm --no-history -j 4 --compression $compression --stack "$soap" a.exr -o 4.exr
    cmp 1.exr 4.exr
    specfilm --no-history -j 4 --compression $compression --stack "$soap" a.exr | cat >4.exr
    specfilm --no-history -j 1 --compression $compression --stack "$soap" - < <(cat a.exr) | cat >1.exr
    cmp 1.exr 4.exr
  done
  specfilm --no-history -j 1 --stack "$soap" --chart 'thickness 0..900, angle 0..90' --size 300x70 -o 1.exr
  for threads in 4 256; do
    specfilm --no-history -j $threads --stack "$soap" --chart 'thickness 0..900, angle 0..90' --size 300x70 -o 4.exr
    cmp 1.exr 4.exr
  done
}

@test "runs of 256 pixels and lines of other lengths give the same pixels" {
  # the middle pixel of a long line is that of the image of this pixel alone
  layers --scene noise --films 2 --size 600x2 --grid 500:600:100 -o a.exr
  specfilm --stack "$glass" a.exr -o b.exr
  specfilm --stack 'air | 1.33 * | 1.5' --thickness 'gravity 300nm..900nm x' a.exr -o c.exr
  for x in 0 255 256 511 512 599; do
    pixel_holds a.exr b.exr $x,1 'on[1] = on[2] = "'"$glass"'"; folds("u")'
    pixel_holds a.exr c.exr $x,1 '
      on[1] = on[2] = sprintf("air | 1.33 %.15gnm | 1.5", 300 * 3 ^ (1 - from["film1.Q.X"])); folds("u")'
    specconvert --crop $x,1,$((x + 1)),2 a.exr | specfilm --stack "$glass" -o one.exr
    specconvert --crop $x,1,$((x + 1)),2 b.exr | specdiff one.exr -
  done
}

@test "every lossless compression gives the same pixels" {
  layers --grid 500:600:50 -o a.exr
  specfilm --stack "$soap" a.exr -o want.exr
  for compression in none rle zips zip piz; do
    specfilm --compression $compression --stack "$soap" a.exr -o b.exr
    specdiff want.exr b.exr
  done
  specfilm --compression piz --stack "$soap" a.exr -o b.exr
  exrheader b.exr | grep -qx 'compression (type compression): piz'
}

@test "--half stores the light as HALF, and what is too large is told" {
  layers --scene noise --grid 500:600:50 -o a.exr
  specfilm --stack "$soap" a.exr -o float.exr
  specfilm --stack "$soap" --half a.exr -o half.exr
  specconvert --half float.exr | specdiff half.exr -
  [ "$(exrheader half.exr | grep -c '^    S0.*16-bit')" -eq 3 ]
  film_image b.exr --pattern constant:0.5 --size 2x2
  specconvert --scale 140000 b.exr -o c.exr
  specfilm --half --stack "$soap" c.exr -o d.exr 2>said
  [ "$(cat said)" = 'specfilm: warning: d.exr: 4 samples are too large for 16 bits and became infinite' ] ||
    complain "$(cat said)"
  specfilm -q --half --stack "$soap" c.exr -o d.exr 2>said
  [ ! -s said ]
}

@test "bands of whole numbers become FLOAT" {
  spectral a.exr --uint S0.500nm --channel film1.mirror.S0.500nm --channel film1.cosine --channel through.S0.500nm \
    --pattern constant:0.5 --size 4x2
  specfilm --stack "$soap" a.exr -o b.exr
  exrheader b.exr | grep -qx '    S0.500,000000nm, 32-bit floating-point, sampling 1 1'
  # x + 65536 y, which was there, and the film's light
  pixel_holds a.exr b.exr 3,1 'seen("'"$soap"'", 500, 0.5, "u"); is("S0.500,000000nm", 65539 + (T + R) / 2)'
}

@test "HALF light stays HALF, and is the same answer rounded" {
  layers --scene tilted --half --grid 500:600:50 -o half.exr
  specfilm --no-history --stack "$soap" half.exr -o b.exr
  specfilm --no-history --half --stack "$soap" half.exr -o c.exr
  cmp b.exr c.exr
  [ "$(exrheader b.exr | grep -c '^    S0.*16-bit')" -eq 3 ]
  pixel_holds half.exr b.exr 8,3 '
    on[1] = "'"$soap"'"
    for (name in from) if (name ~ /^S0/) {
      seen(on[1], wavelength(name), from["film1.cosine"], "u")
      is(name, T * from["through." name] + R * from["film1.mirror." name], 2 ^ -11)
    }'
}

@test "what a writer must write is written where it was missing" {
  film_image a.exr --without spectralLayoutVersion --without emissiveUnits
  specfilm --stack "$soap" a.exr -o b.exr
  has_line b.exr 'spectralLayoutVersion (type string): "1.0"'
  has_line b.exr 'emissiveUnits (type string): "W.m^-2.sr^-1"'
}

@test "spec:history has a line for it, and --no-history none" {
  layers --grid 500:500:1 -o a.exr
  specfilm --stack "$soap" a.exr -o b.exr
  version=$(specfilm --version | sed 's/.* //')
  exrheader b.exr | grep -qF "\"specfilm --stack '$soap' a.exr -o b.exr  # spectools $version" ||
    complain "$(exrheader b.exr)"
  specfilm --stack "$soap" --chart 'angle 0..9' --size 2x2 -o c.exr
  exrheader c.exr | grep -qF "\"specfilm --stack '$soap' --chart 'angle 0..9' --size 2x2 -o c.exr  #"
  specfilm --no-history --stack "$soap" a.exr -o b.exr
  specfilm --no-history --stack "$soap" --chart 'angle 0..9' --size 2x2 -o c.exr
  run ! grep history <<<"$(exrheader b.exr c.exr)"
}

@test "windows and attributes pass through" {
  film_image a.exr --data -7,-300 --display -1000,5,20,4000 --attribute 'own:text=two words' \
    --attribute empty= --quantity 'radiance per band'
  exrstdattr -owner me -longitude 5.25 -framesPerSecond 24 1 -keyCode 1 2 3 4 5 4 64 -float own:float 1.5 \
    -screenWindowWidth 2.5 -screenWindowCenter 0.25 -0.5 -pixelAspectRatio 1.25 a.exr b.exr
  specfilm --no-history --stack "$soap" b.exr -o c.exr
  [ "$(header_of b.exr)" = "$(header_of c.exr)" ] || complain "$(diff <(header_of b.exr) <(header_of c.exr))"
}

@test "foreign channels pass through with their bits, and a preview goes" {
  film_image a.exr --extra A --extra P.X --extra R --extra G --extra B --extra filmy --extra film.x \
    --extra film0.x --extra throughput --uint-id --pattern noise --size 8x2
  # noise is below 1, as a cosine must be
  specfilm --stack "$soap" a.exr -o b.exr
  has_channels b.exr A P.X S0.500,000000nm film.x film0.x filmy id throughput
  for pixel in 0,0 7,1; do
    pixel_holds a.exr b.exr $pixel '
      split("A P.X film.x film0.x filmy id throughput", name, " ")
      for (j = 1; j <= 7; j++) if (to[name[j]] != from[name[j]]) wrong(name[j])'
  done
}

@test "layers go, geometry and lamps stay; with --keep all stays" {
  film_image a.exr --channel lamp1.S0.500nm --channel lamp1.D.X --channel lamp1.D.Y --channel lamp1.D.Z \
    --extra N.X --extra N.Y --extra N.Z --extra cosine --extra cover --extra film1.other --extra film1.Q.X --extra film1.Q.Y \
    --extra film1.Q.Z
  specfilm --stack "$soap" a.exr -o b.exr
  has_channels b.exr N.X N.Y N.Z S0.500,000000nm cosine cover lamp1.D.X lamp1.D.Y lamp1.D.Z lamp1.S0.500nm
  specfilm --keep --stack "$soap" a.exr -o c.exr
  [ "$(channels c.exr)" = "$(channels a.exr | sed 's/^S0.500nm/S0.500,000000nm/')" ] || complain "$(channels c.exr)"
  pixel_holds b.exr c.exr 5,3 'for (name in from) if (to[name] != from[name]) wrong(name)'
  pixel_holds a.exr c.exr 5,3 'for (name in from) if (name !~ /^S0/ && to[name] != from[name]) wrong(name)'
}

@test "bins stay, and so do the other Stokes components" {
  layers --bins --grid 500:600:50 -o a.exr
  specfilm --stack "$soap" a.exr -o b.exr
  exrheader b.exr | grep -qx 'spec:bins (type string): "475 525 575 625"'
  film_image c.exr --channel S1.500nm --channel S2.500nm --channel S3.500nm
  specfilm --stack "$soap" c.exr -o d.exr
  pixel_holds c.exr d.exr 2,2 '
    on[1] = "'"$soap"'"; seen(on[1], 500, 0.5, "u")
    is("S0.500,000000nm", 0.5 + R / 2 + T / 2)
    for (j = 1; j < 4; j++) is("S" j ".500,000000nm", from["S" j ".500nm"])'
}

@test "other namings of the bands and of their layers are the same bands" {
  # the layers' order by name is not that of the wavelengths
  film_image want.exr --channel S0.600nm --channel film1.mirror.S0.600nm --channel through.S0.600nm \
    --pattern noise
  spectral a.exr --channel S0.0,5um --channel film1.mirror.S0.5e-7m --channel film1.cosine \
    --channel through.S0.500,000nm --channel S0.6e2nm --channel film1.mirror.S0.0,6um \
    --channel through.S0.600nm --pattern noise
  specfilm --stack "$soap" want.exr -o b.exr
  specfilm --stack "$soap" a.exr -o c.exr
  specdiff b.exr c.exr
  has_channels c.exr S0.500,000000nm S0.600,000000nm
  spectral d.exr --channel 495.00-505.00nm --channel film1.mirror.S0.500nm --channel film1.cosine \
    --channel through.S0.500nm --pattern constant:0.5
  specfilm --stack "$soap" d.exr -o e.exr
  film_image f.exr
  specfilm --stack "$soap" f.exr -o g.exr
  pixel_holds g.exr e.exr 3,3 'is("S0.500,000000nm", from["S0.500,000000nm"])'
  exrheader e.exr | grep -qx 'spec:bins (type string): "495 505"'
}

# Layers that are wrong

# layers_refused FILE TEXT: with a line that has it.
layers_refused() {
  fails_cleanly specfilm --stack "$soap" "$1" -o out.exr
  [[ $stderr = "specfilm: $1: "*"$2"* ]] || complain "$stderr"
  [ ! -e out.exr ]
}

@test "an image without film layers, or without light, is refused" {
  spectral a.exr
  layers_refused a.exr 'has no film layers'
  spectral b.exr --kind T
  layers_refused b.exr 'no bands of light'
  spectral c.exr --channel R --channel G --channel B
  layers_refused c.exr 'no bands of light'
  layers --scene disc -o d.exr
  layers_refused d.exr 'has no film layers'
}

@test "layers beside no light, or beside reflectance, are refused" {
  layers --grid 500:600:50 --compression none -o a.exr
  rename_channels S0 R0 a.exr b.exr
  layers_refused b.exr 'no bands of light'
  rename_channels 'S0[.]' T.0 a.exr c.exr
  layers_refused c.exr 'no bands of light'
}

@test "a gap in the films' numbers is refused" {
  layers --scene pair --grid 500:600:50 --compression none -o a.exr
  rename_channels film2 film3 a.exr b.exr
  layers_refused b.exr film2
  rename_channels film1 film0 a.exr c.exr
  layers_refused c.exr film1
  # Numbers go to 4096, and have no zeros before them; else a name means nothing.
  film_image d.exr --channel film4096.mirror.S0.500nm --size 2x1
  layers_refused d.exr film2
  film_image e.exr --channel film4097.mirror.S0.500nm --channel film02.mirror.S0.500nm --size 2x1
  specfilm --stack "$soap" e.exr -o f.exr
  has_channels f.exr S0.500,000000nm film02.mirror.S0.500nm film4097.mirror.S0.500nm
}

@test "a layer without one of the bands, or with another, is refused" {
  layers --grid 500:600:50 --compression none -o a.exr
  rename_channels 'film1[.]mirror[.]S0.6' film1.mirror.X0.6 a.exr b.exr
  layers_refused b.exr "'film1.mirror.X0.600,000000nm' is not named as a band"
  rename_channels 'film1[.]mirror[.]S0.600' film1.mirror.S0.601 a.exr b.exr
  layers_refused b.exr "'film1.mirror.S0.601,000000nm' is not at a band of S0"
  rename_channels 'film1[.]mirror[.]S0.600' film1.mirros.S0.600 a.exr b.exr
  layers_refused b.exr "'film1.mirror' has no band at 600 nm"
  rename_channels 'through[.]S0.600' through.S0.601 a.exr b.exr
  layers_refused b.exr "'through.S0.601,000000nm' is not at a band of S0"
  rename_channels 'through[.]S0.600' throuhg.S0.600 a.exr b.exr
  layers_refused b.exr "'through' has no band at 600 nm"
  spectral c.exr --channel S0.500nm --channel film1.mirror.S0.500nm --channel film1.mirror.S0.0,5um \
    --channel film1.cosine
  layers_refused c.exr 'has already'
  spectral d.exr --channel S0.500nm --channel film1.mirror.S0.nm --channel film1.cosine
  layers_refused d.exr "'film1.mirror.S0.nm'"
}

@test "a vector that is not whole is refused" {
  layers --grid 500:500:1 --compression none -o a.exr
  for vector in N Ns P Q I; do
    rename_channels "film1[.]${vector}[.]Z" "film1.$vector.z" a.exr b.exr
    layers_refused b.exr "'film1.$vector' has not all of .X, .Y, .Z"
  done
}

@test "without a cosine Ns and I serve, and without those it is refused" {
  layers --scene sphere --grid 500:600:50 --compression none -o a.exr
  rename_channels '\(film.[.]\)cosine' '\1cosinf' a.exr b.exr
  specfilm --stack "$glass" a.exr -o want.exr
  specfilm --stack "$glass" b.exr -o c.exr
  specdiff --tolerance max=2e-6 want.exr c.exr
  rename_channels '\(film2[.]\)Ns' '\1Nt' b.exr d.exr
  layers_refused d.exr "'film2' has no channel 'cosine'"
}

@test "a cosine that is none is refused, and its pixel named" {
  film_image a.exr --data 100,50 --pattern nan:3,2,2
  layers_refused a.exr 'pixel 3,2: the cosine of film1 is nan'
  film_image b.exr --pattern inf:3,2,2
  layers_refused b.exr 'pixel 3,2: the cosine of film1 is inf'
  film_image c.exr --pattern constant:1.2
  layers_refused c.exr 'pixel 0,0: the cosine of film1 is 1.2'
  film_image d.exr --pattern constant:-1.2
  layers_refused d.exr 'pixel 0,0: the cosine of film1 is -1.2'
  film_image e.exr --pattern constant:1.0011
  layers_refused e.exr 'pixel 0,0: the cosine of film1 is 1.0011'
}

@test "a cosine a little above 1 is 1" {
  film_image a.exr --pattern constant:1.0005
  specfilm --stack "$soap" a.exr -o b.exr
  pixel_holds a.exr b.exr 1,1 'seen("'"$soap"'", 500, 1, "u"); is("S0.500,000000nm", 1.0005 * (1 + R + T))'
}

@test "neighbours seen from both sides, and between them no film" {
  film_image a.exr --channel film1.cover --compression none --size 7x1
  for x in 1 2 5; do
    poke a.exr $(($(sample_at a.exr film1.cosine $x 7) + 3)) '\xbf'
  done
  for x in 3 5; do
    poke a.exr "$(sample_at a.exr film1.cover $x 7)" '\0\0\0\0'
    poke a.exr "$(sample_at a.exr film1.mirror.S0.500nm $x 7)" '\0\0\x80\x3f'
  done
  specfilm --stack "$glass" a.exr -o b.exr
  for x in 0 1 2 3 4 5 6; do
    pixel_holds a.exr b.exr $x,0 '
      x = '$x'
      seen("'"$glass"'", 500, x == 1 || x == 2 ? -0.5 : 0.5, "u")
      is("S0.500,000000nm", x == 3 || x == 5 ? 1 : (1 + T + R) / 2)'
  done
}

@test "where a film does not cover, its other channels do not matter" {
  film_image a.exr --channel film1.cover --pattern constant:0 --pattern nan:3,2,2 --pattern inf:3,2,1
  specfilm --stack "$soap" a.exr -o b.exr
  pixel_holds a.exr b.exr 3,2 'is("S0.500,000000nm", 0)'
}

@test "light and places that are not finite stay in their pixel" {
  film_image want.exr --channel film1.Q.X --channel film1.Q.Y --channel film1.Q.Z --size 3x1
  specfilm --stack "$soap" --thickness 'gravity 5nm..1um' want.exr -o b.exr
  for pattern in nan:1,0,1 inf:1,0,1 nan:1,0,3 nan:1,0,0 nan:1,0,6 inf:1,0,6; do
    film_image a.exr --channel film1.Q.X --channel film1.Q.Y --channel film1.Q.Z --size 3x1 --pattern $pattern
    specfilm --stack "$soap" --thickness 'gravity 5nm..1um' a.exr -o c.exr
    for x in 0 2; do
      pixel_holds b.exr c.exr $x,0 'is("S0.500,000000nm", from["S0.500,000000nm"])'
    done
  done
}

@test "from within a substrate that absorbs nothing is seen" {
  layers --scene sphere --grid 500:500:1 -o a.exr
  for stack in 'air | Au' 'air | 1.38 99nm | 1.5+0.001i'; do
    fails_cleanly specfilm --stack "$stack" a.exr -o b.exr
    [[ $stderr = *'film2 is seen from within its substrate'* ]] || complain "$stderr"
  done
  no_leftovers . a.exr
}

@test "--mask needs an id that is UINT, gravity needs Q" {
  layers --grid 500:500:1 --compression none -o a.exr
  rename_channels film1.id film1.ie a.exr b.exr
  fails_cleanly specfilm --stack "$soap" --mask 3 b.exr -o out.exr
  [[ $stderr = *"'film1' has no channel 'id"* ]] || complain "$stderr"
  specfilm --stack "$soap" b.exr -o c.exr
  film_image d.exr --extra film1.id
  fails_cleanly specfilm --stack "$soap" --mask 3 d.exr -o out.exr
  [[ $stderr = *UINT* ]] || complain "$stderr"
  rename_channels film1.Q film1.R a.exr e.exr
  fails_cleanly specfilm --stack "$soap" --thickness 'gravity 5nm..6nm' e.exr -o out.exr
  [[ $stderr = *"'film1' has no channel 'Q"* ]] || complain "$stderr"
  [ ! -e out.exr ]
}

# Answers

@test "a film that faces the eye, or is tilted" {
  for angle in 0 40 -75; do
    layers --angle $angle --grid 400:700:50 --shape ramp --radiance 3 --behind 0.5 -o a.exr
    for light in u s p; do
      specfilm --polarisation $light --stack "$soap" a.exr -o b.exr
      pixel_holds a.exr b.exr 3,2 '
        for (l = 400; l <= 700; l += 50) {
          seen("'"$soap"'", l, from["film1.cosine"], "'$light'")
          if (!near(R + T, 1, 1e-12)) wrong("R + T is " R + T)
          is("S0." l ",000000nm", (R * 3 + T * 0.5) * l / 550)
        }
        on[1] = "'"$soap"'"; folds("'$light'")'
    done
  done
}

@test "without --polarisation light is unpolarised" {
  layers --angle 60 --grid 500:500:1 -o a.exr
  specfilm --no-history --stack "$soap" a.exr -o b.exr
  specfilm --no-history --stack "$soap" --polarisation u a.exr -o c.exr
  cmp b.exr c.exr
}

@test "an index that depends on wavelength" {
  layers --angle 50 --grid 400:700:50 -o a.exr
  specfilm --stack 'air | cauchy(1.4,0.02) 350nm | cauchy(1.5,0.004)' a.exr -o b.exr
  pixel_holds a.exr b.exr 3,2 'on[1] = "air | cauchy(1.4,0.02) 350nm | cauchy(1.5,0.004)"; folds("u")'
}

@test "several layers, and groups of them" {
  layers --angle 50 --grid 400:700:50 -o a.exr
  specfilm --stack 'air | (2.4 60nm | 1.46 95nm)^3 | 1.52' a.exr -o b.exr
  pixel_holds a.exr b.exr 3,2 '
    on[1] = "air | 2.4 60nm | 1.46 95nm | 2.4 60nm | 1.46 95nm | 2.4 60nm | 1.46 95nm | 1.52"
    folds("u")'
}

@test "a layer that absorbs takes its share" {
  layers --angle 35 --grid 400:700:100 -o a.exr
  specfilm --stack 'air | 0.2+3.1i 20nm | 1.5' a.exr -o b.exr
  pixel_holds a.exr b.exr 3,2 '
    on[1] = "air | 0.2+3.1i 20nm | 1.5"; folds("u")
    power(on[1], 500, 1, "u"); if (R + T > 0.97) wrong("R + T is " R + T)'
}

@test "a bare metal mirrors by its n and k, and nothing comes through" {
  layers --angle 30 --grid 450:650:100 --radiance 2 --behind 100 -o a.exr
  specfilm --stack 'air | Au' a.exr -o b.exr
  specconvert --grid 450:650:100 Au | grep -v '^#' >gold
  # shellcheck disable=SC2034 # for pixel_holds
  while read -r l n k _; do
    pixel_holds a.exr b.exr 3,2 '
      seen("air | '"$n+${k}i"'", '"$l"', from["film1.cosine"], "u")
      if (T != 0 || R < 0.3) wrong("R is " R ", T " T)
      is("S0.'"$l"',000000nm", 2 * R)'
  done <gold
}

@test "bare glass, and nothing at all" {
  layers --angle 60 --grid 500:500:1 -o a.exr
  specfilm --stack 'air | 1.5' a.exr -o b.exr
  pixel_holds a.exr b.exr 3,2 'on[1] = "air | 1.5"; folds("u")'
  for stack in 'air | air' 'air | 1 700nm | air' 'air | 1.33 0nm | air'; do
    specfilm --stack "$stack" a.exr -o b.exr
    pixel_holds a.exr b.exr 3,2 'is("S0.500,000000nm", 0.25)'
  done
}

@test "what S0 held before is added to" {
  layers --scene noise --films 2 --grid 500:600:50 -o a.exr
  specfilm --stack "$glass" a.exr -o b.exr
  for pixel in 0,0 13,5; do
    pixel_holds a.exr b.exr $pixel '
      if (from["S0.500,000000nm"] <= 0) wrong("S0 was nothing")
      on[1] = on[2] = "'"$glass"'"; folds("u")'
  done
}

@test "without through nothing comes from behind" {
  layers --grid 500:600:50 --compression none -o a.exr
  rename_channels through. throuhg. a.exr b.exr
  specfilm --stack "$soap" b.exr -o c.exr
  pixel_holds a.exr c.exr 3,2 'seen("'"$soap"'", 550, 1, "u"); is("S0.550,000000nm", R)'
}

@test "in perspective each pixel has its own angle, and the sky beside stays" {
  layers --scene tilted --size 20x10 --angle 80 --grid 500:600:50 -o a.exr
  specfilm --stack "$soap" a.exr -o b.exr
  for pixel in 3,8 10,7 10,9; do
    pixel_holds a.exr b.exr $pixel '
      if (from["film1.cover"] != 1) wrong("no film")
      on[1] = "'"$soap"'"; folds("u")'
  done
  for pixel in 10,3 0,0; do
    pixel_holds a.exr b.exr $pixel '
      if (from["S0.500,000000nm"] == 0) wrong("no sky")
      is("S0.500,000000nm", from["S0.500,000000nm"])'
  done
}

@test "the front and the back of a sphere, between different media" {
  layers --scene sphere --size 30x20 --grid 450:650:100 --radiance 2 -o a.exr
  for light in u p; do
    specfilm --polarisation $light --stack "$glass" a.exr -o b.exr
    for pixel in 14,9 10,14 21,8 15,3; do
      pixel_holds a.exr b.exr $pixel '
        # awk as in specexr(5): both cosines are known, and both mirrors
        a = ('"${pixel%,*}"' + 0.5 - 15) / 20; b = (10 - '"${pixel#*,}"' - 0.5) / 20
        c = sqrt(1 - (a * a + b * b) / 0.16)
        if (!near(from["film1.cosine"], c, 1e-6) || !near(from["film2.cosine"], -c, 1e-6)) wrong("cosine")
        sky = 1 + 2 * c * a / 0.4 / 8 + (2 * c * c - 1) / 4 + 2 * c * b / 0.4 / 2
        yks = 1 - 2 * c * a / 0.4 / 8 + (2 * c * c - 1) / 4 - 2 * c * b / 0.4 / 2
        for (l = 450; l <= 650; l += 100) {
          power("1.5 | 1.38 120nm | air", l, c, "'$light'")
          L = T * 1.5 ^ 2 * 1.5 + R * 2 * yks
          power("air | 1.38 120nm | 1.5", l, c, "'$light'")
          is("S0." l ",000000nm", T / 1.5 ^ 2 * L + R * 2 * sky, 3e-6)
        }
        on[1] = on[2] = "'"$glass"'"; folds("'$light'")'
    done
  done
}

@test "beyond the critical angle the back of a sphere mirrors all" {
  # seen from the glass at a cosine of 0.6, below the 0.745 of glass and air
  film_image a.exr --pattern constant:-0.6
  specfilm --stack "$glass" a.exr -o b.exr
  pixel_holds a.exr b.exr 1,1 '
    seen("'"$glass"'", 500, -0.6, "u")
    if (!near(R, 1, 1e-12) || T != 0) wrong("R is " R ", T " T)
    is("S0.500,000000nm", -1.2)'
}

@test "light from behind is thinned where it leaves a denser medium" {
  layers --grid 500:500:1 --radiance 0 --behind 1 -o a.exr
  specfilm --stack 'air | 1.5' a.exr -o b.exr
  pixel_holds a.exr b.exr 1,1 'is("S0.500,000000nm", 0.96 / 2.25)'
  specfilm --stack '1.5 | air' a.exr -o b.exr
  pixel_holds a.exr b.exr 1,1 'is("S0.500,000000nm", 0.96 * 2.25)'
}

# Thickness

@test "--thickness sets the only layer, or the one with a star" {
  layers --grid 500:600:50 -o a.exr
  specfilm --no-history --stack "$soap" a.exr -o want.exr
  for stack in "$soap" 'air | 1.33 * | air' 'air | 1.33 9nm | air'; do
    specfilm --no-history --stack "$stack" --thickness 0.5um a.exr -o b.exr
    cmp b.exr want.exr
  done
  specfilm --no-history --stack 'air | 1.5 70nm | 1.33 500nm | 1.7 30nm | 1.5' a.exr -o want.exr
  specfilm --no-history --stack 'air | 1.5 70nm | 1.33 * | 1.7 30nm | 1.5' -t 500nm a.exr -o b.exr
  cmp b.exr want.exr
}

@test "gravity: thin above and thick below, along each axis of the object" {
  for axis in '' ' z' ' -z' ' y' ' -y' ' x' ' -x'; do
    layers --angle 40 --grid 450:650:100 -o a.exr
    specfilm --stack 'air | 1.33 * | air' --thickness "gravity 530nm..730nm$axis" a.exr -o b.exr
    for pixel in 0,0 0,7 9,3 15,7; do
      pixel_holds a.exr b.exr $pixel '
        z = 1 - ('"${pixel#*,}"' + 0.5) / 8; x = ('"${pixel%,*}"' + 0.5) / 16
        axis = "'"$axis"'"; sub(/^ /, "", axis)
        q = axis ~ /x$/ ? x : axis ~ /y$/ ? 1 - z : z
        if (axis ~ /^-/) q = 1 - q
        on[1] = sprintf("air | 1.33 %.15gnm | air", 530 * (730 / 530) ^ (1 - q)); folds("u")'
    done
  done
}

@test "gravity between lengths whose quotient is no number" {
  # at both ends and between there is less film than light could tell, and no NaN
  layers --grid 500:500:1 --size 3x3 -o a.exr
  for axis in z -z; do
    specfilm --stack 'air | 1.33 * | air' --thickness "gravity 1m..1e-300nm $axis" a.exr -o b.exr
    for pixel in 1,0 1,1 1,2; do
      layers --print $pixel b.exr | grep -qE '^S0.500,000000nm [0-9.e+-]+$' || complain "$axis: $(layers --print $pixel b.exr)"
    done
  done
}

@test "gravity on a sphere: each side by its own Q" {
  layers --scene sphere --grid 450:650:100 -o a.exr
  specfilm --stack 'air | 1.33 * | air' --thickness 'gravity 300nm..900nm y' a.exr -o b.exr
  for pixel in 7,4 10,2; do
    pixel_holds a.exr b.exr $pixel '
      for (film = 1; film <= 2; film++)
        on[film] = sprintf("air | 1.33 %.15gnm | air", 300 * 3 ^ (1 - from["film" film ".Q.Y"]))
      folds("u")'
  done
}

@test "gravity moves one layer of several" {
  layers --grid 450:650:100 -o a.exr
  specfilm --stack 'air | 1.33 * | 2 80nm | 1.5' --thickness 'gravity 300nm..900nm' a.exr -o b.exr
  pixel_holds a.exr b.exr 4,6 '
    on[1] = sprintf("air | 1.33 %.15gnm | 2 80nm | 1.5", 300 * 3 ^ (6.5 / 8)); folds("u")'
}

# Several films

@test "one film behind another, each with a stack of its own by its id" {
  layers --scene pair --grid 450:650:100 --radiance 2 --angle 30 -o a.exr
  for order in 1 2; do
    if [ $order = 1 ]; then
      specfilm --stack "$soap" --mask 3 --stack 'air | 1.5 200nm | air' --mask 7 a.exr -o b.exr 2>said
    else
      specfilm --mask 7 --stack 'air | 1.5 200nm | air' --mask 3 --stack "$soap" a.exr -o b.exr 2>said
    fi
    [ ! -s said ]
    for pixel in 2,3 12,5; do
      pixel_holds a.exr b.exr $pixel '
        on[1] = "'"$soap"'"; on[2] = "air | 1.5 200nm | air"; folds("u")'
    done
    # once more, written out
    pixel_holds a.exr b.exr 12,5 '
      c = from["film1.cosine"]
      seen("air | 1.5 200nm | air", 550, c, "u"); L = T * 0.25 + R * 1
      seen("'"$soap"'", 550, c, "u"); is("S0.550,000000nm", T * L + R * 2)'
  done
}

@test "a stack without --mask is for all the other ids" {
  layers --scene pair --grid 450:650:100 -o a.exr
  specfilm --stack "$soap" --stack 'air | 1.5 200nm | air' --mask 7 a.exr -o b.exr 2>said
  [ ! -s said ]
  pixel_holds a.exr b.exr 12,5 'on[1] = "'"$soap"'"; on[2] = "air | 1.5 200nm | air"; folds("u")'
  specfilm --mask 7 --stack 'air | 1.5 200nm | air' --stack "$soap" a.exr -o c.exr
  specdiff b.exr c.exr
}

@test "each stack has its own thickness" {
  layers --scene pair --grid 450:650:100 -o a.exr
  specfilm --stack 'air | 1.33 * | air' --mask 3 --thickness 444nm \
    --stack 'air | 1.5 * | air' --mask 7 --thickness 'gravity 200nm..400nm' a.exr -o b.exr
  pixel_holds a.exr b.exr 12,5 '
    on[1] = "air | 1.33 444nm | air"
    on[2] = sprintf("air | 1.5 %.15gnm | air", 200 * 2 ^ (5.5 / 8)); folds("u")'
}

@test "a surface without a stack is left out as if clear, and told" {
  layers --scene pair --grid 450:650:100 --size 16x8 -o a.exr
  specfilm --stack "$soap" --mask 3 a.exr -o b.exr 2>said
  [ "$(cat said)" = 'specfilm: warning: no stack is for the id of 64 pixels: left out' ] || complain "$(cat said)"
  pixel_holds a.exr b.exr 12,5 'on[1] = "'"$soap"'"; folds("u")'
  specfilm --stack "$soap" --mask 7 a.exr -o c.exr 2>said
  [ "$(cat said)" = 'specfilm: warning: no stack is for the id of 128 pixels: left out' ] || complain "$(cat said)"
  pixel_holds a.exr c.exr 2,5 'is("S0.450,000000nm", 0.25)'
  pixel_holds a.exr c.exr 12,5 'on[2] = "'"$soap"'"; folds("u")'
  specfilm -q --stack "$soap" --mask 3 a.exr -o d.exr 2>said
  [ ! -s said ]
  specdiff b.exr d.exr
  layers --grid 500:500:1 --size 1x1 -o e.exr
  specfilm --stack "$soap" --mask 9 e.exr -o f.exr 2>said
  [ "$(cat said)" = 'specfilm: warning: no stack is for the id of 1 pixel: left out' ] || complain "$(cat said)"
}

@test "the largest id, and 0" {
  film_image a.exr --uint film1.id --size 2x1
  specfilm --stack "$soap" --mask 0 -q a.exr -o b.exr
  pixel_holds a.exr b.exr 0,0 'seen("'"$soap"'", 500, 0.5, "u"); is("S0.500,000000nm", 0.5 + (R + T) / 2)'
  pixel_holds a.exr b.exr 1,0 'is("S0.500,000000nm", 1)'
  specfilm --stack "$soap" --mask 4294967295 -q a.exr -o c.exr
  pixel_holds a.exr c.exr 0,0 'is("S0.500,000000nm", 1)'
}

@test "at a silhouette light that passes beside the second film crosses the first alone" {
  layers --scene pair --size 3x3 --samples 4 --grid 450:650:100 --angle 30 -o a.exr
  specfilm --stack "$soap" a.exr -o b.exr
  pixel_holds a.exr b.exr 1,1 '
    if (from["film1.cover"] != 1 || from["film2.cover"] != 0.5) wrong("cover")
    for (l = 450; l <= 650; l += 100) {
      seen("'"$soap"'", l, from["film1.cosine"], "u")
      L = (1 + T) / 2 * 0.25 + R * from["film2.mirror.S0." l ",000000nm"]
      is("S0." l ",000000nm", T * L + R * 1)
    }'
}

@test "at the silhouette of a sphere through is premultiplied, and the sky beside stays" {
  layers --scene sphere --size 4x4 --radius 0.25 --samples 2 --grid 500:500:1 -o a.exr
  specfilm --stack "$glass" a.exr -o b.exr
  pixel_holds a.exr b.exr 1,1 '
    if (from["film1.cover"] != 0.75 || from["film2.cover"] != 0.75) wrong("cover")
    if (from["S0.500,000000nm"] == 0) wrong("no sky")
    on[1] = on[2] = "'"$glass"'"; folds("u")'
  pixel_holds a.exr b.exr 0,0 'is("S0.500,000000nm", from["S0.500,000000nm"])'
}

@test "a film that covers more than the first keeps what is behind it" {
  # samples are 0.2, 0.4 ... by --channel: cover 1 is 0.5, cover 2 is 0.7
  spectral a.exr --size 1x1 --pattern ramp --channel S0.500nm --channel film1.mirror.S0.500nm \
    --channel film2.mirror.S0.500nm --channel film1.cosine --channel film2.cosine \
    --channel film1.cover --channel through.S0.500nm --channel film2.cover
  specfilm --stack "$soap" a.exr -o b.exr
  pixel_holds a.exr b.exr 0,0 '
    from["S0.500,000000nm"] = from["S0.500nm"]
    if (!(from["film2.cover"] > from["film1.cover"] && from["film1.cover"] > 0)) wrong("cover")
    seen("'"$soap"'", 500, from["film2.cosine"], "u")
    L = T * from["through.S0.500nm"] + R * from["film2.mirror.S0.500nm"]
    seen("'"$soap"'", 500, from["film1.cosine"], "u")
    is("S0.500,000000nm", from["S0.500nm"] + T * L + R * from["film1.mirror.S0.500nm"])'
}

@test "a second film that covers a part, behind a first that covers all" {
  spectral a.exr --size 1x1 --pattern constant:0.5 --channel S0.500nm --channel film1.mirror.S0.500nm \
    --channel film2.mirror.S0.500nm --channel film1.cosine --channel film2.cosine \
    --channel through.S0.500nm --channel film2.cover
  specfilm --stack "$soap" a.exr -o b.exr
  pixel_holds a.exr b.exr 0,0 '
    seen("'"$soap"'", 500, 0.5, "u")
    is("S0.500,000000nm", 0.5 + T * ((1 + T) / 2 + R) / 2 + R / 2)'
}

@test "an index outside its data is taken from its end where that is asked for" {
  layers --grid 450:500:50 -o a.exr
  printf '# quantity: refractive index\n# columns: wavelength_nm n\n500 1.4\n600 1.6\n' >my.spd
  fails_pointing 7 specfilm --stack 'air | ./my.spd' a.exr -o b.exr
  specfilm --extrapolate constant --stack 'air | ./my.spd' a.exr -o b.exr
  pixel_holds a.exr b.exr 1,1 '
    seen("air | 1.4", 500, 1, "u"); is("S0.450,000000nm", R + T / 4)
    is("S0.500,000000nm", R + T / 4)'
  spectrum --extrapolate constant --grid 450:500:50 --stack 'air | ./my.spd' | awk '{ print $2 }' | uniq >found
  [ "$(wc -l <found)" -eq 1 ] || complain "$(cat found)"
}

@test "glass and water that hardly absorb are clear" {
  # the tables have k of about 1e-8, which is 0.1 % over centimetres
  layers --grid 550:550:1 -o a.exr
  specfilm --stack 'air | N-BK7' a.exr -o b.exr
  index=$(specconvert --grid 550:550:1 N-BK7 | awk '!/^#/ { print $2 }')
  pixel_holds a.exr b.exr 1,1 'seen("air | '"$index"'", 550, 1, "u"); is("S0.550,000000nm", R + T / 4)'
  layers --scene sphere --grid 550:550:1 -o c.exr
  specfilm --stack 'air | MgF2 100nm | N-BK7' c.exr -o d.exr
  spectrum --stack 'water | 1.5 100nm | air' --grid 550:550:1
}

@test "a k of 1e-4 is not clear, one below is" {
  layers --grid 550:550:1 -o a.exr
  specfilm --stack 'air | 1.5+0.000099i' a.exr -o b.exr
  pixel_holds a.exr b.exr 1,1 'seen("air | 1.5", 550, 1, "u"); is("S0.550,000000nm", R + T / 4)'
  specfilm --stack 'air | 1.5+0.0001i' a.exr -o b.exr
  pixel_holds a.exr b.exr 1,1 'seen("air | 1.5", 550, 1, "u"); is("S0.550,000000nm", R)'
  spectrum --stack '1.5+0.000099i | air' --grid 550:550:1
  fails_cleanly specfilm --spectrum --stack '1.5+0.0001i | air'
}

@test "a substrate without an index lets nothing through" {
  # n is 0 and k is taken for 0: all is mirrored, and what comes out of it is 0, not NaN
  layers --grid 550:550:1 --behind 3 -o a.exr
  specfilm --stack 'air | 0+0.00001i' a.exr -o b.exr
  pixel_holds a.exr b.exr 1,1 'is("S0.550,000000nm", 1)'
}

# --spectrum

@test "--spectrum is a curve of R, T and A" {
  specfilm --spectrum --stack "$soap" --grid 500:600:50 >curve
  grep -qx '# columns: wavelength_nm R T A' curve
  grep -qx '# quantity: reflectance' curve
  grep -qx '# unit: 1' curve
  grep -qx "# title: $soap, 0 deg, unpolarised light" curve
  [ "$(grep -v '^#' curve | awk '{ print $1, NF }' | xargs)" = '500 4 550 4 600 4' ] || complain "$(cat curve)"
  [ "$(spectrum --stack "$soap" | wc -l)" -eq 81 ]
  spectrum --stack "$soap" | sed -n '1p;81p' | grep -cE '^(380|780) ' | grep -qx 2
  specfilm --spectrum --stack "$soap" --grid 500:600:50 -o file
  cmp file curve
}

@test "--spectrum is right over angles, polarisations and what absorbs, and R + T + A is 1" {
  for stack in "$soap" "$glass" 'air | 0.2+3.1i 20nm | 1.5' 'air | 1.5' '1.5 | 1.38 120nm | air' \
    'air | 1.3+0.01i 2000nm | 0.5+3i'; do
    for angle in 0 30 60 85; do
      for light in u s p; do
        specfilm --spectrum --stack "$stack" --angle $angle --polarisation $light --grid 400:700:100 >curve
        # shellcheck disable=SC2016 # $1 is awk's
        spectrum_holds '
          power("'"$stack"'", $1, cos('$angle' * pi / 180), "'$light'")
          if (!near($2, R, 1e-9) || !near($3, T, 1e-9)) wrong($0 ", not " R " " T)
          if (!near($2 + $3 + $4, 1, 1e-12)) wrong($0)' < <(grep -v '^#' curve)
      done
    done
  done
}

@test "a quarter wave of MgF2 on glass reflects .0126 at 550 nm" {
  spectrum --stack 'air | 1.38 99.637681nm | 1.52' --grid 550:550:1 |
    awk '{ right = $2 > 0.012595 && $2 < 0.012605 } END { exit !right }'
}

@test "at 90 degrees all is mirrored" {
  spectrum --stack "$glass" --angle 90 --grid 400:700:100 |
    awk '{ mirrored += $2 > 1 - 1e-9 && $3 < 1e-9 } END { exit mirrored != 4 || NR != 4 }'
}

@test "what --spectrum prints is a curve for the other tools" {
  specfilm --spectrum --stack "$soap" --grid 400:700:100 >a.spd
  specfilm --spectrum --stack "$soap" --grid 400:700:100 | specconvert | cmp - a.spd
  specconvert a.spd -o patches.exr
  has_channels patches.exr T.400,000000nm T.500,000000nm T.600,000000nm T.700,000000nm
  specconvert patches.exr -f spd | grep -q '^500 0.06029'
}

@test "--spectrum takes one thickness, and no course of it" {
  spectrum --stack "$soap" --grid 400:700:100 >want
  spectrum --stack 'air | 1.33 * | air' --thickness 500nm --grid 400:700:100 | cmp - want
  fails_cleanly specfilm --spectrum --stack 'air | 1.33 * | air' --thickness 'gravity 5nm..6nm'
  [[ $stderr = *'one thickness'* ]] || complain "$stderr"
  fails_cleanly specfilm --chart 'angle 0..9' --stack 'air | 1.33 * | air' --thickness 'gravity 5nm..6nm' -o c.exr
  no_leftovers . want
}

# --chart

# chart_is FILE X,Y COLUMN ARGUMENT...: that pixel is this column of --spectrum with those arguments.
chart_is() {
  specfilm --spectrum "${@:4}" | grep -v '^#' >curve
  paste -d ' ' curve <(layers --print "$2" "$1") | awk -v column="$3" '
    NF != 6 { exit failed = 1 }
    { off = $column - $6; if (off < 0) off = -off; if (!(off < 1e-7)) failed = 1 }
    END { exit failed || !NR }' || complain "$1, pixel $2:" "$(cat curve)" "$(layers --print "$2" "$1")"
}

@test "--chart is an image of reflectance, or of what --of names" {
  specfilm --stack "$soap" --chart 'thickness 0..700' --grid 500:600:50 --size 7x3 -o a.exr
  has_channels a.exr T.500,000000nm T.550,000000nm T.600,000000nm
  exrheader a.exr >header
  grep -qx 'dataWindow (type box2i): (0 0) - (6 2)' header
  grep -qx 'displayWindow (type box2i): (0 0) - (6 2)' header
  grep -qx 'spec:quantity (type string): "reflectance"' header
  grep -qx 'spectralLayoutVersion (type string): "1.0"' header
  for share in reflectance transmittance absorptance; do
    specfilm --stack "$soap" --chart 'angle 0..9' --of $share --size 2x2 -o b.exr
    exrheader b.exr | grep -qx "spec:quantity (type string): \"$share\""
  done
  specfilm --stack "$soap" --chart 'angle 0..9' --half --size 2x2 -o c.exr
  [ "$(exrheader c.exr | grep -c '^    T.*16-bit')" -eq 81 ]
  specfilm --stack "$soap" --chart 'angle 0..9' --grid 500:500:1 -o d.exr
  exrheader d.exr | grep -qx 'dataWindow (type box2i): (0 0) - (479 269)'
  specfilm --stack "$soap" --chart 'angle 0..9' --grid 500:500:1 --size 32768x1 -o e.exr
  exrheader e.exr | grep -qx 'dataWindow (type box2i): (0 0) - (32767 0)'
}

@test "--chart holds what --spectrum prints, at both ends of both axes and between" {
  stack='air | 1.33 * | 1.5'
  specfilm --stack "$stack" --chart 'thickness 0nm..800nm, angle 10..1rad' --grid 400:700:100 --size 5x3 -o a.exr
  chart_is a.exr 0,0 2 --stack 'air | 1.5' --grid 400:700:100 --angle 10
  chart_is a.exr 4,0 2 --stack "$stack" -t 800nm --grid 400:700:100 --angle 10
  chart_is a.exr 0,2 2 --stack 'air | 1.5' --grid 400:700:100 --angle 1rad
  chart_is a.exr 4,2 2 --stack "$stack" -t 800nm --grid 400:700:100 --angle 1rad
  chart_is a.exr 1,1 2 --stack "$stack" -t 200nm --grid 400:700:100 --angle 33.6478897565411604
  specfilm --stack "$stack" --chart 'angle 60..0deg,thickness 800..0.2um' --grid 400:700:100 --size 3x5 -o b.exr
  chart_is b.exr 0,0 2 --stack "$stack" -t 800nm --grid 400:700:100 --angle 60
  chart_is b.exr 2,4 2 --stack "$stack" -t 200nm --grid 400:700:100
  chart_is b.exr 1,2 2 --stack "$stack" -t 500nm --grid 400:700:100 --angle 30
}

@test "--chart over one variable is the same in every line" {
  specfilm --stack "$soap" --chart 'angle 0..80' --grid 400:700:100 --size 5x3 -o a.exr
  specfilm --stack "$soap" --chart 'thickness 100..500' --angle 60 --polarisation p --grid 400:700:100 --size 5x3 -o b.exr
  for y in 0 1 2; do
    chart_is a.exr 0,$y 2 --stack "$soap" --grid 400:700:100
    chart_is a.exr 3,$y 2 --stack "$soap" --grid 400:700:100 --angle 60
    chart_is b.exr 0,$y 2 --stack "$soap" -t 100nm --grid 400:700:100 --angle 60 --polarisation p
    chart_is b.exr 4,$y 2 --stack "$soap" --grid 400:700:100 --angle 60 --polarisation p
  done
}

@test "--chart of one pixel is at the beginning of its axes" {
  specfilm --stack "$soap" --chart 'thickness 300..500, angle 20..40' --size 1x1 --grid 400:700:100 -o a.exr
  chart_is a.exr 0,0 2 --stack "$soap" -t 300nm --angle 20 --grid 400:700:100
}

@test "--chart --of transmittance and absorptance" {
  stack='air | 0.2+3.1i * | 1.5'
  for share in transmittance:3 absorptance:4; do
    specfilm --stack "$stack" --chart 'thickness 0..40, angle 0..80' --of ${share%:*} --grid 400:700:100 --size 3x3 -o a.exr
    chart_is a.exr 1,0 ${share#*:} --stack "$stack" -t 20nm --grid 400:700:100
    chart_is a.exr 2,1 ${share#*:} --stack "$stack" -t 40nm --angle 40 --grid 400:700:100
  done
}

@test "what does not absorb has no negative absorptance" {
  for stack in "$soap" 'air | 1.33 * | 1.6 80nm | 1.5'; do
    specfilm --stack "$stack" --chart 'thickness 0..700, angle 0..90' --of absorptance --size 40x30 -o a.exr
    specinfo --json --statistics a.exr | jq -e '.statistics[0] | .samples == 97200 and .negative == 0 and .nan == 0'
  done
}

@test "--chart needs a layer to vary" {
  fails_cleanly specfilm --stack 'air | 1.5' --chart 'thickness 0..9' -o a.exr
  fails_cleanly specfilm --stack 'air | 1.5 5nm | 1.6 5nm | air' --chart 'thickness 0..9' -o a.exr
  specfilm --stack 'air | 1.5' --chart 'angle 0..9' --size 2x2 -o a.exr
  fails_pointing 11 specfilm --stack 'air | 1.5 * | air' --chart 'angle 0..9' -o b.exr
  no_leftovers . a.exr
}
