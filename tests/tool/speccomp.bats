#!/usr/bin/env bats
# speccomp: every operation against values made on purpose, and everything else as it should be.
# shellcheck disable=SC2154 # fails_cleanly leaves its line in stderr

load common

# constant FILE VALUE ARGUMENT...
constant() {
  spectral "$1" --pattern "constant:$2" "${@:3}"
}

# combine ARGUMENT...: without a history.
combine() {
  speccomp --no-history "$@"
}

# same A B: specdiff finds no difference, in any channel.
same() {
  specdiff "$1" "$2" || return 1
}

# ramps: a.exr, the ramp of synthesize, and b.exr, minus that; c.exr, all 0.5.
ramps() {
  spectral a.exr
  spectral b.exr --pattern negative
  constant c.exr 0.5
}

# rendered FILE SAMPLES SEED ARGUMENT...: a small picture of light.pbrt, whose noise is its own.
rendered() {
  [ -f light.pbrt ] || cat >light.pbrt <<'END'
LookAt 0 0 -3  0 0 0  0 1 0
Camera "perspective" "float fov" 45
Film "rgb" "integer xresolution" 12 "integer yresolution" 8
WorldBegin
AttributeBegin
  AreaLightSource "diffuse" "spectrum L" "D65" "float scale" 0.1
  Translate 0 2 -4
  Shape "disk" "float radius" 2.5
AttributeEnd
AttributeBegin
  Material "thinfilm" "string stack" "air | 1.33 500nm | air"
  Shape "sphere" "float radius" 0.7
AttributeEnd
Material "diffuse" "spectrum reflectance" [ 400 0.5 700 0.7 ]
Translate 0 -1 1
Shape "sphere"
END
  specrender --grid 400:700:100 --spp "$2" --seed "$3" "${@:4}" light.pbrt -o "$1"
}

# The command line

@test "--help, --version and options that are not there" {
  [[ $(speccomp --help) = 'usage: speccomp [OPTION]... FILE...'* ]]
  [[ $(speccomp -V) =~ ^speccomp\ \(spectools\)\ [0-9.]+$ ]]
  fails_cleanly speccomp --merg
  [[ $stderr = *"did you mean '--merge'?" ]] || complain "$stderr"
  fails_cleanly speccomp -x
  for option in op expr mask weight kind output threads compression; do
    fails_cleanly speccomp --$option
    [[ $stderr = *"option '--$option' needs an argument"* ]] || complain "$stderr"
  done
  fails_cleanly speccomp --merge=yes
  no_leftovers .
}

@test "what is missing, or one too many, is told" {
  ramps
  fails_cleanly speccomp a.exr b.exr -o x.exr
  [[ $stderr = *'one of --op, --merge and --expr is needed (try --help)' ]] || complain "$stderr"
  fails_cleanly speccomp --op add -o x.exr
  [[ $stderr = *'images are needed'* ]] || complain "$stderr"
  for chosen in '--op add --merge' '--op add --op min' '--merge --expr a' '--expr a --expr a'; do
    # shellcheck disable=SC2086 # words
    fails_cleanly speccomp $chosen a.exr b.exr -o x.exr
    [[ $stderr = *'one of --op, --merge and --expr at a time' ]] || complain "$stderr"
  done
  fails_cleanly speccomp --op lerp a.exr b.exr -o x.exr
  fails_cleanly speccomp --op add --mask A a.exr b.exr -o x.exr
  fails_cleanly speccomp --op add --weight 1,2 a.exr b.exr -o x.exr
  fails_cleanly speccomp --op add --kind T a.exr b.exr -o x.exr
  fails_cleanly speccomp --op mean --weight 1,2,3 a.exr b.exr -o x.exr
  [[ $stderr = *'3 weights for 2 images' ]] || complain "$stderr"
  fails_cleanly speccomp --op divide a.exr b.exr c.exr -o x.exr
  [[ $stderr = *'divide takes 2 images at most, and 3 are given' ]] || complain "$stderr"
  fails_cleanly speccomp --op add a.exr -o x.exr
  fails_cleanly speccomp --op add - - -o x.exr <a.exr
  [[ $stderr = *'only one of the images can come from standard input' ]] || complain "$stderr"
  no_leftovers . a.exr b.exr c.exr
}

@test "values that are none are refused" {
  ramps
  for option in --op= --op=Add --op=merge --kind=S1 --kind= --weight= --weight=1 '--weight=1,' --weight=,1 --weight=0,1 \
    --weight=-1,1 --weight=1,x --weight=nan,1 --weight=0.9e-30,1 --weight=1,1.1e30 --threads=0 --compression=dwaa --limit=x=1; do
    fails_cleanly speccomp "$option" --op mean a.exr b.exr -o x.exr
  done
  no_leftovers . a.exr b.exr c.exr
}

@test "64 images go, 65 do not" {
  constant a.exr 0.5 --size 5x3 --grid 400:700:100
  constant want.exr 32 --size 5x3 --grid 400:700:100
  mapfile -t many < <(yes a.exr | head -n 64)
  combine --op add "${many[@]}" -o x.exr
  same want.exr x.exr
  combine --op over "${many[@]:0:2}" -o y.exr 2>err || true
  grep -q 'has no alpha (A)' err
  for last in image64 w image23; do
    combine --expr "$last * 64" "${many[@]}" -o x.exr
    same want.exr x.exr
  done
  fails_cleanly speccomp --op add "${many[@]}" a.exr -o x.exr
  [[ $stderr = *"64 images at most"* ]] || complain "$stderr"
}

# The operations

@test "--op add, subtract, min, max and mean of ramps and constants" {
  ramps
  constant zero.exr 0
  combine --op add a.exr b.exr -o x.exr
  same zero.exr x.exr
  combine --op add a.exr c.exr b.exr -o x.exr
  specdiff --tolerance max=1e-7 c.exr x.exr # (a + 0.5) - a in double precision, a being float
  combine --op subtract a.exr a.exr -o x.exr
  same zero.exr x.exr
  combine --op subtract zero.exr b.exr -o x.exr
  same a.exr x.exr
  combine --op min a.exr b.exr c.exr -o x.exr
  same b.exr x.exr
  combine --op max b.exr a.exr zero.exr -o x.exr
  same a.exr x.exr
  combine --op mean a.exr a.exr a.exr a.exr -o x.exr
  same a.exr x.exr
  combine --op mean --weight 1,3 zero.exr a.exr -o x.exr
  specconvert --scale 0.75 a.exr -o want.exr
  same want.exr x.exr
  combine --op mean --weight 1e-30,1e30 zero.exr a.exr -o x.exr
  same a.exr x.exr
}

@test "--op multiply and divide: light by reflectance, and a ratio" {
  spectral a.exr --bins --quantity 'radiance per band'
  spectral t.exr --kind T --pattern constant:0.5
  specconvert --scale 0.5 a.exr -o half.exr
  combine --op multiply a.exr t.exr -o x.exr
  same half.exr x.exr
  combine --op multiply t.exr a.exr -o x.exr
  same half.exr x.exr
  has_line x.exr 'emissiveUnits (type string): "W.m^-2.sr^-1"'
  combine --op divide x.exr t.exr -o y.exr
  same a.exr y.exr
  combine --op multiply t.exr t.exr t.exr -o x.exr
  constant want.exr 0.125 --kind T
  same want.exr x.exr
  combine --op divide half.exr a.exr -o x.exr
  spectral want.exr --kind T --bins --quantity ratio --pattern constant:0.5
  same want.exr x.exr
  combine --op multiply x.exr a.exr -o y.exr
  same half.exr y.exr
  run ! grep -q emissiveUnits <<<"$(exrheader x.exr)"
  fails_cleanly speccomp --op multiply a.exr a.exr -o x.exr
  fails_cleanly speccomp --op divide t.exr a.exr -o x.exr
}

@test "--op over composites premultiplied light and alpha" {
  constant a.exr 0.25 --extra A # A is 0.25, too
  constant b.exr 0.5 --extra A
  constant c.exr 2
  combine --op over a.exr b.exr c.exr -o x.exr
  pixel_holds a.exr x.exr 15,7 '
    is("S0.400,000000nm", 0.25 + 0.75 * (0.5 + 0.5 * 2))
    is("A", 0.25 + 0.75 * (0.5 + 0.5 * 1))'
  fails_cleanly speccomp --op over c.exr a.exr -o x.exr
  [[ $stderr = *'c.exr has no alpha (A), so a.exr could not be seen behind it' ]] || complain "$stderr"
}

@test "--alpha names another channel for --op over" {
  constant a.exr 0.25 --extra A --extra Z --uint id
  constant b.exr 0.5 --extra Z
  combine --op over --alpha Z a.exr b.exr -o x.exr
  pixel_holds a.exr x.exr 15,7 '
    is("S0.400,000000nm", 0.25 + 0.75 * 0.5)
    is("Z", 0.25 + 0.75 * 0.5)
    is("A", 0.25)'
  for alpha in id S0.400,000000nm missing; do
    fails_cleanly speccomp --op over --alpha $alpha a.exr b.exr -o y.exr
  done
  fails_cleanly speccomp --op lerp --mask Z --alpha Z a.exr b.exr -o y.exr
}

@test "--op over holds for every Stokes component" {
  constant a.exr 0.25 --kind stokes --extra A
  constant b.exr 0.5 --kind stokes
  combine --op over a.exr b.exr -o x.exr
  constant want.exr 0.625 --kind stokes
  combine --expr b want.exr x.exr -o y.exr # its foreign channels are those of the first
  same want.exr y.exr
}

@test "--op lerp by a channel, by an id, and by another image" {
  constant a.exr 0.25 --extra Z --uint id --size 4x2
  constant b.exr 0.5 --size 4x2
  spectral mask.exr --channel Y --size 4x2
  spectral many.exr --channel Y --channel Q --uint id --pattern constant:0.75 --size 4x2
  combine --op lerp --mask Z a.exr b.exr -o x.exr # Z is 0.25
  pixel_holds a.exr x.exr 0,0 'is("S0.500,000000nm", 0.75 * 0.25 + 0.25 * 0.5); is("Z", 0.25)'
  combine --op lerp --mask id=65538 a.exr b.exr -o x.exr # x + 65536 y: the pixel 2,1
  pixel_holds a.exr x.exr 2,1 'is("S0.500,000000nm", 0.5)'
  for pixel in 2,0 1,1 3,1; do
    pixel_holds a.exr x.exr $pixel 'is("S0.500,000000nm", 0.25)'
  done
  for mask in mask.exr mask.exr:Y; do
    combine --op lerp --mask $mask a.exr b.exr -o x.exr
    pixel_holds a.exr x.exr 3,1 'is("S0.500,000000nm", 0.25 + 0.25 * (4 * 0.001 + 0.01))'
  done
  combine --op lerp --mask many.exr:Q a.exr b.exr -o x.exr
  pixel_holds a.exr x.exr 3,1 'is("S0.500,000000nm", 0.25 + 0.25 * 0.75)'
  # A channel comes before a file of that name; of several channels A, then Y.
  cp many.exr Z
  combine --op lerp --mask Z a.exr b.exr -o x.exr
  pixel_holds a.exr x.exr 0,0 'is("S0.500,000000nm", 0.75 * 0.25 + 0.25 * 0.5)'
  spectral both.exr --channel Q --channel Y --channel A --size 4x2
  combine --op lerp --mask both.exr a.exr b.exr -o x.exr
  pixel_holds a.exr x.exr 3,1 'is("S0.500,000000nm", 0.25 + 0.25 * (4 * 0.001 + 0.01 + 0.2))'
  spectral both.exr --channel Q --channel Y --size 4x2
  combine --op lerp --mask both.exr a.exr b.exr -o x.exr
  pixel_holds a.exr x.exr 3,1 'is("S0.500,000000nm", 0.25 + 0.25 * (4 * 0.001 + 0.01 + 0.1))'
  combine --op lerp --mask - a.exr b.exr -o y.exr <mask.exr
  combine --op lerp --mask <(cat mask.exr) a.exr b.exr -o z.exr
  cmp y.exr z.exr
  combine --op lerp --mask many.exr:id=65538 a.exr b.exr -o x.exr
  pixel_holds a.exr x.exr 2,1 'is("S0.500,000000nm", 0.5)'
  pixel_holds a.exr x.exr 1,1 'is("S0.500,000000nm", 0.25)'
}

@test "a mask that is none is refused" {
  constant a.exr 0.25 --uint id
  constant b.exr 0.5
  spectral many.exr --channel Q --channel R
  spectral small.exr --channel Y --size 3x3
  for mask in nothing id=x id=-1 id=4294967296 many.exr many.exr:S small.exr many.exr:Q=1 a.exr:id= missing.exr:Y; do
    fails_cleanly speccomp --op lerp --mask "$mask" a.exr b.exr -o x.exr
  done
  fails_cleanly speccomp --op lerp --mask many.exr a.exr b.exr -o x.exr
  [[ $stderr = *'many.exr: which of its 2 channels is the mask? (--mask FILE:CHANNEL)' ]] || complain "$stderr"
  fails_cleanly speccomp --op lerp --mask - - b.exr -o x.exr <a.exr
  [ ! -e x.exr ]
}

@test "--merge of two renders is the mean weighted by their samples, and specdiff says so" {
  rendered a.exr 4 1
  rendered b.exr 12 2
  combine --merge a.exr b.exr -o x.exr
  combine --expr '(4 * a + 12 * b) / 16' a.exr b.exr -o y.exr
  same x.exr y.exr
  combine --op mean --weight 1,3 a.exr b.exr -o y.exr
  same x.exr y.exr
  has_line x.exr 'spec:samples (type int): 16'
  run ! grep -q spec:samples <<<"$(exrheader y.exr)"
  # In two steps as in one, but for the rounding of the first.
  rendered c.exr 2 3
  combine --merge a.exr b.exr c.exr -o x.exr
  combine --merge a.exr b.exr | combine --merge - c.exr -o y.exr
  specdiff --tolerance max=1e-6 x.exr y.exr
  has_line y.exr 'spec:samples (type int): 18'
}

@test "--merge comes nearer to a render of many samples" {
  rendered want.exr 4096 9
  mapfile -t seeds < <(seq 8)
  for seed in "${seeds[@]}"; do
    rendered "$seed.exr" 16 "$seed"
  done
  combine --merge {1..8}.exr -o x.exr
  distance() { specdiff -m rmse "$1" want.exr | awk '{ print $2 }'; }
  # 128 samples against 16: the standard error is 1 / sqrt(8) = 0.354 of one's; each is good to a
  # quarter of itself in 96 pixels and 8 renders of correlated bands.
  total=0
  for seed in "${seeds[@]}"; do
    total=$(awk "BEGIN { print $total + $(distance "$seed.exr") ^ 2 }")
  done
  awk -v total="$total" -v merged="$(distance x.exr)" 'BEGIN {
    ratio = merged / sqrt(total / 8)
    if (ratio < 0.2 || ratio > 0.5) { print "ratio " ratio; exit 1 }
  }'
}

@test "--merge takes light layers and their geometry along" {
  rendered a.exr 8 1 --defer film,disc
  rendered b.exr 24 2 --defer film,disc
  combine --merge a.exr b.exr -o x.exr
  for pixel in 6,4 3,4 4,2 7,5; do
    pixel_holds a.exr x.exr $pixel "$(
      "$TESTS/layers" --print $pixel b.exr | awk '{ printf "b[\"%s\"] = %s;", $1, $2 }')"'
      for (name in from) {
        if (name ~ /(S0[.].*nm|cover)$/) { is(name, (from[name] + 3 * b[name]) / 4, 1e-5); count++ }
        if (name !~ /^film.[.](cosine|P|Q)/) continue
        cover = name; sub(/[.].*/, ".cover", cover)
        weight = from[cover] + 3 * b[cover]
        is(name, weight ? (from[cover] * from[name] + 3 * b[cover] * b[name]) / weight : 0, 1e-5)
      }
      for (k = 1; k <= 2; k++) {
        n = "film" k ".N."
        long = sqrt(to[n "X"] ^ 2 + to[n "Y"] ^ 2 + to[n "Z"] ^ 2)
        if (!near(long, to["film" k ".cover"] > 0, 1e-5)) wrong(n " has length " long)
      }
      if (count < 18) wrong("only " count " channels of light")'
  done
  specfilm --stack 'air | 1.33 500nm | air' x.exr -o y.exr
  fails_cleanly speccomp --op max a.exr b.exr -o x.exr
  [[ $stderr = *'a.exr has light layers, which max cannot do'* ]] || complain "$stderr"
}

@test "--merge needs samples, or weights" {
  ramps
  fails_cleanly speccomp --merge a.exr b.exr -o x.exr
  [[ $stderr = *'a.exr does not say its samples per pixel, spec:samples (--weight)' ]] || complain "$stderr"
  combine --merge --weight 2,2 a.exr b.exr -o x.exr
  constant zero.exr 0
  same zero.exr x.exr
}

# --expr

@test "--expr on bands, wavelengths, pixels and channels" {
  spectral a.exr --extra Z --size 5x4
  constant b.exr 0.25 --size 5x4
  while read -r expression value; do
    combine --expr "$expression" a.exr b.exr -o x.exr
    pixel_holds a.exr x.exr 3,2 "a = from[\"S0.460,000000nm\"]; b = 0.25; is(\"S0.460,000000nm\", $value, 2e-7)" ||
      complain "$expression"
  done <<'END'
a+b a + b
a*nm a * 460
a>b?a:-b a > b ? a : -b
a(400)/a(410nm) from["S0.400,000000nm"] / (0.5 * from["S0.400,000000nm"] + 0.5 * from["S0.420,000000nm"])
x+10*y+100*width+1000*height 4523
bands 16
a.Z-a.("S0.700,000000nm") from["Z"] - from["S0.700,000000nm"]
g=a^2;h=b^2;sqrt(g+h) sqrt(a * a + b * b)
exp(-a)*log(b)+sin(a)*cos(b) exp(-a) * log(b) + sin(a) * cos(b)
mix(a,b,step(450,nm)) b
clamp(a,0,min(b,0.125)) 0.125
planck(5000)/planck(5000+0*a) 1
END
}

@test "--expr that is none is shown with a caret" {
  ramps
  fails_pointing 5 speccomp --expr 'a + * b' a.exr b.exr -o x.exr
  [[ $stderr = *"expected a value, not '*'" ]] || complain "$stderr"
  fails_pointing 1 speccomp --expr 'c - a' a.exr b.exr -o x.exr
  [[ $stderr = *"there is no image 'c': 2 are given" ]] || complain "$stderr"
  fails_pointing 5 speccomp --expr 'a + a(390)' a.exr -o x.exr
  [[ $stderr = *'390 nm is outside the bands of a.exr, 400..700 nm' ]] || complain "$stderr"
  fails_pointing 3 speccomp --expr '2*a.A' a.exr -o x.exr
  [[ $stderr = *"a.exr has no channel 'A'" ]] || complain "$stderr"
  no_leftovers . a.exr b.exr c.exr
}

@test "--expr makes a quotient of light into T, and light of T with --kind" {
  spectral a.exr
  combine --expr 'a / a' --kind T a.exr -o x.exr
  constant want.exr 1 --kind T --quantity ratio
  same want.exr x.exr
  combine --expr '2 * a' --kind S0 x.exr -o y.exr
  constant want.exr 2
  same want.exr y.exr
  spectral t.exr --kind T --quantity transmittance
  combine --expr 'a' --kind T t.exr -o y.exr
  same t.exr y.exr
}

@test "every operation is the expression that its page says" {
  constant a.exr 0.25 --extra A
  constant b.exr 0.5 --extra A
  spectral c.exr --extra A
  while IFS='#' read -r name expression; do
    # shellcheck disable=SC2086 # may have a mask
    combine --op $name a.exr b.exr -o x.exr
    combine --expr "$expression" a.exr b.exr -o y.exr
    # Alpha is the first image's in expressions.
    specconvert --band 400 --band 420 x.exr | combine --expr 'a' - -o x2.exr
    specconvert --band 400 --band 420 y.exr | combine --expr 'a' - -o y2.exr
    combine --expr 'abs(a - b)' x2.exr y2.exr -o z.exr
    pixel_holds a.exr z.exr 9,5 'is("S0.420,000000nm", 0)' || complain "$name"
  done <<'END'
add#a+b
subtract#a-b
min#min(a,b)
max#max(a,b)
mean#(a+b)/2
over#a+(1-a.A)*b
lerp --mask A#mix(a,b,a.A)
END
}

# NaN and infinity

@test "NaN in any image is NaN in the result; what is mixed in by nothing plays no part" {
  constant a.exr 0.25 --pattern nan:2,3,4 --uint id
  constant b.exr 0.5 --pattern inf:5,6,4 --pattern nan:7,7,4
  for op in add subtract min max mean; do
    combine --op $op a.exr b.exr -o x.exr
    for pixel in 2,3 7,7; do
      [ "$("$TESTS/layers" --print $pixel x.exr | grep -c nan)" = 1 ] || complain "$op"
    done
  done
  combine --op divide b.exr a.exr -o x.exr
  [ "$("$TESTS/layers" --print 5,6 x.exr | grep -c inf)" = 1 ]
  combine --op lerp --mask id=99 a.exr b.exr -o x.exr # nowhere: b plays no part
  same a.exr x.exr
  combine --expr 'isnan(a) ? 0.25 : a' a.exr -o x.exr
  constant want.exr 0.25 --uint id
  same want.exr x.exr
}

# What does not go together

@test "what does not go together is refused with both sides" {
  spectral a.exr
  refused() {
    fails_cleanly speccomp --op add a.exr "$1" -o x.exr
    [[ $stderr = *": $2" ]] || complain "$stderr" || return 1
    fails_cleanly speccomp --op add a.exr - -o x.exr < <(cat "$1")
  }
  spectral b.exr --grid 380:780:5
  refused b.exr 'a.exr has 16 bands 400..700 nm, b.exr 81 bands 380..780 nm'
  spectral b.exr --kind T
  refused b.exr "a.exr is light ('radiance per nm'), b.exr reflectance ('reflectance')"
  spectral b.exr --quantity 'radiance per band'
  refused b.exr "a.exr is light ('radiance per nm'), b.exr light ('radiance per band')"
  spectral b.exr --kind stokes
  refused b.exr 'a.exr has 1 Stokes component, b.exr 4'
  spectral b.exr --bins
  refused b.exr 'a.exr has point samples, b.exr bins'
  spectral b.exr --size 16x9
  refused b.exr 'a.exr has the data window 0,0,16,8, b.exr 0,0,16,9'
  spectral b.exr --display 0,0,20,20
  refused b.exr 'a.exr has the display window 0,0,16,8, b.exr 0,0,20,20'
  spectral b.exr --channel R
  refused b.exr 'b.exr: has no spectral channel'
  [ ! -e x.exr ]
}

# What passes through

@test "foreign channels, windows and attributes are the first image's" {
  spectral a.exr --data 3,-5 --display 0,0,30,30 --extra Z --uint id --attribute 'owner=one' --compression piz
  spectral b.exr --data 3,-5 --display 0,0,30,30 --extra Z --extra Y --pattern constant:0 --attribute 'owner=two'
  combine --op add a.exr b.exr -o x.exr
  same a.exr x.exr
  has_line x.exr 'owner (type string): "one"'
  spectral p.exr --grid 400:700:20 --extra R --extra G --extra B
  combine --op add p.exr p.exr -o x.exr
  [ "$(channels x.exr | grep -c '^[RGB]$')" = 0 ]
}

@test "other programs' names of bands are read, and the layout's written" {
  constant a.exr 0.25 --channel 400.00-410.00nm --channel 410.00-420.00nm
  combine --op add a.exr a.exr -o x.exr
  has_channels x.exr S0.405,000000nm S0.415,000000nm
  has_line x.exr 'spec:bins (type string): "400 410 420"'
}

@test "HALF stays where all are HALF, and --half makes it" {
  spectral a.exr --half
  spectral b.exr
  combine --op add a.exr a.exr -o x.exr
  [ "$(exrheader x.exr | grep -c 'S0.*16-bit')" = 16 ]
  combine --op add a.exr b.exr -o x.exr
  [ "$(exrheader x.exr | grep -c 'S0.*32-bit')" = 16 ]
  combine --half --op add a.exr b.exr -o x.exr
  [ "$(exrheader x.exr | grep -c 'S0.*16-bit')" = 16 ]
  constant large.exr 60000
  combine --half --op add large.exr large.exr -o x.exr 2>err
  grep -q 'too large for 16 bits' err
}

@test "spec:history has the commands of all images and its own" {
  ramps
  specconvert a.exr -o one.exr
  specconvert b.exr -o two.exr
  speccomp --op add one.exr two.exr one.exr -o x.exr
  exrheader x.exr | sed -n '/spec:history/,/^"/p' >history
  [ "$(grep -c 'specconvert a.exr -o one.exr' history)" = 1 ] || complain "$(cat history)"
  [ "$(grep -c 'specconvert b.exr -o two.exr' history)" = 1 ] || complain "$(cat history)"
  [ "$(grep -c 'speccomp --op add one.exr two.exr one.exr -o x.exr' history)" = 1 ] || complain "$(cat history)"
  combine --op add a.exr b.exr -o x.exr
  run ! grep history <<<"$(exrheader x.exr)"
}

# Files, pipes and threads

@test "every number of threads, files and pipes, tiles and lines give the same bytes" {
  spectral a.exr --size 61x167 --pattern grain --compression none
  spectral b.exr --size 61x167 --pattern noise --compression zip
  spectral lines.exr --size 61x167 --pattern ramp
  exrmaketiled -t 13 17 lines.exr c.exr
  combine -j 1 --expr 'mix(a, b, c - floor(c)) ^ 0.7' a.exr b.exr c.exr -o want.exr
  for threads in 2 3 7; do
    combine -j $threads --expr 'mix(a, b, c - floor(c)) ^ 0.7' a.exr b.exr c.exr -o x.exr
    cmp want.exr x.exr
  done
  combine --expr 'mix(a, b, c - floor(c)) ^ 0.7' <(cat a.exr) - c.exr -o x.exr < <(cat b.exr)
  cmp want.exr x.exr
  combine --expr 'mix(a, b, c - floor(c)) ^ 0.7' a.exr b.exr c.exr | specconvert --no-history -o x.exr
  same want.exr x.exr
  # A pixel's value does not depend on where it stands in its row.
  for file in a b c; do
    specconvert --crop 5,3,18,19 $file.exr -o $file-crop.exr
  done
  combine --expr 'mix(a, b, c - floor(c)) ^ 0.7' a-crop.exr b-crop.exr c-crop.exr -o x.exr
  specconvert --no-history --crop 5,3,18,19 want.exr | specdiff - x.exr
}

@test "memory does not grow with the height" {
  for lines in 64 2048; do
    spectral a$lines.exr --size 64x$lines --grid 380:780:5 --pattern constant:1 --compression none
    "$TESTS/peak" times$lines speccomp -j 2 --op add a$lines.exr a$lines.exr -o x.exr
  done
  # 2048 lines are 42 MB in each image.
  awk 'NR == FNR { low = $2 } NR != FNR && $2 > low + 8192 { print $2 " KiB"; exit 1 }' times64 times2048
}

@test "an input that is not there, or ends early, fails and leaves nothing" {
  spectral a.exr --size 9x70 --compression none
  size=$(wc -c <a.exr)
  fails_cleanly speccomp --op add a.exr missing.exr -o x.exr
  [[ $stderr = *missing.exr*'No such file or directory' ]] || complain "$stderr"
  for percent in 0 1 30 99; do
    head -c $((size * percent / 100)) a.exr >short.exr
    fails_cleanly speccomp --op add a.exr short.exr -o x.exr
    fails_cleanly speccomp --op add - a.exr -o x.exr < <(cat short.exr)
    fails_cleanly speccomp --op lerp --mask short.exr:A a.exr a.exr -o x.exr
  done
  no_leftovers . a.exr short.exr
}

@test "a full device fails, and leaves nothing" {
  ramps
  fails_cleanly speccomp --op add a.exr b.exr -o /dev/full
  for compression in none zip; do
    code=0
    speccomp --op add --compression $compression a.exr b.exr >/dev/full 2>err || code=$?
    [ "$code" -eq 2 ]
    [ "$(wc -l <err)" -eq 1 ]
  done
  no_leftovers . a.exr b.exr c.exr err
}

@test "an output may be one of the inputs" {
  ramps
  combine --op add a.exr c.exr -o want.exr
  combine --op add a.exr c.exr -o a.exr
  cmp want.exr a.exr
}

@test "limits are refused by name" {
  ramps
  for limit in pixels=7 channels=3 header=50 memory=1k; do
    fails_cleanly speccomp --limit $limit --op add a.exr b.exr -o x.exr
    [[ $stderr = *"--limit ${limit%%=*}="* ]] || complain "$stderr"
  done
}

@test "--progress shows lines on standard error, and -q none" {
  ramps
  speccomp --op add a.exr b.exr -o x.exr 2>said
  [ ! -s said ]
  speccomp --progress --op add a.exr b.exr -o x.exr 2>said
  grep -q '100% .* lines/s' said || complain "$(cat said)"
  speccomp --progress -q --op add a.exr b.exr -o x.exr 2>said
  [ ! -s said ]
}

@test "a reader that leaves ends it silently, with SIGPIPE" {
  spectral a.exr --size 256x200 --compression none
  { env --default-signal=PIPE speccomp --op add a.exr a.exr 2>err || echo $? >code; } | head -c 100 >/dev/null
  [ "$(cat code)" = 141 ]
  [ ! -s err ]
}
