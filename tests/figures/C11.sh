# shellcheck shell=bash
title "An observer's functions as the colours of a strip"
from 'W 4.2, figure 20 (Schiffner 2008)'
note "A program that adds up wavelengths, such as a shader, looks x̄, ȳ and z̄ up in a picture: they are red, green and blue of one column per nanometre. Bytes hold 0 to 1, so the functions are divided by the greatest value of all, or each by its own, which loses less; floats hold them as they are. The colours mean nothing to the eye."

picture global.png 'specconvert cie1931 --strip 48 --scaling global -o global.png' '360 to 830 nm, all by the greatest of z̄'
picture channel.png 'specconvert cie1931 --strip 48 --scaling channel -o channel.png' 'each by its own greatest'
run 'specconvert cie1931 --strip 1 -o float.exr
specconvert cie1931 --strip 1 --scaling global -o global.ppm
specconvert cie1931 --strip 1 --scaling channel -o channel.ppm'

grep '^[0-9]' "$spectra/cmf/cie1931.spd" >functions
check 'wavelengths' "$(wc -l <functions)" equals 471
# The bytes of a PPM, three a line, behind its header.
bytes() {
  tail -c $((3 * 471)) "$1" | od -A n -v -t u1 -w3
}
# off KIND FILE: for each value, how far its byte is off, over the greatest value over 510.
off() {
  bytes "$2" | paste -d ' ' functions - | awk -v kind="$1" '
    { for (i = 1; i <= 3; i++) { v[NR, i] = $(i + 1); b[NR, i] = $(i + 4)
        if ($(i + 1) > own[i]) own[i] = $(i + 1); if ($(i + 1) > all) all = $(i + 1) } }
    END { for (n = 1; n <= NR; n++) for (i = 1; i <= 3; i++) {
        most = kind == "global" ? all : own[i]
        print (b[n, i] / 255 * most - v[n, i]) / (most / 510) } }'
}
# beyond KIND FILE: how many values are off by more, but for the last digits of these sums.
beyond() {
  off "$@" | awk '$1 > 1 + 1e-9 || $1 < -1 - 1e-9 { n++ } END { print n + 0 }'
}
check 'bytes, scaled at once: values off by more than max/510' "$(beyond global global.ppm)" equals 0
check 'bytes, scaled by channel: values off by more than its max/510' "$(beyond channel channel.ppm)" equals 0
check 'the largest error, over max/510' "$(off global global.ppm | largest)" at-least 0.9
check 'greatest byte of each channel, scaled at once' \
  "$(bytes global.ppm | awk '{ for (i = 1; i <= 3; i++) if ($i > m[i]) m[i] = $i } END { print m[1], m[2], m[3] }')" equals \
  "$(awk '{ for (i = 2; i <= 4; i++) { if ($i > m[i]) m[i] = $i; if ($i > all) all = $i } }
    END { print int(255 * m[2] / all + .5), int(255 * m[3] / all + .5), int(255 * m[4] / all + .5) }' functions)"
check 'the same, scaled by channel' \
  "$(bytes channel.ppm | awk '{ for (i = 1; i <= 3; i++) if ($i > m[i]) m[i] = $i } END { print m[1], m[2], m[3] }')" equals '255 255 255'

# All floats, by the bits: the nearest to the value is within half a unit in its last place.
for ((x = 0; x < 471; x++)); do
  layers --print $x,0 float.exr | awk '{ v[$1] = $2 } END { print v["R"], v["G"], v["B"] }'
done | paste -d ' ' functions - >floats
check 'floats: values' "$(awk '{ n += NF - 4 } END { print n }' floats)" equals 1413
check 'floats: largest difference, relative (2^-24 for the float, 1e-9 for its nine digits)' \
  "$(awk '{ for (i = 2; i <= 4; i++) print $i ? $(i + 3) / $i - 1 : $(i + 3) }' floats | largest)" at-most 6.1e-8
# What the strips are for: the sums over a spectrum, here of illuminant A, by each of them.
white() { # white FILE: "x y" from lines "nm x y z" and the light
  awk 'FNR == NR { if (/^[0-9]/) s[$1] = $2; next } $1 in s { for (i = 2; i <= 4; i++) t[i] += s[$1] * $i }
    END { u = t[2] + t[3] + t[4]; printf "%.6f %.6f\n", t[2] / u, t[3] / u }' "$spectra/illuminants/A.spd" "$1"
}
greatest=$(awk '{ for (i = 2; i <= 4; i++) { if ($i > m[i]) m[i] = $i; if ($i > all) all = $i } } END { print m[2], m[3], m[4], all }' functions)
read -r mx my mz all <<<"$greatest"
bytes channel.ppm | paste -d ' ' functions - | awk -v x="$mx" -v y="$my" -v z="$mz" '{ print $1, $5 / 255 * x, $6 / 255 * y, $7 / 255 * z }' >by-channel
bytes global.ppm | paste -d ' ' functions - | awk -v a="$all" '{ print $1, $5 / 255 * a, $6 / 255 * a, $7 / 255 * a }' >by-all
cut -d ' ' -f 1,5-7 floats >by-float
read -r x y <<<"$(white functions)"
apart() {
  white "$1" | awk -v x="$x" -v y="$y" '{ printf "%.3g\n", sqrt(($1 - x) ^ 2 + ($2 - y) ^ 2) }'
}
check 'chromaticity of illuminant A by floats: difference' "$(apart by-float)" at-most 1e-6
check 'the same by bytes, scaled by channel' "$(apart by-channel)" at-most 0.001
check 'the same by bytes, scaled at once' "$(apart by-all)" at-most 0.001
