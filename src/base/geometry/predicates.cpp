#include "base/geometry/predicates.h"

#include "base/geometry/double_double.h"
#include "base/geometry/expansion.h"
#include "base/geometry/wide_integer.h"

// What the filters leave open goes through up to four stages, each exact when it answers:
//   1. differences on a lattice of 41 bits: 128-bit integers. Most degenerate cases of practice end here.
//   2. double-double arithmetic with an error bound: near-degenerate cases of full-precision coordinates.
//   3. coordinates on a lattice of 61 bits: wider integers. Exact degeneracies such as corners of a box.
//   4. expansions of any length: coordinates of very different magnitude. Rare.

namespace octafront {

namespace {

using exact::difference;
using exact::DoubleDouble;
using exact::exact_difference;
using exact::Int128;
using exact::WideInteger;

// Determinants of three differences below 2^41 stay within 127 bits, insphere of differences below 2^62 within 6 limbs.
constexpr int kDifferenceBits = 41, kCoordinateBits = 61;

// a * d - b * c.
template <class T>
auto minor(const T& a, const T& b, const T& c, const T& d) {
  return a * d - b * c;
}

// Rows of coordinate differences p - o, each split into the rounded difference and its error.
template <std::size_t N>
std::array<DoubleDouble, 3 * N> differences(const std::array<Vec3, N>& points, Vec3 o) {
  std::array<DoubleDouble, 3 * N> d;
  for (std::size_t i = 0; i < N; ++i) {
    d[3 * i] = exact_difference(points[i].x, o.x);
    d[3 * i + 1] = exact_difference(points[i].y, o.y);
    d[3 * i + 2] = exact_difference(points[i].z, o.z);
  }
  return d;
}

template <std::size_t N>
std::optional<std::array<std::int64_t, N>> lattice_differences(const std::array<DoubleDouble, N>& d) {
  std::array<double, N> rounded;
  for (std::size_t i = 0; i < N; ++i) {
    if (d[i].lo != 0) return std::nullopt;
    rounded[i] = d[i].hi;
  }
  return exact::on_lattice<kDifferenceBits>(rounded);
}

// Rows of coordinate differences p - o as integers of at most kCoordinateBits + 1 bits.
template <std::size_t N>
std::optional<std::array<std::int64_t, 3 * N>> coordinate_lattice(const std::array<Vec3, N>& points, Vec3 o) {
  std::array<double, 3 * N + 3> coordinates;
  for (std::size_t i = 0; i <= N; ++i)
    for (int axis = 0; axis < 3; ++axis)
      coordinates[3 * i + static_cast<std::size_t>(axis)] = i < N ? points[i][axis] : o[axis];
  const auto lattice = exact::on_lattice<kCoordinateBits>(coordinates);
  if (!lattice) return std::nullopt;
  std::array<std::int64_t, 3 * N> rows;
  for (std::size_t i = 0; i < 3 * N; ++i) rows[i] = (*lattice)[i] - (*lattice)[3 * N + i % 3];
  return rows;
}

template <class Product, class T>
Product determinant(const std::array<T, 9>& m) {
  const auto product = [](T a, T b) { return Product(a) * Product(b); };
  const Product x = product(m[4], m[8]) - product(m[5], m[7]);
  const Product y = product(m[5], m[6]) - product(m[3], m[8]);
  const Product z = product(m[3], m[7]) - product(m[4], m[6]);
  return Product(m[0]) * x + Product(m[1]) * y + Product(m[2]) * z;
}

double determinant_permanent(const std::array<DoubleDouble, 9>& d) {
  const auto m = [&](int i) { return std::abs(d[i].hi); };
  return m(0) * (m(4) * m(8) + m(5) * m(7)) + m(1) * (m(5) * m(6) + m(3) * m(8)) + m(2) * (m(3) * m(7) + m(4) * m(6));
}

WideInteger<4> wide_dot(const std::array<Int128, 3>& a, const std::array<Int128, 3>& b) {
  WideInteger<4> sum;
  for (int i = 0; i < 3; ++i) sum.add_product(WideInteger<2>(a[i]), WideInteger<2>(b[i]));
  return sum;
}

int orient3d_wide(const std::array<std::int64_t, 9>& m) {
  const auto product = [&](int i, int j) { return static_cast<Int128>(m[i]) * m[j]; };
  return wide_dot({m[0], m[1], m[2]},
                  {product(4, 8) - product(5, 7), product(5, 6) - product(3, 8), product(3, 7) - product(4, 6)})
      .sign();
}

int orient3d_expansion(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const auto ux = difference(b.x, a.x), uy = difference(b.y, a.y), uz = difference(b.z, a.z);
  const auto vx = difference(c.x, a.x), vy = difference(c.y, a.y), vz = difference(c.z, a.z);
  const auto wx = difference(d.x, a.x), wy = difference(d.y, a.y), wz = difference(d.z, a.z);
  return (minor(vy, vz, wy, wz) * ux + minor(vz, vx, wz, wx) * uy + minor(vx, vy, wx, wy) * uz).sign();
}

// The insphere determinant of four rows of differences to e, by its column of lifts: each with its 3 x 3 determinant.
// Inside is positive for a positive tetrahedron if their products are added with the signs +, -, +, -.
template <class Product>
struct InsphereTerms {
  std::array<Product, 4> minor, lift;
};

template <class Product, class T>
InsphereTerms<Product> insphere_terms(const std::array<T, 12>& m) {
  const auto x = [&](int row) { return Product(m[3 * row]); };
  const auto y = [&](int row) { return Product(m[3 * row + 1]); };
  const auto z = [&](int row) { return Product(m[3 * row + 2]); };
  const auto flat = [&](int i, int j) { return x(i) * y(j) - x(j) * y(i); };
  const Product ab = flat(0, 1), bc = flat(1, 2), cd = flat(2, 3), da = flat(3, 0), ac = flat(0, 2), bd = flat(1, 3);
  const auto lift = [&](int i) { return x(i) * x(i) + y(i) * y(i) + z(i) * z(i); };
  return {{z(1) * cd - z(2) * bd + z(3) * bc, z(2) * da + z(3) * ac + z(0) * cd, z(3) * ab + z(0) * bd + z(1) * da,
           z(0) * bc - z(1) * ac + z(2) * ab},
          {lift(0), lift(1), lift(2), lift(3)}};
}

int insphere_lattice(const std::array<std::int64_t, 12>& m) {
  const auto [n, l] = insphere_terms<Int128>(m);
  WideInteger<4> sum = wide_dot({n[0], -n[1], n[2]}, {l[0], l[1], l[2]});
  sum.add_product(WideInteger<2>(-n[3]), WideInteger<2>(l[3]));
  return sum.sign();
}

int insphere_wide(const std::array<std::int64_t, 12>& m) {
  const auto product = [&](int i, int j) { return static_cast<Int128>(m[i]) * m[j]; };
  const auto flat = [&](int i, int j) { return product(3 * i, 3 * j + 1) - product(3 * j, 3 * i + 1); };
  const auto z = [&](int i) { return static_cast<Int128>(m[3 * i + 2]); };
  const auto lift = [&](int i) {
    return WideInteger<2>(product(3 * i, 3 * i) + product(3 * i + 1, 3 * i + 1) + product(3 * i + 2, 3 * i + 2));
  };
  const Int128 ab = flat(0, 1), bc = flat(1, 2), cd = flat(2, 3), da = flat(3, 0), ac = flat(0, 2), bd = flat(1, 3);
  WideInteger<6> sum;
  sum.add_product(wide_dot({z(1), -z(2), z(3)}, {cd, bd, bc}), lift(0));
  sum.add_product(wide_dot({-z(2), -z(3), -z(0)}, {da, ac, cd}), lift(1));
  sum.add_product(wide_dot({z(3), z(0), z(1)}, {ab, bd, da}), lift(2));
  sum.add_product(wide_dot({-z(0), z(1), -z(2)}, {bc, ac, ab}), lift(3));
  return sum.sign();
}

DoubleDouble insphere_double_double(const std::array<DoubleDouble, 12>& m) {
  const auto [n, l] = insphere_terms<DoubleDouble>(m);
  return (n[0] * l[0] - n[1] * l[1]) + (n[2] * l[2] - n[3] * l[3]);
}

double insphere_permanent(const std::array<DoubleDouble, 12>& m) {
  struct Magnitude {
    double value;
    Magnitude(DoubleDouble d) : value(std::abs(d.hi)) {}
    explicit Magnitude(double v) : value(v) {}
    Magnitude operator*(Magnitude o) const { return Magnitude(value * o.value); }
    Magnitude operator+(Magnitude o) const { return Magnitude(value + o.value); }
    Magnitude operator-(Magnitude o) const { return Magnitude(value + o.value); }
  };
  const auto [n, l] = insphere_terms<Magnitude>(m);
  return (n[0] * l[0] + n[1] * l[1] + n[2] * l[2] + n[3] * l[3]).value;
}

int insphere_expansion(Vec3 a, Vec3 b, Vec3 c, Vec3 d, Vec3 e) {
  struct Row {
    exact::Expansion<2> x, y, z;
  };
  const auto row = [&](Vec3 p) { return Row{difference(p.x, e.x), difference(p.y, e.y), difference(p.z, e.z)}; };
  const auto lift = [](const Row& r) { return r.x * r.x + r.y * r.y + r.z * r.z; };
  const auto det3 = [](const Row& p, const Row& q, const Row& r) {
    return minor(q.y, q.z, r.y, r.z) * p.x + minor(q.z, q.x, r.z, r.x) * p.y + minor(q.x, q.y, r.x, r.y) * p.z;
  };
  const Row ra = row(a), rb = row(b), rc = row(c), rd = row(d);
  return ((det3(rb, rc, rd) * lift(ra) - det3(ra, rc, rd) * lift(rb)) +
          (det3(ra, rb, rd) * lift(rc) - det3(ra, rb, rc) * lift(rd)))
      .sign();
}

// Roundings on the longest path of each formula, times 8 u^2, doubled and rounded up to a power of two.
constexpr double kOrient3dBound = 0x1p-98;
constexpr double kInsphereBound = 0x1p-97;

}  // namespace

namespace detail {

int orient3d_exact(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  if (a == b || a == c || a == d || b == c || b == d || c == d) return 0;
  const auto m = differences(std::array{b, c, d}, a);
  if (const auto lattice = lattice_differences(m)) return exact::sign(determinant<Int128>(*lattice));
  const DoubleDouble det = determinant<DoubleDouble>(m);
  if (std::abs(det.hi) > kOrient3dBound * determinant_permanent(m)) return det.sign();
  if (const auto lattice = coordinate_lattice(std::array{b, c, d}, a)) return orient3d_wide(*lattice);
  return orient3d_expansion(a, b, c, d);
}

int orient2d_exact(double ax, double ay, double bx, double by, double cx, double cy) {
  const DoubleDouble acx = exact_difference(ax, cx), acy = exact_difference(ay, cy);
  const DoubleDouble bcx = exact_difference(bx, cx), bcy = exact_difference(by, cy);
  if (acx.lo == 0 && acy.lo == 0 && bcx.lo == 0 && bcy.lo == 0) {
    // Exact products as pairs compare by their rounded value, then by their error.
    const auto l = exact::two_product(acx.hi, bcy.hi), r = exact::two_product(acy.hi, bcx.hi);
    return l.hi != r.hi ? sign(l.hi - r.hi) : (l.lo > r.lo) - (l.lo < r.lo);
  }
  return minor(difference(ax, cx), difference(ay, cy), difference(bx, cx), difference(by, cy)).sign();
}

int insphere_exact(Vec3 a, Vec3 b, Vec3 c, Vec3 d, Vec3 e) {
  if (a == e || b == e || c == e || d == e) return 0;
  const auto m = differences(std::array{a, b, c, d}, e);
  if (const auto lattice = lattice_differences(m)) return insphere_lattice(*lattice);
  const DoubleDouble det = insphere_double_double(m);
  if (std::abs(det.hi) > kInsphereBound * insphere_permanent(m)) return det.sign();
  if (const auto lattice = coordinate_lattice(std::array{a, b, c, d}, e)) return insphere_wide(*lattice);
  return insphere_expansion(a, b, c, d, e);
}

}  // namespace detail

int insphere(Vec3 a, Vec3 b, Vec3 c, Vec3 d, Vec3 e) {
  const Vec3 p = a - e, q = b - e, r = c - e, s = d - e;
  const double pq = p.x * q.y, qp = q.x * p.y, qr = q.x * r.y, rq = r.x * q.y, rs = r.x * s.y, sr = s.x * r.y,
               sp = s.x * p.y, ps = p.x * s.y, pr = p.x * r.y, rp = r.x * p.y, qs = q.x * s.y, sq = s.x * q.y;
  const double ab = pq - qp, bc = qr - rq, cd = rs - sr, da = sp - ps, ac = pr - rp, bd = qs - sq;
  const double abc = p.z * bc - q.z * ac + r.z * ab, bcd = q.z * cd - r.z * bd + s.z * bc;
  const double cda = r.z * da + s.z * ac + p.z * cd, dab = s.z * ab + p.z * bd + q.z * da;
  const double pl = squared_length(p), ql = squared_length(q), rl = squared_length(r), sl = squared_length(s);
  const double det = (pl * bcd - ql * cda) + (rl * dab - sl * abc);
  const auto m = [](double x, double y) { return std::abs(x) + std::abs(y); };
  const double az = std::abs(p.z), bz = std::abs(q.z), cz = std::abs(r.z), dz = std::abs(s.z);
  const double permanent = (m(rs, sr) * bz + m(sq, qs) * cz + m(qr, rq) * dz) * pl +
                           (m(sp, ps) * cz + m(pr, rp) * dz + m(rs, sr) * az) * ql +
                           (m(pq, qp) * dz + m(qs, sq) * az + m(sp, ps) * bz) * rl +
                           (m(qr, rq) * az + m(rp, pr) * bz + m(pq, qp) * cz) * sl;
  const double bound = 1.7763568394002532e-15 * permanent;  // (16 + 224 eps) eps
  if (det > bound) return 1;
  if (det < -bound) return -1;
  return detail::insphere_exact(a, b, c, d, e);
}

bool collinear(Vec3 a, Vec3 b, Vec3 c) {
  return orient2d(a.x, a.y, b.x, b.y, c.x, c.y) == 0 && orient2d(a.y, a.z, b.y, b.z, c.y, c.z) == 0 &&
         orient2d(a.z, a.x, b.z, b.x, c.z, c.x) == 0;
}

}  // namespace octafront
