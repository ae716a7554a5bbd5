#include "base/core/parallel.h"
#include "base/geometry/predicates.h"
#include "base/geometry/triangle_intersection.h"
#include "soup/arrangement/arranging.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace octafront::arrangement {
namespace {

/// An end of what two triangles share, by what meets there: a vertex; an edge and a triangle; two edges.
struct End {
  VertexIndex vertex = kNone;
  Edge edge{kNone, kNone}, other_edge{kNone, kNone};
  std::uint32_t triangle = kNone;  ///< in whose plane the edge does not lie

  /// A pair of edges is the same from either side.
  auto key() const {
    const bool pair = other_edge[0] != kNone;
    return std::tuple(vertex, pair ? std::min(edge, other_edge) : edge, pair ? std::max(edge, other_edge) : other_edge,
                      pair ? kNone : triangle);
  }
};

struct Meeting {
  bool coplanar = false;
  std::array<End, 2> end;
  int ends = 0;

  void add(const End& e) {
    for (int i = 0; i < ends; ++i)
      if (end[i].key() == e.key()) return;
    if (ends < 2) end[ends++] = e;
  }
};

class Finder {
 public:
  Finder(const PointTable& table, std::span<const Triangle> triangles) : table_(table), triangles_(triangles) {}

  Meeting meeting(std::uint32_t s, std::uint32_t t) const {
    Meeting m;
    const TriangleCorners corners = corners_of(s);
    const auto lies_in = [&](Vec3 p) { return orient3d(corners[0], corners[1], corners[2], p) == 0; };
    const TriangleCorners others = corners_of(t);
    if (std::all_of(others.begin(), others.end(), lies_in)) {
      m.coplanar = true;
      return m;
    }
    edges_on_triangle(s, t, m);
    edges_on_triangle(t, s, m);
    return m;
  }

 private:
  TriangleCorners corners_of(std::uint32_t t) const {
    const auto [a, b, c] = triangles_[t];
    return {table_.place(a).at, table_.place(b).at, table_.place(c).at};
  }

  /// Edges in the plane of t are left to t's own edges and to the other edges of s.
  void edges_on_triangle(std::uint32_t s, std::uint32_t t, Meeting& m) const {
    const TriangleCorners corners = corners_of(s), others = corners_of(t);
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const SegmentHit hit = segment_triangle_hit(corners[i], corners[j], others);
      if (hit.kind != SegmentHit::Kind::kPoint) continue;
      End end;
      const Edge own = sorted_edge(triangles_[s][i], triangles_[s][j]);
      if (hit.end >= 0) {
        end.vertex = triangles_[s][hit.end == 0 ? i : j];
      } else if (hit.part == SegmentHit::Part::kCorner) {
        end.vertex = triangles_[t][hit.index];
      } else if (hit.part == SegmentHit::Part::kEdge) {
        end = {kNone, own, sorted_edge(triangles_[t][(hit.index + 1) % 3], triangles_[t][(hit.index + 2) % 3]), t};
      } else {
        end = {kNone, own, {kNone, kNone}, t};
      }
      m.add(end);
    }
  }

  const PointTable& table_;
  std::span<const Triangle> triangles_;
};

}  // namespace

Contacts find_contacts(PointTable& table, std::span<const Triangle> triangles,
                       std::span<const std::array<std::uint32_t, 2>> pairs, const RunContext& context) {
  std::vector<Meeting> meetings(pairs.size());
  const Finder finder(table, triangles);
  parallel_for(pairs.size(), [&](std::size_t i) { meetings[i] = finder.meeting(pairs[i][0], pairs[i][1]); });
  context.check();

  std::map<decltype(End{}.key()), std::uint32_t> number;
  std::vector<End> fresh;
  const std::uint32_t first = table.size();
  const auto number_of = [&](const End& end) {
    if (end.vertex != kNone) return end.vertex;
    const auto [at, is_new] = number.try_emplace(end.key(), first + static_cast<std::uint32_t>(fresh.size()));
    if (is_new) fresh.push_back(end);
    return at->second;
  };
  Contacts contacts;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Meeting& m = meetings[i];
    const auto [s, t] = pairs[i];
    if (m.coplanar) contacts.coplanar.push_back({s, t});
    if (m.coplanar || m.ends == 0) continue;
    const std::uint32_t a = number_of(m.end[0]), b = m.ends == 2 ? number_of(m.end[1]) : kNone;
    contacts.all.push_back({s, t, a, b});
    contacts.all.push_back({t, s, a, b});
  }
  context.check();
  std::vector<ExactPoint> points(fresh.size());
  parallel_for(fresh.size(), [&](std::size_t i) {
    const auto corner = [&](int k) { return table.place(triangles[fresh[i].triangle][k]).at; };
    points[i] = line_meets_plane(table.place(fresh[i].edge[0]).at, table.place(fresh[i].edge[1]).at,
                                 plane_through(corner(0), corner(1), corner(2)));
  });
  for (ExactPoint& x : points) table.add(std::move(x));
  return contacts;
}

}  // namespace octafront::arrangement
