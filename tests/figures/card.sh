# shellcheck shell=bash
title 'A ColorChecker in daylight and in the light of a bulb'
from 'the measured reflectances of spectra/reflectance/colorchecker'
note "The README's pictures: 24 patches of 81 bands, seen by the CIE's observer of 1931."

patches=$(cd "$spectra/reflectance" && printf '%s\n' colorchecker/*.spd)
run "specconvert --patches 6x4 --patch 96 --gap 12 --grid 380:780:5 $(xargs <<<"${patches//.spd/}") -o card.exr"
picture card-D65.png 'spec2rgb card.exr --illuminant D65 -o card-D65.png' 'in daylight, illuminant D65'
picture card-A.png 'spec2rgb card.exr --illuminant A -o card-A.png' 'in the light of a bulb, illuminant A'

# The red patch is the third of the third row; every patch and gap take 108 pixels.
red=264,264
specconvert 15-red --grid 380:780:5 | grep '^[0-9]' >red.txt
# The image has floats: 24 bits.
check 'red patch: largest difference to its curve' \
  "$(pixel card.exr $red | paste -d ' ' red.txt - | awk '{ print $2 - $4 }' | largest)" at-most 3e-8

# The picture against the CIE's sums and the standard of sRGB, computed beside the suite.
for light in D65 A; do
  check "red patch in $light: codes of the picture" \
    "$(rgb card.exr $red --illuminant $light)" equals "$(codes card.exr $red $light)"
done
