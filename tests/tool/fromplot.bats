#!/usr/bin/env bats
# specconvert --from-plot: curves read off pictures of plots.

load common
load ../figures/measure

# drawn FILE WIDTH HEIGHT AWK: a picture of text; AWK sets r, g and b, white unless it does, of each
# pixel x, y.
drawn() {
  awk -v width="$2" -v height="$3" 'BEGIN {
    printf "P3\n%d %d\n255\n", width, height
    for (y = 0; y < height; y++) for (x = 0; x < width; x++) {
      r = g = b = 255
      '"$4"'
      print int(r + 0.5), int(g + 0.5), int(b + 0.5)
    }
  }' >"$1"
}

# A line of a pixel and a half, with smooth edges, from the bottom left to the top right.
slope='off = (59 - y) - x / 2; off = off < 0 ? -off : off; s = 1.25 - off; s = s < 0 ? 0 : s > 1 ? 1 : s; g = b = 255 - 255 * s;'
axes='0,59=400,0 100,9=500,1'

# straight FILE TOLERANCE [FROM TO]: "nm value", the line from 400,0 to 500,1.
straight() {
  awk -v most="$2" -v from="${3-401}" -v to="${4-499}" '
    /^[0-9]/ && $1 >= from && $1 <= to { n++; off = $2 - ($1 - 400) / 100; if (off > most || off < -most) { print; bad = 1 } }
    END { exit bad || n < 20 }' "$1" || complain "$(<"$1")"
}

@test "a straight line with smooth edges, to a twentieth of a pixel" {
  drawn a.ppm 110 70 "$slope"
  specconvert --from-plot "$axes" --ink '#ff0000' a.ppm >a.spd
  [ "$(grep -c '^[0-9]' a.spd)" -eq 101 ]
  straight a.spd 0.001
  grep -qx '# source: read off the plot a.ppm' a.spd
  # The same with whatever stands for red.
  specconvert --from-plot "$axes" --ink hsv:0,1,1 a.ppm | cmp - a.spd
  specconvert --from-plot '0,59=0.4um,0 100,9=500nm,1' --ink 'rgb:1,0,0' a.ppm | cmp - a.spd
}

@test "the axes may run either way, and the points may be any" {
  drawn a.ppm 110 70 "$slope"
  specconvert --from-plot '100,9=500,1 0,59=400,0' --ink '#ff0000' a.ppm >a.spd
  straight a.spd 0.001
  # To the right 500 to 400 nm, downwards 0 to 1: the same points turned by half a circle.
  specconvert --from-plot '0,59=500,1 100,9=400,0' --ink '#ff0000' a.ppm >b.spd
  straight b.spd 0.001
  [ "$(grep '^[0-9]' b.spd | head -n 1 | cut -d ' ' -f 1)" = 400 ]
  # Only what is between the points counts.
  specconvert --from-plot '20,49=420,.2 80,19=480,.8' --ink '#ff0000' a.ppm >c.spd
  [ "$(grep '^[0-9]' c.spd | cut -d ' ' -f 1 | sed -n '1p;$p' | xargs)" = '420 480' ]
  straight c.spd 0.001
}

@test "other colours, thin grids and gaps do not matter" {
  drawn a.ppm 110 70 "if (x % 10 == 0 || y % 10 == 0) r = g = b = 220; if (y == 20) { r = 0; g = 0; b = 255 } $slope if (x % 7 == 3) r = g = b = 255"
  specconvert --from-plot "$axes" --ink '#ff0000' a.ppm >a.spd
  straight a.spd 0.02
  [ "$(grep -c '^[0-9]' a.spd)" -lt 101 ]
  # White on black.
  drawn b.ppm 110 70 "$slope r = g = b = 255 - g"
  specconvert --from-plot "$axes" --ink '#ffffff' --paper '#000000' b.ppm >b.spd
  straight b.spd 0.001
}

@test "a plot with numbers and axes, in PNG too" {
  display >display.spd
  plot p.ppm 400:700 0:2 0.5 '0 128 0' <(specconvert -g 400:700:10 -m 14-green 16-yellow | awk '/^[0-9]/ { $2 *= 8 } 1')
  specconvert -g 400:700:10 -m 14-green 16-yellow | awk '/^[0-9]/ { $2 *= 8 } 1' >wanted.spd
  spec2rgb --name-map R=650nm,G=550nm,B=450nm --observer display.spd p.ppm -o p.png
  specconvert --from-plot '40,249=400,0 469,10=700,2' --ink '#008000' -g 410:690:5 p.png | grep '^[0-9]' |
    paste -d ' ' - <(specconvert -g 410:690:5 wanted.spd | grep '^[0-9]') |
    awk '{ n++; off = $2 - $4; if (off * off > .02 ^ 2) { print; exit 1 } } END { exit n != 57 }'
}

@test "a broad line at an end of an axis, and at the picture's, counts whole" {
  drawn foot.ppm 110 70 'if (y >= 57 && y <= 61) g = b = 0'
  specconvert --from-plot "$axes" --ink '#ff0000' foot.ppm | awk '/^[0-9]/ { n++; if ($2 != 0) exit 1 } END { exit n != 101 }'
  drawn last.ppm 110 60 'if (y >= 58) g = b = 0'
  specconvert --from-plot "$axes" --ink '#ff0000' last.ppm | awk '/^[0-9]/ { n++; if ($2 < .009999 || $2 > .010001) exit 1 } END { exit n != 101 }'
}

@test "what counts as ink, as a run and as the plot" {
  # Beside the way from white to red by 36 / 255 and by 39 / 255; 28, 23, 130 and 125 of its 255 parts;
  # four rows and five outside the points.
  drawn a.ppm 110 70 '
    if (x == 10 && y == 30) { r = 219; g = b = 0 }
    if (x == 20 && y == 30) { r = 216; g = b = 0 }
    if (x == 30 && y >= 29 && y <= 31) g = b = y == 30 ? 0 : y == 29 ? 227 : 232
    if (x == 40 && y == 30) g = b = 125
    if (x == 50 && y == 30) g = b = 130
    if (x == 60 && y >= 55 && y <= 63) g = b = 0
    if (x == 70 && y == 64) g = b = 0
    if (x == 80 && y >= 5 && y <= 13) g = b = 0
    if (x == 90 && y == 4) g = b = 0'
  specconvert --from-plot "$axes" --ink '#ff0000' a.ppm | awk '!/^#/ { printf "%d %.4f\n", $1, $2 }' >found
  # The middle of one pixel and 28 / 255 of the next lies 28 / 283 above it.
  printf '%s\n' '410 0.5800' '430 0.5820' '440 0.5800' '460 0.0000' '480 1.0000' | cmp - found || complain "$(<found)"
}

@test "what is read goes on as a curve does" {
  drawn a.ppm 110 70 "$slope"
  specconvert --from-plot "$axes" --ink '#ff0000' -g 410:490:20 --scale 100 a.ppm |
    awk '/^[0-9]/ { n++; off = $2 - ($1 - 400); if (off * off > .01) exit 1 } END { exit n != 5 }'
  specconvert --from-plot "$axes" --ink '#ff0000' a.ppm -o a.exr
  channels a.exr | grep -q '^S0[.]450,000000nm$'
  fails_cleanly specconvert --from-plot "$axes" --ink '#ff0000' -g 390:490:20 a.ppm
  specconvert --from-plot "$axes" --ink '#ff0000' - <a.ppm >piped.spd
  specconvert --from-plot "$axes" --ink '#ff0000' a.ppm -o named.spd
  cmp <(grep '^[0-9]' piped.spd) <(grep '^[0-9]' named.spd)
}

@test "what cannot be read is told with its place" {
  drawn a.ppm 110 70 "$slope if (x == 40 && y > 20 && y < 25) { r = 255; g = b = 0 }"
  fails_cleanly specconvert --from-plot "$axes" --ink '#ff0000' a.ppm
  [[ $stderr = *"a.ppm: the curve's colour is at two places of column 40, around rows 22 and 39" ]]
  fails_cleanly specconvert --from-plot "$axes" --ink '#00ff00' a.ppm
  [[ $stderr = *"a.ppm: the curve's colour is in no column of the plot" ]]
  fails_cleanly specconvert --from-plot '0,59=400,0 120,9=500,1' --ink '#ff0000' a.ppm
  [[ $stderr = *'a.ppm: has 110 x 70 pixels, and a point of the axes is not among them' ]]
  fails_cleanly specconvert --from-plot "$axes" --ink '#fff8f8' a.ppm
  [[ $stderr = *'can hardly be told from the background'* ]]
  drawn one.ppm 110 70 'if (x == 50 && y == 30) g = b = 0'
  fails_cleanly specconvert --from-plot "$axes" --ink '#ff0000' one.ppm
  [[ $stderr = *'is in one column alone of the plot' ]]
  head -c 3000 a.ppm >short.ppm
  fails_cleanly specconvert --from-plot "$axes" --ink '#ff0000' short.ppm
  spectral scene.exr
  fails_cleanly specconvert --from-plot '0,7=400,0 15,0=500,1' --ink '#ff0000' scene.exr
  [[ $stderr = *'scene.exr: is no picture of colours: no channel R' ]]
  fails_cleanly specconvert --from-plot "$axes" --ink '#ff0000' missing.png
}

@test "axes and options that make no sense" {
  local text
  drawn a.ppm 110 70 "$slope"
  for text in '' '0,59=400,0' '0,59=400,0 100,9=500' '0,59=400,0 100,9=500,1,2' '0;59=400,0 100,9=500,1' \
    '0,59=400,0  100,9=500,1 5' '0,59=400,x 100,9=500,1' '0,59=-400,0 100,9=500,1' '0,59=400,0 0,9=500,1' \
    '0,59=400,0 100,59=500,1' '0,59=400,0 100,9=400,1' '0,59=400,1 100,9=500,1' '0,59=400,0 1e9,9=500,1' \
    '0,59=400,0 100,-9=500,1' 'nan,59=400,0 100,9=500,1'; do
    fails_cleanly specconvert --from-plot "$text" --ink '#ff0000' a.ppm || complain "taken: '$text'"
  done
  fails_cleanly specconvert --from-plot "$axes" a.ppm
  [[ $stderr = *"--from-plot needs the curve's colour"* ]]
  fails_cleanly specconvert --ink '#ff0000' a.ppm
  fails_cleanly specconvert --from-plot "$axes" --ink red a.ppm
  fails_cleanly specconvert --from-plot "$axes" --ink '#ff0000' --from-rgb smits a.ppm
  fails_cleanly specconvert --from-plot "$axes" --ink '#ff0000' --row a a.ppm
  fails_cleanly specconvert --from-plot "$axes" --ink '#ff0000' --to fourier:9 a.ppm
}
