/*
 * Ruled gratings that reflect. A direction is a unit vector in the grating's own frame: x
 * along the grooves, y across them, z the normal. Both point away from the surface, to the
 * lamp and to the eye, and z >= 0.
 */
#ifndef SPEC_OPTICS_GRATING_H
#define SPEC_OPTICS_GRATING_H

/*
 * Where the light of an order goes, by the grating equation for any incidence, also out of
 * the plane across the grooves (conical diffraction): with m the order,
 *   incident.x + outgoing.x = 0,  incident.y + outgoing.y = m wavelength / pitch.
 * Given:    incident       unit vector to the lamp
 *           order          m; 0 is the mirror's, positive ones lie from there towards +y
 *           wavelength_nm  > 0, in the medium that both directions are in. A clear plane
 *                          layer over the grating changes nothing of this: it keeps both
 *                          components along the surface.
 *           pitch_nm       > 0, from groove to groove
 * Returned: 1, and outgoing, a unit vector to where the light goes, which grazes the surface
 *           (z = 0) at the most; or 0 where there is no such light (evanescent), and
 *           outgoing is left alone.
 * Source:   Vangorp & Yskout, Multispectrale rendering (2005), eq. 7.2; Harvey &
 *           Vernold, Description of diffraction grating behavior in direction cosine
 *           space, Applied Optics 37 (1998) 8158-8160.
 */
int spec_grating_direction(const double incident[3], int order, double wavelength_nm,
	double pitch_nm, double outgoing[3]);

/*
 * The lowest and the highest order that spec_grating_direction finds a direction for; all
 * between them have one. Arguments as there, pitch_nm < 1e9 wavelength_nm. Order 0 is always
 * among them: lowest <= 0 <= highest.
 */
void spec_grating_orders(const double incident[3], double wavelength_nm, double pitch_nm,
	int *lowest, int *highest);

/*
 * The phase [rad] that light gains on its way into a pit and back, at normal incidence:
 * 4 pi index depth / wavelength. Given: depth_nm >= 0; index > 0 of the medium in which the
 * light comes; wavelength_nm > 0 in vacuum.
 */
double spec_grating_phase(double depth_nm, double index, double wavelength_nm);

/*
 * The share of the reflected power that goes into an order of a lamellar grating: pits with
 * upright walls and a flat floor, as reflecting as the land between them.
 * Given:    width_ratio  q, of the pit's width to the pitch, 0..1
 *           phase_rad    phi, as spec_grating_phase
 *           order        m, of either sign: the efficiencies are the same
 * Returned: for m = 0 1 - 4 q (1 - q) sin^2(phi / 2), else
 *           4 sin^2(phi / 2) sin^2(pi m q) / (pi m)^2; in 0..1. The sum over all orders is
 *           1, for any q and phi; what is left out where some are evanescent is lost.
 * Source:   scalar diffraction (Goodman, Introduction to Fourier Optics, 2nd ed. 1996,
 *           section 4.4): |c_m|^2 of the Fourier series of a reflection that is
 *           exp(i phi) in the pits and 1 elsewhere. It knows no polarisation, and is the
 *           better the wider the pitch is against the wavelength.
 */
double spec_grating_lamellar(double width_ratio, double phase_rad, int order);

#endif
