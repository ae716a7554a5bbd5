#include "base/geometry/expansion.h"
#include "soup/tidy/steps.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace octafront::tidy {
namespace {

/// A sum of doubles without rounding: nonoverlapping terms of increasing magnitude.
class ExactSum {
 public:
  void add(double b) {
    std::size_t kept = 0;
    for (const double term : terms_) {
      const exact::TwoDoubles s = exact::two_sum(b, term);
      b = s.hi;
      if (s.lo != 0) terms_[kept++] = s.lo;
    }
    terms_.resize(kept);
    if (b != 0) terms_.push_back(b);
  }
  int sign() const { return terms_.empty() ? 0 : terms_.back() > 0 ? 1 : -1; }

 private:
  std::vector<double> terms_;
};

void add_exact_determinant(ExactSum& sum, Vec3 a, Vec3 b, Vec3 c) {
  const auto add_product = [&](double x, double y, double z) {
    exact::Expansion<1> factor;
    factor.push(x);
    const auto product = exact::scale(exact::scale(factor, y), z);
    for (int i = 0; i < product.size; ++i) sum.add(product.term[i]);
  };
  add_product(a.x, b.y, c.z);
  add_product(-a.x, b.z, c.y);
  add_product(a.y, b.z, c.x);
  add_product(-a.y, b.x, c.z);
  add_product(a.z, b.x, c.y);
  add_product(-a.z, b.y, c.x);
}

/// A piece is closed if along each edge its own triangles run back as often as forth.
std::vector<char> closed_pieces(const std::vector<Triangle>& triangles, const EdgeTable& table, const Pieces& pieces) {
  std::vector<char> closed = pieces.orientable;
  std::vector<std::pair<std::uint32_t, int>> runs;  // piece, 1 from the smaller vertex to the larger, -1 back
  for (std::size_t e = 0; e < table.size(); ++e) {
    runs.clear();
    for (const std::uint32_t h : table.uses(e))
      runs.push_back({pieces.piece_of_triangle[h / 3], start_of(triangles, h) == table.edges[e][0] ? 1 : -1});
    if (runs.size() == 2 && runs[0].first == runs[1].first && runs[0].second != runs[1].second) continue;
    std::sort(runs.begin(), runs.end());
    for (std::size_t i = 0; i < runs.size();) {
      const std::uint32_t piece = runs[i].first;
      int balance = 0;
      for (; i < runs.size() && runs[i].first == piece; ++i) balance += runs[i].second;
      if (balance != 0) closed[piece] = 0;
    }
  }
  return closed;
}

void number_bodies(Shells& shells, const Nesting& nesting) {
  const auto count = static_cast<std::uint32_t>(nesting.depth.size());
  shells.body_of_piece.assign(count, kNone);
  for (std::uint32_t p = 0; p < count; ++p)
    if (nesting.depth[p] % 2 == 0) shells.body_of_piece[p] = shells.bodies++;
  for (std::uint32_t p = 0; p < count; ++p) {
    if (nesting.depth[p] % 2 == 0) continue;
    shells.body_of_piece[p] = shells.body_of_piece[nesting.parent[p]];
    ++shells.cavities;
  }
}

}  // namespace

std::vector<int> volume_signs(const SurfaceMesh& mesh, const Pieces& pieces) {
  const std::uint32_t count = pieces.count();
  // Measured from the middle of the model first; only pieces whose rounding error may exceed their volume are added up
  // without rounding.
  const Vec3 o = bounding_box(mesh.points).center();
  std::vector<double> volume(count, 0), error(count, 0);
  std::vector<std::uint32_t> faces(count, 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [i, j, k] = mesh.triangles[t];
    const Vec3 a = mesh.points[i] - o, b = mesh.points[j] - o, c = mesh.points[k] - o;
    const std::uint32_t p = pieces.piece_of_triangle[t];
    volume[p] += dot(a, cross(b, c));
    error[p] += length(a) * length(b) * length(c);
    ++faces[p];
  }
  std::vector<int> sign(count, 0);
  std::vector<char> doubtful(count, 0);
  bool any_doubtful = false;
  // Shifting by `o` rounds too: the error is relative to the coordinates themselves then.
  const Box3 box = bounding_box(mesh.points);
  const double shift = mesh.points.empty() ? 0 : std::max(length(box.lo), length(box.hi)), radius = box.diagonal();
  for (std::uint32_t p = 0; p < count; ++p) {
    const double bound = 1e-15 * ((faces[p] + 20.0) * error[p] + 10.0 * faces[p] * radius * radius * shift);
    doubtful[p] = !(std::abs(volume[p]) > bound);
    any_doubtful |= doubtful[p] != 0;
    sign[p] = (volume[p] > 0) - (volume[p] < 0);
  }
  if (!any_doubtful) return sign;
  std::vector<ExactSum> sums(count);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [i, j, k] = mesh.triangles[t];
    const std::uint32_t p = pieces.piece_of_triangle[t];
    if (doubtful[p]) add_exact_determinant(sums[p], mesh.points[i], mesh.points[j], mesh.points[k]);
  }
  for (std::uint32_t p = 0; p < count; ++p)
    if (doubtful[p]) sign[p] = sums[p].sign();
  return sign;
}

Shells orient_shells(Draft& draft, const Pieces& pieces) {
  SurfaceMesh& mesh = draft.mesh;
  const std::vector<char> closed = closed_pieces(mesh.triangles, draft.edges(), pieces);
  const std::vector<int> sign = volume_signs(mesh, pieces);
  const Nesting nesting = find_nesting(mesh, pieces, closed, draft.context);

  Shells shells;
  std::vector<char> turn(pieces.count(), 0);
  for (std::uint32_t p = 0; p < pieces.count(); ++p) {
    const int wanted = nesting.depth[p] % 2 == 0 ? 1 : -1;
    turn[p] = closed[p] && sign[p] == -wanted;
    if (turn[p]) ++(wanted > 0 ? shells.inside_out : shells.turned_cavities);
  }
  std::vector<char> seen(pieces.count(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint32_t p = pieces.piece_of_triangle[t];
    if (!turn[p]) continue;
    draft.known_edges.reset();
    std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    if (!seen[p])
      (nesting.depth[p] % 2 == 0 ? shells.inside_out_faces : shells.turned_cavity_faces).push_back(draft.face[t]);
    seen[p] = 1;
  }
  sort_unique(shells.inside_out_faces);
  sort_unique(shells.turned_cavity_faces);
  number_bodies(shells, nesting);
  return shells;
}

}  // namespace octafront::tidy
