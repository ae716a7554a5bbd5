// The slow step of the validity test. Two convex sets that share a simplex meet in nothing else if and only if no
// extreme point of their intersection lies off that simplex; the extreme points of (tetrahedron, triangle) are where an
// edge of one meets a face of the other. Each such meeting is decided by the signs of orient3d, and by orient2d in the
// common plane where they vanish: a conservative answer there would leave faces unfilled on every flat side of a model.

#include "fill/front/meeting.h"

#include <octafront/tet_mesh.h>

#include "base/geometry/predicates.h"

#include <algorithm>

namespace octafront {

namespace {

/// Projection along a coordinate axis that keeps a given triangle non-degenerate, mirrored if needed so that it turns
/// counter-clockwise.
class Projection {
 public:
  Projection(const NamedPoint& a, const NamedPoint& b, const NamedPoint& c) {
    for (u_ = 0; u_ < 3; ++u_) {
      v_ = (u_ + 1) % 3;
      const int turn = orientation(a, b, c);
      if (turn == 0) continue;
      if (turn < 0) std::swap(u_, v_);
      return;
    }
    u_ = 0, v_ = 1;  // degenerate triangle: excluded by contract
  }
  int orientation(const NamedPoint& a, const NamedPoint& b, const NamedPoint& c) const {
    return orient2d(a.at[u_], a.at[v_], b.at[u_], b.at[v_], c.at[u_], c.at[v_]);
  }
  /// p on the closed segment (a, b), given that the three are collinear.
  bool between(const NamedPoint& a, const NamedPoint& b, const NamedPoint& p) const {
    const auto inside = [](double l, double r, double x) { return (l <= x && x <= r) || (r <= x && x <= l); };
    return inside(a.at[u_], b.at[u_], p.at[u_]) && inside(a.at[v_], b.at[v_], p.at[v_]);
  }

 private:
  int u_ = 0, v_ = 1;
};

using Corners = std::array<const NamedPoint*, 3>;

bool in_closed_triangle(const Projection& plane, const Corners& t, const NamedPoint& p) {
  return plane.orientation(*t[0], *t[1], p) >= 0 && plane.orientation(*t[1], *t[2], p) >= 0 &&
         plane.orientation(*t[2], *t[0], p) >= 0;
}

bool closed_segments_meet(const Projection& plane, const NamedPoint& p, const NamedPoint& q, const NamedPoint& a,
                          const NamedPoint& b) {
  const int pa = plane.orientation(p, q, a), pb = plane.orientation(p, q, b);
  if (pa * pb > 0) return false;
  const int ap = plane.orientation(a, b, p), aq = plane.orientation(a, b, q);
  if (ap * aq > 0) return false;
  if (pa == 0 && plane.between(p, q, a)) return true;
  if (pb == 0 && plane.between(p, q, b)) return true;
  if (ap == 0 && plane.between(a, b, p)) return true;
  if (aq == 0 && plane.between(a, b, q)) return true;
  return pa * pb < 0 && ap * aq < 0;
}

/// The segment leaves the triangle's corner t[i] (it is one of its ends) towards q, in the triangle's plane.
bool runs_into_triangle(const Projection& plane, const Corners& t, int i, const NamedPoint& q) {
  const NamedPoint &a = *t[i], &b = *t[(i + 1) % 3], &c = *t[(i + 2) % 3];
  return plane.orientation(a, b, q) >= 0 && plane.orientation(a, q, c) >= 0;
}

bool coplanar_segment_meets(const NamedPoint& p, const NamedPoint& q, const Corners& t, int shared_p, int shared_q) {
  const Projection plane(*t[0], *t[1], *t[2]);
  if (shared_p >= 0) return runs_into_triangle(plane, t, shared_p, q);
  if (shared_q >= 0) return runs_into_triangle(plane, t, shared_q, p);
  if (in_closed_triangle(plane, t, p) || in_closed_triangle(plane, t, q)) return true;
  for (int i = 0; i < 3; ++i)
    if (closed_segments_meet(plane, p, q, *t[i], *t[(i + 1) % 3])) return true;
  return false;
}

int find_corner(const Corners& t, std::uint32_t id) {
  for (int i = 0; i < 3; ++i)
    if (t[i]->id == id) return i;
  return -1;
}

/// The segment (p, q) meets the closed triangle in more than the corners they share. sp, sq: signs of p and q against
/// the triangle's plane.
bool segment_meets(const NamedPoint& p, const NamedPoint& q, const Corners& t, int sp, int sq) {
  if (sp * sq > 0) return false;
  const int shared_p = find_corner(t, p.id), shared_q = find_corner(t, q.id);
  if (shared_p >= 0 && shared_q >= 0) return false;
  if (sp == 0 && sq == 0) return coplanar_segment_meets(p, q, t, shared_p, shared_q);
  if (sp == 0 || sq == 0) {
    if ((sp == 0 ? shared_p : shared_q) >= 0) return false;
    return in_closed_triangle(Projection(*t[0], *t[1], *t[2]), t, sp == 0 ? p : q);
  }
  int least = 1, most = -1;
  for (int i = 0; i < 3; ++i) {
    const int s = orient3d(p.at, q.at, t[i]->at, t[(i + 1) % 3]->at);
    least = std::min(least, s);
    most = std::max(most, s);
  }
  return least >= 0 || most <= 0;
}

/// The signs on which the planes through a tetrahedron's faces and a triangle's plane decide. First those of which
/// floating point is sure, 0 where it is not: they settle nearly all cases.
class Planes {
 public:
  Planes(const std::array<NamedPoint, 4>& t, const std::array<NamedPoint, 3>& f) : t_(t), f_(f) {
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 4; ++i)
        if (t[i].id == f[j].id) shared_f[j] = i, shared_t[i] = j;
  }

  /// The triangle's plane, or one of the tetrahedron, has the other strictly on one side but for shared corners.
  template <class Sign>
  bool triangle_separates(const Sign& sign) {
    bool above = true, below = true;
    for (int i = 0; i < 4; ++i) {
      if (shared_t[i] >= 0) continue;
      if (side[i] == 0) side[i] = sign(f_[0].at, f_[1].at, f_[2].at, t_[i].at);
      above = above && side[i] > 0;
      below = below && side[i] < 0;
    }
    return above || below;
  }
  template <class Sign>
  bool tet_separates(const Sign& sign) {
    for (int i = 0; i < 4; ++i) {
      const auto& c = kTetFaces[i];
      bool separates = true;
      for (int j = 0; j < 3; ++j) {
        if (shared_f[j] >= 0)
          outer[i][j] = shared_f[j] == i ? -1 : 0;
        else if (outer[i][j] == 0)
          outer[i][j] = sign(t_[c[0]].at, t_[c[1]].at, t_[c[2]].at, f_[j].at);
        separates = separates && (outer[i][j] > 0 || (shared_f[j] >= 0 && shared_f[j] != i));
      }
      if (separates) return true;
    }
    return false;
  }

  /// The one corner that both share lies on a plane through an edge of each that has them strictly apart. Its signs are
  /// those that are known: that of corner m against the plane through corner k and a corner l of the triangle is that
  /// of l against the plane through k and m.
  bool edges_separate() const {
    int j = -1;
    for (int i = 0; i < 3; ++i)
      if (shared_f[i] >= 0) {
        if (j >= 0) return false;
        j = i;
      }
    if (j < 0) return false;
    const auto& ring = kTetFaces[shared_f[j]];
    for (int turn = 0; turn < 3; ++turn) {
      const int k = ring[turn], m = ring[(turn + 1) % 3], n = ring[(turn + 2) % 3];
      for (const int step : {1, 2}) {
        const int l = (j + step) % 3, of_tet = outer[n][l], of_triangle = step == 1 ? side[k] : -side[k];
        if (of_tet != 0 && outer[m][l] == -of_tet && of_triangle == -of_tet) return true;
      }
    }
    return false;
  }

  int shared_f[3] = {-1, -1, -1}, shared_t[4] = {-1, -1, -1, -1};
  int outer[4][3] = {};  ///< of the triangle's corners against the planes of the tetrahedron, +1 on the outer side
  int side[4] = {};      ///< of the tetrahedron's corners against the plane of the triangle

 private:
  const std::array<NamedPoint, 4>& t_;
  const std::array<NamedPoint, 3>& f_;
};

}  // namespace

bool meets_beyond_shared_simplex(const std::array<NamedPoint, 4>& t, const std::array<NamedPoint, 3>& f) {
  Planes planes(t, f);
  if (planes.triangle_separates(orient3d_filter) || planes.tet_separates(orient3d_filter) || planes.edges_separate())
    return false;
  if (planes.triangle_separates(orient3d) || planes.tet_separates(orient3d)) return false;
  const auto& outer = planes.outer;
  for (int j = 0; j < 3; ++j)
    if (planes.shared_f[j] < 0 && outer[0][j] <= 0 && outer[1][j] <= 0 && outer[2][j] <= 0 && outer[3][j] <= 0)
      return true;
  const Corners triangle{&f[0], &f[1], &f[2]};
  for (const auto& [i, j] : kTetEdges)
    if (segment_meets(t[i], t[j], triangle, planes.side[i], planes.side[j])) return true;
  for (int i = 0; i < 4; ++i) {
    const auto& c = kTetFaces[i];
    const Corners face{&t[c[0]], &t[c[1]], &t[c[2]]};
    for (int j = 0; j < 3; ++j) {
      const int k = (j + 1) % 3;
      if (segment_meets(f[j], f[k], face, outer[i][j], outer[i][k])) return true;
    }
  }
  return false;
}

}  // namespace octafront
