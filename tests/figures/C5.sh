# shellcheck shell=bash disable=SC2016
title 'Spectra for the seven colours'
from 'T 2.6.2, figures 2.11 and 2.12 (Vangorp & Yskout 2005, after Smits 1999)'
note 'As much white as there is in a colour, then as much cyan, magenta or yellow, then what remains of red, green or blue: each a spectrum of ten bins of 34 nm. Added up, red, green and blue are rougher than white.'

# bars FILE: the columns of a curve as bars of 17 nm, side by side, to a height of 1.2; each bar has
# about the colour of its wavelength. A curve for a chart of 24 rows, its columns on stderr.
bars() {
  awk '
    /^# columns:/ { columns = NF - 3 }
    /^[0-9]/ { nm[++n] = $1; for (i = 2; i <= NF; i++) value[n, i - 1] = $i }
    function at(x, k, i) {
      for (i = 2; i < n && nm[i] < x; i++);
      return value[i - 1, k] + (value[i, k] - value[i - 1, k]) * (x - nm[i - 1]) / (nm[i] - nm[i - 1])
    }
    END {
      print columns * 21 >"/dev/stderr"
      print "# quantity: spectral power distribution"
      for (l = 400; l <= 700; l += 10) {
        line = l
        for (row = 23; row >= 0; row--)
          for (k = 1; k <= columns; k++)
            for (bar = 0; bar < 21; bar++) {
              x = 380 + 17 * (bar + 0.5)
              on = bar < 20 && at(x, k) > (row + 0.5) / 20
              line = line " " (on ? 0.25 + 1.5 * exp(-((l - x) / 25) ^ 2) : row == 19 ? 0.05 : 0)
            }
        print line
      }
    }' "$1"
}

smits=$spectra/upsampling/smits.spd
bars "$smits" >bars.spd 2>columns
picture bases.png "specconvert --patches $(<columns)x24 --patch 6 bars.spd -o bars.exr
spec2rgb bars.exr -o bases.png" 'white, cyan, magenta, yellow; red, green, blue; the line is at 1'

# The sum of red, green and blue beside white.
awk '/^# quantity/ { print } /^# columns/ { print "# columns: wavelength_nm white sum" }
  /^[0-9]/ { print $1, $2, $6 + $7 + $8 }' "$smits" >sum.spd
bars sum.spd >bars.spd 2>columns
picture sum.png "specconvert --patches $(<columns)x24 --patch 12 bars.spd -o bars.exr
spec2rgb bars.exr -o sum.png" 'white, and the sum of red, green and blue'
picture patches.png 'specconvert --patches 7x1 --patch 64 --gap 4 -g 380:719:1 smits -o patches.exr
spec2rgb --illuminant E --adapt bradford patches.exr -o patches.png' 'the seven under equal energy, adapted to the white of sRGB'

# The rule of the paper: a space of Rec. 709 primaries whose white is equal energy, and sums over
# the table of 1931 where the bins are. The matrix follows from the primaries and the white.
# rgb_of WHITE: "name R G B" for each column, for a curve on standard input that has every nm.
rgb_of() {
  awk -v white="$1" '
    function invert(m, w,  i, j, d) {
      d = m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) + m[2] * (m[3] * m[7] - m[4] * m[6])
      w[0] = (m[4] * m[8] - m[5] * m[7]) / d; w[1] = (m[2] * m[7] - m[1] * m[8]) / d; w[2] = (m[1] * m[5] - m[2] * m[4]) / d
      w[3] = (m[5] * m[6] - m[3] * m[8]) / d; w[4] = (m[0] * m[8] - m[2] * m[6]) / d; w[5] = (m[2] * m[3] - m[0] * m[5]) / d
      w[6] = (m[3] * m[7] - m[4] * m[6]) / d; w[7] = (m[1] * m[6] - m[0] * m[7]) / d; w[8] = (m[0] * m[4] - m[1] * m[3]) / d
    }
    part == "observer" && /^[0-9]/ { for (c = 0; c < 3; c++) bar[$1 + 0, c] = $(c + 2); next }
    /^# columns:/ { for (i = 4; i <= NF; i++) name[i - 3] = $i; columns = NF - 3 }
    /^[0-9]/ {
      luminance += bar[$1 + 0, 1]
      for (k = 1; k < NF; k++) for (c = 0; c < 3; c++) sum[k, c] += bar[$1 + 0, c] * $(k + 1)
    }
    END {
      split(white, w, ",")
      p[0] = 0.64; p[1] = 0.3; p[2] = 0.15; p[3] = 0.33; p[4] = 0.6; p[5] = 0.06
      for (c = 0; c < 3; c++) p[6 + c] = 1 - p[c] - p[3 + c]
      invert(p, q)
      for (c = 0; c < 3; c++) scale[c] = (q[3 * c] * w[1] + q[3 * c + 1] * w[2] + q[3 * c + 2] * (1 - w[1] - w[2])) / w[2]
      for (k = 1; k <= columns; k++) {
        line = name[k]
        for (c = 0; c < 3; c++)
          line = line " " (q[3 * c] * sum[k, 0] + q[3 * c + 1] * sum[k, 1] + q[3 * c + 2] * sum[k, 2]) / luminance / scale[c]
        print line
      }
    }' part=observer "$spectra/cmf/cie1931.spd" part=curve -
}

# farthest: of such lines the largest distance from the seven colours.
farthest() {
  awk '
    BEGIN { split("white 111 cyan 011 magenta 101 yellow 110 red 100 green 010 blue 001", w)
      for (i = 1; i < 14; i += 2) wanted[w[i]] = w[i + 1] }
    { for (c = 1; c <= 3; c++) print $(c + 1) - substr(wanted[$1], c, 1) }' | largest
}

run 'specconvert -g 380:719:1 smits >bins.spd'
check 'ten bins under equal energy: largest distance of the seven from their RGB' \
  "$(rgb_of 0.3333333333,0.3333333333 <bins.spd | farthest)" at-most 0.001

# The same numbers as points of an even grid, as they are often stored.
awk '/^#/ { print } /^[0-9]/ && n++ % 2 == 0 { $1 = 380 + 340 / 9 * i++; print }' "$smits" >points.spd
specconvert -g 380:719:1 points.spd >between.spd
check 'ten points, linear between them' "$(rgb_of 0.3333333333,0.3333333333 <between.spd | farthest)" within 0.09 0.01

read -r _ red green blue < <(rgb_of 0.3127,0.329 <bins.spd)
check 'white, seen with the white D65: red' "$red" within 1.205 0.0015
check 'green' "$green" within 0.948 0.0015
check 'blue' "$blue" within 0.909 0.0015
check 'the largest value, of red' "$(column "$smits" red | sort -g | tail -n 1)" within 1.0149 0.00005
check 'white is between 0.999 and 1: its largest distance from 1' \
  "$(column "$smits" white | awk '{ print 1 - $1 }' | largest)" at-most 0.001
check 'red, green and blue added up: the largest distance from 1' \
  "$(column sum.spd sum | awk '{ print 1 - $1 }' | largest)" within 0.126 0.0005

# A picture of the three primaries, and of white, goes through the tool.
run 'specconvert --from-rgb smits rgb:1,0,0 -g 380:715:5 >red.spd
specconvert --from-rgb smits rgb:1,1,1 -g 380:715:5 >white.spd'
check 'as a reflectance red is at most 1' "$(column red.spd R | largest)" at-most 1
check 'mean of red over 380 to 715 nm: as much as the bins hold' \
  "$(column red.spd R | awk '{ sum += $1 } END { print sum / NR }')" within \
  "$(awk '/^[0-9]/ && $1 < 716 { sum += $2 > 1 ? 1 : $2; n++ } END { print sum / n }' <(awk '/^[0-9]/ { print $1, $6 }' bins.spd))" 0.002
