#include "images/formulas/named_surfaces.h"

#include "base/core/elementary.h"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace octafront::formulas {

namespace {

/// Larger angles are brought below it first, which is exact.
constexpr double kLargeAngle = 1e5;

double reduced(double angle) {
  return std::abs(angle) <= kLargeAngle ? angle : std::fmod(angle, 2 * std::numbers::pi);
}

/// Sines and cosines of a place, and of twice its angles.
struct Angles {
  double sx, sy, sz, cx, cy, cz;

  Angles(double x, double y, double z)
      : sx(sine(x)), sy(sine(y)), sz(sine(z)), cx(cosine(x)), cy(cosine(y)), cz(cosine(z)) {}
  double s2x() const { return 2 * sx * cx; }
  double s2y() const { return 2 * sy * cy; }
  double s2z() const { return 2 * sz * cz; }
  double c2x() const { return 2 * cx * cx - 1; }
  double c2y() const { return 2 * cy * cy - 1; }
  double c2z() const { return 2 * cz * cz - 1; }
  double doubled_pairs() const { return c2x() * c2y() + c2y() * c2z() + c2z() * c2x(); }
};

// After A. H. Schoen, "Infinite periodic minimal surfaces without self-intersections", 1970; the level sets of lowest
// order, as in M. Wohlgemuth et al., "Triply periodic bicontinuous cubic microdomain morphologies by symmetries", 2001.

double gyroid(double x, double y, double z) {
  const Angles a(x, y, z);
  return a.sx * a.cy + a.sy * a.cz + a.sz * a.cx;
}

double schwarz_p(double x, double y, double z) {
  return cosine(x) + cosine(y) + cosine(z);
}

double diamond(double x, double y, double z) {
  const Angles a(x, y, z);
  return a.sx * a.sy * a.sz + a.sx * a.cy * a.cz + a.cx * a.sy * a.cz + a.cx * a.cy * a.sz;
}

double iwp(double x, double y, double z) {
  const Angles a(x, y, z);
  return 2 * (a.cx * a.cy + a.cy * a.cz + a.cz * a.cx) - (a.c2x() + a.c2y() + a.c2z());
}

double neovius(double x, double y, double z) {
  const Angles a(x, y, z);
  return 3 * (a.cx + a.cy + a.cz) + 4 * a.cx * a.cy * a.cz;
}

double lidinoid(double x, double y, double z) {
  const Angles a(x, y, z);
  return 0.5 * (a.s2x() * a.cy * a.sz + a.s2y() * a.cz * a.sx + a.s2z() * a.cx * a.sy) - 0.5 * a.doubled_pairs() + 0.15;
}

double fischer_koch_s(double x, double y, double z) {
  const Angles a(x, y, z);
  return a.c2x() * a.sy * a.cz + a.cx * a.c2y() * a.sz + a.sx * a.cy * a.c2z();
}

double split_p(double x, double y, double z) {
  const Angles a(x, y, z);
  return 1.1 * (a.s2x() * a.sz * a.cy + a.s2y() * a.sx * a.cz + a.s2z() * a.sy * a.cx) - 0.2 * a.doubled_pairs() -
         0.4 * (a.c2x() + a.c2y() + a.c2z());
}

constexpr std::array<std::pair<std::string_view, NamedSurface>, 8> kSurfaces{{{"gyroid", gyroid},
                                                                              {"schwarz_p", schwarz_p},
                                                                              {"diamond", diamond},
                                                                              {"iwp", iwp},
                                                                              {"neovius", neovius},
                                                                              {"lidinoid", lidinoid},
                                                                              {"fischer_koch_s", fischer_koch_s},
                                                                              {"split_p", split_p}}};

}  // namespace

double sine(double angle) {
  return elementary::sin(reduced(angle));
}

double cosine(double angle) {
  return elementary::cos(reduced(angle));
}

NamedSurface named_surface(std::string_view name) {
  for (const auto& [known, surface] : kSurfaces)
    if (known == name) return surface;
  return nullptr;
}

std::vector<std::string> names_of_surfaces() {
  std::vector<std::string> names;
  for (const auto& [known, surface] : kSurfaces) names.emplace_back(known);
  return names;
}

}  // namespace octafront::formulas
