#!/usr/bin/env bats
# spec2rgb --step, --lod and --error: fewer bands, and what they cost in colour.
# shellcheck disable=SC2154 # fails_cleanly leaves its line in stderr

load common

# reported NAME FILE: a number that --error printed.
reported() {
  awk -v name="$1" '$1 == name { print $2; found = 1 } END { exit !found }' "$2"
}

# close A B TOLERANCE
close() {
  awk -v a="$1" -v b="$2" -v t="$3" 'BEGIN { d = a - b; exit !(a != "" && b != "" && d <= t && -d <= t) }' ||
    complain "$1 is not $2, to $3"
}

# at_most A B
at_most() {
  awk -v a="$1" -v b="$2" 'BEGIN { exit !(a != "" && b != "" && a + 0 <= b + 0) }' || complain "$1 is more than $2"
}

# same_light A.exr B.exr: equal, to the rounding of floats.
same_light() {
  specdiff -m max -t max=3e-7 "$1" "$2" >compared || complain "$1 is not $2" "$(<compared)"
}

# coarse FROM TO NM: the bands of 400:720:5, linear between those NM apart.
coarse() {
  specconvert --grid "400:720:$3" "$1" -o coarse.tmp.exr
  specconvert --grid 400:720:5 coarse.tmp.exr -o "$2"
  rm coarse.tmp.exr
}

# Fewer bands

@test "--lod sees straight lines between the bands it keeps" {
  for kind in S0 T; do
    spectral full.exr --grid 400:720:5 --kind $kind --pattern grain
    for level in 6:5 5:10 4:20 3:40 2:80 1:160 0:320; do
      coarse full.exr few.exr "${level#*:}"
      spec2rgb --illuminant A few.exr -o wanted.exr
      spec2rgb --illuminant A --lod "${level%:*}" full.exr -o got.exr
      same_light wanted.exr got.exr
    done
  done
}

@test "--lod beyond the finest level is all bands, bit by bit" {
  spectral a.exr --pattern grain
  spec2rgb a.exr -o all.exr
  spec2rgb --lod 4 a.exr -o 4.exr
  spec2rgb --lod 15 --error a.exr -o 15.exr 2>said
  [ "$(sed -n '1,2p' said | tr -s ' ' | xargs)" = 'level 4 of 4 bands 16 of 16' ]
  spec2rgb --lod 3 a.exr -o 3.exr
  specdiff -m max -t max=0 all.exr 4.exr
  specdiff -m max -t max=0 all.exr 15.exr
  run ! specdiff -m max -t max=0 all.exr 3.exr
}

@test "--lod takes uneven bands, bins, bands of a quantity each, and one band" {
  spectral uneven.exr --channel S0.400nm --channel S0.410nm --channel S0.450nm --channel S0.500nm \
    --channel S0.610nm --pattern ramp
  # Of five bands level 1 keeps the third: 410 is four fifths of 400 and a fifth of 450.
  printf '%s\n' '# quantity: transmittance' '400 1' '450 1' '610 1' >three.spd
  printf '%s\n' '# quantity: transmittance' '400 1' '410 1' '450 1' '500 1' '610 1' >five.spd
  specconvert --grid three.spd uneven.exr | specconvert --grid five.spd - -o few.exr
  spec2rgb -q few.exr -o wanted.exr
  spec2rgb -q --lod 1 uneven.exr -o got.exr
  same_light wanted.exr got.exr
  # A flat spectrum stays what it is.
  for option in --bins '--quantity=radiance per band'; do
    case $option in
    --bins) spectral flat.exr --grid 365:825:10 --bins --pattern constant:0.5 ;;
    *) spectral flat.exr --grid 365:825:10 --quantity 'radiance per band' --pattern constant:0.5 ;;
    esac
    spec2rgb flat.exr -o wanted.exr
    spec2rgb --lod 2 flat.exr -o got.exr
    same_light wanted.exr got.exr
  done
  spectral one.exr --channel S0.550nm --quantity 'radiance per band'
  spec2rgb -q one.exr -o wanted.exr
  spec2rgb -q --lod 0 one.exr -o got.exr
  same_light wanted.exr got.exr
}

@test "--lod keeps all elements of reradiation" {
  # A constant one: what the bands show is the same at every level, and so is what fluorescence adds.
  spectral glow.exr --channel T.400nm --channel T.450nm --channel T.500nm --channel T.550nm --channel T.600nm \
    --channel T.400nm.550nm --channel T.450nm.600nm --pattern constant:0.5
  spectral plain.exr --channel T.400nm --channel T.450nm --channel T.500nm --channel T.550nm --channel T.600nm \
    --pattern constant:0.5
  for name in glow plain; do
    spec2rgb -q $name.exr -o $name-all.exr
    spec2rgb -q --lod 0 $name.exr -o $name-few.exr
    same_light $name-all.exr $name-few.exr
  done
  run ! specdiff -m max -t max=1e-3 glow-all.exr plain-all.exr
}

@test "--step: each band kept stands for those up to the next" {
  spectral full.exr --grid 400:700:10 --pattern grain
  {
    echo '# quantity: transmittance'
    for ((nm = 400; nm <= 700; nm += 10)); do echo "$nm $(((nm - 400) % 40 ? 0 : 4))"; done
  } >comb.spd
  specconvert --multiply comb.spd full.exr -o few.exr
  spec2rgb few.exr -o wanted.exr
  spec2rgb --step 40 full.exr -o got.exr
  same_light wanted.exr got.exr
  spec2rgb --step 0.04um full.exr -o got.exr
  same_light wanted.exr got.exr
  spec2rgb full.exr -o wanted.exr
  spec2rgb --step 10 full.exr -o got.exr
  specdiff -m max -t max=0 wanted.exr got.exr
}

@test "every format that is read, and a folder of bands" {
  spectral a.exr --grid 400:720:20 --pattern grain
  spec2rgb --lod 2 a.exr -o wanted.exr
  spec2rgb --lod de76-max:1e6 --error a.exr -o wanted-0.exr 2>wanted
  specconvert -f envi a.exr -o a.bsq
  specconvert -f tiff a.exr -o a.tif
  specconvert -f bands a.exr -o bands
  specconvert --compression none a.exr -o none.exr
  for file in a.bsq a.tif bands none.exr; do
    spec2rgb --lod 2 --read-as radiance $file -o got.exr
    same_light wanted.exr got.exr
    # Twice read, with the same result.
    spec2rgb --lod de76-max:1e6 --error --read-as radiance $file -o got.exr 2>said
    same_light wanted-0.exr got.exr
    diff wanted said
  done
  specconvert --to fourier:9 a.exr -o series.exr
  spec2rgb --lod de2000-max:0 --error series.exr -o got.exr 2>said
  spec2rgb series.exr -o wanted.exr
  same_light wanted.exr got.exr
  specconvert a.exr -o a.hsr
  spec2rgb --lod de2000-max:0 --error a.hsr -o got.exr 2>said
  spec2rgb a.hsr -o wanted.exr
  same_light wanted.exr got.exr
}

@test "a folder of pictures, of which some are not read" {
  spectral a.exr --grid 400:720:20 --pattern grain
  mkdir folder
  for nm in 450 500 550 600 650; do
    spec2rgb --observer v-photopic -e $((nm / 50 - 11)) --bits 16 a.exr -o folder/${nm}nm.png
  done
  specconvert --read-as radiance folder -o all.exr
  for level in 0 1; do
    spec2rgb -q --lod $level all.exr -o wanted.exr
    spec2rgb -q --lod $level --error --read-as radiance folder -o got.exr
    specdiff -m max -t max=0 wanted.exr got.exr
  done
  # What is not read may be damaged: its samples are, its header is not.
  head -c -40 folder/500nm.png >short && mv short folder/500nm.png
  spec2rgb -q --lod 1 --read-as radiance folder -o got.exr
  specdiff -m max -t max=0 wanted.exr got.exr
  fails_cleanly spec2rgb -q --lod 2 --read-as radiance folder -o x.exr
  [[ $stderr = *folder/500nm.png:* ]] || complain "$stderr"
}

@test "--model has the components of the coarser colour" {
  spectral a.exr --pattern grain
  coarse=$(spec2rgb --lod 2 a.exr -f ppm | md5sum)
  [ "$coarse" != "$(spec2rgb a.exr -f ppm | md5sum)" ]
  spec2rgb --lod 2 --model hsv a.exr -o hsv.exr
  spec2rgb --model hsv a.exr -o all.exr
  run ! specdiff -m max -t max=1e-3 hsv.exr all.exr
}

# The error

@test "--error prints what specdiff measures" {
  # Reflectance, of which both take the perfect reflector for white; specdiff has its own sums.
  spectral full.exr --grid 400:720:5 --kind T --pattern grain
  for level in 3:40 2:80 0:320; do
    coarse full.exr few.exr "${level#*:}"
    { specdiff --observer 1931 --illuminant A -m de76,de76-max,de2000,de2000-max full.exr few.exr || [ $? = 1 ]; } >measured
    spec2rgb --illuminant A --lod "${level%:*}" --error full.exr -o x.png 2>said
    for name in de76 de76-max de2000 de2000-max; do
      close "$(reported $name said)" "$(reported $name measured)" 1e-4
    done
    diff <(sed -n 's/^\(de.*-max\) .* at/\1/p' said | sort) <(sed -n 's/^\(de.*-max\) .* at/\1/p' measured | sort)
    for name in de76 de2000; do
      at_most "$(reported $name said)" "$(reported $name-rms said)"
      at_most "$(reported $name-rms said)" "$(reported $name-max said)"
    done
  done
  sed -n 1,2p said | diff - <(printf '%s\n' 'level      0 of 6' 'bands      2 of 65')
}

@test "--error of one pixel: mean, rms and most are the same" {
  spectral one.exr --size 1x1 --grid 400:720:5 --pattern grain
  spec2rgb --step 20 --error one.exr -o x.png 2>said
  [ "$(head -n 1 said)" = 'bands      17 of 65' ]
  for name in de76 de2000; do
    [ "$(reported $name said)" = "$(reported $name-max said)" ]
    [ "$(reported $name said)" = "$(reported $name-rms said)" ]
    at_most 1e-3 "$(reported $name said)"
  done
}

@test "--error names the first of several pixels with the most" {
  specconvert --patches 1x1 --patch 5 --grid 400:720:5 15-red -o equal.exr
  spec2rgb --lod 1 --error equal.exr -o x.png 2>said
  [ "$(grep -c ' at 0,0$' said)" = 2 ]
  at_most 0.1 "$(reported de76-max said)"
}

@test "--error rms is the root of the mean square" {
  # Two pixels side by side, and each alone.
  spectral two.exr --size 2x1 --grid 400:720:5 --pattern grain
  spec2rgb --lod 2 --error two.exr -o x.png 2>both
  specconvert --crop 0,0,1,1 two.exr | spec2rgb --lod 2 --error -o x.png 2>left
  specconvert --crop 1,0,2,1 two.exr | spec2rgb --lod 2 --error -o x.png 2>right
  a=$(reported de76 left) b=$(reported de76 right)
  close "$(reported de76 both)" "$(awk "BEGIN { print ($a + $b) / 2 }")" 2e-5
  close "$(reported de76-rms both)" "$(awk "BEGIN { print sqrt(($a ^ 2 + $b ^ 2) / 2) }")" 2e-5
  close "$(reported de76-max both)" "$(awk "BEGIN { print ($a > $b ? $a : $b) }")" 2e-5
}

@test "--error leaves standard output to the picture" {
  spectral a.exr
  spec2rgb --lod 2 --error a.exr >a.png 2>said
  [ "$(od -An -tx1 -N4 a.png)" = ' 89 50 4e 47' ]
  [ "$(wc -l <said)" = 8 ]
}

@test "--error is measured at the exposure that is given" {
  spectral a.exr --grid 400:720:5 --pattern grain
  spec2rgb --lod 2 --error a.exr -o x.png 2>plain
  spec2rgb --lod 2 --error -e 3 a.exr -o x.png 2>bright
  # Lightness goes with the third root: of 8 times the light 2 times the difference, but near black.
  close "$(awk "BEGIN { print $(reported de76 bright) / $(reported de76 plain) }")" 2 0.05
}

@test "--verbose tells the bands that were kept, also in the picture" {
  spectral a.exr --grid 400:720:5 --pattern grain
  for option in '--lod 3:9 of 65 bands, level 3, straight lines between them' \
    '--step 40:9 of 65 bands, each for those up to the next' \
    '--lod de76-max=1e6:2 of 65 bands, level 0, straight lines between them'; do
    args=${option%%:*}
    # shellcheck disable=SC2086 # words
    spec2rgb -v ${args/=/:} a.exr -o x.exr 2>said
    [[ $(<said) = "spec2rgb: a.exr: rule "*"; ${option#*:}" ]] || complain "$(<said)"
    [ "$(wc -l <said)" = 1 ]
    exrheader x.exr | grep -q "^spec:integration .*; ${option#*:}\"$"
  done
  spec2rgb -v a.exr -o x.exr 2>said
  [ "$(wc -l <said)" = 1 ]
  exrheader x.exr | { run ! grep 'spec:integration.*65 bands'; }
  spec2rgb --lod 3 a.exr -o x.exr 2>said
  [ ! -s said ]
}

# The bound

@test "a bound of every pixel is kept, and no coarser level keeps it" {
  spectral a.exr --grid 400:720:5 --pattern grain
  for metric in de76-max de2000-max de76 de2000; do
    for bound in 0.5 1 2 4; do
      spec2rgb --lod "$metric:$bound" --error a.exr -o got.exr 2>said
      at_most "$(reported "$metric" said)" "$bound"
      level=$(reported level said)
      spec2rgb --lod "$level" --error a.exr -o wanted.exr 2>again
      diff said again
      specdiff -m max -t max=0 wanted.exr got.exr
      [ "$level" != 0 ] || continue
      spec2rgb --lod $((level - 1)) --error a.exr -o x.png 2>coarser
      run ! at_most "$(reported "$metric" coarser)" "$bound"
    done
  done
}

@test "a line in one band needs all bands" {
  spectral smooth.exr --size 32x32 --grid 400:720:5 --kind T --pattern ramp
  {
    echo '# quantity: transmittance'
    for ((nm = 400; nm <= 720; nm += 5)); do echo "$nm $((nm == 555))"; done
  } >line.spd
  spec2rgb --lod de2000-max:0.5 --error smooth.exr -o x.png 2>before
  specconvert --patches 1x1 line.spd --grid 400:720:5 -o line.exr
  spec2rgb --lod de2000-max:0.5 --error line.exr -o x.png 2>said
  [ "$(reported level said)" = 6 ]
  [ "$(reported bands said)" = 65 ]
  [ "$(reported de2000-max said)" = 0 ]
  [ "$(reported level before)" -lt 6 ]
}

@test "a bound of 0 keeps bands only where they are straight lines" {
  spectral flat.exr --size 4x2 --grid 400:720:5 --pattern constant:0
  spec2rgb --lod de2000-max:0 --error flat.exr -o x.png 2>said
  [ "$(head -n 1 said)" = 'level      0 of 6' ]
  spectral grain.exr --size 4x2 --grid 400:720:5 --pattern grain
  spec2rgb --lod de2000-max:0 --error grain.exr -o x.png 2>said
  [ "$(head -n 1 said)" = 'level      6 of 6' ]
  [ "$(reported de2000-max said)" = 0 ]
}

@test "from a pipe as from a file, with any number of threads" {
  spectral a.exr --size 64x48 --grid 400:720:5 --pattern grain
  specconvert a.exr --compression none -o none.exr
  spec2rgb --lod de2000:1 --error a.exr -o wanted.png 2>wanted
  for threads in 1 2 5; do
    for file in a none; do
      spec2rgb -j $threads --lod de2000:1 --error $file.exr -o file.png 2>said
      diff wanted said
      cmp wanted.png file.png
      cat $file.exr | spec2rgb -j $threads --lod de2000:1 --error -o pipe.png 2>said
      diff wanted said
      cmp wanted.png pipe.png
    done
  done
  specconvert --half a.exr --compression none -o half.exr
  specconvert half.exr --compression zip -o packed.exr
  for level in 0 1 3 5 6; do
    for file in a:none packed:half; do
      spec2rgb --lod $level "${file%:*}.exr" -o wanted.png
      spec2rgb --lod $level "${file#*:}.exr" -o file.png
      cmp wanted.png file.png
      cat "${file#*:}.exr" | spec2rgb --lod $level -o pipe.png
      cmp wanted.png pipe.png
    done
  done
}

@test "a pixel that is not finite stays so within a bound, and is counted" {
  # Band 2 of 16 is kept from level 3 on; the coarser levels would make the pixel finite.
  spectral nan.exr --grid 400:700:20 --pattern nan:3,2,2
  spec2rgb --lod 2 --error nan.exr -o x.png 2>said
  [ "$(reported nonfinite said)" = 1 ]
  run ! grep -q warning said
  for metric in de2000-max de76; do
    spec2rgb --lod $metric:1e6 --error nan.exr -o x.png 2>said
    [ "$(reported level said)" -ge 2 ]
    [ "$(reported nonfinite said)" = 1 ]
    grep -q 'warning: nan.exr: 1 pixel is not finite, the first at 3,2' said
  done
}

@test "a bound on the mean is one on that of the pixels that are finite" {
  spectral grain.exr --grid 400:720:5 --pattern grain
  speccomp --expr 'x < 8 ? 0 / 0 : a' grain.exr -o half.exr
  spec2rgb -q --lod 0 --error half.exr -o x.png 2>said
  bound=$(awk '$1 == "de2000" { print 0.75 * $2 }' said)
  spec2rgb -q --lod "de2000:$bound" --error half.exr -o x.png 2>said
  [ "$(reported nonfinite said)" = 64 ]
  at_most "$(reported de2000 said)" "$bound"
  [ "$(reported level said)" -gt 0 ]
}

# Bad input

@test "levels and steps that make no sense" {
  spectral a.exr
  for lod in x '' -1 16 1.5 de2000 de2000: de2000:x de2000-max:-1 de2000-max:nan de94:1 :1; do
    fails_cleanly spec2rgb --lod "$lod" a.exr -o x.png
  done
  for step in x '' 0 -5 1e999 20deg; do
    fails_cleanly spec2rgb --step "$step" a.exr -o x.png
  done
  fails_cleanly spec2rgb --lod de94:1 a.exr -o x.png
  [[ $stderr = *"de2000-max with a bound"*"not 'de94:1'" ]] || complain "$stderr"
  fails_cleanly spec2rgb --step 30 a.exr -o x.png
  [[ $stderr = *': a.exr: the bands are 20 nm apart: a step of 30 nm is no multiple of that' ]] || complain "$stderr"
  fails_cleanly spec2rgb --step 10 a.exr -o x.png
  fails_cleanly spec2rgb --step 320 a.exr -o x.png
  [[ $stderr = *': a.exr: of the bands at 400..700 nm a step of 320 nm leaves one' ]] || complain "$stderr"
  spectral uneven.exr --channel S0.400nm --channel S0.410nm --channel S0.450nm
  fails_cleanly spec2rgb --step 10 uneven.exr -o x.png
  [[ $stderr = *'equal distances'* ]] || complain "$stderr"
  fails_cleanly spec2rgb --step 20 --lod 3 a.exr -o x.png
  [[ $stderr = *'--step and --lod exclude each other' ]] || complain "$stderr"
  fails_cleanly spec2rgb --error a.exr -o x.png
  [[ $stderr = *'--error is of --step or --lod' ]] || complain "$stderr"
  fails_cleanly spec2rgb --error --lod 3 -e auto a.exr -o x.png
  fails_cleanly spec2rgb --lod de76:1 -e auto:99% a.exr -o x.png
  [[ $stderr = *'need a given exposure, not auto' ]] || complain "$stderr"
  fails_cleanly spec2rgb --observer cie2006-lms-2 --lod de76:1 a.exr -o x.png
  no_leftovers . a.exr uneven.exr
  # Without a difference to measure, sensors and a meter are as good as others.
  spec2rgb --observer cie2006-lms-2 --lod 3 a.exr -o x.png
  spec2rgb --lod 3 -e auto a.exr -o x.png
}

@test "input that ends early, and no place for a copy of a pipe" {
  spectral a.exr --compression none
  head -c 5000 a.exr >short.exr
  # All bands that are kept are there, and the last byte of something else is not.
  spectral more.exr --size 128x4 --extra Z --extra AA --compression none
  spec2rgb --lod 0 more.exr -o x.png
  head -c -1 more.exr >less.exr
  fails_cleanly spec2rgb --lod 0 less.exr -o y.png
  [[ $stderr = *': less.exr: ends early, in line 3 of 0..3' ]] || complain "$stderr"
  rm more.exr less.exr x.png
  for option in '--lod 2' '--lod de2000-max:1' '--step 40 --error'; do
    # shellcheck disable=SC2086 # words
    fails_cleanly spec2rgb $option short.exr -o x.png
    # shellcheck disable=SC2086
    fails_cleanly spec2rgb $option - -o x.png < <(cat short.exr)
  done
  mkdir tmp
  chmod -w tmp
  for option in '--lod de2000-max:1' '--lod 2 --error'; do
    # shellcheck disable=SC2086
    TMPDIR=$PWD/missing fails_cleanly spec2rgb $option - -o x.png < <(cat a.exr)
    [[ $stderr = *"unable to create a temporary file in '$PWD/missing'"* ]] || complain "$stderr"
  done
  # A file is read twice, and a pipe once where nothing is measured.
  TMPDIR=$PWD/missing spec2rgb --lod de2000-max:1 a.exr -o x.png
  cat a.exr | TMPDIR=$PWD/missing spec2rgb --lod 2 -o x.png
  no_leftovers . a.exr short.exr tmp x.png
}
