#!/usr/bin/env bats
# specinfo: what is in a file, as text and as JSON; statistics; and every finding of --check.
# shellcheck disable=SC2154 # fails_cleanly leaves its line in stderr
# shellcheck disable=SC2016 # jq's variables
# shellcheck disable=SC2030,SC2031 # each test is a subshell, and its variables its own

load common

# prints LINE COMMAND...: it is among the lines on stdout, and the exit status is 0.
prints() {
  local line=$1 answer
  shift
  answer=$("$@") || complain "exit $?: $*" || return 1
  grep -qxF -e "$line" <<<"$answer" || complain "no line '$line' in:" "$answer"
}

# value FILTER COMMAND...: what jq makes of the JSON that a command prints.
value() {
  local filter=$1
  shift
  "$@" >printed.json || complain "exit $?: $*" || return 1
  jq -cer "$filter" printed.json
}

# holds FILTER COMMAND...: jq finds it true.
holds() {
  [ "$(value "$@")" = true ] || complain "not true: $1" "$(cat printed.json)"
}

# checks CODE FILE LINE...: --check ends with that status and prints these lines, no others,
# behind the file's name; from a file and from a pipe.
checks() {
  local wanted=$1 file=$2 code=0 answer
  shift 2
  answer=$(specinfo --check "$file") || code=$?
  [ "$code" -eq "$wanted" ] || complain "exit $code instead of $wanted" "$answer" || return 1
  [ "$answer" = "$([ $# = 0 ] || printf "$file: %s\n" "$@")" ] ||
    complain "$answer" 'instead of:' "$@" || return 1
  code=0
  answer=$(cat "$file" | specinfo --check -) || code=$?
  [ "$code" -eq "$wanted" ] || complain "pipe: exit $code instead of $wanted" || return 1
  [ "$answer" = "$([ $# = 0 ] || printf '<stdin>: %s\n' "$@")" ] || complain "pipe: $answer"
}

# light_of FILE: names of its S0 bands.
light_of() {
  channels "$1" | grep '^S0'
}

# Options and input

@test "help, version, options that are not there" {
  specinfo --help | grep -q '^usage: specinfo '
  [[ $(specinfo --version) = 'specinfo (spectools) '* ]]
  fails_cleanly specinfo --jsno
  [[ $stderr = *"did you mean '--json'?" ]] || complain "$stderr"
  fails_cleanly specinfo --check --bands missing.exr
  fails_cleanly specinfo - -
}

@test "an image on standard input, named and not" {
  spectral a.exr
  prints '  bands         16, 400..700 nm by 20 nm, float' specinfo <a.exr
  prints '<stdin>' specinfo - < <(cat a.exr)
  diff <(specinfo -s a.exr | tail -n +2) <(cat a.exr | specinfo -s | tail -n +2)
}

@test "a pipe is read to its end, so that who writes it is not killed" {
  spectral a.exr --size 640x480 --compression none
  set -o pipefail
  cat a.exr | specinfo >printed
}

@test "a file that is missing, a folder, a text, nothing" {
  fails_cleanly specinfo missing.exr
  [[ $stderr = *missing.exr*'No such file or directory' ]] || complain "$stderr"
  mkdir folder.exr
  fails_cleanly specinfo folder.exr
  echo text >text.exr
  fails_cleanly specinfo text.exr
  fails_cleanly specinfo </dev/null
  fails_cleanly specinfo --check </dev/null
  fails_cleanly specinfo no-such-spectrum
}

@test "a file that ends early: in the header, and where pixels are read" {
  spectral a.exr --size 9x7 --grid 500:540:20 --compression none
  size=$(wc -c <a.exr)
  head -c 200 a.exr >header.exr
  head -c $((size - 1)) a.exr >pixels.exr
  for option in --json --statistics --check; do
    fails_cleanly specinfo $option header.exr
  done
  specinfo pixels.exr >/dev/null
  for option in --statistics --bands --check; do
    fails_cleanly specinfo $option pixels.exr
    [[ $stderr = *'ends early, in line 6 of 0..6' ]] || complain "$stderr"
    fails_cleanly specinfo $option < <(cat pixels.exr)
  done
}

@test "a full disk, and a closed output" {
  spectral a.exr
  code=0
  specinfo a.exr >/dev/full 2>err || code=$?
  [ "$code" -eq 2 ]
  [ "$(cat err)" = "specinfo: unable to write '<stdout>': No space left on device" ]
  code=0
  specinfo --check --json a.exr >&- 2>err || code=$?
  [ "$code" -eq 2 ]
  [ "$(wc -l <err)" -eq 1 ]
}

@test "the output in a file" {
  spectral a.exr
  specinfo a.exr -o a.txt
  diff a.txt <(specinfo a.exr)
  echo old >old.txt
  fails_cleanly specinfo a.exr missing.exr -o old.txt
  [ "$(cat old.txt)" = old ]
}

@test "--progress shows lines on standard error where pixels are read, and -q none" {
  spectral a.exr
  specinfo --statistics a.exr >told 2>said
  [ ! -s said ]
  specinfo --progress --statistics a.exr 2>said | diff told -
  grep -q '100% .* lines/s' said || complain "$(cat said)"
  specinfo --progress -q --statistics a.exr 2>said | diff told -
  [ ! -s said ]
}

@test "several files: an empty line between them, and trouble with one is not the others'" {
  spectral a.exr
  spectral b.exr --kind T
  [ "$(specinfo a.exr b.exr D65 | grep -c '^$')" -eq 2 ]
  code=0
  specinfo a.exr missing.exr b.exr >printed 2>err || code=$?
  [ "$code" -eq 2 ]
  [ "$(wc -l <err)" -eq 1 ]
  [ "$(grep -c '^[^ ]' printed)" -eq 2 ] || complain "$(cat printed)"
}

# What is told

@test "all of a plain image" {
  spectral a.exr --attribute owner=nobody
  [ "$(specinfo a.exr)" = 'a.exr
  format        OpenEXR, compression zip
  size          16 x 8 pixels, 8 KiB uncompressed
  bands         16, 400..700 nm by 20 nm, float
  samples       points
  quantity      radiance per nm [W m^-2 sr^-1 nm^-1]
  role          emissive
  names         layout, such as S0.400,000000nm
  attributes    spectralLayoutVersion  1.0
                emissiveUnits          W.m^-2.sr^-1
                owner                  nobody' ] || complain "$(specinfo a.exr)"
}

@test "windows, bins, samples, channels, history" {
  spectral a.exr --size 5x3 --data=-2,7 --display 0,0,64,48 --bins --half --extra A --extra Z --uint id \
    --quantity 'radiance per band' --compression piz
  prints '  data window   -2,7,3,10' specinfo a.exr
  prints '  display       0,0,64,48' specinfo a.exr
  prints '  samples       integrals over bins, 390..710 nm' specinfo a.exr
  prints '  bands         16, 400..700 nm by 20 nm, half' specinfo a.exr
  prints '  quantity      radiance per band [W m^-2 sr^-1]' specinfo a.exr
  prints '  format        OpenEXR, compression piz' specinfo a.exr
  holds '.format == "OpenEXR" and .compression == "piz"' specinfo --json a.exr
  prints '  geometry      id' specinfo a.exr
  prints '  channels      float: A Z' specinfo a.exr
  specconvert --scale 2 a.exr | specconvert --scale "0.5" -o b.exr
  specinfo b.exr | grep -A1 '^  history       specconvert --scale 2 a.exr  # spectools' |
    grep '^                specconvert --scale 0.5 -o b.exr  # spectools'
  holds '.history | length == 2 and (.[0] | startswith("specconvert --scale 2 a.exr  # "))' specinfo --json b.exr
  holds '.data_window == [-2, 7, 3, 10] and .display_window == [0, 0, 64, 48]' specinfo --json a.exr
  holds '.edges_nm == [range(390; 711; 20)] and .unit == "W m^-2 sr^-1"' specinfo --json a.exr
}

@test "sizes, pixel aspects and what is too long for a line" {
  spectral a.exr --size 600x60 --grid 380:780:5 --compression none
  prints '  size          600 x 60 pixels, 11.1 MiB uncompressed' specinfo a.exr
  holds '.bytes == 600 * 60 * 81 * 4 and .pixel_aspect_ratio == 1' specinfo --json a.exr
  run ! grep -q aspect <(specinfo a.exr)
  for number in {10..40}; do
    many+=(--extra "C$number")
  done
  spectral b.exr --size 4x2 --half --attribute "owner=$(printf 'x%.0s' {1..70})" --extra Zebra "${many[@]}"
  exrstdattr -pixelAspectRatio 1.25 b.exr c.exr
  prints '  pixel aspect  1.25' specinfo c.exr
  holds '.pixel_aspect_ratio == 1.25 and .bytes == 4 * 2 * (16 * 2 + 32 * 4)' specinfo --json c.exr
  prints "                owner                  $(printf 'x%.0s' {1..64}) ... (70 bytes)" specinfo c.exr
  prints "  channels      float:$(printf ' C%s' {10..25}) and 16 more" specinfo c.exr
}

@test "other formats have no compression" {
  spectral a.exr --size 5x3 --pattern constant:0.5 --bins
  while read -r file format; do
    specconvert a.exr -o "$file"
    prints "  format        $format" specinfo "$file"
    holds ".format == \"$format\" and .compression == null" specinfo --json "$file"
  done <<'END'
a.hdr ENVI
a.hsr Radiance HSR
a.tif picture
END
}

@test "quantities and their units" {
  for quantity in transmittance absorptance 'reflectance factor'; do
    spectral a.exr --kind T --quantity "$quantity"
    prints "  quantity      $quantity [1]" specinfo a.exr
    holds '.unit == "1"' specinfo --json a.exr
  done
  spectral a.exr --quantity irradiance
  prints '  quantity      irradiance' specinfo a.exr
}

@test "what stands for the bands" {
  spectral a.exr
  holds '.representation == null' specinfo --json a.exr
  specconvert --to fourier:5 a.exr -o b.exr
  prints '  stored as     fourier 5 400 700' specinfo b.exr
  prints '  bands         16, 400..700 nm by 20 nm, float' specinfo b.exr
  holds '.representation == "fourier 5 400 700" and .bands == 16' specinfo --json b.exr
}

@test "grids: irregular, a single band, three decimals" {
  spectral a.exr --channel S0.400,000000nm --channel S0.410,000000nm --channel S0.700,000000nm
  prints '  bands         3, 400..700 nm, irregular, float' specinfo a.exr
  holds '.step_nm == null and .wavelength_nm == [400, 410, 700]' specinfo --json a.exr
  spectral b.exr --channel T.550nm
  prints '  bands         1, 550 nm, float' specinfo b.exr
  spectral c.exr --channel S0.367,344nm --channel S0.382,031nm --channel S0.396,719nm
  prints '  bands         3, 367.344..396.719 nm by 14.6875 nm, float' specinfo c.exr
}

@test "the names of other programs" {
  spectral mitsuba.exr --channel 400.00-410.00nm --channel 410.00-420.00nm
  prints '  names         mitsuba, such as 400.00-410.00nm' specinfo mitsuba.exr
  prints '  samples       means over bins, 400..420 nm' specinfo mitsuba.exr
  spectral iset.exr --channel Radiance.C01 --channel Radiance.C02
  holds '.naming == "iset3d" and .wavelength_nm == [400, 410]' specinfo --json iset.exr
  spectral kaist.exr --channel w420nm
  holds '.naming == "kaist" and .role == "reflective" and .quantity == "reflectance"' specinfo --json kaist.exr
  spectral ocean.exr --channel a --channel b --attribute a.wavelength=4.5e-7 --attribute b.wavelength=5.5e-7
  prints '  names         ocean, such as a' specinfo ocean.exr
  spectral given.exr --channel a --channel b
  holds '.naming == "given" and .wavelength_nm == [450]' specinfo --json --name-map a=450nm given.exr
}

@test "polarised, bispectral, not spectral" {
  spectral stokes.exr --kind stokes
  prints '  role          emissive, polarised (S0 S1 S2 S3)' specinfo stokes.exr
  holds '.stokes == 4 and .bands == 16 and (.channels | length) == 64 and
    ([.channels[].stokes] | unique == [0, 1, 2, 3])' specinfo --json stokes.exr
  spectral bi.exr --channel T.400nm --channel T.500nm --channel T.400nm.500nm
  prints '  role          reflective, bispectral (1 channels off the diagonal)' specinfo bi.exr
  holds '.bispectral == 1 and .channels[1].reradiated_nm == 500' specinfo --json bi.exr
  spectral rgb.exr --channel R --channel G --channel B
  prints '  bands         none: the image is not spectral' specinfo rgb.exr
  holds '.bands == 0 and .role == null and .naming == null and .quantity == null and .stokes == 0' specinfo --json rgb.exr
}

@test "light layers and geometry" {
  "$TESTS/layers" --scene sphere --size 8x8 --grid 400:700:100 -o films.exr
  prints '  layers        film1: mirror, P N Ns I cosine Q id cover' specinfo films.exr
  prints '                film2: mirror, P N Ns I cosine Q id cover' specinfo films.exr
  prints '                through' specinfo films.exr
  holds '.layers == ["film1", "film2", "through"] and .geometry == []' specinfo --json films.exr
  "$TESTS/layers" --scene disc --size 8x8 --grid 400:700:100 -o disc.exr
  prints '  layers        lamp1: irradiance, D' specinfo disc.exr
  prints '  geometry      P N Ns Tan I cosine Q id cover' specinfo disc.exr
  holds '.layers == ["lamp1"] and .geometry[3] == "Tan"' specinfo --json disc.exr
  spectral bad.exr --grid 400:500:100 --extra film1.mirror.S0.400,000000nm
  specinfo bad.exr | grep -q "^  layers        unusable: .*no band at 500 nm"
  holds '.layers == [] and (.layers_error | contains("no band at 500 nm"))' specinfo --json bad.exr
}

@test "parts and tiles" {
  spectral one.exr
  spectral two.exr --channel Y
  exrmultipart -combine -i two.exr one.exr -o parts.exr >/dev/null
  prints '  part          1 of 2, counted from 0, named one' specinfo parts.exr
  holds '.parts == 2 and .part == 0 and .part_name == "two" and .bands == 0' specinfo --json --part two parts.exr
  exrmaketiled -t 8 4 one.exr tiles.exr
  prints '  format        OpenEXR, compression zip, tiles of 8 x 4' specinfo tiles.exr
  holds '.tiles == [8, 4]' specinfo --json tiles.exr
}

@test "a curve, by name, from a file and from standard input" {
  prints '  title         CIE standard illuminant D65' specinfo D65
  prints '  samples       107, 300..830 nm by 5 nm, in air' specinfo D65
  prints '  samples       45, 203.3..1937 nm, irregular, in vacuum' specinfo Au
  prints '                k: 1.277 at 203.3 nm to 13.78 at 1937 nm' specinfo Au
  holds '.format == "spd" and .medium == "vacuum" and .count == 45 and .step_nm == null' specinfo --json Au
  holds '.columns | map(.name) == ["n", "k"]' specinfo --json Au
  holds '.quantity == "refractive index" and .unit == "1" and (.source | startswith("P. B. Johnson and R. W. Christy, "))' \
    specinfo --json Au
  prints '  quantity      refractive index' specinfo Au
  prints '  unit          1' specinfo Au
  specinfo Au | grep -q '^  source        P. B. Johnson and R. W. Christy, '
  printf '%s\n' '# title: a "filter"' 400,0.5 500,-1 600,3 >a.spd
  holds '.title == "a \"filter\"" and .wavelength_nm == [400, 500, 600] and .step_nm == 100' specinfo --json a.spd
  holds '.columns == [{name: "value", min: -1, min_nm: 500, max: 3, max_nm: 600}]' specinfo --json a.spd
  prints '  columns       value: -1 at 500 nm to 3 at 600 nm' specinfo <a.spd
  prints '  samples       1, 400 nm' specinfo < <(echo 400 1)
  fails_cleanly specinfo --check D65
  echo 400 x >bad.spd
  fails_cleanly specinfo bad.spd
}

# JSON

@test "JSON: an object for a file, an array for several" {
  spectral a.exr
  holds 'type == "object" and .file == "a.exr" and .format == "OpenEXR"' specinfo --json a.exr
  holds 'type == "array" and length == 2 and .[1].format == "spd"' specinfo --json a.exr D65
  code=0
  specinfo --json missing.exr a.exr >printed 2>/dev/null || code=$?
  [ "$code" -eq 2 ]
  jq -e 'length == 1' printed
}

@test "JSON is valid whatever the file holds" {
  printf 'quote " back \\ bell \a tab \t line \n bytes \xff\xfe\xc3(' >value
  spectral a.exr --attribute "odd\"name=$(cat value)" --extra $'Z\x01"\xff' --quantity $'a\\b\xf0\x9f'
  specinfo --json --bands a.exr >printed.json
  python=$(jq -er '.attributes["odd\"name"]' printed.json)
  [ "$python" = "$(printf 'quote " back \\ bell \a tab \t line \n bytes \xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd(')" ]
  jq -e '.quantity == "a\\b��" and .unit == null' printed.json
  specinfo a.exr >printed
  run ! env LC_ALL=C grep -q $'[\x01\a]' printed
}

@test "attributes are JSON's own types" {
  spectral a.exr --number EV=15.7456 --attribute text=1
  holds '.attributes == {spectralLayoutVersion: "1.0", emissiveUnits: "W.m^-2.sr^-1", EV: 15.7456, text: "1"}' \
    specinfo --json a.exr
  prints '                EV                     15.7456' specinfo a.exr
}

# Statistics

# The ramp is ((x + 1) * 0.001 + y * 0.01) + band * 0.1, over 4 x 2 pixels: its mean is 0.0025 + 0.005
# + band * 0.1, its variance 1.25e-6 + 25e-6 in each band. Rounding to float is below 1e-7.
@test "statistics are those of the ramp" {
  spectral a.exr --size 4x2 --grid 400:500:50
  filter='def near($a; $b): ($a - $b) | fabs < 1e-7;
    .statistics == [.statistics[0]] and (.statistics[0] |
      .name == "S0" and .channels == 3 and .samples == 24 and .nan == 0 and .inf == 0 and .negative == 0 and
      near(.min; 0.001) and near(.max; 0.214) and near(.mean; 0.1075) and near(.deviation; 0.08181025))
    and (.band_statistics | length == 3 and (to_entries | all(
      .key as $band | .value | near(.mean; 0.0075 + $band * 0.1) and near(.deviation; 0.005123475) and
      near(.min; 0.001 + $band * 0.1) and near(.max; 0.014 + $band * 0.1))))'
  holds "$filter" specinfo --json --bands a.exr
  holds 'has("band_statistics") | not' specinfo --json --statistics a.exr
  holds 'has("statistics") | not' specinfo --json a.exr
}

@test "what is not finite is counted, and in no mean" {
  spectral a.exr --size 4x2 --grid 400:500:50 --pattern negative --pattern nan:1,1,2 --pattern inf:0,0,2
  holds '.band_statistics[2] | .nan == 1 and .inf == 1 and .negative == 6 and .samples == 8 and .max < 0' \
    specinfo --json --bands a.exr
  holds '.statistics[0] | .nan == 1 and .inf == 1 and .negative == 22' specinfo --json -s a.exr
  spectral b.exr --size 1x1 --channel T.500nm --pattern nan:0,0,0
  holds '.statistics[0] | .min == null and .max == null and .mean == null and .deviation == null and .nan == 1' \
    specinfo --json -s b.exr
  specinfo -s b.exr | grep -q '^  T  *-  *-  *-  *-  *1  *0  *0$'
}

@test "each Stokes component, what is bispectral, and other channels have their own" {
  spectral a.exr --kind stokes --grid 400:500:100 --extra A --uint id
  [ "$(value '.statistics | map(.name) | join(" ")' specinfo --json -s a.exr)" = 'S0 S1 S2 S3 A' ]
  [ "$(value '.statistics | map(.channels)' specinfo --json -s a.exr)" = '[2,2,2,2,1]' ]
  holds '.statistics[2] | .min < 0 and .max < 0' specinfo --json -s a.exr
  [ "$(value '.band_statistics | length' specinfo --json -b a.exr)" = 8 ]
  spectral b.exr --channel T.400nm --channel T.500nm --channel T.400nm.500nm
  [ "$(value '.statistics | map(.name) | join(", ")' specinfo --json -s b.exr)" = 'T, T off the diagonal' ]
}

@test "every number of threads gives the same bits, and so does every compression" {
  spectral a.exr --size 700x301 --grid 400:700:20 --pattern grain --compression zip
  specinfo -j 1 --json --bands a.exr >one
  for threads in 2 3 7; do
    specinfo -j $threads --json --bands a.exr | cmp - one
  done
  spectral b.exr --size 700x301 --grid 400:700:20 --pattern grain --compression none
  diff <(jq -c '[.statistics, .band_statistics]' one) \
    <(cat b.exr | specinfo --json --bands | jq -c '[.statistics, .band_statistics]')
}

@test "--limit memory is kept" {
  spectral a.exr --size 64x64
  fails_cleanly specinfo --limit memory=1k --statistics a.exr
  [[ $stderr = *'--limit memory='* ]]
  fails_cleanly specinfo --limit channels=3 --check a.exr
}

# Pixels

# The ramp is ((x + 1) * 0.001 + y * 0.01) + band * 0.1, as floats.
@test "--probe prints the spectrum of pixels, which is a curve" {
  spectral a.exr --grid 400:500:50 --extra A --uint id --data=-3,5
  [ "$(specinfo --probe 2,1 -p 0,7 a.exr | grep -v '^# x')" = '# title: a.exr
# quantity: radiance per nm
# channel A: 0.313 0.371
# channel id: 65538 458752
# columns: wavelength_nm x2y1 x0y7
400 0.013 0.071
450 0.113 0.171
500 0.213 0.271' ] || complain "$(specinfo --probe 2,1 -p 0,7 a.exr)"
  specinfo --probe 2,1 a.exr | specconvert --scale 1 - | grep -qx '450 0.113'
}

@test "--probe agrees with other tools, in any order, from files and pipes" {
  for compression in none zip piz; do
    spectral a.exr --size 7x70 --grid 400:700:100 --pattern noise --compression $compression
    specinfo -p 6,69 -p 0,0 -p 3,33 -p 2,33 -p 1,34 a.exr >several
    specinfo -p 6,69 -p 0,0 -p 3,33 -p 2,33 -p 1,34 - < <(cat a.exr) | tail -n +2 | diff <(tail -n +2 several) -
    column=2
    for pixel in 6,69 0,0 3,33 2,33 1,34; do
      x=${pixel%,*} y=${pixel#*,}
      diff <(grep -v '^#' several | cut -d ' ' -f 1,$column) \
        <(specconvert --crop "$x,$y,$((x + 1)),$((y + 1))" a.exr | specconvert -f spd | grep -v '^#')
      column=$((column + 1))
    done
  done
}

@test "--probe of a curve, and of what is not there" {
  spectral a.exr
  for option in --probe=0,0 --patches=1x1 --check; do
    fails_cleanly specinfo $option D65
    [ "$stderr" = "specinfo: 'D65' is a curve, and ${option%=*} is for images" ]
    fails_cleanly specinfo $option - < <(echo '500 1')
    [ "$stderr" = "specinfo: '-' is a curve, and ${option%=*} is for images" ]
    fails_cleanly specinfo $option nothing
    [[ $stderr = "specinfo: no spectrum 'nothing'"* ]] || complain "$stderr"
    fails_cleanly specinfo $option b.exr
    [ "$stderr" = "specinfo: unable to open 'b.exr': No such file or directory" ]
  done
}

@test "--probe of Stokes components, of no finite sample, as JSON" {
  spectral a.exr --kind stokes --grid 400:500:100 --pattern nan:1,0,1 --extra A
  specinfo --probe 1,0 a.exr | grep -qx '# columns: wavelength_nm x1y0S0 x1y0S1 x1y0S2 x1y0S3'
  specinfo --probe 1,0 a.exr | grep -qx '500 nan 0.051 -0.0255 0.01275'
  holds '.wavelength_nm == [400, 500] and .quantity == "radiance per nm" and (.pixels | length == 2) and
    (.pixels[0] | .x == 1 and .y == 0 and .S0 == [0.002, null] and .S3 == [0.00025, 0.01275] and .channels == {A: 0.202})' \
    specinfo --json --probe 1,0 --probe 0,1 a.exr
  spectral b.exr --channel T.400nm --channel T.500nm --channel T.400nm.500nm
  holds '.pixels[0] | .T == [0.001, 0.101] and .channels == {"T.400nm.500nm": 0.201}' specinfo --json --probe 0,0 b.exr
  spectral c.exr --channel Y
  holds '.wavelength_nm == [] and .quantity == null and .pixels[0].channels == {Y: 0.001}' specinfo --json --probe 0,0 c.exr
  [ "$(specinfo --probe 0,0 c.exr)" = '# title: c.exr
# channel Y: 0.001' ]
}

@test "--probe outside the image, and what is no pixel" {
  spectral a.exr
  for pixel in 16,0 0,8 4294967296,0 -1,0 1 1,2,3 1.5,0 x,y '1,' ,1; do
    fails_cleanly specinfo --probe "$pixel" a.exr
  done
  fails_cleanly specinfo --probe 16,0 a.exr
  [[ $stderr = *'a.exr: the pixel 16,0 is outside of its 16 x 8' ]] || complain "$stderr"
  fails_cleanly specinfo --probe 0,0 --check a.exr
  fails_cleanly specinfo --probe 0,0 D65
}

# Rectangles

@test "--patches: means over rectangles of a file, in any order, overlapping" {
  spectral a.exr --grid 400:500:50 --extra A --uint id --data=-3,5
  printf '%s\n' '# name x0 y0 x1 y1' '' 'low 2 1 6 5' $'  all\t0 0 16 8\r' 'one 3 7 4 8' >rectangles
  # The mean of x + 1 is 4.5, of y 2.5; of all 8.5 and 3.5.
  holds '(.patches | map(.name) == ["low", "all", "one"]) and (.patches[0] | .x0 == 2 and .y0 == 1 and .x1 == 6 and .y1 == 5) and
    ([.patches[0].S0, [0.0295, 0.1295, 0.2295], .patches[1].S0, [0.0435, 0.1435, 0.2435]] | [.[0][0] - .[1][0], .[0][2] - .[1][2], .[2][1] - .[3][1]] | map(fabs) | max < 1e-8) and
    .patches[0].channels.id == null and .patches[2].channels.id == 458755 and (.patches[1].channels.A - 0.3435 | fabs < 1e-7)' \
    specinfo --json --patches rectangles a.exr
  specinfo --patches rectangles a.exr | grep -qx '# columns: wavelength_nm low all one'
  diff <(specinfo --patches rectangles a.exr | grep -v '^#' | cut -d ' ' -f 1,4) <(specinfo -p 3,7 a.exr | grep -v '^#')
  value '.patches[2] | del(.name, .x0, .x1, .y0, .y1)' specinfo --json --patches rectangles a.exr >one
  [ "$(value '.pixels[0] | del(.x, .y)' specinfo --json -p 3,7 a.exr)" = "$(cat one)" ]
}

@test "--patches: the same bits from pipes, tiles, every compression and number of threads" {
  spectral a.exr --size 50x70 --grid 400:700:10 --pattern noise --compression none
  printf '%s\n' 'a 1 60 49 70' 'b 0 9 50 33' 'c 7 10 8 69' >rectangles
  specinfo --patches rectangles -j 1 a.exr | tail -n +2 >wanted
  for compression in zip piz; do
    specconvert --compression $compression a.exr -o b.exr
    specinfo --patches rectangles -j 5 b.exr | tail -n +2 | diff wanted -
  done
  specinfo --patches rectangles -j 3 - < <(cat a.exr) | tail -n +2 | diff wanted -
}

@test "--patches of a chart: the middle of each patch, called by its number" {
  mapfile -t names < <(cd "$ROOT/spectra/reflectance/colorchecker" && printf '%s\n' *.spd)
  specconvert -g 380:730:5 --patches 6x4 --patch 8 -o card.exr "${names[@]%.spd}"
  holds '(.patches | length == 24) and (.patches[7] | .name == "8" and .x0 == 10 and .x1 == 14 and .y0 == 10 and .y1 == 14)' \
    specinfo --json --patches 6x4 card.exr
  # Floats hold six digits of the curve.
  for patch in 1 15 19 24; do
    jq -n --slurpfile card printed.json --argjson curve \
      "$(specconvert -g 380:730:5 "${names[patch - 1]%.spd}" | specinfo --json -)" --argjson i $((patch - 1)) \
      '[$card[0].patches[$i].Lab, $curve.Lab] | transpose | map(.[0] - .[1] | fabs) | max < 1e-4' | grep -qx true
  done
  # The ColorChecker's Lab under D50, BabelColor's mean of 30 charts 2005: 96.539 -0.425 1.186.
  holds '[.patches[18].Lab, [96.539, -0.425, 1.186]] | transpose | map(.[0] - .[1] | . * .) | add < 4' \
    specinfo --json --illuminant D50 --patches 6x4 card.exr
  fails_cleanly specinfo --patches 49x4 card.exr
  fails_cleanly specinfo --patches 0x4 card.exr
  fails_cleanly specinfo --patches 999x999 card.exr
  fails_cleanly specinfo --patches 257x256 card.exr
  [[ $stderr = *'a chart of 257x256 has more than 65536 patches' ]] || complain "$stderr"
}

@test "--patches that are wrong" {
  spectral a.exr
  fails_cleanly specinfo --patches nothing a.exr
  [[ $stderr = *nothing:* ]] || complain "$stderr"
  for line in 'a 0 0 1' 'a 0 0 1 1 1' 'a 1 0 1 1' 'a 0 2 1 1' 'a -1 0 1 1' 'a 0 0 1.5 1' 'a 0 0 x 1' 'a 0 0 99999999999 1' '' $'a 0 0 1 1\na 0 0 2 2'; do
    printf '%s\n' "$line" >rectangles
    fails_cleanly specinfo --patches rectangles a.exr
    [[ $stderr = *rectangles:* ]] || complain "$stderr"
  done
  printf 'a 0 0 1 1\nb 0 0\n' >rectangles
  fails_cleanly specinfo --patches rectangles a.exr
  [[ $stderr = *'rectangles: line 2: '* ]] || complain "$stderr"
  printf 'a 0 0 1\0 1\n' >rectangles
  fails_cleanly specinfo --patches rectangles a.exr
  fails_cleanly specinfo --patches . a.exr
  for line in 'far 0 0 17 8' 'far 0 0 16 9' 'far 16 0 17 1'; do
    echo "$line" >rectangles
    fails_cleanly specinfo --patches rectangles a.exr
    [[ $stderr = *"a.exr: 'far' reaches outside of its 16 x 8"* ]] || complain "$stderr"
  done
  echo 'a 0 0 1 1' >rectangles
  fails_cleanly specinfo --patches rectangles D65
  fails_cleanly specinfo --patches rectangles --probe 0,0 a.exr
  fails_cleanly specinfo --patches rectangles -s a.exr
  # Lines are read as far as the rectangles reach.
  spectral a.exr --compression none
  head -c 3000 a.exr >short.exr
  echo 'a 0 0 16 1' >rectangles
  specinfo --patches rectangles short.exr >told
  echo 'a 0 0 16 8' >rectangles
  fails_cleanly specinfo --patches rectangles short.exr
}

# Colours

# about FILTER NUMBER TOLERANCE COMMAND...: what jq finds is that number.
about() {
  local filter=$1 number=$2 tolerance=$3
  shift 3
  holds "$filter - $number | fabs <= $tolerance" "$@"
}

# Numbers of CIE 15:2004, table T.3 (X, Z: ASTM E308), and of lamps T.8.1.
@test "colours of lights" {
  about '.XYZ[0]' 95.047 0.005 specinfo --json D65
  about '.XYZ[1]' 100 1e-9 specinfo --json D65
  about '.XYZ[2]' 108.883 0.005 specinfo --json D65
  about '.xy[0]' 0.31272 2e-5 specinfo --json D65
  about '.xy[1]' 0.32903 2e-5 specinfo --json D65
  about .cct 6504 2 specinfo --json D65
  about .duv 0.0032 5e-5 specinfo --json D65
  about '.uv[0]' 0.19783 2e-5 specinfo --json D65
  about '.uv[1]' 0.46833 2e-5 specinfo --json D65
  about .cct 2856 1 specinfo --json A
  about .duv 0 2e-5 specinfo --json A
  about .cct 4230 15 specinfo --json F2
  holds '.luminance == null and .Lab[0] == 100 and .outside == 0' specinfo --json D65
  holds '.purity == 0 and .dominant_nm == null' specinfo --json E
  holds '(.purity < 1e-3) and (.Lab | map(fabs) | .[1:] | max < 1e-9)' specinfo --json --illuminant A A
  about '.xy[0]' 0.31381 2e-5 specinfo --json --observer 1964 D65
  about '.xy[1]' 0.33098 2e-5 specinfo --json --observer 1964 D65
  value '[.cct, .duv]' specinfo --json --observer 1964 D65 >wide
  [ "$(value '[.cct, .duv]' specinfo --json D65)" = "$(cat wide)" ]
  specinfo D65 | grep -qxE '  temperature   650[2-4]\.[0-9] K, Duv 0.0032[0-9]'
}

@test "colours of reflectance, of several columns, of what has none" {
  about '.XYZ[1]' 14.343 0.001 specinfo --json reflectance/cornell-red
  holds '.cct == null and .luminance == null and .dominant_nm > 600' specinfo --json reflectance/cornell-red
  holds '.dominant_nm < -490 and .dominant_nm > -570' specinfo --json 17-magenta
  specinfo 17-magenta | grep -qE '^  complementary 5[0-9]{2}\.[0-9]{2} nm, purity 0\.'
  printf '%s\n' '# quantity: reflectance' '# columns: wavelength_nm half none' '360 .5 0' '830 .5 0' >two.spd
  holds '.XYZ == null and (.colours | length == 2) and (.colours[0].XYZ[1] - 50 | fabs < 1e-9) and .colours[0].purity < 1e-9 and
    .colours[1].XYZ == [0, 0, 0] and .colours[1].xy == null and .colours[1].Lab == [0, 0, 0]' specinfo --json two.spd
  [ "$(specinfo two.spd | grep -c '^  XYZ ')" -eq 2 ]
  printf '%s\n' '900 1' '1000 2' >infrared.spd
  printf '%s\n' '# quantity: refractive index' '360 1.5' '830 1.4' >index.spd
  for curve in infrared.spd index.spd; do
    holds 'has("XYZ") and has("luminance") and
      ([.XYZ, .xy, .Lab, .cct, .duv, .dominant_nm, .purity, .luminance] | unique == [null])' specinfo --json $curve
  done
  fails_cleanly specinfo --observer Au D65
  fails_cleanly specinfo --illuminant Au D65
  fails_cleanly specinfo --illuminant infrared.spd D65
  fails_cleanly specinfo --observer nobody D65
}

# 683 lm/W times the integral of ybar, 106.857 nm (CIE 15), for a radiance of 100 per nm.
@test "colours of pixels: luminance, XYZ in cd/m2, and none where nothing is seen" {
  specconvert -g 360:830:5 --patches 1x1 -o light.exr E
  about '.pixels[0].luminance' 7298333 100 specinfo --json -p 0,0 light.exr
  holds '.pixels[0] | (.XYZ[1] - .luminance | fabs < 1e-3) and .purity < 1e-6' specinfo --json -p 0,0 light.exr
  specinfo -p 0,0 light.exr | grep -qxE '# x0y0 luminance     7\.2983[0-9]*e\+06 cd/m\^2'
  spectral n.exr --grid 400:700:50 --pattern nan:1,0,1
  holds '[.pixels[0] | .XYZ, .xy, .Lab, .cct, .duv, .dominant_nm, .purity, .luminance] | unique == [null]' specinfo --json -p 1,0 n.exr
  spectral blue.exr --grid 400:500:50
  # ybar's share from 400 to 500 nm is 7 %: 7.4 of 106.857 nm (CIE 15).
  about '.pixels[0].outside' 0.931 0.003 specinfo --json -p 1,0 blue.exr
  specinfo -p 1,0 blue.exr | grep -qx '# x1y0 outside       93.1 % of Y, not counted'
  # Light of which no luminance is known: Y is 100 for 1 per nm, and so is white.
  spectral irradiance.exr --size 1x1 --grid 360:830:5 --pattern constant:1 --quantity irradiance
  holds '.pixels[0] | (.XYZ[1] - 100 | fabs < 1e-9) and (.Lab[0] - 100 | fabs < 1e-9) and .luminance == null and .cct > 5000' \
    specinfo --json -p 0,0 irradiance.exr
  # More than 1 % is told: of Y of equal energy 1.16 % lies beyond 655 nm, 0.84 % beyond 660.
  spectral red.exr --size 1x1 --grid 380:655:5 --pattern constant:1
  specinfo -p 0,0 red.exr | grep -qx '# x0y0 outside       1.2 % of Y, not counted'
  spectral red.exr --size 1x1 --grid 380:660:5 --pattern constant:1
  specinfo -p 0,0 red.exr >told
  run ! grep -q outside told
  spectral infrared.exr --grid 900:1000:50
  holds '.pixels[0].XYZ == null and .pixels[0].S0 != null' specinfo --json -p 1,0 infrared.exr
  # XYZ of what is reradiated, too: more than that of the diagonal alone.
  spectral b.exr --channel T.450nm --channel T.550nm --channel T.650nm --channel T.450nm.550nm
  spectral d.exr --channel T.450nm --channel T.550nm --channel T.650nm
  jq -n --argjson with "$(specinfo --json -p 5,5 b.exr)" --argjson without "$(specinfo --json -p 5,5 d.exr)" \
    '$with.pixels[0].XYZ[1] > $without.pixels[0].XYZ[1] + 1' | grep -qx true
}

@test "--rule: the perfect reflector is white by every one, and the text tells it" {
  spectral white.exr --kind T --grid 400:700:20 --pattern constant:1
  for rule in grid astm; do
    holds ".pixels[0] | .rule == \"$rule\" and (.XYZ[1] - 100 | fabs < 1e-9) and (.Lab | (.[0] - 100 | fabs < 1e-9) and (.[1:] | map(fabs) | max < 1e-9)) and .purity < 1e-9" \
      specinfo --json --rule $rule -p 0,0 white.exr
  done
  # White of ASTM E308; by the sums of 1 nm what lies outside is missing.
  about '.pixels[0].XYZ[2]' 108.883 .002 specinfo --json --rule astm -p 0,0 white.exr
  holds '.pixels[0] | .rule == "cie" and .XYZ[1] < 99.97' specinfo --json -p 0,0 white.exr
  specinfo --rule astm -p 0,0 white.exr | grep -qx '# x0y0 rule          astm, the weights of ASTM E308-15, made by ASTM E2022-11'
  specinfo -p 0,0 white.exr | { run ! grep rule; }
  specinfo --rule cie D65 | grep -q '^  rule          cie, sums by '
  # Sums of the table by its 5 nm: CIE 15:2004, .31272.
  about '.xy[0]' 0.31272 1e-5 specinfo --json --rule grid D65
  specconvert -g 400:700:10 colorchecker/15-red -o red.spd
  holds '.rule == "astm" and (.XYZ[1] - 11.826 | fabs < 1e-3)' specinfo --json --rule astm red.spd
}

@test "--rule that is refused: nothing of that file is told" {
  spectral light.exr --grid 400:700:20
  fails_cleanly specinfo --rule simpson D65
  fails_cleanly specinfo --rule astm D65
  [[ $stderr = *'D65: the weights of ASTM E308 are for reflectance and transmittance, not for light' ]]
  fails_cleanly specinfo --json --rule astm colorchecker/15-red
  [[ $stderr = *'colorchecker/15-red: ASTM E308 has weights for bands 10 or 20 nm apart, not for these' ]]
  fails_cleanly specinfo --rule astm -p 0,0 light.exr
  [[ $stderr = *'light.exr: the weights of ASTM E308 '*'not for light' ]]
}

@test "--observer: the CIE's of 2015, and those without X, Y and Z" {
  # CIE 170-2:2015: the spectrum of equal energy is white to all.
  for observer in 2015-2 2015-10; do
    about '.xy[0]' 0.33333 5e-5 specinfo --json --observer $observer E
  done
  holds '.XYZ == null and .xy == null and .Lab == null and .dominant_nm == null and .purity == null and (.signals | length == 3) and
    .signals[1] == 100 and .cct > 6500' specinfo --json --observer cie2006-lms-2 D65
  specinfo --observer cie2006-lms-2 D65 | grep -qxE '  signals       l 116\.[0-9]+, m 100, s 64\.[0-9]+'
  holds '.signals == null and .XYZ != null' specinfo --json D65
  # A radiance of 1 per nm: 1700.06 lm/W times the sum of V', and of V 683.
  specconvert -g 380:780:1 --patches 1x1 E --scale 0.01 -o light.exr
  sum=$(awk '/^[0-9]/ { sum += $2 } END { printf "%.6f", sum * 1700.06 }' "$ROOT/spectra/cmf/v-scotopic.spd")
  about '.pixels[0].signals[0]' "$sum" 2 specinfo --json --observer v-scotopic -p 0,0 light.exr
  about '.pixels[0].luminance' 72983.3 2 specinfo --json --observer v-scotopic -p 0,0 light.exr
  about '.pixels[0].XYZ[1]' "$(awk '/^[0-9]/ { sum += $3 } END { printf "%.6f", sum * 683.599 }' "$ROOT/spectra/cmf/cie1964.spd")" 3 \
    specinfo --json --observer 1964 -p 0,0 light.exr
  # The reflector has 100 in the second of three sensors, and in the only one.
  printf '%s\n' '# quantity: reflectance' '360 1' '830 1' >white.spd
  about '.signals[1]' 100 1e-9 specinfo --json --observer cie2006-lms-10 white.spd
  holds '.signals | length == 1 and (.[0] - 100 | fabs < 1e-9)' specinfo --json --observer v-scotopic white.spd
  fails_cleanly specinfo --observer cie2006-lms-2 --plot x.svg D65
  [[ $stderr = *'has no X, Y and Z to draw a chromaticity diagram of' ]]
  [ ! -e x.svg ]
}

# Plots

# In the diagram, x = 0.31273 is 810.57 from the left, y = 0.32902 345.54 from the top; a point's
# circle, of radius 4, begins at its right. The panel of spectra spans 70..550 and 30..460. cairo
# rounds to 1/256.
@test "--plot: the spectra and their points are where they belong" {
  specinfo --plot a.svg D65 >told
  diff told <(specinfo D65)
  grep -qE 'd="M 814\.5[67][0-9]* 345\.5[34][0-9]* C' a.svg
  # At 300 nm, the left edge, D65 is 0.0341 of 117.812 and 4 % more: 0.12 above the lower edge.
  grep -qE 'd="M 70 459\.8[78][0-9]* L ' a.svg
  grep -qE ' L 550 [0-9.]+' a.svg
  specinfo --plot b.svg A >told
  run ! grep -qE 'M 814\.5[67][0-9]* 345\.5[34]' b.svg
  spectral a.exr --grid 400:700:50
  specinfo --json -p 3,2 --plot c.svg a.exr >told.json
  x=$(jq '614 + 470 * (.pixels[0].xy[0] + 0.05) / 0.85 | . * 10 | floor / 10' told.json)
  grep -qE "d=\"M ${x/./\\.}[0-9]* [0-9.]+ C" c.svg || complain "no circle at $x"
  spectral b.exr --grid 400:700:50 --extra A --extra Z
  specinfo -p 3,2 --plot e.svg b.exr >told
  cmp c.svg e.svg
  echo 'some 0 0 4 4' >rectangles
  specinfo --patches rectangles --plot d.svg a.exr >told
  run ! cmp -s c.svg d.svg
}

@test "--plot: the formats, the same bytes each time, several curves and columns" {
  specinfo --plot a.png D65 Au 15-red | diff - <(specinfo D65 Au 15-red)
  [ "$(od -An -tx1 -N4 a.png)" = ' 89 50 4e 47' ]
  [ "$(od -An -tu1 -j16 -N8 a.png)" = '   0   0   4  76   0   0   2 108' ]
  specinfo --plot a.pdf D65 Au 15-red >told
  [ "$(head -c 5 a.pdf)" = '%PDF-' ]
  specinfo --plot a.SVG D65 Au 15-red >told
  grep -q '<svg ' a.SVG
  for file in a.png a.pdf a.SVG; do
    specinfo --plot "b${file#a}" D65 Au 15-red >told
    cmp "$file" "b${file#a}"
  done
  # Other quantities, each over its greatest value: D65 begins at 0.0341 / 117.812 of 1.04.
  grep -qE 'd="M [0-9.]+ 459\.8[78]' a.SVG
  # The greatest value of all four lines is as high: 30 + 430 * 0.04 / 1.04.
  [ "$(grep -oE '[ML] [0-9.]+ 46\.5[34][0-9]* ' a.SVG | wc -l)" -ge 4 ]
  # Without sRGB's triangle there is one closed path of three corners less.
  specinfo --observer 1964 --plot c.svg D65 >told
  specinfo --plot d.svg D65 >told
  triangle='d="M [0-9.]+ [0-9.]+ L [0-9.]+ [0-9.]+ L [0-9.]+ [0-9.]+ Z'
  grep -qE "$triangle" d.svg
  run ! grep -qE "$triangle" c.svg
}

# 520 nm is at 0.0743, 0.8338 (CIE 1931), the black body of 1000 K at 0.65275, 0.34446.
@test "--plot: the loci, the white, and which spectrum is which" {
  cp "$ROOT/spectra/illuminants/A.spd" a.spd
  cp a.spd b.spd
  for name in a b; do
    specinfo --plot $name.svg $name.spd >told
    # The locus is the edge of the tints, too.
    [ "$(grep -oE ' L 678\.73[0-9]* 66\.58[0-9]* ' $name.svg | wc -l)" -eq 2 ]
    grep -qE ' L 998\.58[0-9]* 337\.01[0-9]* ?"' $name.svg
    grep -qE 'M 806\.5[0-9]* 345\.5[0-9]* L 814\.5[0-9]* 345\.5[0-9]* ' $name.svg
  done
  run ! cmp -s a.svg b.svg
  specinfo --observer 1964 --plot c.svg a.spd >told
  run ! grep -qE 'M 806\.5[0-9]* 345\.5' c.svg
}

# Two lines of names, which a picture shows as they are seen: what is cut off is not there.
@test "--plot: names that are too long keep their ends, and all are there" {
  mkdir -p a-folder-of-a-very-long-name/in-another-of-such-a-name/and-in-a-third-one-of-them
  for name in one two three four five; do
    file=$(echo a-*/*/*)/$name
    printf '%s\n' '400 1' '500 1' >"$file.spd"
  done
  cp "$file.spd" "${file%five}FIVE.spd"
  draw() {
    specinfo --plot "$1" "${@:2}" >told
  }
  draw a.png a-*/*/*/{one,two,three,four,five}.spd
  draw b.png a-*/*/*/{two,one,three,four,five}.spd
  run ! cmp a.png b.png
  # One that is wide has a line of its own: 13 pixels below the other's.
  draw c.svg a-*/*/*/one.spd a-*/*/*/two.spd
  [ "$(grep -oE '<use [^>]* x="88[.0-9]*" y="5(13|26)\.' c.svg | wc -l)" -eq 2 ] ||
    complain "$(grep -oE '<use [^>]*y="5[12][0-9.]*"' c.svg | head)"
}

@test "--plot: the axis of values has the unit that all have" {
  printf '%s\n' '# quantity: a' '400 1' '500 2' >none.spd
  sed 's/# .*/&\n# unit: W/' none.spd >watt.spd
  sed 's/# .*/&\n# unit: V/' none.spd >volt.spd
  letters() {
    specinfo --plot a.svg "$@" >told
    grep -oE '<use [^>]*y="24"' a.svg | wc -l
  }
  few=$(letters none.spd)
  [ "$(letters watt.spd)" -eq $((few + 4)) ] || complain "$few" "$(letters watt.spd)"
  [ "$(letters watt.spd watt.spd)" -eq $((few + 4)) ]
  [ "$(letters watt.spd volt.spd)" -eq "$few" ]
}

@test "--plot: names and quantities that are no UTF-8 are drawn all the same" {
  name=$'caf\xe9.spd'
  printf '# quantity: \xe9\n# unit: \xe9\n400 1\n500 2\n' >"$name"
  specinfo --plot a.png "$name" >told
  printf '# quantity: \xef\xbf\xbd\n# unit: \xef\xbf\xbd\n400 1\n500 2\n' >$'caf\xef\xbf\xbd.spd'
  specinfo --plot b.png $'caf\xef\xbf\xbd.spd' >told
  cmp a.png b.png
}

@test "--plot: 1000 spectra at most" {
  for count in 1000 1001; do
    awk -v count=$count 'BEGIN {
      print "# quantity: refractive index"
      for (nm = 400; nm < 900; nm += 300) { printf "%d", nm; for (i = 0; i < count; i++) printf " 1.5"; print "" }
    }' >$count.spd
  done
  specinfo --plot a.svg 1000.spd >told
  fails_cleanly specinfo --plot b.svg 1001.spd
  [[ $stderr = *'more than 1000 spectra are too many for a plot' ]]
  [ ! -e b.svg ]
}

@test "--plot: of what is not finite, or no colour; and what is wrong" {
  spectral n.exr --grid 400:700:50 --pattern nan:1,0,1
  specinfo -p 1,0 --plot a.png n.exr >told
  printf '%s\n' '500 1' >one.spd
  specinfo --plot b.png one.spd >told
  printf '%s\n' '500 0' '600 0' >none.spd
  specinfo --plot c.svg none.spd >told
  run ! grep -qi nan c.svg
  fails_cleanly specinfo --plot d.gif D65
  fails_cleanly specinfo --plot png D65
  fails_cleanly specinfo --plot d.png n.exr
  fails_cleanly specinfo --plot d.png --check n.exr
  fails_cleanly specinfo --plot d.png -s n.exr
  fails_cleanly specinfo --plot d.png nothing-of-that-name
  fails_cleanly specinfo --plot nowhere/d.png D65
  spectral y.exr --channel Y
  fails_cleanly specinfo -p 0,0 --plot d.png y.exr
  mkdir bin
  cp "$BIN/specinfo" bin
  SPECTRA_PATH=$ROOT/spectra fails_cleanly bin/specinfo --plot d.png D65
  [[ $stderr = *plots.so* ]] || complain "$stderr"
  [ ! -e d.png ]
}

# Other programs' files, as exrheader sees them

@test "every sample of other programs is told of" {
  samples
  while read -r name role stokes bands from to step sample; do
    holds ".role == \"$role\" and .stokes == $stokes and .bands == $bands and .step_nm == $step and
      .wavelength_nm[0] == $from and .wavelength_nm[-1] == $to and .edges_nm == null and .naming == \"layout\" and
      (.channels | map(select(.wavelength_nm) | .sample) | unique == [\"$sample\"])" \
      specinfo --json "$SAMPLES/$name.exr" || complain "$name"
    [ "$(value '.channels[].name' specinfo --json "$SAMPLES/$name.exr")" = "$(channels "$SAMPLES/$name.exr")" ]
    specinfo --json --bands "$SAMPLES/$name.exr" | jq -e '.statistics | all(.nan == 0 and .inf == 0)'
  done <<'END'
Macbeth reflective 1 36 380 730 10 float
D65 emissive 1 90 380 825 5 float
D65_colour emissive 1 97 300 780 5 half
BiSpectral reflective 1 41 380 780 10 float
Polarised emissive 4 8 400 680 40 float
pbrt-v4_cbox emissive 1 30 405 695 10 float
END
  holds '.width == 600 and .height == 400 and .quantity == "reflectance"' specinfo --json "$SAMPLES/Macbeth.exr"
  holds '.bispectral == 820 and .width == 16' specinfo --json "$SAMPLES/BiSpectral.exr"
  holds '.attributes.EV | . > 15.7 and . < 15.8' specinfo --json "$SAMPLES/D65_colour.exr"
  holds '.attributes | .samplesPerPixel == 16 and .worldToCamera[0] == [-1, 0, 0, 278]' \
    specinfo --json "$SAMPLES/pbrt-v4_cbox.exr"
  prints '  role          emissive, polarised (S0 S1 S2 S3)' specinfo "$SAMPLES/Polarised.exr"
  prints '  channels      float: A B G R' specinfo "$SAMPLES/Polarised.exr"
}

@test "--check of other programs' files finds names with other decimals, and no more" {
  samples
  for name in Macbeth D65 BiSpectral Polarised; do
    [ -z "$(specinfo --check "$SAMPLES/$name.exr")" ]
  done
  run specinfo --check "$SAMPLES/D65_colour.exr"
  [[ $status = 1 && $output = *": warning: S0.300,0nm: is not named 'S0.300,000000nm', as a writer must name it (97 of 97 bands)" ]]
  [ "${#lines[@]}" -eq 1 ]
  run specinfo --check "$SAMPLES/pbrt-v4_cbox.exr"
  [[ $status = 1 && ${lines[0]} = *": warning: S0.405,000nm: "* && ${lines[1]} = *": note: S0.405,000nm: has three decimals"* ]]
  [ "${#lines[@]}" -eq 2 ]
}

# --check: nothing to find

@test "--check finds nothing in what the tools and helpers write" {
  spectral a.exr --pattern constant:0.5 --bins --extra A
  checks 0 a.exr
  spectral b.exr --kind T --half --pattern constant:1
  checks 0 b.exr
  spectral c.exr --kind stokes --attribute polarisationHandedness=right
  checks 0 c.exr
  for scene in flat pair tilted sphere disc; do
    "$TESTS/layers" --scene $scene --size 16x16 --grid 400:700:100 -o layers.exr
    checks 0 layers.exr
  done
  cp "$ROOT/tests/example.exr" .
  checks 0 example.exr
  specconvert --grid 400:700:50 -m D65 --patches 2x1 E A --extrapolate zero -o d.exr 2>/dev/null ||
    specconvert --grid 400:700:50 --patches 2x1 E A -o d.exr
  checks 0 d.exr
  specconvert --to-vacuum d.exr -o vacuum.exr
  checks 0 vacuum.exr
  specconvert --to composite:2 d.exr -o lines.exr
  checks 0 lines.exr
  specconvert --to fourier:3 a.exr -o series.exr
  checks 0 series.exr
  specconvert --atlas -g 400:700:1 D65 Au -o atlas.exr
  checks 0 atlas.exr 'note: file: has no bands: it is not spectral'
}

@test "--check of other formats does not ask for OpenEXR's attributes" {
  spectral a.exr --pattern constant:0.5 --bins
  for file in a.hdr a.tif a.hsr; do
    specconvert a.exr -o $file
    run -0 specinfo --check $file
    [ -z "$output" ] || complain "$output"
  done
}

@test "--check looks into other representations, and tells where they are damaged" {
  spectral a.exr --pattern nan:3,2,5
  specconvert -q --to fourier:5 a.exr -o series.exr
  checks 1 series.exr 'warning: S0.400,000000nm at 3,2: is NaN, the first of 16 such samples in 16 channels'
  LC_ALL=C sed 's/S0\.b1/S0.c1/' series.exr >lacking.exr
  checks 1 lacking.exr 'note: file: has no bands: it is not spectral' "error: file: lacks the channel 'S0.b1'" \
    'note: S0.a0 at 3,2: is NaN, the first of 5 such samples in 5 channels'
}

@test "--check as JSON" {
  spectral a.exr --without emissiveUnits --attribute spec:mine=x
  code=0
  specinfo --check --json a.exr >printed.json || code=$?
  [ "$code" -eq 1 ]
  jq -e '.file == "a.exr" and .errors == 0 and .warnings == 1 and .notes == 1 and
    (.findings | length == 2) and .findings[1].severity == "warning" and
    .findings[1].place == "emissiveUnits"' printed.json
  spectral b.exr
  code=0
  specinfo --check --json b.exr a.exr >printed.json || code=$?
  [ "$code" -eq 1 ]
  jq -e 'length == 2 and .[0].findings == []' printed.json
}

@test "--check: 2 where a file cannot be read, and the others' findings all the same" {
  spectral a.exr --without emissiveUnits
  code=0
  specinfo --check a.exr missing.exr >printed 2>err || code=$?
  [ "$code" -eq 2 ]
  [ "$(wc -l <printed)" -eq 1 ]
  [ "$(wc -l <err)" -eq 1 ]
}

# --check: names

@test "finding: a band without a wavelength, and others all the same" {
  spectral a.exr --channel S0.nm --channel S0.500,000000nm --channel S0.9999999999nm --without emissiveUnits
  checks 1 a.exr 'error: S0.9999999999nm: is named as a band without a wavelength between 0.01 and 1e+06 nm' \
    'error: S0.nm: is named as a band without a wavelength between 0.01 and 1e+06 nm' \
    "warning: emissiveUnits: is missing; a writer must write 'W.m^-2.sr^-1'"
  fails_cleanly specinfo a.exr
}

@test "finding: what looks like a band" {
  spectral a.exr --extra S0.550.5nm
  checks 1 a.exr "warning: S0.550.5nm: looks like a band, but its name is another channel's (the decimal mark is a comma)"
}

@test "finding: names that are not as a writer must write them" {
  spectral a.exr --channel T.400nm --channel T.0,5um --channel T.600,000000nm
  checks 1 a.exr "warning: T.0,5um: is not named 'T.500,000000nm', as a writer must name it (2 of 3 bands)" \
    'note: emissiveUnits: is there, but no band of light'
}

@test "finding: the names of other programs" {
  spectral a.exr --channel 400.00-410.00nm --channel 410.00-420.00nm
  checks 1 a.exr "warning: 400.00-410.00nm: is not named 'S0.405,000000nm', as a writer must name it (2 of 2 bands, in the way of another program)"
}

@test "finding: pbrt-v4's names and scale" {
  spectral a.exr --channel S0.402,500nm --channel S0.407,500nm
  checks 1 a.exr "warning: S0.402,500nm: is not named 'S0.402,500000nm', as a writer must name it (2 of 2 bands)" \
    'note: S0.402,500nm: has three decimals, as pbrt-v4 writes them; its values are 106.856895 times the radiance'
  spectral b.exr --channel S0.402,500nm --channel S0.407,5nm
  checks 1 b.exr "warning: S0.402,500nm: is not named 'S0.402,500000nm', as a writer must name it (2 of 2 bands)"
}

@test "finding: light and reflectance at once" {
  spectral a.exr --extra T.500,000000nm
  checks 1 a.exr "error: T.500,000000nm: is a band of reflectance, beside bands of light such as 'S0.400,000000nm'"
  fails_cleanly specconvert a.exr -o b.exr
}

@test "finding: two grids, of two programs" {
  spectral a.exr --extra 400.00-410.00nm
  checks 1 a.exr "error: 400.00-410.00nm: is named in another way than 'S0.400,000000nm': two grids in one file" \
    "warning: 400.00-410.00nm: is not named 'S0.405,000000nm', as a writer must name it (1 of 17 bands, in the way of another program)"
}

@test "finding: the same band twice, and nearly" {
  spectral a.exr --channel S0.500,000000nm --channel S0.500nm
  checks 1 a.exr "warning: S0.500nm: is not named 'S0.500,000000nm', as a writer must name it (1 of 2 bands)" \
    "error: S0.500nm: is the same band as 'S0.500,000000nm'"
  spectral b.exr --channel S0.500,000000nm --channel S0.500,000900nm --channel S0.500,002000nm
  checks 1 b.exr "warning: S0.500,000900nm: is nearly the same band as 'S0.500,000000nm'"
}

@test "finding: bands of whole numbers" {
  spectral a.exr --size 1x1 --grid 400:500:100 --uint S0.600,000000nm
  checks 1 a.exr 'warning: S0.600,000000nm: is UINT, where HALF or FLOAT is advised (1 bands)'
}

@test "finding: Stokes components that are missing" {
  spectral a.exr --channel S0.500,000000nm --channel S1.500,000000nm --pattern constant:0 \
    --attribute polarisationHandedness=left
  checks 1 a.exr 'error: S2: is missing, beside other Stokes components' \
    'error: S3: is missing, beside other Stokes components' \
    'note: file: every sample of its bands and layers is 0'
}

@test "finding: Stokes components on other grids" {
  for component in S0 S1 S2 S3; do
    names+=(--channel "$component.500,000000nm")
  done
  spectral a.exr "${names[@]}" --extra S2.510,000000nm --extra S0.600,000000nm --attribute polarisationHandedness=left
  checks 1 a.exr 'error: S0.600,000000nm: has no partner in S1 (1 bands)' \
    'error: S0.600,000000nm: has no partner in S2 (1 bands)' \
    'error: S2.510,000000nm: has no partner in S0 (1 bands)' \
    'error: S0.600,000000nm: has no partner in S3 (1 bands)'
}

@test "finding: bispectral without the diagonal" {
  spectral a.exr --channel T.400,000000nm.500,000000nm --without emissiveUnits
  checks 1 a.exr 'error: T.400,000000nm.500,000000nm: is bispectral, and there is no band on the diagonal'
  spectral b.exr --channel T.400,000000nm --channel T.400,000000nm.500,000000nm --without emissiveUnits
  checks 1 b.exr 'error: T.400,000000nm.500,000000nm: has no band on the diagonal at 500 nm'
}

@test "finding: what the reader alone refuses" {
  # 0.0008 nm off, which is near, but farther than a quarter of the way to the next band.
  spectral a.exr --channel T.500,000000nm --channel T.500,002000nm --channel T.500,000800nm.500,002000nm \
    --without emissiveUnits
  checks 1 a.exr "error: file: channel 'T.500,000800nm.500,002000nm' has a wavelength that is not on the diagonal"
}

@test "finding: micrometres that are called nanometres" {
  spectral a.exr --channel T.0,400000nm --channel T.0,700000nm --without emissiveUnits
  checks 1 a.exr 'warning: T.0,400000nm: is at 0.4 nm, and no band is above 10 nm: is its unit another?'
}

@test "finding: no bands" {
  spectral a.exr --channel Y --without emissiveUnits --without spectralLayoutVersion
  checks 0 a.exr 'note: file: has no bands: it is not spectral'
}

# --check: attributes

@test "finding: attributes that are missing" {
  spectral a.exr --without spectralLayoutVersion --without emissiveUnits
  checks 1 a.exr "warning: spectralLayoutVersion: is missing; a writer must write '1.0'" \
    "warning: emissiveUnits: is missing; a writer must write 'W.m^-2.sr^-1'"
}

@test "finding: another layout, other units" {
  spectral a.exr --attribute spectralLayoutVersion=2.0 --attribute emissiveUnits=cd
  checks 1 a.exr "warning: spectralLayoutVersion: is '2.0', not '1.0'" "warning: emissiveUnits: is 'cd', not 'W.m^-2.sr^-1'"
}

@test "finding: types of attributes" {
  spectral a.exr --number spec:samples=3
  checks 1 a.exr 'warning: spec:samples: is of type float instead of int, and so means nothing'
  spectral a.exr --number spec:bins=3 --attribute EV=1 --number spec:quantity=1
  checks 1 a.exr 'warning: spec:bins: is of type float instead of string, and so means nothing' \
    'warning: EV: is of type string instead of float, and so means nothing' \
    'warning: spec:quantity: is of type float instead of string, and so means nothing'
}

@test "finding: own attributes that are not known" {
  spectral a.exr --attribute spec:bin=x
  checks 0 a.exr 'note: spec:bin: is none of the attributes that this version knows'
}

@test "finding: quantities" {
  spectral a.exr --quantity reflectance
  checks 1 a.exr "warning: spec:quantity: is 'reflectance', but the bands are named as light"
  spectral b.exr --kind T --pattern constant:1 --quantity 'radiance per band'
  checks 1 b.exr "warning: spec:quantity: is 'radiance per band', but the bands are named as reflectance"
  spectral c.exr --quantity irradiance
  checks 0 c.exr "note: spec:quantity: is 'irradiance', none of those that this version knows"
}

@test "finding: bins" {
  spectral a.exr --grid 400:500:50 --attribute 'spec:bins=375 425 475'
  checks 1 a.exr 'error: spec:bins: has 3 edges for 3 bands, instead of 4'
  spectral b.exr --grid 400:500:50 --attribute 'spec:bins=375 425  475 525'
  checks 1 b.exr 'error: spec:bins: is not numbers with single spaces between them'
  spectral c.exr --grid 400:500:50 --attribute 'spec:bins=375 425 425 525'
  checks 1 c.exr 'error: spec:bins: the edge 425 nm does not lie above the one before, 425 nm'
  spectral d.exr --grid 400:500:50 --attribute 'spec:bins=375 425 445 525'
  checks 1 d.exr 'error: spec:bins: the bin 425..445 nm is not around its band, 450 nm'
  spectral e.exr --grid 400:500:50 --attribute 'spec:bins=375 425 475 525 575'
  checks 1 e.exr 'error: spec:bins: has 5 edges for 3 bands, instead of 4'
  for file in a b c d e; do
    fails_cleanly specinfo $file.exr
  done
}

@test "finding: handedness" {
  spectral a.exr --kind stokes
  checks 1 a.exr 'warning: polarisationHandedness: is missing: the sign of S3 is not known'
  spectral b.exr --kind stokes --attribute polarisationHandedness=up
  checks 1 b.exr "warning: polarisationHandedness: is 'up', neither 'left' nor 'right'"
}

@test "finding: curves in attributes" {
  spectral a.exr --attribute 'lensTransmission=400nm:0.5;500.5nm:1e-3;' --attribute 'cameraResponse=400nm:0.5' \
    --attribute 'S0.400,000000nm=400nm=0.5'
  checks 1 a.exr 'note: cameraResponse: lacks the semicolon at its end' \
    'warning: S0.400,000000nm: is no curve as the layout writes it (450.0nm:0.5;460.0nm:0.6;)'
}

@test "finding: a history without its last line feed" {
  spectral a.exr --attribute spec:history=tool
  checks 1 a.exr 'warning: spec:history: does not end with a line feed, as each of its lines must'
}

@test "finding: places beyond the Earth" {
  spectral a.exr --number longitude=-180 --number latitude=90.5
  checks 1 a.exr 'warning: latitude: is 90.5 degrees, beyond 90'
  spectral b.exr --number longitude=180.5 --number latitude=-90
  checks 1 b.exr 'warning: longitude: is 180.5 degrees, beyond 180'
  spectral c.exr --number utcOffset=-86401 --attribute 'capDate=2026:01:02 03:04:05'
  checks 1 c.exr 'warning: utcOffset: is -86401 s, beyond 86400'
}

@test "finding: times that are none, and half of a place or time" {
  for date in 2026-01-02T03:04:05 '2026:01:02 03:04' '2026:13:02 03:04:05' '2026:01:02 24:04:05' '2026:01:02 03:04:5 '; do
    spectral a.exr --number utcOffset=-3600 --attribute "capDate=$date"
    checks 1 a.exr "warning: capDate: is '$date', not YYYY:MM:DD hh:mm:ss"
  done
  spectral b.exr --number utcOffset=-3600 --number latitude=3
  checks 0 b.exr 'note: latitude: means nothing without longitude' 'note: utcOffset: means nothing without capDate'
  spectral c.exr --attribute 'capDate=2026:01:02 03:04:05' --number longitude=3
  checks 0 c.exr 'note: longitude: means nothing without latitude'
}

# --check: the file, layers, geometry

@test "finding: tiles, parts, the order of lines" {
  spectral one.exr --size 9x7 --grid 500:540:20 --compression none
  spectral two.exr --size 9x7 --channel Y
  exrmaketiled -t 8 4 one.exr a.exr
  checks 1 a.exr 'warning: file: has tiles of 8 x 4; a writer must write scanlines'
  exrmultipart -combine -i two.exr one.exr -o b.exr >/dev/null
  checks 1 b.exr 'warning: file: has 2 parts; a writer must write a single one'
  reverse_lines one.exr c.exr 7 $((9 * 3 * 4))
  checks 1 c.exr 'warning: file: its lines are not in increasing order, as a writer must write them'
}

@test "finding: layers that do not fit" {
  spectral a.exr --grid 400:500:100 --extra film1.mirror.S0.400,000000nm --extra film1.cosine
  checks 1 a.exr "error: layers: the layer 'film1.mirror' has no band at 500 nm, which S0 has"
}

@test "finding: films without cosine, cover for some of them" {
  for film in 1 2; do
    films+=(--extra "film$film.mirror.S0.400,000000nm")
  done
  spectral a.exr --channel S0.400,000000nm "${films[@]}" --pattern constant:0.5 --extra film1.cosine --extra film2.cover
  checks 1 a.exr 'error: film2.cosine: is missing, and so is Ns or I in its place' \
    'error: layers: have cover for 1 of 2 films; it must be there for all or for none'
}

@test "finding: lamps without a direction" {
  spectral a.exr --channel S0.400,000000nm --extra lamp1.S0.400,000000nm
  checks 1 a.exr "error: lamp1.D: is missing: the direction of the lamp's light"
}

@test "finding: ids that are no whole numbers, vectors that are not whole" {
  spectral a.exr --channel S0.400,000000nm --extra id --extra N.X --extra N.Y
  checks 1 a.exr 'warning: N: has not all of .X, .Y, .Z' 'warning: id: is float; ids are UINT'
  spectral b.exr --channel S0.400,000000nm --extra film1.mirror.S0.400,000000nm --extra film1.cosine --extra film1.id \
    --pattern constant:0.5
  checks 1 b.exr 'warning: film1.id: is float; ids are UINT'
}

# --check: samples

@test "finding: NaN and infinities, the first and how many" {
  spectral a.exr --pattern nan:3,2,5 --pattern nan:2,2,6 --pattern nan:9,7,5 --pattern inf:0,0,1
  checks 1 a.exr 'warning: S0.520,000000nm at 2,2: is NaN, the first of 3 such samples in 2 channels' \
    'warning: S0.420,000000nm at 0,0: is infinite, the first of 1 such samples in 1 channels'
}

@test "finding: NaN where there is no band" {
  spectral a.exr --grid 400:500:100 --extra Z --pattern nan:3,2,2 --pattern inf:4,2,2
  checks 0 a.exr 'note: Z at 3,2: is NaN, the first of 1 such samples in 1 channels' \
    'note: Z at 4,2: is infinite, the first of 1 such samples in 1 channels'
}

@test "finding: negative light, and what reflects more than all" {
  spectral a.exr --size 2x1 --grid 400:500:100 --pattern constant:-0.5
  checks 1 a.exr 'warning: S0.400,000000nm at 0,0: is negative (the least is -0.5), the first of 4 such samples in 2 channels'
  spectral b.exr --size 2x1 --grid 400:500:100 --kind T --pattern constant:1.25
  checks 1 b.exr 'warning: T.400,000000nm at 0,0: is a reflectance above 1 (the most is 1.25), the first of 4 such samples in 2 channels'
  spectral c.exr --size 2x1 --grid 400:500:100 --kind T --pattern constant:1.25 --quantity 'reflectance factor'
  checks 0 c.exr
  spectral d.exr --size 2x1 --grid 400:500:100 --kind T --pattern constant:1.000001
  checks 0 d.exr
}

@test "finding: transmittance and absorptance above 1" {
  for quantity in transmittance absorptance; do
    spectral a.exr --size 2x1 --grid 400:500:100 --kind T --quantity $quantity --pattern constant:1.25
    checks 1 a.exr "warning: T.400,000000nm at 0,0: is a $quantity above 1 (the most is 1.25), the first of 4 such samples in 2 channels"
  done
}

@test "finding: NaN and infinities in layers" {
  spectral a.exr --size 2x1 --channel S0.400,000000nm --extra through.S0.400,000000nm --extra lamp1.S0.400,000000nm \
    --extra lamp1.D.X --extra lamp1.D.Y --extra lamp1.D.Z --pattern constant:1 --pattern nan:1,0,1 --pattern inf:0,0,2
  checks 1 a.exr 'warning: through.S0.400,000000nm at 1,0: is NaN, the first of 1 such samples in 1 channels' \
    'warning: lamp1.S0.400,000000nm at 0,0: is infinite, the first of 1 such samples in 1 channels'
}

@test "finding: negative light in layers" {
  spectral a.exr --size 1x1 --channel S0.400,000000nm --extra through.S0.400,000000nm --pattern constant:-1
  checks 1 a.exr 'warning: S0.400,000000nm at 0,0: is negative (the least is -1), the first of 2 such samples in 2 channels'
}

@test "finding: light that is more polarised than it can be" {
  # Channels count from 0, so S0 is .001, S1 .101, S2 .201 and S3 .301 in the first pixel.
  for component in S0 S1 S2 S3; do
    names+=(--channel "$component.500,000000nm")
  done
  spectral a.exr --size 3x2 "${names[@]}" --attribute polarisationHandedness=left
  checks 1 a.exr 'warning: S0.500,000000nm at 0,0: is less than the length of S1, S2, S3, the first of 6 such samples'
}

@test "what is off by rounding alone is no finding: polarisation, cosines, coverage" {
  spectral a.exr --kind stokes --size 1x1 --grid 500:500:1 --attribute polarisationHandedness=left
  speccomp --no-history -e 'stokes == 0 ? 1 : stokes == 3 ? 1.00005 : 0' a.exr -o b.exr
  checks 0 b.exr
  speccomp --no-history -e 'stokes == 0 ? 1 : stokes == 3 ? -1.0002 : 0' a.exr -o b.exr
  checks 1 b.exr 'warning: S0.500,000000nm at 0,0: is less than the length of S1, S2, S3, the first of 1 such samples'
  spectral c.exr --size 1x1 --channel S0.400,000000nm --extra cosine --pattern constant:1.0009
  checks 0 c.exr
  spectral c.exr --size 1x1 --channel S0.400,000000nm --extra cosine --pattern constant:1.0011
  checks 1 c.exr 'warning: cosine: reaches from 1.0011 to 1.0011, which no cosine does'
  spectral d.exr --size 1x1 --channel S0.400,000000nm --extra A --pattern constant:1.000005
  checks 0 d.exr
  spectral d.exr --size 1x1 --channel S0.400,000000nm --extra A --pattern constant:1.00002
  checks 1 d.exr 'warning: A at 0,0: is a coverage above 1 (the most is 1.00002), the first of 1 such samples in 1 channels'
}

@test "finding: coverage and cosines of films" {
  spectral a.exr --size 1x1 --channel S0.400,000000nm --extra film1.mirror.S0.400,000000nm --extra film1.cosine \
    --extra film1.cover --pattern constant:1.5
  checks 1 a.exr 'warning: film1.cover at 0,0: is a coverage above 1 (the most is 1.5), the first of 1 such samples in 1 channels' \
    'warning: film1.cosine: reaches from 1.5 to 1.5, which no cosine does'
}

@test "finding: coverage beyond 0 to 1, cosines beyond 1" {
  spectral a.exr --size 1x1 --channel S0.400,000000nm --extra A --extra cover --extra cosine --pattern constant:1.5
  checks 1 a.exr 'warning: A at 0,0: is a coverage above 1 (the most is 1.5), the first of 2 such samples in 2 channels' \
    'warning: cosine: reaches from 1.5 to 1.5, which no cosine does'
  spectral b.exr --size 1x1 --channel T.400,000000nm --extra A --pattern constant:-0.5 --without emissiveUnits
  checks 1 b.exr 'warning: T.400,000000nm at 0,0: is negative (the least is -0.5), the first of 1 such samples in 1 channels' \
    'warning: A at 0,0: is a coverage below 0 (the least is -0.5), the first of 1 such samples in 1 channels'
}

@test "finding: nothing but zeros" {
  spectral a.exr --pattern constant:0
  checks 0 a.exr 'note: file: every sample of its bands and layers is 0'
}

@test "--check prints the same for every number of threads" {
  spectral a.exr --size 700x301 --grid 400:700:20 --pattern negative --pattern nan:600,300,3 --pattern nan:5,200,7
  specinfo -j 1 --check a.exr >one || [ $? -eq 1 ]
  [ "$(wc -l <one)" -eq 2 ]
  for threads in 2 5; do
    specinfo -j $threads --check a.exr >several || [ $? -eq 1 ]
    cmp one several
  done
}
