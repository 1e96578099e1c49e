#!/usr/bin/env bats
# specconvert --projection: what is all around, laid out anew.
# shellcheck disable=SC2154 # fails_cleanly leaves its line in stderr

load common

# sky FILE HEIGHT: latitude and longitude; a radiance of 1 + x/8 + y/4 + z/2 in each direction.
sky() {
  spectral grid.exr --size $((2 * $2))"x$2" --grid 400:700:100 --pattern constant:1
  speccomp --expr 't = pi * (y + 0.5) / height; p = 2 * pi * (x + 0.5) / width;
    nm / 400 * (1 + sin(t) * cos(p) / 8 + sin(t) * sin(p) / 4 + cos(t) / 2)' grid.exr -o "$1"
}

# shows FILE X,Y A,B,C: the band at 400 nm has what the sky sends from that direction, within 0.2 %.
shows() {
  "$TESTS/layers" --print "$2" "$1" | awk -v of="$3" '
    /^S0[.]400/ {
      split(of, d, ",")
      want = 1 + (d[1] / 8 + d[2] / 4 + d[3] / 2) / sqrt(d[1] ^ 2 + d[2] ^ 2 + d[3] ^ 2)
      off = $2 / want - 1
      if (off * off > 4e-6) print "'"$1 $2"'", $2, "instead of", want
      else found = 1
    }
    END { exit !found }' || complain "$1 $2"
}

@test "faces are where they belong, and show what they should" {
  sky ll.exr 64
  specconvert --projection cross ll.exr -o cross.exr
  specinfo cross.exr | grep -q 'size *128 x 96 pixels' || complain "$(specinfo cross.exr)"
  # near the middles of faces: half a pixel to the right of and below them
  shows cross.exr 48,48 32,1,-1     # +x
  shows cross.exr 80,48 -1,32,-1    # +y
  shows cross.exr 112,48 -32,-1,-1  # -x
  shows cross.exr 16,48 1,-32,-1    # -y
  shows cross.exr 48,16 1,1,32      # +z
  shows cross.exr 48,80 -1,1,-32    # -z
  # and their corners
  shows cross.exr 63,32 32,31,31
  shows cross.exr 64,32 31,32,31
  shows cross.exr 32,31 31,-31,32
  for place in 0,0 70,10 127,95; do
    [ "$("$TESTS/layers" --print $place cross.exr | awk '{ print $2 }' | sort -u)" = 0 ] || complain $place
  done
  specconvert --projection tall-cross:128 cross.exr -o tall.exr
  specinfo tall.exr | grep -q 'size *96 x 128 pixels'
  shows tall.exr 48,48 32,1,-1
  shows tall.exr 48,112 -32,1,1 # upside down
  shows tall.exr 80,48 -1,32,-1
  specconvert --projection octahedral tall.exr -o square.exr
  specinfo square.exr | grep -q 'size *73 x 73 pixels'
  shows square.exr 36,36 0,0,1
  shows square.exr 45,45 0.4622,0.4622,0.7568
  shows square.exr 27,45 -0.4622,0.4622,0.7568
}

@test "there and back: all four layouts hold what is all around" {
  sky ll.exr 64
  local way most
  for way in cross tall-cross octahedral latlong; do
    specconvert --projection $way ll.exr | specconvert --projection latlong:64 -o back.exr
    # linear between pixels of 2.8 degrees, twice; the square has edges in its middle
    [ $way = octahedral ] && most=0.02 || most=0.004
    specdiff -m max -t max="$most" ll.exr back.exr || complain "$way"
  done
}

@test "light of one colour stays what it is, to the corners" {
  spectral one.exr --size 32x16 --grid 400:500:100 --pattern constant:0.7
  specconvert --projection cross one.exr | specconvert --projection octahedral | specconvert --projection tall-cross |
    specconvert --projection latlong:16 -o back.exr
  specdiff -m max -t max=1e-6 one.exr back.exr
}

@test "other channels come along, whole numbers as they are" {
  spectral id.exr --size 32x16 --grid 400:500:100 --uint-id --attribute envmap=latlong --attribute owner=nobody
  specconvert --projection latlong id.exr -o same.exr
  for place in 0,0 5,7 31,15; do
    [ "$("$TESTS/layers" --print $place same.exr | grep '^id ')" = "$("$TESTS/layers" --print $place id.exr | grep '^id ')" ]
  done
  has_line same.exr 'owner (type string): "nobody"'
  [[ $(exrheader same.exr) != *envmap\ * ]] # which would be another shape's
  has_channels same.exr S0.400,000000nm S0.500,000000nm id
  specconvert --projection cross --half id.exr -o cross.exr
  [ "$(exrheader cross.exr | grep -c '^    S0.*16-bit')" -eq 2 ]
  [ "$("$TESTS/layers" --print 0,0 cross.exr | grep '^id ')" = 'id 0' ]
  has_line same.exr 'displayWindow (type box2i): (0 0) - (31 15)'
  spectral far.exr --size 8x4 --data -3,5 --display -10,-10,90,90 --grid 500:500:1
  exrstdattr -pixelAspectRatio 2 far.exr wide.exr
  specconvert --projection latlong wide.exr -o home.exr
  has_line home.exr 'dataWindow (type box2i): (0 0) - (7 3)'
  has_line home.exr 'displayWindow (type box2i): (0 0) - (7 3)'
  has_line home.exr 'pixelAspectRatio (type float): 1'
}

@test "a pixel is the mean of 4 x 4 places, between which the input is linear, across the pole too" {
  spectral one.exr --size 8x4 --grid 500:500:1 --pattern constant:1
  speccomp --expr 'x == 2' one.exr -o column.exr
  specconvert --projection latlong:2 column.exr -o half.exr
  # At .25, .75, 1.25 and 1.75 pixels two columns have 7/16 each and those beside them 1/16; so have
  # rows, of which the one beyond the pole is half around.
  for pixel in '1,0 7/16*15/16' '0,0 1/16*15/16' '3,1 7/16*1/16' '2,0 1/16*1/16' '1,1 7/16*15/16'; do
    pixel_holds half.exr half.exr "${pixel% *}" 'is("S0.500,000000nm", '"${pixel#* }"')'
  done
}

@test "a pipe and any number of threads have the same image" {
  sky ll.exr 16
  specconvert --no-history --compression none --projection cross ll.exr -o cross.exr
  cat ll.exr | specconvert --no-history --projection cross | cmp - cross.exr
  specconvert -j 1 --no-history --compression none --projection cross -o one.exr ll.exr
  specconvert -j 3 --no-history --compression none --projection cross -o three.exr ll.exr
  cmp one.exr cross.exr
  cmp three.exr cross.exr
}

@test "what cannot be laid out is refused" {
  sky ll.exr 16
  spectral odd.exr --size 17x8
  fails_cleanly specconvert --projection cross odd.exr -o x.exr
  [[ $stderr = *'odd.exr: 17 x 8 pixels: what is all around has 2:1 (latlong)'* ]] || complain "$stderr"
  spectral stokes.exr --kind stokes --size 16x8
  fails_cleanly specconvert --projection cross stokes.exr -o x.exr
  [[ $stderr = *'stokes.exr: is polarised'* ]]
  fails_cleanly specconvert --projection cube ll.exr -o x.exr
  fails_cleanly specconvert --projection cross:100 ll.exr -o x.exr
  fails_cleanly specconvert --projection latlong:0 ll.exr -o x.exr
  fails_cleanly specconvert --projection cross --scale 2 ll.exr -o x.exr
  fails_cleanly specconvert --projection cross --crop 0,0,4,4 ll.exr -o x.exr
  fails_cleanly specconvert --projection cross ll.exr -f spd
  fails_cleanly specconvert --projection cross --to fourier:3 ll.exr -o x.exr
  fails_cleanly specconvert --projection cross --from-rgb basis ll.exr -o x.exr
  fails_cleanly specconvert --projection cross D65 -o x.exr
  fails_cleanly specconvert --projection cross --limit memory=8k ll.exr -o x.exr
  [[ $stderr = *'--limit memory'* ]] || complain "$stderr"
  spectral high.exr --size 256x128 --grid 500:500:1
  fails_cleanly specconvert -j 1 --projection cross --limit memory=100k high.exr -o x.exr
  [[ $stderr = *'high.exr: 256 x 128 pixels of 1 channels take more than the limit of 102400 bytes'* ]] || complain "$stderr"
  rm high.exr
  fails_cleanly specconvert --projection cross:65535 ll.exr -o x.exr
  [[ $stderr = *'would become 87380 x 65535 pixels, more than the limit of 1073741824 (--limit pixels'* ]] || complain "$stderr"
  specconvert --compression none ll.exr -o flat.exr
  head -c 5000 flat.exr >short.exr
  fails_cleanly specconvert --projection cross short.exr -o x.exr
  fails_cleanly specconvert --projection cross -o x.exr < <(cat short.exr)
  no_leftovers . grid.exr ll.exr odd.exr stokes.exr flat.exr short.exr
}
