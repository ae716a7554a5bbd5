#include "base/core/disjoint_sets.h"
#include "base/core/groups.h"
#include "base/core/parallel.h"
#include "base/geometry/measures.h"
#include "base/geometry/plane_mesh.h"
#include "base/geometry/predicates.h"
#include "soup/arrangement/arranging.h"

#include <algorithm>
#include <cmath>

namespace octafront::arrangement {
namespace {

/// The triangles of one plane that overlap or touch, with all that cuts them.
struct Facet {
  std::vector<std::uint32_t> triangles;  ///< ascending
  std::vector<std::uint32_t> contacts;   ///< numbers of Contacts::all
};

/// At how many points three faces may cross. Soups of real things have few such points, even if parts of theirs lie on
/// each other; faces that all cross all others have a cube of their number.
constexpr std::size_t kCrossingsInAll = 50'000, kCrossingsPerFace = 10;

/// What becomes of a facet: points count from the table's; behind all of them its own crossings.
struct FacetPieces {
  struct Piece {
    std::array<std::uint32_t, 3> corners;
    std::vector<std::uint32_t> triangles;
  };
  std::vector<Piece> pieces;
  std::vector<ExactPoint> crossings;
  std::vector<std::array<std::uint32_t, 2>> equal;  ///< numbers of one point
  int axis = 0;
};

std::vector<Facet> facets_of(const Contacts& contacts, std::size_t triangles) {
  DisjointSets plane(triangles);
  std::vector<char> concerned(triangles, 0);
  for (const auto& [s, t] : contacts.coplanar) {
    plane.join(s, t);
    concerned[s] = concerned[t] = 1;
  }
  for (const Contact& c : contacts.all) concerned[c.triangle] = 1;
  std::vector<std::uint32_t> number(triangles, kNone);
  std::vector<Facet> facets;
  for (std::uint32_t t = 0; t < triangles; ++t) {
    if (!concerned[t]) continue;
    std::uint32_t& n = number[plane.find(t)];
    if (n == kNone) {
      n = static_cast<std::uint32_t>(facets.size());
      facets.emplace_back();
    }
    facets[n].triangles.push_back(t);
  }
  for (std::uint32_t c = 0; c < contacts.all.size(); ++c)
    facets[number[plane.find(contacts.all[c].triangle)]].contacts.push_back(c);
  return facets;
}

/// An axis along which the triangle is not seen as a line; the one nearest to its normal if that does.
int viewing_axis(Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 n = double_area_normal(a, b, c);
  const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
  int axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
  for (int tries = 0; tries < 3 && orient_along(axis, {a}, {b}, {c}) == 0; ++tries) axis = (axis + 1) % 3;
  return axis;
}

class FacetDivider {
 public:
  FacetDivider(const PointTable& table, std::span<const Triangle> triangles, const Contacts& contacts,
               const Facet& facet, CrossingBudget& budget)
      : table_(table), triangles_(triangles), contacts_(contacts), facet_(facet), budget_(budget) {}

  FacetPieces pieces() {
    FacetPieces result;
    const auto [a, b, c] = triangles_[facet_.triangles.front()];
    result.axis = viewing_axis(at(a), at(b), at(c));
    Box3 box;
    for (const std::uint32_t t : facet_.triangles)
      for (const VertexIndex v : triangles_[t]) box.add(at(v));
    PlaneMesh mesh(plane_through(at(a), at(b), at(c)), result.axis, box, &budget_);
    add_points(mesh, result);
    add_segments(mesh, result.axis);
    mesh.improve();
    const auto own = static_cast<std::uint32_t>(table_.size());
    for (std::size_t i = 0; i < mesh.crossings().size(); ++i) {
      set_number(mesh.first_crossing_node(i), own + static_cast<std::uint32_t>(i));
      result.crossings.push_back(mesh.crossings()[i]);
    }
    for (auto& [corners, faces] : mesh.pieces()) {
      for (std::uint32_t& f : faces) f = facet_.triangles[f];
      result.pieces.push_back({{number_[corners[0]], number_[corners[1]], number_[corners[2]]}, std::move(faces)});
    }
    return result;
  }

 private:
  Vec3 at(VertexIndex v) const { return table_.place(v).at; }

  void set_number(PlaneMesh::Node n, std::uint32_t number) {
    if (n >= number_.size()) number_.resize(n + 1, kNone);
    number_[n] = number;
  }

  void add_point(PlaneMesh& mesh, std::uint32_t p, FacetPieces& result) {
    const PlaneMesh::Node n = mesh.add_point(table_.place(p));
    if (n < number_.size() && number_[n] != kNone) {
      if (number_[n] != p) result.equal.push_back({number_[n], p});
    } else {
      set_number(n, p);
    }
    node_.push_back({p, n});
  }

  /// Vertices first, so that equal points take their numbers.
  void add_points(PlaneMesh& mesh, FacetPieces& result) {
    std::vector<std::uint32_t> points;
    for (const std::uint32_t t : facet_.triangles)
      points.insert(points.end(), triangles_[t].begin(), triangles_[t].end());
    for (const std::uint32_t c : facet_.contacts) {
      points.push_back(contacts_.all[c].a);
      if (contacts_.all[c].b != kNone) points.push_back(contacts_.all[c].b);
    }
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    for (const std::uint32_t p : points) add_point(mesh, p, result);
  }

  PlaneMesh::Node node_of(std::uint32_t p) const {
    return std::lower_bound(node_.begin(), node_.end(), std::pair(p, PlaneMesh::Node{0}))->second;
  }

  void add_segments(PlaneMesh& mesh, int axis) {
    for (std::uint32_t k = 0; k < facet_.triangles.size(); ++k)
      for (int i = 0; i < 3; ++i) {
        const Triangle& t = triangles_[facet_.triangles[k]];
        const VertexIndex a = std::min(t[i], t[(i + 1) % 3]), b = std::max(t[i], t[(i + 1) % 3]);
        mesh.add_segment(node_of(a), node_of(b), plane_along_axis(at(a), at(b), axis), k);
      }
    for (const std::uint32_t c : facet_.contacts) {
      const Contact& contact = contacts_.all[c];
      if (contact.b == kNone) continue;
      const auto [p, q, r] = triangles_[contact.other];
      mesh.add_segment(node_of(contact.a), node_of(contact.b), plane_through(at(p), at(q), at(r)));
    }
  }

  const PointTable& table_;
  std::span<const Triangle> triangles_;
  const Contacts& contacts_;
  const Facet& facet_;
  CrossingBudget& budget_;
  std::vector<std::pair<std::uint32_t, PlaneMesh::Node>> node_;  ///< of points, sorted
  std::vector<std::uint32_t> number_;                            ///< per node
};

/// Numbers of points such that equal ones have the least of theirs.
std::vector<std::uint32_t> merged_numbers(const PointTable& table, const std::vector<char>& used, DisjointSets& equal) {
  std::vector<std::uint32_t> order;
  for (std::uint32_t p = 0; p < table.size(); ++p)
    if (used[p]) order.push_back(p);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const int sign = equal.find(a) == equal.find(b) ? 0 : compare(table.place(a), table.place(b));
    return sign != 0 ? sign < 0 : a < b;
  });
  for (std::size_t i = 1; i < order.size(); ++i)
    if (compare(table.place(order[i - 1]), table.place(order[i])) == 0) equal.join(order[i - 1], order[i]);
  std::vector<std::uint32_t> number(table.size());
  for (std::uint32_t p = 0; p < table.size(); ++p) number[p] = equal.find(p);
  return number;
}

}  // namespace

Divided divide(PointTable& table, std::span<const Triangle> triangles,
               std::span<const std::array<std::uint32_t, 2>> pairs, const RunContext& context) {
  const Contacts contacts = find_contacts(table, triangles, pairs, context);
  const std::vector<Facet> facets = facets_of(contacts, triangles.size());
  std::vector<FacetPieces> made(facets.size());
  CrossingBudget budget(kCrossingsInAll + kCrossingsPerFace * triangles.size());
  parallel_for(
      facets.size(),
      [&](std::size_t f) {
        context.check();
        made[f] = FacetDivider(table, triangles, contacts, facets[f], budget).pieces();
      },
      Split::kAdaptive);

  // Crossings of facets get numbers behind all others.
  const std::uint32_t shared = table.size();
  std::vector<std::uint32_t> first_crossing;
  for (FacetPieces& m : made) {
    first_crossing.push_back(table.size());
    for (ExactPoint& x : m.crossings) table.add(std::move(x));
    m.crossings.clear();
  }
  DisjointSets equal(table.size());
  std::vector<char> used(table.size(), 0);
  for (std::size_t f = 0; f < made.size(); ++f) {
    for (const auto& [a, b] : made[f].equal) equal.join(a, b);
    for (FacetPieces::Piece& piece : made[f].pieces)
      for (std::uint32_t& p : piece.corners) {
        if (p >= shared) p += first_crossing[f] - shared;
        used[p] = 1;
      }
  }
  const std::vector<std::uint32_t> number = merged_numbers(table, used, equal);

  std::vector<std::uint32_t> facet_at(triangles.size(), kNone), facet_of(triangles.size(), kNone);
  for (std::uint32_t f = 0; f < facets.size(); ++f) {
    facet_at[facets[f].triangles.front()] = f;
    for (const std::uint32_t t : facets[f].triangles) facet_of[t] = f;
  }
  Divided result;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    if (facet_of[t] == kNone) {
      result.triangles.push_back(triangles[t]);
      result.origins.push_back({{t, false}});
    }
    if (facet_at[t] == kNone) continue;
    const FacetPieces& m = made[facet_at[t]];
    const auto turn = [&](std::uint32_t face) {
      const auto [a, b, c] = triangles[face];
      return orient_along(m.axis, table.place(a), table.place(b), table.place(c));
    };
    for (const FacetPieces::Piece& piece : m.pieces) {
      auto [a, b, c] = piece.corners;
      const int first = turn(piece.triangles.front());
      if (first < 0) std::swap(b, c);
      result.triangles.push_back({number[a], number[b], number[c]});
      result.origins.emplace_back();
      for (const std::uint32_t face : piece.triangles) result.origins.back().push_back({face, turn(face) != first});
    }
  }
  return result;
}

}  // namespace octafront::arrangement
