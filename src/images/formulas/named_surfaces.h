#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace octafront::formulas {

/// A surface that repeats itself along three axes, as the level set of a function of period 2 pi.
using NamedSurface = double (*)(double x, double y, double z);

/// Null if there is none of that name.
NamedSurface named_surface(std::string_view name);
std::vector<std::string> names_of_surfaces();

/// By sine and cosine of any finite angle, exactly repeatable.
double sine(double angle);
double cosine(double angle);

}  // namespace octafront::formulas
