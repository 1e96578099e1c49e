#!/usr/bin/env bats
# spec2rgb's false colours: the number that was asked for, in the colour that the legend has for it.
# shellcheck disable=SC2154 # fails_cleanly leaves its line in stderr

load common

# pixel FILE.ppm X Y: red, green and blue of a binary PPM of 8 bits.
pixel() {
  local width header
  read -r width _ < <(sed -n 2p "$1" | tr -d '\0')
  header=$(head -n 3 "$1" | wc -c)
  tail -c +$((header + 3 * ($3 * width + $2) + 1)) "$1" | od -An -v -tu1 -N3 | xargs
}

# is PIXEL FILE.ppm X Y
is() {
  local found
  found=$(pixel "$2" "$3" "$4")
  [ "$found" = "$1" ] || complain "$2 has $found at $3,$4, not $1"
}

# size FILE.ppm: WIDTH HEIGHT
size() {
  sed -n 2p "$1" | tr -d '\0'
}

# number FILE.ppm LEFT RIGHT: the columns that have ink below a legend's colours, as 0 and 1.
number() {
  tail -c +$((16 + 3 * 256 * 20)) "$1" | od -An -v -tu1 -w768 | awk -v left="$2" -v right="$3" 'NR <= 13 {
      for (x = left; x < right; x++) column[x] = column[x] ($(3 * x + 1) < 128 ? 1 : 0)
    }
    END { for (x = left; x < right; x++) if (column[x] ~ /1/) print column[x] }'
}

# numbered FILE EXPRESSION: an image of 11 x 2 pixels, bands of 400 to 700 nm by 50.
numbered() {
  spectral grid.exr --size 11x2 --grid 400:700:50 --pattern constant:1
  speccomp --expr "$2" grid.exr -o "$1"
}

# Of viridis: the ends, and a quarter, which lies 3/4 of the way from its 12th to its 13th colour.
first='68 1 84' last='253 231 37' quarter='59 82 139'

# Numbers

@test "--band: the band's values on the scale of the least and the largest, or a given one" {
  numbered x.exr 'nm == 550 ? x + 2 : 100'
  spec2rgb --band 550 x.exr -o auto.ppm
  [ "$(size auto.ppm)" = '11 2' ]
  is "$first" auto.ppm 0 0
  is "$last" auto.ppm 10 1
  spec2rgb -b 550nm --range 2..12 x.exr -o given.ppm
  cmp auto.ppm given.ppm
  spec2rgb --band .55um --range auto x.exr -o again.ppm
  cmp auto.ppm again.ppm
  spec2rgb --verbose --band 550 x.exr -o again.ppm 2>err
  [ "$(cat err)" = 'spec2rgb: x.exr: 550 nm: the scale is 2..12' ] || complain "$(cat err)"
  spec2rgb --band 550 --range 2..10 x.exr -o narrow.ppm
  is "$quarter" narrow.ppm 2 0
  is "$last" narrow.ppm 8 0
  is "$last" narrow.ppm 10 0
  spec2rgb --band 550 --range=-8..2 x.exr -o high.ppm
  is "$last" high.ppm 5 1
}

@test "--expr: a ratio of bands, in speccomp's words" {
  numbered x.exr 'nm < 500 ? 1 : 1 + x / 10'
  spec2rgb --expr '(b650-b450)/(b650+b450)' x.exr -o ratio.ppm
  # the same as a band of the same numbers
  speccomp --expr '(a(650) - a(450)) / (a(650) + a(450))' x.exr -o value.exr
  spec2rgb --band 500 value.exr -o value.ppm
  cmp ratio.ppm value.ppm
  # x/10 / (2 + x/10): of 0 to 1/3 it is .75 / 3 of that at x = .75 / .275
  spec2rgb --expr '(b650-b450)/(b650+b450)' --range 0..0.52380952 x.exr -o narrow.ppm
  is "$quarter" narrow.ppm 3 0
  # with a band, its own value and wavelength have names
  spec2rgb --expr 'a * nm / 100' --band 650 --range 6.5..13 x.exr -o a.ppm
  is "$first" a.ppm 0 0
  is "$last" a.ppm 10 0
  # reflectance has values, too
  speccomp --kind T --expr a x.exr -o paint.exr
  spec2rgb --expr '(b650-b450)/(b650+b450)' paint.exr -o paint.ppm
  cmp ratio.ppm paint.ppm
}

@test "--expr: between two bands, and what is the same everywhere" {
  numbered x.exr 'nm + x'
  spec2rgb --expr 'b525' --range 525..535 x.exr -o between.ppm
  is "$first" between.ppm 0 0
  is "$last" between.ppm 10 1
  spec2rgb --expr 7 x.exr -o seven.ppm
  is "$first" seven.ppm 5 1
  # a scale all the same, which begins there
  spec2rgb --expr 7 --legend x.exr -o seven.ppm
  spec2rgb --expr 7 --range 7..14 --legend x.exr | cmp - <(spec2rgb --expr 7 --legend x.exr)
  spec2rgb --expr y --range 0..1 x.exr -o y.ppm
  is "$first" y.ppm 10 0
  is "$last" y.ppm 0 1
}

@test "what is not finite has a colour of its own, is counted, and does not stretch the scale" {
  numbered x.exr 'x == 3 ? 1 / 0 : x == 4 && y == 1 ? 0 / 0 : x == 5 ? -1 / 0 : x'
  spec2rgb --band 400 x.exr -o x.ppm 2>err
  [ "$(cat err)" = 'spec2rgb: warning: x.exr: 5 pixels are not finite, the first at 3,0' ] ||
    complain "$(cat err)"
  is '255 0 255' x.ppm 3 1
  is '128 128 128' x.ppm 4 1
  is '255 0 255' x.ppm 5 0
  is "$first" x.ppm 0 0
  is "$last" x.ppm 10 0
  spec2rgb -q --band 400 --range 0..10 x.exr -o given.ppm 2>err
  [ ! -s err ]
  cmp x.ppm given.ppm
  spec2rgb --expr 'y == 1 && x > 6 ? 0/0 : x' x.exr -o below.ppm 2>err
  grep -qF '4 pixels are not finite, the first at 7,1' err || complain "$(cat err)"
  spec2rgb --expr '0/0' x.exr -o none.ppm 2>err
  grep -qF '22 pixels are not finite, the first at 0,0' err
  is '128 128 128' none.ppm 0 0
}

@test "--colour-map: each by its name" {
  numbered x.exr x
  local map
  while read -r map a b c; do
    spec2rgb --band 400 --colour-map "$map" x.exr -o map.ppm
    is "${a//,/ }" map.ppm 0 0
    is "${b//,/ }" map.ppm 5 0
    is "${c//,/ }" map.ppm 10 1
  done <<'END'
viridis 68,1,84 33,144,140 253,231,37
grey 0,0,0 119,119,119 255,255,255
cool-warm 59,76,192 221,221,221 180,4,38
END
  spec2rgb --band 400 --colour-map hue x.exr -o map.ppm
  is "$(pixel map.ppm 0 0)" map.ppm 10 0
}

@test "--legend: the map below the picture, as wide as its numbers need" {
  numbered x.exr 'x + 2'
  spec2rgb --band 550 x.exr -o plain.ppm
  spec2rgb --band 550 --legend x.exr -o legend.ppm
  [ "$(size legend.ppm)" = '256 50' ] || complain "$(size legend.ppm)"
  for x in 0 5 10; do
    is "$(pixel plain.ppm $x 1)" legend.ppm $x 1
  done
  is '255 255 255' legend.ppm 11 1
  is "$first" legend.ppm 4 6
  is "$last" legend.ppm 251 6
  is '255 255 255' legend.ppm 252 6
  # 2, 7 and 12: the first column of a 2 is white but for its corners' rows
  is '0 0 0' legend.ppm 4 22
  is '255 255 255' legend.ppm 4 24
  spec2rgb --band 550 --range 3..12 --legend x.exr -o other.ppm
  run ! cmp -s legend.ppm other.ppm
  # what the number is, in a line of its own
  spec2rgb --expr 'b550' --legend x.exr -o label.ppm
  cmp <(head -c $((15 + 3 * 256 * 36)) legend.ppm) <(head -c $((15 + 3 * 256 * 36)) label.ppm)
  run ! cmp -s legend.ppm label.ppm
  # half-way stands 7, as where a scale begins there
  spec2rgb --band 550 --range 7..9 --legend x.exr -o seven.ppm
  [ -n "$(number legend.ppm 100 156)" ]
  [ "$(number legend.ppm 100 156)" = "$(number seven.ppm 0 60)" ] ||
    complain "$(number legend.ppm 100 156)" "$(number seven.ppm 0 60)"
  run ! test "$(number legend.ppm 100 156)" = "$(number legend.ppm 0 60)"
  # wider pictures have wider legends
  spectral wide.exr --size 300x2 --grid 400:500:50
  spec2rgb --band 400 --legend wide.exr -o wide.ppm
  [ "$(size wide.ppm)" = '300 50' ]
  is "$last" wide.ppm 295 6
  # and of 1600 pixels twice as large ones: a dot of the first digit, 0, is 4 pixels wide, not 2.
  spectral hd.exr --size 1599x2 --grid 400:500:50
  spec2rgb --band 400 --legend hd.exr -o hd.ppm
  [ "$(size hd.ppm)" = '1599 50' ]
  is '0 0 0' hd.ppm 9 22
  is '255 255 255' hd.ppm 7 24
  spectral hd.exr --size 1600x2 --grid 400:500:50
  spec2rgb --band 400 --legend hd.exr -o hd.ppm
  [ "$(size hd.ppm)" = '1600 98' ]
  is "$first" hd.ppm 8 10
  is '255 255 255' hd.ppm 7 10
  is '0 0 0' hd.ppm 8 42
  is '0 0 0' hd.ppm 11 49
  is '255 255 255' hd.ppm 12 49
  is '0 0 0' hd.ppm 16 49
}

# Polarisation

@test "--stokes: degrees and angles of one band" {
  spectral grid.exr --kind stokes --size 11x2 --grid 400:700:100 --pattern constant:1
  # of degree x / 10, at 18 degrees times x, a quarter of it circular in the second line
  speccomp --expr 'd = 2 * x / 10 * (y == 0 ? 1 : sqrt(3) / 2); t = 2 * x * pi / 10;
    stokes == 0 ? 2 : stokes == 1 ? d * cos(t) : stokes == 2 ? d * sin(t) : y * x / 10' grid.exr -o s.exr
  spec2rgb --expr 'x / 10' --range 0..1 s.exr -o degree.ppm
  spec2rgb --stokes dop --band 500 s.exr -o dop.ppm
  cmp degree.ppm dop.ppm
  spec2rgb --stokes dop s.exr -o dop.ppm # of all bands, which are alike
  cmp degree.ppm dop.ppm
  spec2rgb --expr 'x / 10 * (y == 0 ? 1 : sqrt(3) / 2)' --range 0..1 s.exr -o linear.ppm
  spec2rgb --stokes dolp --band 500 s.exr -o dolp.ppm
  cmp linear.ppm dolp.ppm
  spec2rgb --expr 'x / 20 * y' --range 0..1 s.exr -o circular.ppm
  spec2rgb --stokes docp --band 500 s.exr -o docp.ppm
  cmp circular.ppm docp.ppm
  # light that is not polarised has no angle
  spec2rgb --expr 'x == 0 ? 0 / 0 : 18 * x' --range 0..180 --colour-map hue -q s.exr -o turned.ppm
  spec2rgb --stokes aop --band 500 s.exr -o aop.ppm 2>err
  grep -qF '2 pixels are not finite, the first at 0,0' err
  # 180 degrees are 0, but for rounding
  for x in 0 1 2 3 4 5 6 7 8 9; do
    is "$(pixel turned.ppm $x 0)" aop.ppm $x 0
  done
  spec2rgb --expr 'x == 0 ? 0 / 0 : 15 * y' --range -45..45 --colour-map cool-warm -q s.exr -o shape.ppm
  spec2rgb -q --stokes ellipticity --band 500 s.exr -o ellipticity.ppm
  cmp shape.ppm ellipticity.ppm
  spec2rgb --stokes aop --range 0..90 --colour-map grey --legend -q s.exr -o options.ppm
  is '255 255 255' options.ppm 9 0
}

@test "--stokes: what an observer sees weighs the bands" {
  # Only 400 nm is polarised, of which no eye sees much.
  spectral grid.exr --kind stokes --size 4x2 --grid 400:700:100 --pattern constant:1
  speccomp --expr 'stokes == 0 ? 1 : stokes == 1 && nm == 400 ? 1 : 0' grid.exr -o violet.exr
  spec2rgb --stokes dop violet.exr --range 0..1 -o eye.ppm
  spec2rgb --stokes dop --observer v-scotopic violet.exr --range 0..1 -o night.ppm
  run ! cmp -s eye.ppm night.ppm
  spec2rgb --stokes dop --band 400 violet.exr -o band.ppm
  is "$last" band.ppm 0 0
}

@test "--stokes: values per band weigh as those per nm of the same light" {
  # bins of 10 and of 190 nm, of which the narrow one is polarised
  for quantity in nm band; do
    spectral grid.exr --kind stokes --size 3x2 --grid 500:600:100 --attribute 'spec:bins=495 505 695' \
      --quantity "radiance per $quantity"
    width=1
    [ $quantity = nm ] || width='(nm == 500 ? 10 : 190)'
    speccomp --expr "$width * (stokes == 0 ? 1 : stokes == 1 && nm == 500 ? 1 : 0)" grid.exr -o s.exr
    spec2rgb --stokes dop --range 0..0.1 s.exr -o $quantity.ppm
    spec2rgb --stokes dop --range 0..1 s.exr -o high.ppm
    run ! cmp -s $quantity.ppm high.ppm
  done
  cmp nm.ppm band.ppm
}

# Layers

@test "--layer: light that arrives at a film, as the picture that it is" {
  layers --size 16x8 --radiance 0.3 --behind 0.2 -o flat.exr
  spectral mirror.exr --size 16x8 --grid 380:780:5 --pattern constant:0.3
  spectral through.exr --size 16x8 --grid 380:780:5 --pattern constant:0.4
  spec2rgb --layer film1.mirror flat.exr -o layer.ppm
  spec2rgb mirror.exr -o mirror.ppm
  cmp layer.ppm mirror.ppm
  spec2rgb --layer through -e 1 flat.exr -o layer.ppm
  spec2rgb through.exr -o through.ppm
  cmp layer.ppm through.ppm
  spec2rgb --layer film1.mirror --lod 3 --error flat.exr -o layer.ppm 2>err
  grep -qx 'bands      9 of 81' err
  cmp layer.ppm mirror.ppm # flat: nothing is lost
  # and in false colours
  spec2rgb --layer film1.mirror --band 500 --range 0..0.3 flat.exr -o band.ppm
  is "$last" band.ppm 3 3
  spec2rgb --layer film1.cover flat.exr -o cover.ppm
  [ "$(size cover.ppm)" = '16 8' ]
}

@test "--layer: directions as codes, n / 2 + 1 / 2, and back within a code" {
  layers --scene sphere --size 32x32 -o ball.exr
  spec2rgb --layer film1.N ball.exr -o n.ppm
  spec2rgb --layer film1.N --bits 16 ball.exr -o n16.ppm
  spec2rgb --layer film1.N ball.exr -o n.exr
  spec2rgb --layer film1.I ball.exr -o eye.ppm
  for place in 16,16 8,20 20,9; do
    layers --print "$place" ball.exr | awk '/^film1\.N\./ { print $2 }' >want
    layers --print "$place" n.exr | sort -r | awk '{ print 2 * $2 - 1 }' >float # R, G, B
    pixel n.ppm "${place%,*}" "${place#*,}" | tr ' ' '\n' | awk '{ print $1 / 255 * 2 - 1 }' |
      paste - want float | awk '{ d = $1 - $2; f = $3 - $2
        if (d * d > (1.001 / 255) ^ 2 || f * f > 1e-12 || NF != 3) { print; bad = 1 } } END { exit bad || NR != 3 }' ||
      complain "$place"
  done
  # and by specconvert, from codes of 8 and of 16 bits, and from floats
  spec2rgb --layer film1.N ball.exr -o n.png
  spec2rgb --layer film1.N --bits 16 ball.exr -o n16.png
  local name most
  for name in 'n.png 3.94e-3' 'n16.png 1.54e-5' 'n.exr 2e-7'; do
    read -r name most <<<"$name"
    cat "$name" | specconvert --vectors N -o back.exr
    has_channels back.exr N.X N.Y N.Z
    for place in 16,16 8,20 20,9; do
      paste <(layers --print "$place" back.exr) <(layers --print "$place" ball.exr | grep '^film1\.N\.') |
        awk -v most="$most" '{ d = $2 - $4; if (d * d > most * most || NF != 4) { print; bad = 1 } } END { exit bad || NR != 3 }' ||
        complain "$name $place"
    done
  done
  fails_cleanly specconvert --vectors N ball.exr -o x.exr
  fails_cleanly specconvert --vectors '' n.png -o x.exr
  fails_cleanly specconvert --vectors N --scale 2 n.png -o x.exr
  fails_cleanly specconvert --vectors N --projection cross n.png -o x.exr
  fails_cleanly specconvert --vectors N D65 -o x.exr
  fails_cleanly specconvert --vectors N --place '50N 4E' n.png -o x.exr
  [[ $stderr = *'--vectors does nothing else on the way'* ]] || complain "$stderr"
  spectral whole.exr --channel R --channel G --uint B
  fails_cleanly specconvert --vectors N whole.exr -o x.exr
  [[ $stderr = *'whole.exr: its channel B holds whole numbers, not codes' ]] || complain "$stderr"
  [ ! -e x.exr ]
  # Towards the eye: (0, 1, 0)
  is '128 255 128' eye.ppm 16 16
  # nothing is there: 0
  is '128 128 128' n.ppm 0 0
  [ "$(wc -c <n16.ppm)" = $((15 + 6 * 32 * 32)) ] || complain "$(wc -c <n16.ppm)"
  spec2rgb --layer film1.N --range 0..1 ball.exr -o half.ppm
  # the component is N.X = 0.039 there
  [[ $(pixel half.ppm 16 16) = '10 255 0' ]] || complain "$(pixel half.ppm 16 16)"
}

@test "--layer: uv, positions and whole numbers" {
  spectral uv.exr --size 9x2 --grid 400:500:50 --channel u --channel v --pattern constant:0.25
  spec2rgb --layer uv uv.exr -o uv.ppm
  is '64 64 0' uv.ppm 4 1
  fails_cleanly spec2rgb --layer vu uv.exr -o x.png
  fails_cleanly spec2rgb --layer w uv.exr -o x.png
  spec2rgb --layer uv --range=-1..1 uv.exr -o uv.ppm
  is '159 159 0' uv.ppm 4 1
  spectral id.exr --size 9x2 --uint-id
  spec2rgb --layer id --range 0..65544 id.exr -o id.ppm
  is "$first" id.ppm 0 0
  is "$last" id.ppm 8 1
  layers --scene sphere --size 32x32 -o ball.exr
  spec2rgb --layer film1.P ball.exr -o p.ppm
  [ "$(size p.ppm)" = '32 32' ]
  # positions from the least component to the largest
  [ "$(tail -c 3072 p.ppm | od -An -v -tu1 -w1 | sort -nu | sed -n '1p;$p' | xargs)" = '0 255' ]
  # directions from -1 to 1, object coordinates from 0 to 1
  local name
  for name in N Ns Tan I film1.N lamp1.D Q film1.Q; do
    spectral v.exr --size 2x2 --channel $name.X --channel $name.Y --channel $name.Z --pattern constant:0.25
    spec2rgb --layer $name v.exr -o v.ppm
    case $name in *Q) is '64 64 64' v.ppm 1 1 ;; *) is '159 159 159' v.ppm 1 1 ;; esac
  done
}

# Formats, pipes, threads

@test "every format, a pipe and any number of threads have the same picture" {
  spectral x.exr --size 40x33 --grid 400:700:50
  spec2rgb --band 550 --legend x.exr -o x.ppm
  spec2rgb --band 550 --legend -f ppm <x.exr | cmp - x.ppm
  cat x.exr | spec2rgb --band 550 --legend -f ppm | cmp - x.ppm
  spec2rgb --band 550 --legend -j 1 -f ppm x.exr | cmp - x.ppm
  spec2rgb --band 550 --legend -j 3 -f ppm x.exr | cmp - x.ppm
  spec2rgb --band 550 --range 0..1 -j 3 -f ppm x.exr | cmp - <(spec2rgb --band 550 --range 0..1 -j 1 -f ppm x.exr)
  spec2rgb --band 550 --legend x.exr -o x.png
  cat x.exr | spec2rgb --band 550 --legend | cmp - x.png
  spec2rgb --band 550 --bits 16 x.exr -o x16.ppm
  spec2rgb --band 550 x.exr -o x8.ppm
  [ "$(tail -c 6 x16.ppm | od -An -v -tu2 --endian=big | xargs)" = "$(tail -c 3 x8.ppm | od -An -v -tu1 | awk '{ print 257 * $1, 257 * $2, 257 * $3 }')" ]
  # floats are the light of the colours
  spec2rgb --band 550 x.exr -o light.exr
  layers --print 39,32 light.exr >light
  tail -c 3 x8.ppm | od -An -v -tu1 | awk '{ for (i = 1; i <= 3; i++) { c = $i / 255; print c <= .04045 ? c / 12.92 : ((c + .055) / 1.055) ^ 2.4 } }' |
    paste - <(sort -r light) | awk '{ d = $1 - $3; if (d * d > 1e-10) { print; bad = 1 } } END { exit bad || NR != 3 }'
}

# What is refused

@test "bad input: bands, expressions, components and layers that are not there" {
  spectral x.exr --grid 400:700:50
  fails_cleanly spec2rgb --band 540 x.exr -o x.png
  [[ $stderr = *'x.exr: has no band at 540 nm; the nearest is at 550 nm' ]]
  fails_cleanly spec2rgb --band nm x.exr
  fails_pointing 8 spec2rgb --expr 'b450 + (b500' x.exr -o x.png
  fails_pointing 8 spec2rgb --expr 'b450 + b900' x.exr -o x.png
  fails_pointing 1 spec2rgb --expr 'a / b500' x.exr -o x.png
  fails_pointing 8 spec2rgb --expr 'b450 + c' x.exr -o x.png
  fails_pointing 1 spec2rgb --expr 'a.Z' x.exr -o x.png
  fails_pointing 1 spec2rgb --expr '' x.exr -o x.png
  fails_cleanly spec2rgb --stokes dop x.exr -o x.png
  [[ $stderr = *'x.exr: is not polarised: it has no Stokes components S1, S2 and S3' ]]
  fails_cleanly spec2rgb --stokes degree x.exr -o x.png
  fails_cleanly spec2rgb --layer N x.exr -o x.png
  [[ $stderr = *"x.exr: has no layer 'N', and none besides its bands" ]]
  layers --size 4x4 -o flat.exr
  fails_cleanly spec2rgb --layer film2 flat.exr -o x.png
  [[ $stderr = *"has no layer 'film2'; it has film1.I, film1.N, "*', film1.mirror, through' ]] || complain "$stderr"
  spectral none.exr --channel R --channel G --channel B
  fails_cleanly spec2rgb --band 550 none.exr -o x.png
  no_leftovers . x.exr flat.exr none.exr
}

@test "bad usage: what goes together and what does not" {
  spectral x.exr --grid 400:700:50
  layers --size 4x4 -o flat.exr
  fails_cleanly spec2rgb --range 1..1 --band 550 x.exr -o x.png
  fails_cleanly spec2rgb --range 2..1 --band 550 x.exr -o x.png
  fails_cleanly spec2rgb --range 1 --band 550 x.exr -o x.png
  fails_cleanly spec2rgb --colour-map jet --band 550 x.exr -o x.png
  fails_cleanly spec2rgb --legend x.exr -o x.png
  fails_cleanly spec2rgb --range 0..1 x.exr -o x.png
  fails_cleanly spec2rgb --colour-map grey --layer through flat.exr -o x.png
  fails_cleanly spec2rgb --expr b550 --stokes dop x.exr -o x.png
  [[ $stderr = *'--expr and --stokes exclude each other' ]]
  for option in '-e 1' '--illuminant A' '--space p3' '--tone filmic' '--gamut scale' --dither '--model hsv' '--adapt cat16' '--transfer linear' '--lod 2' '--step 100'; do
    # shellcheck disable=SC2086 # an option and its argument
    fails_cleanly spec2rgb --band 550 $option x.exr -o x.png
    # shellcheck disable=SC2086
    fails_cleanly spec2rgb --layer film1.N $option flat.exr -o x.png
  done
  fails_cleanly spec2rgb --layer film1.N --legend flat.exr -o x.png
  fails_cleanly spec2rgb --layer film1.N --colour-map grey flat.exr -o x.png
  fails_cleanly spec2rgb --layer film1.N --band 550 flat.exr -o x.png
  fails_cleanly spec2rgb --layer film1.cover --expr b550 flat.exr -o x.png
  no_leftovers . x.exr flat.exr
}

@test "bad input: half an image, a full device, a folder that is not there for temporary files" {
  spectral x.exr --size 64x64 --grid 400:700:50 --compression none
  head -c 20000 x.exr >short.exr
  fails_cleanly spec2rgb --band 550 short.exr -o x.png
  fails_cleanly spec2rgb --band 550 --range 0..1 -o x.png < <(cat short.exr)
  ln -s /dev/full full.png
  fails_cleanly spec2rgb --band 550 --legend x.exr -o full.png
  TMPDIR=$PWD/nowhere fails_cleanly spec2rgb --band 550 x.exr -o x.png
  TMPDIR=$PWD/nowhere spec2rgb --band 550 --range 0..1 x.exr -o y.png
  no_leftovers . x.exr short.exr full.png y.png
}
