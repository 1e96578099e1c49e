# shellcheck shell=bash disable=SC2016
title 'Many layers, clear and absorbing'
from 'W 67–68, 50–51 and 73–79 (Schiffner 2008), put right; Abelès 1950'

picture mirror.png \
  'specfilm --stack "air | (TiO2 60nm | SiO2 95nm)^8 | N-BK7" --chart "angle 0deg..89deg" --size 640x120 | spec2rgb -o mirror.png' \
  'dielectric mirror of 8 pairs on glass, reflected: angle 0 to 89° to the right'
picture passed.png \
  'specfilm --stack "air | (TiO2 60nm | SiO2 95nm)^2 | TiO2 * | (SiO2 95nm | TiO2 60nm)^2 | N-BK7" --chart "thickness 20nm..220nm, angle 0deg..85deg" --of transmittance --grid 380:780:2 --size 320x160 | spec2rgb -o passed.png' \
  'mirrors of 2 pairs with a layer between them, transmitted: its thickness 20 to 220 nm to the right, angle 0 to 85° downwards'
picture gold.png \
  'specfilm --stack "air | SiO2 * | Au" --chart "thickness 0nm..800nm, angle 0deg..85deg" --size 640x320 | spec2rgb -o gold.png' \
  'oxide on gold: thickness 0 to 800 nm to the right, angle 0 to 85° downwards'

# S. J. Byrnes, the tmm package, basic_test: values of an independent program in Mathematica.
# 0.1 rad is 5.729577951308232 degrees.
run 'for p in s p; do
  specfilm --stack "1 | 2+4i 2nm | 3+0.3i 3nm | 1+0.1i" --spectrum --angle 5.729577951308232deg --polarisation $p --grid 100:100:1 >byrnes-$p.spd
done'
check 'R for s, published by S. J. Byrnes (tmm)' "$(value byrnes-s.spd 100 R)" within 0.37273208839139516 1e-12
check 'T for s' "$(value byrnes-s.spd 100 T)" within 0.22604491247079261 1e-12
check 'R for p' "$(value byrnes-p.spd 100 R)" within 0.37016110373044969 1e-12
check 'T for p' "$(value byrnes-p.spd 100 T)" within 0.22824374314132009 1e-12
check 'A for s' "$(value byrnes-s.spd 100 A)" within 0.40122299913781223 1e-12

# Quarter waves at 550 nm: the admittance of N pairs HL on glass is (H/L)^(2N) times that of glass.
run 'specfilm --stack "air | (2.4 57.291666666666664nm | 1.46 94.17808219178082nm)^8 | 1.52" --spectrum --angle 0deg --grid 550:550:1'
check 'quarter-wave mirror of 8 pairs at 550 nm' "$(awk '!/^#/ { print $2 }' <<<"$printed")" \
  within "$(awk 'BEGIN { y = 1.52 * (2.4 / 1.46) ^ 16; printf "%.17g", ((1 - y) / (1 + y)) ^ 2 }')" 1e-12

# Whole curves against characteristic matrices computed beside the suite, for s, p and their mean.
run 'for angle in 0 45 85; do for p in s p u; do
  specfilm --stack "air | (2.4 57.3nm | 1.46 94.2nm)^8 | 1.52" --spectrum --angle ${angle}deg --polarisation $p --grid 380:780:2 >mirror-$p$angle.spd
  specfilm --stack "air | 1.46 200nm | 0.2+3.4i 20nm | 2.1+0.02i 90nm | 0.16+1.95i" --spectrum --angle ${angle}deg --polarisation $p --grid 380:780:2 >metal-$p$angle.spd
done; done'
declare -A stack
pair='2.4 0 57.3 | 1.46 0 94.2 |'
stack[mirror]="1 0 | $pair $pair $pair $pair $pair $pair $pair $pair 1.52 0"
stack[metal]='1 0 | 1.46 0 200 | 0.2 3.4 20 | 2.1 0.02 90 | 0.16 1.95'
for kind in mirror metal; do
  for angle in 0 45 85; do
    for p in s p; do transfer $p $angle "${stack[$kind]}" <"$kind-$p$angle.spd" >$p.txt; done
    paste -d ' ' s.txt p.txt | awk '{ printf "%s %.17g %.17g\n", $1, ($2 + $5) / 2, ($3 + $6) / 2 }' >u.txt
    for p in s p u; do
      grep '^[0-9]' $kind-$p$angle.spd | paste -d ' ' - $p.txt | awk '{ print $2 - $6, $3 - $7, $2 + $3 + $4 - 1 }'
    done
  done >$kind.errors
  check "$kind, s, p and mean, 0 to 85°: samples" "$(wc -l <$kind.errors)" equals $((201 * 9))
  check "$kind: R, T and R + T + A - 1: largest error" "$(largest <$kind.errors)" at-most 1e-12
done
