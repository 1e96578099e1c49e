#!/usr/bin/env bats
# The gallery's runner and page: what fails must be seen. The rows here are thrown away; the
# real ones run in tests/check.
# shellcheck disable=SC2016,SC2030,SC2031 # scripts in quotes; each test is a subshell

load common
load ../figures/measure

setup() {
  in_own_folder
  mkdir -p build rows
  ln -s "$BIN" build/bin
}

# row NAME: a script from standard input. It has a title and a picture by itself.
row() {
  { printf '%s\n' "title 'row $1'" "picture dot.png 'specconvert D65 --patches 1x1 -f exr | spec2rgb -o dot.png' dot"
    cat; } >"rows/$1.sh"
}

# runs NAME: what the runner prints is in $output, its exit status in $status.
runs() {
  run "$ROOT/tests/figures/row" build "$1" rows
}

gallery() {
  "$ROOT/tests/figures/gallery" build rows
}

# has TEXT: a whole line of $output.
has() {
  grep -qxF -- "$1" <<<"$output" || complain "no line '$1' in:" "$output"
}

@test "a row whose checks hold passes, and leaves its pictures and its record" {
  row F1 <<<"check 'a sum' 4 within 4.1 0.2
    check 'no more' 1e-13 at-most 1e-12
    check 'no less' 3 at-least -1
    check 'a text' 'red green' equals 'red green'"
  runs F1
  [ "$status" = 0 ]
  has 'ok 1 a sum'
  has 'ok 4 a text'
  has '1..4'
  no_leftovers build/figures F1
  no_leftovers build/figures/F1 dot.png row.txt
  [ "$(grep -c '^held' build/figures/F1/row.txt)" = 4 ]
}

@test "a check that fails is told, and the others are made nevertheless" {
  row F1 <<<"check first 1 within 2 0.5
    check second 1 at-most 0.5
    check third 1 at-least 2
    check fourth red equals green
    check fifth 1 within 1 0"
  runs F1
  [ "$status" = 1 ]
  has 'not ok 1 first'
  has '# measured 1, wanted 2 ± 0.5'
  has 'not ok 2 second'
  has '# measured 1, wanted at most 0.5'
  has 'not ok 3 third'
  has 'not ok 4 fourth'
  has 'ok 5 fifth'
  has '1..5'
}

@test "what is no number, or nothing, holds no check" {
  local measured
  for measured in '' ' ' nan -nan inf none '1 2' 1,5 0x1 1e 5nm; do
    row F1 <<<"check a '$measured' within 0 1e9
      check b '$measured' at-most 1e9
      check c '$measured' at-least -1e9
      check d 0 within '$measured' 1e9"
    runs F1
    [ "$status" = 1 ]
    [ "$(grep -c '^not ok ' <<<"$output")" = 4 ] || complain "'$measured' held:" "$output"
  done
  row F1 <<<"check a '' equals ''"
  runs F1
  has 'not ok 1 a'
}

@test "a check without a limit, or with an unknown relation, fails" {
  row F1 <<<"check a 1 within 1
    check b 1 at-most
    check c 1 about 1"
  runs F1
  [ "$status" = 1 ]
  [ "$(grep -c '^not ok ' <<<"$output")" = 3 ]
  has '1..3'
}

@test "a command that fails ends the row, with what it said" {
  row F1 <<<"run 'specconvert nothing.exr -o copy.exr'
    check never 1 within 1 0"
  runs F1
  [ "$status" = 1 ]
  has 'not ok 1 specconvert nothing.exr -o copy.exr'
  has "# specconvert: unable to open 'nothing.exr': No such file or directory"
  has '1..1'
  grep -q "exit status 2: specconvert: unable to open" build/figures/F1/row.txt
}

@test "a command fails with the first of a pipe, and with the first of its lines" {
  row F1 <<<"run 'false | cat'"
  runs F1
  has 'not ok 1 false | cat'
  row F1 <<<"run 'false
true'"
  runs F1
  has 'not ok 1 false true'
}

@test "a script that ends early, or breaks a rule of bash, fails" {
  local line
  for line in 'exit 0' 'false' 'echo "$unknown"' 'grep nothing /dev/null >found' 'if'; do
    row F1 <<<"check before 1 within 1 0
      $line
      check after 1 within 1 0"
    runs F1
    [ "$status" = 1 ] || complain "passed: $line" "$output"
    grep -q "^not ok .* F1.sh runs to its end" <<<"$output" || complain "not told: $line" "$output"
  done
}

@test "a row without a title, a picture or a check fails" {
  echo ':' >rows/F1.sh
  runs F1
  [ "$status" = 1 ]
  has 'not ok 1 F1.sh has a title'
  has 'not ok 2 F1.sh makes a picture'
}

@test "a picture that is not made fails" {
  row F1 <<<"picture other.png true 'nothing'"
  runs F1
  has 'not ok 1 true'
  has "# measured no file 'other.png', wanted a picture 'other.png'"
}

@test "a row that failed is older than its script, one that passed is not" {
  row F1 <<<"check a 1 within 1 0"
  row F2 <<<"check a 1 within 2 0"
  runs F1
  runs F2
  [ ! build/figures/F1/row.txt -ot rows/F1.sh ]
  [ build/figures/F2/row.txt -ot rows/F2.sh ]
}

@test "the folder is new each time, and nothing of an older run is left" {
  row F1 <<<"run 'echo >old.txt'
    check a 1 within 1 0"
  runs F1
  row F1 <<<"check a 1 within 1 0"
  runs F1
  no_leftovers build/figures/F1 dot.png row.txt
}

@test "the gallery shows commands, what they print, pictures and checks, and counts" {
  row F1 <<<"from 'somebody 1888'
    note 'a note'
    run 'echo printed; echo more'
    check 'an error' 1e-13 at-most 1e-12
    check 'a value' 2 within 2 0.5"
  runs F1
  run gallery
  [ "$status" = 0 ]
  has '<h2 id="F1">F1 row F1</h2>'
  has '<p><cite>somebody 1888</cite></p>'
  has '<p>a note</p>'
  has '<b>$ echo printed; echo more</b>'
  has more
  has '<figcaption>dot</figcaption></figure>'
  has '<tr><td>an error</td><td>1e-13</td><td>at most 1e-12</td><td></td><td>holds</td></tr>'
  has '<tr><td>a value</td><td>2</td><td>2</td><td>0.5</td><td>holds</td></tr>'
  grep -q 'spectools [0-9].*; 2 of 2 checks hold' <<<"$output"
}

@test "the gallery shows what failed, and fails" {
  row F1 <<<"check good 1 within 1 0"
  row F2 <<<"check bad nan within 1 0"
  row F3 <<<"run 'exit 3'"
  row F4 <<<"check good 1 within 1 0"
  for name in F1 F2 F3; do
    runs "$name"
  done
  run --separate-stderr gallery
  [ "$status" = 1 ]
  has '<tr><td>bad</td><td>nan</td><td>1</td><td>0</td><td><strong>FAILED</strong></td></tr>'
  has '<li><a href="#F1">F1</a> row F1</li>'
  has '<li><a href="#F2">F2</a> row F2 <strong>1 FAILED</strong></li>'
  has '<li><a href="#F4">F4</a> not made <strong>1 FAILED</strong></li>'
  output=$stderr
  has 'FAILED F2: bad: nan, wanted 1'
  has 'FAILED F3: exit 3: exit status 3: , wanted exit status 0'
  has 'FAILED F4: the row is made: nothing, wanted row.txt'
  has 'gallery: 1 of 4 checks hold'
}

@test "the gallery escapes what HTML would take for its own" {
  row F1 <<<"from '<b>A & B</b>'
    picture '<dot>.png' 'cp dot.png \"<dot>.png\"' 'a \"dot\" & <more>'
    run 'echo \"<i>&amp;</i>\"'
    check '1 < 2' '<1>' equals '<1>'"
  runs F1
  [ "$status" = 0 ]
  run gallery
  has '<p><cite>&lt;b&gt;A &amp; B&lt;/b&gt;</cite></p>'
  has '<b>$ echo &quot;&lt;i&gt;&amp;amp;&lt;/i&gt;&quot;</b>'
  has '&lt;i&gt;&amp;amp;&lt;/i&gt;'
  grep -qF 'src="F1/&lt;dot&gt;.png" width="320" alt="a &quot;dot&quot; &amp; &lt;more&gt;">' <<<"$output"
  grep -qF '<td>1 &lt; 2</td><td>&lt;1&gt;</td>' <<<"$output"
}

@test "rows stand in the order C F D R A M, then by number" {
  for name in M1 A2 R3 D4 F10 F9 C2 C11 card; do
    row $name <<<':'
  done
  run gallery
  [ "$(sed -n 's/^<h2 id="\([^"]*\)".*/\1/p' <<<"$output" | xargs)" = 'card C2 C11 F9 F10 D4 R3 A2 M1' ]
}

@test "every row of the gallery is a name, and no two are the same but for case" {
  names=$(cd "$ROOT/tests/figures" && ls ./*.sh)
  [ -n "$names" ]
  run ! grep -vE '^\./([CFDRAM][1-9][0-9]*|[a-z]+)\.sh$' <<<"$names"
  [ -z "$(tr '[:upper:]' '[:lower:]' <<<"$names" | sort | uniq -d)" ]
}

@test "colours measured here are those that spec2rgb shows" {
  specconvert --patches 3x2 --grid 400:701:7 15-red 13-blue 14-green 16-yellow 19-white 24-black -o card.exr
  for light in D65 A F11; do
    for at in 0,0 1,0 2,0 0,1 1,1 2,1; do
      [ "$(codes card.exr $at $light)" = "$(rgb card.exr $at --illuminant $light -q)" ]
    done
  done
  spectral light.exr --size 2x1 --grid 380:780:10
  [ "$(codes light.exr 1,0 E)" = "$(rgb light.exr 1,0)" ]
}

@test "hue, chroma and lightness of patches, a pixel of a window as alone" {
  specconvert --patches 2x2 15-red 13-blue 14-green 19-white -o card.exr
  # CIELAB of a perfect grey: no chroma. The others lie in the sectors of their names.
  hues card.exr 0,0,2,2 D65 >colours
  awk 'NR == 1 && ($3 < 20 || $3 > 40) || NR == 2 && ($3 < 270 || $3 > 310) ||
    NR == 3 && ($3 < 120 || $3 > 160) || NR == 4 && ($4 > 5 || $5 < 94) { bad = 1 }
    END { exit bad || NR != 4 }' colours || complain "$(<colours)"
  [ "$(hue card.exr 0,1 D65)" = "$(sed -n '3s/^0 1 //p' colours)" ]
}

@test "values that are not there are told, and none is printed" {
  printf '%s\n' '# columns: wavelength_nm R T' '400 0.25 0.5' '500 0.5 0.25' >a.spd
  [ "$(column a.spd T | xargs)" = '0.5 0.25' ]
  [ "$(value a.spd 500 R)" = 0.5 ]
  run -1 --separate-stderr value a.spd 450 R
  [ -z "$output" ] && [ "$stderr" = 'a.spd: no R at 450 nm' ]
  run -1 --separate-stderr column a.spd A
  [ -z "$output" ] && [ "$stderr" = 'a.spd: no column A' ]
  [ "$(printf '%s\n' 1 -3 '2 0' | largest)" = 3 ]
  [ -z "$(printf '%s\n' 1 nan | largest)" ]
  [ -z "$(largest </dev/null)" ]
}

@test "characteristic matrices: published values, and no energy lost in clear layers" {
  # S. J. Byrnes, the tmm package, basic_test: from an independent program.
  got=$(for p in s p; do transfer $p 5.729577951308232 '1 0 | 2 4 2 | 3 0.3 3 | 1 0.1' <<<100; done)
  awk '{ print $2, $3 }' <<<"$got" | paste -d ' ' - - | awk '{
    print $1 - 0.37273208839139516, $2 - 0.22604491247079261, $3 - 0.37016110373044969, $4 - 0.22824374314132009
  }' | awk '{ for (i = 1; i <= 4; i++) if (!($i < 1e-14 && $i > -1e-14)) exit 1 } END { exit NR != 1 }'
  # Also where a layer is beyond its critical angle.
  transfer p 60 '1.52 0 | 2.4 0 100 | 1 0 400 | 1.52 0' <<<550 |
    awk '{ off = $2 + $3 - 1; exit !(off < 1e-14 && off > -1e-14 && $3 > 0 && $3 < 0.1) }'
}
