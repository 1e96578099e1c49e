# What films and discs do to light, computed again by awk for those who compare: to be called in
# pixel_holds, where functions holds one of these or both, and behind $statements.
# shellcheck shell=bash disable=SC2034 # the files that load this use them

# Films. Stacks are specfilm's, but with lengths in nm alone, no groups, and as media
# numbers, n+ki, cauchy(A,B) and air.
#   power(STACK, NM, COSINE, POLARISATION)  R and T are the shares of the power
#   seen(STACK, NM, COSINE, POLARISATION)   R and T are what radiance is multiplied by; from the
#                                           back where the cosine is negative
#   folds(POLARISATION)                     every S0 of to is that of from with its films folded
#                                           in; film k has the stack on[k], or is left out
# By Fresnel's coefficients and Airy's sums, from the last layer on: the characteristic matrices
# of specfilm are another way.
film_functions='
  function times(a, b, c, e) { re = a * c - b * e; im = a * e + b * c }
  function over(a, b, c, e,  s) { s = c * c + e * e; re = (a * c + b * e) / s; im = (b * c - a * e) / s }
  function root(a, b,  m) { # the one above the real axis
    m = sqrt(a * a + b * b)
    re = m + a > 0 ? sqrt((m + a) / 2) : 0
    im = m - a > 0 ? sqrt((m - a) / 2) : 0
  }
  function take(stack, l,  part, word, j) {
    last = split(stack, part, / *[|] */) - 1
    for (j = 0; j <= last; j++) {
      split(part[j + 1], word, " ")
      thick[j] = word[2] + 0
      n[j] = word[1] == "air" ? 1 : word[1] + 0
      k[j] = word[1] ~ /[+]/ ? substr(word[1], index(word[1], "+")) + 0 : 0
      if (split(word[1], word, /[(,)]/) > 2) n[j] = word[2] + word[3] / (l / 1000) ^ 2
    }
  }
  function turn(  j, x) {
    for (j = 0; j < last - j; j++) {
      x = n[j]; n[j] = n[last - j]; n[last - j] = x
      x = k[j]; k[j] = k[last - j]; k[last - j] = x
      x = thick[j]; thick[j] = thick[last - j]; thick[last - j] = x
    }
  }
  function airy(l, cosine, p,  j, qr, qi, yr, yi, rr, ri, tr, ti, er, ei, br, bi, dr, di) {
    for (j = 0; j <= last; j++) { # admittances: n cos, for p divided by n^2
      root(n[j] ^ 2 - k[j] ^ 2 - n[0] ^ 2 * (1 - cosine ^ 2), 2 * n[j] * k[j])
      qr[j] = re; qi[j] = im
      if (p) over(re, im, n[j] ^ 2 - k[j] ^ 2, 2 * n[j] * k[j])
      yr[j] = re; yi[j] = im
    }
    rr = ri = ti = 0; tr = 1
    for (j = last; j > 0; j--) {
      er = exp(-2 * pi * thick[j] * qi[j] / l) * cos(2 * pi * thick[j] * qr[j] / l)
      ei = exp(-2 * pi * thick[j] * qi[j] / l) * sin(2 * pi * thick[j] * qr[j] / l)
      times(tr, ti, er, ei); tr = re; ti = im
      times(er, ei, er, ei); times(rr, ri, re, im); rr = re; ri = im
      over(yr[j - 1] - yr[j], yi[j - 1] - yi[j], yr[j - 1] + yr[j], yi[j - 1] + yi[j]); br = re; bi = im
      times(br, bi, rr, ri); dr = 1 + re; di = im
      times(tr, ti, 1 + br, bi); over(re, im, dr, di); tr = re; ti = im
      over(br + rr, bi + ri, dr, di); rr = re; ri = im
    }
    R += rr ^ 2 + ri ^ 2
    if (yr[0] > 0) T += (tr ^ 2 + ti ^ 2) * yr[last] / yr[0]
  }
  function shares(l, cosine, light) {
    R = T = 0
    if (light != "p") airy(l, cosine, 0)
    if (light != "s") airy(l, cosine, 1)
    if (light == "u") { R /= 2; T /= 2 }
  }
  function power(stack, l, cosine, light) { take(stack, l); shares(l, cosine, light) }
  function seen(stack, l, cosine, light) {
    take(stack, l)
    if (cosine < 0) turn()
    shares(l, cosine < 0 ? -cosine : cosine, light)
    T = k[last] > 0 ? 0 : T * (n[0] / n[last]) ^ 2
  }
  function folds(light,  name, film, L) {
    for (name in from) {
      if (name !~ /^S0[.]/) continue
      L = from["through." name]
      for (film = 4; film > 0; film--) {
        if (!(film in on) || from["film" film ".cover"] + 0 == 0) continue
        seen(on[film], wavelength(name), from["film" film ".cosine"], light)
        L = T * L + R * from["film" film ".mirror." name]
      }
      is(name, from[name] + L)
    }
  }
'

# Discs. A disc is set by
#   disc(NAME)           cd, dvd, bluray, vinyl: the numbers of specdisc(1)
# where directions come from a pixel of from, or of a chart in degrees, by
#   look(LAMP)           u, v, h and lit: N.D, 0 behind the surface, of lamp 1, 2, ...
#   aim(ANGLE, LAMP, AZIMUTH)
# and reflection at the bands nm[1 ... bands], in ascending order, becomes f[1 ... bands] by
#   find_bands(PATTERN)  nm and band[] are of the channels of to that match
#   composite()          of point samples, or of bins with the edges edge[0 ... bands]
#   orders(SPREAD)       the same; in degrees
#   efficiency(ORDER, NM)
#   adds(MODEL)          S0 of to is that of from and the light of all lamps; MODEL is 0:
#                        composite, or the spread of orders
disc_functions='
  function disc(kind) {
    c0 = 0.005; c1 = 1; c2 = 0.01; c3 = 1000; c4 = 0; c5 = 10; beta = 2; sigma1 = 3.14; sigma2 = 0.4
    mirror = 50; alpha = 10000; matt = 0.001; glass = 1.58
    if (kind == "cd") { track = 1600; pit = 2400; wide = 600; deep = 125 }
    if (kind == "dvd") { track = 740; pit = 1400; wide = 320; deep = 103 }
    if (kind == "bluray") { track = 320; pit = 506; wide = 130; deep = 64 }
    if (kind == "vinyl") {
      track = 100000; c0 = 0.04; c1 = c3 = mirror = matt = pit = wide = deep = 0; c2 = 1; alpha = 1
    }
  }
  function unit(p, v,  j, s) {
    for (j = 1; j <= 3; j++) { v[j] = from[p "." substr("XYZ", j, 1)]; s += v[j] ^ 2 }
    for (j = 1; j <= 3; j++) v[j] /= sqrt(s)
  }
  function dot(a, b) { return a[1] * b[1] + a[2] * b[2] + a[3] * b[3] }
  function directions(t, lamp,  wi, wo, n, sum, y, j, s) {
    unit("lamp" lamp ".D", wi); unit("I", wo); unit("Ns.X" in from ? "Ns" : "N", n)
    for (j = 1; j <= 3; j++) sum[j] = wi[j] + wo[j]
    h = dot(sum, n) / sqrt(dot(sum, sum))
    lit = dot(wi, n) > 0 && dot(wo, n) > 0 ? dot(wi, n) : 0
    s = dot(t, n)
    for (j = 1; j <= 3; j++) t[j] -= s * n[j]
    s = sqrt(dot(t, t))
    y[1] = n[2] * t[3] - n[3] * t[2]; y[2] = n[3] * t[1] - n[1] * t[3]; y[3] = n[1] * t[2] - n[2] * t[1]
    u = dot(sum, t) / s; v = dot(sum, y) / s
  }
  function look(lamp,  t) { unit("Tan", t); directions(t, lamp) }
  function circle(lamp, cx, cy, cz, ax, ay, az,  x, y, z, t) {
    x = from["P.X"] - cx; y = from["P.Y"] - cy; z = from["P.Z"] - cz
    t[1] = ay * z - az * y; t[2] = az * x - ax * z; t[3] = ax * y - ay * x
    directions(t, lamp)
  }
  function aim(angle, lamp, azimuth,  sines) {
    sines = sin(angle * pi / 180) + sin(lamp * pi / 180)
    u = sines * sin(azimuth * pi / 180); v = sines * cos(azimuth * pi / 180)
    h = cos((angle + lamp) * pi / 360)
  }
  function find_bands(pattern,  k, j, x) {
    bands = 0
    for (k in to) if (k ~ pattern) {
      for (j = ++bands; j > 1 && nm[j - 1] > wavelength(k); j--) { nm[j] = nm[j - 1]; band[j] = band[j - 1] }
      nm[j] = wavelength(k); band[j] = k
    }
    if (!bands) wrong("no bands")
  }
  function strip(l,  k, m, sum) {
    for (m = -3; m <= 3; m++) if (m != 0) sum += exp(-4 * (2 * pi / l * pit * u - 2 * pi * m) ^ 2 / sigma1 ^ 2)
    return c1 * sqrt(pi) / (2 * sigma1) * sum + c2
  }
  function weight(l) {
    return c3 * (c1 * sqrt(pi) / (2 * sigma2) * exp(-4 * (2 * pi / l * pit * u) ^ 2 / sigma2 ^ 2) + c2) + c4
  }
  function trapezoid(j) { return (nm[j < bands ? j + 1 : j] - nm[j > 1 ? j - 1 : j]) / 2 }
  function composite(  j, m, l, s, groove) {
    groove = c0 * exp(-c5 * (u < 0 ? -u : u) ^ beta)
    for (j = 1; j <= bands; j++) f[j] = groove * strip(nm[j]) + mirror * h ^ alpha + matt
    spikes = 0
    for (m = 1; m < 20000 && c3 + c4 > 0; m++) {
      l = track * (v < 0 ? -v : v) / m
      if (l < 100) break
      if (0 in edge) {
        for (j = 1; j <= bands; j++) if (edge[j - 1] <= l && l < edge[j]) {
          f[j] += groove * weight(l) / (edge[j] - edge[j - 1]); spikes++
        }
      } else for (j = 1; j < bands; j++) if (nm[j] <= l && (l < nm[j + 1] || (j == bands - 1 && l == nm[bands]))) {
        s = (l - nm[j]) / (nm[j + 1] - nm[j]); spikes++
        f[j] += groove * weight(l) * (1 - s) / trapezoid(j)
        f[j + 1] += groove * weight(l) * s / trapezoid(j + 1)
      }
    }
  }
  function efficiency(m, l,  q, half) {
    q = wide / track; half = 2 * pi * glass * deep / l
    if (m == 0) return 1 - 4 * q * (1 - q) * sin(half) ^ 2
    return 4 * sin(half) ^ 2 * sin(pi * m * q) ^ 2 / (pi * m) ^ 2
  }
  function bell(x, sd) { return exp(-0.5 * (x / sd) ^ 2) / (sd * sqrt(2 * pi)) }
  function low(j) { return 0 in edge ? edge[j - 1] : j == 1 ? nm[1] - (nm[2] - nm[1]) / 2 : (nm[j - 1] + nm[j]) / 2 }
  function high(j) { return 0 in edge ? edge[j] : j == bands ? nm[j] + (nm[j] - nm[j - 1]) / 2 : (nm[j] + nm[j + 1]) / 2 }
  function mean_bell(j, m, sd,  a, b, k, sum) { # over the band, by the rule of Simpson
    if (bands == 1 && !(0 in edge)) return bell(v - m * nm[1] / track, sd)
    a = low(j); b = high(j)
    for (k = 0; k <= 400; k++)
      sum += (k % 400 == 0 ? 1 : k % 2 ? 4 : 2) * bell(v - m * (a + (b - a) * k / 400) / track, sd)
    return sum / 1200
  }
  function orders(spread,  j, m, sd) {
    sd = spread * pi / 180
    for (j = 1; j <= bands; j++) {
      f[j] = 0
      for (m = -12; m <= 12; m++) f[j] += efficiency(m, nm[j]) * bell(u, sd) * mean_bell(j, m, sd)
    }
  }
  function model(spread) { if (spread) orders(spread); else composite() }
  function adds(spread,  lamp, j, light) {
    find_bands("^S0[.]")
    for (lamp = 1; "lamp" lamp ".D.X" in from; lamp++) {
      look(lamp)
      model(spread)
      for (j = 1; j <= bands; j++) light[j] += f[j] * lit * from["lamp" lamp "." band[j]]
    }
    for (j = 1; j <= bands; j++) is(band[j], from[band[j]] + light[j], 4e-6)
  }
  function charted(angle, lamp, azimuth, spread,  j) {
    find_bands("^T[.]")
    aim(angle, lamp, azimuth); model(spread)
    for (j = 1; j <= bands; j++) is(band[j], pi * f[j], 4e-6)
  }
'
