# What the rows of the gallery measure with: curves and pixels as numbers on standard output.
# What cannot be measured is told on standard error, and nothing is printed: a check of nothing
# fails. Colours are computed here anew, from the tables in spectra/ alone, so that they can be
# compared with what spec2rgb makes of the same pixel.
# shellcheck shell=bash

spectra=$(cd "${BASH_SOURCE[0]%/*}/../../spectra" && pwd)

# column FILE NAME: a column of a curve's file (spd(5)), a value on each line.
column() {
  awk -v name="$2" '
    /^# columns:/ { for (i = 3; i <= NF; i++) if ($i == name) at = i - 2 }
    /^[0-9]/ && at { print $at; found = 1 }
    END { if (!found) { print FILENAME ": no column " name | "cat >&2"; exit 1 } }' "$1"
}

# value FILE NM NAME: what a column says at a wavelength, which must be there.
value() {
  awk -v nm="$2" -v name="$3" '
    /^# columns:/ { for (i = 3; i <= NF; i++) if ($i == name) at = i - 2 }
    /^[0-9]/ && at && $1 - nm < 1e-9 * nm && nm - $1 < 1e-9 * nm { print $at; found = 1 }
    END { if (!found) { print FILENAME ": no " name " at " nm " nm" | "cat >&2"; exit 1 } }' "$1"
}

# window X,Y: the crop of one pixel.
window() {
  echo "$1,$((${1%,*} + 1)),$((${1#*,} + 1))"
}

# pixel FILE X,Y: the spectrum of a pixel, "nm value" on each line.
pixel() {
  specconvert --crop "$(window "$2")" "$1" | specconvert -f spd | grep '^[0-9]'
}

# rgb FILE X,Y [OPTION...]: the codes that spec2rgb with these options gives a pixel.
rgb() {
  specconvert --crop "$(window "$2")" "$1" | spec2rgb "${@:3}" -f ppm | tail -c 3 | od -A n -t u1 | xargs
}

# xyz FILE X0,Y0,X1,Y1 ILLUMINANT: "x y X Y Z Xn Yn Zn" for each pixel of a window, by rows: the
# tristimulus values of CIE 15:2018 for the observer of 1931, by 1 nm, and those of the white.
# Reflectance and transmittance are lit by the illuminant; light is as it is, and the white is
# the illuminant's colour at a radiance for which Y = 1 in spec2rgb(1).
xyz() {
  local corner=${2%,*,*}
  specconvert --crop "$2" "$1" | specconvert -f spd |
    awk -v left="${corner%,*}" -v top="${corner#*,}" '
      # The curve at[], of[] of n points, linear, nothing outside.
      function linear(at, of, n, nm, i) {
        if (nm < at[1] - 1e-6 || nm > at[n] + 1e-6) return 0
        for (i = 2; i < n && at[i] < nm; i++);
        if (n == 1) return of[1]
        return of[i - 1] + (of[i] - of[i - 1]) * (nm - at[i - 1]) / (at[i] - at[i - 1])
      }
      part == "image" && /^# quantity: .*(radiance|power)/ { emits = 1 }
      part == "image" && /^# columns:/ { for (i = 4; i <= NF; i++) name[i - 3] = $i }
      !/^[0-9]/ { next }
      part == "observer" { nm[++steps] = $1; x[steps] = $2; y[steps] = $3; z[steps] = $4 }
      part == "light" { light_nm[++lights] = $1; light[lights] = $2 }
      part == "image" {
        band[++bands] = $1
        pixels = NF - 1
        for (i = 1; i <= pixels; i++) sample[i, bands] = $(i + 1)
      }
      END {
        if (!steps || !lights || bands < 2) exit 1
        b = 1
        for (s = 1; s <= steps; s++) {
          power = linear(light_nm, light, lights, nm[s])
          xn += power * x[s]; yn += power * y[s]; zn += power * z[s]
          equal += y[s]
          if (emits) power = 1
          if (nm[s] < band[1] - 1e-6 || nm[s] > band[bands] + 1e-6) continue
          while (b < bands - 1 && band[b + 1] < nm[s]) b++
          part = (nm[s] - band[b]) / (band[b + 1] - band[b])
          for (k = 0; k < 2; k++) {
            share = power * (k ? part : 1 - part)
            wx[b + k] += share * x[s]; wy[b + k] += share * y[s]; wz[b + k] += share * z[s]
          }
        }
        scale = emits ? equal : yn
        for (i = 1; i <= pixels; i++) {
          X = Y = Z = 0
          for (b = 1; b <= bands; b++) {
            X += wx[b] * sample[i, b]; Y += wy[b] * sample[i, b]; Z += wz[b] * sample[i, b]
          }
          split(substr(name[i], 2), place, "y")
          printf "%d %d %.17g %.17g %.17g %.17g 1 %.17g\n", left + place[1], top + place[2],
            X / scale, Y / scale, Z / scale, xn / yn, zn / yn
        }
      }' part=observer "$spectra/cmf/cie1931.spd" part=light "$spectra/illuminants/$3.spd" part=image -
}

# lab FILE X0,Y0,X1,Y1 ILLUMINANT: "x y L* a* b*" for each pixel of a window (CIE 15:2018, 8.2.1).
lab() {
  xyz "$@" | awk '
    function f(t) {
      return t > 216 / 24389 ? exp(log(t) / 3) : (24389 / 27 * t + 16) / 116
    }
    {
      fx = f($3 / $6); fy = f($4 / $7); fz = f($5 / $8)
      printf "%d %d %.9f %.9f %.9f\n", $1, $2, 116 * fy - 16, 500 * (fx - fy), 200 * (fy - fz)
    }'
}

# hues FILE X0,Y0,X1,Y1 ILLUMINANT: "x y hue chroma lightness" for each pixel of a window, in
# CIELAB; the hue is in degrees, 0 to 360.
hues() {
  lab "$@" | awk '{
    hue = atan2($5, $4) * 45 / atan2(1, 1)
    printf "%d %d %.6f %.6f %.6f\n", $1, $2, hue < 0 ? hue + 360 : hue, sqrt($4 ^ 2 + $5 ^ 2), $3
  }'
}

# hue FILE X,Y ILLUMINANT: "hue chroma lightness" of one pixel.
hue() {
  hues "$1" "$(window "$2")" "$3" | cut -d ' ' -f 3-
}

# codes FILE X,Y ILLUMINANT: the codes of sRGB (IEC 61966-2-1:1999) of 8 bits for one pixel. The
# matrix follows from the primaries and the white; it is the standard's to its four digits.
codes() {
  xyz "$1" "$(window "$2")" "$3" | awk '
    function code(v) {
      v = v <= 0.0031308 ? 12.92 * v : 1.055 * exp(log(v) / 2.4) - 0.055
      return v <= 0 ? 0 : v >= 1 ? 255 : int(255 * v + 0.5)
    }
    {
      print code( 3.2409699419 * $3 - 1.5373831776 * $4 - 0.4986107603 * $5),
        code(-0.9692436363 * $3 + 1.8759675015 * $4 + 0.0415550574 * $5),
        code( 0.0556300797 * $3 - 0.2039769589 * $4 + 1.0569715142 * $5)
    }'
}

# largest: of the numbers on standard input the largest magnitude; nothing of no numbers.
largest() {
  awk '{ for (i = 1; i <= NF; i++) {
      v = $i < 0 ? -$i : $i + 0
      if ($i !~ /^[-+]?[0-9.]/) bad = 1
      if (!n++ || v > most) most = v
    } }
    END { if (n && !bad) printf "%.3g\n", most }'
}

# transfer POLARISATION DEGREES STACK: "nm R T" for each wavelength on standard input, computed
# beside the suite; transfer.awk has the STACK, such as '1 0 | 2.4 0.1 57 | 1.52 0'.
transfer() {
  awk -v polarisation="$1" -v angle="$2" -v stack="$3" -f "${spectra%/*}/tests/figures/transfer.awk"
}

# display: an observer (spd(5)) who sees a display's three colours, those of sRGB: bands at 650, 550
# and 450 nm are red, green and blue to spec2rgb, and 1 in all of them is white.
display() {
  awk 'BEGIN {
    print "# title: the primaries of sRGB, one in each of three bands"
    print "# source: IEC 61966-2-1:1999"
    print "# columns: wavelength_nm x y z"
    of[450] = "0.1804807884 0.0721923154 0.9505321522"
    of[550] = "0.3575843394 0.7151686788 0.1191947798"
    of[650] = "0.4123907993 0.2126390059 0.0193308187"
    for (nm = 400; nm <= 700; nm += 50) print nm, nm in of ? of[nm] : "0 0 0"
  }'
}

# plot OUT LOW:HIGH BOTTOM:TOP STEP COLOURS CURVE...: draws curves into OUT, a PPM of 480 x 270 pixels, by
# draw.awk: 40,249 is LOW nm and BOTTOM, 469,10 is HIGH nm and TOP. COLOURS: "r g b,r g b".
plot() {
  awk -v low="${2%:*}" -v high="${2#*:}" -v bottom="${3%:*}" -v top="${3#*:}" -v step="$4" -v step_nm=50 \
    -v width=480 -v height=270 -v colours="$5" -f "${spectra%/*}/tests/figures/draw.awk" "${@:6}" >"$1"
}
