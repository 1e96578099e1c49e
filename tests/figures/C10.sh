# shellcheck shell=bash disable=SC2016
title 'Fewer wavelengths: steps, and levels of detail'
from 'W 4.3, codes 5 and 6, figure 22, and 4.6 (Schiffner 2008)'
note 'Steps: of wavelengths 1 nm apart every n-th is taken, for n of them. From 450 to 650 nm even a flat spectrum changes its colour, as the last one stands for some beyond the end, or some before it are left. From 360 to 830 nm, where the eye sees next to nothing at the ends, 32 nm are not to be told from 1.'
note 'Levels of detail: 513 wavelengths are halved again and again, and between the ends of the halves spectra are straight lines. A flat spectrum stays what it is; fringes that fall between become others, so that films too thick for colours get some. So a level is chosen by what it costs, of each image anew.'

cp "$here/steps.pbrt" .
run 'specrender --grid 450:650:1 steps.pbrt -o ball.exr'
for step in 1 8 16 32 64 128; do
  picture ball-$step.png "spec2rgb -q --observer 1964 --step $step ball.exr -o ball-$step.png" \
    "a white ball in light of 450 to 650 nm, every $step nm"
done

# A flat spectrum.
printf '%s\n' '# quantity: radiance' '360 1' '830 1' >flat.spd
run 'specconvert --grid 360:830:1 --patches 1x1 flat.spd -o all.exr
specconvert --grid 450:650:1 --patches 1x1 flat.spd -o middle.exr
for image in all middle; do for nm in 8 16 32 64 128; do
  spec2rgb -q --observer 1964 --step $nm --error $image.exr -o flat.png 2>&1 | grep de76-max
done; done'
awk '{ print $2 }' <<<"$printed" >steps.txt
# The same from the table alone: sums of every n-th row times n, beside the white of all.
for range in 360:830 450:650; do
  awk -v low=${range%:*} -v high=${range#*:} '
    function f(t) { return t > 216 / 24389 ? exp(log(t) / 3) : (24389 / 27 * t + 16) / 116 }
    function lab(X, Y, Z) { l = 116 * f(Y) - 16; a = 500 * (f(X) - f(Y)); b = 200 * (f(Y) - f(Z)) }
    /^[0-9]/ { for (c = 0; c < 3; c++) { bar[$1 + 0, c] = $(c + 2); white[c] += $(c + 2) } }
    function sums(step, nm, c) {
      for (c = 0; c < 3; c++) s[c] = 0
      for (nm = low; nm <= high; nm += step) for (c = 0; c < 3; c++) s[c] += step * bar[nm, c]
      lab(s[0] / white[0], s[1] / white[1], s[2] / white[2])
    }
    END {
      sums(1); l1 = l; a1 = a; b1 = b
      for (step = 8; step <= 128; step *= 2) {
        sums(step)
        printf "%.9f\n", sqrt((l - l1) ^ 2 + (a - a1) ^ 2 + (b - b1) ^ 2)
      }
    }' "$spectra/cmf/cie1964.spd"
done >table.txt
check 'steps of a flat spectrum: largest departure of ΔE*ab from sums of the table' \
  "$(paste -d ' ' steps.txt table.txt | awk 'NF == 2 { print $1 - $2; n++ } END { if (n != 10) print "none" }' | largest)" at-most 5e-4
at=0
while read -r range nm wanted tolerance; do
  at=$((at + 1))
  check "$range nm every $nm: ΔE*ab from 1 nm" "$(sed -n ${at}p steps.txt)" within "$wanted" "$tolerance"
done <<'END'
360..830 8 0.01 0.005
360..830 16 0.17 0.005
360..830 32 0.24 0.005
360..830 64 4.2 0.05
360..830 128 46 0.5
450..650 8 6.3 0.05
450..650 16 13 0.5
450..650 32 25 0.5
450..650 64 53 0.5
450..650 128 123 0.5
END

# Levels: a card, and soap films up to 5 µm.
patches=$(cd "$spectra/reflectance" && printf '%s\n' colorchecker/*.spd)
run "specconvert -q --extrapolate constant --grid 324:836:1 --patches 6x4 --patch 4 $(xargs <<<"${patches//.spd/}") -o card.exr
specfilm --stack 'air | 1.33 * | air' --chart 'thickness 0nm..5um' --grid 324:836:1 --size 480x24 -o films.exr"
display >display.spd
# strips LEVEL...: the films at some levels, one below the other.
strips() {
  local level
  printf 'P6\n480 %d\n255\n' $((24 * $#))
  for level; do
    spec2rgb -q -e 3 --lod "$level" -f ppm films.exr | tail -c $((480 * 24 * 3))
  done
}
strips 9 7 6 5 4 3 >strips.ppm
picture strips.png 'spec2rgb --name-map R=650nm,G=550nm,B=450nm --observer display.spd strips.ppm -o strips.png' \
  'soap films, 0 to 5 µm to the right: by 513 wavelengths, and at levels 7, 6, 5, 4 and 3, by 129, 65, 33, 17 and 9'
picture card.png 'spec2rgb -q --lod 3 card.exr -o card.png' 'a ColorChecker at level 3, by 9 wavelengths'

run 'TIMEFORMAT="%R s"
specconvert --compression none films.exr -o plain.exr
for level in 9 8 7 6 5 4 3 2; do
  spec2rgb -q --lod $level --error card.exr -o x.png 2>&1 | awk "/^bands/ { print \"level\", $level, \$2, \"bands\" } /^de2000-max/ { print \"card\", \$2 }"
  spec2rgb -q -e 3 --lod $level --error films.exr -o x.png 2>&1 | awk "/^de2000-max/ { print \"films\", \$2 }"
  time spec2rgb -q --lod $level plain.exr -o x.ppm
done 2>&1 | paste - - - -
rm plain.exr x.*'
awk '{ print $2, $3 }' <<<"$printed" >levels.txt
check 'bands of levels 9 to 2' "$(awk '{ print $2 }' levels.txt | xargs)" equals '513 257 129 65 33 17 9 5'
# told NAME FILE OPTION...: what --error says.
told() {
  spec2rgb -q "${@:3}" --error "$2" -o told.png 2>&1 | awk -v name="$1" '$1 == name { print $2 }'
}
for level in 0 1 2 3 4 5 6 7 8 9; do told de76-max all.exr --lod $level; done >flat.txt
check 'a flat spectrum at levels 0 to 9: largest ΔE*ab' \
  "$(awk '{ print } END { if (NR != 10) print "none" }' flat.txt | largest)" at-most 5e-5

# Beside the suite: the bands of level 4, 32 nm apart, straight lines between them, and CIELAB.
run 'specconvert --grid 324:836:32 card.exr | specconvert --grid 324:836:1 - -o card-4.exr'
lab card.exr 0,0,24,16 D65 >full.txt
lab card-4.exr 0,0,24,16 D65 >coarse.txt
paste -d ' ' full.txt coarse.txt | awk '{ print sqrt(($3 - $8) ^ 2 + ($4 - $9) ^ 2 + ($5 - $10) ^ 2) }' >apart.txt
check 'the card at level 4: largest ΔE*ab' "$(told de76-max card.exr --lod 4)" \
  within "$(sort -g apart.txt | tail -n 1)" 2e-4
check 'the card at level 4: mean ΔE*ab' "$(told de76 card.exr --lod 4)" \
  within "$(awk '{ sum += $1 } END { printf "%.6f", sum / NR }' apart.txt)" 2e-4

# The choice by a bound.
run 'for image in "card.exr" "films.exr -e 3"; do
  spec2rgb -q --lod de2000-max:0.5 --error $image -o chosen.png 2>&1 | grep -E "level|bands|de2000-max"
done'
awk '$1 == "level" { level = $2 } $1 == "de2000-max" { print level, $2 }' <<<"$printed" >chosen.txt
read -r card card_most < <(sed -n 1p chosen.txt)
read -r films films_most < <(sed -n 2p chosen.txt)
check 'the card within 0.5: largest CIEDE2000' "$card_most" at-most 0.5
check 'the card one level below: largest CIEDE2000' "$(told de2000-max card.exr --lod $((card - 1)))" at-least 0.5
check 'the films within 0.5: largest CIEDE2000' "$films_most" at-most 0.5
check 'the films one level below: largest CIEDE2000' "$(told de2000-max films.exr -e 3 --lod $((films - 1)))" at-least 0.5
check 'levels that the films need more than the card' $((films - card)) at-least 2
