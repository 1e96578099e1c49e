#!/usr/bin/env bats
# specrender: every option does what it says, scenes that are wrong are told where, and the same
# scene is the same picture. What pictures show is tests/pipe/square.bats and tests/unit/render.c.
# shellcheck disable=SC2154 # fails_cleanly leaves its line in stderr

load common

# scene FILE LINE...: of 6 x 4 pixels and 2 samples, and what LINE... says.
scene() {
  printf '%s\n' 'Camera "perspective" "float fov" 40' \
    'Film "rgb" "integer xresolution" 6 "integer yresolution" 4' \
    'Sampler "independent" "integer pixelsamples" 2' "${@:2}" >"$1"
}

sky='LightSource "infinite" "spectrum L" [ 300 .5 900 2 ]'
lamp='LightSource "point" "float I" 3 "point3 from" [ .2 .1 0 ]'
sun='LightSource "distant" "float L" 2 "point3 from" [ 0 0 -1 ] "point3 to" [ 0 .1 0 ]'
table='AttributeBegin Material "diffuse" "float reflectance" .5 Shape "disk" "float height" 3 "float radius" .9 AttributeEnd'
film='AttributeBegin Material "thinfilm" "string stack" "air | 1.33 400nm | air" Translate -.3 0 2.5 Shape "sphere" "float radius" .3 AttributeEnd'
disc='AttributeBegin Material "diffractive" "string preset" "cd" Translate .4 0 2.5 Rotate 180 1 0 0 Shape "disk" "float radius" .3 "float innerradius" .1 AttributeEnd'

# some FILE: a scene with something of everything.
some() {
  scene "$1" WorldBegin "$sky" "$lamp" "$sun" "$table" "$film" "$disc"
}

render() {
  specrender --no-history --grid 400:700:100 "$@"
}

bands='S0.400,000000nm S0.500,000000nm S0.600,000000nm S0.700,000000nm'
geometry='I.X I.Y I.Z N.X N.Y N.Z Ns.X Ns.Y Ns.Z P.X P.Y P.Z Q.X Q.Y Q.Z Tan.X Tan.Y Tan.Z cosine cover id u v'

# ordered PREFIX NAME...: with the prefix, as a header has them.
ordered() {
  printf "$1%s\n" "${@:2}"
}

# has_just FILE NAME...: these channels, in the header's order.
has_just() {
  local wanted
  mapfile -t wanted < <(printf '%s\n' "${@:2}" | LC_ALL=C sort)
  has_channels "$1" "${wanted[@]}"
}

# same_channels A B AWK: those of A that the AWK regular expression matches are in B with the same
# bits, in all pixels of 6 x 4.
same_channels() {
  local x y
  for y in 0 1 2 3; do
    for x in 0 1 2 3 4 5; do
      pixel_holds "$1" "$2" $x,$y 'for (name in from) if (name ~ /'"$3"'/) {
        count++; if (!(name in to) || to[name] != from[name]) wrong(name ": " from[name] " and " to[name])
      } if (!count) wrong("no channel")'
    done
  done
}

# The command line

@test "--help, --version and options that are not there" {
  [[ $(specrender --help) = 'usage: specrender [OPTION]... [SCENE.pbrt]'* ]]
  [[ $(specrender -V) =~ ^specrender\ \(spectools\)\ [0-9.]+$ ]]
  fails_cleanly specrender --sup 3
  fails_cleanly specrender --super-sample 3
  [[ $stderr = *"did you mean '--supersample'?" ]] || complain "$stderr"
  fails_cleanly specrender -x
  for option in grid spp size crop defer films supersample extrapolate seed output threads compression; do
    fails_cleanly specrender --$option
    [[ $stderr = *"option '--$option' needs an argument"* ]] || complain "$stderr"
  done
  fails_cleanly specrender --gbuffer=yes
  no_leftovers .
}

@test "one scene at a time" {
  some a.pbrt
  fails_cleanly specrender a.pbrt a.pbrt -o b.exr
  [[ $stderr = *'one scene at a time'* ]] || complain "$stderr"
  no_leftovers . a.pbrt
}

@test "values that are none are refused" {
  some a.pbrt
  for option in --spp=0 --spp=x --spp=1.5 --spp=-1 --spp=16777217 --size=0x4 --size=4 --size=4x --size=1048577x1 \
    --size=-4x4 --crop=1,1,1,2 --crop=0,0,7,4 --crop=0,0,6 --crop=x --crop=-1,0,3,3 --crop=3,3,2,4 --defer= --defer=x \
    --defer=film,film --defer=films --defer=film,,disc --supersample=0 --supersample=65 --supersample=x --seed=-1 --seed=x \
    --seed=1.5 --grid=600:500:1 --grid=500 --grid=0:5:1 --threads=0 --compression=dwaa --limit=x=1 --extrapolate=zero --extrapolate=; do
    fails_cleanly specrender "$option" a.pbrt -o b.exr
  done
  fails_cleanly specrender --size 1048577x1 a.pbrt -o b.exr
  [[ $stderr = *'outside 1..1048576'* ]] || complain "$stderr"
  for films in 0 17 x; do
    fails_cleanly specrender --defer film --films $films a.pbrt -o b.exr
  done
  no_leftovers . a.pbrt
}

@test "--films needs --defer film" {
  some a.pbrt
  for defer in '' --defer=disc; do
    # shellcheck disable=SC2086 # or nothing
    fails_cleanly specrender --films 1 $defer a.pbrt -o b.exr
    [[ $stderr = *'--films needs --defer film' ]] || complain "$stderr"
  done
  render --films 1 --defer film,disc a.pbrt -o b.exr
}

# What comes in

@test "a file, standard input, '-' and a process substitution are read alike" {
  some a.pbrt
  render a.pbrt -o file.exr
  render <a.pbrt -o redirected.exr
  render - < <(cat a.pbrt) -o dash.exr
  render <(cat a.pbrt) -o substituted.exr
  for other in redirected dash substituted; do
    cmp file.exr $other.exr
  done
}

@test "files that a scene names are beside it, or for standard input in the working folder" {
  mkdir sub
  printf '400 1\n700 2\n' >sub/a.spd
  specconvert --patches 2x1 sub/a.spd sub/a.spd -o sub/sky.exr
  echo 'Shape "sphere" "float radius" 9' >sub/more.pbrt
  scene sub/a.pbrt WorldBegin 'LightSource "infinite" "string filename" "sky.exr"' 'AreaLightSource "diffuse" "spectrum L" "./a.spd"' \
    'Material "diffuse" "float reflectance" 0' ReverseOrientation 'Include "more.pbrt"'
  render sub/a.pbrt -o a.exr
  pixel_holds a.exr a.exr 3,2 'is("S0.500,000000nm", 4 / 3); is("S0.600,000000nm", 5 / 3)'
  (cd sub && render <a.pbrt) >b.exr
  cmp a.exr b.exr
  for suffix in spd txt csv; do
    cp sub/a.spd sub/lamp.$suffix
    scene sub/lamp.pbrt WorldBegin 'LightSource "infinite" "spectrum L" "lamp.'$suffix'"'
    render sub/lamp.pbrt -o lamp.exr
    pixel_holds lamp.exr lamp.exr 3,2 'is("S0.500,000000nm", 4 / 3)'
  done
  fails_cleanly specrender <sub/a.pbrt -o c.exr
  [[ $stderr = 'specrender: <stdin>:5:'*"there is no file 'sky.exr'" ]] || complain "$stderr"
}

@test "what is no scene is refused, and the file there was stays" {
  some a.pbrt
  : >empty.pbrt
  echo 'not a scene' >text.pbrt
  mkdir folder
  echo old >out.exr
  for file in empty.pbrt text.pbrt folder missing.pbrt; do
    fails_cleanly specrender $file -o out.exr
    [[ $stderr = *$file* ]] || complain "$stderr"
  done
  fails_cleanly specrender -o out.exr </dev/null
  fails_cleanly specrender -o out.exr < <(head -c 300 a.pbrt)
  [[ $stderr = 'specrender: <stdin>:'*:*:' '* ]] || complain "$stderr"
  [ "$(cat out.exr)" = old ]
  no_leftovers . a.pbrt empty.pbrt text.pbrt folder out.exr
}

# wrong_at LINE:COLUMN TEXT LINE...: a scene of those lines is refused, with a message about that place.
wrong_at() {
  printf '%s\n' "${@:3}" >a.pbrt
  fails_cleanly specrender a.pbrt -o out.exr
  [[ $stderr = "specrender: a.pbrt:$1: "*"$2"* ]] || complain "$stderr" "instead of a.pbrt:$1: $2"
  [ ! -e out.exr ]
}

@test "what is wrong in a scene is told with file, line and column" {
  wrong_at 1:1 "there is no statement 'Wordl'" Wordl
  wrong_at 2:1 'the file ends before a WorldBegin' '# nothing'
  wrong_at 1:1 'Shape cannot stand before WorldBegin' 'Shape "sphere"' WorldBegin
  wrong_at 2:3 'Camera cannot stand behind WorldBegin' WorldBegin '  Camera "perspective"'
  wrong_at 2:1 'did you mean "diffuse"?' WorldBegin 'Material "difuse"'
  wrong_at 2:16 "'radius' of Shape \"sphere\" is not positive" WorldBegin 'Shape "sphere" "float radius" 0'
  wrong_at 2:31 "'x' stands where a number should be" WorldBegin 'Shape "sphere" "float radius" x'
  wrong_at 2:1 'needs its spectrum' WorldBegin 'LightSource "point"'
  wrong_at 3:1 'what begins here is never ended' WorldBegin '' 'AttributeBegin'
  wrong_at 2:9 "there is no file 'no.pbrt'" WorldBegin 'Include "no.pbrt"'
  wrong_at 2:24 "there is no file 'no.exr'" WorldBegin 'LightSource "infinite" "string filename" "no.exr"'
  wrong_at 1:12 "'xresolution' of Film \"rgb\" is outside" 'Film "rgb" "integer xresolution" 0'
  wrong_at 2:24 "'cdd'" WorldBegin 'Material "diffractive" "string preset" "cdd"'
}

@test "what cannot be rendered is told with file, line and column, too" {
  wrong_at 2:22 "'eta' covers 400..500 nm" WorldBegin 'Material "conductor" "spectrum eta" [ 400 1 500 2 ] "float k" 2' 'Shape "sphere"'
  wrong_at 3:1 'a second infinite light' WorldBegin "$sky" "$sky"
  wrong_at 2:1 'a rough dielectric' WorldBegin 'Material "dielectric" "float roughness" .3' 'Shape "sphere"'
  wrong_at 3:1 'a sphere that shines' WorldBegin 'Scale 1 2 1 AreaLightSource "diffuse" "float L" 1' 'Shape "sphere"'
}

@test "a picture of surroundings that is none is told with file, line and column" {
  spectral square.exr --size 4x4
  wrong_at 2:1 'twice as wide as high' WorldBegin 'LightSource "infinite" "string filename" "square.exr"'
  spectral wide.exr --size 4x2
  wrong_at 2:13 'a picture of surroundings cannot be stretched' WorldBegin 'Scale 1 2 1 LightSource "infinite" "string filename" "wide.exr"'
  spectral paint.exr --size 4x2 --kind T
  wrong_at 2:1 'surroundings need bands of light (S0)' WorldBegin 'LightSource "infinite" "string filename" "paint.exr"'
  spectral dark.exr --size 4x2 --pattern negative
  wrong_at 2:1 'is negative or not finite' WorldBegin 'LightSource "infinite" "string filename" "dark.exr"'
  echo 'no picture, but longer than a magic number' >text.exr
  wrong_at 2:1 text.exr WorldBegin 'LightSource "infinite" "string filename" "text.exr"'
}

@test "a part of the picture of surroundings is chosen by number" {
  spectral a.exr --size 4x2 --pattern constant:1
  spectral b.exr --size 4x2 --pattern constant:3
  exrmultipart -combine -i a.exr b.exr -o both.exr >/dev/null
  scene a.pbrt WorldBegin 'LightSource "infinite" "string filename" "both.exr"'
  render --part 1 a.pbrt -o c.exr
  pixel_holds c.exr c.exr 3,2 'is("S0.500,000000nm", 3)'
  fails_cleanly specrender a.pbrt -o d.exr
  [[ $stderr = *--part* ]] || complain "$stderr"
}

@test "a stack that is wrong is shown with a caret" {
  printf '%s\n' WorldBegin 'Material "thinfilm" "string stack" "air | 1.33 5mn | air"' 'Shape "sphere"' >a.pbrt
  fails_in_lines 3 specrender a.pbrt -o out.exr
  [[ $stderr = 'specrender: a.pbrt:2:21: '* ]] || complain "$stderr"
  [ "${said[1]}" = $'  air | 1.33 5mn | air\n' ] && [ "${said[2]}" = "$(printf '%13s^' '')"$'\n' ] || complain "${said[@]}"
  no_leftovers . a.pbrt
}

@test "what is wrong in an included file is told with that file's name" {
  mkdir sub
  printf '\n\n   Shape "spere"\n' >sub/more.pbrt
  scene a.pbrt WorldBegin 'Include "sub/more.pbrt"'
  fails_cleanly specrender a.pbrt -o out.exr
  [[ $stderr = 'specrender: sub/more.pbrt:3:4: '*'did you mean "sphere"?' ]] || complain "$stderr"
}

@test "what makes no difference is a warning with its place, and none with -q" {
  scene a.pbrt 'PixelFilter "gaussian"' 'Integrator "volpath"' WorldBegin "$sky"
  render a.pbrt -o b.exr 2>said
  [ "$(wc -l <said)" -eq 2 ]
  grep -q '^specrender: warning: a.pbrt:4:1: PixelFilter "gaussian" ' said || complain "$(cat said)"
  grep -q '^specrender: warning: a.pbrt:5:1: Integrator "volpath" ' said || complain "$(cat said)"
  render -q a.pbrt -o c.exr 2>said
  [ ! -s said ]
  cmp b.exr c.exr
}

# What comes out

@test "an image of S0 in bins, of radiance per nm" {
  some a.pbrt
  specrender --grid 400:700:100 a.pbrt -o b.exr
  # shellcheck disable=SC2086 # words
  has_channels b.exr $bands
  has_line b.exr 'spec:bins (type string): "350 450 550 650 750"'
  has_line b.exr 'spec:quantity (type string): "radiance per nm"'
  has_line b.exr 'emissiveUnits (type string): "W.m^-2.sr^-1"'
  has_line b.exr 'spectralLayoutVersion (type string): "1.0"'
  has_line b.exr 'dataWindow (type box2i): (0 0) - (5 3)'
  has_line b.exr 'displayWindow (type box2i): (0 0) - (5 3)'
  has_line b.exr 'compression (type compression): zip, multi-scanline blocks'
  [ "$(exrheader b.exr | grep -c '^    S0.*32-bit floating-point')" -eq 4 ]
}

@test "spec:history has a line for it, and --no-history none" {
  some a.pbrt
  specrender --grid 500:500:1 --seed 5 a.pbrt -o b.exr
  version=$(specrender --version | sed 's/.* //')
  exrheader b.exr | grep -qF "\"specrender --grid 500:500:1 --seed 5 a.pbrt -o b.exr  # spectools $version" ||
    complain "$(exrheader b.exr)"
  specrender --no-history --grid 500:500:1 a.pbrt -o b.exr
  run ! grep history <<<"$(exrheader b.exr)"
}

@test "--grid sets the bands, which are means over bins; the usual ones are 81" {
  some a.pbrt
  specrender --spp 1 a.pbrt -o b.exr
  [ "$(channels b.exr | sed -n '1p;2p;$p' | xargs)" = 'S0.380,000000nm S0.385,000000nm S0.780,000000nm' ]
  [ "$(channels b.exr | wc -l)" -eq 81 ]
  has_line b.exr "spec:bins (type string): \"$(seq -s ' ' 377.5 5 782.5)\""
  specrender --spp 1 --grid 550:550:1 a.pbrt -o c.exr
  has_channels c.exr S0.550,000000nm
  has_line c.exr 'spec:bins (type string): "549.5 550.5"'
  # (l - 500)^2 has means that differ from the values in the middle by the step squared, over 12
  awk 'BEGIN { for (l = 300; l <= 800; l++) print l, (l - 500) ^ 2 }' >curve.spd
  scene d.pbrt WorldBegin 'LightSource "infinite" "spectrum L" "./curve.spd"'
  render d.pbrt -o e.exr
  pixel_holds e.exr e.exr 3,2 'is("S0.500,000000nm", 1e4 / 12, 1e-3); is("S0.700,000000nm", 4e4 + 1e4 / 12, 1e-3)'
  fails_cleanly specrender --grid 500:500.000001:0.0000001 d.pbrt -o f.exr
}

@test "a band is the same beside few others and beside many" {
  scene a.pbrt WorldBegin "$sky" "$lamp" "$table"
  specrender --grid 400:700:20 a.pbrt | specconvert --band 500 --band 520 --band 540 --no-history -o b.exr
  specrender --grid 500:540:20 a.pbrt -o c.exr
  # of two lights one is chosen by the mean of all bands
  scene a.pbrt WorldBegin 'LightSource "infinite" "float L" 2' "$table"
  specrender --grid 400:700:20 a.pbrt | specconvert --band 500 --band 520 --band 540 -o b.exr
  specrender --grid 500:540:20 a.pbrt -o c.exr
  specdiff b.exr c.exr
}

@test "--extrapolate constant: reflectances and indices outside their data are those of the nearer end" {
  scene a.pbrt WorldBegin 'LightSource "infinite" "float L" 1' 'Translate 0 0 2' \
    'Material "conductor" "spectrum eta" [ 500 .5 600 .7 ] "spectrum k" [ 500 3 600 4 ]' 'Shape "disk" "float radius" 9'
  sed 's/500 .5 600 .7/300 .5 500 .5 600 .7 800 .7/; s/500 3 600 4/300 3 500 3 600 4 800 4/' a.pbrt >b.pbrt
  for option in '' '--extrapolate refuse'; do
    # shellcheck disable=SC2086 # words
    fails_cleanly specrender $option --grid 400:700:100 a.pbrt -o c.exr
    [[ $stderr = "specrender: a.pbrt:7:22: 'eta' covers 500..600 nm"* ]] || complain "$stderr"
  done
  render --extrapolate constant a.pbrt -o c.exr
  render b.pbrt -o d.exr
  cmp c.exr d.exr
  scene a.pbrt WorldBegin 'LightSource "infinite" "float L" 1' 'Material "diffuse" "spectrum reflectance" [ 500 .5 600 .7 ]' "Translate 0 0 9" 'Shape "disk"'
  fails_cleanly specrender --grid 400:700:100 a.pbrt -o c.exr
  [[ $stderr = *" covers 500..600 nm"* ]] || complain "$stderr"
  render --extrapolate constant a.pbrt -o c.exr
}

@test "light is 0 outside its data" {
  scene a.pbrt WorldBegin 'LightSource "infinite" "spectrum L" [ 500 1 600 1 ]'
  specrender --grid 400:700:100 a.pbrt -o b.exr
  pixel_holds b.exr b.exr 3,2 '
    is("S0.400,000000nm", 0); is("S0.500,000000nm", 0.5); is("S0.600,000000nm", 0.5); is("S0.700,000000nm", 0)'
  # A picture's bands are not bins that reach farther.
  spectral sky.exr --size 4x2 --grid 500:600:100 --pattern constant:1
  scene c.pbrt WorldBegin 'LightSource "infinite" "string filename" "sky.exr"'
  specrender --grid 400:700:100 c.pbrt -o d.exr
  pixel_holds d.exr d.exr 3,2 '
    is("S0.400,000000nm", 0); is("S0.500,000000nm", 1); is("S0.600,000000nm", 1); is("S0.700,000000nm", 0)'
}

@test "--spp, --size and --seed are the scene's, unless they are given" {
  some a.pbrt
  render a.pbrt -o want.exr
  render --spp 2 --size 6x4 --seed 0 a.pbrt -o b.exr
  cmp want.exr b.exr
  printf '%s\n' 'Film "rgb" "integer xresolution" 3 "integer yresolution" 9' \
    'Sampler "independent" "integer pixelsamples" 5 "integer seed" 7' >c.pbrt
  sed '/Film\|Sampler/d' a.pbrt >>c.pbrt
  render --spp 2 --size 6x4 --seed 0 c.pbrt -o d.exr
  cmp want.exr d.exr
  render c.pbrt -o e.exr
  render --spp 5 --size 3x9 --seed 7 a.pbrt -o f.exr
  cmp e.exr f.exr
  sed '/Sampler/d' a.pbrt >g.pbrt
  render g.pbrt -o h.exr
  render --spp 16 a.pbrt -o i.exr
  cmp h.exr i.exr
  has_line b.exr 'spec:samples (type int): 2'
  has_line h.exr 'spec:samples (type int): 16'
}

@test "a path has five scatterings, unless the scene says how many" {
  scene a.pbrt WorldBegin 'AreaLightSource "diffuse" "float L" 1' 'Material "diffuse" "float reflectance" 1' \
    ReverseOrientation 'Shape "sphere" "float radius" 9'
  render a.pbrt -o usual.exr
  for depth in 4 5 6; do
    sed "s/^WorldBegin/Integrator \"path\" \"integer maxdepth\" $depth WorldBegin/" a.pbrt >b.pbrt
    render b.pbrt -o $depth.exr
  done
  cmp usual.exr 5.exr
  run ! cmp usual.exr 4.exr
  run ! cmp usual.exr 6.exr
}

@test "from the fifth scattering on a path may end by chance, not before" {
  # The ray goes to and fro through the middle; each time a fifth is mirrored: (0 + k^2) / (4 + k^2).
  scene a.pbrt 'Integrator "path" "integer maxdepth" 4' WorldBegin 'AreaLightSource "diffuse" "float L" 1' \
    'Material "conductor" "float eta" 1 "float k" 1' 'ReverseOrientation Shape "sphere" "float radius" 9'
  render a.pbrt -o b.exr
  numbers b.exr | awk '{ for (i = 2; i <= NF; i++) { n++; off = $i - 1.2496; if (off * off > 1e-12) exit 1 } } END { exit n != 4 * 24 }'
  sed 's/maxdepth" 4/maxdepth" 9/' a.pbrt >c.pbrt
  render c.pbrt -o d.exr
  [ "$(numbers d.exr | sed -n 1p | cut -d ' ' -f 2- | tr ' ' '\n' | sort -u | wc -l)" -gt 1 ]
}

@test "--seed chooses other random numbers, and the same ones again" {
  some a.pbrt
  render a.pbrt -o b.exr
  render --seed 1 a.pbrt -o c.exr
  render --seed 1 a.pbrt -o d.exr
  render --seed 4611686018427387904 a.pbrt -o e.exr
  cmp c.exr d.exr
  for pair in 'b c' 'b e' 'c e'; do
    # shellcheck disable=SC2086 # two
    set -- $pair
    [ "$(paste -d '\n' <(numbers "$1.exr") <(numbers "$2.exr") | sort -u | wc -l)" -eq 8 ] || complain "$pair"
  done
}

@test "--crop is the crop of the whole, bit for bit, and so are its layers" {
  some a.pbrt
  for options in '' '--gbuffer' '--defer film,disc' '--defer film --supersample 2' '--half --size 9x7'; do
    factor=$([[ $options = *supersample* ]] && echo 2 || echo 1)
    # shellcheck disable=SC2086 # words
    render $options a.pbrt -o whole.exr
    for crop in 1,1,5,3 0,0,1,1 5,3,6,4 0,0,6,4; do
      IFS=, read -r x0 y0 x1 y1 <<<$crop
      # shellcheck disable=SC2086 # words
      render $options --crop $crop a.pbrt -o b.exr
      specconvert --no-history --crop $((x0 * factor)),$((y0 * factor)),$((x1 * factor)),$((y1 * factor)) whole.exr -o c.exr
      cmp b.exr c.exr || complain "$options --crop $crop"
    done
  done
}

@test "every number of threads writes the same bytes" {
  some a.pbrt
  for options in '' '--defer film,disc --gbuffer'; do
    # shellcheck disable=SC2086 # words
    {
      render -j 1 $options --size 41x37 a.pbrt -o 1.exr
      render -j 3 $options --size 41x37 a.pbrt -o 3.exr
      cmp 1.exr 3.exr
      render -j 1 $options --size 41x37 a.pbrt | cat >1.exr
      render -j 3 $options --size 41x37 a.pbrt | cat >3.exr
      cmp 1.exr 3.exr
      render -j 3 $options --compression none --size 41x37 a.pbrt -o 1.exr
      cmp 1.exr 3.exr
    }
  done
}

@test "every lossless compression gives the same pixels" {
  some a.pbrt
  render --defer film,disc a.pbrt -o want.exr
  for compression in none rle zips zip piz; do
    render --defer film,disc --compression $compression a.pbrt -o b.exr
    specdiff want.exr b.exr
  done
  has_line b.exr 'compression (type compression): piz'
}

@test "--half stores the light as HALF, and what is too large is told" {
  some a.pbrt
  render a.pbrt -o float.exr
  render --half a.pbrt -o half.exr
  specconvert --no-history --half float.exr -o want.exr
  cmp half.exr want.exr
  render --half --defer film,disc a.pbrt -o half.exr
  run ! grep -E '^    (.*\.)?S0\..*32-bit' <<<"$(exrheader half.exr)"
  run ! grep -E '^    .*(D\.X|P\.X|cosine|cover|id), 16-bit' <<<"$(exrheader half.exr)"
  scene b.pbrt WorldBegin 'LightSource "infinite" "float L" 1e6'
  specrender --half --grid 500:510:10 b.pbrt -o c.exr 2>said
  [ "$(cat said)" = 'specrender: warning: c.exr: 48 samples are too large for 16 bits and became infinite' ] ||
    complain "$(cat said)"
  specrender -q --half --grid 500:510:10 b.pbrt -o c.exr 2>said
  [ ! -s said ]
}

# --gbuffer

@test "--gbuffer adds the geometry of what is seen first, and changes no light" {
  some a.pbrt
  render a.pbrt -o b.exr
  render --gbuffer a.pbrt -o c.exr
  # shellcheck disable=SC2086 # words
  has_just c.exr $bands $geometry
  same_channels b.exr c.exr '^S0'
  exrheader c.exr | grep -q '^    id, 32-bit unsigned integer'
}

@test "--gbuffer of a sphere, by hand" {
  scene a.pbrt WorldBegin 'Translate .1 .2 3' 'Material "diffuse" "integer id" 9' 'Shape "sphere" "float radius" 1'
  render --spp 1 --gbuffer --size 12x12 a.pbrt -o b.exr
  for pixel in 5,5 3,6 8,3; do
    pixel_holds b.exr b.exr $pixel '
      x = to["P.X"] - 0.1; y = to["P.Y"] - 0.2; z = to["P.Z"] - 3
      if (!near(sqrt(x ^ 2 + y ^ 2 + z ^ 2), 1, 1e-6) || z > 0) wrong("not on the near side")
      eye = sqrt(to["P.X"] ^ 2 + to["P.Y"] ^ 2 + to["P.Z"] ^ 2)
      # within the pixel: x to the right, y upwards, 40 degrees high
      if (int(6 + 6 * to["P.X"] / to["P.Z"] / 0.363970234) != '${pixel%,*}') wrong("column")
      if (int(6 - 6 * to["P.Y"] / to["P.Z"] / 0.363970234) != '${pixel#*,}') wrong("line")
      is("N.X", x, 1e-5); is("N.Y", y, 1e-5); is("N.Z", z, 1e-5)
      is("Ns.X", to["N.X"]); is("Ns.Y", to["N.Y"]); is("Ns.Z", to["N.Z"])
      is("I.X", -to["P.X"] / eye); is("I.Y", -to["P.Y"] / eye); is("I.Z", -to["P.Z"] / eye)
      is("cosine", to["N.X"] * to["I.X"] + to["N.Y"] * to["I.Y"] + to["N.Z"] * to["I.Z"])
      r = sqrt(x ^ 2 + y ^ 2)
      is("Tan.X", -y / r, 1e-5); is("Tan.Y", x / r, 1e-5); is("Tan.Z", 0)
      is("Q.X", (x + 1) / 2, 1e-5); is("Q.Y", (y + 1) / 2, 1e-5); is("Q.Z", (z + 1) / 2, 1e-5)
      azimuth = atan2(y, x); if (azimuth < 0) azimuth += 2 * pi
      is("u", azimuth / (2 * pi), 1e-5); is("v", 1 - atan2(r, z) / pi, 1e-5)
      is("cover", 1); is("id", 9)'
  done
  pixel_holds b.exr b.exr 0,0 'for (name in to) if (name !~ /^S0/ && to[name] != 0) wrong(name)'
}

@test "a triangle without uv has (0,0), (1,0) and (1,1) at its corners, and its tangent along the first edge" {
  scene a.pbrt WorldBegin 'Shape "trianglemesh" "point3 P" [ -2 -2 2  2 -2 2  2 2 2 ]'
  render --spp 1 --gbuffer a.pbrt -o b.exr
  for pixel in 3,3 5,2 4,3; do
    pixel_holds b.exr b.exr $pixel 'is("cover", 1); is("u", (to["P.X"] + 2) / 4, 1e-5); is("v", (to["P.Y"] + 2) / 4, 1e-5)
      is("Tan.X", 1); is("Tan.Y", 0); is("Tan.Z", 0)'
  done
}

@test "--gbuffer at a silhouette: cover is the share of the samples, the rest their mean" {
  scene a.pbrt WorldBegin 'Translate 0 0 2' 'Shape "trianglemesh" "point3 P" [ -9 -9 0  0 -9 0  0 9 0  -9 9 0 ] "integer indices" [ 0 1 2 0 2 3 ]'
  render --spp 4096 --size 3x3 --gbuffer a.pbrt -o b.exr
  pixel_holds b.exr b.exr 0,1 'is("cover", 1)'
  pixel_holds b.exr b.exr 2,1 'is("cover", 0)'
  # the left half of the middle pixel, whose side is 2/3 of tan(20 degrees) at a distance of 1
  pixel_holds b.exr b.exr 1,1 'is("cover", 0.5, 0.01); is("P.X", -2 * 0.363970234 / 6, 0.01); is("P.Z", 2); is("N.X", 0); is("N.Y", 0)
    if (size(to["N.Z"]) != 1) wrong("N.Z")'
}

# --defer

@test "--defer film adds two films and what passes, --films N so many" {
  some a.pbrt
  for films in 1 2 3; do
    render --defer film --films $films a.pbrt -o b.exr
    # shellcheck disable=SC2046,SC2086 # words
    has_just b.exr $bands $(ordered through. $bands) $(for ((i = 1; i <= films; i++)); do
      ordered film$i. $geometry; ordered film$i.mirror. $bands; done)
    [ $films != 2 ] || cp b.exr two.exr
  done
  render --defer film a.pbrt -o b.exr
  cmp b.exr two.exr
}

@test "--defer disc adds its geometry and the lamps, but no lights that are none" {
  some a.pbrt
  render --defer disc a.pbrt -o b.exr
  # shellcheck disable=SC2046,SC2086 # words
  has_just b.exr $bands $geometry lamp{1,2}.D.{X,Y,Z} $(ordered lamp1. $bands) $(ordered lamp2. $bands)
  render --defer film,disc a.pbrt -o b.exr
  render --defer disc,film a.pbrt -o c.exr
  cmp b.exr c.exr
  # shellcheck disable=SC2046,SC2086 # words
  has_just b.exr $bands $geometry lamp{1,2}.D.{X,Y,Z} $(ordered lamp1. $bands) $(ordered lamp2. $bands) \
    $(ordered through. $bands) $(for i in 1 2; do ordered film$i. $geometry; ordered film$i.mirror. $bands; done)
}

@test "what sees neither film nor disc is the same with --defer and without" {
  scene a.pbrt WorldBegin "$sky" "$lamp" "$table"
  render --spp 4 a.pbrt -o b.exr
  render --spp 4 --defer film,disc a.pbrt -o c.exr
  same_channels b.exr c.exr '^S0'
  for pixel in 0,0 3,2; do
    pixel_holds c.exr c.exr $pixel 'for (name in to) if (name !~ /^S0/ && to[name] != 0) wrong(name)'
  done
  specfilm --no-history --stack 'air | 1.5' c.exr | specdisc --no-history -o d.exr
  same_channels b.exr d.exr '^S0'
}

@test "a film that shines is rendered, but not deferred" {
  scene a.pbrt WorldBegin 'Material "thinfilm" "string stack" "air | 1.5 9nm | air"' 'Translate 0 0 2' \
    'AreaLightSource "diffuse" "float L" 3' 'Shape "sphere" "float radius" .5'
  render --defer disc a.pbrt -o b.exr
  pixel_holds b.exr b.exr 3,2 'is("S0.500,000000nm", 3)'
  fails_cleanly specrender --defer film a.pbrt -o c.exr
  [[ $stderr = 'specrender: a.pbrt:8:1: '* ]] || complain "$stderr"
}

@test "the object coordinates of a mesh are those of its bounding box, before it is turned" {
  scene a.pbrt WorldBegin 'Translate 0 0 3' 'Rotate 30 1 2 3' 'Scale .5 .25 1' 'Material "thinfilm" "string stack" "air | 1.5 9nm | air"' \
    'Shape "trianglemesh" "point3 P" [ -3 -4 1  5 -4 1  5 4 1  -3 4 1 ] "integer indices" [ 0 1 2 0 2 3 ] "point2 uv" [ 0 0 1 0 1 1 0 1 ]'
  sed 's/Shape.*/Shape "disk" "float radius" 4 "float height" 1/' a.pbrt >c.pbrt
  render --spp 1 --gbuffer a.pbrt -o b.exr
  render --spp 1 --defer film a.pbrt -o d.exr
  render --spp 1 --gbuffer c.pbrt -o e.exr
  for pixel in 2,1 3,2; do
    pixel_holds b.exr b.exr $pixel 'is("cover", 1); is("Q.X", to["u"]); is("Q.Y", to["v"]); is("Q.Z", 0)'
    pixel_holds b.exr d.exr $pixel 'is("film1.Q.X", from["Q.X"]); is("film1.Q.Y", from["Q.Y"])'
    # a disk in the same plane, from -4 to 4
    pixel_holds e.exr b.exr $pixel 'is("Q.X", (8 * from["Q.X"] - 4 + 3) / 8, 1e-5); is("Q.Y", from["Q.Y"], 1e-5)'
  done
}

@test "a film's id, cover and cosine, and those of its back" {
  scene a.pbrt WorldBegin "$sky" 'Translate 0 0 3' 'Material "thinfilm" "integer id" 4000000 "string stack" "air | 1.5 9nm | air"' \
    'Shape "sphere" "float radius" 2'
  render --spp 1 --defer film --films 3 a.pbrt -o b.exr
  pixel_holds b.exr b.exr 3,2 '
    for (film = 1; film <= 2; film++) { is("film" film ".id", 4000000); is("film" film ".cover", 1) }
    if (!(to["film1.cosine"] > 0.9 && to["film2.cosine"] < -0.9)) wrong("cosines")
    if (!(to["film1.P.Z"] < 1.1 && to["film2.P.Z"] > 4.9)) wrong("places")
    is("film3.cover", 0); is("film3.id", 0)
    for (name in to) if (name ~ /^S0/) is(name, 0)
    is("through.S0.500,000000nm", 1)'
}

@test "behind a film on a metal there is nothing, neither another film nor the sky" {
  scene a.pbrt WorldBegin "$sky" 'Translate 0 0 3 Material "thinfilm" "string stack" "air | 1.5 200nm | 0.5+3i"' \
    'ReverseOrientation Shape "disk" "float radius" 4' 'Translate 0 0 1 Shape "disk" "float radius" 4'
  render --spp 1 --defer film a.pbrt -o b.exr
  pixel_holds b.exr b.exr 3,2 '
    is("film1.cover", 1); is("film2.cover", 0); is("film1.mirror.S0.600,000000nm", 1.25)
    for (name in to) if (name ~ /^(through|film2)/ && to[name] != 0) wrong(name)'
}

# --supersample

@test "--supersample N has windows N times as large, and --downsample N brings them back" {
  some a.pbrt
  render --spp 1 --supersample 3 --crop 1,0,5,3 a.pbrt -o b.exr
  has_line b.exr 'dataWindow (type box2i): (3 0) - (14 8)'
  has_line b.exr 'displayWindow (type box2i): (0 0) - (17 11)'
  specconvert --no-history --downsample 3 b.exr -o c.exr
  render --spp 9 --crop 1,0,5,3 a.pbrt -o d.exr # as many samples in a pixel
  [ "$(header_of c.exr)" = "$(header_of d.exr)" ] || complain "$(diff <(header_of c.exr) <(header_of d.exr))"
  render --spp 9 --supersample 1 --crop 1,0,5,3 a.pbrt -o e.exr
  cmp d.exr e.exr
  render --supersample 2 a.pbrt -o f.exr
  render --size 12x8 a.pbrt -o g.exr
  cmp f.exr g.exr
}

@test "--supersample sees what an ordinary picture sees, closer" {
  scene a.pbrt WorldBegin 'Translate 0 0 2' 'Shape "trianglemesh" "point3 P" [ -9 -9 0  0 -9 0  0 9 0  -9 9 0 ] "integer indices" [ 0 1 2 0 2 3 ]'
  render --size 3x3 --supersample 4 --gbuffer a.pbrt | specconvert --downsample 4 -o b.exr
  pixel_holds b.exr b.exr 1,1 'is("cover", 0.5)'
  pixel_holds b.exr b.exr 0,1 'is("cover", 1)'
  pixel_holds b.exr b.exr 2,1 'is("cover", 0)'
}

# Files, pipes and terminals

@test "a full device fails, and leaves nothing" {
  some a.pbrt
  mkdir tmp
  export TMPDIR=$PWD/tmp
  fails_cleanly specrender a.pbrt -o /dev/full
  for compression in none zip; do
    code=0
    specrender --compression $compression a.pbrt >/dev/full 2>err || code=$?
    [ "$code" -eq 2 ] && [ "$(wc -l <err)" -eq 1 ] || complain "exit $code" "$(cat err)"
  done
  fails_cleanly specrender a.pbrt -o missing/b.exr
  no_leftovers tmp
  no_leftovers . a.pbrt err tmp
}

@test "no image is written to a terminal" {
  some a.pbrt
  shuns_terminal 'specrender a.pbrt'
}

@test "--progress shows lines on standard error, and -q none" {
  some a.pbrt
  render a.pbrt -o want.exr 2>said
  [ ! -s said ]
  render --progress a.pbrt -o b.exr 2>said
  grep -q '100% .* lines/s' said || complain "$(cat said)"
  cmp want.exr b.exr
  render -q --progress a.pbrt -o b.exr 2>said
  [ ! -s said ]
}

@test "a pipe into spec2rgb makes the picture of a file" {
  some a.pbrt
  specrender --grid 400:700:20 a.pbrt -o b.exr
  spec2rgb -q b.exr -o files.png
  specrender --grid 400:700:20 a.pbrt | spec2rgb -q >pipes.png
  cmp files.png pipes.png
  specrender --grid 400:700:20 --defer film,disc a.pbrt | specfilm --stack 'air | 1.33 400nm | air' | specdisc | spec2rgb -q >more.png
  [ -s more.png ]
}

@test "a reader that leaves ends it silently, with SIGPIPE" {
  some a.pbrt
  { env --default-signal=PIPE specrender --spp 1 --size 64x64 a.pbrt 2>err || echo $? >code; } | head -c 100 >/dev/null
  [ "$(cat code)" -eq 141 ]
  [ ! -s err ] || complain "$(cat err)"
}

@test "closed standard streams are trouble" {
  some a.pbrt
  code=0
  specrender a.pbrt >&- 2>err || code=$?
  specrender -o out.exr <&- 2>>err || code=$code$?
  [ "$code" = 22 ] && [ "$(wc -l <err)" -eq 2 ] || complain "$code" "$(cat err)"
  no_leftovers . a.pbrt err
}

@test "limits on the picture of an infinite light, and on memory, are refused by name" {
  spectral sky.exr --size 4x2 --pattern constant:1
  scene a.pbrt WorldBegin 'LightSource "infinite" "string filename" "sky.exr"' "$table"
  render a.pbrt -o b.exr
  for limit in pixels=7 channels=3 attributes=1 header=50 memory=1k; do
    fails_cleanly specrender --limit $limit a.pbrt -o c.exr
    [[ $stderr = *"--limit ${limit%=*}="* ]] || complain "$limit: $stderr"
  done
  # Two bands of the file, but 81 of the picture: 64 x 32 x 81 x 4 bytes.
  spectral large.exr --size 64x32 --grid 380:780:400
  scene c.pbrt WorldBegin 'LightSource "infinite" "string filename" "large.exr"'
  fails_cleanly specrender -j 1 --limit memory=500k c.pbrt -o c.exr
  [[ $stderr = *'64 x 32 pixels of 81 bands take more than the limit of 512000 bytes (--limit memory='* ]] || complain "$stderr"
  no_leftovers . a.pbrt b.exr c.pbrt large.exr sky.exr
}

@test "a picture of which one line is larger than the limit is refused before memory is taken" {
  scene a.pbrt WorldBegin
  fails_cleanly specrender --limit memory=10M --size 100000x1 a.pbrt -o b.exr # 81 bands: 32 MB
  [[ $stderr = *'more than the limit of 10485760 (--limit memory='* ]] || complain "$stderr"
  fails_cleanly specrender --grid 1:2000:1 --size 1048576x1 a.pbrt -o b.exr
  [[ $stderr = *'more than the limit of 4294967296 (--limit memory='* ]] || complain "$stderr"
  no_leftovers . a.pbrt
}

# Odd scenes

@test "a scene without light is black, and one without shapes shows its surroundings" {
  scene a.pbrt WorldBegin "$table" "$film" "$disc"
  render a.pbrt -o b.exr
  [ "$(numbers b.exr | cut -d ' ' -f 2- | tr ' ' '\n' | sort -u)" = 0 ]
  scene a.pbrt WorldBegin 'LightSource "infinite" "float L" 2.5'
  render --defer film,disc --gbuffer a.pbrt -o b.exr
  [ "$(numbers b.exr | cut -d ' ' -f 2- | tr ' ' '\n' | sort -u)" = 2.5 ]
  scene a.pbrt WorldBegin
  render a.pbrt -o b.exr
  [ "$(numbers b.exr | cut -d ' ' -f 2- | tr ' ' '\n' | sort -u)" = 0 ]
}

@test "the smallest picture" {
  some a.pbrt
  render --size 1x1 --spp 1 --defer film,disc --gbuffer a.pbrt -o b.exr
  has_line b.exr 'dataWindow (type box2i): (0 0) - (0 0)'
}

# ---- spectra in other representations ----

@test "the lines of a light bring their energy into the bands that hold them" {
  scene a.pbrt WorldBegin 'LightSource "infinite" "compositespectrumsampled L" [ 2 300 800 1 1 404.66 30 546.07 50 650 8 ]'
  render -o a.exr a.pbrt
  numbers a.exr | awk '
    function wants(value) { for (i = 2; i <= NF; i++) if ($i < value - 1e-6 || $i > value + 1e-6) exit 1; rows++ }
    $1 == 400 { wants(1.3) } $1 == 500 { wants(1.5) } $1 == 600 { wants(1) } $1 == 700 { wants(1.08) }
    END { exit rows != 4 }'
  specrender --no-history --grid 540:550:1 -o b.exr a.pbrt
  numbers b.exr | awk '
    { if ($2 < ($1 == 546 ? 51 : 1) - 1e-5 || $2 > ($1 == 546 ? 51 : 1) + 1e-5) exit 1; rows++ }
    END { exit rows != 11 }'
}

@test "a light by formula is one wherever a light's spectrum is named" {
  local look='LookAt 0 0 0  0 0 1  0 1 0' wall='Shape "disk" "float height" 1'
  for light in daylight:6504K blackbody:3000K daylight:25000K; do
    specconvert $light -f spd -o lamp.spd
    for name in $light lamp.spd; do
      scene infinite.pbrt WorldBegin 'LightSource "infinite" "spectrum L" "'"$name"'"'
      scene area.pbrt "$look" WorldBegin 'AreaLightSource "diffuse" "bool twosided" true "spectrum L" "'"$name"'"' "$wall"
      scene point.pbrt "$look" WorldBegin 'LightSource "point" "spectrum I" "'"$name"'"' "$wall"
      scene distant.pbrt "$look" WorldBegin 'LightSource "distant" "spectrum L" "'"$name"'"' "$wall"
      for place in infinite area point distant; do
        render $place.pbrt | specconvert -f spd - -o "$place.${name%%:*}"
      done
    done
    for place in infinite area point distant; do
      awk 'FNR == 1 { file++ } /^#/ { next } file == 1 { lamp[$1] = $2 }
        file == 2 { if ($2 <= 0 || $2 < lamp[$1] * (1 - 1e-5) || $2 > lamp[$1] * (1 + 1e-5)) exit 1; rows++ }
        END { exit rows != 4 }' $place.lamp.spd $place.${light%%:*} || complain "$light in $place:" "$(cat $place.*)"
    done
  done
  scene a.pbrt WorldBegin 'LightSource "infinite" "spectrum L" "daylight:3000K"'
  fails_cleanly specrender a.pbrt
  [[ $stderr == *'a.pbrt:5:24: '*'3000'* ]] || complain "$stderr"
  for material in '"diffuse" "spectrum reflectance"' '"dielectric" "spectrum eta"'; do
    scene a.pbrt WorldBegin "Material $material"' "blackbody:3000K"' 'Shape "sphere"'
    fails_cleanly specrender a.pbrt
    [[ $stderr == *"a.pbrt:5:"*", which 'blackbody:3000K' is not" ]] || complain "$stderr"
  done
}

@test "a Fourier spectrum that falls below 0 is clamped, with a warning" {
  scene a.pbrt WorldBegin 'LightSource "infinite" "fourierspectrum L" [ 300 800 1 1 0 ]'
  run --separate-stderr specrender --grid 400:600:50 -o a.exr a.pbrt
  [ "$status" = 0 ]
  [[ $stderr == *"a.pbrt:5:24: 'L' of "*'is light and -0.5 at 550 nm; it is clamped'* ]]
  numbers a.exr | awk '{ if ($2 < 0 || ($1 >= 500 && $2 != 0) || ($1 == 400 && $2 < .7)) exit 1; rows++ } END { exit rows != 5 }'
}

@test "a light named by a file keeps the file's lines and its series" {
  printf '%s\n' '# representation: fourier' '# range: 300 800' '0 2 0' 'line 546.07 50' >lamp.spd
  scene a.pbrt WorldBegin 'LightSource "infinite" "spectrum L" "lamp.spd"'
  specrender --no-history --grid 545:547:.1 -o a.exr a.pbrt
  numbers a.exr | awk '
    { wanted = $1 > 546.05 && $1 < 546.15 ? 501 : 1; if ($2 < wanted - 1e-3 || $2 > wanted + 1e-3) exit 1; rows++ }
    END { exit rows != 21 }'
  sed -i s/50/-50/ lamp.spd
  fails_cleanly specrender --grid 400:700:100 a.pbrt
  [[ $stderr == *"a.pbrt:5:24: 'L' of "*'has a line of negative weight: -50 at 546.07 nm'* ]] || complain "$stderr"
  # Where a ratio is wanted, a line has no meaning but in the samples of a curve.
  printf '%s\n' '# quantity: reflectance' '# representation: fourier' '# range: 300 800' '0 1 0' >wall.spd
  scene b.pbrt WorldBegin "$lamp" 'Material "diffuse" "spectrum reflectance" "wall.spd"' 'Shape "disk" "float height" 3'
  render -o b.exr b.pbrt
}
