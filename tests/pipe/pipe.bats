#!/usr/bin/env bats
# What the tools do between each other: streams, spools, early ends and closed pipes.
# shellcheck disable=SC2154 # fails_cleanly leaves its line in stderr
# shellcheck disable=SC2030,SC2031 # each test is a subshell, and its variables its own

load ../tool/common

# large FILE: an image whose pixels fit no pipe, which holds 1 MiB at most.
large() {
  spectral "$1" --size 256x200 --compression none --pattern noise
}

# compression FILE: as exrheader has it.
compression() {
  exrheader "$1" | sed -n 's/^compression (type compression): //p'
}

# on_a_broken_pipe COMMAND...: with a reader that leaves after 100 bytes; $code and err are left.
on_a_broken_pipe() {
  rm -f code
  { env --default-signal=PIPE "$@" 2>err || echo $? >code; } | head -c 100 >/dev/null
  code=$(cat code)
}

# The same as through files

@test "a chain of three tools makes the same picture as files" {
  large a.exr
  specconvert --grid 405:695:10 a.exr -o b.exr
  specconvert --scale 2 --crop 3,5,250,190 b.exr -o c.exr
  spec2rgb c.exr -o files.png
  specconvert --grid 405:695:10 a.exr | specconvert --scale 2 --crop 3,5,250,190 | spec2rgb >pipes.png
  cmp files.png pipes.png
}

@test "a pipe carries the bytes of -o FILE --compression none" {
  spectral a.exr --size 61x67 --data -3,-5 --display -9,-9,70,80 --pattern grain --uint-id --extra Z
  specconvert --no-history a.exr | cat >pipe.exr
  specconvert --no-history --compression none a.exr -o file.exr
  cmp pipe.exr file.exr
}

@test "a pipe carries HALF as a file holds it" {
  spectral a.exr --size 61x67 --half --pattern grain --uint-id
  specconvert --no-history a.exr | cat >pipe.exr
  specconvert --no-history --compression none a.exr -o file.exr
  cmp pipe.exr file.exr
}

@test "each compression on a pipe is the file of that compression" {
  spectral a.exr --size 61x67 --pattern grain
  for compression in rle zips zip piz pxr24 b44 b44a; do
    specconvert --no-history --compression $compression a.exr | cat >pipe.exr
    specconvert --no-history --compression $compression a.exr -o file.exr
    cmp pipe.exr file.exr
  done
}

@test "each lossless compression is read from a pipe" {
  spectral a.exr --size 61x67 --pattern grain
  for compression in none rle zips zip piz; do
    specconvert --compression $compression a.exr | specdiff --metric max a.exr -
  done
}

@test "an image of one line and one of one pixel pass" {
  for size in 1x1 300x1 1x300; do
    spectral a.exr --size $size
    specconvert a.exr | specconvert --compression zip | specdiff a.exr -
  done
}

@test "every number of threads puts the same bytes on a pipe" {
  spectral a.exr --size 61x67 --pattern grain
  for compression in none zip; do
    specconvert --no-history -j 1 --compression $compression --grid 405:695:10 a.exr | cat >one.exr
    for threads in 2 3; do
      specconvert --no-history -j $threads --compression $compression --grid 405:695:10 - < <(cat a.exr) |
        cat >more.exr
      cmp one.exr more.exr
    done
  done
}

# What standard output is

@test "'> FILE' gives ZIP" {
  spectral a.exr
  specconvert a.exr >b.exr
  [ "$(compression b.exr)" = 'zip, multi-scanline blocks' ]
  specdiff a.exr b.exr
}

@test "'>> FILE' gives NONE, behind what is there" {
  spectral a.exr
  : >b.exr
  specconvert a.exr >>b.exr
  [ "$(compression b.exr)" = none ]
  specdiff a.exr b.exr
  echo before >c
  specconvert a.exr >>c
  [ "$(head -n 1 c | tr -d '\0')" = before ]
  tail -c +8 c >c.exr
  specdiff a.exr c.exr
}

@test "a file that is written already is gone on with, as a stream" {
  spectral a.exr
  { echo before && specconvert a.exr; } >b
  tail -c +8 b >b.exr
  [ "$(compression b.exr)" = none ]
  specdiff a.exr b.exr
}

@test "standard input is read from where it stands" {
  spectral a.exr
  { echo before && cat a.exr; } >b
  { read -r line && specdiff - a.exr; } <b
  [ "$line" = before ]
}

@test "nothing is written to a terminal" {
  spectral a.exr
  for tool in specconvert spec2rgb; do
    shuns_terminal "$tool a.exr"
  done
}

# What cannot be read in order

@test "tiles are read from a pipe" {
  spectral a.exr --size 61x67 --pattern grain
  exrmaketiled -t 16 8 a.exr tiled.exr
  specdiff a.exr - < <(cat tiled.exr)
  specconvert - < <(cat tiled.exr) | specdiff a.exr -
}

@test "several parts are read from a pipe" {
  spectral a.exr --pattern grain
  spectral b.exr --channel R --channel G --channel B
  exrmultipart -combine -i b.exr a.exr -o both.exr >/dev/null
  specconvert - < <(cat both.exr) | specdiff a.exr -
}

@test "decreasing lines are read from a pipe" {
  spectral a.exr --compression none
  reverse_lines a.exr b.exr 8 $((16 * 16 * 4))
  specdiff a.exr - < <(cat b.exr)
}

@test "lines that are out of order without saying so are read from a file, and from a pipe or not at all" {
  spectral a.exr --compression none
  reverse_lines a.exr b.exr 8 $((16 * 16 * 4))
  poke b.exr "$(attribute_at b.exr lineOrder lineOrder)" '\x00'
  specdiff a.exr b.exr
  specdiff a.exr - < <(cat b.exr) || fails_cleanly specconvert - -o c.exr < <(cat b.exr)
}

@test "a spool leaves nothing behind" {
  spectral a.exr
  exrmaketiled -t 16 8 a.exr tiled.exr
  mkdir spool
  TMPDIR=$PWD/spool specdiff a.exr - < <(cat tiled.exr)
  TMPDIR=$PWD/spool specconvert --compression zip a.exr | specdiff a.exr -
  no_leftovers spool
}

@test "a folder for spools that is not there is told" {
  spectral a.exr
  exrmaketiled -t 16 8 a.exr tiled.exr
  export TMPDIR=$PWD/missing
  fails_cleanly specconvert - -o b.exr < <(cat tiled.exr)
  [[ $stderr = *"$TMPDIR"* ]]
  no_leftovers . a.exr tiled.exr
}

@test "a named pipe can be read and written" {
  # Opened twice, it would lose its writer now and then: hence the repetitions.
  spectral a.exr
  mkfifo in out
  for ((i = 0; i < 30; i++)); do
    cat a.exr >in 2>/dev/null &
    writer=$!
    code=0
    timeout 20 specconvert in -o b.exr || code=$?
    kill "$writer" 2>/dev/null || true
    wait "$writer" || true
    [ "$code" -eq 0 ] || complain "exit $code in round $i"
  done
  specdiff a.exr b.exr
  cat out >c.exr 3>&- &
  reader=$!
  timeout 20 specconvert a.exr -o out
  wait "$reader"
  [ "$(compression c.exr)" = none ]
  specdiff a.exr c.exr
}

# Early ends

@test "input that ends early: the line is named, and there is no output file" {
  large a.exr
  for tool in specconvert spec2rgb; do
    fails_cleanly $tool - -o out.exr < <(head -c 1000000 a.exr)
    [[ $stderr = "$tool: <stdin>: ends early, in line "[0-9]*' of 0..199' ]] || complain "$stderr"
    no_leftovers . a.exr
  done
}

@test "an upstream that is killed: no output file" {
  large a.exr
  for tool in specconvert spec2rgb; do
    fails_cleanly $tool - -o out.exr < <(head -c 1000000 a.exr; kill -KILL "$BASHPID")
    no_leftovers . a.exr
  done
}

@test "an upstream that fails before its first byte: no output file" {
  for tool in specconvert spec2rgb; do
    fails_cleanly $tool - -o out.exr < <(specconvert missing.exr 2>/dev/null)
    [[ $stderr = *'is empty' ]] || complain "$stderr"
    no_leftovers .
  done
}

@test "a tool downstream of a failed one fails too" {
  large a.exr
  head -c 1000000 a.exr >short.exr
  for compression in none zip; do
    for ((i = 0; i < 3; i++)); do echo >"err$i"; done
    run bash -c "set -o pipefail
      specconvert --compression $compression short.exr 2>err0 | specconvert 2>err1 | spec2rgb -o out.png 2>err2
      echo \"\${PIPESTATUS[*]}\""
    [ "$output" = '2 2 2' ] || complain "$output" "$(cat err0 err1 err2)"
    for ((i = 0; i < 3; i++)); do
      [ "$(wc -l <"err$i")" -eq 1 ] || complain "$(cat "err$i")"
    done
    [ ! -e out.png ]
  done
}

@test "specdiff of an input that ends early is trouble, not difference" {
  large a.exr
  fails_cleanly specdiff a.exr - < <(head -c 1000000 a.exr)
}

@test "more bytes than the image has are no trouble, from a file or a pipe" {
  spectral a.exr
  { cat a.exr && echo more; } >longer.exr
  specdiff a.exr longer.exr
  specdiff a.exr - < <(cat longer.exr)
}

# Closed pipes

@test "a reader that leaves ends the writer silently, with SIGPIPE" {
  large a.exr
  spectral b.exr --size 800x800 --grid 400:700:100 --pattern noise
  for command in 'specconvert a.exr' 'specconvert --compression zip a.exr' 'spec2rgb -q b.exr'; do
    # shellcheck disable=SC2086 # words
    on_a_broken_pipe $command
    [ "$code" -eq 141 ] || complain "exit $code instead of 141: $command"
    [ ! -s err ] || complain "$(cat err)"
  done
}

@test "a reader that leaves ends a whole chain silently" {
  # What is upstream of the tool that writes to the closed pipe may be through by then.
  large a.exr
  # shellcheck disable=SC2016 # the other bash expands it
  run --separate-stderr env --default-signal=PIPE bash -c \
    'specconvert a.exr | specconvert | specconvert | head -c 100 | wc -c; echo "${PIPESTATUS[*]}"'
  [ "${lines[0]}" = 100 ]
  [[ ${lines[1]} =~ ^(0|141)\ (0|141)\ 141\ 0\ 0$ ]] || complain "$output"
  [ -z "$stderr" ] || complain "$stderr"
}

@test "a closed standard output is trouble" {
  spectral a.exr
  for tool in specconvert spec2rgb 'specdiff a.exr'; do
    code=0
    # shellcheck disable=SC2086 # words
    $tool a.exr >&- 2>err || code=$?
    [ "$code" -eq 2 ] || complain "exit $code: $tool"
    [ "$(wc -l <err)" -eq 1 ]
  done
}

@test "a closed standard input is trouble" {
  for tool in specconvert spec2rgb; do
    code=0
    $tool -o out.exr <&- 2>err || code=$?
    [ "$code" -eq 2 ]
    [ "$(wc -l <err)" -eq 1 ]
    [ ! -e out.exr ]
  done
}

# Memory

@test "memory on a pipe does not grow with the height" {
  for height in 1000 4000; do
    spectral $height.exr --size 256x$height --grid 400:700:20 --compression none --pattern constant:1
    "$TESTS/peak" peak.$height specconvert -j 2 --scale 2 - < <(cat $height.exr) | cat >/dev/null
    rm $height.exr
  done
  read -r _ small code _ <peak.1000
  [ "$code" -eq 0 ]
  read -r _ tall code _ <peak.4000
  [ "$code" -eq 0 ]
  # 16 MB of pixels and 64 MB: within 10 % means that none of the difference was kept
  [ $((10 * tall)) -le $((11 * small)) ] || complain "$small KiB, at four times the height $tall KiB"
}

@test "a crop lets its upstream finish: no stage of the pipe is killed" {
  spectral a.exr --size 64x400
  specconvert a.exr | specconvert --crop 0,0,64,1 -o b.exr
  [ "${PIPESTATUS[*]}" = "0 0" ] || complain "${PIPESTATUS[*]}"
}

# Light layers

soap='air | 1.33 300nm | air'

# layers ARGUMENT...: an image of light layers, from 400 to 700 nm.
layers() {
  "$TESTS/layers" --grid 400:700:20 "$@"
}

@test "layers, their films and a picture of them are the same through pipes as through files" {
  layers --scene sphere --size 120x100 --samples 2 -o a.exr
  specfilm --stack "$soap" a.exr -o b.exr
  spec2rgb b.exr -o files.png
  layers --scene sphere --size 120x100 --samples 2 | specfilm --stack "$soap" | spec2rgb >pipes.png
  cmp files.png pipes.png
  layers --scene disc --size 120x100 -o a.exr
  specdisc --model orders a.exr -o b.exr
  spec2rgb b.exr -o files.png
  layers --scene disc --size 120x100 | specdisc --model orders | spec2rgb >pipes.png
  cmp files.png pipes.png
}

@test "films and discs on a pipe are the bytes of -o FILE --compression none" {
  layers --scene noise --films 2 --size 61x67 -o a.exr
  specfilm --no-history --stack "$soap" a.exr | cat >pipe.exr
  specfilm --no-history --stack "$soap" --compression none a.exr -o file.exr
  cmp pipe.exr file.exr
  layers --scene noise --lamps 2 --size 61x67 -o a.exr
  specdisc --no-history a.exr | cat >pipe.exr
  specdisc --no-history --compression none a.exr -o file.exr
  cmp pipe.exr file.exr
  specdisc --no-history --chart 'eye 0..80' --size 61x67 | cat >pipe.exr
  specdisc --no-history --chart 'eye 0..80' --size 61x67 --compression none -o file.exr
  cmp pipe.exr file.exr
}

@test "films and discs are compared from a pipe" {
  layers --scene disc --size 61x40 -o disc.exr
  specdisc disc.exr -o want.exr
  specdisc - < <(cat disc.exr) | specdiff want.exr -
  layers --scene pair --size 61x40 -o films.exr
  specfilm --stack "$soap" films.exr -o want.exr
  specfilm --stack "$soap" - < <(cat films.exr) | specdiff want.exr -
  code=0
  specfilm --stack 'air | 1.34 300nm | air' films.exr | specdiff want.exr - >/dev/null || code=$?
  [ "$code" -eq 1 ]
}

@test "layers that end early: the line is named, and there is no output file" {
  layers --size 256x200 --compression none -o a.exr
  fails_cleanly specfilm --stack "$soap" - -o out.exr < <(head -c 5000000 a.exr)
  [[ $stderr = 'specfilm: <stdin>: ends early, in line '[0-9]*' of 0..199' ]] || complain "$stderr"
  fails_cleanly specfilm --stack "$soap" - -o out.exr < <(head -c 5000000 a.exr; kill -KILL "$BASHPID")
  layers --scene disc --size 256x200 --compression none -o b.exr
  fails_cleanly specdisc - -o out.exr < <(head -c 5000000 b.exr)
  [[ $stderr = 'specdisc: <stdin>: ends early, in line '[0-9]*' of 0..199' ]] || complain "$stderr"
  no_leftovers . a.exr b.exr
}

@test "downstream of layers that end early all fail" {
  layers --size 256x200 --compression none -o a.exr
  head -c 5000000 a.exr >short.exr
  run bash -c "specfilm --stack '$soap' short.exr 2>err0 | specconvert 2>err1 | spec2rgb -o out.png 2>err2
    echo \"\${PIPESTATUS[*]}\""
  [ "$output" = '2 2 2' ] || complain "$output" "$(cat err0 err1 err2)"
  [ "$(cat err0 err1 err2 | wc -l)" -eq 3 ]
  [ ! -e out.png ]
}

@test "a reader that leaves ends specfilm and specdisc silently, with SIGPIPE" {
  layers --size 256x200 -o a.exr
  layers --scene disc --size 256x200 -o b.exr
  for command in "specfilm --stack '$soap' a.exr" 'specdisc b.exr' 'specdisc --chart "eye 0..80"' \
    "specfilm --stack '$soap' --chart 'angle 0..80'" 'specdisc --orders --track 0.1mm --grid 400:700:1'; do
    on_a_broken_pipe bash -c "exec $command"
    [ "$code" -eq 141 ] || complain "exit $code instead of 141: $command"
    [ ! -s err ] || complain "$(cat err)"
  done
}

@test "a closed standard input or output is trouble to specfilm and specdisc" {
  layers -o a.exr
  layers --scene disc -o b.exr
  code=0
  specfilm --stack "$soap" a.exr >&- 2>err || code=$?
  specdisc b.exr >&- 2>>err || code=$code$?
  specdisc --orders >&- 2>>err || code=$code$?
  specfilm --stack "$soap" --spectrum >&- 2>>err || code=$code$?
  specfilm --stack "$soap" -o out.exr <&- 2>>err || code=$code$?
  specdisc -o out.exr <&- 2>>err || code=$code$?
  [ "$code" = 222222 ] && [ "$(wc -l <err)" -eq 6 ] || complain "$code" "$(cat err)"
  [ ! -e out.exr ]
}

@test "memory of films on a pipe does not grow with the height" {
  for height in 1000 4000; do
    "$TESTS/layers" --size 128x$height --grid 400:700:20 --compression none -o $height.exr
    "$TESTS/peak" peak.$height specfilm -j 2 --stack "$soap" - < <(cat $height.exr) | cat >/dev/null
    rm $height.exr
  done
  read -r _ small code _ <peak.1000
  [ "$code" -eq 0 ]
  read -r _ tall code _ <peak.4000
  [ "$code" -eq 0 ]
  [ $((10 * tall)) -le $((11 * small)) ] || complain "$small KiB, at four times the height $tall KiB"
}
