# shellcheck shell=bash disable=SC2016
title 'From RGB to spectra and back'
from 'T 2.6.2 (Vangorp & Yskout 2005, after Smits 1999 and Sun et al. 1999); P 4.6.6 (after Jakob & Hanika 2019); Mallett & Yuksel 2019'
note 'A picture of 16³ colours becomes reflectances, or light after Sun, and a picture again. Under D65 all models show the same picture. Under the light of a bulb they part: they are metamers.'

# Each square has one value of blue; red goes to the right, green down.
awk 'BEGIN {
  print "P3 64 64 255"
  for (y = 0; y < 64; y++) for (x = 0; x < 64; x++)
    print x % 16 * 17, y % 16 * 17, (int(x / 16) + 4 * int(y / 16)) * 17
}' >colours.ppm

picture colours.png 'specconvert --from-rgb sigmoid colours.ppm -o sigmoid.exr
spec2rgb sigmoid.exr -o colours.png' 'sigmoids under D65'
picture sigmoid-A.png 'spec2rgb --illuminant A --adapt bradford sigmoid.exr -o sigmoid-A.png' 'sigmoids under a bulb'
picture basis-A.png 'specconvert --from-rgb basis colours.ppm -o basis.exr
spec2rgb --illuminant A --adapt bradford basis.exr -o basis-A.png' 'Mallett and Yuksel'\''s basis under a bulb'
picture smits-A.png 'specconvert --from-rgb smits colours.ppm -o smits.exr
spec2rgb --illuminant A --adapt bradford smits.exr -o smits-A.png' 'Smits'\'' steps under a bulb'
picture sun.png 'specconvert --from-rgb sun -g 360:830:5 colours.ppm -o sun.exr
spec2rgb sun.exr -o sun.png' 'Sun'\''s Gaussians, which are light'

# expected: "L* a* b*" of the colours, from the standard's matrix of the primaries and the white.
expected() {
  awk '
    function f(t) { return t > 216 / 24389 ? exp(log(t) / 3) : (24389 / 27 * t + 16) / 116 }
    function decode(v) { return v <= 0.04045 ? v / 12.92 : exp(2.4 * log((v + 0.055) / 1.055)) }
    NR > 1 {
      r = decode($1 / 255); g = decode($2 / 255); b = decode($3 / 255)
      x = (0.4123907993 * r + 0.3575843394 * g + 0.1804807884 * b) / 0.9504559271
      y = 0.2126390059 * r + 0.7151686788 * g + 0.0721923154 * b
      z = (0.0193308187 * r + 0.1191947798 * g + 0.9505321522 * b) / 1.0890577508
      print 116 * f(y) - 16, 500 * (f(x) - f(y)), 200 * (f(y) - f(z))
    }' colours.ppm
}

# ciede2000: the differences of "L* a* b* L* a* b*" on each line (Sharma, Wu & Dalal 2005).
ciede2000() {
  awk '
    function hue(b, a, h) { h = atan2(b, a); return h < 0 ? h + 2 * pi : h }
    function seventh(c) { c = c ^ 7; return sqrt(c / (c + 25 ^ 7)) }
    BEGIN { pi = atan2(0, -1); degree = pi / 180 }
    {
      stretch = 1.5 - 0.5 * seventh((sqrt($2 * $2 + $3 * $3) + sqrt($5 * $5 + $6 * $6)) / 2)
      a1 = $2 * stretch; a2 = $5 * stretch
      c1 = sqrt(a1 * a1 + $3 * $3); c2 = sqrt(a2 * a2 + $6 * $6)
      h1 = hue($3, a1); h2 = hue($6, a2)
      turn = h2 - h1
      if (turn > pi) turn -= 2 * pi
      if (turn < -pi) turn += 2 * pi
      h = (h1 + h2) / 2
      if (h1 - h2 > pi || h2 - h1 > pi) h += h < pi ? pi : -pi
      if (c1 * c2 == 0) { turn = 0; h = h1 + h2 }
      l = ($1 + $4) / 2; c = (c1 + c2) / 2
      t = 1 - 0.17 * cos(h - 30 * degree) + 0.24 * cos(2 * h) + 0.32 * cos(3 * h + 6 * degree) - 0.2 * cos(4 * h - 63 * degree)
      around = 30 * degree * exp(-((h / degree - 275) / 25) ^ 2)
      sl = 1 + 0.015 * (l - 50) ^ 2 / sqrt(20 + (l - 50) ^ 2)
      dl = ($4 - $1) / sl
      dc = (c2 - c1) / (1 + 0.045 * c)
      dh = 2 * sqrt(c1 * c2) * sin(turn / 2) / (1 + 0.015 * c * t)
      off = dl * dl + dc * dc + dh * dh - sin(2 * around) * 2 * seventh(c) * dc * dh
      print (off > 0 ? sqrt(off) : 0)
    }'
}

# Pairs 1 and 7 of the test data of that paper.
check 'CIEDE2000 of the paper'\''s pairs 1 and 7' \
  "$(printf '%s\n' '50 2.6772 -79.7751 50 0 -82.7485' '50 0 0 50 -1 2' | ciede2000 | awk '{ printf "%s%.4f", s, $1; s = " " }')" \
  equals '2.0425 2.3669'

# round_trip FILE: the largest and the mean difference.
round_trip() {
  local y
  for y in 0 16 32 48; do lab "$1" 0,$y,64,$((y + 16)) D65; done | cut -d ' ' -f 3- | paste -d ' ' <(expected) - | ciede2000 |
    awk '{ sum += $1; if ($1 > most) most = $1 } END { if (NR == 4096) printf "%.3g %.3g\n", most, sum / NR }'
}

# With sanitizers the table of sigmoids has half the side, and four times the error.
coarser=1
[[ $build != */san-* ]] || coarser=4

# Bands of 5 nm, taken as values at their middles, add 0.1 to what the models leave.
while read -r model most mean name; do
  read -r largest_off mean_off < <(round_trip "$model.exr")
  check "$name: largest CIEDE2000 of 16³ colours" "$largest_off" at-most "$most"
  check "$name: mean" "$mean_off" at-most "$mean"
done <<END
sigmoid $(awk "BEGIN { print 0.2 * $coarser, 0.04 * $coarser }") sigmoids
basis 0.2 0.1 Mallett and Yuksel
smits 2.2 1.1 Smits, clamped to 1
sun 4 0.25 Sun, whose Gaussians miss deep blues
END

for model in sigmoid basis smits; do
  read -r low high < <(for y in 0 16 32 48; do
    specconvert --crop 0,$y,64,$((y + 16)) "$model.exr" | specconvert -f spd
  done | awk '
    /^[0-9]/ { for (i = 2; i <= NF; i++) { if (!n++ || $i < low) low = $i; if ($i > high) high = $i } }
    END { print low, high }')
  check "$model: the least reflectance" "$low" at-least 0
  check "$model: the largest" "$high" at-most 1
done
