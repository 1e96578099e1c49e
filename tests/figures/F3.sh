# shellcheck shell=bash disable=SC2016
title 'One film: the reflections in it, one by one'
from 'T 6.1–6.12 (Vangorp & Yskout 2005), put right; Airy 1833'

picture coat.png \
  'specfilm --stack "air | 1.38 * | 1.52" --chart "thickness 0nm..1000nm, angle 0deg..80deg" --size 500x320 | spec2rgb -e 3 -o coat.png' \
  'magnesium fluoride (1.38) on glass: thickness 0 to 1000 nm to the right, angle 0 to 80° downwards'

# Two films: between equal media, and one that reverses no phase at its second surface.
run 'for angle in 0 30 60 80; do for p in s p; do
  specfilm --stack "air | 1.5 500nm | air" --spectrum --angle ${angle}deg --polarisation $p --grid 380:780:1 >soap-$p$angle.spd
  specfilm --stack "air | 1.38 700nm | 1.52" --spectrum --angle ${angle}deg --polarisation $p --grid 380:780:1 >coat-$p$angle.spd
done; done'

files=()
for angle in 0 30 60 80; do
  for p in s p; do
    files+=("angle=$angle" "p=$p" n2=1.5 n3=1 d=500 "soap-$p$angle.spd")
    files+=(n2=1.38 n3=1.52 d=700 "coat-$p$angle.spd")
  done
done

# Of all samples the largest errors: of the series after 200 reflections, of its end in closed
# form, of R + T; of the series after 1 to 10 reflections the largest part of what the terms
# left out can make; and how many samples there were.
awk '
  BEGIN { pi = 4 * atan2(1, 1) }
  function largest(i, v) {
    if (v < 0) v = -v
    if (v > most[i]) most[i] = v
  }
  # abs(r12 + t12 r23 t21 e^(i beta) A)^2, A = ar + i ai
  function reflectance(ar, ai) {
    return (r12 + trt * (co * ar - si * ai)) ^ 2 + (trt * (co * ai + si * ar)) ^ 2
  }
  FNR == 1 {
    s = sin(angle * pi / 180)
    c1 = sqrt(1 - s * s); c2 = sqrt(1 - (s / n2) ^ 2); c3 = sqrt(1 - (s / n3) ^ 2)
    if (p == "s") { a = c1; b = n2 * c2; c = n3 * c3 } else { a = 1 / c1; b = n2 / c2; c = n3 / c3 }
    r12 = (a - b) / (a + b); r23 = (b - c) / (b + c)
    trt = (1 - r12 * r12) * r23 # t12 t21 = 1 - r12^2, and r21 = -r12
    rho = -r12 * r23
  }
  /^[0-9]/ {
    n++
    beta = 4 * pi * n2 * d * c2 / $1
    co = cos(beta); si = sin(beta)
    left = 2 * (trt < 0 ? -trt : trt) / (1 - (rho < 0 ? -rho : rho))
    ar = 1; ai = 0 # A_1 = 1, A_k = 1 + r21 r23 e^(i beta) A_(k-1)
    for (k = 1; k <= 200; k++) {
      left *= rho < 0 ? -rho : rho
      if (k <= 10) largest(4, (reflectance(ar, ai) - $2) / (left + 1e-13))
      t = 1 + rho * (co * ar - si * ai); ai = rho * (co * ai + si * ar); ar = t
    }
    largest(1, reflectance(ar, ai) - $2)
    airy = (r12 * r12 + r23 * r23 + 2 * r12 * r23 * co) / (1 + (r12 * r23) ^ 2 + 2 * r12 * r23 * co)
    largest(2, airy - $2)
    largest(3, $2 + $3 - 1)
  }
  END { if (n) print most[1] + 0, most[2] + 0, most[3] + 0, most[4] + 0, n }' "${files[@]}" >errors
read -r series airy energy part samples <errors
check 'curves compared: samples' "$samples" equals $((401 * 16))
check 'R against 200 reflections added as amplitudes: largest error' "$series" at-most 1e-12
check "R against Airy's closed form: largest error" "$airy" at-most 1e-12
check 'R + T - 1: largest' "$energy" at-most 1e-12
check 'after 1 to 10 reflections: largest part of the bound 2 |t12 r23 t21| |r21 r23|^k / (1 - |r21 r23|)' \
  "$part" at-most 1

# T adds powers, unpolarised: the series then ends elsewhere.
note "T's own series of powers (6.12) tends to another limit, X = ((R cos β + √(1 − R² sin² β)) / (1 − R²))²."
run 'for angle in 0 60 80; do
  specfilm --stack "air | 1.5 500nm | air" --spectrum --angle ${angle}deg --grid 380:780:1 >soap-$angle.spd
done'
for angle in 0 60 80; do
  awk -v angle=$angle '
    BEGIN {
      pi = 4 * atan2(1, 1)
      s = sin(angle * pi / 180); c1 = sqrt(1 - s * s); c2 = sqrt(1 - (s / 1.5) ^ 2)
      R = (((c1 - 1.5 * c2) / (c1 + 1.5 * c2)) ^ 2 + ((c2 - 1.5 * c1) / (c2 + 1.5 * c1)) ^ 2) / 2
    }
    /^[0-9]/ {
      beta = 4 * pi * 1.5 * 500 * c2 / $1
      limit = ((R * cos(beta) + sqrt(1 - (R * sin(beta)) ^ 2)) / (1 - R * R)) ^ 2
      X = 1
      for (k = 2; k <= 200; k++) X = 1 + R * R * X + 2 * sqrt(R * R * X) * cos(beta)
      off = X - limit; if (off < 0) off = -off
      if (off > most) most = off
      power = (1 - R) ^ 2 * R * X
      off = R + power - 2 * sqrt(R * power) * cos(beta) - $2; if (off < 0) off = -off
      if (off > error) error = off
      n++
    }
    END { if (n) print most + 0, error + 0 }' soap-$angle.spd >errors
  read -r limit error <errors
  check "T's X after 200 reflections at $angle°, against its limit" "$limit" at-most 1e-12
  case $angle in
  0) wanted=0.003 tolerance=0.0005 ;;
  60) wanted=0.042 tolerance=0.0005 ;;
  80) wanted=0.19 tolerance=0.005 ;;
  esac
  check "T's reflectance at $angle°: largest error" "$error" within "$wanted" "$tolerance"
done
