#include "geometry/predicates.h"

#include "geometry/expansion.h"

namespace octafront {

namespace {

using exact::difference;

// a * d - b * c, exactly.
template <class E>
auto minor(const E& a, const E& b, const E& c, const E& d) {
  return a * d - b * c;
}

}  // namespace

namespace detail {

int orient3d_exact(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const auto ux = difference(b.x, a.x), uy = difference(b.y, a.y), uz = difference(b.z, a.z);
  const auto vx = difference(c.x, a.x), vy = difference(c.y, a.y), vz = difference(c.z, a.z);
  const auto wx = difference(d.x, a.x), wy = difference(d.y, a.y), wz = difference(d.z, a.z);
  return (minor(vy, vz, wy, wz) * ux + minor(vz, vx, wz, wx) * uy + minor(vx, vy, wx, wy) * uz).sign();
}

int orient2d_exact(double ax, double ay, double bx, double by, double cx, double cy) {
  return minor(difference(ax, cx), difference(ay, cy), difference(bx, cx), difference(by, cy)).sign();
}

int insphere_exact(Vec3 a, Vec3 b, Vec3 c, Vec3 d, Vec3 e) {
  struct Row {
    exact::Expansion<2> x, y, z;
  };
  const auto row = [&](Vec3 p) { return Row{difference(p.x, e.x), difference(p.y, e.y), difference(p.z, e.z)}; };
  const auto lift = [](const Row& r) { return r.x * r.x + r.y * r.y + r.z * r.z; };
  const auto det3 = [](const Row& p, const Row& q, const Row& r) {
    return minor(q.y, q.z, r.y, r.z) * p.x + minor(q.z, q.x, r.z, r.x) * p.y + minor(q.x, q.y, r.x, r.y) * p.z;
  };
  const Row ra = row(a), rb = row(b), rc = row(c), rd = row(d);
  // Expanded by the column of lifts; signs so that inside is positive for a positive (a, b, c, d).
  return ((det3(rb, rc, rd) * lift(ra) - det3(ra, rc, rd) * lift(rb)) +
          (det3(ra, rb, rd) * lift(rc) - det3(ra, rb, rc) * lift(rd)))
      .sign();
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
