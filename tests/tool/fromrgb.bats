#!/usr/bin/env bats
# specconvert --from-rgb: spectra of pictures and of single colours.

load common

# colours FILE [ARGUMENT...]: an image of three colours, all kinds of samples in [0, 1.6).
colours() {
  spectral "$1" --size 16x8 --channel R --channel G --channel B --pattern noise "${@:2}"
}

# Reflectances as a picture has them: a card of measured ones, and black and white.
card() {
  specconvert -g 380:780:5 --patch 4 --patches 7x4 -o card.exr colorchecker/{01-dark-skin,02-light-skin,03-blue-sky,04-foliage,05-blue-flower,06-bluish-green,07-orange,08-purplish-blue,09-moderate-red,10-purple,11-yellow-green,12-orange-yellow,13-blue,14-green,15-red,16-yellow,17-magenta,19-white,20-neutral-8,21-neutral-6.5,22-neutral-5,23-neutral-3.5,24-black}
  spec2rgb card.exr -o rgb.exr
}

# largest_off A B: the largest difference of a channel R, G or B, at the middle of each patch.
largest_off() {
  local x y
  for x in 1 5 9 13 17 21 25; do
    for y in 1 5 9 13; do
      paste -d ' ' <("$TESTS/layers" --print $x,$y "$1") <("$TESTS/layers" --print $x,$y "$2")
    done
  done | awk '{ off = $2 - $4; if (off < 0) off = -off; if (off > most) most = off } END { print most }'
}

@test "a picture becomes bands that are the picture again" {
  local off model
  card
  for model in sigmoid basis smits; do
    specconvert --from-rgb $model rgb.exr -o spectra.exr
    spec2rgb spectra.exr -o back.exr
    off=$(largest_off rgb.exr back.exr)
    # Smits' own white is equal energy; with sanitizers the table of sigmoids is coarser.
    awk -v off="$off" -v most="$(case $model in smits) echo .06 ;; sigmoid) echo .005 ;; *) echo .002 ;; esac)" \
      'BEGIN { exit !(off > 0 && off < most) }' || complain "$model: off by $off"
  done
  for model in sigmoid basis sun; do
    specconvert --from-rgb $model --as light rgb.exr -o light.exr
    spec2rgb light.exr -o back.exr
    off=$(largest_off rgb.exr back.exr)
    # A part of Sun's widest Gaussians is beyond 780 nm.
    awk -v off="$off" -v most="$(case $model in sun) echo .01 ;; sigmoid) echo .005 ;; *) echo .002 ;; esac)" \
      'BEGIN { exit !(off > 0 && off < most) }' || complain "$model: off by $off"
  done
}

@test "the header says what the bands are, and all else passes through" {
  colours rgb.exr --extra A --extra depth.Z --uint id --attribute owner=me
  specconvert -q --from-rgb basis -g 400:700:100 rgb.exr -o t.exr
  has_channels t.exr A T.400,000000nm T.500,000000nm T.600,000000nm T.700,000000nm depth.Z id
  exrheader t.exr | grep -A 1 'spec:quantity' | grep -q '"reflectance"'
  exrheader t.exr | grep -q '"350 450 550 650 750"'
  exrheader t.exr | grep -q '"me"'
  pixel_holds rgb.exr t.exr 3,5 'is("A", from["A"], 0); is("depth.Z", from["depth.Z"], 0); is("id", from["id"], 0)'
  specconvert -q --from-rgb basis --as light -g 400:700:100 rgb.exr -o s0.exr
  has_channels s0.exr A S0.400,000000nm S0.500,000000nm S0.600,000000nm S0.700,000000nm depth.Z id
  exrheader s0.exr | grep -q 'radiance per nm'
  exrheader s0.exr | grep -q emissiveUnits
  specconvert -q --from-rgb basis --as unbounded -g 400:700:100 rgb.exr -o u.exr
  exrheader u.exr | grep -q '"factor"'
}

@test "the usual grid, and samples as the picture has them" {
  colours rgb.exr
  specconvert -q --from-rgb sigmoid rgb.exr -o t.exr
  [ "$(channels t.exr | grep -c '^T[.]')" -eq 81 ]
  [ "$(channels t.exr | head -n 1)" = T.380,000000nm ]
  [ "$(exrheader t.exr | grep -c '16-bit')" -eq 0 ]
  specconvert -q --half --from-rgb sigmoid rgb.exr -o half.exr
  [ "$(exrheader half.exr | grep -c 'T.*16-bit')" -eq 81 ]
  oiiotool rgb.exr -d half -o sixteen.exr
  specconvert -q --from-rgb basis sixteen.exr -o half.exr
  [ "$(exrheader half.exr | grep -c 'T.*16-bit')" -eq 81 ]
}

@test "the same bits for every number of threads, and through a pipe" {
  local model
  colours rgb.exr --size 300x40
  for model in smits basis sigmoid sun; do
    specconvert -q --no-history -j 1 --as light --from-rgb $model rgb.exr -o one.exr
    specconvert -q --no-history -j 4 --as light --from-rgb $model rgb.exr -o four.exr
    cmp one.exr four.exr
  done
  specconvert -q --no-history --from-rgb smits rgb.exr -o file.exr --compression none
  specconvert -q --no-history --from-rgb smits <rgb.exr | cat >pipe.exr
  cmp file.exr pipe.exr
}

@test "pictures of whole numbers are encoded as sRGB has it" {
  printf 'P3 2 1 255 128 128 128 255 255 255' >grey.ppm
  specconvert --from-rgb sigmoid -g 400:700:100 grey.ppm -o ppm.exr
  pixel_holds ppm.exr ppm.exr 0,0 'is("T.400,000000nm", 0.21586050, 1e-6); is("T.700,000000nm", 0.21586050, 1e-6)'
  pixel_holds ppm.exr ppm.exr 1,0 'is("T.600,000000nm", 1, 1e-7)'
  spec2rgb ppm.exr -o grey.png
  specconvert --from-rgb sigmoid -g 400:700:100 grey.png -o png.exr
  pixel_holds ppm.exr png.exr 0,0 'is("T.500,000000nm", from["T.500,000000nm"], 0.01)'
}

@test "what is out of range is clamped, and told once" {
  colours rgb.exr --pattern constant:1.5
  specconvert --from-rgb sigmoid -g 400:700:100 rgb.exr -o t.exr 2>said
  [ "$(cat said)" = 'specconvert: warning: 128 pixels had a component outside [0, 1], which was clamped' ]
  pixel_holds rgb.exr t.exr 1,1 'is("T.500,000000nm", 1, 1e-12)'
  specconvert -q --from-rgb sigmoid -g 400:700:100 rgb.exr -o t.exr 2>said
  [ ! -s said ]
  specconvert --from-rgb sigmoid --as unbounded -g 400:700:100 rgb.exr -o u.exr 2>said
  [ ! -s said ]
  pixel_holds rgb.exr u.exr 1,1 'is("T.500,000000nm", 1.5, 1e-6)'
  colours dark.exr --pattern constant:-1
  specconvert --from-rgb basis --as light -g 400:700:100 dark.exr -o u.exr 2>said
  [[ $(cat said) = *'128 pixels had a component outside the range from 0 on'* ]]
  pixel_holds dark.exr u.exr 1,1 'is("S0.500,000000nm", 0, 0)'
}

@test "pictures that are none" {
  spectral scene.exr
  fails_cleanly specconvert --from-rgb smits scene.exr -o x.exr
  [[ $stderr = *'scene.exr: is spectral already' ]]
  spectral two.exr --channel R --channel B
  fails_cleanly specconvert --from-rgb smits two.exr -o x.exr
  [[ $stderr = *'two.exr: has no channel G' ]]
  spectral whole.exr --channel R --channel G --uint B
  fails_cleanly specconvert --from-rgb smits whole.exr -o x.exr
  [[ $stderr = *'whole.exr: its channel B holds whole numbers' ]]
  colours rgb.exr --compression none
  head -c 1200 rgb.exr >short.exr
  fails_cleanly specconvert -q --from-rgb smits short.exr -o x.exr
  [[ $stderr = *'ends early'* ]]
  fails_cleanly specconvert --from-rgb smits missing.exr -o x.exr
  no_leftovers . scene.exr two.exr whole.exr rgb.exr short.exr
}

@test "pictures of other primaries are refused" {
  card
  specconvert -q --from-rgb basis rgb.exr -o t.exr
  # 0.31 in place of green's 0.3: within the byte order of the format.
  poke rgb.exr $(($(attribute_at rgb.exr chromaticities chromaticities) + 8)) '\x52\xb8\x9e\x3e'
  fails_cleanly specconvert --from-rgb basis rgb.exr -o x.exr
  [[ $stderr = *'rgb.exr: its primaries or its white are not those of Rec. 709 (green x is 0.31 instead of 0.3)' ]]
  # What files round to three digits is Rec. 709 still; of spectra the attribute says nothing.
  exrstdattr -chromaticities 0.64 0.33 0.3009 0.6 0.15 0.06 0.3127 0.329 rgb.exr near.exr
  specconvert -q --from-rgb basis near.exr -o t.exr
  run ! grep chromaticities <<<"$(exrheader t.exr)"
  exrstdattr -chromaticities 0.64 0.33 0.3011 0.6 0.15 0.06 0.3127 0.329 rgb.exr far.exr
  fails_cleanly specconvert -q --from-rgb basis far.exr -o x.exr
}

@test "options that do not go together" {
  colours rgb.exr
  fails_cleanly specconvert --from-rgb smit rgb.exr
  [[ $stderr = *"unknown model 'smit' (smits sun sigmoid basis)"* ]]
  fails_cleanly specconvert --from-rgb smits --as albedo rgb.exr
  [[ $stderr = *"unknown use 'albedo' (reflectance unbounded light)"* ]]
  fails_cleanly specconvert --as light rgb.exr
  fails_cleanly specconvert --from-rgb sun --as reflectance rgb.exr
  [[ $stderr = *"Sun's spectra are no reflectances"* ]]
  fails_cleanly specconvert --from-rgb smits --crop 0,0,1,1 rgb.exr
  [[ $stderr = *'make the spectra first'* ]]
  fails_cleanly specconvert --from-rgb smits -b 500 rgb.exr
  fails_cleanly specconvert --from-rgb smits -m D65 rgb.exr
  fails_cleanly specconvert --from-rgb smits -f spd rgb.exr
  fails_cleanly specconvert --from-rgb smits D65
  [[ $stderr = *"not for the curve 'D65'"* ]]
  fails_cleanly specconvert --from-rgb basis --as light -g 800:900:10 rgb.exr
  [[ $stderr = *300..830* ]]
  specconvert -q --from-rgb basis --as light -g 800:900:10 --extrapolate zero rgb.exr -o x.exr
}

@test "without its table the tool says so" {
  colours rgb.exr
  mkdir bin
  cp "$BIN/specconvert" bin/
  SPECTRA_PATH=$ROOT/spectra fails_cleanly bin/specconvert --from-rgb sigmoid rgb.exr -o x.exr
  [[ $stderr = *'unable to open '*srgb.sigmoids* ]]
  SPECTRA_PATH=$ROOT/spectra bin/specconvert -q --from-rgb smits rgb.exr -o x.exr
}

@test "the spectrum of a colour" {
  # Mallett and Yuksel's table: red is its first column.
  [ "$(specconvert --from-rgb basis 'rgb:1,0,0' | grep '^[0-9]')" = \
    "$(specconvert mallett-yuksel | grep '^[0-9]' | cut -d ' ' -f 1,2)" ]
  # The three of white, added up.
  specconvert --from-rgb basis -g 400:700:100 '#ffffff' | awk '/^[0-9]/ { n++; if ($2 < .9999 || $2 > 1) exit 1 } END { exit n != 4 }'
  # Greys of sigmoids are level: 0.5 decoded.
  specconvert --from-rgb sigmoid '#808080' | awk '/^[0-9]/ { n++; off = $2 - 0.21586050; if (off * off > 1e-14) exit 1 } END { exit n != 81 }'
  # Smits' steps as means: 412.5 nm to 417.5 nm spans two of them.
  specconvert --from-rgb smits 'rgb:0,0,1' -g 400:420:5 | grep -q '^405 1$'
  # From 465 to 485 nm 16.5 of 20 nm are .0273, 3.5 are .7937.
  specconvert --from-rgb smits 'rgb:0,1,0' -g 455:515:20 |
    awk '$1 == 475 { n++; off = $2 - .16142; if (off * off > 1e-24) exit 1 } END { exit n != 1 }'
  [ "$(specconvert --from-rgb smits '#102030' | head -n 2 | tail -n 1)" = '# quantity: reflectance' ]
  [ "$(specconvert --from-rgb sun '#102030' | sed -n 's/# quantity: //p')" = 'spectral power distribution' ]
  [ "$(specconvert --from-rgb basis --as unbounded 'rgb:3,3,3' | sed -n 's/# quantity: //p')" = factor ]
}

@test "white light is D65, which spec2rgb shows as 1" {
  for model in sigmoid basis smits sun; do
    specconvert --from-rgb $model --as light rgb:1,1,1 -o white.exr
    has_line white.exr 'emissiveUnits (type string): "W.m^-2.sr^-1"'
    spec2rgb white.exr -o shown.exr
    # Smits' white is 0.9992 where it is least.
    pixel_holds shown.exr shown.exr 0,0 'is("R", 1, 1e-3); is("G", 1, 1e-3); is("B", 1, 1e-3)'
  done
}

@test "colours become a chart, and take part in what curves take part in" {
  specconvert --from-rgb sigmoid --patch 2 '#ff0000' '#00ff00' '#0000ff' -o chart.exr
  spec2rgb chart.exr -f ppm | tail -n +4 | head -c 18 | od -A n -v -w3 -t u1 | awk '
    { for (i = 1; i <= 3; i++) if (i == int((NR + 1) / 2) ? $i < 253 : $i > 4) exit 1 }
    END { if (NR != 6) exit 1 }'
  specconvert --from-rgb basis -m D65 -s 2 -g 400:700:100 '#ff8000' | grep -q '^600 '
}

@test "colours that are none" {
  local name
  for name in '#12' '#gg0000' '#1234567' 'rgb:1,2' 'rgb:1,1,1,1' 'rgb:1,,1' 'rgb:' 'rgb:nan,0,0' 'rgb:-1,0,0'; do
    fails_cleanly specconvert --from-rgb smits --as unbounded "$name"
  done
  fails_cleanly specconvert --from-rgb smits 'rgb:1.5,0,0'
  [[ $stderr = *'a component of the colour is 1.5, not in [0, 1]' ]]
  fails_cleanly specconvert '#ff8000'
}

@test "one colour in every model has one spectrum" {
  local text
  # #ff8000 is 128 / 255 of green, cornflower blue #6495ed.
  specconvert --from-rgb basis '#ff8000' >code
  for text in hsv:30.11764705882353,1,1 hsl:30.11764705882353,1,.5 cmyk:0,.498039215686274,1,0; do
    specconvert --from-rgb basis "$text" >model
    paste -d ' ' <(grep '^[0-9]' code) <(grep '^[0-9]' model) |
      awk '{ off = $2 - $4; if (off * off > 1e-24) exit 1 } END { exit NR != 81 }' || complain "$text:" "$(head -n 1 model)"
  done
  # Of television's red, rounded to three digits, no component is left outside.
  [ "$(specconvert --from-rgb basis yuv:.299,-.147,.615 | sed -n 's/# title: RGB 1 \([0-9.e-]*\) \([0-9.e-]*\)$/\1 \2/p' |
    awk '{ print ($1 >= 0 && $1 < 1e-3 && $2 >= 0 && $2 < 1e-3) }')" = 1 ]
  specconvert --from-rgb basis --as light 'hsv:218.54,.578,.929' | grep -q '^# title: RGB 0.12.* 0.30.* 0.84'
}

@test "colours of models that are none" {
  fails_cleanly specconvert --from-rgb basis hsv:1,2
  [[ $stderr = *"'hsv:1,2' is no colour hsv:H,S,V" ]]
  fails_cleanly specconvert --from-rgb basis cmyk:0,0,0
  [[ $stderr = *"'cmyk:0,0,0' is no colour cmyk:C,M,Y,K" ]]
  fails_cleanly specconvert --from-rgb basis hsl:361,1,1
  [[ $stderr = *"outside 0..360: '361'" ]]
  fails_cleanly specconvert --from-rgb basis hsl:1,1,1,1
  fails_cleanly specconvert --from-rgb basis hsv:30,50%,1
  fails_cleanly specconvert --from-rgb basis hsv:nan,1,1
  fails_cleanly specconvert --from-rgb basis yuv:1,.3,.3
  [[ $stderr = *"'yuv:1,.3,.3' is no colour of RGB: its red is 1.342, not in [0, 1]" ]]
  fails_cleanly specconvert --from-rgb basis yuv:0,.2,0
  [[ $stderr = *"'yuv:0,.2,0' is no colour of RGB: its green is -0.07879, not in [0, 1]" ]]
  fails_cleanly specconvert --from-rgb basis lab:50,0,0
  fails_cleanly specconvert hsv:30,1,1
}
