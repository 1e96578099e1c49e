#!/usr/bin/env bats
# specconvert --atlas and --row: many curves in one picture, four samples in each pixel.

load common

setup() {
  in_own_folder
  printf '%s\n' '# title: a glass' '# quantity: refractive index' '# unit: 1' '# source: nobody, 2000' \
    '# medium: vacuum' '# columns: wavelength_nm n k' '400 1.5 0' '500 1.25 0.125' '700 1 0.375' >glass.spd
  printf '%s\n' '# quantity: reflectance' '# columns: wavelength_nm R' '400 0.25' '700 0.75' >ramp.spd
}

@test "a line for each column, and texels as they are said to be" {
  specconvert --atlas -g 400:700:50 -o a.exr ramp.spd glass.spd
  has_channels a.exr A B G R
  has_line a.exr 'dataWindow (type box2i): (0 0) - (2 2)'
  has_line a.exr 'spec:atlas (type string): "400:700:50"'
  exrheader a.exr | grep -qF $'glass\tk\trefractive index\t1\tvacuum\ta glass\tnobody, 2000'
  [ "$(channels a.exr | wc -l)" -eq 4 ] && [ "$(exrheader a.exr | grep -c '32-bit floating-point')" -eq 4 ]
  # Seven samples: four, then three and a 0.
  [ "$(layers --print 0,1 a.exr | xargs)" = 'A 1.1875 B 1.25 G 1.375 R 1.5' ]
  [ "$(layers --print 1,1 a.exr | xargs)" = 'A 0 B 1 G 1.0625 R 1.125' ]
  [ "$(layers --print 0,2 a.exr | xargs)" = 'A 0.1875 B 0.125 G 0.0625 R 0' ]
  # The index has no colour, the reflectance is a pale red.
  [ "$(layers --print 2,1 a.exr | xargs)" = 'A 0 B 0 G 0 R 0' ]
  layers --print 2,0 a.exr | awk '{ of[$1] = $2 } END { exit !(of["A"] == 1 && of["R"] > of["G"] && of["G"] > of["B"] && of["B"] > .25 && of["R"] < .75) }'
}

@test "without a grid, 128 texels from 324 nm on, and outside what --extrapolate says" {
  specconvert --atlas --extrapolate zero -o a.exr ramp.spd
  has_line a.exr 'dataWindow (type box2i): (0 0) - (128 0)'
  [ "$(layers --print 18,0 a.exr | xargs)" = 'A 0 B 0 G 0 R 0' ]
  [ "$(layers --print 19,0 a.exr | grep R)" = 'R 0.25' ]
  specconvert --atlas --extrapolate constant -o a.exr ramp.spd
  [ "$(layers --print 127,0 a.exr | xargs)" = 'A 0.75 B 0.75 G 0.75 R 0.75' ]
  fails_cleanly specconvert --atlas -o x.exr ramp.spd
  [[ $stderr = 'specconvert: an atlas has the grid 324:835:1 where --grid gives no other: '* ]]
  [[ $stderr = *'400..700 nm, not 324 nm' ]]
  no_leftovers . a.exr glass.spd ramp.spd
}

@test "what went in comes out, from a file and from a pipe" {
  specconvert --atlas -g 400:700:50 -o a.exr ramp.spd glass.spd
  specconvert -g 400:700:50 glass.spd >wanted
  specconvert --row glass a.exr | cmp - wanted
  specconvert --atlas -g 400:700:50 ramp.spd glass.spd | specconvert --row glass - | cmp - wanted
  specconvert --row glass -o out.spd a.exr
  cmp out.spd wanted
  # The shortest decimals.
  specconvert -g 400:700:5 --atlas 15-red | specconvert --row 15-red - | grep -qx '400 0.051'
  # Packed again, the same samples, whatever decimals they passed through.
  specconvert -g 400:700:3 --atlas --no-history -o one.exr 15-red Au
  specconvert --row 15-red one.exr -o 15-red.spd
  specconvert --row Au one.exr -o Au.spd
  specconvert -g 400:700:3 --atlas --no-history -o two.exr ./15-red.spd ./Au.spd
  cmp one.exr two.exr
}

@test "a curve from an atlas is a curve like others" {
  specconvert --atlas -g 400:700:50 -o a.exr ramp.spd glass.spd
  specconvert --row ramp -g 500:600:100 --scale 2 a.exr | grep '^[0-9]' | cmp - <(printf '%s\n' '500 0.8333333' '600 1.1666666') ||
    specconvert --row ramp -g 500:600:100 --scale 2 a.exr | awk '/^[0-9]/ { off = $2 - ($1 - 400) / 300 - .5; n++; if (off * off > 1e-13) exit 1 } END { exit n != 2 }'
  specconvert --row ramp a.exr -o patch.exr
  channels patch.exr | grep -q '^T[.]550,000000nm$'
  spec2rgb -q patch.exr -o patch.png
}

@test "the colour at a line's end is that of spec2rgb" {
  specconvert -g 400:700:5 --atlas -o a.exr 14-green A
  for name in 14-green A; do
    specconvert -g 400:700:5 --patches 1x1 -o p.exr "$name"
    spec2rgb -q p.exr -o rgb.exr
    layers --print "16,$([ $name = A ] && echo 1 || echo 0)" a.exr | grep -v A | paste -d ' ' - <(layers --print 0,0 rgb.exr) |
      awk '{ n++; if ($1 != $3 || ($2 / $4 - 1) ^ 2 > 1e-11) { print; exit 1 } } END { exit n != 3 }'
  done
  # Where nothing is seen there is none.
  printf '%s\n' '1000 1' '2000 2' >far.spd
  specconvert -g 1000:2000:100 --atlas -o far.exr far.spd
  [ "$(layers --print 3,0 far.exr | xargs)" = 'A 0 B 0 G 0 R 0' ]
}

@test "names are told apart, and told" {
  mkdir other
  cp ramp.spd other/ramp.txt
  fails_cleanly specconvert --atlas -g 400:700:50 -o x.exr ramp.spd other/ramp.txt
  [[ $stderr = *"two curves are called 'ramp'"* ]]
  specconvert --atlas -g 400:700:50 -o a.exr ramp.spd glass.spd
  fails_cleanly specconvert --row nothing a.exr
  [[ $stderr = *"a.exr: has no curve 'nothing' (ramp glass)" ]]
  fails_cleanly specconvert --row '' a.exr
  fails_cleanly specconvert --row glas a.exr
  fails_cleanly specconvert --row glasses a.exr
}

@test "what is no atlas, or a damaged one" {
  spectral scene.exr
  fails_cleanly specconvert --row ramp scene.exr
  [[ $stderr = *'scene.exr: is no atlas of curves (no attribute spec:atlas)' ]]
  fails_cleanly specconvert --row ramp missing.exr
  specconvert --atlas -g 400:700:50 --compression none -o a.exr ramp.spd glass.spd
  LC_ALL=C sed 's/400:700:50/400:700:25/' a.exr >grid.exr
  fails_cleanly specconvert --row ramp grid.exr
  [[ $stderr = *'a damaged atlas: its width does not fit its grid' ]]
  LC_ALL=C sed 's/400:700:50/400:700;50/' a.exr >grid.exr
  fails_cleanly specconvert --row ramp grid.exr
  [[ $stderr = *'a damaged atlas: its grid is none' ]]
  LC_ALL=C sed 's/nobody, 2000/nobody\n 2000/' a.exr >lines.exr
  fails_cleanly specconvert --row ramp lines.exr
  [[ $stderr = *'it has more or fewer lines than it says' ]]
  rename_channels G H a.exr named.exr
  fails_cleanly specconvert --row ramp named.exr
  [[ $stderr = *'channels R, G, B, A are not there' ]]
  head -c $(($(wc -c <a.exr) - 20)) a.exr >short.exr
  fails_cleanly specconvert --row ramp short.exr
  poke a.exr $(($(wc -c <a.exr) - 12)) '\x00\x00\xc0\x7f'
  specconvert --row ramp a.exr >/dev/null
  poke a.exr $(($(wc -c <a.exr) - 2 * 56 - 12)) '\x00\x00\xc0\x7f'
  fails_cleanly specconvert --row ramp a.exr
  [[ $stderr = *'line 0 is not finite at '*' nm' ]]
}

@test "what cannot be packed" {
  printf '%s\n' '400 1e300' '700 1' >huge.spd
  fails_cleanly specconvert --atlas -g 400:700:50 -o x.exr huge.spd
  [[ $stderr = *'beyond 32-bit floats, 1e+300' ]]
  fails_cleanly specconvert --atlas -g 400:700:50 --patches 1x1 -o x.exr ramp.spd
  printf '%s\n' '400 1' '500 1' '700 1' >uneven.spd
  fails_cleanly specconvert --atlas -g ./uneven.spd -o x.exr ramp.spd
  [[ $stderr = *'the grid of an atlas has equal steps (--grid LO:HI:STEP)' ]] || complain "$stderr"
  fails_cleanly specconvert --atlas -g 400:700:50 -f spd ramp.spd
  fails_cleanly specconvert --atlas -g 400:700:50 -o x.png ramp.spd
  fails_cleanly specconvert --atlas --to fourier:9 -o x.exr ramp.spd
  spectral scene.exr
  fails_cleanly specconvert --atlas -o x.exr scene.exr
  [[ $stderr = *"--atlas is for curves, 'scene.exr' is an image" ]]
  fails_cleanly specconvert --row a --from-rgb smits scene.exr
  no_leftovers . glass.spd ramp.spd huge.spd uneven.spd scene.exr
}
