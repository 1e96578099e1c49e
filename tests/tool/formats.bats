#!/usr/bin/env bats
# formats.bats - images that other programs wrote, and those in formats other than OpenEXR
load common

# Two channels whose names are no wavelengths.
two_channels() {
  "$TESTS/synthesize" --size 2x1 --channel red --channel green --pattern constant:0.25 -o two.exr
}

@test "a name map makes bands of channels, in any tool" {
  two_channels
  run --separate-stderr specconvert --name-map red=650nm,green=.55um two.exr -o bands.exr
  [ "$status" = 0 ]
  has_channels bands.exr 'S0.550,000000nm' 'S0.650,000000nm'
  run specdiff --name-map red=650nm,green=550nm two.exr bands.exr
  [ "$status" = 0 ]
}

@test "--read-as says that mapped bands are reflectance" {
  two_channels
  specconvert --name-map red=650nm,green=550nm --read-as reflectance two.exr -o bands.exr
  has_channels bands.exr 'T.550,000000nm' 'T.650,000000nm'
}

@test "--read-as contradicts no name of the layout" {
  "$TESTS/synthesize" --kind S0 --size 2x1 -o light.exr
  run --separate-stderr specconvert --read-as reflectance light.exr -o out.exr
  [ "$status" = 2 ]
  [[ $stderr = *'light.exr: its names say that it is radiance' ]] || complain "$stderr"
  [ ! -e out.exr ]
  specconvert --read-as radiance light.exr -o out.exr
}

@test "a name map that is no map, or does not fit, is refused" {
  two_channels
  local map
  for map in red red= =650nm red=650nm,red=600nm blue=450nm red=0nm red=650xyz; do
    run --separate-stderr specconvert --name-map "$map" two.exr -o out.exr
    [ "$status" = 2 ] || complain "$map"
    [ "${#stderr_lines[@]}" = 1 ] || complain "$map: $stderr"
    [ ! -e out.exr ]
  done
  run --separate-stderr specconvert --name-map blue=450nm two.exr -o out.exr
  [[ $stderr = *"two.exr: has no channel 'blue' to be mapped" ]] || complain "$stderr"
  run --separate-stderr specconvert --read-as light two.exr -o out.exr
  [[ $stderr = *"'light' is neither radiance nor reflectance" ]] || complain "$stderr"
}

@test "the flag for long names is there from 32 bytes on" {
  long=$(printf 'x%.0s' {1..32})
  while read -r flags arguments; do
    # shellcheck disable=SC2086 # several words
    spectral a.exr --size 1x1 $arguments
    [ "$(od -An -tu1 -j 4 -N 4 a.exr | xargs)" = "2 $flags 0 0" ] || complain "$arguments"
  done <<END
0 --extra ${long#x}
4 --extra $long
0 --attribute ${long#x}=a
4 --attribute $long=a
END
}

@test "Ocean's channels have their wavelengths in attributes, in metres" {
  "$TESTS/synthesize" --size 2x1 --channel a --channel b --pattern constant:0.5 \
    --attribute a.wavelength=5.5e-7 --attribute b.wavelength=4.5e-7 -o ocean.exr
  specconvert ocean.exr -o bands.exr
  has_channels bands.exr 'S0.450,000000nm' 'S0.550,000000nm'
  [[ $(header_of bands.exr) != *b.wavelength* ]]
}

# ---- from one format to another ----

# make_image FORMAT FILE ARGUMENT...: an image that the format can hold, as synthesize makes it.
# An image of 8-bit numbers comes from a file of that format.
make_image() {
  local format=$1 file=$2
  shift 2
  spectral source.exr "$@"
  case $format in
  hsr)
    specconvert --no-history source.exr -o source.hsr
    specconvert --no-history source.hsr -o "$file" ;;
  *) specconvert --no-history source.exr -o "$file" ;;
  esac
}

# as_file FORMAT STEM: the name of its file.
as_file() {
  case $1 in
  bands) echo "$2.folder" ;;
  *) echo "$2.$1" ;;
  esac
}

# write_as FORMAT FROM TO
write_as() {
  local more=()
  [ "$1" != bands ] || more=(-f bands)
  specconvert --no-history "${more[@]}" "$2" -o "$3" || complain "$2 is not written as $1"
}

# same_image A B: the same samples, and all that their headers say, in whatever order.
same_image() {
  local said
  specconvert --no-history "$1" -o one.exr && specconvert --no-history "$2" -o two.exr || return 1
  said=$(diff <(exrheader one.exr | sort | grep -v '^file ') <(exrheader two.exr | sort | grep -v '^file ')) ||
    complain "$1 and $2 say:" "$said" || return 1
  specdiff -m max one.exr two.exr || complain "$1 and $2 differ"
}

# What every one of these formats can carry: FLOAT radiance in even bins, and its history.
@test "every pair of formats goes there and back exactly" {
  local from to formats=(exr hdr bsq bil bip tif bands hsr)
  for from in "${formats[@]}"; do
    make_image hsr from.exr --size 5x4 --grid 400:700:20 --bins --quantity 'radiance per nm'
    write_as "$from" from.exr "$(as_file "$from" a)"
    for to in "${formats[@]}"; do
      write_as "$to" "$(as_file "$from" a)" "$(as_file "$to" b)"
      write_as "$from" "$(as_file "$to" b)" "$(as_file "$from" c)"
      same_image "$(as_file "$from" a)" "$(as_file "$from" c)" || complain "$from by $to"
      same_image from.exr "$(as_file "$to" b)" || complain "$from to $to"
      rm -rf b.* c.*
    done
    rm -rf a.*
  done
}

# What OpenEXR's other readers of floats carry, and Radiance's does not.
@test "windows, aspect, quantity, bins, samples and history go along" {
  local to
  spectral a.exr --size 5x4 --data -2,3 --display -4,0,8,10 --kind T --grid 400:700:50 --bins \
    --quantity 'transmittance' --pattern negative --attribute 'spec:note={a} 100%
two lines '
  specconvert --half --scale 1 a.exr -o from.exr # and bands that are HALF
  for to in hdr bsq bil bip tif bands; do
    write_as "$to" from.exr "$(as_file "$to" b)"
    specconvert --no-history --half "$(as_file "$to" b)" -o back.exr
    same_image from.exr back.exr || complain "$to"
    header_of back.exr | grep -q 'spec:history.*specconvert --half' || complain "$to has no history"
    rm -rf b.*
  done
}

@test "samples per pixel go along" {
  local to
  cat >scene.pbrt <<'END'
Film "rgb" "integer xresolution" 2 "integer yresolution" 2
WorldBegin
LightSource "infinite" "spectrum L" "D65"
END
  specrender -q --spp 3 --grid 400:700:100 scene.pbrt -o a.exr
  for to in hdr tif bands; do
    write_as "$to" a.exr "$(as_file "$to" b)"
    specconvert "$(as_file "$to" b)" -o back.exr
    has_line back.exr 'spec:samples (type int): 3'
  done
}

@test "text of small images goes there and back" {
  local suffix
  spectral a.exr --size 3x2 --grid 400:700:50 --pattern noise --quantity 'radiance per nm'
  for suffix in spd csv txt; do
    specconvert a.exr -o "a.$suffix"
    specconvert --no-history --patches 3x2 "a.$suffix" -o b.exr
    specdiff a.exr b.exr || complain "$suffix"
  done
  [ "$(head -n 1 a.csv)" = wavelength_nm,x0y0,x1y0,x2y0,x0y1,x1y1,x2y1 ]
  [ "$(wc -l <a.csv)" = 8 ]
  [[ $(sed -n 2p a.csv) =~ ^400(,[0-9.e-]+){6}$ ]]
  specconvert -f csv a.exr | cmp - a.csv
  specconvert -f csv a.csv | cmp - a.csv
}

@test "a CSV file says what it is on the command line alone" {
  spectral a.exr --size 2x1 --kind T --grid 400:700:50
  specconvert a.exr -o a.csv
  specconvert --patches 2x1 --read-as reflectance a.csv -o b.exr
  specdiff a.exr b.exr
  fails_cleanly specconvert --patches 1x1 --read-as radiance cornell-red -o c.exr
  [[ $stderr = *"'cornell-red' says itself that it is reflectance" ]] || complain "$stderr"
  specconvert D65 -f csv | head -n 1 | grep -qx 'wavelength_nm,S'
}

@test "as many pixels as fit a text go there and back" {
  spectral a.exr --size 64x64 --grid 400:500:100 --pattern noise
  specconvert a.exr -o a.csv
  specconvert --patches 64x64 a.csv -o b.exr
  specdiff a.exr b.exr
}

@test "NaN and infinities go through formats of floats" {
  local to
  spectral a.exr --size 4x3 --grid 400:700:100 --pattern nan:1,2,0 --pattern inf:3,0,2
  specconvert --no-history --compression none a.exr -o plain.exr
  for to in hdr bsq bip tif bands; do
    write_as "$to" a.exr "$(as_file "$to" b)"
    specconvert --no-history --compression none "$(as_file "$to" b)" -o back.exr
    # The chunks are the end of both files; the order of attributes may be another.
    cmp <(tail -c $((3 * (8 + 4 * 4 * 4))) plain.exr) <(tail -c $((3 * (8 + 4 * 4 * 4))) back.exr) ||
      complain "$to"
  done
}

@test "bands whose names do not sort as their wavelengths do" {
  local to
  spectral a.exr --size 3x2 --grid 800:1200:100 --pattern noise
  for to in hdr bsq bip tif bands hsr; do
    [ "$to" != hsr ] || { specconvert a.exr -o x.hsr && specconvert --no-history x.hsr -o a.exr; }
    write_as "$to" a.exr "$(as_file "$to" b)"
    specdiff a.exr "$(as_file "$to" b)" || complain "$to"
  done
}

# ---- what is written ----

@test "ENVI's three orders have the bytes that they should" {
  # Two bands of two pixels by two lines: x + 2 y + 4 band, and 1.
  printf '400 1 2 3 4\n500 5 6 7 8\n' >a.spd
  specconvert --patches 2x2 a.spd -o a.exr
  local name order
  for name in bsq bil bip; do
    specconvert a.exr -o "a.$name"
    case $name in
    bsq) order='1 2 3 4 5 6 7 8' ;;
    bil) order='1 2 5 6 3 4 7 8' ;;
    bip) order='1 5 2 6 3 7 4 8' ;;
    esac
    [ "$(od -A n -v -t f4 -w64 "a.$name" | tr -s ' ')" = " $order" ] || complain "$name: $(od -t f4 "a.$name")"
    grep -qx "interleave = $name" a.hdr
  done
  specconvert a.exr -o b.hdr
  cmp b.img a.bil
}

@test "an unknown key of ENVI's is written again, known ones anew" {
  spectral a.exr --size 2x2 --grid 400:500:100
  specconvert --no-history a.exr -o a.hdr
  printf 'map info = {UTM, 1,\n 2}\nbbl = {1, 0}\nfwhm = {9, 9}\nband names = {one, two}\ndata ignore value = 77\n; a comment\n' >>a.hdr
  specconvert a.hdr -o b.exr
  specconvert --band 400 b.exr -o c.hdr
  grep -A 1 -x 'map info = {UTM, 1,' c.hdr | grep -qx ' 2}'
  grep -qx 'bands = 1' c.hdr
  [ "$(grep -cE 'bbl|fwhm|one, two|ignore|comment' c.hdr)" = 0 ] || complain "$(cat c.hdr)"
  [ "$(grep -c '^samples' c.hdr)" = 1 ]
}

@test "the bytes of a Radiance picture go there and back" {
  printf '#?RADIANCE\nrpict scene.oct\nNCOMP=4\nWAVELENGTH_SPLITS= 780 588 480 380\nFORMAT=Radiance_spectra\n\n-Y 2 +X 1\n\200\377\001\000\200\150\200\000\012\203' >a.hsr
  specconvert --no-history a.hsr -o b.hsr
  cmp a.hsr b.hsr
  specconvert --no-history a.hsr -o b.exr
  specconvert --no-history b.exr -o c.hsr
  cmp a.hsr c.hsr
  # Commands are lines of its header.
  specconvert b.exr -o d.hsr
  sed -n 3p d.hsr | grep -q '^specconvert b.exr -o d.hsr'
}

@test "what Radiance's pictures cannot hold is refused" {
  local -A why=([negative]='is negative' [nan]='is negative, too large or no number')
  spectral negative.exr --size 2x2 --pattern negative
  spectral nan.exr --size 2x2 --pattern nan:1,1,3
  spectral kind.exr --size 2x2 --kind T
  spectral few.exr --size 2x2 --grid 400:600:100
  spectral uneven.exr --size 2x2 --channel S0.400,0nm --channel S0.410,0nm --channel S0.420,0nm --channel S0.440,0nm
  spectral band.exr --size 2x2 --quantity 'radiance per band'
  spectral alpha.exr --size 2x2 --extra A
  why+=([kind]='holds radiance in four bands' [few]='holds radiance in four bands'
    [uneven]='bands of one width' [band]='not per band' [alpha]="no place for channel 'A'")
  local name
  for name in "${!why[@]}"; do
    fails_cleanly specconvert "$name.exr" -o out.hsr
    [[ $stderr = *"${why[$name]}"* ]] || complain "$name: $stderr"
  done
  [ ! -e out.hsr ]
}

@test "what no other format can hold is refused by all" {
  local to
  spectral alpha.exr --size 2x2 --extra A
  spectral stokes.exr --size 2x2 --kind stokes
  for to in envi tiff bands; do
    fails_cleanly specconvert -f "$to" alpha.exr -o out
    [[ $stderr = *"no place for channel 'A'"* ]] || complain "$to: $stderr"
    fails_cleanly specconvert -f "$to" stokes.exr -o out
    [[ $stderr = *'neither Stokes components'* ]] || complain "$to: $stderr"
    fails_cleanly specconvert -f "$to" --half alpha.exr -o out
    [[ $stderr = *'--half is for OpenEXR alone'* ]] || complain "$to: $stderr"
    fails_cleanly specconvert -f "$to" --compression zip alpha.exr -o out
    [[ $stderr = *'--compression is for OpenEXR alone'* ]] || complain "$to: $stderr"
  done
  no_leftovers . alpha.exr stokes.exr
}

@test "a file of many channels that says nothing needs its wavelengths" {
  spectral a.exr --size 4x3 --grid 400:700:50 --pattern noise
  specconvert a.exr -o a.tif
  # Of as many bytes, so that all else of the file stays.
  LC_ALL=C sed -i 's/spectools/nonsenses/' a.tif
  fails_cleanly specconvert a.tif -o b.exr
  [[ $stderr = *'does not say of which wavelengths its 7 bands are (--wavelengths LO:HI:STEP)' ]] || complain "$stderr"
  fails_cleanly specconvert --wavelengths 400:700:50 a.tif -o b.exr
  [[ $stderr = *'(--read-as)' ]] || complain "$stderr"
  fails_cleanly specconvert --wavelengths 400:700:100 --read-as radiance a.tif -o b.exr
  [[ $stderr = *'has 7 bands, and --wavelengths gives 4' ]] || complain "$stderr"
  specconvert --wavelengths 400:700:50 --read-as radiance a.tif -o b.exr
  specdiff a.exr b.exr
  # From a pipe, and with no suffix to tell.
  cat a.tif | specconvert --wavelengths 400:700:50 --read-as radiance - -o c.exr
  specdiff a.exr c.exr
}

# ---- folders and lists ----

@test "a folder of bands: names, single files, lists" {
  spectral a.exr --size 4x3 --grid 400:480:20 --bins --pattern noise --quantity 'radiance per nm'
  specconvert --no-history -f bands a.exr -o folder
  no_leftovers folder 400nm.tif 420nm.tif 440nm.tif 460nm.tif 480nm.tif
  specconvert --no-history folder -o b.exr
  same_image a.exr b.exr
  # Neighbours keep their bins, others have none.
  specconvert folder/440nm.tif folder/420nm.tif -o two.exr
  specconvert --band 420 --band 440 a.exr -o wanted.exr
  specdiff two.exr wanted.exr
  has_line two.exr 'spec:bins (type string): "410 430 450"'
  specconvert folder/400nm.tif folder/480nm.tif -o apart.exr
  [[ $(header_of apart.exr) != *spec:bins* ]]
  specconvert folder/460nm.tif -o one.exr
  has_channels one.exr S0.460,000000nm
  # Their wavelengths are in them, whatever their names are.
  mv folder/400nm.tif folder/z.tif
  specconvert --no-history folder -o c.exr
  same_image a.exr c.exr
}

@test "a folder is written where nothing else would be read with it" {
  spectral a.exr --size 2x2 --grid 400:500:100
  spectral b.exr --size 2x2 --grid 400:600:100 --pattern constant:3
  specconvert -f bands a.exr -o folder
  specconvert -f bands b.exr -o folder # more bands: none is left from before
  specdiff b.exr folder
  fails_cleanly specconvert -f bands a.exr -o folder
  [[ $stderr = *"folder: has '600nm.tif' in it, which is no band of this image" ]] || complain "$stderr"
  specdiff b.exr folder
  fails_cleanly specconvert -f bands a.exr
  fails_cleanly specconvert -f bands a.exr -o a.exr
  no_leftovers . a.exr b.exr folder
}

@test "grey pictures numbered from the first band on, as CAVE has them" {
  local i
  mkdir cave
  for i in 1 2 3; do
    printf 'P5\n2 1\n65535\n\0%b\377\377' "\\0$((i))" >p.pgm
    cp p.pgm "cave/scene_ms_0$i.pgm"
  done
  echo 'not a picture' >cave/README.txt
  specconvert --wavelengths 400:420:10 --read-as reflectance cave -o a.exr
  has_channels a.exr T.400,000000nm T.410,000000nm T.420,000000nm
  numbers a.exr | awk '{ if ($2 < (NR - .01) / 65535 || $2 > (NR + .01) / 65535 || $3 < .9999) exit 1 }'
  # In the order that the shell gives them.
  specconvert --wavelengths 400:420:10 --read-as reflectance cave/*.pgm -o b.exr
  specdiff a.exr b.exr
  fails_cleanly specconvert cave -o c.exr
  [[ $stderr = *'cave: does not say of which wavelengths its 3 bands are'* ]] || complain "$stderr"
  printf 'P5\n1 2\n65535\n\0\0\0\0' >cave/scene_ms_04.pgm
  fails_cleanly specconvert --wavelengths 400:430:10 --read-as reflectance cave -o c.exr
  [[ $stderr = *'scene_ms_04.pgm: has 1 x 2 pixels, and '*' has 2 x 1' ]] || complain "$stderr"
  mkdir empty
  fails_cleanly specconvert --wavelengths 400:430:10 empty -o c.exr
  [[ $stderr = *'empty: has no picture in it' ]] || complain "$stderr"
  [ ! -e c.exr ]
}

# ---- pictures for eyes ----

@test "pictures of red, green and blue become linear" {
  spec2rgb -q --bits 16 "$ROOT/tests/example.exr" -o a.png
  spec2rgb -q "$ROOT/tests/example.exr" -o wanted.exr
  specconvert a.png -o a.exr
  has_channels a.exr B G R
  "$TESTS/layers" --print 0,0 wanted.exr | sort >wanted
  "$TESTS/layers" --print 0,0 a.exr | sort >got
  # 1/131070 of the code at most, where the curve is steepest, 2.4 x 1.055^-1 as high.
  paste wanted got | awk '{ w = $2 > 1 ? 1 : $2 < 0 ? 0 : $2; d = w - $4
    if ($1 != $3 || d * d > 2e-5 * 2e-5) { print; exit 1 } }'
  # By OpenImageIO, and as grey.
  spec2rgb -q "$ROOT/tests/example.exr" -o b.tif
  spec2rgb -q "$ROOT/tests/example.exr" -o b.png
  specconvert --no-history b.tif -o c.exr
  specconvert --no-history b.png -o d.exr
  # OpenImageIO's curve for 8 bits is its own, a float's rounding from the definition.
  paste <("$TESTS/layers" --print 1,0 c.exr) <("$TESTS/layers" --print 1,0 d.exr) |
    awk '{ d = $2 - $4; if ($1 != $3 || d * d > 1e-13) { print; exit 1 } }'
}

@test "PNG is read without OpenImageIO, from pipes, and its faults are told in one line" {
  spec2rgb -q "$ROOT/tests/example.exr" -o a.png
  specconvert --no-history a.png -o a.exr
  cat a.png | specconvert --no-history -o b.exr
  cmp a.exr b.exr
  specconvert --no-history <a.png | specconvert --no-history - -o b.exr
  cmp a.exr b.exr
  mkdir -p bin lib/spectools
  cp "$(command -v specconvert)" bin/
  bin/specconvert --no-history a.png -o b.exr # there is no plugin beside it
  cmp a.exr b.exr
  specfilm --stack 'air | 1.33 * | air' --chart 'thickness 0..700, angle 0..80' --size 64x64 |
    spec2rgb -q -o large.png
  head -c 3000 large.png >cut.png
  fails_cleanly specconvert cut.png -o c.exr
  [[ $stderr =~ 'cut.png: ends early, in line '[0-9]+' of 0..63'$ ]] || complain "$stderr"
  cp large.png bad.png
  poke bad.png 1500 'xxxx'
  fails_cleanly specconvert bad.png -o c.exr
  fails_cleanly specconvert - -o c.exr < <(cat cut.png)
  [ ! -e c.exr ]
}

# ---- trouble ----

@test "data that are missing or short, and a header alone" {
  spectral a.exr --size 4x3 --grid 400:700:100
  specconvert a.exr -o a.hdr
  fails_cleanly specconvert - -o b.exr <a.hdr
  [[ $stderr = *'is the header of an ENVI file'* ]] || complain "$stderr"
  truncate -s -1 a.img
  fails_cleanly specconvert a.hdr -o b.exr
  [[ $stderr = *'a.img: ends early: has 191 bytes instead of 192' ]] || complain "$stderr"
  rm a.img
  fails_cleanly specconvert a.hdr -o b.exr
  [[ $stderr = *'were not found beside it'* ]] || complain "$stderr"
  [ ! -e b.exr ]
}

@test "a Radiance picture that ends early in a pipe: the line is named" {
  spectral a.exr --size 40x30 --grid 400:700:20
  specconvert a.exr -o a.hsr
  fails_cleanly specconvert - -o b.exr < <(head -c 9000 a.hsr)
  [[ $stderr = *'<stdin>: ends early, in line 13 of 0..29' ]] || complain "$stderr"
  [ ! -e b.exr ]
}

@test "a full disk: one line, and nothing left" {
  local name
  spectral a.exr --size 64x64 --grid 400:700:10
  for name in hsr tiff; do
    fails_cleanly specconvert -f $name a.exr -o /dev/full
    [[ $stderr = *'No space left on device' ]] || complain "$name: $stderr"
  done
  mkdir small
  # As large as half of the data.
  for name in out.hdr out.bsq out.bip out.tif out.hsr; do
    (ulimit -f 100 && trap '' XFSZ && fails_cleanly specconvert "$PWD/a.exr" -o "small/$name") || complain "$name"
    no_leftovers small || complain "$name"
  done
  # That libtiff's last bytes, too, did not go out is found by looking at them.
  for name in 10 16; do
    (ulimit -f $name && trap '' XFSZ && fails_cleanly specconvert -f bands a.exr -o small/folder) ||
      complain "folder, $name KiB"
    no_leftovers small
  done
}

@test "an output that is there stays until the new one is complete" {
  spectral a.exr --size 4x4 --grid 400:700:100
  spectral bad.exr --size 4x4 --grid 400:700:100 --compression none
  truncate -s -9 bad.exr
  local to
  for to in hdr bsq tif hsr; do
    specconvert --no-history a.exr -o "a.$to"
    cp "a.$to" kept
    fails_cleanly specconvert --no-history bad.exr -o "a.$to"
    cmp "a.$to" kept || complain "$to"
    specconvert --no-history --scale 2 a.exr -o "a.$to"
    specconvert --no-history --scale 1 a.exr -o "a.$to"
    cmp "a.$to" kept || complain "$to"
  done
  specconvert -f bands a.exr -o folder
  fails_cleanly specconvert -f bands bad.exr -o folder
  fails_cleanly specconvert -f bands bad.exr -o other
  [ ! -e other ]
}

@test "any number of threads gives the same bytes" {
  local to
  spectral a.exr --size 50x120 --grid 400:700:5 --pattern noise
  for to in hdr bsq bip tif hsr; do
    specconvert --no-history -j 1 a.exr -o "one.$to"
    specconvert --no-history -j 5 a.exr -o "five.$to"
    case $to in
    hdr) cmp one.img five.img && cmp one.hdr five.hdr ;;
    *) cmp "one.$to" "five.$to" ;;
    esac || complain "writing $to"
    specconvert --no-history -j 1 "one.$to" -o one.exr
    specconvert --no-history -j 5 "one.$to" -o five.exr
    cmp one.exr five.exr || complain "reading $to"
  done
}

@test "pipes carry what one file holds" {
  local to
  spectral a.exr --size 50x20 --grid 400:700:5
  for to in hsr tiff; do
    specconvert --no-history -f "$to" a.exr -o "a.$to" || true
    specconvert --no-history -f "$to" a.exr >b
    specconvert --no-history -f "$to" a.exr | cat >c
    cmp b c || complain "$to"
    cat b | specconvert --no-history - -o d.exr
    specconvert --no-history b -o e.exr
    cmp d.exr e.exr || complain "$to"
  done
  for to in envi bands; do
    fails_cleanly specconvert -f "$to" a.exr
    [[ $stderr = *'standard output'* ]] || complain "$to: $stderr"
  done
}

@test "a suffix counts below /dev, too, where it is a known one" {
  [ -w /dev/shm ] || skip 'no /dev/shm'
  spectral a.exr --size 2x2
  local folder
  folder=$(mktemp -d /dev/shm/formats.XXXXXX)
  specconvert a.exr -o "$folder/a.hsr" && specconvert a.exr -o "$folder/a.csv" &&
    specconvert a.exr -o "$folder/a.other" && specconvert D65 -o "$folder/b.other"
  cp "$folder"/* .
  rm -r "$folder"
  [ "$(head -c 10 a.hsr)" = '#?RADIANCE' ]
  [ "$(head -c 13 a.csv)" = wavelength_nm ]
  cmp <(head -c 4 a.exr) <(head -c 4 a.other)
  specconvert D65 | cmp - b.other
}

@test "images are not written to a terminal in other formats either" {
  spectral a.exr --size 2x2
  shuns_terminal 'specconvert -f hsr a.exr'
  shuns_terminal 'specconvert -f tiff a.exr'
}
