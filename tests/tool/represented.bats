#!/usr/bin/env bats
# represented.bats - images whose pixels hold Fourier series, or lines and a smooth rest
load common

# A wave over 400..700 nm in 31 bands, which a series of 5 coefficients holds all of: 2 + cos u.
make_wave() {
  awk 'BEGIN { for (nm = 400; nm <= 700; nm += 10)
    printf "%d,%.12g\n", nm, 2 + cos(2 * 3.14159265358979323846 * (nm - 400) / 300) }' >wave.csv
  specconvert wave.csv -o wave.exr
}

@test "a wave becomes its coefficients and comes back" {
  make_wave
  specconvert --to fourier:5 wave.exr -o series.exr
  has_channels series.exr S0.a0 S0.a1 S0.a2 S0.b1 S0.b2
  [[ $(header_of series.exr) = *'"fourier 5 400 700"'* ]]
  specconvert --to sampled series.exr -o back.exr
  # Between its samples the wave is taken as straight: that alone is lost, (10 k)^2 / 12 of it.
  run specdiff wave.exr back.exr --tolerance max=0.004
  [ "$status" = 0 ] || complain "$output"
  run specdiff wave.exr back.exr --tolerance max=0.003
  [ "$status" = 1 ] || complain "$output"
  [[ $(header_of back.exr) != *spec:representation* ]]
}

@test "every tool takes a series for the bands that it stands for" {
  make_wave
  specconvert --to fourier:5 wave.exr -o series.exr
  specconvert series.exr -o back.exr
  spec2rgb -q series.exr -o a.png
  spec2rgb -q back.exr -o b.png
  cmp a.png b.png
  specconvert --to fourier:5 wave.exr | specconvert -b 500 -b 600 - -o two.exr
  has_channels two.exr S0.500,000000nm S0.600,000000nm
  specconvert -b 500 -b 600 back.exr -o same.exr
  specdiff two.exr same.exr
}

@test "bins: the mean over all of them is half of a0, and comes back exactly" {
  "$TESTS/synthesize" --size 9x5 --grid 400:700:10 --bins --pattern grain -o bins.exr
  specconvert --to fourier:31 bins.exr -o series.exr
  specconvert --to sampled series.exr -o back.exr
  specconvert -g 400:700:10 back.exr -o same.exr
  # The energy: the sum of all bands is kept, whatever their shape.
  local sums
  sums=$(for file in bins back; do
    specconvert -f spd "$file.exr" | awk '!/^#/ { for (i = 2; i <= NF; i++) sum[i] += $i }
      END { for (i = 2; i <= NF; i++) printf "%.3f ", sum[i] }'
    echo
  done)
  [ "$(sort -u <<<"$sums" | wc -l)" = 1 ] || complain "$sums"
}

@test "spikes become lines, and the rest stays what it was" {
  awk 'BEGIN { for (nm = 400; nm <= 700; nm += 10)
    print nm "," 1 + nm / 1000 + (nm == 440 ? 5 : nm == 550 ? 9 : 0) }' >lamp.csv
  specconvert lamp.csv -o lamp.exr
  specconvert --to composite:2 lamp.exr -o lines.exr
  # 5 and 9 above the slope, in cells 10 nm wide.
  specconvert --to composite:2,5 lamp.exr -o both.exr
  has_channels both.exr S0.a0 S0.a1 S0.a2 S0.b1 S0.b2 \
    S0.line1 S0.line1.nm S0.line2 S0.line2.nm
  run oiiotool --stats both.exr
  [[ $output = *' 50.000000 90.000000 440.000000 550.000000 (float)'* ]] || complain "$output"
  specconvert --to sampled lines.exr -o back.exr
  specdiff lamp.exr back.exr --tolerance max=1e-6
}

@test "Stokes components, windows, other channels and half floats" {
  "$TESTS/synthesize" --size 7x3 --data 5,-2 --kind stokes --grid 400:700:25 --pattern grain \
    --extra Z -o all.exr
  specconvert --to fourier:13 all.exr -o series.exr
  specconvert --to sampled series.exr -o back.exr
  [ "$(channels back.exr)" = "$(channels all.exr)" ]
  [[ $(header_of back.exr) = *'dataWindow (type box2i): (5 -2) - (11 0)'* ]]
  oiiotool -q all.exr --ch Z back.exr --ch Z --diff
  specconvert --half --to fourier:13 all.exr -o half.exr
  exrheader half.exr | grep -q 'S3.b6, 16-bit'
}

@test "the same bytes for any number of threads" {
  "$TESTS/synthesize" --size 70x90 --grid 400:700:5 --pattern noise -o noise.exr
  for to in fourier:21 composite:4,9; do
    specconvert -j1 --no-history --to $to noise.exr -o one.exr
    specconvert -j4 --no-history --to $to noise.exr -o four.exr
    cmp one.exr four.exr
    specconvert -j1 --no-history one.exr -o a.exr
    specconvert -j3 --no-history four.exr -o b.exr
    cmp a.exr b.exr
  done
}

@test "what cannot be is refused" {
  make_wave
  fails_cleanly specconvert --to fourier:33 wave.exr -o out.exr
  [[ $stderr = *'wave.exr: 33 coefficients are more than its 31 bands'* ]] || complain "$stderr"
  spectral many.exr --size 1x1 --grid 400:1430:1
  fails_cleanly specconvert --to fourier:1027 many.exr -o out.exr
  [[ $stderr = *'or than 1025' ]] || complain "$stderr"
  spectral glow.exr --channel T.400nm --channel T.500nm --channel T.400nm.500nm
  fails_cleanly specconvert --to composite:1 glow.exr -o out.exr
  [[ $stderr = *'glow.exr: is bispectral; --illuminate it first' ]] || complain "$stderr"
  fails_cleanly specconvert --to fourier:4 wave.exr -o out.exr
  fails_cleanly specconvert --to composite:65 wave.exr -o out.exr
  fails_cleanly specconvert --to fourier:5 --scale 2 wave.exr -o out.exr
  fails_cleanly specconvert --to fourier:5 -f envi wave.exr -o out.hdr
  fails_cleanly specconvert --to fourier:5 wave.exr -o out.tif
  fails_cleanly specconvert --to sampled:400:700:5 wave.exr -o out.exr
  [ ! -e out.exr ] && [ ! -e out.hdr ] && [ ! -e out.tif ]
}

@test "a representation that is none is told" {
  series=(--size 1x1 --channel S0.a0 --channel S0.a1 --channel S0.b1)
  spectral a.exr "${series[@]}" --attribute 'spec:representation=fourier 3 400 700' --attribute 'spec:wavelengths=400 500 700'
  specinfo a.exr >told
  for text in '' fourier composite sampled 'fourier 0 400 700' 'fourier 2 400 700' 'fourier 1027 400 700' 'fourier -3 400 700' \
    'fourier 3 nan 700' 'fourier 3 400 inf' 'fourier 3 700 400' 'fourier 3 400 400' 'fourier 3 0 700' 'fourier 3 0x190 700' \
    'fourier 3 400 700 ' 'composite 0' 'composite 65' 'composite 0 fourier 3 400 700' 'composite 1 fourier 0 400 700'; do
    spectral a.exr "${series[@]}" --attribute "spec:representation=$text" --attribute 'spec:wavelengths=400 500 700'
    fails_cleanly specinfo a.exr
    [[ $stderr = "specinfo: a.exr: its spec:representation is none: '$text'" ]] || complain "$stderr"
  done
  spectral a.exr "${series[@]}" --attribute 'spec:representation=fourier 1025 400 700' --attribute 'spec:wavelengths=400 500 700'
  fails_cleanly specinfo a.exr
  [[ $stderr = *"lacks the channel 'S0.a2'" ]] || complain "$stderr"
  for text in '' 400 '500 400' '400 400' '400 nan' 400,500 '0 400'; do
    spectral a.exr "${series[@]}" --attribute 'spec:representation=fourier 3 400 700' --attribute "spec:wavelengths=$text"
    fails_cleanly specinfo a.exr
    [[ $stderr = 'specinfo: a.exr: the attribute spec:wavelengths '* ]] || complain "$stderr"
  done
}

@test "a representation that is damaged is told" {
  make_wave
  specconvert --no-history --to fourier:5 wave.exr -o series.exr
  LC_ALL=C sed 's/fourier 5 400 700/fourier 4 400 700/' series.exr >even.exr
  fails_cleanly specconvert even.exr -o out.exr
  [[ $stderr = *"its spec:representation is none: 'fourier 4 400 700'" ]] || complain "$stderr"
  LC_ALL=C sed 's/fourier 5 400 700/fourier 5 700 400/' series.exr >reversed.exr
  fails_cleanly specconvert reversed.exr -o out.exr
  LC_ALL=C sed 's/S0\.b1/S0.c1/' series.exr >lacking.exr
  fails_cleanly specconvert lacking.exr -o out.exr
  [[ $stderr = *"lacks the channel 'S0.b1'" ]] || complain "$stderr"
  LC_ALL=C sed 's/400 410 420/400 420 410/' series.exr >disordered.exr
  fails_cleanly specconvert disordered.exr -o out.exr
  [[ $stderr = *'disordered.exr: the attribute spec:wavelengths is damaged at '* ]] || complain "$stderr"
  head -c -10 series.exr >short.exr
  fails_cleanly specconvert short.exr -o out.exr
}
