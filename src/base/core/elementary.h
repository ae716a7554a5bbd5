#pragma once

#include <cmath>
#include <cstdint>

/// Elementary functions that give the same bits on every processor, with every compiler and C library: only sums,
/// products, quotients and roots, which IEEE 754 fixes. The C library's own differ from one variant for a processor to
/// the next in the last bit, and a decision depends on it sooner or later. Errors are of one or two units in the last
/// place. The series are those of every textbook (M. Abramowitz, I. Stegun, Handbook of Mathematical Functions, 4).
namespace octafront::elementary {

/// For any x; 0 below the least double, infinity above the largest.
double exp(double x);
/// Of x > 0; minus infinity of 0, not a number below.
double log(double x);
/// Exact where x is whole.
double exp2(double x);
/// Exact where x is a power of two.
double log2(double x);
/// Of x > 0.
double pow(double x, double exponent);
/// By products.
double pow(double x, int exponent);
double cbrt(double x);
/// Radians, up to 10^5 of them.
double sin(double x);
double cos(double x);
double tan(double x);
/// In [-pi, pi]; 0 of (0, 0).
double atan2(double y, double x);
/// Of x in [-1, 1].
double acos(double x);
double hypot(double x, double y);

}  // namespace octafront::elementary
