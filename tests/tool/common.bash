# What the bats files share. A file begins with: load common (or ../tool/common) and has
#   BIN    the folder of the tools, put first in PATH
#   TESTS  the folder of the helper programs
#   ROOT   the checkout
# Each test runs in an empty folder of its own, $BATS_TEST_TMPDIR.
# shellcheck shell=bash

bats_require_minimum_version 1.5.0

ROOT=${ROOT:-$(cd "${BASH_SOURCE[0]%/*}/../.." && pwd)}
BIN=${BIN:-$ROOT/build/bin}
TESTS=${TESTS:-$ROOT/build/tests}
PATH=$BIN:$PATH
export ROOT BIN TESTS PATH
unset SPECTRA_PATH

# A file that needs more says: setup() { in_own_folder; MORE; }
in_own_folder() {
  cd "$BATS_TEST_TMPDIR" || return 1
}

setup() {
  in_own_folder
}

# complain TEXT...: one line each, shown when the test fails.
complain() {
  printf '%s\n' "$@" >&2
  return 1
}

# fails_in_lines COUNT COMMAND...: exit status 2, so many lines on stderr, the first of which begins
# with the tool's name, and nothing on stdout. The lines are left in said.
fails_in_lines() {
  local count=$1 name=${2##*/} out=$BATS_FILE_TMPDIR/stdout err=$BATS_FILE_TMPDIR/stderr
  shift
  status=0 stderr=
  "$@" >"$out" 2>"$err" || status=$?
  mapfile said <"$err"
  stderr=${said[0]%$'\n'}
  [ "$status" -eq 2 ] || complain "exit $status instead of 2: $*" "${said[@]}" || return 1
  [ ! -s "$out" ] || complain "something on stdout: $*" || return 1
  [[ ${#said[@]} -eq $count && ${said[-1]} = *$'\n' ]] ||
    complain "not $count line(s) on stderr: $*" "${said[@]}" || return 1
  [[ $stderr = "$name: "?* ]] ||
    complain "stderr does not begin with '$name: ': $*" "$stderr" || return 1
}

# fails_cleanly COMMAND...: exit status 2, one line on stderr that begins with the tool's name,
# nothing on stdout. The line is left in $stderr. What goes in comes by <FILE.
fails_cleanly() {
  local said=()
  fails_in_lines 1 "$@"
}

# fails_pointing COLUMN COMMAND...: as fails_cleanly, and then two more lines: one of the arguments
# behind two blanks, and a caret under its byte COLUMN, counted from 1.
fails_pointing() {
  local column=$1 said=() argument shown=
  shift
  fails_in_lines 3 "$@" || return 1
  for argument; do
    [ "${said[1]}" != "  $argument"$'\n' ] || shown=1
  done
  [ -n "$shown" ] || complain "no argument is shown: $*" "${said[@]}" || return 1
  [ "${said[2]}" = "$(printf '  %*s^' $((column - 1)) '')"$'\n' ] ||
    complain "the caret is not in column $column: $*" "${said[@]}" || return 1
}

# shuns_terminal COMMAND: as the shell has it; it refuses to write its image to a terminal, of which
# nothing is shown.
shuns_terminal() {
  local code=0
  command -v script >/dev/null || skip 'no script(1) to make a terminal'
  script -qec "$1" typescript </dev/null >seen || code=$?
  [ "$code" -eq 2 ] || complain "exit $code instead of 2: $1" || return 1
  grep -q "^${1%% *}: refusing to write .* to a terminal; use -o FILE or a pipe" seen ||
    complain "$1:" "$(cat seen)" || return 1
  ! grep -q channels seen || complain "something of the image is shown: $1"
}

# no_leftovers FOLDER [FILE...]: there is nothing in it but these files, hidden ones included.
no_leftovers() {
  local folder=$1 found wanted
  shift
  found=$(cd "$folder" && find . -mindepth 1 -maxdepth 1 | sed 's,^\./,,' | sort)
  wanted=$(printf '%s\n' "$@" | sort)
  [ "$found" = "$wanted" ] || complain "in $folder:" "$found" "instead of:" "$wanted"
}

# samples: other programs' files are in $SAMPLES from here on; without them the test is skipped.
samples() {
  SAMPLES=$ROOT/../shared/samples
  [ -d "$SAMPLES" ] || skip 'no ../shared/samples beside the checkout'
}

# spectral FILE ARGUMENT...: makes a test image with tests/helper/synthesize.
spectral() {
  local file=$1
  shift
  "$TESTS/synthesize" "$@" -o "$file"
}

# layers ARGUMENT...: makes, or prints, an image of light layers with tests/helper/layers.
layers() {
  "$TESTS/layers" "$@"
}

# poke FILE OFFSET BYTES: puts bytes, written as printf has them, over those in a file.
poke() {
  # shellcheck disable=SC2059 # the format is what the caller means
  printf "$3" | dd of="$1" bs=1 seek="$2" conv=notrunc status=none
}

# little BYTES NUMBER: a whole number as printf's escapes, lowest byte first.
little() {
  local count=$1 number=$2 i
  for ((i = 0; i < count; i++)); do
    printf '\\x%02x' $((number >> 8 * i & 255))
  done
}

# attribute_at FILE NAME TYPE: where the value of an EXR attribute begins.
attribute_at() {
  local at
  at=$(LC_ALL=C grep -aboP "$2\\x00$3\\x00" "$1" | head -n 1 | tr -d '\0')
  [ -n "$at" ] || complain "$1 has no attribute '$2' of type '$3'" || return 1
  echo $((${at%%:*} + ${#2} + ${#3} + 6))
}

# table_at FILE LINES BYTES: where the chunk table of an uncompressed file of scanlines begins.
# BYTES: of a line. The header is as long where the same image is compressed.
table_at() {
  echo $(($(wc -c <"$1") - $2 * (16 + $3)))
}

# reverse_lines FROM TO LINES BYTES: the same uncompressed image with its last line first in the
# file, and a header that says so.
reverse_lines() {
  local from=$1 to=$2 lines=$3 chunk=$(($4 + 8)) table first y
  table=$(table_at "$from" "$lines" "$4")
  first=$((table + 8 * lines))
  {
    head -c "$table" "$from"
    for ((y = 0; y < lines; y++)); do
      # shellcheck disable=SC2059 # made of escapes
      printf "$(little 8 $((first + (lines - 1 - y) * chunk)))"
    done
    for ((y = lines - 1; y >= 0; y--)); do
      tail -c +$((first + y * chunk + 1)) "$from" | head -c "$chunk"
    done
  } >"$to"
  poke "$to" "$(attribute_at "$to" lineOrder lineOrder)" '\x01'
}

# channels FILE: the names of its channels, one a line.
channels() {
  exrheader "$1" | sed -nE 's/^    (.*), (16|32)-bit.*/\1/p'
}

# has_channels FILE NAME...: these and no others, in this order.
has_channels() {
  local found wanted
  found=$(channels "$1")
  shift
  wanted=$(printf '%s\n' "$@")
  [ "$found" = "$wanted" ] || complain "has:" "$found" "instead of:" "$wanted"
}

# has_line FILE LINE: exrheader prints that line.
has_line() {
  exrheader "$1" | grep -qxF -e "$2" || complain "no line '$2' in:" "$(exrheader "$1")"
}

# numbers FILE: an image's or a curve's numbers as text, without the header.
numbers() {
  specconvert --format spd "$1" | grep -v '^#'
}

# header_of FILE: all that exrheader prints but the file's name and the channels.
header_of() {
  exrheader "$1" | grep -vE '^file |^    .*, (16|32)-bit'
}

# sample_at FILE CHANNEL X WIDTH: where that sample begins in an uncompressed image of one line whose
# samples all have 4 bytes.
sample_at() {
  local names number
  names=$(channels "$1")
  number=$(grep -nxF -e "$2" <<<"$names") || complain "$1 has no channel '$2'" || return 1
  echo $(($(wc -c <"$1") - 4 * $4 * ($(wc -l <<<"$names") - ${number%%:*} + 1) + 4 * $3))
}

# rename_channels FROM TO IN OUT: other names of the same length, in the same order; FROM as sed
# has it, from the beginning of a name on. Of an uncompressed file.
rename_channels() {
  LC_ALL=C sed "s/\\x00$1/\\x00$2/g" "$3" >"$4"
}

# What pixel_holds, and awk in other places, knows.
#   wrong(TEXT)
#   near(NUMBER, WANT, TOLERANCE)     within this share of what is wanted, and no NaN, which to some
#                                     awks is as small as any number
#   is(CHANNEL, WANT[, TOLERANCE])    to has this value, within 1e-6 of it or what is given
#   wavelength(CHANNEL)               in nm, of a band
statements='
  function wrong(text) { print text; failed = 1 }
  function size(a) { return a < 0 ? -a : a }
  function near(a, want, tolerance) {
    return a !~ /nan/ && size(a - want) <= tolerance * size(want) + 1e-12
  }
  function is(name, want, tolerance) {
    if (!(name in to)) wrong("no channel " name)
    else if (!near(to[name], want, tolerance ? tolerance : 1e-6))
      wrong(sprintf("%s is %.9g instead of %.9g", name, to[name], want))
  }
  function wavelength(name) {
    gsub(/.*S0[.]|.*T[.]|nm/, "", name)
    sub(/,/, ".", name)
    return name + 0
  }
  BEGIN { pi = atan2(0, -1) }
'

# pixel_holds IN OUT X,Y AWK: the statements hold for that pixel of two images, from[CHANNEL] and
# to[CHANNEL] being its values. What a file has in $functions can be called too.
pixel_holds() {
  local said
  said=$(awk "$statements${functions-}"'
    FNR == 1 { file++ }
    file == 1 { from[$1] = $2 }
    file == 2 { to[$1] = $2 }
    END {
      if (file != 2) wrong("a file has no such pixel")
      '"$4"'
      exit failed
    }' <("$TESTS/layers" --print "$3" "$1") <("$TESTS/layers" --print "$3" "$2") 2>&1) ||
    complain "$2, pixel $3:" "$said"
}
