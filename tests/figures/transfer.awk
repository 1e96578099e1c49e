# transfer.awk - reflectance and transmittance of a stack by characteristic matrices, written
# beside the suite to check it
# usage: awk -v stack='1 0 | 2.4 0 57.3 | 1.52 0' -v angle=30 -v polarisation=s -f transfer.awk
#
# The stack has n and k, of n + ik, and a thickness in nm for each layer; its ambient must not
# absorb. The input has a wavelength [nm] first on each line, the output "nm R T". F. Abelès,
# Ann. Phys. (Paris) 12 (1950) 596 and 706, as in Born & Wolf, Principles of Optics, 1.6.2; for
# fields that go as e^(-iwt). Layers that absorb so much that cosh overflows are out of reach.

# Complex functions leave their result in re and im.
function multiply(a, b, c, d) {
  re = a * c - b * d; im = a * d + b * c
}
function divide(a, b, c, d, size) {
  size = c * c + d * d
  re = (a * c + b * d) / size; im = (b * c - a * d) / size
}
function root(a, b, size) { # the one with im >= 0: waves that die away
  size = sqrt(a * a + b * b)
  im = sqrt((size - a > 0 ? size - a : 0) / 2)
  re = sqrt((size + a > 0 ? size + a : 0) / 2)
  # the larger of both gives the other without loss of digits
  if (a >= 0) im = re ? b / (2 * re) : 0; else re = im ? b / (2 * im) : 0
  if (im < 0) { re = -re; im = -im }
}

# The tilted admittance of medium i, and n cos of the angle in it.
function tilt(i, ar, ai) {
  multiply(n[i], k[i], n[i], k[i])
  root(re - sine2, im)
  cr[i] = re; ci[i] = im
  if (polarisation == "s") { er[i] = re; ei[i] = im; return }
  ar = re; ai = im
  multiply(n[i], k[i], n[i], k[i])
  divide(re, im, ar, ai)
  er[i] = re; ei[i] = im
}

BEGIN {
  pi = 4 * atan2(1, 1)
  media = split(stack, text, "|")
  for (i = 1; i <= media; i++) {
    split(text[i], part, " ")
    n[i] = part[1]; k[i] = part[2]; d[i] = part[3]
  }
  sine2 = (n[1] * sin(angle * pi / 180)) ^ 2
  for (i = 1; i <= media; i++) tilt(i)
}

/^[0-9]/ {
  br = 1; bi = 0; hr = er[media]; hi = ei[media] # the fields E and H, from the substrate on
  for (i = media - 1; i > 1; i--) {
    x = 2 * pi * d[i] * cr[i] / $1; y = 2 * pi * d[i] * ci[i] / $1
    up = exp(y); down = exp(-y)
    cosr = cos(x) * (up + down) / 2; cosi = -sin(x) * (up - down) / 2
    sinr = sin(x) * (up + down) / 2; sini = cos(x) * (up - down) / 2
    # E' = cos E - i sin H / eta, H' = cos H - i sin eta E
    multiply(sinr, sini, hr, hi); divide(re, im, er[i], ei[i]); pr = im; p = -re
    multiply(sinr, sini, br, bi); multiply(re, im, er[i], ei[i]); qr = im; q = -re
    multiply(cosr, cosi, br, bi); newr = re + pr; new = im + p
    multiply(cosr, cosi, hr, hi); hr = re + qr; hi = im + q
    br = newr; bi = new
  }
  multiply(er[1], ei[1], br, bi)
  sumr = re + hr; sumi = im + hi
  divide(re - hr, im - hi, sumr, sumi)
  printf "%s %.17g %.17g\n", $1, re * re + im * im, 4 * er[1] * er[media] / (sumr ^ 2 + sumi ^ 2)
}
