# shellcheck shell=bash
title 'Three spheres under a green lamp, by colours and by spectra'
from 'T 2.9 (Vangorp & Yskout 2005); the spectra are those of Smits 1999'
note 'A red, a purple and a yellow sphere under a green lamp. Where colours are three numbers, red and purple send nothing back. Where they are spectra, the lamp has a little red and blue, too.'
cp "$here/smits.pbrt" .

# The three numbers of a colour as bands of 100 nm that do not meet; the renderer's bands are the
# same. What is between two of a sphere's lies outside the lamp's light.
display >display.spd
box() {
  printf '# quantity: reflectance\n# columns: wavelength_nm R\n400 %s\n499.9999 %s\n500 %s\n600 %s\n600.0001 %s\n700 %s\n' \
    "$3" "$3" "$2" "$2" "$1" "$1"
}
mkdir colours spectra
cp smits.pbrt colours
cp smits.pbrt spectra
printf '%s\n' '# quantity: spectral power distribution' '# columns: wavelength_nm L' \
  '400 0' '500 0' '500.0001 1' '599.9999 1' '600 0' '700 0' >colours/lamp.spd
box 1 0 0 >colours/red.spd
box 1 0 1 >colours/purple.spd
box 1 1 0 >colours/yellow.spd
run 'cat colours/lamp.spd; cat colours/yellow.spd'
picture colours.png 'specrender --grid 450:650:100 colours/smits.pbrt -o colours.exr
spec2rgb --observer display.spd colours.exr -o colours.png' 'colours of three numbers: black, black, green'

# The lamp is a multiple of D65, which the displayed white is; so its colour is that of the RGB.
grid=360:830:15.6666666666667
picture spectra.png "specconvert --from-rgb smits --as light --extrapolate constant --grid $grid rgb:0,1,0 -o spectra/lamp.spd
specconvert --from-rgb smits --grid $grid rgb:1,0,0 -o spectra/red.spd
specconvert --from-rgb smits --grid $grid rgb:1,0,1 -o spectra/purple.spd
specconvert --from-rgb smits --grid $grid rgb:1,1,0 -o spectra/yellow.spd
specrender --extrapolate constant --grid $grid spectra/smits.pbrt -o spectra.exr
spec2rgb spectra.exr -o spectra.png" 'spectra of 31 samples, 360 to 830 nm: the red and the purple are seen'

# Where a sphere is brightest; the lamp stands to the left and above.
declare -A at=([red]="55,43" [purple]="215,43" [yellow]="375,43")
run 'spec2rgb --observer display.spd colours.exr -o colours-linear.exr
spec2rgb spectra.exr -o spectra-linear.exr'
for kind in colours spectra; do
  for name in red purple yellow; do
    layers --print "${at[$name]}" $kind-linear.exr | awk '{ of[$1] = $2 } END { print of["R"], of["G"], of["B"] }' >$kind-$name.txt
  done
done
check 'red by colours: R, G, B' "$(largest <colours-red.txt)" at-most 0
check 'purple by colours: R, G, B' "$(largest <colours-purple.txt)" at-most 0
check 'yellow by colours: R and B over G' "$(awk '{ print $1 / $2, $3 / $2 }' colours-yellow.txt | largest)" at-most 1e-6
# A diffuse reflectance of 1 at normal incidence sends back irradiance over pi: the scene's lamp has
# pi. The sphere's brightest pixel is within 0.2 % of that.
check 'yellow by colours: G' "$(cut -d ' ' -f 2 colours-yellow.txt)" within 1 0.002
check 'all of the red sphere by colours: largest light in any band' \
  "$(specconvert --crop 0,0,160,160 colours.exr | specconvert --downsample 40 | specconvert -f spd | grep '^[0-9]' | cut -d ' ' -f 2- | largest)" at-most 0

# By spectra each band is the product of its means, of lamp and of sphere, times one number for all:
# the means of straight lines between the samples, which are a band apart, computed anew.
means() {
  grep '^[0-9]' "spectra/$1.spd" | awk '{ v[NR] = $2 } END {
    for (i = 1; i <= NR; i++) {
      low = i > 1 ? v[i - 1] : v[i]; high = i < NR ? v[i + 1] : v[i]
      printf "%.17g\n", (low + 6 * v[i] + high) / 8
    }
  }'
}
for name in red purple yellow; do
  pixel spectra.exr "${at[$name]}" | paste -d ' ' - <(means lamp) <(means $name) | awk '
    NR > 1 && NR < 31 { light[NR] = $2; wanted[NR] = $3 * $4; a += $2; b += $3 * $4 }
    END { for (i in light) print light[i] / a - wanted[i] / b }' >$name.errors
  check "$name by spectra: 29 inner bands, share of the light, largest difference to lamp times reflectance" "$(largest <$name.errors)" at-most 2e-6
done
# What Smits has between 584 and 618 nm, where both red and green are not 0, is .8325 and .1719.
check 'red by spectra: R over the G of yellow' \
  "$(cat spectra-red.txt spectra-yellow.txt | xargs | awk '{ print $1 / $5 }')" at-least 0.1
check 'red by spectra is red: R over G' "$(awk '{ print $1 / $2 }' spectra-red.txt)" at-least 1
check 'purple by spectra is not black: G over that of yellow' \
  "$(cat spectra-purple.txt spectra-yellow.txt | xargs | awk '{ print $3 / $5 }')" at-least 0.01
check 'yellow by spectra is green: G over R' "$(awk '{ print $2 / $1 }' spectra-yellow.txt)" at-least 1.5
