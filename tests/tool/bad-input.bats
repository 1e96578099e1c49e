#!/usr/bin/env bats
# Input that is damaged, hostile or merely odd: one line, exit status 2, and no partial file.
# shellcheck disable=SC2154 # fails_cleanly leaves its line in stderr

load common

# refused FILE [ARGUMENT...]: every tool refuses it, from a file and from a pipe.
refused() {
  local file=$1 tool code
  shift
  for tool in spec2rgb specconvert; do
    fails_cleanly $tool "$@" "$file" -o out.exr
    fails_cleanly $tool "$@" - -o out.exr < <(cat "$file")
  done
  fails_cleanly specinfo --statistics "$@" "$file"
  fails_cleanly specinfo --statistics "$@" - < <(cat "$file")
  # What is damaged is trouble; what is merely forbidden is found, and makes 1.
  code=0
  specinfo --check "$@" "$file" >found 2>err || code=$?
  [[ $code = 2 && ! -s found && $(wc -l <err) = 1 || $code = 1 && -s found && ! -s err ]] ||
    complain "specinfo --check: exit $code" "$(cat found err)" || return 1
  rm found err
  fails_cleanly specdiff "$@" "$file" "$file"
  [ ! -e out.exr ] || complain "a file was left: $*"
}

# survived FILE: specconvert makes a whole image of it, or refuses it cleanly; from a file and
# from a pipe. It neither crashes nor hangs; $accepted counts what it took.
survived() {
  local code=0 input said
  for input in "$1" -; do
    [ ! -e out.exr ] || rm out.exr
    code=0
    timeout 30 specconvert "$input" -o out.exr < <([ "$input" != - ] || cat "$1") >printed 2>err || code=$?
    case $code in
    0) accepted=$((accepted + 1)) ;;
    2)
      mapfile -t said <err
      [ ${#said[@]} -eq 1 ] || complain "${said[@]}" || return 1
      [ ! -e out.exr ] || complain 'a file was left' || return 1
      ;;
    *) complain "exit $code: $2" "$(cat err)" || return 1 ;;
    esac
    [ ! -s printed ] || complain 'something on stdout' || return 1
  done
}

# truncated FILE: at every 1 %, from a file and from a pipe.
truncated() {
  local size percent
  size=$(wc -c <"$1")
  for ((percent = 0; percent < 100; percent++)); do
    head -c $((size * percent / 100)) "$1" >short.exr
    fails_cleanly specconvert short.exr -o out.exr || complain "at $percent %" || return 1
    fails_cleanly specconvert - -o out.exr < <(cat short.exr) || complain "at $percent %, pipe" || return 1
  done
  no_leftovers . "$1" short.exr "${@:2}"
}

# box X0 Y0 X1 Y1: a window as it stands in a file, with the last pixel, as printf's escapes.
box() {
  little 4 "$1"
  little 4 "$2"
  little 4 "$3"
  little 4 "$4"
}

# set_window FILE NAME X0 Y0 X1 Y1
set_window() {
  poke "$1" "$(attribute_at "$1" "$2" box2i)" "$(box "${@:3}")"
}

largest=2147483647

# What is no image

@test "an empty file" {
  : >empty.exr
  refused empty.exr
  [[ $stderr = *'empty.exr: is empty' ]]
}

@test "a text" {
  echo 'not an image, but longer than a magic number' >text.exr
  refused text.exr
  [[ $stderr = *'is no image in a format that is read here' ]]
}

@test "one byte of the magic number, and all four alone" {
  printf '\x76' >one.exr
  printf '\x76\x2f\x31\x01' >four.exr
  refused one.exr
  refused four.exr
}

@test "a folder without pictures" {
  mkdir folder.exr
  for tool in spec2rgb specconvert; do
    fails_cleanly $tool folder.exr -o out.exr
    [[ $stderr = *"folder.exr: has no picture in it" ]] || complain "$stderr"
    fails_cleanly $tool -o out.exr <folder.exr
  done
  no_leftovers . folder.exr
}

@test "a file that is not there" {
  for tool in spec2rgb specconvert; do
    for suffix in exr hdr tif; do
      fails_cleanly $tool missing.$suffix -o out.exr
      [[ $stderr = *missing.$suffix*'No such file or directory' ]] || complain "$stderr"
    done
  done
}

@test "a name that is neither a file nor a spectrum" {
  fails_cleanly specconvert missing
  [[ $stderr = *missing* ]]
}

@test "nothing on standard input" {
  for tool in spec2rgb specconvert; do
    fails_cleanly $tool -o out.exr </dev/null
    [[ $stderr = *'is empty' ]] || complain "$stderr"
  done
}

# Truncated

@test "uncompressed lines cut off at every 1 %" {
  spectral a.exr --size 9x7 --grid 500:540:20 --compression none --uint-id
  truncated a.exr
}

@test "ZIP cut off at every 1 %" {
  spectral a.exr --size 9x35 --grid 500:540:20 --compression zip --pattern noise
  truncated a.exr
}

@test "tiles cut off at every 1 %" {
  spectral lines.exr --size 19x13 --grid 500:520:20 --pattern noise
  exrmaketiled -t 8 4 lines.exr a.exr
  rm lines.exr
  truncated a.exr
}

@test "a part cut off at every 1 %" {
  spectral one.exr --size 9x7 --grid 500:520:20
  spectral two.exr --size 9x7 --channel Y --pattern noise
  exrmultipart -combine -i two.exr one.exr -o a.exr >/dev/null
  rm one.exr two.exr
  truncated a.exr
}

@test "spec2rgb and specdiff of a file that is cut off" {
  spectral a.exr --size 9x7
  size=$(wc -c <a.exr)
  for percent in 1 20 40 60 80 99; do
    head -c $((size * percent / 100)) a.exr >short.exr
    refused short.exr
  done
}

# Channels

@test "a band without a wavelength" {
  spectral a.exr --channel S0.nm --channel S0.500nm
  refused a.exr
  [[ $stderr = *"'S0.nm'"* ]] || complain "$stderr"
}

@test "a band whose wavelength is none of light" {
  for name in S0.0nm S0.0,000nm T.1e99nm T.500nm.0nm S0.0Hz S0.1e-5nm; do
    spectral a.exr --channel $name --channel S0.500nm
    refused a.exr
    [[ $stderr = *"'$name'"* ]] || complain "$stderr"
  done
}

@test "one band twice" {
  spectral a.exr --channel S0.500nm --channel S0.500,0nm
  refused a.exr
  spectral a.exr --channel S0.500nm --channel S0.0,5um
  refused a.exr
}

@test "two grids in one file" {
  spectral a.exr --channel S0.500nm --channel S0.600nm --channel S1.500nm --channel S2.500nm --channel S3.500nm
  refused a.exr
  spectral b.exr --channel S0.500nm --channel S0.600nm --channel 495.00-505.00nm
  refused b.exr
}

@test "light and reflectance in one file" {
  spectral a.exr --channel S0.500nm --channel T.500nm
  refused a.exr
  spectral b.exr --channel S0.500nm --channel w500nm
  refused b.exr
}

@test "no spectral channel" {
  spectral a.exr --channel R --channel G --channel B
  fails_cleanly spec2rgb a.exr -o out.png
  [[ $stderr = *'no spectral channel' ]]
  fails_cleanly specconvert --scale 2 a.exr -o out.exr
  [[ $stderr = *'no spectral channel' ]]
  fails_cleanly specconvert a.exr -o out.spd
  [[ $stderr = *'no spectral channel' ]]
  no_leftovers . a.exr
}

@test "bins that do not fit the bands" {
  for bins in '' abc '490 510' '490 510 505 550' '490 510 530 550 570' '490 nan 530 550' '495 505 515 525'; do
    spectral a.exr --grid 500:540:20 --attribute "spec:bins=$bins"
    refused a.exr
  done
}

# header CHANNELS...: an OpenEXR file of 1 x 1 pixel, up to its chunk table. The channels come
# as the bytes of a list.
attribute() {
  printf '%s\0%s\0' "$1" "$2"
  # shellcheck disable=SC2059 # made of escapes
  printf "$(little 4 "$3")"
}

header() {
  local size=$1
  printf '\x76\x2f\x31\x01\x02\0\0\0'
  attribute channels chlist "$size"
  cat
  attribute compression compression 1 && printf '\0'
  attribute dataWindow box2i 16 && printf '\0%.0s' {1..16}
  attribute displayWindow box2i 16 && printf '\0%.0s' {1..16}
  attribute lineOrder lineOrder 1 && printf '\0'
  attribute pixelAspectRatio float 4 && printf '\0\0\x80\x3f'
  attribute screenWindowCenter v2f 8 && printf '\0%.0s' {1..8}
  attribute screenWindowWidth float 4 && printf '\0\0\x80\x3f'
  printf '\0'
}

# many COUNT: a list of so many FLOAT bands, 29 bytes each.
many() {
  printf 'S0.%07dnm\0\2\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0' $(seq 100000 $((99999 + $1)))
  printf '\0'
}

@test "a header made by hand is read" {
  # so that what the next test refuses is refused for its 40000 channels
  {
    many 2 | header $((2 * 29 + 1))
    # the table, then line 0 of 8 bytes: 1 and 2
    size=$({ many 2 | header 59; } | wc -c)
    # shellcheck disable=SC2059 # made of escapes
    printf "$(little 8 $((size + 8)))"
    printf '\0\0\0\0\x08\0\0\0\0\0\x80\x3f\0\0\0\x40'
  } >a.exr
  specconvert a.exr -f spd | grep -v '^#' >found
  [ "$(cat found)" = '100000 1
100001 2' ] || complain "$(cat found)"
}

@test "40000 channels" {
  many 40000 | header $((40000 * 29 + 1)) >a.exr
  printf '\0%.0s' {1..64} >>a.exr
  fails_cleanly specconvert a.exr -o out.exr
  [[ $stderr = *'40000 channels'*'--limit channels='* ]] || complain "$stderr"
  fails_cleanly specconvert --limit channels=100000 - -o out.exr < <(cat a.exr)
  no_leftovers . a.exr
}

@test "more channels than anybody can use are refused before they are sorted" {
  # OpenEXRCore sorts them in as it reads, which takes time by the square of their number:
  # half a million, of 15 MB, well below the header's limit, would take minutes.
  many 500000 | header $((500000 * 29 + 1)) >a.exr
  code=0
  timeout 20 specconvert a.exr -o out.exr 2>err || code=$?
  [ "$code" -eq 2 ] || complain "exit $code"
  [ "$(wc -l <err)" -eq 1 ]
}

# Sizes

@test "a window of 2^31 pixels" {
  spectral a.exr --compression none
  set_window a.exr dataWindow 0 0 $largest 0
  refused a.exr
  [[ $stderr = *'ata window'* ]] || complain "$stderr"
  refused a.exr --limit pixels=1T
}

@test "a window that OpenEXR allows and the limit does not" {
  spectral a.exr --compression none
  set_window a.exr dataWindow 0 0 99999 99999
  refused a.exr
  [[ $stderr = *'100000 x 100000'*'--limit pixels='* ]] || complain "$stderr"
  refused a.exr --limit pixels=1T
}

@test "windows from one end of the numbers to the other" {
  spectral a.exr --compression none
  for window in "-2147483648 0 $largest 0" "0 -2147483648 0 $largest" \
    "-2147483648 -2147483648 $largest $largest" "$largest 0 $largest 0" \
    "-2147483648 0 -2147483648 0" "0 $largest 0 $largest"; do
    # shellcheck disable=SC2086 # four numbers
    set_window a.exr dataWindow $window
    refused a.exr
    refused a.exr --limit pixels=1T
  done
}

@test "a window one pixel beyond 2^30" {
  spectral a.exr --compression none --size 1x1
  for window in "1073741824 0 1073741824 0" "0 1073741824 0 1073741824" "-1073741825 0 -1073741825 0" \
    "0 -1073741825 0 -1073741825"; do
    # shellcheck disable=SC2086 # four numbers
    set_window a.exr dataWindow $window
    refused a.exr
    [[ $stderr = *'ata window'* ]] || complain "$stderr"
  done
}

@test "a window that ends before it begins" {
  spectral a.exr --compression none
  set_window a.exr dataWindow 5 0 3 7
  refused a.exr
  set_window a.exr dataWindow 0 5 15 3
  refused a.exr
}

@test "a display window that ends before it begins, or at the end of the numbers" {
  spectral a.exr --compression none
  accepted=0
  set_window a.exr displayWindow 5 0 -3 7
  survived a.exr
  set_window a.exr displayWindow -2147483648 -2147483648 $largest $largest
  survived a.exr
}

@test "more pixels than the limit" {
  spectral a.exr
  refused a.exr --limit pixels=127
  [[ $stderr = *'16 x 8'*127*'--limit pixels='* ]] || complain "$stderr"
}

@test "without --limit, 2^30 pixels and 4 GiB of buffers are the most" {
  spectral a.exr --compression none
  set_window a.exr dataWindow 0 0 32767 32768
  refused a.exr
  [[ $stderr = *'32768 x 32769'*1073741824*'--limit pixels='* ]] || complain "$stderr"
  set_window a.exr dataWindow 0 0 32767 32767
  refused a.exr
  [[ $stderr != *'--limit pixels='* ]] || complain "$stderr"
  set_window a.exr dataWindow 0 0 1073741822 0
  refused a.exr
  [[ $stderr = *4294967296*'--limit memory='* ]] || complain "$stderr"
}

@test "without --limit, 16384 attributes are the most" {
  spectral a.exr --compression none --size 1x1 --grid 500:500:1
  end=$(($(table_at a.exr 1 4) - 1))
  {
    head -c $end a.exr
    awk 'BEGIN { for (i = 0; i < 16385; i++) printf "a%05d%cstring%c%c%c%c%c", i, 0, 0, 0, 0, 0, 0 }'
    tail -c +$((end + 1)) a.exr
  } >many.exr
  fails_cleanly specconvert many.exr -o out.exr
  [[ $stderr = *16384*'--limit attributes='* ]] || complain "$stderr"
}

@test "more channels than the limit" {
  spectral a.exr
  refused a.exr --limit channels=15
  [[ $stderr = *16*15*'--limit channels='* ]] || complain "$stderr"
}

@test "a header longer than the limit" {
  spectral a.exr
  refused a.exr --limit header=500
  [[ $stderr = *500*'--limit header='* ]] || complain "$stderr"
}

@test "more memory than the limit" {
  spectral a.exr
  refused a.exr --limit memory=2k
  [[ $stderr = *2048*'--limit memory='* ]] || complain "$stderr"
}

@test "a limit that is none" {
  spectral a.exr
  for limit in pixels pixels= pixels=0 pixels=-1 pixels=x pixels=1kk depth=3 =3 ''; do
    fails_cleanly specconvert --limit "$limit" a.exr -o out.exr
  done
}

@test "an attribute that claims to be longer than the file" {
  spectral a.exr
  for size in 1000000 $largest 4294967295; do
    cp a.exr b.exr
    poke b.exr $(($(attribute_at b.exr emissiveUnits string) - 4)) "$(little 4 "$size")"
    refused b.exr
    cp a.exr b.exr
    poke b.exr $(($(attribute_at b.exr channels chlist) - 4)) "$(little 4 "$size")"
    fails_cleanly specconvert b.exr -o out.exr
    # On a pipe the size of the file is not known, and the list has an end of its own.
    refused_or_same b.exr
  done
}

# Headers

@test "a version and flags that nobody knows" {
  spectral a.exr
  for bytes in '\x07\x00' '\x02\x80' '\x02\xff'; do
    cp a.exr b.exr
    poke b.exr 4 "$bytes"
    refused b.exr
  done
}

@test "a compression that nobody knows" {
  spectral a.exr
  poke a.exr "$(attribute_at a.exr compression compression)" '\xc8'
  refused a.exr
}

@test "DWA compression, which this OpenEXRCore cannot read" {
  spectral lines.exr --half
  for compression in dwaa dwab; do
    exrmaketiled -z $compression lines.exr a.exr
    refused a.exr
    [[ $stderr = *DWA* ]] || complain "$stderr"
  done
}

@test "a type of sample that nobody knows" {
  spectral a.exr
  # behind the name of 15 bytes and its zero
  poke a.exr $(($(attribute_at a.exr channels chlist) + 16)) '\x03'
  refused a.exr
}

@test "a channel of fewer samples than the image" {
  spectral a.exr
  # behind the name, the type and the hint
  poke a.exr $(($(attribute_at a.exr channels chlist) + 16 + 8)) '\x02'
  refused a.exr
}

@test "tiles of no size, and of any" {
  spectral lines.exr
  exrmaketiled -t 8 4 lines.exr tiles.exr
  accepted=0
  for size in '\x00\x00\x00\x00' '\xff\xff\xff\xff' '\xff\xff\xff\x7f' '\x07\x00\x00\x00'; do
    for offset in 0 4; do
      cp tiles.exr a.exr
      poke a.exr $(($(attribute_at a.exr tiles tiledesc) + offset)) "$size"
      survived a.exr
    done
  done
}

@test "tiles of several levels: the finest is read" {
  spectral lines.exr --size 37x21 --pattern noise
  for levels in -m -r; do
    exrmaketiled $levels -t 8 4 lines.exr tiles.exr
    specdiff lines.exr tiles.exr
    specdiff lines.exr - < <(cat tiles.exr)
  done
}

@test "a part that is not there" {
  spectral one.exr
  spectral two.exr --channel Y
  exrmultipart -combine -i one.exr two.exr -o a.exr >/dev/null
  for part in 2 -1 missing '' 1x 99999999999999999999; do
    refused a.exr --part "$part"
    [[ $stderr = *part* ]] || complain "$stderr"
  done
  # specdiff's --part is for those of its files that have several
  for tool in spec2rgb specconvert; do
    fails_cleanly $tool --part 1 one.exr -o out.exr
  done
}

@test "control characters in a name stay out of messages" {
  spectral a.exr --channel $'S0.0nm\n' --channel $'S0.\e[31m0nm' --channel S0.0nm
  refused a.exr
  spectral b.exr --extra $'two\nlines\e[31m'
  spectral c.exr
  run specdiff b.exr c.exr
  [ "$status" -eq 1 ]
  [ "${#lines[@]}" -eq 1 ] || [[ ${lines[1]} = rmse* ]] || complain "$output"
  run ! grep -q $'\e' <<<"$output"
}

# Chunks

@test "a chunk table of zeros" {
  spectral a.exr --compression none
  table=$(table_at a.exr 8 $((16 * 16 * 4)))
  poke a.exr "$table" '\x00%.0s' # the first entry's low byte, for a table that is merely wrong
  accepted=0
  survived a.exr
  for ((i = 0; i < 64; i++)); do poke a.exr $((table + i)) '\x00'; done
  refused_or_same a.exr
}

# refused_or_same FILE: the image that spectral makes, or a clean refusal; never other pixels.
refused_or_same() {
  local code
  [ -e same.exr ] || spectral same.exr
  for input in "$1" -; do
    code=0
    timeout 30 specconvert "$input" -o out.exr < <([ "$input" != - ] || cat "$1") 2>err || code=$?
    if [ "$code" -eq 0 ]; then
      specdiff same.exr out.exr || return 1
      rm out.exr
    else
      [ "$code" -eq 2 ] || complain "exit $code" || return 1
      [ "$(wc -l <err)" -eq 1 ] || complain "$(cat err)" || return 1
      [ ! -e out.exr ] || complain 'a file was left' || return 1
    fi
  done
}

@test "chunk offsets past the end, before the beginning, and into the header" {
  spectral good.exr --compression none
  table=$(table_at good.exr 8 $((16 * 16 * 4)))
  for offset in 1000000 9223372036854775807 -1 -9223372036854775808 0 8 "$table"; do
    cp good.exr a.exr
    poke a.exr $((table + 3 * 8)) "$(little 8 "$offset")"
    refused_or_same a.exr
  done
}

@test "a chunk table that has one chunk for all lines" {
  spectral a.exr --compression none
  table=$(table_at a.exr 8 $((16 * 16 * 4)))
  for ((y = 1; y < 8; y++)); do
    poke a.exr $((table + 8 * y)) "$(little 8 $((table + 64)))"
  done
  refused_or_same a.exr
}

@test "a chunk of another line, or of another size" {
  spectral good.exr --compression none
  table=$(table_at good.exr 8 $((16 * 16 * 4)))
  for word in 4 -1 99 $largest; do
    for offset in 0 4; do
      cp good.exr a.exr
      poke a.exr $((table + 64 + offset)) "$(little 4 "$word")"
      refused_or_same a.exr
    done
  done
}

@test "the table of ZIP with zeros, and past the end" {
  spectral none.exr --size 16x35 --compression none
  spectral good.exr --size 16x35
  spectral same.exr --size 16x35
  table=$(table_at none.exr 35 $((16 * 16 * 4)))
  for offset in 0 1000000 -1 "$table"; do
    cp good.exr a.exr
    poke a.exr $((table + 8)) "$(little 8 "$offset")"
    refused_or_same a.exr
  done
}

@test "a chunk of ZIP whose bytes were changed is never taken for good" {
  spectral none.exr --compression none
  spectral good.exr
  table=$(table_at none.exr 8 $((16 * 16 * 4)))
  size=$(wc -c <good.exr)
  for ((at = table + 16; at < size; at += 97)); do
    cp good.exr a.exr
    old=$(od -An -v -tu1 -j $at -N 1 good.exr)
    poke a.exr $at "$(little 1 $((old ^ 0x55)))"
    refused_or_same a.exr
  done
}

@test "changed bytes anywhere, in every compression, neither crash nor hang" {
  accepted=0
  for compression in none rle zips zip piz pxr24 b44; do
    spectral good.exr --size 9x19 --grid 500:520:20 --half --uint-id --compression $compression
    size=$(wc -c <good.exr)
    for ((at = 4; at < size; at += size / 16)); do
      cp good.exr a.exr
      poke a.exr $at '\xff'
      survived a.exr "$compression, byte $at"
    done
  done
}

@test "changed bytes anywhere in tiles neither crash nor hang" {
  spectral lines.exr --size 19x13 --grid 500:520:20 --half --uint-id
  exrmaketiled -t 8 4 -z piz lines.exr good.exr
  accepted=0
  size=$(wc -c <good.exr)
  for ((at = 4; at < size; at += size / 40)); do
    cp good.exr a.exr
    poke a.exr $at '\xfe'
    survived a.exr "byte $at"
  done
}

# Samples

@test "negative, infinite and undefined pixels are an image like any other" {
  spectral a.exr --pattern negative --pattern inf:1,1,1 --pattern nan:2,2,2
  for tool in 'spec2rgb -q' specconvert; do
    # shellcheck disable=SC2086 # words
    $tool a.exr -o out.exr 2>err
    [ ! -s err ]
  done
  specdiff a.exr a.exr
  specdiff a.exr out.exr
}

@test "samples that a text cannot hold are refused" {
  spectral a.exr --pattern nan:2,2,2
  fails_cleanly specconvert a.exr -o a.spd
  no_leftovers . a.exr
}

# Curves

@test "curves that are none" {
  printf '400 1\n500 \0 2\n' >zero.spd
  printf '400 1\n400 2\n' >level.spd
  printf '400 nan\n' >nan.spd
  printf '400\n' >lonely.spd
  : >empty.spd
  head -c 100000 /dev/zero | tr '\0' 1 >long.spd
  mkdir folder.spd
  for curve in zero level nan lonely empty long folder missing; do
    fails_cleanly specconvert $curve.spd -o out.exr
    [[ $stderr = *"$curve.spd"* ]] || complain "$stderr"
  done
  [ ! -e out.exr ]
}

@test "two namings are two grids, wherever their bands lie" {
  spectral a.exr --channel S0.500nm --channel S0.600nm --channel 400.00-410.00nm
  refused a.exr
  [[ $stderr = *'two grids in one file'* ]] || complain "$stderr"
}

@test "more attributes than the limit" {
  spectral a.exr --attribute one=1 --attribute two=2
  fails_cleanly specconvert --limit attributes=3 a.exr -o out.exr
  [[ $stderr = *'--limit attributes=N'* ]] || complain "$stderr"
  specconvert --limit attributes=100 a.exr -o out.exr
}

@test "a header up to its limit is read, whatever is read ahead" {
  spectral a.exr
  specconvert --limit header=4k a.exr -o out.exr
  specconvert --limit header=4k - -o out.exr < <(cat a.exr)
  fails_cleanly specconvert --limit header=300 a.exr -o out.exr
  [[ $stderr = *'--limit header=BYTES'* ]] || complain "$stderr"
}

@test "of several damaged places the first is told, for any number of threads" {
  spectral a.exr --size 64x256 --pattern grain --compression zip
  size=$(stat -c %s a.exr)
  # From the middle on every byte is zero.
  head -c $((size / 2)) a.exr >b.exr
  head -c $((size - size / 2)) /dev/zero >>b.exr
  specconvert -j1 b.exr -o out.exr 2>first || true
  for ((i = 0; i < 10; i++)); do
    specconvert -j4 b.exr -o out.exr 2>again || true
    cmp first again || complain "$(cat first again)"
  done
}
