#!/usr/bin/env bats
# tests/helper/layers makes what its first lines promise: the tests of other programs compute
# their answers from those. Here they are computed again, by awk.

load common

# holds FILE X,Y AWK: the statements hold for that pixel, v[CHANNEL] being its values.
#   is(CHANNEL, NUMBER) and are(CHANNELS, X, Y, Z): has this value, these in .X, .Y, .Z
#   lawful(PREFIX): N and I are unit vectors, Ns is N, cosine is N.I
#   sky_of(PREFIX): what the sky is along the mirror direction of N and I as they stand in v
#   dark(PREFIX): every channel of that prefix is 0
holds() {
  layers --print "$2" "$1" >pixel
  awk '
    function wrong(text) { print text; failed = 1 }
    function off(a, b) { return (a > b ? a - b : b - a) > 2e-7 * (1 + (b < 0 ? -b : b)) }
    function is(name, want) {
      if (!(name in v)) wrong("no channel " name)
      else if (off(v[name], want)) wrong(name " is " v[name] " instead of " want)
    }
    function are(name, x, y, z) { is(name ".X", x); is(name ".Y", y); is(name ".Z", z) }
    function dot(a, b) {
      return v[a ".X"] * v[b ".X"] + v[a ".Y"] * v[b ".Y"] + v[a ".Z"] * v[b ".Z"]
    }
    function lawful(p) {
      if (off(dot(p "N", p "N"), 1)) wrong(p "N is not a unit vector")
      if (off(dot(p "I", p "I"), 1)) wrong(p "I is not a unit vector")
      are(p "Ns", v[p "N.X"], v[p "N.Y"], v[p "N.Z"])
      is(p "cosine", dot(p "Ns", p "I"))
    }
    function sky(x, y, z) { return 1 + x / 8 + y / 4 + z / 2 }
    function sky_of(p,  c) {
      c = 2 * dot(p "N", p "I")
      return sky(c * v[p "N.X"] - v[p "I.X"], c * v[p "N.Y"] - v[p "I.Y"], c * v[p "N.Z"] - v[p "I.Z"])
    }
    function dark(p,  name) {
      for (name in v) if (index(name, p) == 1 && v[name] + 0 != 0) wrong(name " is not 0")
    }
    { v[$1] = $2; lines++ }
    END {
      pi = atan2(0, -1)
      if (!lines) wrong("no channels")
      '"$3"'
      exit failed
    }' pixel >said || complain "$1, pixel $2:" "$(cat said)"
}

# grain X Y BAND C: G(C) of the text in layers.c.
grain() {
  local n=$((($2 << 32) + ($1 << 16) + $3 + 1024 * $4)) z
  z=$((n + 0x9e3779b97f4a7c15))
  z=$(((z ^ (z >> 30 & 0x3ffffffff)) * 0xbf58476d1ce4e5b9))
  z=$(((z ^ (z >> 27 & 0x1fffffffff)) * 0x94d049bb133111eb))
  z=$((z ^ (z >> 31 & 0x1ffffffff)))
  awk -v x="$1" -v y="$2" -v band="$3" -v noise=$((z >> 40 & 0xffffff)) 'BEGIN {
    printf "%.12g\n", (0.25 + (x + y) / 8192 + band / 512) * (1 + noise / 2 ^ 24 / 8) }'
}

# The scenes

@test "a film has the channels of specexr(5), all FLOAT but id" {
  layers --grid 550:550:1 -o a.exr
  [ "$(channels a.exr | xargs)" = "S0.550,000000nm film1.I.X film1.I.Y film1.I.Z film1.N.X \
film1.N.Y film1.N.Z film1.Ns.X film1.Ns.Y film1.Ns.Z film1.P.X film1.P.Y film1.P.Z film1.Q.X \
film1.Q.Y film1.Q.Z film1.cosine film1.cover film1.id film1.mirror.S0.550,000000nm \
through.S0.550,000000nm" ] || complain "$(channels a.exr)"
  [ "$(exrheader a.exr | grep -c '32-bit floating-point')" -eq 20 ]
  exrheader a.exr | grep -q '^    film1.id, 32-bit unsigned integer'
  layers --scene disc --grid 550:550:1 --lamp 1,1,1 --lamp 1,2,1 -o b.exr
  [ "$(channels b.exr | xargs)" = "I.X I.Y I.Z N.X N.Y N.Z Ns.X Ns.Y Ns.Z P.X P.Y P.Z Q.X Q.Y Q.Z \
S0.550,000000nm Tan.X Tan.Y Tan.Z cosine cover id lamp1.D.X lamp1.D.Y lamp1.D.Z \
lamp1.S0.550,000000nm lamp2.D.X lamp2.D.Y lamp2.D.Z lamp2.S0.550,000000nm" ] ||
    complain "$(channels b.exr)"
}

@test "flat: a plane that faces the eye, or is tilted" {
  layers --size 20x10 --grid 500:600:100 -o a.exr
  holds a.exr 3,2 '
    lawful("film1.")
    is("film1.cosine", 1); is("film1.cover", 1); is("film1.id", 1)
    are("film1.I", 0, 1, 0)
    are("film1.P", (3.5 - 10) / 10, 0, (5 - 2.5) / 10)
    are("film1.Q", 3.5 / 20, 0, 1 - 2.5 / 10)
    is("film1.mirror.S0.500,000000nm", 1); is("through.S0.600,000000nm", 0.25)
    dark("S0.")'
  layers --size 20x10 --grid 500:600:100 --angle -40 --radiance 3 --behind 0.5 --shape ramp -o b.exr
  holds b.exr 19,9 '
    lawful("film1.")
    a = -40 * pi / 180
    is("film1.cosine", cos(a))
    are("film1.N", 0, cos(a), sin(a))
    are("film1.P", 9.5 / 10, 4.5 / 10 * sin(a) / cos(a), -4.5 / 10)
    are("film1.Q", 19.5 / 20, 0.5 / 10, 0.5 / 10)
    is("film1.mirror.S0.500,000000nm", 3 * 500 / 550)
    is("film1.mirror.S0.600,000000nm", 3 * 600 / 550)
    is("through.S0.600,000000nm", 0.5 * 600 / 550)
    dark("S0.")'
  layers --size 20x10 --grid 500:500:1 --angle 40 -o c.exr
  holds c.exr 19,9 'is("film1.Q.Z", 0.05); is("film1.Q.Y", 0.95)'
}

@test "pair: the second film is behind the right half" {
  layers --scene pair --grid 500:500:1 --radiance 2 --behind 0.125 -o a.exr
  holds a.exr 7,4 '
    lawful("film1."); is("film1.id", 3); is("film1.mirror.S0.500,000000nm", 2)
    dark("film2."); dark("S0."); is("through.S0.500,000000nm", 0.125)'
  holds a.exr 8,4 '
    lawful("film1."); is("film1.id", 3); is("film1.mirror.S0.500,000000nm", 2)
    lawful("film2."); is("film2.id", 7); is("film2.mirror.S0.500,000000nm", 1)
    is("film2.cover", 1); is("through.S0.500,000000nm", 0.125); dark("S0.")
    are("film2.P", 0.5 / 8, -0.1, -0.5 / 8); are("film2.Q", 1 / 16, 0, 1 - 4.5 / 8)'
  layers --scene pair --size 3x3 --grid 500:500:1 --samples 6 -o b.exr
  holds b.exr 1,1 '
    is("film1.id", 3); is("film1.cover", 1); is("film2.cover", 0.5); is("film2.id", 7)
    is("film2.mirror.S0.500,000000nm", 0.25); is("film2.P.X", 1 / 12); lawful("film2.")'
}

@test "tilted: a square in perspective, under a sky of known radiance" {
  layers --scene tilted --size 20x10 --grid 500:500:1 --radiance 2 -o a.exr
  for pixel in 0,0 13,2 19,9; do
    holds a.exr $pixel '
      x = '"${pixel%,*}"'; y = '"${pixel#*,}"'
      a = (x + 0.5 - 10) / 10; b = (5 - y - 0.5) / 10; angle = pi / 6
      g = 1 - b * sin(angle) / cos(angle); h = b / g / cos(angle)
      length_of_v = sqrt(a * a + 1 + b * b)
      lawful("film1.")
      are("film1.P", a / g, 1 - 1 / g, b / g)
      are("film1.I", -a / length_of_v, 1 / length_of_v, -b / length_of_v)
      are("film1.N", 0, cos(angle), sin(angle))
      are("film1.Q", 0.5 + a / g / 4, 0.5 - h / 4, 0.5 + h / 4)
      is("film1.mirror.S0.500,000000nm", 2 * sky_of("film1."))
      is("film1.id", 1); is("film1.cover", 1); is("through.S0.500,000000nm", 0.25); dark("S0.")'
  done
}

@test "tilted: beside the square and beyond its horizon is sky" {
  # The horizon is at b = 1 / tan 80 degrees = 0.176, the square's edge at b = 0.117. Of the
  # lines 7, 3 and 0 the middles are at -0.25, 0.15 and 0.45.
  layers --scene tilted --angle 80 --size 20x10 --grid 500:500:1 -o a.exr
  holds a.exr 10,7 'lawful("film1."); is("film1.cover", 1)'
  for y in 0 3; do
    holds a.exr 10,$y '
      b = (4.5 - '$y') / 10; length_of_v = sqrt(0.0025 + 1 + b * b)
      dark("film1."); dark("through.")
      is("S0.500,000000nm", sky(0.05 / length_of_v, -1 / length_of_v, b / length_of_v))'
  done
}

@test "sphere: normals point outward, the back film's away from the eye" {
  layers --scene sphere --size 30x20 --grid 500:500:1 --radiance 2 --radius 0.375 -o a.exr
  for pixel in 14,9 10,14 21,8; do
    holds a.exr $pixel '
      a = ('"${pixel%,*}"' + 0.5 - 15) / 20; b = (10 - '"${pixel#*,}"' - 0.5) / 20; r = 0.375
      c = sqrt(1 - (a * a + b * b) / r / r)
      for (k = 1; k <= 2; k++) {
        p = "film" k "."; side = k == 1 ? 1 : -1
        lawful(p); is(p "cosine", side * c); is(p "id", 1); is(p "cover", 1)
        are(p "N", a / r, side * c, b / r); are(p "P", a, side * r * c, b); are(p "I", 0, 1, 0)
        are(p "Q", (1 + a / r) / 2, (1 + side * c) / 2, (1 + b / r) / 2)
        is(p "mirror.S0.500,000000nm", 2 * sky_of(p))
        is(p "mirror.S0.500,000000nm", 2 * sky(side * 2 * c * a / r, 2 * c * c - 1, side * 2 * c * b / r))
      }
      is("through.S0.500,000000nm", 1.5); dark("S0.")'
  done
  holds a.exr 0,0 'dark("film"); dark("through."); is("S0.500,000000nm", 1.5)'
}

@test "sphere: means of points tend to the integrals over the disc that it shows" {
  # Over the disc the mean of c is 2/3, that of c^2 is 1/2, so the mean of sky(m) is 1.
  layers --scene sphere --size 1x1 --samples 1000 --grid 500:500:1 -o a.exr
  holds a.exr 0,0 '
    cover = v["film1.cover"]
    if (cover / (pi * 0.16) > 1.0002 || cover / (pi * 0.16) < 0.9998) wrong("cover is " cover)
    if (v["film1.cosine"] > 0.6668 || v["film1.cosine"] < 0.6665) wrong("cosine " v["film1.cosine"])
    is("film2.cover", cover); is("film2.cosine", -v["film1.cosine"])
    are("film1.N", 0, 1, 0); are("film2.N", 0, -1, 0); are("film2.I", 0, 1, 0)
    is("film1.P.Y", 0.4 * v["film1.cosine"])
    for (k = 1; k <= 2; k++) {
      ratio = v["film" k ".mirror.S0.500,000000nm"] / cover
      if (ratio > 1.0002 || ratio < 0.9998) wrong("mirror " k " is cover times " ratio)
    }
    is("through.S0.500,000000nm", 0.75 * cover); is("S0.500,000000nm", 0.75 * (1 - cover))'
}

@test "sphere: at a silhouette light is premultiplied, geometry is not" {
  # of the four points of pixel 1,1 the one in the corner misses the sphere
  layers --scene sphere --radius 0.25 --size 4x4 --samples 2 --grid 500:500:1 -o a.exr
  holds a.exr 1,1 '
    far = 0.1875; near = 0.0625
    x[1] = -near; z[1] = near; x[2] = -far; z[2] = near; x[3] = -near; z[3] = far
    x[4] = -far; z[4] = far
    for (i = 1; i <= 4; i++) {
      square = (x[i] ^ 2 + z[i] ^ 2) / 0.0625
      if (square >= 1) continue
      n++; c = sqrt(1 - square); sc += c; sx += x[i]; sz += z[i]
      mirror += sky(8 * c * x[i], 2 * c * c - 1, 8 * c * z[i])
    }
    if (n != 3) wrong(n " points inside")
    norm = sqrt(sc ^ 2 + (4 * sx) ^ 2 + (4 * sz) ^ 2)
    is("film1.cover", 0.75); is("film1.cosine", sc / 3); is("film1.id", 1)
    are("film1.N", 4 * sx / norm, sc / norm, 4 * sz / norm)
    are("film1.P", sx / 3, sc / 12, sz / 3)
    is("film1.mirror.S0.500,000000nm", mirror / 4)
    is("through.S0.500,000000nm", 0.75 * 0.75); is("S0.500,000000nm", 0.75 * 0.25)'
}

@test "disc: geometry, tracks and lamps" {
  layers --scene disc --size 30x20 --grid 500:600:100 --shape ramp --lamp 0.1,0.2,0.4 \
    --lamp -0.3,0,0.1,5 --lamp 1,1,-1 -o a.exr
  for pixel in 11,9 15,14 19,7; do
    holds a.exr $pixel '
      # e = (0, -1/4, 1/4), so f = (0, 1, -1) / sqrt(2), right = (-1, 0, 0), up = (0, 1, 1) / sqrt(2)
      a = ('"${pixel%,*}"' + 0.5 - 15) / 20; b = (10 - '"${pixel#*,}"' - 0.5) / 20
      scale = 0.14 / sqrt(0.125)
      vx = -scale * a; vy = (1 + scale * b) / sqrt(2); vz = (-1 + scale * b) / sqrt(2)
      x = -vx * 0.25 / vz; y = -0.25 - vy * 0.25 / vz
      length_of_v = sqrt(vx * vx + vy * vy + vz * vz); radius = sqrt(x * x + y * y)
      lawful(""); is("cover", 1); is("id", 1); dark("S0.")
      are("P", x, y, 0); are("N", 0, 0, 1)
      are("I", -vx / length_of_v, -vy / length_of_v, -vz / length_of_v)
      are("Tan", -y / radius, x / radius, 0)
      are("Q", (x + 0.058) / 0.116, (y + 0.058) / 0.116, 0)
      square = (0.1 - x) ^ 2 + (0.2 - y) ^ 2 + 0.16; d = sqrt(square)
      are("lamp1.D", (0.1 - x) / d, (0.2 - y) / d, 0.4 / d)
      is("lamp1.S0.500,000000nm", 500 / 550 / (4 * pi * square))
      square = (-0.3 - x) ^ 2 + y ^ 2 + 0.01; d = sqrt(square)
      are("lamp2.D", (-0.3 - x) / d, -y / d, 0.1 / d)
      is("lamp2.S0.600,000000nm", 5 * 600 / 550 / (4 * pi * square))
      dark("lamp3.S0."); if (off(dot("lamp3.D", "lamp3.D"), 1)) wrong("lamp3.D")'
  done
  for pixel in 14,9 0,0; do
    holds a.exr $pixel 'for (name in v) if (v[name] + 0 != 0) wrong(name " is not 0")'
  done
}

@test "disc: from straight above it shows its area" {
  layers --scene disc --eye 0,0,1 --size 1x1 --samples 1000 --grid 500:500:1 -o a.exr
  holds a.exr 0,0 '
    ratio = v["cover"] / (pi * (0.058 ^ 2 - 0.025 ^ 2) / 0.14 ^ 2)
    if (ratio > 1.0005 || ratio < 0.9995) wrong("cover is its area times " ratio)
    are("P", 0, 0, 0); are("I", 0, 0, 1)'
  # x is then on the left, y above: u = y, f = -z, y x -z = -x
  layers --scene disc --eye 0,0,1 --size 14x14 --grid 500:500:1 -o b.exr
  holds b.exr 10,5 'are("P", -0.035, 0.015, 0); are("Tan", -15 / sqrt(15 ^ 2 + 35 ^ 2), -35 / sqrt(15 ^ 2 + 35 ^ 2), 0)'
}

@test "noise: waves, and grain on all light" {
  layers --scene noise --films 2 --size 40x20 --grid 500:600:50 --shape ramp --radiance 2 -o a.exr
  holds a.exr 31,17 '
    x = 31.5 / 40; z = 1 - 17.5 / 20
    for (k = 1; k <= 2; k++) {
      p = "film" k "."; side = k == 1 ? 1 : -1
      nx = sin(6 * pi * x + k); nz = cos(4 * pi * z + k); n = sqrt(nx * nx + 1 + nz * nz)
      lawful(p); are(p "N", nx / n, side / n, nz / n); is(p "id", k); is(p "cover", 1)
      are(p "P", (31.5 - 20) / 20, (1 - k) / 10, (10 - 17.5) / 20); are(p "Q", x, 0, z)
    }
    is("film1.mirror.S0.500,000000nm", 2 * 500 / 550 * '"$(grain 31 17 0 1)"')
    is("film2.mirror.S0.600,000000nm", 2 * 600 / 550 * '"$(grain 31 17 2 2)"')
    is("through.S0.550,000000nm", 0.25 * '"$(grain 31 17 1 32)"')
    is("S0.600,000000nm", 2 * 600 / 550 * '"$(grain 31 17 2 0)"')'
  layers --scene noise --lamps 2 --size 40x20 --grid 500:600:50 -o b.exr
  holds b.exr 31,17 '
    lawful(""); n = sqrt(v["N.X"] ^ 2 + v["N.Y"] ^ 2)
    are("Tan", v["N.Y"] / n, -v["N.X"] / n, 0)
    x = cos(2) - v["P.X"]; y = 1 - v["P.Y"]; z = sin(2) - v["P.Z"]; d = sqrt(x * x + y * y + z * z)
    are("lamp2.D", x / d, y / d, z / d)
    is("lamp2.S0.500,000000nm", '"$(grain 31 17 0 2)"'); is("S0.550,000000nm", '"$(grain 31 17 1 0)"')'
}

# The file

@test "every number of threads writes the same bytes" {
  for scene in 'noise --films 3' 'sphere --samples 2' 'disc'; do
    # shellcheck disable=SC2086 # options
    for threads in 1 2 3; do
      layers --scene $scene --size 61x67 --grid 400:700:100 -j $threads -o $threads.exr
      cmp 1.exr $threads.exr
    done
  done
}

@test "specconvert passes all the layers through unchanged" {
  for scene in flat pair tilted 'sphere --samples 3' 'disc --samples 3' 'noise --films 2' 'noise --lamps 2'; do
    # shellcheck disable=SC2086 # options
    layers --scene $scene --size 9x7 --grid 400:700:100 --compression none -o a.exr
    specconvert --compression zip a.exr | specconvert --compression none -o b.exr
    [ "$(channels a.exr)" = "$(channels b.exr)" ]
    bytes=$((9 * 4 * $(channels a.exr | wc -l)))
    for file in a b; do
      tail -c $((7 * (8 + bytes))) $file.exr >$file.pixels
    done
    cmp a.pixels b.pixels || complain "$scene"
  done
}

@test "--bins are half-way, --half is for light alone" {
  layers --grid 400:700:100 --bins --half -o a.exr
  exrheader a.exr | grep -qx 'spec:bins (type string): "350 450 550 650 750"'
  [ "$(exrheader a.exr | grep -c '16-bit')" -eq 12 ]
  exrheader a.exr | grep -q 'film1.mirror.S0.400,000000nm, 16-bit'
  holds a.exr 3,3 'is("film1.mirror.S0.400,000000nm", 1); is("film1.P.X", (3.5 - 8) / 8)'
}

@test "without --grid there are 81 bands from 380 to 780 nm" {
  layers -o a.exr
  [ "$(channels a.exr | grep -c ^S0)" -eq 81 ]
  channels a.exr | grep -qx film1.mirror.S0.380,000000nm
  channels a.exr | grep -qx through.S0.780,000000nm
}

# --print

@test "--print lists a pixel of any image, counted from its corner" {
  spectral a.exr --data -7,-300 --grid 500:600:50 --uint-id --pattern nan:1,0,1
  layers --print 3,2 a.exr >found
  printf '%s\n' 'S0.500,000000nm 0.0240000002' 'S0.550,000000nm 0.123999998' \
    'S0.600,000000nm 0.224000007' 'id 131075' >want
  cmp found want || complain "$(cat found)"
  for compression in none zip; do
    specconvert --compression $compression a.exr | layers --print 3,2 | cmp - want
  done
  layers --print 1,0 a.exr | grep -qx 'S0.550,000000nm nan'
}

@test "--print refuses pixels that are not there" {
  spectral a.exr --size 4x3
  layers --print 3,2 a.exr >last
  for pixel in 4,2 3,3 -1,0 1 1,x 1,1,1; do
    fails_cleanly "$TESTS/layers" --print $pixel a.exr
  done
  fails_cleanly "$TESTS/layers" --print 0,0 none.exr
}

@test "options that do not fit the scene are refused" {
  for line in 'flat --radius 1' 'flat --samples 2' 'flat --eye 0,0,1' 'flat --lamp 1,1,1' \
    'flat --films 2' 'pair --lamps 2' 'tilted --radius 1' 'sphere --behind 1' 'sphere --angle 3' \
    'disc --radiance 2' 'disc --films 1' 'noise --angle 3' 'noise --samples 2' \
    'noise --lamps 2 --films 2' 'noise --lamps 2 --behind 1' 'disc --print 0,0' \
    'bubble' 'sphere --radius 0' 'disc --eye 0,0,-1' 'disc --lamp 1,1' 'disc --lamp 1,1,1,1,1' \
    'disc --eye 1,1,' 'flat --shape round' 'flat --size 0x1' 'flat a.exr' 'noise --films 5' \
    'noise --lamps 17' 'flat --grid 400:2000:1'; do
    # shellcheck disable=SC2086 # options
    fails_cleanly "$TESTS/layers" --scene $line -o out.exr
  done
  fails_cleanly "$TESTS/layers" --print 0,0 a.exr -o out.exr
  no_leftovers .
}
