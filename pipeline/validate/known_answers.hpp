#pragma once

namespace selvedge {

// Answers that do not come from a cloth solver: boundary-value problems in one dimension and transcendental equations,
// solved to ten digits or so.

// A cantilever of unit length that starts level and bends under its own weight: H is how far the tip sinks, W how far
// it reaches. gamma = rho g L^3 / B > 0. theta'' = -gamma (1 - s) cos(theta), theta(0) = 0, theta'(1) = 0.
struct Cantilever {
  double H = 0, W = 0;
};
Cantilever elastica(double gamma);

// Sag over distance of a chain that is `ratio` > 1 times as long as its ends are apart, on one level.
double catenary_sag(double ratio);

// Load rho g L^3 / B at which a vertical strip clamped at its foot topples (Greenhill 1881): the first zero of the
// Bessel function J of order -1/3.
inline constexpr double greenhill_gamma = 7.8373;

// The same for a narrow strip clamped at one end and standing on its edge, B the plate stiffness E h^3 / (12 (1 -
// nu^2)): 12.85 sqrt(EI GJ) with EI = B (1 - nu^2) and GJ = 2 B (1 - nu) per width.
double lateral_buckling_gamma(double nu);

// The n-th (1, 2) root of cosh(z) cos(z) = -1; a strip clamped at one end vibrates with z^2 / (2 pi) sqrt(B / (rho
// L^4)).
double clamped_free_root(int n);

// Its shape at s in [0, 1], largest at 1.
double clamped_free_mode(double root, double s);

}  // namespace selvedge
