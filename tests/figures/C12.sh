# shellcheck shell=bash
title 'An atlas of spectra, and curves read off a printed plot'
from 'W 4.2, fig. 19 and 24, and 5.1 (Schiffner 2008)'
note 'Curves lie in a picture as a program on a graphics card reads them: a curve on each line, in each texel values at four wavelengths, from 324 to 835 nm in 128 texels; then the colour, so that it need not be computed again. An index of refraction takes two lines, n and k.'

patches=$(cd "$spectra/reflectance" && printf '%s\n' colorchecker/*.spd)
run "specconvert --atlas --extrapolate constant -o atlas.exr $(xargs <<<"${patches//.spd/}") D65 F2 Au TiO2"
display >display.spd
picture atlas.png 'spec2rgb --name-map R=650nm,G=550nm,B=450nm --observer display.spd atlas.exr -o atlas.png' \
  '24 patches of a ColorChecker, light, and metals: 128 texels of samples, shown as red, green and blue, and one of colour'

# Each line is the curve itself: half a last place of the 24 bits of a float, and as much again for the
# shortest decimal that is the same float.
for name in 15-red 13-blue D65 F2 Au TiO2; do
  specconvert --row "$name" atlas.exr >"$name.spd"
  specconvert -q --grid 324:835:1 --extrapolate constant "$name" >wanted.txt
  grep '^[0-9]' "$name.spd" | paste -d ' ' - <(grep '^[0-9]' wanted.txt) | awk '
    { n = NF / 2; if ($1 != $(n + 1)) exit 1
      for (i = 2; i <= n; i++) { w = $(n + i); print (w ? $i / w - 1 : $i) } }' >errors.txt
  check "$name: values" "$(wc -l <errors.txt)" equals $((512 * ($(grep '^[0-9]' wanted.txt | head -n 1 | wc -w) - 1)))
  check "$name: largest relative difference to its curve" "$(largest <errors.txt)" at-most 1.2e-7
  check "$name: what is known of it" "$(grep -c '^#' "$name.spd") $(diff <(grep '^#' "$name.spd") <(grep '^#' wanted.txt) && echo same)" \
    equals "$(grep -c '^#' wanted.txt) same"
done
run 'specconvert --atlas --no-history -o again.exr 15-red.spd 13-blue.spd D65.spd F2.spd Au.spd TiO2.spd
specconvert --atlas --no-history --extrapolate constant -o once.exr 15-red 13-blue D65 F2 Au TiO2
cmp again.exr once.exr && echo the same bytes'
check 'taken out and packed again' "$printed" equals 'the same bytes'

# W, code 9: the texel is (nm - 324) / 4, the component the rest.
run 'layers --print 56,14 atlas.exr'
check '15-red: 548 to 551 nm are R, G, B, A of texel 56' \
  "$(awk '{ of[$1] = $2 } END { print of["R"], of["G"], of["B"], of["A"] }' <<<"$printed" | tr ' ' '\n' |
    paste -d ' ' - <(for nm in 548 549 550 551; do value 15-red.spd $nm R; done) | awk '{ print $1 - $2 }' | largest)" at-most 1e-8

# The colours at the end of the lines are those of spec2rgb.
for line in 14 12 24 25; do
  name=$(sed -n "$((line + 1))p" <<<"$(printf '%s\n' "${patches//.spd/}" D65 F2)")
  specconvert -q --patches 1x1 --grid 324:835:1 --extrapolate constant "$name" -o one.exr
  spec2rgb one.exr -o rgb.exr
  paste -d ' ' <(layers --print 128,$line atlas.exr | grep '^[RGB]') <(layers --print 0,0 rgb.exr) |
    awk '$1 != $3 { exit 1 } { print ($4 ? $2 / $4 - 1 : $2) }' >errors.txt
  check "${name#*/}: its colour, largest relative difference to that of spec2rgb" \
    "$([ "$(wc -l <errors.txt)" = 3 ] && largest <errors.txt)" at-most 2e-6
done
check 'Au: n and k have no colour' "$(layers --print 128,26 atlas.exr | awk '{ print $2 }' | largest)" at-most 0

# A plot as it is printed, with a second curve that crosses the first.
plot plot.ppm 380:780 0:1 0.2 '255 0 0,30 60 200' <(specconvert 15-red) <(specconvert 13-blue)
picture plot.png 'spec2rgb --name-map R=650nm,G=550nm,B=450nm --observer display.spd plot.ppm -o plot.png' \
  'a plot of two reflectances, 480 x 270 pixels'
run "specconvert --from-plot '40,249=380nm,0 469,10=780nm,1' --ink '#ff0000' plot.png -o red.spd
specconvert --from-plot '40,249=380nm,0 469,10=780nm,1' --ink '#1e3cc8' plot.png -o blue.spd
specconvert --grid 400:700:50 red.spd"
for name in red:15-red blue:13-blue; do
  specconvert --grid 382:778:2 "${name%:*}.spd" | grep '^[0-9]' >read.txt
  specconvert --grid 382:778:2 "${name#*:}" | grep '^[0-9]' | paste -d ' ' read.txt - | awk '{ print $2 - $4 }' >errors.txt
  check "${name%:*} curve: wavelengths read" "$(wc -l <errors.txt)" equals 199
  check "${name%:*} curve, read - plotted: largest, of an axis from 0 to 1" "$(largest <errors.txt)" at-most 0.01
  check "${name%:*} curve: root mean square" "$(awk '{ s += $1 * $1 } END { print sqrt(s / NR) }' errors.txt)" at-most 0.002
done
