# shellcheck shell=bash disable=SC2016
title 'What a viewer shows of the data, and all that is around'
from 'W 4.1, equation 55 and figure 18 (Schiffner 2008)'
note 'Which way a surface faces, its texture coordinates, and the ways to the eye and to the lamp, are channels that specrender leaves beside the light. Directions are drawn as n/2 + 1/2 and can be read off the picture again. Surroundings are six faces of a cube in one of two crosses, or latitude and longitude.'

cp "$here/views.pbrt" .
run 'specrender views.pbrt --grid 500:700:100 --size 288x216 --spp 9 --defer disc --gbuffer -o large.exr'
for view in 'N which way it faces' 'uv texture coordinates' 'I the way to the eye' 'lamp1.D the way to the lamp'; do
  name=${view%% *}
  picture "$name.png" "spec2rgb --layer $name large.exr -o $name.png" "${view#* }"
done
picture cosine.png 'spec2rgb --layer cosine --range 0..1 --legend large.exr -o cosine.png' 'how much it faces the eye, in false colours'

# Of one point in each pixel all is known.
run 'specrender views.pbrt --grid 500:700:100 --size 72x54 --defer disc --gbuffer -o views.exr
for layer in N uv I lamp1.D; do spec2rgb --layer $layer views.exr -o $layer.ppm; done
specdisc views.exr -o disc.exr
specinfo --probe 30,30 disc.exr'
probed=$(awk '/^# channel N[.]/ { print $4 }' <<<"$printed" | xargs)

# table FILE: the three bands of all pixels, a pixel on each line.
table() {
  specconvert -f spd "$1" | awk '
    /^[0-9]/ { bands++; most = NF; for (i = 2; i <= NF; i++) pixel[i] = pixel[i] (bands > 1 ? " " : "") $i }
    END { for (i = 2; i <= most; i++) print pixel[i] }'
}
# numbers FILE A B C: the same of channels.
numbers() {
  speccomp --expr "nm == 500 ? a.$2 : nm == 600 ? a.$3 : a.$4" "$1" -o numbers.exr
  table numbers.exr
}

numbers disc.exr P.X P.Y P.Z >place
numbers disc.exr cover cover cover >covered
# What these directions are, from the place of each point alone: the ball stands at 0 0 .08, the eye
# is at .3 -.5 .4, the lamp at -.1 -.3 .4. u and v are pbrt's: the turn around z, and from the rim of
# the table inwards or from below upwards. The same lines as the picture, or "-" where nothing is.
paste -d ' ' place covered | awk '
  function unit(x, y, z, l) { l = sqrt(x * x + y * y + z * z); return sprintf("%.9g %.9g %.9g", x / l, y / l, z / l) }
  BEGIN { pi = atan2(0, -1) }
  $4 == 0 { print "-" >"want.N"; print "-" >"want.I"; print "-" >"want.lamp1.D"; print "-" >"want.uv"; next }
  {
    ball = $3 > 1e-6
    print ball ? unit($1, $2, $3 - .08) : "0 0 1" >"want.N"
    print unit(.3 - $1, -.5 - $2, .4 - $3) >"want.I"
    print unit(-.1 - $1, -.3 - $2, .4 - $3) >"want.lamp1.D"
    u = atan2($2, $1) / (2 * pi)
    z = ($3 - .08) / .08
    v = ball ? 1 - atan2(sqrt($1 * $1 + $2 * $2), $3 - .08) / pi : 1 - sqrt($1 * $1 + $2 * $2) / .2
    print 2 * (u < 0 ? u + 1 : u) - 1, 2 * v - 1, -1 >"want.uv"
  }'
check 'points of the table and the ball' "$(grep -vcx -e - want.uv)" at-least 1500
# apart A B: the largest difference of two files of numbers, where there is something.
apart() {
  paste -d ' ' "$1" "$2" | awk '$1 != "-" { print $1 - $4, $2 - $5, $3 - $6 }' | largest
}
for name in N I lamp1.D uv; do
  # A PPM's bytes behind its header, a pixel on each line.
  tail -c $((3 * 72 * 54)) $name.ppm | od -A n -v -t u1 -w3 |
    awk '{ print 2 * $1 / 255 - 1, 2 * $2 / 255 - 1, 2 * $3 / 255 - 1 }' >$name.codes
  # half a step of a code, which is 1/255 of what is shown, and a rounding
  check "$name, from codes: 2 c / 255 - 1, largest error" "$(apart want.$name $name.codes)" at-most 0.003922
done
run 'specconvert --vectors N N.ppm -o back.exr
speccomp --expr "nm == 500 ? b.N.X : nm == 600 ? b.N.Y : b.N.Z" disc.exr back.exr -o normals.exr'
table normals.exr >back
check 'N, made channels again: largest error' "$(apart want.N back)" at-most 0.003922
check 'the probe at 30,30: N' "$probed" equals "$(numbers disc.exr N.X N.Y N.Z | sed -n $((30 * 72 + 31))p)"

# All that is around: hills under a sky with a sun, latitude and longitude.
run 'specconvert D65 D65 --grid 400:700:50 --patches 2x1 --patch 256 -o plain.exr'
picture around.png 'speccomp --expr "
    t = pi * (y + 0.5) / height; p = 2 * pi * (x + 0.5) / width;
    dx = sin(t) * cos(p); dy = sin(t) * sin(p); dz = cos(t);
    hill = 0.12 + 0.08 * sin(3 * p) + 0.05 * sin(7 * p + 1) + 0.02 * sin(17 * p);
    ground = 1 / (1 + exp(80 * (dz - hill)));
    sky = (0.25 + 0.5 * (1 - dz) ^ 3) * (500 / nm) ^ (3 * dz + 1);
    sun = 5 * exp(400 * (0.8 * dx + 0.36 * dy + 0.48 * dz - 1)) * nm / 550;
    land = (0.1 + 0.05 * sin(9 * dx + 14 * dy)) * exp(0 - ((nm - 560) / 60) ^ 2) + 0.03;
    ground * land + (1 - ground) * (sky + sun)" plain.exr -o around.exr
spec2rgb -e 0.5 around.exr -o around.png' 'latitude and longitude: x at the left and right sides, y at a quarter'
picture tall.png 'specconvert --projection tall-cross:256 around.exr -o tall.exr
spec2rgb -e 0.5 tall.exr -o tall.png' 'the faces of a cube, higher than wide: what is behind is upside down below'
picture cross.png 'specconvert --projection cross:192 around.exr -o cross.exr
spec2rgb -e 0.5 cross.exr -o cross.png' 'and wider than high'
picture square.png 'specconvert --projection octahedral around.exr -o square.exr
spec2rgb -e 0.5 square.exr -o square.png' "pbrt-v4's square of equal areas"

# Each face is what a camera sees that looks along its axis, 90 degrees wide, in light from all
# around. NAME, LOOK and UP, and the corners of the face in each cross.
while read -r name look up cross tall; do
  cat >face.pbrt <<END
LookAt 0 0 0  ${look//,/ }  ${up//,/ }
Camera "perspective" "float fov" 90
Film "rgb" "integer xresolution" 64 "integer yresolution" 64
WorldBegin
LightSource "infinite" "string filename" "around.exr"
END
  specrender face.pbrt --grid 400:700:50 --spp 36 -o seen.exr
  for corner in "cross,$cross" "tall,$tall"; do
    IFS=, read -r layout x y <<<"$corner"
    specconvert --crop "$x,$y,$((x + 64)),$((y + 64))" "$layout.exr" | specconvert -f spd |
      paste -d ' ' - <(specconvert -f spd seen.exr) | awk -v name="$name" -v turned="$([ "$layout$name" = tall-x ] && echo 1)" '
        /^[0-9]/ {
          n = NF / 2
          for (i = 2; i <= n; i++) {
            a = $i; b = turned ? $(2 * n - i + 2) : $(n + i)
            off += (a - b) ^ 2; all += a * a
          }
        }
        END { printf "%.4g\n", sqrt(off / all) }' >>"faces.$layout"
  done
done <<'END'
x 1,0,0 0,0,1 64,64 64,64
y 0,1,0 0,0,1 128,64 128,64
-x -1,0,0 0,0,1 192,64 64,192
-y 0,-1,0 0,0,1 0,64 0,64
z 0,0,1 -1,0,0 64,0 64,0
-z 0,0,-1 1,0,0 64,128 64,128
END
check 'faces' "$(cat faces.cross faces.tall | wc -l)" equals 12
# The light of 36 random places in a pixel and that of 16 regular ones, both linear between the same
# pixels; a face that is turned or elsewhere is off by more than half.
check 'the faces of the cross and six pictures of a camera: rms of the difference over rms, largest' "$(largest <faces.cross)" at-most 0.005
check 'and of the tall cross' "$(largest <faces.tall)" at-most 0.005

# And back: what is lost is what lies between the pixels, most of all at the hills' rim.
for layout in tall cross square; do
  run "specconvert --projection latlong:256 $layout.exr | specdiff -m rmse,energy -t rmse=1 around.exr -"
  check "$layout and back: rms difference, of a radiance of about 0.3" "$(awk '$1 == "rmse" { print $2 }' <<<"$printed")" at-most 0.02
  check "$layout and back: energy" "$(awk '$1 == "energy" { print $2 }' <<<"$printed")" within 0 0.001
done
