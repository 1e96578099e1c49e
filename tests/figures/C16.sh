# shellcheck shell=bash disable=SC2016
title 'HSV, HSL, YUV and CMYK'
from 'W 2.1.3 (Schiffner 2008); Smith 1978; CSS Color Module; ITU-R BT.470-6'
note 'Colours that are named in other models than RGB become spectra, and are seen again in daylight. Their components are what spec2rgb finds in the spectra.'

# plane NAME FORMAT TOP BOTTOM: lines of colours, hue to the right by 10 degrees; FORMAT has the
# hue and then what changes downwards, from TOP to BOTTOM in 12 steps.
plane() {
  awk -v form="$2" -v top="$3" -v bottom="$4" 'BEGIN {
    for (line = 0; line < 12; line++) for (hue = 0; hue < 360; hue += 10)
      printf form "\n", hue, top + (bottom - top) * line / 11
  }' >"$1.txt"
}
plane values 'hsv:%d,1,%.4f' 1 0
plane saturations 'hsv:%d,%.4f,1' 1 0
plane lightnesses 'hsl:%d,1,%.4f' 1 0

for name in values saturations lightnesses; do
  case $name in
  values) caption='HSV: hue to the right, 0 to 350°; value 1 to 0 downwards, saturation 1' ;;
  saturations) caption='HSV: saturation 1 to 0 downwards, value 1' ;;
  lightnesses) caption='HSL: lightness 1 to 0 downwards, saturation 1' ;;
  esac
  picture $name.png "specconvert --from-rgb sigmoid --grid 380:780:2 --patches 36x12 --patch 9 \$(cat $name.txt) -o $name.exr
spec2rgb $name.exr -o $name.png" "$caption"
done

# The codes of the pictures against the definitions, in the form of CSS Color 4: what a component of
# RGB loses by saturation is a trapezium over the hue.
for name in values saturations lightnesses; do
  specconvert --downsample 9 $name.exr | spec2rgb -f ppm | tail -c $((36 * 12 * 3)) | od -A n -v -t u1 -w3 |
    paste -d ' ' - <(tr ':,' '  ' <$name.txt) | awk '
      function least(a, b) { return a < b ? a : b }
      function most(a, b) { return a > b ? a : b }
      function hsv(n, k) { k = (n + $5 / 60) % 6; return $7 - $7 * $6 * most(0, least(least(k, 4 - k), 1)) }
      function hsl(n, k) { k = (n + $5 / 30) % 12; return $7 - $6 * least($7, 1 - $7) * most(-1, least(least(k - 3, 9 - k), 1)) }
      {
        if ($4 == "hsv") { r = hsv(5); g = hsv(3); b = hsv(1) } else { r = hsl(0); g = hsl(8); b = hsl(4) }
        print $1 - 255 * r, $2 - 255 * g, $3 - 255 * b
      }' >$name.errors
  check "$name: colours" "$(wc -l <$name.errors)" equals 432
  # Half a code is rounding; bands of 2 nm meet a colour to a CIEDE2000 of 0.05.
  check "$name: codes of the picture, largest difference to the definition" "$(largest <$name.errors)" at-most 1.5
done

# There and back through a spectrum. The hue of dark and pale colours is as uncertain as their codes.
run 'specconvert --from-rgb sigmoid --grid 380:780:1 --patches 4x1 hsv:30,.8,.9 hsv:150,.5,.6 hsv:210,.3,.8 hsv:330,.7,.7 -o four.exr
for model in hsv hsl yuv cmyk; do spec2rgb --model $model four.exr -o $model.exr; done
for x in 0 1 2 3; do layers --print $x,0 hsv.exr; done'
check 'HSV from spectra: hue [degrees], largest error' \
  "$(awk '$1 == "H" { print $2 }' <<<"$printed" | paste -d ' ' - <(printf '%s\n' 30 150 210 330) | awk '{ print $1 - $2 }' | largest)" at-most 0.1
check 'HSV from spectra: saturation' \
  "$(awk '$1 == "S" { print $2 }' <<<"$printed" | paste -d ' ' - <(printf '%s\n' .8 .5 .3 .7) | awk '{ print $1 - $2 }' | largest)" at-most 0.001
check 'HSV from spectra: value' \
  "$(awk '$1 == "V" { print $2 }' <<<"$printed" | paste -d ' ' - <(printf '%s\n' .9 .6 .8 .7) | awk '{ print $1 - $2 }' | largest)" at-most 0.001
# component MODEL X: the components of a pixel in the order of the model's name, with commas.
component() {
  local letters
  letters=$(tr '[:lower:]' '[:upper:]' <<<"$1" | sed 's/./& /g')
  layers --print "$2,0" "$1.exr" | awk -v letters="$letters" '
    { of[$1] = $2 }
    END { n = split(letters, letter, " "); for (i = 1; i <= n; i++) printf "%s%.9f", (i > 1 ? "," : ""), of[letter[i]] }'
}
for model in hsv hsl yuv cmyk; do
  for x in 0 1 2 3; do
    specconvert --from-rgb basis --grid 550:550:1 "$model:$(component $model $x)" | sed -n 's/# title: RGB //p'
  done | xargs >$model.back
done
for model in hsl yuv cmyk; do
  check "the same colours by $model: RGB, largest difference to those by hsv" \
    "$(paste -d ' ' hsv.back $model.back | awk '{ for (i = 1; i <= 12; i++) print $i - $(i + 12) }' | largest)" at-most 2e-6
done
