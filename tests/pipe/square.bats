#!/usr/bin/env bats
# The square: what specrender makes of a film or a disc is what specfilm and specdisc make of the
# light that specrender --defer hands over; and both are what closed forms say, computed by awk.
#
# Where the two routes choose at random what they follow, means of 8 seeds are compared, with 4 of
# their own standard errors between them: the variance over the seeds, summed over the pixels of a
# cell, which are independent (64 pixels or more: 448 degrees of freedom; discs, which are bright in
# few pixels, take 16 seeds). One comparison in 14000
# would fail by chance; there are about 200, so one run of this file in 70, were the seeds not
# fixed. Bands share their choices of ways: the true rate is lower.
# shellcheck disable=SC2016 # $1 and the like are awk's

load ../tool/common
load ../tool/physics

functions=$film_functions$disc_functions

soap='air | 1.33 300nm | air'
grid=450:650:100
seeds=8
rendered=0

render() {
  specrender --no-history -q --grid $grid "$@"
}

# fold FILE ARGUMENT...: the layers that come in become an image without layers.
fold() {
  specfilm --no-history "${@:2}" -o "$1"
}

# text FILE...: each as FILE.spd beside it, a column per pixel.
text() {
  local file
  for file; do
    specconvert -f spd "$file" -o "${file%.exr}.spd"
  done
}

# statistics CELL: of a.1.spd, b.1.spd, a.2.spd, ..., which come in the order a, b, a, b: a line per
# band and cell, WAVELENGTH CELL PIXELS MEAN SIGMA SIGMAS: the mean of b, the standard error of the
# means' difference, and how many of these a lies above b. CELL is awk's and sets cell to the name of
# that of pixel x, y, or to "".
statistics() {
  local pairs=() i
  for ((i = 1; i <= seeds; i++)); do pairs+=("a.$i.spd" "b.$i.spd"); done
  awk '
    FNR == 1 { file++; row = 0 }
    /^# columns/ && file == 1 {
      columns = NF - 2
      for (i = 2; i <= columns; i++) {
        split(substr($(i + 2), 2), at, "y"); x = at[1]; y = at[2]
        cell = ""; '"$1"'
        of[i] = cell
      }
    }
    /^#/ { next }
    {
      nm[++row] = $1
      for (i = 2; i <= columns; i++) {
        if (of[i] == "") continue
        if (file % 2) { a[i, row] = $i; continue }
        d = a[i, row] - $i
        sum[i, row] += d; square[i, row] += d * d; light[i, row] += $i
      }
    }
    END {
      seeds = file / 2
      for (r = 1; r <= row; r++) {
        split("", pixels); split("", off); split("", variance); split("", mean)
        for (i = 2; i <= columns; i++) if ((c = of[i]) != "") {
          pixels[c]++; off[c] += sum[i, r] / seeds; mean[c] += light[i, r] / seeds
          variance[c] += (square[i, r] - sum[i, r] ^ 2 / seeds) / (seeds - 1) / seeds
        }
        for (c in pixels) {
          # rounding to float and to text counts as noise, too
          sigma = sqrt((variance[c] > 0 ? variance[c] : 0) + (1e-6 * mean[c]) ^ 2)
          printf "%s %s %d %.6g %.6g %.3f\n", nm[r], c, pixels[c], mean[c] / pixels[c], sigma / pixels[c], off[c] / sigma
        }
      }
    }' "${pairs[@]}"
}

# agree [CELL]: a and b are within 4 sigma in every band and cell; what was found is left in found, and
# for who wants to look at it all added to the file $SQUARE_LOG.
agree() {
  statistics "${1:-cell = \"all\"}" >found
  [ -z "${SQUARE_LOG-}" ] || { echo "$BATS_TEST_DESCRIPTION"; cat found; } >>"$SQUARE_LOG"
  awk '!($6 >= -4 && $6 <= 4) { bad = 1 } END { exit bad || !NR }' found ||
    complain "WAVELENGTH CELL PIXELS MEAN SIGMA SIGMAS" "$(cat found)"
}

# both ARGUMENT...: renders scene.pbrt 8 times, to a.1.exr ... as it is, and to b.1.exr ... through
# layers, which specfilm folds with the arguments in folding. Each pixel is one sample, so that there
# are no means that do not commute, unless ARGUMENT... asks for more.
both() {
  local i seed
  for ((i = 1; i <= seeds; i++)); do
    seed=$((BATS_TEST_NUMBER * 1000 + (rendered += 1)))
    render --seed $seed "$@" scene.pbrt -o "a.$i.exr"
    render --seed $seed "$@" --defer film scene.pbrt | fold "b.$i.exr" "${folding[@]}"
  done
  text a.?.exr b.?.exr
}

# against AWK: what AWK sets want to, at the wavelength l, takes the place of all pixels of b.
against() {
  local i
  awk "$statements$functions"'
    /^#/ { print; next }
    { l = $1; '"$1"'; for (i = 2; i <= NF; i++) $i = sprintf("%.9g", want); print }' a.1.spd >want.spd
  for ((i = 1; i <= seeds; i++)); do cp want.spd "b.$i.spd"; done
}

# A plane film, 40 degrees off the view, before a black ground or a mirror. What it mirrors comes
# from the surroundings, whose radiance is nm / 500, and so does what the mirror behind it mirrors:
# that is turned 30 degrees the other way, so that its light goes past the film.

black='
  Translate 0 0 6
  Material "diffuse" "float reflectance" 0
  Shape "disk" "float radius" 50'
mirror='
  Translate 0 0 6
  Rotate 30 1 0 0
  Material "conductor" "float eta" 0.5 "float k" 3
  Shape "disk" "float radius" 2'

# The normal looks to the eye, or away from it.
front=140
back=-40

# plane FOV STACK GROUND [TURN]
plane() {
  cat <<END
Camera "perspective" "float fov" $1
Film "rgb" "integer xresolution" 8 "integer yresolution" 8
Sampler "independent" "integer pixelsamples" 1
Integrator "path" "integer maxdepth" 200
WorldBegin
LightSource "infinite" "spectrum L" [ 300 .6 800 1.6 ]
AttributeBegin
$3
AttributeEnd
Translate 0 0 2
Rotate ${4:-$front} 1 0 0
Material "thinfilm" "string stack" "$2"
Shape "disk" "float radius" 1
END
}

# The film reflects R and passes T at the wavelength l, where its cosine is this, and the mirror behind
# it reflects C, where that has one.
functions+='
  function sees(stack, l, cosine, behind) {
    C = 0
    if (behind) { power("air | 0.5+3i", l, behind, "u"); C = R }
    seen(stack, l, cosine, "u")
  }
'

# Exact, but that layers round cosines to 6e-8, of which phases of 10 make some 1e-6.

@test "a plane film before a black ground, folded, is R L in each pixel" {
  for turn in $front $back; do
    for stack in "$soap" 'air | 1.38 120nm | 1.5' 'air | 2.3+0.2i 60nm | 1.33 100nm | air'; do
      # its own stack is another: the layers do not know it
      plane 20 'air | 1.7 1nm | 1.2' "$black" "$turn" >scene.pbrt
      render --defer film scene.pbrt -o layers.exr
      fold folded.exr --stack "$stack" <layers.exr
      for pixel in 0,0 3,4 7,7; do
        pixel_holds layers.exr folded.exr $pixel '
          if (from["film1.cover"] != 1) wrong("no film")
          # the eye is at the origin, and the normal is turned about x
          px = from["film1.P.X"]; py = from["film1.P.Y"]; pz = from["film1.P.Z"]
          cosine = (py * sin('"$turn"' * pi / 180) - pz * cos('"$turn"' * pi / 180)) / sqrt(px ^ 2 + py ^ 2 + pz ^ 2)
          if (!near(from["film1.cosine"], cosine, 1e-6)) wrong("cosine")
          for (l = 450; l <= 650; l += 100) {
            sees("'"$stack"'", l, from["film1.cosine"]); is("S0." l ",000000nm", R * l / 500, 3e-6)
          }'
      done
    done
  done
}

@test "a plane film before a mirror, folded, is (R + T C) L in each pixel" {
  for turn in $front $back; do
    for stack in "$soap" 'air | 1.38 120nm | 1.5' 'air | 2.3+0.2i 60nm | 1.33 100nm | air'; do
      plane 20 'air | 1.7 1nm | 1.2' "$mirror" "$turn" >scene.pbrt
      render --defer film scene.pbrt -o layers.exr
      fold folded.exr --stack "$stack" <layers.exr
      for pixel in 0,0 3,4 7,7; do
        pixel_holds layers.exr folded.exr $pixel '
          behind = size(0.5 * from["film1.I.Y"] - cos(pi / 6) * from["film1.I.Z"])
          for (l = 450; l <= 650; l += 100) {
            sees("'"$stack"'", l, from["film1.cosine"], behind)
            is("S0." l ",000000nm", (R + T * C) * l / 500, 3e-6)
          }'
      done
    done
  done
}

# Within 4 sigma. The pictures are so narrow that one angle holds for all pixels.

# plane_agrees GROUND WANT COSINE: for some stacks on both sides, rendered as it is and folded are as
# awk's WANT says; COSINE is that at the mirror, or 0.
plane_agrees() {
  local turn stack
  for turn in $front $back; do
    for stack in "$soap" 'air | 1.38 120nm | 1.5' 'air | 2.3+0.2i 60nm | 1.33 100nm | air'; do
      [ "$turn $stack" != "$back $soap" ] || continue # it has two equal sides
      plane 0.05 "$stack" "$1" "$turn" >scene.pbrt
      folding=(--stack "$stack")
      both --spp 64
      agree
      against 'sees("'"$stack"'", l, '"$([ "$turn" = $front ] || echo -)"'cos(40 * pi / 180), '"$3"'); want = ('"$2"') * l / 500'
      agree
    done
  done
}

@test "a plane film before a black ground, rendered, is R L" {
  plane_agrees "$black" R 0
}

@test "a plane film before a mirror, rendered, is (R + T C) L" {
  plane_agrees "$mirror" 'R + T * C' 'cos(30 * pi / 180)'
}

@test "a plane film with a mirror close behind it: all the light that goes to and fro between them" {
  for stack in "$soap" 'air | 2.3+0.2i 60nm | 1.33 100nm | 2.3+0.2i 60nm | air'; do
    plane 0.05 "$stack" '
      Translate 0 0 2
      Rotate 140 1 0 0
      Translate 0 0 -.001
      Material "conductor" "float eta" 0.5 "float k" 3
      Shape "disk" "float radius" 10' >scene.pbrt
    folding=(--stack "$stack")
    both --spp 64
    agree
    against 'sees("'"$stack"'", l, cos(40 * pi / 180), cos(40 * pi / 180)); want = (R + T * T * C / (1 - R * C)) * l / 500'
    agree
  done
}

# A film that absorbs nothing, in surroundings of the radiance 2, is not to be seen.

@test "a plane film in uniform surroundings is not to be seen" {
  for stack in "$soap" 'air | 1.7 150nm | 1.3 200nm | air'; do
    plane 40 "$stack" '' >scene.pbrt
    sed -i 's/.*"infinite".*/LightSource "infinite" "float L" 2/' scene.pbrt
    render --defer film scene.pbrt | fold b.exr --stack "$stack"
    for pixel in 0,0 3,4 7,7; do
      pixel_holds b.exr b.exr $pixel 'for (name in to) if (name ~ /^S0/) is(name, 2, 3e-7)'
    done
    folding=(--stack "$stack")
    both --spp 64
    against 'want = 2'
    agree
  done
}

@test "a plane film and a single band: the ways are chosen as the light goes, and nothing is left to chance" {
  plane 0.05 "$soap" '' >scene.pbrt
  sed -i 's/.*"infinite".*/LightSource "infinite" "float L" 2/' scene.pbrt
  render --grid 450:450:1 --spp 64 scene.pbrt -o a.exr
  for pixel in 0,0 3,4 7,7; do
    pixel_holds a.exr a.exr $pixel 'is("S0.450,000000nm", 2, 3e-7)'
  done
}

# bubble LIGHT: of 4 cm, whose radius in the picture is 12.2 pixels about its middle.
bubble() {
  cat <<END
LookAt 0 -.3 .02  0 0 0  0 0 1
Camera "perspective" "float fov" 20
Film "rgb" "integer xresolution" 32 "integer yresolution" 32
Sampler "independent" "integer pixelsamples" 1
Integrator "path" "integer maxdepth" 200
WorldBegin
$1
Material "thinfilm" "string stack" "air | 1.33 * | air" "string thickness" "gravity 530nm..730nm"
Shape "sphere" "float radius" .04
END
}

gravity=(--stack 'air | 1.33 * | air' --thickness 'gravity 530nm..730nm')
distance='d = sqrt((x - 15.5) ^ 2 + (y - 15.5) ^ 2)'
quarter='(x < 16 ? "left" : "right") "-" (y < 16 ? "upper" : "lower")'
inside="$distance; if (d < 9) cell = $quarter; if (d > 14) cell = \"beside\""
rim="$distance; if (d > 10 && d < 14) cell = $quarter"

@test "a bubble in uniform surroundings is not to be seen" {
  bubble 'LightSource "infinite" "float L" 2' >scene.pbrt
  folding=("${gravity[@]}")
  both --spp 4
  agree
  against 'want = 2'
  agree 'cell = '"$quarter"
}

# A room whose walls shine: the ceiling more and more to the red, the floor to the blue.
walls() {
  local i light=('[ 300 1 800 6 ]' '[ 300 1 800 .2 ]' '[ 300 .3 800 .3 ]') at=('
    -2 -2 1  2 -2 1  2 2 1  -2 2 1' '
    -2 -2 -1  2 -2 -1  2 2 -1  -2 2 -1' '
    -2 -2 -1  2 -2 -1  2 -2 1  -2 -2 1  -2 2 -1  2 2 -1  2 2 1  -2 2 1
    -2 -2 -1  -2 2 -1  -2 2 1  -2 -2 1  2 -2 -1  2 2 -1  2 2 1  2 -2 1')
  echo 'AttributeBegin Material "diffuse" "float reflectance" 0'
  for i in 0 1 2; do
    echo "AreaLightSource \"diffuse\" \"spectrum L\" ${light[i]} \"bool twosided\" true"
    echo "Shape \"trianglemesh\" \"point3 P\" [ ${at[i]} ] \"integer indices\" [ 0 1 2 0 2 3"
    [ $i != 2 ] || echo '4 5 6 4 6 7 8 9 10 8 10 11 12 13 14 12 14 15'
    echo ']'
  done
  echo AttributeEnd
}

@test "a bubble in a room, away from its rim" {
  bubble "$(walls)" >scene.pbrt
  folding=("${gravity[@]}")
  both --spp 32
  agree "$inside"
}

@test "a bubble in a picture of surroundings, away from its rim" {
  for i in 1 2 3 4 5 6 7 8; do printf '400 %s\n700 %s\n' $i $((9 - i)) >$i.spd; done
  specconvert --patches 4x2 ./?.spd -o surroundings.exr
  rm ./?.spd
  bubble 'LightSource "infinite" "string filename" "surroundings.exr"' >scene.pbrt
  folding=("${gravity[@]}")
  both --spp 32
  agree "$inside"
}

@test "the rim of a bubble, with layers of 4 times the resolution" {
  bubble "$(walls)" >scene.pbrt
  folding=("${gravity[@]}")
  both --spp 64
  # means of layers do not commute with films: so it is told apart
  statistics "$rim" >found
  awk '$6 < -6 || $6 > 6 { found = 1 } END { exit !found }' found || complain "$(cat found)"
  for ((i = 1; i <= seeds; i++)); do
    render --seed $((BATS_TEST_NUMBER * 1000 + i)) --defer film --supersample 4 --spp 4 scene.pbrt |
      specfilm --no-history "${gravity[@]}" | specconvert --downsample 4 -o "b.$i.exr"
  done
  text b.?.exr
  agree "$rim"
}

@test "a bubble, of the light that is mirrored once or passes, in each pixel and as a mean" {
  # A path that may meet two films alone: what is mirrored within the bubble is lost.
  bubble 'LightSource "infinite" "float L" 2' | sed 's/maxdepth" 200/maxdepth" 2/' >scene.pbrt
  folding=("${gravity[@]}")
  both --spp 16
  agree "$inside"
  render --defer film scene.pbrt -o layers.exr
  fold folded.exr "${folding[@]}" <layers.exr
  for pixel in 16,16 8,12 13,22 20,7 18,25; do
    pixel_holds layers.exr folded.exr $pixel '
      # cosine and thickness from where the eye is and what it sees
      x = 0; y = -0.3; z = 0.02
      for (film = 2; film >= 1; film--) {
        px = from["film" film ".P.X"]; py = from["film" film ".P.Y"]; pz = from["film" film ".P.Z"]
        if (!near(sqrt(px ^ 2 + py ^ 2 + pz ^ 2), 0.04, 1e-6)) wrong("not on the bubble")
        c[film] = (px * (x - px) + py * (y - py) + pz * (z - pz)) / 0.04 / sqrt((x - px) ^ 2 + (y - py) ^ 2 + (z - pz) ^ 2)
        stack[film] = sprintf("air | 1.33 %.9gnm | air", 530 * (730 / 530) ^ (1 - (pz / 0.04 + 1) / 2))
      }
      if (!(c[1] > 0 && near(c[2], -c[1], 1e-5))) wrong("cosines " c[1] " and " c[2])
      for (l = 450; l <= 650; l += 100) {
        seen(stack[1], l, c[1], "u"); mirrored = R; passed = T
        seen(stack[2], l, c[2], "u")
        is("S0." l ",000000nm", 2 * (mirrored + passed * T), 1e-5)
      }'
  done
}

@test "a bubble, of paths that end at once or at the first film" {
  bubble 'LightSource "infinite" "float L" 2' >scene.pbrt
  folding=("${gravity[@]}")
  sed -i 's/maxdepth" 200/maxdepth" 0/' scene.pbrt
  both
  cmp a.1.spd b.1.spd
  statistics "$inside" | awk '$2 != "beside" && $4 != 0 { exit 1 }'
  sed -i 's/maxdepth" 0/maxdepth" 1/' scene.pbrt
  both --spp 16
  agree "$inside"
  render --defer film scene.pbrt -o layers.exr
  fold folded.exr "${folding[@]}" <layers.exr
  pixel_holds layers.exr folded.exr 13,22 '
    stack = sprintf("air | 1.33 %.9gnm | air", 530 * (730 / 530) ^ (1 - from["film1.Q.Z"]))
    for (l = 450; l <= 650; l += 100) {
      seen(stack, l, from["film1.cosine"], "u")
      is("S0." l ",000000nm", 2 * R, 1e-5)
    }'
}

@test "a ball of metal with a film on it mirrors the light, and what is behind it is not there" {
  stack='air | 1.5 200nm | 0.5+3i'
  bubble "$(walls)" | sed 's/"string thickness".*//; s/air | 1.33 [*] | air/'"$stack/" >scene.pbrt
  folding=(--stack "$stack")
  for more in '--films 1' '--films 2'; do
    # shellcheck disable=SC2086 # words
    render --defer film $more scene.pbrt | fold b.exr "${folding[@]}"
    render scene.pbrt -o a.exr
    for pixel in 16,16 8,12 13,22 20,7 2,2; do
      # no way is chosen: the light goes one alone
      pixel_holds a.exr b.exr $pixel 'for (l = 450; l <= 650; l += 100) is("S0." l ",000000nm", from["S0." l ",000000nm"], 3e-6)'
    done
  done
  bubble 'LightSource "infinite" "float L" 2' | sed 's/"string thickness".*//; s/air | 1.33 [*] | air/'"$stack/" >scene.pbrt
  render scene.pbrt -o a.exr
  render --gbuffer scene.pbrt -o geometry.exr
  for pixel in 16,16 8,12 13,22 20,7; do
    pixel_holds geometry.exr a.exr $pixel '
      for (l = 450; l <= 650; l += 100) { seen("'"$stack"'", l, from["cosine"], "u"); is("S0." l ",000000nm", 2 * R, 1e-5) }'
  done
}

# Films one behind the other, each with a stack of its own by its id.

row=('air | 1.33 300nm | air' 'air | 1.38 120nm | 1.5' '1.5 | 2.3+0.2i 40nm | 1.2')

# panes FOV: three plane films, all turned so that what they mirror goes past the others.
panes() {
  local i
  cat <<END
Camera "perspective" "float fov" $1
Film "rgb" "integer xresolution" 8 "integer yresolution" 8
Sampler "independent" "integer pixelsamples" 1
WorldBegin
LightSource "infinite" "spectrum L" [ 300 .6 800 1.6 ]
END
  for i in 0 1 2; do
    cat <<END
AttributeBegin
  Material "thinfilm" "integer id" $((10 + i)) "string stack" "${row[i]}"
  Translate 0 0 $((2 + i))
  Rotate $((140 + 5 * i)) 1 0 0
  Shape "trianglemesh" "integer indices" [ 0 1 2 0 2 3 ] "point3 P" [ -.5 -.5 0  .5 -.5 0  .5 .5 0  -.5 .5 0 ]
AttributeEnd
END
  done
}

@test "three films one behind the other, folded, are what Airy says in each pixel" {
  panes 10 >scene.pbrt
  render --defer film --films 3 scene.pbrt -o layers.exr
  fold folded.exr --stack "${row[0]}" --mask 10 --stack "${row[1]}" --mask 11 --stack "${row[2]}" --mask 12 <layers.exr
  for pixel in 0,0 3,4 7,7; do
    pixel_holds layers.exr folded.exr $pixel '
      on[1] = "'"${row[0]}"'"; on[2] = "'"${row[1]}"'"; on[3] = "'"${row[2]}"'"
      for (l = 450; l <= 650; l += 100) {
        L = l / 500
        for (film = 3; film >= 1; film--) {
          if (from["film" film ".id"] != 9 + film || from["film" film ".cover"] != 1) wrong("film " film)
          angle = (40 - 5 * (film - 1)) * pi / 180
          cosine = from["film1.I.Y"] * -sin(angle) - from["film1.I.Z"] * cos(angle)
          seen(on[film], l, cosine, "u"); L = T * L + R * l / 500
        }
        is("S0." l ",000000nm", L, 3e-6)
      }'
  done
}

@test "of three films one, two or all are deferred: it is all the same, and as without" {
  panes 0.05 >scene.pbrt
  for films in 1 2 3; do
    folding=(--stack "${row[0]}" --mask 10)
    [ $films = 1 ] || folding+=(--stack "${row[1]}" --mask 11)
    [ $films -lt 3 ] || folding+=(--stack "${row[2]}" --mask 12)
    for ((i = 1; i <= seeds; i++)); do
      [ $films != 1 ] || render --seed "$i" --spp 64 scene.pbrt -o "a.$i.exr"
      render --seed "$i" --spp 64 --defer film --films $films scene.pbrt | fold "b.$i.exr" "${folding[@]}"
    done
    text a.?.exr b.?.exr
    agree
  done
}

# Discs: a compact disc at the origin, z is up.

# disc LINE...: seen from above; the picture is of 24 x 16 pixels. LINE...: what else there is.
disc() {
  cat <<END
LookAt ${eye:-0 -.25 .25}  0 0 0  0 0 1
Camera "perspective" "float fov" 20
Film "rgb" "integer xresolution" 24 "integer yresolution" 16
Sampler "independent" "integer pixelsamples" 1
WorldBegin
AttributeBegin
Material "diffractive" "string preset" "cd" "integer id" 5
Shape "disk" "float radius" .058 "float innerradius" .025
AttributeEnd
END
  printf '%s\n' "$@"
}

lamp1='LightSource "point" "point3 from" [ .1 .2 .4 ] "spectrum I" [ 380 1.9 780 3.9 ]' # nm / 200
lamp2='LightSource "distant" "point3 from" [ -.2 .1 .3 ] "point3 to" [ 0 0 0 ] "float L" 20'
ball='AttributeBegin Translate .01 .055 .05 Material "diffuse" "float reflectance" 0
  Shape "sphere" "float radius" .02 AttributeEnd'
floor='AttributeBegin Translate 0 0 -.02 Material "diffuse" "float reflectance" .5
  Shape "disk" "float radius" .3 AttributeEnd'
bands=(--grid 400:700:20)
functions+='
  function bins(  j) { find_bands("^S0[.]"); for (j = 0; j <= bands; j++) edge[j] = 390 + 20 * j }
'

discs() {
  specrender --no-history -q "${bands[@]}" "$@"
}

# same A B: two texts of pixels are the same up to what rounding directions to float does: theta off
# the mirror direction, the highlight of T's exponent 10000 changes by 10000 tan(theta) of what they
# do, which are some 1e-7; and theta is 0.03 where it is last seen.
same() {
  awk "$statements"'
    FNR == 1 { file++ }
    /^#/ { next }
    file == 1 { for (i = 2; i <= NF; i++) a[$1, i] = $i; next }
    { for (i = 2; i <= NF; i++) { numbers++; if (size(a[$1, i] - $i) > 2e-5 * size($i) + 1e-9) wrong($1 " nm, pixel " i - 2 ": " a[$1, i] " and " $i) } }
    END { if (numbers != 16 * 24 * 16) wrong(numbers " numbers"); exit failed }' "$1" "$2" >said || complain "$(head said)"
}

@test "what is handed over of a disc and its lamps, in each pixel that shows it" {
  disc "$lamp1" "$lamp2" >scene.pbrt
  discs --defer disc scene.pbrt -o layers.exr
  seen=0
  for y in 2 4 7 9 11; do
    for x in 5 8 11 14 18; do
      pixel_holds layers.exr layers.exr $x,$y '
        if (to["cover"] == 0) {
          for (name in to) if (to[name] != 0) wrong(name " beside the disc")
          exit
        }
        print "seen" >"seen"
        for (name in to) if (name ~ /^S0/ && to[name] != 0) wrong(name)
        px = to["P.X"]; py = to["P.Y"]; r = sqrt(px ^ 2 + py ^ 2)
        if (!(r > 0.025 && r < 0.058) || to["P.Z"] != 0) wrong("not on the disc")
        is("cover", 1); is("id", 5)
        is("N.X", 0); is("N.Y", 0); is("N.Z", 1); is("Ns.X", 0); is("Ns.Y", 0); is("Ns.Z", 1)
        is("Tan.X", -py / r); is("Tan.Y", px / r); is("Tan.Z", 0)
        s = sqrt(px ^ 2 + (-0.25 - py) ^ 2 + 0.25 ^ 2)
        is("I.X", -px / s); is("I.Y", (-0.25 - py) / s); is("I.Z", 0.25 / s); is("cosine", 0.25 / s)
        # where it stands in the picture: the eye looks along (0, 1, -1), x goes to the left
        depth = (py + 0.25 + 0.25) / sqrt(2); scale = 8 / (depth * sin(pi / 18) / cos(pi / 18))
        if (int(12 - px * scale) != '$x' || int(8 - (py + 0.25 - 0.25) / sqrt(2) * scale) != '$y') wrong("another pixel")
        s = sqrt((0.1 - px) ^ 2 + (0.2 - py) ^ 2 + 0.4 ^ 2)
        is("lamp1.D.X", (0.1 - px) / s); is("lamp1.D.Y", (0.2 - py) / s); is("lamp1.D.Z", 0.4 / s)
        s2 = sqrt(0.14)
        is("lamp2.D.X", -0.2 / s2); is("lamp2.D.Y", 0.1 / s2); is("lamp2.D.Z", 0.3 / s2)
        for (name in to) {
          if (name ~ /^lamp1.S0/) is(name, wavelength(name) / 200 / s ^ 2)
          if (name ~ /^lamp2.S0/) is(name, 20)
        }'
      [ ! -e seen ] || seen=$((seen + 1))
      rm -f seen
    done
  done
  [ $seen -ge 12 ] || complain "$seen pixels"
}

@test "a disc under a lamp is T's model in each pixel, rendered and folded" {
  for lamp in "$lamp1" "$lamp2"; do
    disc "$lamp" >scene.pbrt
    discs scene.pbrt -o rendered.exr
    discs --defer disc scene.pbrt -o layers.exr
    specdisc layers.exr -o folded.exr
    for pixel in 10,4 16,5 6,7 18,8 8,11 15,12; do
      for image in rendered folded; do
        pixel_holds layers.exr $image.exr $pixel 'disc("cd"); bins(); adds(0); if (lit == 0) wrong("nothing to see")'
      done
    done
  done
}

@test "a disc under one lamp is the same rendered and folded, with and without a shadow" {
  for lamp in "$lamp1" "$lamp2"; do
    for more in '' "$ball" "$floor" "$ball $floor"; do
      disc "$lamp" "$more" >scene.pbrt
      for seed in 1 2; do
        discs --seed $seed scene.pbrt -o a.exr
        discs --seed $seed --defer disc scene.pbrt | specdisc -o b.exr
        text a.exr b.exr
        same a.spd b.spd
      done
    done
  done
}

@test "a ball's shadow on a disc is where straight lines to the lamp say" {
  disc "$lamp1" "$ball" >scene.pbrt
  discs --size 48x32 --grid 500:500:1 --defer disc scene.pbrt -o layers.exr
  for y in 7 10 13 16; do
    for x in 13 16 19 22 25 28 31 34; do
      pixel_holds layers.exr layers.exr $x,$y '
        if (to["cover"] == 0) exit
        px = to["P.X"]; py = to["P.Y"]; dx = 0.1 - px; dy = 0.2 - py; dz = 0.4
        t = ((0.01 - px) * dx + (0.055 - py) * dy + 0.05 * dz) / (dx ^ 2 + dy ^ 2 + dz ^ 2)
        off = sqrt((px + t * dx - 0.01) ^ 2 + (py + t * dy - 0.055) ^ 2 + (t * dz - 0.05) ^ 2)
        dark = to["lamp1.S0.500,000000nm"] == 0
        if (near(off, 0.02, 1e-4)) exit
        if (dark != (off < 0.02)) wrong("passes the ball at " off " m, light " to["lamp1.S0.500,000000nm"])
        print dark >"seen"'
      [ ! -e seen ] || cat seen >>shadows
      rm -f seen
    done
  done
  [[ $(grep -c 1 shadows) -ge 4 && $(grep -c 0 shadows) -ge 8 ]] || complain "$(sort shadows | uniq -c)"
}

@test "a disc under two lamps, folded, is the sum of what each makes of it" {
  for lamp in 1 2; do
    [ $lamp = 1 ] && disc "$lamp1" "$ball" >scene.pbrt || disc "$lamp2" "$ball" >scene.pbrt
    discs scene.pbrt -o $lamp.exr
  done
  disc "$lamp1" "$lamp2" "$ball" >scene.pbrt
  discs --defer disc scene.pbrt | specdisc -o b.exr
  text 1.exr 2.exr b.exr
  paste -d ' ' 1.spd 2.spd | awk '
    /^#/ { print "#"; next }
    { half = NF / 2; printf "%s", $1; for (i = 2; i <= half; i++) printf " %.9g", $i + $(half + i); print "" }' >sum.spd
  same sum.spd b.spd
}

@test "a disc seen from behind is dark, rendered and folded" {
  eye='0 -.25 -.25'
  disc "$lamp1" "LightSource \"point\" \"float I\" 1 \"point3 from\" [ .1 .1 -.3 ]" >scene.pbrt
  discs --defer disc scene.pbrt | specdisc -o b.exr
  discs scene.pbrt -o a.exr
  text a.exr b.exr
  awk '!/^#/ { for (i = 2; i <= NF; i++) if ($i != 0) exit 1 }' b.spd
  same a.spd b.spd
}

# discs_agree DEFER TOOL...: as agree, of 16 renders each, where 64 samples of a pixel are 64 pixels of
# their own. What a disc sends to the eye is strong in few places, so that all of it is one cell.
discs_agree() {
  local i
  seeds=16
  for ((i = 1; i <= seeds; i++)); do
    discs --seed "$i" --supersample 8 scene.pbrt | specconvert --downsample 8 -o "a.$i.exr"
    discs --seed "$i" --supersample 8 --defer "$1" scene.pbrt | "${@:2}" | specconvert --downsample 8 -o "b.$i.exr"
  done
  text a.*.exr b.*.exr
  agree 'd = sqrt((x - 11.5) ^ 2 + ((y - 7.5) * 1.4) ^ 2); if (d > 3 && d < 9) cell = "disc"; else cell = "beside"'
}

@test "a disc under two lamps and a sky, on a floor and beside a ball, as a mean" {
  bands=(--grid 450:650:100)
  disc "$lamp1" "$lamp2" "$ball" "$floor" 'LightSource "infinite" "float L" 1' >scene.pbrt
  discs_agree disc specdisc
}

@test "a disc behind a film: films and discs are folded one after the other, in either order" {
  bands=(--grid 450:650:100)
  disc "$lamp1" "$lamp2" "$floor" 'LightSource "infinite" "float L" 1' "
    Translate -.03 .01 .05
    Material \"thinfilm\" \"string stack\" \"$soap\"
    Shape \"sphere\" \"float radius\" .03" >scene.pbrt
  film_and_disc() { specfilm --stack "$soap" | specdisc; }
  discs_agree film,disc film_and_disc
  discs --defer film,disc scene.pbrt | film_and_disc | specconvert -o c.exr
  discs --defer disc,film scene.pbrt | specdisc | specfilm --stack "$soap" -o d.exr
  text c.exr d.exr
  cmp c.spd d.spd
}

@test "what else is in a pixel does not change a disc, with --gbuffer and without" {
  disc "$lamp1" "$floor" >scene.pbrt
  discs --spp 16 --defer disc scene.pbrt | specdisc -o a.exr
  discs --spp 16 --defer disc --gbuffer scene.pbrt | specdisc -o b.exr
  text a.exr b.exr
  same a.spd b.spd
}
