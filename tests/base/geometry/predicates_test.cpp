#include "base/geometry/predicates.h"

#include "base/geometry/big_integer.h"
#include "base/geometry/expansion.h"
#include "base/geometry/wide_integer.h"
#include "support/lattice_points.h"
#include "support/named_surfaces.h"

#include <array>
#include <bit>
#include <random>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace octafront {
namespace {

using testing::BigInteger;

// Enough for the lowest bit of the points that `cluster` makes.
constexpr int kFraction = 160;

struct BigRow {
  BigInteger x, y, z;
  BigRow(Vec3 p, Vec3 o) : x(minus(p.x, o.x)), y(minus(p.y, o.y)), z(minus(p.z, o.z)) {}
  static BigInteger minus(double a, double b) { return BigInteger(a, kFraction) - BigInteger(b, kFraction); }
};

BigInteger big_determinant(const BigRow& a, const BigRow& b, const BigRow& c) {
  return a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x);
}

int oracle_orient3d(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  return big_determinant({b, a}, {c, a}, {d, a}).sign();
}

// |p|^2 as a fourth coordinate, rows about e: Laplace along that column.
int oracle_insphere(Vec3 a, Vec3 b, Vec3 c, Vec3 d, Vec3 e) {
  const std::array rows{BigRow(a, e), BigRow(b, e), BigRow(c, e), BigRow(d, e)};
  BigInteger sum;
  for (int i = 0; i < 4; ++i) {
    const BigRow& r = rows[i];
    const auto other = [&](int k) { return rows[k < i ? k : k + 1]; };
    const BigInteger term = (r.x * r.x + r.y * r.y + r.z * r.z) * big_determinant(other(0), other(1), other(2));
    sum = i % 2 == 0 ? sum + term : sum - term;
  }
  return sum.sign();
}

int oracle_orient2d(Vec3 a, Vec3 b, Vec3 c) {
  const BigRow ac(a, c), bc(b, c);
  return (ac.x * bc.y - ac.y * bc.x).sign();
}

// Five points that are degenerate, nearly so, or not, of all the kinds that reach different stages of the predicates.
class Cluster {
 public:
  explicit Cluster(std::uint64_t seed) : random_(seed) {
    const int kind = integer(0, 6);
    const double scale = std::ldexp(1, integer(-20, 20));
    shift_ = integer(0, 3) == 0 ? Vec3{1e3, -2e4, 3e5} : Vec3{};
    for (Vec3& p : points) p = point(kind) * scale + shift_;
    if (integer(0, 4) == 0) points[integer(0, 4)] = points[integer(0, 4)];
  }

  std::array<Vec3, 5> points;

 private:
  int integer(int lo, int hi) { return std::uniform_int_distribution(lo, hi)(random_); }
  double real() { return std::uniform_real_distribution(-1.0, 1.0)(random_); }
  Vec3 random_vector() {
    const double x = real(), y = real();
    return {x, y, real()};
  }

  Vec3 point(int kind) {
    const Vec3 r = random_vector();
    const auto lattice = [&](double n) { return Vec3{std::round(r.x * n), std::round(r.y * n), std::round(r.z * n)}; };
    const auto on_plane = [](Vec3 p) { return Vec3{p.x, p.y, 0.3 * p.x - 0.7 * p.y + 0.1}; };
    switch (kind) {
      case 0:
        return r;
      case 1:
        return lattice(4);
      case 2:
        return lattice(1 << 20) / 1024;
      case 3:
        return on_plane(r);  // coplanar to rounding
      case 4:
        return normalized(r);  // cospherical to rounding
      case 5:
        return lattice(2) + r * 0x1p-50;  // a lattice, shaken
      default:
        return Vec3{0.1, 0.2, 0.3} + Vec3{1, 0.7, -0.4} * r.x + r * (integer(0, 1) * 0x1p-52);  // nearly a line
    }
  }

  std::mt19937_64 random_;
  Vec3 shift_;
};

Cluster any_cluster() {
  return Cluster(*rc::gen::resize(100, rc::gen::arbitrary<std::uint64_t>()));
}

constexpr int kRepeats = 20;

RC_GTEST_PROP(Predicates, HaveTheExactSign, ()) {
  for (int i = 0; i < kRepeats; ++i) {
    const auto [a, b, c, d, e] = any_cluster().points;
    RC_ASSERT(orient3d(a, b, c, d) == oracle_orient3d(a, b, c, d));
    RC_ASSERT(insphere(a, b, c, d, e) == oracle_insphere(a, b, c, d, e));
    RC_ASSERT(orient2d(a.x, a.y, b.x, b.y, c.x, c.y) == oracle_orient2d(a, b, c));
  }
}

RC_GTEST_PROP(Predicates, HaveTheExactSignBehindTheFilterToo, ()) {
  for (int i = 0; i < kRepeats; ++i) {
    const auto [a, b, c, d, e] = any_cluster().points;
    RC_ASSERT(detail::orient3d_exact(a, b, c, d) == oracle_orient3d(a, b, c, d));
    RC_ASSERT(detail::insphere_exact(a, b, c, d, e) == oracle_insphere(a, b, c, d, e));
    RC_ASSERT(detail::orient2d_exact(a.x, a.y, b.x, b.y, c.x, c.y) == oracle_orient2d(a, b, c));
  }
}

RC_GTEST_PROP(Predicates, ChangeSignWithEachExchange, ()) {
  const auto [a, b, c, d, e] = any_cluster().points;
  const int s = orient3d(a, b, c, d), t = insphere(a, b, c, d, e);
  RC_ASSERT(orient3d(b, a, c, d) == -s);
  RC_ASSERT(orient3d(a, c, b, d) == -s);
  RC_ASSERT(orient3d(a, b, d, c) == -s);
  RC_ASSERT(insphere(b, a, c, d, e) == -t);
  RC_ASSERT(insphere(a, c, b, d, e) == -t);
  RC_ASSERT(insphere(a, b, d, c, e) == -t);
  // In and out change places with e as with any row, where the tetrahedra are not flat.
  RC_ASSERT(insphere(a, b, c, e, d) == -t);
  RC_ASSERT(orient2d(a.x, a.y, b.x, b.y, c.x, c.y) == -orient2d(b.x, b.y, a.x, a.y, c.x, c.y));
  RC_ASSERT(orient2d(a.x, a.y, b.x, b.y, c.x, c.y) == orient2d(b.x, b.y, c.x, c.y, a.x, a.y));
}

RC_GTEST_PROP(Predicates, DoNotChangeWithExactTranslationAndScale, ()) {
  std::array<Vec3, 5> p;
  for (Vec3& v : p) v = testing::lattice_point(3);
  const Vec3 shift = testing::lattice_point(1 << 20);
  const double scale = std::ldexp(1.0, *rc::gen::resize(100, rc::gen::inRange(-100, 130)));
  std::array<Vec3, 5> q = p;
  for (Vec3& v : q) v = (v + shift) * scale;
  RC_ASSERT(orient3d(p[0], p[1], p[2], p[3]) == orient3d(q[0], q[1], q[2], q[3]));
  RC_ASSERT(insphere(p[0], p[1], p[2], p[3], p[4]) == insphere(q[0], q[1], q[2], q[3], q[4]));
  RC_ASSERT(collinear(p[0], p[1], p[2]) == collinear(q[0], q[1], q[2]));
}

RC_GTEST_PROP(Collinear, IsExact, ()) {
  for (int i = 0; i < kRepeats; ++i) {
    const auto points = any_cluster().points;
    const Vec3 a = points[0], b = points[1], c = points[2];
    const BigRow u(b, a), v(c, a);
    const bool expected = (u.y * v.z - u.z * v.y).sign() == 0 && (u.z * v.x - u.x * v.z).sign() == 0 &&
                          (u.x * v.y - u.y * v.x).sign() == 0;
    RC_ASSERT(collinear(a, b, c) == expected);
  }
}

TEST(Collinear, SeesOneUlp) {
  EXPECT_TRUE(collinear({0.1, 0.1, 0.1}, {0.7, 0.7, 0.7}, {0.3, 0.3, 0.3}));
  EXPECT_FALSE(collinear({0.1, 0.1, 0.1}, {0.7, 0.7, 0.7}, {0.3, 0.3, std::nextafter(0.3, 1.0)}));
  EXPECT_TRUE(collinear({1, 2, 3}, {1, 2, 3}, {4, 5, 6}));
}

TEST(Orient3d, UnitTetrahedronIsPositive) {
  EXPECT_EQ(orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}), 1);
  EXPECT_EQ(orient3d({0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}), -1);
}

TEST(Predicates, DoNotTrustRoundedDifferences) {
  // The differences to the first point round to small integers that are coplanar; the points are not.
  const Vec3 a{0x1p-60, 0, 0}, b{1, 1, 1}, c{2, 3, 5}, d{3, 4, 6};
  EXPECT_EQ(orient3d(a, b, c, d), oracle_orient3d(a, b, c, d));
  EXPECT_NE(orient3d(a, b, c, d), 0);
  // The same with a cube's corners about the last point.
  const std::array<Vec3, 4> corners{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}}};
  const int sign = insphere(corners[0], corners[1], corners[2], corners[3], a);
  EXPECT_EQ(sign, oracle_insphere(corners[0], corners[1], corners[2], corners[3], a));
  EXPECT_NE(sign, 0);
}

TEST(Insphere, UnitTetrahedronHoldsItsCentroidAndNotTheFarCorner) {
  const Vec3 a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0}, d{0, 0, 1};
  EXPECT_EQ(insphere(a, b, c, d, {0.25, 0.25, 0.25}), 1);
  EXPECT_EQ(insphere(a, b, c, d, {1, 1, 1}), 0);
  EXPECT_EQ(insphere(a, b, c, d, {1, 1, std::nextafter(1.0, 0.0)}), 1);
  EXPECT_EQ(insphere(a, b, c, d, {1, 1, std::nextafter(1.0, 2.0)}), -1);
  EXPECT_EQ(insphere(b, a, c, d, {1, 1, std::nextafter(1.0, 2.0)}), 1);
}

TEST(Predicates, AreExactAtTheEndsOfTheirRange) {
  for (const double s : {1e-40, 1e50}) {
    const double above = std::nextafter(s, 2 * s);
    EXPECT_EQ(orient3d({0, 0, s}, {s, 0, s}, {0, s, s}, {s, s, s}), 0);
    EXPECT_EQ(orient3d({0, 0, s}, {s, 0, s}, {0, s, s}, {s, s, above}), 1);
    EXPECT_EQ(insphere({0, 0, 0}, {s, 0, 0}, {0, s, 0}, {0, 0, s}, {s, s, s}), 0);
    EXPECT_EQ(insphere({0, 0, 0}, {s, 0, 0}, {0, s, 0}, {0, 0, s}, {s, s, above}), -1);
    EXPECT_EQ(insphere({0, 0, 0}, {s, 0, 0}, {0, s, 0}, {0, 0, s}, {s, s, std::nextafter(s, 0.0)}), 1);
  }
}

RC_GTEST_PROP(WideInteger, SumsProductsExactly, ()) {
  std::mt19937_64 random(*rc::gen::arbitrary<std::uint64_t>());
  // Signed integers of up to 112 bits as high * 2^60 + low, so that doubles can carry them to the oracle.
  const auto half = [&] { return static_cast<std::int64_t>(random() >> 12) - (std::int64_t{1} << 51); };
  exact::WideInteger<4> sum;
  exact::WideInteger<6> cubes;
  BigInteger expected, expected_cubes;
  for (int i = 0; i < 6; ++i) {
    std::array<std::int64_t, 4> h{half(), half(), half(), half()};
    if (i % 2 == 1) h[0] = h[2] = 0;
    const auto wide = [&](int k) { return exact::Int128(h[k]) * (exact::Int128(1) << 60) + h[k + 1]; };
    const auto big = [&](int k) {
      return BigInteger(static_cast<double>(h[k]), 60) + BigInteger(static_cast<double>(h[k + 1]), 0);
    };
    sum.add_product(exact::WideInteger<2>(wide(0)), exact::WideInteger<2>(wide(2)));
    expected = expected + big(0) * big(2);
    RC_ASSERT(sum.sign() == expected.sign());
    cubes.add_product(sum, exact::WideInteger<2>(wide(0)));
    expected_cubes = expected_cubes + expected * big(0);
    RC_ASSERT(cubes.sign() == expected_cubes.sign());
  }
  exact::WideInteger<4> zero;
  zero.add_product(exact::WideInteger<2>(-3), exact::WideInteger<2>(7));
  zero.add_product(exact::WideInteger<2>(21), exact::WideInteger<2>(1));
  RC_ASSERT(zero.sign() == 0);
}

// Corners of a box are cospherical and in fours coplanar, whatever doubles its sides have.
RC_GTEST_PROP(Predicates, KnowTheCornersOfAnyBox, ()) {
  std::mt19937_64 random(*rc::gen::resize(100, rc::gen::arbitrary<std::uint64_t>()));
  std::uniform_real_distribution<double> real(-1, 1);
  const double thin = std::ldexp(1.0, -*rc::gen::resize(100, rc::gen::inRange(0, 60)));
  const Vec3 lo{real(random), real(random), real(random)}, hi{real(random) * thin, real(random), real(random)};
  const auto corner = [&](int i) { return Vec3{i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z}; };
  for (const auto& [a, b, c, d] : {std::array{0, 1, 2, 3}, {0, 1, 6, 7}, {1, 3, 4, 6}, {0, 3, 4, 7}})
    RC_ASSERT(orient3d(corner(a), corner(b), corner(c), corner(d)) ==
              oracle_orient3d(corner(a), corner(b), corner(c), corner(d)));
  for (int e = 0; e < 8; ++e) {
    RC_ASSERT(insphere(corner(0), corner(1), corner(2), corner(4), corner(e)) == 0);
    RC_ASSERT(insphere(corner(1), corner(7), corner(4), corner(2), corner(e)) == 0);
  }
}

TEST(NamedSurfaces, FaceOutward) {
  for (const SurfaceMesh& s : {testing::cube(3), testing::unit_tetrahedron(), testing::icosphere(2),
                               testing::torus(12, 8), testing::hollow_sphere(1)})
    EXPECT_GT(enclosed_volume(s), 0);
}

}  // namespace
}  // namespace octafront
