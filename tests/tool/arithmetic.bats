#!/usr/bin/env bats
# specconvert: resampling, bins and arithmetic, of images and of curves, by closed forms.
# shellcheck disable=SC2154 # fails_cleanly leaves its line in stderr

load common

# numbers FILE: an image's or a curve's numbers as text, without the header.
numbers() {
  specconvert --format spd "$1" | grep -v '^#'
}

# has_numbers FILE LINE...
has_numbers() {
  local found wanted
  found=$(numbers "$1")
  shift
  wanted=$(printf '%s\n' "$@")
  [ "$found" = "$wanted" ] || complain "has:" "$found" "instead of:" "$wanted"
}

# has_line FILE LINE: exrheader prints that line.
has_line() {
  exrheader "$1" | grep -qxF -e "$2" || complain "no line '$2' in:" "$(exrheader "$1")"
}

# near FILE AWK [TOLERANCE]: the statements, given the wavelength nm, set want; each value is that
# within the tolerance, relative, of a float unless it is given.
near() {
  numbers "$1" | awk -v tolerance="${3:-1e-7}" '
    function size(a) { return a < 0 ? -a : a }
    { nm = $1; '"$2"'
      for (i = 2; i <= NF; i++) if (!(size($i - want) <= tolerance * size(want) + 1e-12)) {
        printf "at %s nm: %s instead of %.9g\n", nm, $i, want; bad = 1 } }
    END { exit bad || NR == 0 }'
}

# warns LINE COMMAND...: succeeds, and says this on standard error alone; nothing with -q.
warns() {
  local line=$1
  shift
  "$@" 2>said || complain "failed: $*" "$(cat said)" || return 1
  [ "$(cat said)" = "specconvert: warning: $line" ] || complain "said:" "$(cat said)" || return 1
  "$@" -q 2>said
  [ ! -s said ] || complain "with -q:" "$(cat said)"
}

light() { # light FILE NM VALUE...: a curve of light
  local file=$1
  shift
  { echo '# quantity: spectral power distribution'; printf '%s %s\n' "$@"; } >"$file"
}

ratio() {
  local file=$1
  shift
  { echo '# quantity: transmittance'; printf '%s %s\n' "$@"; } >"$file"
}

# Grids

@test "--grid takes the wavelengths of an image or a curve, or leaves them" {
  spectral a.exr --size 1x1 --grid 400:700:100
  spectral like.exr --size 1x1 --kind T --grid 450:550:25
  specconvert --grid like.exr a.exr -o b.exr
  numbers b.exr | cut -d ' ' -f 1 | cmp - <(printf '%s\n' 450 475 500 525 550)
  light curve.spd 420 1 640 1
  specconvert --grid curve.spd a.exr -o b.exr
  numbers b.exr | cut -d ' ' -f 1 | cmp - <(printf '%s\n' 420 640)
  specconvert --grid native a.exr -o b.exr
  specdiff a.exr b.exr
  specconvert --grid 15-red D65 | grep -v '^#' | cut -d ' ' -f 1 |
    cmp - <(specconvert 15-red | grep -v '^#' | cut -d ' ' -f 1)
  fails_cleanly specconvert --grid no-such-thing a.exr -o c.exr
  [[ $stderr = *LO:HI:STEP* ]] || complain "$stderr"
  spectral rgb.exr --channel R --channel G --channel B
  fails_cleanly specconvert --grid rgb.exr a.exr -o c.exr
  [[ $stderr = *'rgb.exr: has no spectral channel to take a grid from' ]] || complain "$stderr"
}

@test "--interp nearest and left" {
  spectral a.exr --size 1x1 --grid 400:440:20
  specconvert --interp nearest --grid 405:435:10 a.exr -o nearest.exr
  has_numbers nearest.exr '405 0.001' '415 0.101' '425 0.101' '435 0.201'
  specconvert --interp left --grid 405:435:10 a.exr -o left.exr
  has_numbers left.exr '405 0.001' '415 0.001' '425 0.101' '435 0.101'
  specconvert a.exr -o a.spd
  for rule in nearest left; do
    specconvert --interp $rule --grid 405:435:10 a.spd -o curve.spd
    cmp <(numbers curve.spd) <(numbers $rule.exr)
  done
  fails_cleanly specconvert --interp cubic --grid 405:435:10 a.exr -o b.exr
}

@test "--interp sprague: a quartic inside, as a curve and as an image, and equal steps alone" {
  awk 'BEGIN { for (i = 0; i <= 8; i++) { x = (i - 4) / 4
    printf "%d %.17g\n", 400 + 10 * i, 2 + x - x * x + x ^ 3 + x ^ 4 } }' >a.spd
  specconvert --interp sprague --grid 420:460:2.5 a.spd -o b.spd
  near b.spd 'x = (nm - 440) / 40; want = 2 + x - x * x + x ^ 3 + x ^ 4' 1e-13
  specconvert a.spd -o a.exr
  specconvert --interp sprague --grid 420:460:2.5 a.exr -o b.exr
  near b.exr 'x = (nm - 440) / 40; want = 2 + x - x * x + x ^ 3 + x ^ 4' 3e-7
  # Linear between the samples is something else.
  specconvert --grid 420:460:2.5 a.spd -o linear.spd
  run ! near linear.spd 'x = (nm - 440) / 40; want = 2 + x - x * x + x ^ 3 + x ^ 4' 1e-4
  spectral uneven.exr --channel S0.400nm --channel S0.410nm --channel S0.420nm \
    --channel S0.430nm --channel S0.440nm --channel S0.455nm
  fails_cleanly specconvert --interp sprague --grid 410:420:5 uneven.exr -o b.exr
  [[ $stderr = *equidistant* ]] || complain "$stderr"
}

@test "a grid that goes beyond what is extrapolated is told" {
  spectral a.exr --size 1x1 --grid 500:520:20
  warns 'a.exr: has nothing at 480..500 nm and 520..540 nm: taken for 0' \
    specconvert --grid 480:540:20 --extrapolate zero a.exr -o b.exr
  warns 'a.exr: has nothing at 480..500 nm: taken as at its end' \
    specconvert --grid 480:510:10 --extrapolate constant a.exr -o b.exr
  light a.spd 500 1 520 1
  warns 'a.spd: has nothing at 520..540 nm: taken for 0' \
    specconvert --grid 500:540:20 --extrapolate zero a.spd -o b.spd
}

# Bins

@test "--rebin gives each bin its share, and writes the bins" {
  # 0.001, 0.101, 0.201 on 490..510..530..550
  spectral a.exr --size 1x1 --grid 500:540:20 --bins
  specconvert --rebin --grid 500:530:30 a.exr -o b.exr
  # 485 would be outside: 485..515..545
  has_line b.exr 'spec:bins (type string): "485 515 545"'
  near b.exr 'want = nm == 500 ? (20 * 0.001 + 5 * 0.101) / 30 : (15 * 0.101 + 15 * 0.201) / 30'
  specconvert --rebin --grid 520:520:1 a.exr -o one.exr
  has_numbers one.exr '520 0.101'
}

@test "--rebin keeps the integral, of densities and of values per band" {
  spectral a.exr --size 4x4 --grid 400:700:5 --pattern noise --bins
  spectral band.exr --size 4x4 --grid 400:700:5 --pattern noise --bins --quantity 'radiance per band'
  specconvert --rebin --grid 405.125:694.875:15.25 a.exr -o nm.exr
  specconvert --rebin --grid 405.125:694.875:15.25 band.exr -o bands.exr
  # 61 bins of 5 nm become 20, on the same 305 nm.
  for file in a band nm bands; do numbers $file.exr >$file.txt; done
  paste -d ' ' <(awk '{ for (i = 2; i <= NF; i++) s[i] += 5 * $i } END { for (i = 2; i <= 17; i++) print s[i] }' a.txt) \
    <(awk '{ for (i = 2; i <= NF; i++) s[i] += 15.25 * $i } END { for (i = 2; i <= 17; i++) print s[i] }' nm.txt) \
    <(awk '{ for (i = 2; i <= NF; i++) s[i] += $i } END { for (i = 2; i <= 17; i++) print s[i] }' band.txt) \
    <(awk '{ for (i = 2; i <= NF; i++) s[i] += $i } END { for (i = 2; i <= 17; i++) print s[i] }' bands.txt) |
    awk '{ if (($1 / $2 - 1) ^ 2 > 1e-12 || ($3 / $4 - 1) ^ 2 > 1e-12) { print; bad = 1 } } END { exit bad || NR != 16 }'
}

@test "--rebin takes the bins of another image" {
  spectral a.exr --size 1x1 --grid 500:540:20 --bins
  spectral like.exr --size 1x1 --channel 495.00-505.00nm --channel 505.00-545.00nm
  specconvert --rebin --grid like.exr a.exr -o b.exr
  has_line b.exr 'spec:bins (type string): "495 505 545"'
  near b.exr 'want = nm == 500 ? 0.001 : (5 * 0.001 + 20 * 0.101 + 15 * 0.201) / 40'
}

@test "--rebin beyond the bins warns where a bin is there in part, and refuses one that is not" {
  spectral a.exr --size 1x1 --grid 500:540:20 --bins --pattern constant:1
  warns 'a.exr: has nothing at 480..490 nm: taken for 0' \
    specconvert --rebin --grid 490:530:20 a.exr -o b.exr
  near b.exr 'want = nm == 490 ? 0.5 : 1'
  warns 'a.exr: has nothing at 480..490 nm: taken as at its end' \
    specconvert --rebin --grid 490:530:20 --extrapolate constant a.exr -o b.exr
  near b.exr 'want = 1'
  fails_cleanly specconvert --rebin --grid 470:530:20 a.exr -o b.exr
  [[ $stderr = *'the bin 460..480 nm is outside its bins, 490..550 nm'* ]] || complain "$stderr"
  specconvert -q --rebin --grid 470:530:20 --extrapolate zero a.exr -o b.exr
  near b.exr 'want = nm == 470 ? 0 : nm == 490 ? 0.5 : 1'
  warns 'a.exr: has nothing at 550..560 nm: taken as at its end' \
    specconvert --rebin --grid 510:550:20 --extrapolate constant a.exr -o b.exr
  near b.exr 'want = 1'
}

@test "--rebin of point samples says what it takes for bins; a curve does the same" {
  spectral a.exr --size 1x1 --grid 500:540:20
  warns 'a.exr: has no spec:bins: its bands are taken to meet half-way' \
    specconvert --rebin --grid 505:535:30 a.exr -o b.exr
  near b.exr 'want = nm == 505 ? (20 * 0.001 + 10 * 0.101) / 30 : (10 * 0.101 + 20 * 0.201) / 30'
  specconvert a.exr -o a.spd
  specconvert --rebin --grid 505:535:30 a.spd -o b.spd
  near b.spd 'want = nm == 505 ? (20 * 0.001 + 10 * 0.101) / 30 : (10 * 0.101 + 20 * 0.201) / 30'
  fails_cleanly specconvert --rebin a.exr -o c.exr
  fails_cleanly specconvert --rebin --interp left --grid 505:535:30 a.exr -o c.exr
  fails_cleanly specconvert --interp left a.exr -o c.exr
  fails_cleanly specconvert --least 0.5 a.exr -o c.exr
}

@test "--per nm and --per band, and back" {
  spectral a.exr --size 2x2 --channel S0.500nm --channel S0.510nm --channel S0.530nm \
    --attribute 'spec:bins=495 505 520 540'
  specconvert --per band a.exr -o band.exr
  has_line band.exr 'spec:quantity (type string): "radiance per band"'
  # Where there were no bins the bands are said to meet half-way.
  spectral plain.exr --size 1x1 --grid 500:520:10
  specconvert -q --per band plain.exr -o halfway.exr
  has_line halfway.exr 'spec:bins (type string): "495 505 515 525"'
  specconvert --crop 0,0,1,1 band.exr -o one.exr
  near one.exr 'want = nm == 500 ? 0.001 * 10 : nm == 510 ? 0.101 * 15 : 0.201 * 20'
  specconvert --per nm band.exr -o back.exr
  has_line back.exr 'spec:quantity (type string): "radiance per nm"'
  specdiff --tolerance max=1e-7 a.exr back.exr
  # A preview would show other values.
  spectral seen.exr --size 2x2 --grid 500:510:10 --extra R --extra G --extra B
  specconvert -q --per band seen.exr -o unseen.exr
  has_channels unseen.exr S0.500,000000nm S0.510,000000nm
  # Interpolated values are densities.
  specconvert --per nm --grid 505:505:1 band.exr -o between.exr
  specconvert --grid 505:505:1 a.exr -o wanted.exr
  specdiff --tolerance max=1e-7 wanted.exr between.exr
  spectral t.exr --kind T
  fails_cleanly specconvert --per nm t.exr -o c.exr
  fails_cleanly specconvert --per metre a.exr -o c.exr
}

# Air and units

@test "--to-air and --to-vacuum rename the bands, and back" {
  spectral a.exr --size 1x1 --channel S0.589,1583264nm --channel S0.656,46nm \
    --attribute 'spec:bins=550 600 700'
  specconvert --to-air a.exr -o air.exr
  # NIST: 588.99510 nm; its air has less carbon dioxide, by 1e-5 nm here
  exrheader air.exr | grep -qE 'S0\.588,9950(8|9)[0-9]nm'
  has_line air.exr 'spec:medium (type string): "air"'
  # Ciddor's index of air at 550, 600 and 700 nm
  exrheader air.exr | grep -q '^spec:bins (type string): "549.8472317 599.8338561 699.806990'
  specconvert --to-vacuum air.exr -o back.exr
  # names have six decimals, bins ten digits
  exrheader back.exr | grep -qE 'S0\.589,15832[5-7]nm'
  edges=$(exrheader back.exr | sed -n 's/^spec:bins.*"\(.*\)"/\1/p')
  awk '{ exit !(($1 - 550) ^ 2 < 1e-12 && ($2 - 600) ^ 2 < 1e-12 && ($3 - 700) ^ 2 < 1e-12) }' <<<"$edges" || complain "$edges"
  fails_cleanly specconvert --to-air air.exr -o x.exr
  [[ $stderr = *'already' ]] || complain "$stderr"
  fails_cleanly specconvert --to-air --to-vacuum a.exr -o x.exr
  spectral far.exr --size 1x1 --grid 2000:2100:100
  fails_cleanly specconvert --to-air far.exr -o x.exr
  [[ $stderr = *'230..1690 nm'* ]] || complain "$stderr"
  spectral near.exr --size 1x1 --grid 220:320:100
  fails_cleanly specconvert --to-air near.exr -o x.exr
  [[ $stderr = *'230..1690 nm, not at 220 nm'* ]] || complain "$stderr"
  spectral glow.exr --size 1x1 --channel T.400nm --channel T.500nm --channel T.400nm.500nm
  fails_cleanly specconvert --to-air glow.exr -o x.exr
}

@test "--to-vacuum of a curve, whose medium says what it is" {
  printf '# medium: air\n588.9950954 1\n700 2\n' >a.spd
  specconvert --to-vacuum a.spd -o b.spd
  grep -qx '# medium: vacuum' b.spd
  numbers b.spd | awk 'NR == 1 { exit !($1 - 589.1583264 < 2e-5 && 589.1583264 - $1 < 2e-5) }'
  fails_cleanly specconvert --to-vacuum b.spd -o c.spd
  specconvert --to-air b.spd -o c.spd
  numbers c.spd | awk 'NR == 2 { exit !(($1 - 700) ^ 2 < 1e-16) }'
}

@test "--input-unit: frequencies, wavenumbers and micrometres" {
  printf '%s\n' '# quantity: spectral power distribution' '# unit: W/THz' '500 1' '600 3' >thz.spd
  specconvert --input-unit THz thz.spd -o nm.spd
  near nm.spd 'want = (nm < 550 ? 3 : 1) * 299792.458 / (nm * nm)' 1e-14
  numbers nm.spd | cut -c 1-8 | head -n 1 | cmp - <(echo 499.6540)
  run ! grep '# unit' nm.spd
  printf '%s\n' '# quantity: reflectance' '14000 0.25' '20000 0.5' >cm.spd
  specconvert --input-unit cm-1 cm.spd -o nm.spd
  has_numbers nm.spd '500 0.5' '714.2857142857143 0.25'
  printf '%s\n' '0.5 2' '0.75 4' >um.csv
  warns 'um.csv: states no quantity: its values were left as they are' \
    specconvert --input-unit um um.csv -o nm.spd
  has_numbers nm.spd '500 2' '750 4'
  printf '%s\n' '# quantity: radiance per um' '0.5 2' '0.75 4' >density.spd
  specconvert --input-unit um density.spd -o nm.spd
  has_numbers nm.spd '500 0.002' '750 0.004'
  grep -qx '# quantity: radiance per nm' nm.spd
  # No density over the wavelength: the quantity does not end so.
  sed 's/per um/per um of depth/' density.spd >depth.spd
  specconvert --input-unit um depth.spd -o nm.spd
  has_numbers nm.spd '500 2' '750 4'
  fails_cleanly specconvert --input-unit eV um.csv -o x.spd
  spectral a.exr
  fails_cleanly specconvert --input-unit um a.exr -o x.exr
}

# Arithmetic

@test "--divide, --add, --scale, --raise and --clamp, in the order given, of images and curves" {
  spectral a.exr --size 1x1 --grid 400:440:20
  light two.spd 300 2 500 2
  light ramp.spd 400 1 440 5
  specconvert a.exr -o a.spd
  for kind in exr spd; do
    specconvert --divide two.spd a.$kind -o b.$kind
    near b.$kind 'want = (0.001 + (nm - 400) / 200) / 2'
    specconvert --add two.spd --scale 3 a.$kind -o b.$kind
    near b.$kind 'want = (0.001 + (nm - 400) / 200 + 2) * 3'
    specconvert --add two.spd --divide ramp.spd a.$kind -o b.$kind
    near b.$kind 'want = (0.001 + (nm - 400) / 200 + 2) / (1 + (nm - 400) / 10)'
    specconvert --scale 3 --add ramp.spd a.$kind -o b.$kind
    near b.$kind 'want = (0.001 + (nm - 400) / 200) * 3 + 1 + (nm - 400) / 10'
    specconvert --multiply ramp.spd --raise 2 --scale 2 --clamp 0.01..1 a.$kind -o b.$kind
    near b.$kind 'want = 2 * ((0.001 + (nm - 400) / 200) * (1 + (nm - 400) / 10)) ^ 2
      if (want < 0.01) want = 0.01; if (want > 1) want = 1'
    specconvert --clamp 0.01..1 --scale 2 --raise -1 a.$kind -o b.$kind
    near b.$kind 'want = 0.001 + (nm - 400) / 200; if (want < 0.01) want = 0.01; want = 1 / (2 * want)'
  done
}

@test "what two tools do one after the other, one does at once" {
  spectral a.exr --pattern grain
  light ramp.spd 400 1 700 5
  specconvert --divide ramp.spd a.exr | specconvert --add ramp.spd | specconvert --raise 0.5 |
    specconvert --clamp 1..1.5 -o steps.exr
  specconvert --divide ramp.spd --add ramp.spd --raise 0.5 --clamp 1..1.5 a.exr -o once.exr
  # a float rounded three times more
  specdiff --tolerance max=3e-7 steps.exr once.exr
  for threads in 1 3; do
    specconvert --no-history -j $threads --divide ramp.spd --raise 0.5 a.exr -o $threads.exr
  done
  cmp 1.exr 3.exr
}

@test "a mean is one of what the operations have made" {
  spectral a.exr --size 4x2 --grid 500:520:20
  specconvert --raise 2 --downsample 2 a.exr -o b.exr
  numbers b.exr | awk '{ band = $1 == 500 ? 0 : 0.1
    for (block = 0; block < 2; block++) {
      want = 0
      for (x = 0; x < 2; x++) for (y = 0; y < 2; y++)
        want += ((2 * block + x + 1) * 0.001 + y * 0.01 + band) ^ 2 / 4
      if (($(2 + block) / want - 1) ^ 2 > 4e-14) { print; bad = 1 }
    } } END { exit bad || NR != 2 }'
}

@test "division by zero is refused before a pixel is read, and names the wavelength" {
  spectral a.exr
  light gap.spd 400 1 500 0 700 1
  head -c 4000 a.exr >short.exr
  fails_cleanly specconvert --divide gap.spd short.exr -o b.exr
  [[ $stderr = *"'gap.spd': it is 0 at 500 nm" ]] || complain "$stderr"
  light a.spd 400 1 700 1
  fails_cleanly specconvert --divide gap.spd a.spd -o b.spd
  [[ $stderr = *'it is 0 at 500 nm' ]] || complain "$stderr"
  no_leftovers . a.exr short.exr gap.spd a.spd
}

@test "what is not the same is not added" {
  spectral light.exr
  spectral paint.exr --kind T
  spectral band.exr --quantity 'radiance per band'
  light light.spd 300 1 800 1
  ratio ratio.spd 300 1 800 1
  fails_cleanly specconvert --add light.spd paint.exr -o x.exr
  fails_cleanly specconvert --add ratio.spd light.exr -o x.exr
  fails_cleanly specconvert --add light.spd band.exr -o x.exr
  fails_cleanly specconvert --add light.spd ratio.spd -o x.spd
  for unit in W kW; do
    { printf '# quantity: spectral power distribution\n# unit: %s nm-1\n' $unit; printf '%s\n' '300 1' '800 1'; } >$unit.spd
  done
  fails_cleanly specconvert --add W.spd kW.spd -o x.spd
  specconvert --add W.spd light.spd | grep -qx '# unit: W nm-1'
  specconvert --add light.spd W.spd | grep -qx '# unit: W nm-1'
  fails_cleanly specconvert --raise 2 --add light.spd light.exr -o x.exr
  specconvert --illuminate light.spd --add light.spd paint.exr -o lit.exr
  specconvert --add ratio.spd paint.exr -o two.exr
  printf '%s\n' '300 1' '800 1' >one.spd
  specconvert --add one.spd light.exr -o x.exr
  specconvert --add one.spd paint.exr -o x.exr
}

@test "powers and bounds of Stokes components, light layers and reradiation are refused" {
  spectral stokes.exr --kind stokes
  spectral glow.exr --size 1x1 --channel T.400nm --channel T.500nm --channel T.400nm.500nm
  "$TESTS/layers" --scene flat --size 4x4 --grid 400:700:50 -o layers.exr
  light one.spd 300 1 800 1
  ratio half.spd 300 0.5 800 0.5
  for operation in '--raise 2' '--clamp 0..1'; do
    for file in stokes glow layers; do
      # shellcheck disable=SC2086 # two words
      fails_cleanly specconvert $operation $file.exr -o x.exr
    done
  done
  fails_cleanly specconvert --add half.spd glow.exr -o x.exr
  specconvert --illuminate one.spd --raise 2 glow.exr -o x.exr
  # T.400 = 0.001, T.500 = 0.101, T.400.500 = 0.201
  near x.exr 'want = nm == 400 ? 0.001 ^ 2 : 0.302 ^ 2' 2e-7
  # Light that is added is not polarised.
  specconvert --add one.spd --grid 400:400:1 --crop 0,0,1,1 stokes.exr -o x.exr
  pixel_holds stokes.exr x.exr 0,0 '
    is("S0.400,000000nm", from["S0.400,000000nm"] + 1)
    for (s = 1; s < 4; s++) is("S" s ".400,000000nm", from["S" s ".400,000000nm"])'
}

@test "what is raised says so, and what has no power is counted" {
  spectral a.exr --size 2x1 --grid 500:510:10 --pattern negative
  warns 'b.exr: 4 samples have no finite power' specconvert --raise 0.5 a.exr -o b.exr
  has_line b.exr 'spec:quantity (type string): "(radiance per nm)^0.5"'
  spectral t.exr --kind T --quantity transmittance --pattern constant:0.5 --size 1x1
  specconvert --raise 3 t.exr -o b.exr
  has_line b.exr 'spec:quantity (type string): "transmittance"'
  near b.exr 'want = 0.125'
  # A NaN that was there is not counted, and passes a bound.
  spectral nan.exr --size 1x1 --grid 500:510:10 --pattern nan:0,0,0
  specconvert --raise 2 nan.exr -o b.exr 2>said
  [ ! -s said ]
  specconvert --clamp 0..1 nan.exr -o b.exr
  pixel_holds b.exr b.exr 0,0 'if (to["S0.500,000000nm"] !~ /nan/) wrong(to["S0.500,000000nm"])'
  warns 'b.exr: 2 samples have no finite power' \
    specconvert --grid 500:500:1 --raise 1.5 a.exr -o b.exr
  light minus.spd 400 1 500 -1
  specconvert --raise 2 minus.spd -o b.spd
  [ "$(grep -c '^# quantity' b.spd)" -eq 0 ]
  specconvert --raise 1 minus.spd -o b.spd
  grep -qx '# quantity: spectral power distribution' b.spd
  ratio half.spd 400 0.5 500 0.5
  specconvert --raise 2 half.spd -o b.spd
  grep -qx '# quantity: transmittance' b.spd
  fails_cleanly specconvert --raise 0.5 minus.spd -o b.spd
  [[ $stderr = *'500 nm'* ]] || complain "$stderr"
}

@test "a power that is none, a range that is none" {
  spectral a.exr
  for power in x '' 1e9 nan; do fails_cleanly specconvert --raise "$power" a.exr -o b.exr; done
  for range in 1..0 1 ..1 0.. a..b 0:1 ''; do fails_cleanly specconvert --clamp "$range" a.exr -o b.exr; done
}

@test "--reflectance-of divides by the light, and --illuminate takes that back" {
  spectral t.exr --kind T --pattern grain
  light lamp.spd 400 1 700 4
  specconvert --illuminate lamp.spd t.exr -o s.exr
  specconvert --reflectance-of lamp.spd s.exr -o back.exr
  # two floats rounded, of values below 1
  specdiff --tolerance max=1.3e-7 t.exr back.exr
  has_line back.exr 'spec:quantity (type string): "reflectance"'
  run ! grep emissiveUnits <<<"$(exrheader back.exr)"
  # At once: the same scene in another light.
  specconvert --reflectance-of lamp.spd --illuminate A s.exr -o relit.exr
  specconvert --illuminate A t.exr -o wanted.exr
  specdiff --tolerance max=3e-5 wanted.exr relit.exr
}

@test "--reflectance-of leaves out what the light does not show, and says so" {
  spectral s.exr --size 1x1 --grid 400:700:100 --pattern constant:2
  light lamp.spd 400 0.001 500 4 600 0.1 700 0
  warns "s.exr: without the bands at 400 700 nm, where 'lamp.spd' is below 0.001 of its most" \
    specconvert --reflectance-of lamp.spd s.exr -o t.exr
  has_numbers t.exr '500 0.5' '600 20'
  warns "s.exr: without the bands at 400 600 700 nm, where 'lamp.spd' is below 0.1 of its most" \
    specconvert --reflectance-of lamp.spd --least 0.1 s.exr -o t.exr
  warns "s.exr: without the bands at 700 nm, where 'lamp.spd' is below 0 of its most" \
    specconvert --reflectance-of lamp.spd --least 0 s.exr -o t.exr
  # what is just as much as that stays
  light half.spd 400 2 700 4
  specconvert --reflectance-of half.spd --least 0.5 s.exr -o t.exr
  has_numbers t.exr '400 1' '500 0.75' '600 0.6' '700 0.5'
  light dark.spd 400 0 700 0
  fails_cleanly specconvert --reflectance-of dark.spd s.exr -o x.exr
  spectral t2.exr --kind T
  fails_cleanly specconvert --reflectance-of lamp.spd t2.exr -o x.exr
  spectral stokes.exr --kind stokes
  fails_cleanly specconvert --reflectance-of lamp.spd stokes.exr -o x.exr
  [[ $stderr = *'is polarised, which reflectance (T) cannot say' ]] || complain "$stderr"
  "$TESTS/layers" --scene flat --size 4x4 --grid 400:700:50 -o layers.exr
  fails_cleanly specconvert --reflectance-of D65 layers.exr -o x.exr
  spectral band.exr --quantity 'radiance per band'
  fails_cleanly specconvert --reflectance-of D65 band.exr -o x.exr
  light a.spd 400 1 700 1
  fails_cleanly specconvert --reflectance-of D65 a.spd -o x.spd
}

@test "bins stay where the bands that are left out are at an end" {
  spectral s.exr --size 1x1 --grid 400:700:100 --bins
  light end.spd 400 0 500 4 600 4 700 4
  specconvert -q --reflectance-of end.spd s.exr -o t.exr
  has_line t.exr 'spec:bins (type string): "450 550 650 750"'
  light middle.spd 400 4 500 0 600 4 700 4
  specconvert -q --reflectance-of middle.spd s.exr -o t.exr
  run ! grep spec:bins <<<"$(exrheader t.exr)"
}

# What else is in the image

@test "--bands-only drops all but the bands" {
  spectral a.exr --size 2x2 --grid 500:510:10 --extra A --extra Z --uint-id
  specconvert --bands-only a.exr -o b.exr
  has_channels b.exr S0.500,000000nm S0.510,000000nm
  "$TESTS/layers" --scene pair --size 4x4 --grid 400:700:100 -o layers.exr
  specconvert --bands-only --raise 2 layers.exr -o b.exr
  [ "$(channels b.exr | wc -l)" -eq 4 ]
  spectral rgb.exr --channel R --channel G --channel B
  fails_cleanly specconvert --bands-only rgb.exr -o c.exr
}

@test "light layers follow the bands: a filter at the lens, before the films or after them" {
  "$TESTS/layers" --scene sphere --shape ramp --size 12x12 --grid 400:700:20 -o layers.exr
  ratio filter.spd 400 0.25 700 1
  stack='air | 1.33 500nm | air'
  specconvert --multiply filter.spd layers.exr | specfilm --stack "$stack" -o before.exr
  specfilm --stack "$stack" layers.exr | specconvert --multiply filter.spd -o after.exr
  specdiff --tolerance max=5e-7 before.exr after.exr
  specconvert --grid 440:640:40 layers.exr | specfilm --stack "$stack" -o before.exr
  specfilm --stack "$stack" layers.exr | specconvert --grid 440:640:40 -o after.exr
  specdiff --tolerance max=5e-7 before.exr after.exr
  specconvert --band 500 --band 600 layers.exr | specfilm --stack "$stack" -o before.exr
  specfilm --stack "$stack" layers.exr | specconvert --band 500 --band 600 -o after.exr
  specdiff --tolerance max=5e-7 before.exr after.exr
  # Light that is added there is added once.
  light glow.spd 400 1 700 2
  specconvert --add glow.spd layers.exr | specfilm --stack "$stack" -o before.exr
  specfilm --stack "$stack" layers.exr | specconvert --add glow.spd -o after.exr
  specdiff --tolerance max=5e-7 before.exr after.exr
  "$TESTS/layers" --scene disc --size 8x8 --grid 400:700:20 -o disc.exr
  specconvert --multiply filter.spd disc.exr | specdisc --preset cd -o before.exr
  specdisc --preset cd disc.exr | specconvert --multiply filter.spd -o after.exr
  specdiff --tolerance max=5e-6 before.exr after.exr
}

@test "--downsample weighs geometry by cover, and directions stay of unit length" {
  "$TESTS/layers" --scene sphere --size 8x8 --grid 500:600:100 -o a.exr
  specconvert --downsample 4 a.exr -o b.exr
  # the means of the upper left quarter, of the pixels in which the bubble is
  for ((i = 0; i < 16; i++)); do
    "$TESTS/layers" --print $((i % 4)),$((i / 4)) a.exr | sed "s/^/$i /"
  done >pixels
  "$TESTS/layers" --print 0,0 b.exr | sed 's/^/- /' >mean
  awk "$statements"'
    { value[$1, $2] = $3; to[$2] = $3 }
    END {
      for (k = 1; k <= 2; k++) {
        film = "film" k "."
        for (i = 0; i < 16; i++) cover += value[i, film "cover"] / 32
        split("P.X P.Y P.Z Q.X Q.Y Q.Z cosine N.X N.Y N.Z Ns.X Ns.Y Ns.Z I.X I.Y I.Z", name, " ")
        for (n = 1; n <= 16; n++) {
          mean[n] = weight = 0
          for (i = 0; i < 16; i++) {
            mean[n] += value[i, film "cover"] * value[i, film name[n]]
            weight += value[i, film "cover"]
          }
          mean[n] /= weight
        }
        for (n = 8; n <= 16; n++) {
          first = n - (n - 8) % 3
          long = sqrt(mean[first] ^ 2 + mean[first + 1] ^ 2 + mean[first + 2] ^ 2)
          is(film name[n], mean[n] / long)
        }
        for (n = 1; n <= 7; n++) is(film name[n], mean[n])
        is(film "id", 1)
      }
      is("film1.cover", cover)
      if (!(cover > 0.2 && cover < 0.8)) wrong("the pixel is covered in whole: " cover)
      exit failed
    }' pixels mean || complain "$(cat mean)"
}

@test "--downsample where nothing is covered gives 0, and ids go by cover" {
  spectral a.exr --size 2x2 --channel S0.500nm --channel cover --channel P.X --channel u \
    --pattern constant:0 --uint-id
  specconvert --downsample 2 a.exr -o b.exr
  pixel_holds a.exr b.exr 0,0 'is("P.X", 0); is("u", 0); is("id", 0)'
  # cover 0.001 .. of the ramp's pixels: 1, 2, 11 and 12 thousandths; id x + 65536 y
  spectral a.exr --size 2x2 --channel cover --channel u --channel S0.500nm --channel v --uint-id
  specconvert --downsample 2 a.exr -o b.exr
  pixel_holds a.exr b.exr 0,0 '
    is("id", 65537)
    is("cover", 0.0065)
    is("u", (1 * 0.101 + 2 * 0.102 + 11 * 0.111 + 12 * 0.112) / 26)
    is("v", (1 * 0.301 + 2 * 0.302 + 11 * 0.311 + 12 * 0.312) / 26)'
  # One id everywhere, and nowhere its surface.
  spectral a.exr --size 2x2 --channel S0.500nm --channel cover --pattern constant:0 --uint-id --compression none
  size=$(wc -c <a.exr)
  for line in 0 1; do
    poke a.exr $((size - 8 - 32 * line)) "$(little 4 7)$(little 4 7)"
  done
  specconvert --downsample 2 a.exr -o b.exr
  pixel_holds a.exr b.exr 0,0 'is("cover", 0); if (from["id"] != 7) wrong("no 7"); is("id", 0)'
}

@test "--downsample leaves the directions to lamps of unit length" {
  "$TESTS/layers" --scene disc --size 16x16 --grid 500:600:100 -o a.exr
  specconvert --downsample 4 a.exr -o b.exr
  seen=0
  for y in 0 1 2 3; do
    for x in 0 1 2 3; do
      "$TESTS/layers" --print $x,$y b.exr >pixel
      awk '$1 == "cover" { cover = $2 } $1 ~ /^lamp1[.]D/ { square += $2 ^ 2 }
        END { if (!(cover > 0)) exit 1; off = square - 1; exit off * off > 1e-12 ? 2 : 0 }' pixel && seen=$((seen + 1)) ||
        [ $? -eq 1 ] || complain "$(<pixel)"
    done
  done
  [ $seen -gt 3 ]
}

@test "R, G and B that are bands by name are no preview" {
  spectral rgb.exr --size 1x1 --channel R --channel G --channel B
  specconvert --name-map R=650nm,G=550nm,B=450nm --scale 2 rgb.exr -o b.exr
  has_channels b.exr S0.450,000000nm S0.550,000000nm S0.650,000000nm
}

@test "the grid comes before the operations, for curves as for images" {
  ratio ramp.spd 400 0 500 1
  ratio bend.spd 400 1 430 4 500 1
  for how in '--grid 400:500:20' '--grid 410:490:20 --interp left' '--rebin --grid 400:500:20 -q'; do
    for file in spd exr; do
      specconvert ramp.spd -o ramp.exr
      # shellcheck disable=SC2086 # several words
      specconvert $how --multiply bend.spd --raise 2 --clamp 0.1..0.5 ramp.$file -o $file.$file
    done
    numbers exr.exr >image
    numbers spd.spd | paste -d ' ' - image | awk '($1 != $3) || ($2 - $4) ^ 2 > 1e-14 { exit 1 } END { exit NR < 4 }' ||
      complain "$how" "$(numbers spd.spd)" "$(cat image)"
  done
  # not on the line between the ends, 0.1 and 0.5
  specconvert --grid 460:460:1 --clamp 0.1..0.5 ramp.spd -o one.spd
  has_numbers one.spd '460 0.5'
}

# Strips

# bytes FILE.ppm COUNT: the last ones.
bytes() {
  tail -c "$2" "$1" | od -A n -v -t u1 | xargs
}

@test "--strip makes red, green and blue of three columns, a pixel for each wavelength" {
  printf '%s\n' '400 0.25 0.5 0.125' '500 0.5 2 0' >three.spd
  specconvert three.spd --strip 1 --scaling global -o global.ppm
  # 255 / 8 = 31.9, / 4 = 63.8, / 16 = 15.9
  [ "$(bytes global.ppm 6)" = '32 64 16 64 255 0' ]
  specconvert three.spd --strip 2 --scaling channel -o channel.ppm
  [ "$(bytes channel.ppm 12)" = '128 64 255 255 255 0 128 64 255 255 255 0' ]
  specconvert three.spd --strip 1 -o float.exr
  [ "$("$TESTS/layers" --print 1,0 float.exr | xargs)" = 'B 0 G 2 R 0.5' ]
  specconvert three.spd --grid 450:450:1 --scale 0.5 --strip 1 -o one.exr
  [ "$("$TESTS/layers" --print 0,0 one.exr | xargs)" = 'B 0.03125 G 0.625 R 0.1875' ]
  printf '%s\n' '400 0.25' '500 1' >grey.spd
  specconvert grey.spd --strip 1 -o grey.ppm
  [ "$(bytes grey.ppm 6)" = '64 64 64 255 255 255' ]
}

@test "a strip that bytes cannot hold, or of other columns, is refused" {
  printf '%s\n' '400 0.25 0.5 0.125' '500 0.5 2 0' >three.spd
  printf '%s\n' '400 0.25 0.5' '500 0.5 1' >two.spd
  printf '%s\n' '400 -0.25' '500 1' >minus.spd
  printf '%s\n' '400 0' '500 0' >dark.spd
  fails_cleanly specconvert three.spd --strip 1 -o x.ppm
  [[ $stderr = *'is 2 at 500 nm'* ]] || complain "$stderr"
  fails_cleanly specconvert two.spd --strip 1 -o x.exr
  fails_cleanly specconvert minus.spd --strip 1 --scaling global -o x.ppm
  fails_cleanly specconvert dark.spd --strip 1 --scaling channel -o x.ppm
  fails_cleanly specconvert three.spd three.spd --strip 1 -o x.exr
  fails_cleanly specconvert three.spd --strip 0 -o x.exr
  fails_cleanly specconvert three.spd --strip 1 --scaling most -o x.exr
  fails_cleanly specconvert three.spd --strip 1 -o x.spd
  fails_cleanly specconvert three.spd --scaling global -o x.spd
  spectral a.exr
  fails_cleanly specconvert a.exr --strip 1 -o x.exr
  no_leftovers . three.spd two.spd minus.spd dark.spd a.exr
  fails_cleanly specconvert --strip 2 --atlas cie1931 -o a.exr
  [[ $stderr = *'--strip makes a picture of one curve'* ]] || complain "$stderr"
  fails_cleanly specconvert --strip 2 --to fourier:3 E -o a.png
  [[ $stderr = *'--to excludes'*'--strip' ]] || complain "$stderr"
}

@test "a reradiation matrix of 861 channels under a light: each band is its sum" {
  names=()
  for ((i = 400; i <= 720; i += 8)); do
    names+=(--channel "T.$i,0nm")
    for ((j = i + 8; j <= 720; j += 8)); do names+=(--channel "T.$i,0nm.$j,0nm"); done
  done
  spectral glow.exr --size 1100x1 "${names[@]}" --pattern grain
  light lamp.spd 400 1 720 9
  specconvert --illuminate lamp.spd glow.exr -o lit.exr
  # also behind the first run of pixels, and with an odd rest of terms
  for x in 0 1023 1024 1099; do
    pixel_holds glow.exr lit.exr $x,0 '
      for (name in from) {
        split(name, part, ".")
        sub(/nm/, "", part[2]); sub(/nm/, "", part[3])
        sub(/,.*/, "", part[2]); sub(/,.*/, "", part[3])
        out = part[3] ? part[3] : part[2]
        sum[out] += from[name] * (1 + (part[2] - 400) / 40)
      }
      for (out in sum) { is("S0." out ",000000nm", sum[out]); n++ }
      if (n != 41) wrong(n " bands")'
  done
}
