#!/usr/bin/env bats
# formats.bats - images that other programs wrote, and those in formats other than OpenEXR
load common

# Two channels whose names are no wavelengths.
two_channels() {
  "$TESTS/synthesize" --size 2x1 --channel red --channel green --pattern constant:0.25 -o two.exr
}

@test "a name map makes bands of channels, in any tool" {
  two_channels
  run --separate-stderr specconvert --name-map red=650nm,green=.55um two.exr -o bands.exr
  [ "$status" = 0 ]
  has_channels bands.exr 'S0.550,000000nm' 'S0.650,000000nm'
  run specdiff --name-map red=650nm,green=550nm two.exr bands.exr
  [ "$status" = 0 ]
}

@test "--read-as says that mapped bands are reflectance" {
  two_channels
  specconvert --name-map red=650nm,green=550nm --read-as reflectance two.exr -o bands.exr
  has_channels bands.exr 'T.550,000000nm' 'T.650,000000nm'
}

@test "--read-as contradicts no name of the layout" {
  "$TESTS/synthesize" --kind S0 --size 2x1 -o light.exr
  run --separate-stderr specconvert --read-as reflectance light.exr -o out.exr
  [ "$status" = 2 ]
  [[ $stderr = *'light.exr: its names say that it is radiance' ]] || complain "$stderr"
  [ ! -e out.exr ]
  specconvert --read-as radiance light.exr -o out.exr
}

@test "a name map that is no map, or does not fit, is refused" {
  two_channels
  local map
  for map in red red= =650nm red=650nm,red=600nm blue=450nm red=0nm red=650xyz; do
    run --separate-stderr specconvert --name-map "$map" two.exr -o out.exr
    [ "$status" = 2 ] || complain "$map"
    [ "${#stderr_lines[@]}" = 1 ] || complain "$map: $stderr"
    [ ! -e out.exr ]
  done
  run --separate-stderr specconvert --name-map blue=450nm two.exr -o out.exr
  [[ $stderr = *"two.exr: has no channel 'blue' to be mapped" ]] || complain "$stderr"
  run --separate-stderr specconvert --read-as light two.exr -o out.exr
  [[ $stderr = *"'light' is neither radiance nor reflectance" ]] || complain "$stderr"
}

@test "Ocean's channels have their wavelengths in attributes, in metres" {
  "$TESTS/synthesize" --size 2x1 --channel a --channel b --pattern constant:0.5 \
    --attribute a.wavelength=5.5e-7 --attribute b.wavelength=4.5e-7 -o ocean.exr
  specconvert ocean.exr -o bands.exr
  has_channels bands.exr 'S0.450,000000nm' 'S0.550,000000nm'
  [[ $(header_of bands.exr) != *b.wavelength* ]]
}
