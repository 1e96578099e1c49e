#!/usr/bin/env bats
# specdisc: discs add to images what their models say, computed again by awk; orders and charts;
# and everything else stays as it was.
# shellcheck disable=SC2154 # fails_cleanly leaves its line in stderr

load common
load physics

functions=$disc_functions

# disc_image FILE [ARGUMENT...]: an image of the least that a disc needs, at 500 nm; the vectors,
# which are none of length 1, all point to the same side.
disc_image() {
  spectral "$1" --channel S0.500nm --channel lamp1.S0.500nm --channel I.X --channel Tan.Y \
    --channel N.X --channel lamp1.D.Z --channel N.Y --channel I.Y --channel Tan.X --channel N.Z \
    --channel lamp1.D.X --channel Tan.Z --channel I.Z --channel lamp1.D.Y "${@:2}"
}

# The command line

@test "--help, --version and options that are not there" {
  [[ $(specdisc --help) = 'usage: specdisc [OPTION]... [FILE]'* ]]
  [[ $(specdisc -V) =~ ^specdisc\ \(spectools\)\ [0-9.]+$ ]]
  fails_cleanly specdisc --prest cd
  [[ $stderr = *"did you mean '--preset'?" ]] || complain "$stderr"
  fails_cleanly specdisc -x
  for option in preset track pit mask model spread centre axis chart size angle azimuth grid output; do
    fails_cleanly specdisc --$option
    [[ $stderr = *"option '--$option' needs an argument"* ]] || complain "$stderr"
  done
  no_leftovers .
}

@test "one image at a time" {
  disc_image a.exr
  fails_cleanly specdisc a.exr a.exr -o b.exr
  [[ $stderr = *'one image at a time'* ]] || complain "$stderr"
  no_leftovers . a.exr
}

@test "what does not go together is refused" {
  disc_image a.exr
  refused() {
    fails_cleanly specdisc "$@" -o b.exr
    [ ! -e b.exr ] || complain "an image was made: $*"
  }
  refused --orders --chart 'eye 0..9'
  for alone in --orders --chart=eye\ 0..9; do
    refused "$alone" a.exr
    refused "$alone" -
    refused "$alone" --mask 3
    refused "$alone" --keep
    refused "$alone" --centre 0,0,0
    refused "$alone" --preset cd --preset dvd
    refused "$alone" --spread 1
  done
  for option in --angle=3 --eye=3 --azimuth=3 --grid=500:500:1 --size=3x3 --axis=0,0,1 --spread=1; do
    refused $option a.exr
  done
  refused --orders --size 3x3
  refused --orders --eye 3
  refused --orders --model orders
  refused --orders --pit 3um
  # what an axis gives is not given twice
  refused --chart 'eye 0..9' --eye 3
  refused --chart 'eye 0..9, lamp 0..9' --angle 3
  refused --chart 'azimuth 0..9' --azimuth 3
  refused --model composite --spread 1 a.exr
}

@test "values that are none are refused" {
  disc_image a.exr
  for option in --preset=x --preset= --preset=CD --model=x --track=0 --track=x --track=-5nm --pit=0 \
    --mask=x --mask=-1 --mask=4294967296 --threads=0; do
    fails_cleanly specdisc $option a.exr -o b.exr
  done
  fails_cleanly specdisc --preset lp a.exr -o b.exr
  [[ $stderr = *'cd, dvd, bluray and vinyl' ]] || complain "$stderr"
  for spread in 0 -1 0.00009 45.1 46 x 1nm 2rad; do
    fails_cleanly specdisc --model orders --spread $spread a.exr -o b.exr
  done
  for eye in 91 -91 x; do
    fails_cleanly specdisc --chart 'lamp 0..9' --eye $eye -o b.exr
  done
  for option in --angle=91 --angle=-1 --azimuth=181 --azimuth=-181 --azimuth=x --grid=500; do
    fails_cleanly specdisc --orders $option
  done
  for size in 0x5 5 40000x5 32769x1; do
    fails_cleanly specdisc --chart 'eye 0..9' --size $size -o b.exr
  done
  no_leftovers . a.exr
}

@test "vectors that are none are refused" {
  layers --scene disc --grid 500:500:1 -o a.exr
  for vector in '' 1 1,2 1,2,3,4 1,2,x ',,' '1,2,' ,1,2 nan,0,0 inf,0,0 1e10,0,0 '1;2;3' '1, 2, 3m'; do
    fails_cleanly specdisc --centre "$vector" a.exr -o b.exr
    [[ $stderr = *'the centre '* ]] || complain "$stderr"
    fails_cleanly specdisc --centre 0,0,0 --axis "$vector" a.exr -o b.exr
    [[ $stderr = *'the axis '* ]] || complain "$stderr"
  done
  for axis in 0,0,0 -0,0,0e5; do
    fails_cleanly specdisc --centre 0,0,0 --axis $axis a.exr -o b.exr
    [[ $stderr = *'axis is 0,0,0' ]] || complain "$stderr"
  done
  no_leftovers . a.exr
}

@test "two discs for one surface are refused" {
  disc_image a.exr
  fails_cleanly specdisc --preset cd --preset dvd a.exr -o b.exr
  [[ $stderr = *'two discs are for all surfaces'* ]] || complain "$stderr"
  fails_cleanly specdisc --mask 3 --preset cd --mask 3 a.exr -o b.exr
  [[ $stderr = *'two discs are for the id 3' ]] || complain "$stderr"
  no_leftovers . a.exr
}

# quickly ARGUMENT...: done within a second or two.
quickly() {
  timeout 3 specdisc "$@" -o out || complain "exit $?: $*"
}

@test "a track or a pit of more than 1 cm is refused, and any other quickly done" {
  layers --scene disc --grid 500:600:100 -o a.exr
  for distance in 10.1mm 11mm 1000m 1e30m; do
    fails_cleanly specdisc --orders --track $distance
    fails_cleanly specdisc --track $distance a.exr -o b.exr
    fails_cleanly specdisc --pit $distance a.exr -o b.exr
  done
  for distance in 1cm 1e-300nm; do
    quickly --track $distance --orders --grid 500:500:1
    for model in composite orders; do
      quickly --track $distance --pit $distance --model $model --chart 'eye 0..9' --size 5x5 --grid 500:600:50
      quickly --track $distance --pit $distance --model $model a.exr
    done
  done
}

# axes_faulty BEFORE AFTER
axes_faulty() {
  fails_pointing $((${#1} + 1)) specdisc --chart "$1$2" -o c.exr
  no_leftovers .
}

@test "axes that are none are shown with a caret under the fault" {
  for text in '' x 'thickness 0..9' 'Lamp 0..9'; do
    axes_faulty '' "$text"
  done
  axes_faulty 'lamp' ''
  axes_faulty 'azimuth ' '5'
  axes_faulty 'eye 0..' '91'
  axes_faulty 'lamp ' '-91..0'
  axes_faulty 'azimuth 0..' '181'
  axes_faulty 'lamp 0..' '9nm'
  axes_faulty 'lamp 0..9,' ''
  axes_faulty 'lamp 0..9 ' 'eye 0..9'
  axes_faulty 'lamp 0..9, eye 0..9' ', azimuth 0..9'
}

@test "of two axes that are the same the second is shown" {
  axes_faulty 'lamp 0..9, ' 'lamp 0..8'
}

# What comes in

@test "a file, standard input, '-' and a process substitution are read alike" {
  layers --scene disc --grid 500:600:50 -o a.exr
  specdisc --no-history a.exr -o file.exr
  specdisc --no-history <a.exr -o redirected.exr
  specdisc --no-history - < <(cat a.exr) -o dash.exr
  specdisc --no-history <(cat a.exr) -o substituted.exr
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
    fails_cleanly specdisc $file -o out.exr
    [[ $stderr = *$file* ]] || complain "$stderr"
  done
  fails_cleanly specdisc -o out.exr </dev/null
  [[ $stderr = *'is empty' ]] || complain "$stderr"
  [ "$(cat out.exr)" = old ]
  no_leftovers . empty.exr text.exr folder out.exr
}

@test "an image cut off anywhere is refused, and the file there was stays" {
  echo old >out.exr
  for compression in none zip; do
    layers --scene disc --size 9x35 --grid 500:520:20 --compression $compression -o a.exr
    size=$(wc -c <a.exr)
    for percent in 0 1 5 20 50 80 99; do
      head -c $((size * percent / 100)) a.exr >short.exr
      fails_cleanly specdisc short.exr -o out.exr
      fails_cleanly specdisc - -o out.exr < <(cat short.exr)
    done
  done
  [ "$(cat out.exr)" = old ]
  no_leftovers . a.exr short.exr out.exr
}

@test "a part is chosen by number" {
  disc_image a.exr
  spectral b.exr --grid 500:500:1 --pattern constant:1
  exrmultipart -combine -i b.exr a.exr -o both.exr >/dev/null
  specdisc a.exr -o want.exr
  specdisc --part 1 both.exr -o part.exr
  specdiff want.exr part.exr
  fails_cleanly specdisc both.exr -o none.exr
  [[ $stderr = *--part* ]] || complain "$stderr"
  [ ! -e none.exr ]
}

@test "each limit is refused by name" {
  layers --scene disc -o a.exr
  for limit in pixels=127 channels=15 header=500 memory=1k; do
    fails_cleanly specdisc --limit $limit a.exr -o b.exr
    [[ $stderr = *"--limit ${limit%=*}="* ]] || complain "$limit: $stderr"
  done
  no_leftovers . a.exr
}

# What comes out

@test "an image may be written over itself" {
  disc_image a.exr
  specdisc --no-history a.exr -o want.exr
  specdisc --no-history a.exr -o a.exr
  cmp a.exr want.exr
}

@test "a full device fails, and leaves nothing" {
  disc_image a.exr
  mkdir tmp
  export TMPDIR=$PWD/tmp
  for made in '--chart=eye 0..9' --orders a.exr; do
    fails_cleanly specdisc "$made" -o /dev/full
    code=0
    specdisc "$made" >/dev/full 2>err || code=$?
    [ "$code" -eq 2 ] && [ "$(wc -l <err)" -eq 1 ] || complain "$made: exit $code" "$(cat err)"
  done
  fails_cleanly specdisc a.exr -o missing/b.exr
  no_leftovers tmp
  no_leftovers . a.exr err tmp
}

@test "no image is written to a terminal, but a table is" {
  disc_image a.exr
  for made in "--chart 'eye 0..9'" a.exr; do
    shuns_terminal "specdisc $made"
  done
  script -qec 'specdisc --orders --grid 532:532:1' typescript </dev/null >seen
  grep -q '^0 532 0 0' seen
}

@test "every number of threads writes the same bytes" {
  layers --scene noise --lamps 3 --size 61x67 --grid 400:700:20 -o a.exr
  for model in composite orders; do
    specdisc --no-history -j 1 --model $model a.exr -o 1.exr
    specdisc --no-history -j 4 --model $model a.exr -o 4.exr
    cmp 1.exr 4.exr
    specdisc --no-history -j 4 --model $model a.exr | cat >4.exr
    specdisc --no-history -j 1 --model $model - < <(cat a.exr) | cat >1.exr
    cmp 1.exr 4.exr
    specdisc --no-history -j 1 --model $model --chart 'eye -90..90, lamp 0..90' --size 300x40 -o 1.exr
    specdisc --no-history -j 4 --model $model --chart 'eye -90..90, lamp 0..90' --size 300x40 -o 4.exr
    cmp 1.exr 4.exr
  done
}

@test "runs of 256 pixels and lines of other lengths give the same pixels" {
  layers --scene noise --lamps 2 --size 600x2 --grid 500:600:50 -o a.exr
  specdisc a.exr -o b.exr
  specdisc --model orders a.exr -o c.exr
  for x in 0 255 256 511 512 599; do
    pixel_holds a.exr b.exr $x,1 'disc("cd"); adds(0)'
    specconvert --crop $x,1,$((x + 1)),2 a.exr | specdisc --model orders -o one.exr
    specconvert --crop $x,1,$((x + 1)),2 c.exr | specdiff one.exr -
  done
}

@test "every lossless compression gives the same pixels" {
  layers --scene disc --grid 500:600:50 -o a.exr
  specdisc a.exr -o want.exr
  for compression in none rle zips zip piz; do
    specdisc --compression $compression a.exr -o b.exr
    specdiff want.exr b.exr
  done
}

@test "--half stores the light as HALF, and what is too large is told" {
  layers --scene disc --grid 500:600:50 -o a.exr
  specdisc a.exr -o float.exr
  specdisc --half a.exr -o half.exr
  specconvert --half float.exr | specdiff half.exr -
  [ "$(exrheader half.exr | grep -c '^    S0.*16-bit')" -eq 3 ]
  [ "$(exrheader half.exr | grep -c '^    [A-Z][a-z]*[.][XYZ], 32-bit')" -eq 18 ]
  layers --scene disc --grid 500:500:1 --lamp 0.1,0.2,0.4,1e9 --size 8x8 -o b.exr
  specdisc --half b.exr -o c.exr 2>said
  [[ $(cat said) = 'specdisc: warning: c.exr: '*' samples are too large for 16 bits and became infinite' ]] ||
    complain "$(cat said)"
  specdisc -q --half b.exr -o c.exr 2>said
  [ ! -s said ]
}

@test "spec:history has a line for it, and --no-history none" {
  disc_image a.exr
  specdisc --preset dvd a.exr -o b.exr
  version=$(specdisc --version | sed 's/.* //')
  exrheader b.exr | grep -qF "\"specdisc --preset dvd a.exr -o b.exr  # spectools $version" || complain "$(exrheader b.exr)"
  specdisc --no-history a.exr -o b.exr
  specdisc --no-history --chart 'eye 0..9' --size 2x2 -o c.exr
  run ! grep history <<<"$(exrheader b.exr c.exr)"
}

@test "windows and attributes pass through" {
  disc_image a.exr --data -7,-300 --display -1000,5,20,4000 --attribute 'own:text=two words' \
    --attribute empty= --quantity 'radiance per band'
  exrstdattr -owner me -longitude 5.25 -keyCode 1 2 3 4 5 4 64 -float own:float 1.5 \
    -screenWindowWidth 2.5 -screenWindowCenter 0.25 -0.5 -pixelAspectRatio 1.25 a.exr b.exr
  specdisc --no-history b.exr -o c.exr
  [ "$(header_of b.exr)" = "$(header_of c.exr)" ] || complain "$(diff <(header_of b.exr) <(header_of c.exr))"
}

@test "lamps go; geometry, films and foreign channels stay, and a preview goes" {
  disc_image a.exr --extra A --extra R --extra G --extra B --extra lampion --extra lamp0.x \
    --extra lamp1.other --extra cosine --extra film1.mirror.S0.500nm --extra through.S0.500nm \
    --extra film1.cosine --uint-id --size 4x2
  specdisc a.exr -o b.exr
  has_channels b.exr A I.X I.Y I.Z N.X N.Y N.Z S0.500,000000nm Tan.X Tan.Y Tan.Z cosine film1.cosine \
    film1.mirror.S0.500nm id lamp0.x lampion through.S0.500nm
  for pixel in 0,0 3,1; do
    pixel_holds a.exr b.exr $pixel 'for (name in to) if (name !~ /^S0/ && to[name] != from[name]) wrong(name)'
  done
}

@test "with --keep all but the preview stays" {
  layers --scene disc --grid 500:600:50 -o a.exr
  specdisc a.exr -o b.exr
  specdisc --keep a.exr -o c.exr
  [ "$(channels c.exr)" = "$(channels a.exr)" ] || complain "$(channels c.exr)"
  pixel_holds b.exr c.exr 10,4 'for (name in from) if (to[name] != from[name]) wrong(name)'
  pixel_holds a.exr c.exr 10,4 'for (name in from) if (name !~ /^S0/ && to[name] != from[name]) wrong(name)'
}

@test "HALF light stays HALF, and other namings are the same bands" {
  layers --scene disc --half --grid 500:600:50 -o half.exr
  specdisc --no-history half.exr -o b.exr
  specdisc --no-history --half half.exr -o c.exr
  cmp b.exr c.exr
  disc_image d.exr
  spectral e.exr --channel S0.0,5um --channel lamp1.S0.5e-7m --channel I.X --channel Tan.Y \
    --channel N.X --channel lamp1.D.Z --channel N.Y --channel I.Y --channel Tan.X --channel N.Z \
    --channel lamp1.D.X --channel Tan.Z --channel I.Z --channel lamp1.D.Y
  specdisc d.exr -o f.exr
  specdisc e.exr -o g.exr
  specdiff f.exr g.exr
}

# Layers that are wrong

# layers_refused FILE TEXT [ARGUMENT...]: with a line that has it.
layers_refused() {
  fails_cleanly specdisc "${@:3}" "$1" -o out.exr
  [[ $stderr = "specdisc: $1: "*"$2"* ]] || complain "$stderr"
  [ ! -e out.exr ]
}

@test "an image without lamp layers, or without light, is refused" {
  spectral a.exr
  layers_refused a.exr 'has no lamp layers'
  spectral b.exr --kind T
  layers_refused b.exr 'no bands of light'
  spectral c.exr --channel R --channel G --channel B
  layers_refused c.exr 'no bands of light'
  layers -o d.exr
  layers_refused d.exr 'has no lamp layers'
  layers --scene disc --grid 500:600:50 --compression none -o e.exr
  rename_channels S0 R0 e.exr f.exr
  layers_refused f.exr 'no bands of light'
  rename_channels 'S0[.]' T.0 e.exr f.exr
  layers_refused f.exr 'no bands of light'
}

@test "a gap in the lamps' numbers, and a lamp without a band or direction, are refused" {
  layers --scene disc --grid 500:600:50 --lamp 1,1,1 --lamp 1,2,1 --compression none -o a.exr
  rename_channels lamp2 lamp3 a.exr b.exr
  layers_refused b.exr lamp2
  rename_channels 'lamp2[.]S0.600' lamp2.T0.600 a.exr b.exr
  layers_refused b.exr "'lamp2' has no band at 600 nm"
  rename_channels 'lamp2[.]S0.600' lamp2.S0.601 a.exr b.exr
  layers_refused b.exr "'lamp2.S0.601,000000nm' is not at a band of S0"
  rename_channels 'lamp2[.]D' lamp2.E a.exr b.exr
  layers_refused b.exr "'lamp2' has no direction"
  rename_channels 'lamp2[.]D[.]Z' lamp2.D.z a.exr b.exr
  layers_refused b.exr "'lamp2.D' has not all of .X, .Y, .Z"
}

@test "a surface without what a disc needs is refused" {
  layers --scene disc --grid 500:500:1 --compression none -o a.exr
  rename_channels 'I[.]' J. a.exr b.exr
  layers_refused b.exr I.X
  rename_channels 'Tan[.]' Tam. a.exr b.exr
  layers_refused b.exr Tan.X
  [[ $stderr = *--centre* ]] || complain "$stderr"
  specdisc --centre 0,0,0 b.exr -o c.exr
  rename_channels 'P[.]' O. a.exr b.exr
  specdisc b.exr -o c.exr
  layers_refused b.exr P.X --centre 0,0,0
  rename_channels 'Ns[.]' Nt. a.exr b.exr
  specdisc --no-history b.exr -o d.exr
  specdiff c.exr d.exr || pixel_holds c.exr d.exr 5,4 'is("S0.500,000000nm", from["S0.500,000000nm"])'
  rename_channels 'N[.]' M. b.exr e.exr
  layers_refused e.exr Ns.X
  rename_channels id ie a.exr b.exr
  layers_refused b.exr 'no channel id' --mask 3
  disc_image f.exr --extra id
  layers_refused f.exr UINT --mask 3
  for vector in I N Ns P Q Tan; do
    rename_channels "${vector}[.]Z" "$vector.z" a.exr b.exr
    layers_refused b.exr "'$vector' has not all of .X, .Y, .Z"
  done
}

# Answers of the composite model

@test "a compact disc under a lamp" {
  layers --scene disc --size 30x20 --grid 400:700:10 --shape ramp -o a.exr
  specdisc a.exr -o b.exr
  for pixel in 17,5 19,6 21,8 11,9 15,14 22,10; do
    pixel_holds a.exr b.exr $pixel 'disc("cd"); adds(0); if (lit == 0) wrong("nothing to see")'
  done
  pixel_holds a.exr b.exr 17,5 'disc("cd"); adds(0); if (spikes == 0) wrong("no spike")'
  for pixel in 14,9 0,0; do
    pixel_holds a.exr b.exr $pixel 'for (name in to) if (to[name] != 0) wrong(name " is not 0")'
  done
}

@test "in the mirror direction there is the lamp's highlight" {
  layers --scene disc --size 30x20 --grid 400:700:50 -o a.exr
  # the lamp is put where the eye at 0,-0.25,0.25 sees its reflection in this pixel
  lamp=$(layers --print 15,14 a.exr | awk '/^P.X/ { x = $2 } /^P.Y/ { printf "%.9g,%.9g,0.25", 2 * x, 2 * $2 + 0.25 }')
  layers --scene disc --size 30x20 --grid 400:700:50 --lamp "$lamp" -o b.exr
  specdisc b.exr -o c.exr
  pixel_holds b.exr c.exr 15,14 'disc("cd"); adds(0); if (f[1] < 50) wrong("no highlight")'
  pixel_holds b.exr c.exr 16,14 'disc("cd"); adds(0); if (f[1] > 20) wrong("too wide")'
  specdisc --chart 'eye -30..30' --angle 30 --size 3x1 --grid 500:500:1 -o d.exr
  pixel_holds d.exr d.exr 0,0 'disc("cd"); charted(-30, 30, 0, 0); if (f[1] < 50) wrong("no highlight")'
}

@test "presets, and distances in place of theirs" {
  layers --scene disc --size 30x20 --grid 400:700:10 -o a.exr
  for kind in dvd bluray vinyl; do
    specdisc --preset $kind a.exr -o b.exr
    for pixel in 11,9 15,14; do
      pixel_holds a.exr b.exr $pixel 'disc("'$kind'"); adds(0); if (lit == 0) wrong("nothing to see")'
    done
  done
  specdisc --track 1um --pit 3000 a.exr -o b.exr
  pixel_holds a.exr b.exr 15,14 'disc("cd"); track = 1000; pit = 3000; adds(0)'
  specdisc --pit 0.9um --preset dvd a.exr -o b.exr
  pixel_holds a.exr b.exr 15,14 'disc("dvd"); pit = 900; adds(0)'
}

@test "a record is grey: the colour of its lamp" {
  layers --scene disc --size 30x20 --grid 400:700:50 --shape ramp -o a.exr
  specdisc --preset vinyl a.exr -o b.exr
  pixel_holds a.exr b.exr 15,14 '
    look(1)
    for (l = 400; l <= 700; l += 50) {
      n = "S0." l ",000000nm"
      if (!(to[n] > 0)) wrong("nothing to see")
      is(n, 0.04 * exp(-10 * u * u) * lit * from["lamp1." n])
    }'
}

@test "bins take the spikes that lie in them, and a sole band takes none" {
  layers --scene disc --size 30x20 --grid 400:700:10 --bins -o a.exr
  specdisc a.exr -o b.exr
  for pixel in 17,5 19,7; do
    pixel_holds a.exr b.exr $pixel '
      for (j = 0; j <= 31; j++) edge[j] = 395 + 10 * j
      disc("cd"); adds(0); if (spikes == 0) wrong("no spike")'
  done
  layers --scene disc --size 30x20 --grid 550:550:1 -o c.exr
  specdisc c.exr -o d.exr
  pixel_holds c.exr d.exr 17,5 'disc("cd"); adds(0); if (spikes != 0) wrong("a spike")'
}

@test "two lamps are the sum of both, and one behind the disc is nothing" {
  layers --scene disc --size 30x20 --grid 400:700:50 --lamp 0.1,0.2,0.4 -o one.exr
  layers --scene disc --size 30x20 --grid 400:700:50 --lamp -0.3,0,0.1,5 -o two.exr
  layers --scene disc --size 30x20 --grid 400:700:50 --lamp 0.1,0.2,0.4 --lamp -0.3,0,0.1,5 -o both.exr
  layers --scene disc --size 30x20 --grid 400:700:50 --lamp 0.1,0.2,-0.4 -o behind.exr
  for file in one two both behind; do
    specdisc $file.exr -o $file.out.exr
  done
  for pixel in 11,9 15,14 19,7; do
    pixel_holds both.exr both.out.exr $pixel 'disc("cd"); adds(0)'
    "$TESTS/layers" --print $pixel two.out.exr | grep ^S0 >two
    pixel_holds one.out.exr both.out.exr $pixel '
      while ((getline line <"two") > 0) { split(line, part, " "); is(part[1], from[part[1]] + part[2]) }'
    pixel_holds behind.exr behind.out.exr $pixel '
      for (name in to) if (name ~ /^S0/ && to[name] != 0) wrong(name)'
  done
}

# negated FROM TO CHANNEL...: an uncompressed image of one pixel, FLOAT alone, with minus these.
negated() {
  local to=$2 channel at
  cp "$1" "$to"
  shift 2
  for channel; do
    at=$(($(sample_at "$to" "$channel" 0 1) + 3))
    poke "$to" $at "$(little 1 $(($(od -An -v -tu1 -j $at -N 1 "$to") ^ 128)))"
  done
}

@test "what is behind the surface, lamp or eye, gives nothing" {
  disc_image a.exr --size 1x1 --compression none
  specdisc a.exr -o b.exr
  pixel_holds a.exr b.exr 0,0 '
    from["S0.500,000000nm"] = from["S0.500nm"]; from["lamp1.S0.500,000000nm"] = from["lamp1.S0.500nm"]
    disc("cd"); adds(0); if (lit == 0) wrong("nothing to see")'
  for vector in lamp1.D I N; do
    negated a.exr c.exr $vector.X $vector.Y $vector.Z
    specdisc c.exr -o d.exr
    pixel_holds c.exr d.exr 0,0 'is("S0.500,000000nm", from["S0.500nm"])'
  done
  # with both behind, and the normal with them, it is the same as before
  negated a.exr c.exr lamp1.D.X lamp1.D.Y lamp1.D.Z I.X I.Y I.Z N.X N.Y N.Z
  specdisc c.exr -o d.exr
  pixel_holds b.exr d.exr 0,0 'is("S0.500,000000nm", from["S0.500,000000nm"])'
  # and the way along the track does not matter
  negated a.exr c.exr Tan.X Tan.Y Tan.Z
  specdisc c.exr -o d.exr
  pixel_holds b.exr d.exr 0,0 'is("S0.500,000000nm", from["S0.500,000000nm"])'
}

@test "where the disc does not cover, nothing is added, whatever the lamp's light" {
  disc_image a.exr --channel cover --uint-id --compression none --size 2x1
  poke a.exr "$(sample_at a.exr cover 1 2)" '\0\0\0\0'
  specdisc a.exr -o b.exr
  pixel_holds a.exr b.exr 0,0 'if (to["S0.500,000000nm"] == from["S0.500nm"]) wrong("nothing")'
  pixel_holds a.exr b.exr 1,0 'is("S0.500,000000nm", from["S0.500nm"])'
  # and it is no surface that a disc is missing for
  specdisc --mask 7 a.exr -o c.exr 2>said
  [ "$(cat said)" = 'specdisc: warning: no disc is for the id of 1 pixel: left out' ] || complain "$(cat said)"
}

@test "the normal is Ns, and N where there is none" {
  disc_image n.exr --size 1x1
  disc_image ns.exr --size 1x1 --channel Ns.Z --channel Ns.X --channel Ns.Y
  for file in n ns; do
    specdisc --preset vinyl $file.exr -o out.exr
    pixel_holds $file.exr out.exr 0,0 '
      disc("vinyl"); look(1)
      is("S0.500,000000nm", from["S0.500nm"] + 0.04 * exp(-10 * u * u) * lit * from["lamp1.S0.500nm"])'
  done
}

@test "vectors that are 0 or not finite give nothing" {
  disc_image a.exr --size 2x1 --pattern constant:0
  specdisc a.exr -o b.exr
  pixel_holds a.exr b.exr 1,0 'is("S0.500,000000nm", 0)'
  for pattern in nan:1,0,4 inf:1,0,2 nan:1,0,5 nan:1,0,3; do
    disc_image a.exr --size 2x1 --pattern $pattern
    specdisc a.exr -o b.exr
    pixel_holds a.exr b.exr 1,0 'is("S0.500,000000nm", from["S0.500nm"])'
    pixel_holds a.exr b.exr 0,0 'if (to["S0.500,000000nm"] == from["S0.500nm"]) wrong("nothing")'
  done
}

@test "light that is not finite stays in its pixel" {
  for pattern in nan:1,0,1 inf:1,0,1 nan:1,0,0; do
    disc_image a.exr --size 3x1 --pattern $pattern
    disc_image want.exr --size 3x1
    specdisc a.exr -o b.exr
    specdisc want.exr -o c.exr
    for x in 0 2; do
      pixel_holds c.exr b.exr $x,0 'is("S0.500,000000nm", from["S0.500,000000nm"])'
    done
    layers --print 1,0 b.exr | grep -qE '^S0.500,000000nm (nan|-nan|inf)'
  done
}

@test "tracks around a centre are those of Tan; the axis may look up or down" {
  layers --scene disc --size 30x20 --grid 400:700:10 -o a.exr
  specdisc a.exr -o want.exr
  for around in '--centre 0,0,0' '--centre 0,0,0 --axis 0,0,1' '--centre 0,0,0 --axis 0,0,-3.5' \
    '--centre=-0,0,7 --axis 0,0,1e-3' '--centre 0,0,0 --axis 0,0,1e-300' '--centre 0,0,0 --axis 0,0,1e9'; do
    # shellcheck disable=SC2086 # words
    specdisc $around a.exr -o b.exr
    for pixel in 11,9 15,14 19,7 14,9; do
      pixel_holds want.exr b.exr $pixel 'for (name in from) is(name, from[name], 1e-4)'
    done
  done
}

@test "tracks around any axis" {
  layers --scene disc --size 30x20 --grid 550:550:1 -o a.exr
  specdisc --preset vinyl --centre 0.1,-0.03,0.02 --axis 0.5,-0.25,2 a.exr -o b.exr
  for pixel in 11,9 15,14 19,7; do
    pixel_holds a.exr b.exr $pixel '
      circle(1, 0.1, -0.03, 0.02, 0.5, -0.25, 2)
      is("S0.550,000000nm", 0.04 * exp(-10 * u * u) * lit * from["lamp1.S0.550,000000nm"])'
  done
}

@test "what S0 held before is added to" {
  layers --scene noise --lamps 2 --grid 400:700:50 -o a.exr
  specdisc a.exr -o b.exr
  pixel_holds a.exr b.exr 13,5 '
    if (from["S0.500,000000nm"] <= 0) wrong("S0 was nothing")
    disc("cd"); adds(0)'
}

@test "at the disc's rim the light of its lamps is premultiplied already" {
  layers --scene disc --size 7x7 --samples 3 --grid 550:550:1 -o a.exr
  specdisc --preset vinyl a.exr -o b.exr
  pixel_holds a.exr b.exr 1,2 '
    cover = from["cover"]
    if (cover <= 0 || cover >= 1) wrong("cover is " cover)
    disc("vinyl"); adds(0)'
}

# Several discs

@test "each id has its disc, and one without is for the others" {
  disc_image a.exr --uint-id --size 3x1
  specdisc --preset vinyl a.exr -o vinyl.exr
  specdisc --track 2um --pit 5um --preset dvd a.exr -o dvd.exr
  specdisc --preset vinyl --preset dvd --track 2um --pit 5um --mask 1 a.exr -o b.exr 2>said
  [ ! -s said ]
  pixel_holds vinyl.exr b.exr 0,0 'is("S0.500,000000nm", from["S0.500,000000nm"])'
  pixel_holds dvd.exr b.exr 1,0 'is("S0.500,000000nm", from["S0.500,000000nm"])'
  pixel_holds vinyl.exr b.exr 2,0 'is("S0.500,000000nm", from["S0.500,000000nm"])'
}

@test "a surface without a disc stays, and is told" {
  disc_image a.exr --uint-id --size 3x1
  specdisc --mask 1 a.exr -o b.exr 2>said
  [ "$(cat said)" = 'specdisc: warning: no disc is for the id of 2 pixels: left out' ] || complain "$(cat said)"
  pixel_holds a.exr b.exr 0,0 'is("S0.500,000000nm", from["S0.500nm"])'
  pixel_holds a.exr b.exr 1,0 'if (to["S0.500,000000nm"] == from["S0.500nm"]) wrong("nothing")'
  specdisc -q --mask 1 a.exr -o c.exr 2>said
  [ ! -s said ]
  specdiff b.exr c.exr
}

# The model of orders

@test "--model orders at one wavelength, and over bands" {
  layers --scene disc --eye 0,0,0.5 --lamp 0,0.5,0.5 --size 31x31 --grid 550:550:1 -o a.exr
  specdisc --model orders --spread 4 a.exr -o b.exr
  for pixel in 15,5 15,24 17,6; do
    pixel_holds a.exr b.exr $pixel 'disc("cd"); adds(4); if (to["S0.550,000000nm"] < 1e-6) wrong("nothing to see")'
  done
  for bins in '' --bins; do
    layers --scene disc --eye 0,0,0.5 --lamp 0,0.5,0.5 --size 31x31 --grid 400:700:50 $bins -o a.exr
    specdisc --model orders --spread 0.05rad a.exr -o b.exr
    specdisc --model orders a.exr -o c.exr
    for pixel in 15,5 15,24; do
      pixel_holds a.exr b.exr $pixel 'disc("cd"); adds(0.05 * 180 / pi)'
      pixel_holds a.exr c.exr $pixel 'disc("cd"); adds(0.5)'
    done
  done
}

@test "presets and distances of the model of orders" {
  layers --scene disc --eye 0,0,0.5 --lamp 0,0.2,0.5 --size 31x31 --grid 450:650:100 -o a.exr
  for kind in dvd bluray; do
    specdisc --model orders --spread 9 --preset $kind a.exr -o b.exr
    pixel_holds a.exr b.exr 15,5 'disc("'$kind'"); adds(9)'
  done
  # pits wider than the track keep their share of it
  specdisc --model orders --spread 9 --track 500nm a.exr -o b.exr
  pixel_holds a.exr b.exr 15,5 'disc("cd"); track = 500; wide = 600 * 500 / 1600; adds(9)'
  specdisc --model orders --spread 9 --track 2um a.exr -o b.exr
  pixel_holds a.exr b.exr 15,5 'disc("cd"); track = 2000; adds(9)'
}

@test "a record is a plain mirror to the model of orders" {
  specdisc --model orders --preset vinyl --chart 'eye -40..40' --angle 20 --spread 2 --size 5x1 --grid 500:600:100 -o a.exr
  pixel_holds a.exr a.exr 1,0 'is("T.500,000000nm", pi / (2 * pi * (pi / 90) ^ 2)); is("T.600,000000nm", to["T.500,000000nm"])'
  pixel_holds a.exr a.exr 4,0 'is("T.500,000000nm", 0)'
}

@test "light appears at the wavelength that the grating equation has" {
  # the column x = 0, where lamp, eye and track are at right angles: u is 0
  layers --scene disc --eye 0,0,0.5 --lamp 0,0.5,0.5 --size 31x31 --grid 400:700:1 -o a.exr
  specdisc --model orders --spread 0.1 a.exr -o b.exr
  for y in 4 6 8 22 24 26; do
    pixel_holds a.exr b.exr 15,$y '
      look(1)
      if (size(u) > 1e-6) wrong("u is " u)
      for (name in to) if (name ~ /^S0/ && to[name] > most) { most = to[name]; l = wavelength(name) }
      m = 1600 * size(v) / l
      if (!most || size(m - int(m + 0.5)) > 0.006) wrong("the brightest is " l " nm, order " m)'
  done
}

@test "the orders take no more light than there is" {
  # over all directions in the plane across the tracks: the lobe at u = 0 times their sum
  specdisc --model orders --spread 2 --chart 'eye -90..90' --size 361x1 --grid 600:600:1 -o a.exr
  specconvert a.exr -f spd | grep -v '^#' | awk "$statements$functions"'
    { for (j = 2; j <= NF; j++) sum += $j / pi * cos((j - 182) / 2 * pi / 180) * pi / 360 }
    END {
      disc("cd"); want = efficiency(0, 600) + 2 * efficiency(1, 600) + 2 * efficiency(2, 600)
      if (want >= 1) wrong("sum of the efficiencies: " want)
      if (!near(sum, want * bell(0, 2 * pi / 180), 1e-4)) wrong(sum / bell(0, 2 * pi / 180) " instead of " want)
      exit failed
    }'
}

# --orders

@test "--orders at 532 nm: three orders to each side, at 19.42, 41.68 and 85.95 degrees" {
  specdisc --orders --grid 532:532:1 >table
  head -n 1 table | grep -qx '# order nm angle azimuth efficiency'
  grep -v '^#' table | awk '{ printf "%d %d %.2f %d\n", $1, $2, $3, $4 }' >found
  printf '%s\n' '-3 532 85.95 180' '-2 532 41.68 180' '-1 532 19.42 180' '0 532 0.00 0' '1 532 19.42 0' \
    '2 532 41.68 0' '3 532 85.95 0' | cmp - found || complain "$(cat found)"
  specdisc --orders --grid 532:532:1 -o file
  cmp table file
}

@test "--orders at 534 nm has none above 2, and a Blu-ray disc none but the mirror's" {
  [ "$(specdisc --orders --grid 534:534:1 | awk '!/^#/ { print $1 }' | xargs)" = '-2 -1 0 1 2' ]
  [ "$(specdisc --orders --preset bluray --grid 380:780:20 | awk '!/^#/ { print $1 }' | sort -u)" = 0 ]
  [ "$(specdisc --orders --preset bluray --angle 60 --grid 400:400:1 | awk '!/^#/ { print $1 }' | xargs)" = '0 1' ]
}

@test "--orders keeps what lies along the tracks, and moves what lies across by whole steps" {
  for angle in 0 30 60 89; do
    for azimuth in 0 90 -90 180 35 -120; do
      specdisc --orders --preset dvd --angle $angle --azimuth $azimuth --grid 400:700:100 >table
      awk "$statements$functions"'
        /^#/ { next }
        {
          t = $3 * pi / 180; a = $4 * pi / 180; ti = '$angle' * pi / 180; ai = '$azimuth' * pi / 180
          x = sin(t) * sin(a) + sin(ti) * sin(ai); y = sin(t) * cos(a) + sin(ti) * cos(ai)
          if (size(x) > 1e-8 || size(y - $1 * $2 / 740) > 1e-8) wrong($0 ": " x " " y)
          disc("dvd")
          if (!near($5, efficiency($1, $2), 1e-8)) wrong($0 ": " efficiency($1, $2))
          # the next order, if there is none here, does not exist
          seen[$1 " " $2] = 1
        }
        END {
          for (l = 400; l <= 700; l += 100) for (m = -4; m <= 4; m++) {
            x = -sin(ti) * sin(ai); y = m * l / 740 - sin(ti) * cos(ai)
            if ((x * x + y * y < 0.999999) != (m " " l in seen)) wrong("order " m " of " l)
          }
          exit failed
        }' table >said || complain "$angle, $azimuth:" "$(cat said)"
    done
  done
}

@test "--orders has the lamp's mirror direction as order 0" {
  specdisc --orders --angle 30 --azimuth 90 --grid 550:550:1 |
    awk '$1 == 0 { right = $3 > 29.9999 && $3 < 30.0001 && $4 == -90 } END { exit !right }'
  specdisc --orders --angle 0.5rad --grid 550:550:1 |
    awk '$1 == 0 { right = $3 > 28.6478 && $3 < 28.648 && $4 == 180 } END { exit !right }'
}

@test "--orders takes --track and grids" {
  [ "$(specdisc --orders --grid 500.12345:500.12345:1 | awk '$1 == 0 { print $2 }')" = 500.12345 ]
  [ "$(specdisc --orders --track 1mm --grid 500:500:1 | grep -vc '^#')" -eq 4001 ]
  [ "$(specdisc --orders --preset bluray | grep -vc '^#')" -eq 81 ]
}

# --chart

@test "--chart is an image of the reflectance factor" {
  specdisc --chart 'eye -80..80' --grid 500:600:50 --size 7x3 -o a.exr
  has_channels a.exr T.500,000000nm T.550,000000nm T.600,000000nm
  exrheader a.exr >header
  grep -qx 'dataWindow (type box2i): (0 0) - (6 2)' header
  grep -qx 'displayWindow (type box2i): (0 0) - (6 2)' header
  grep -qx 'spec:quantity (type string): "reflectance factor"' header
  specdisc --chart 'eye 0..9' --half --size 2x2 -o b.exr
  [ "$(exrheader b.exr | grep -c '^    T.*16-bit')" -eq 81 ]
  specdisc --chart 'eye 0..9' --grid 500:500:1 -o c.exr
  exrheader c.exr | grep -qx 'dataWindow (type box2i): (0 0) - (479 269)'
}

# charted_at FILE X,Y ANGLE LAMP AZIMUTH SPREAD [PRESET]: that pixel of a chart is the model's.
charted_at() {
  pixel_holds "$1" "$1" "$2" 'disc("'"${7-cd}"'"); charted('"$3, $4, $5, $6"')'
}

@test "--chart holds the model at both ends of both axes and between" {
  for spread in 0 8; do
    model=(--model orders --spread 8)
    [ $spread != 0 ] || model=()
    specdisc "${model[@]}" --chart 'eye -60..60deg, lamp 0..50' --grid 400:700:20 --size 5x3 -o a.exr
    charted_at a.exr 0,0 -60 0 0 $spread
    charted_at a.exr 4,0 60 0 0 $spread
    charted_at a.exr 0,2 -60 50 0 $spread
    charted_at a.exr 4,2 60 50 0 $spread
    charted_at a.exr 3,1 30 25 0 $spread
    specdisc "${model[@]}" --preset dvd --chart 'lamp 50..-50,azimuth -180..0.2rad' --grid 400:700:20 --size 3x2 -o b.exr
    charted_at b.exr 0,0 0 50 -180 $spread dvd
    charted_at b.exr 2,1 0 -50 11.4591559026164642 $spread dvd
  done
}

@test "--chart over one axis, with --angle the lamp's and --azimuth both's" {
  specdisc --chart 'eye 0..80' --angle 20 --azimuth 5 --grid 400:700:20 --size 5x2 -o a.exr
  specdisc --chart 'azimuth -10..10' --angle 40 --grid 400:700:20 --size 5x2 -o b.exr
  for y in 0 1; do
    charted_at a.exr 1,$y 20 20 5 0
    charted_at a.exr 4,$y 80 20 5 0
    charted_at b.exr 0,$y 0 40 -10 0
    charted_at b.exr 3,$y 0 40 5 0
  done
  specdisc --chart 'lamp -20..20' --eye -35deg --azimuth -2 --grid 400:700:20 --size 5x2 -o c.exr
  charted_at c.exr 1,1 -35 -10 -2 0
  specdisc --chart 'eye 20..60' --size 1x1 --grid 400:700:20 -o d.exr
  charted_at d.exr 0,0 20 0 0 0
}

@test "--chart is the same when lamp and eye change places" {
  specdisc --chart 'eye -60..60, lamp -60..60' --grid 400:700:20 --size 7x7 -o a.exr
  specdisc --chart 'lamp -60..60, eye -60..60' --grid 400:700:20 --size 7x7 -o b.exr
  specdiff a.exr b.exr
}
