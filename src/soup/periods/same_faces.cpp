#include <octafront/error.h>
#include <octafront/mend.h>

#include "base/geometry/exact_point.h"
#include "base/geometry/measures.h"
#include "soup/periods/matched.h"
#include "soup/periods/periods.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/core.h>

namespace octafront {

namespace {

using periods::CommonDivision;
using periods::FaceParts;

/// A new vertex on the edge between two faces comes to the others with the next round.
constexpr int kMostRounds = 4;

/// What a triangle of the surface is, beside its corners.
struct FaceKind {
  std::uint32_t patch;
  Sides sides;
  std::uint32_t origin;
};

class PeriodMaker {
 public:
  PeriodMaker(SurfaceMesh& surface, const std::array<bool, 3>& along, const RunContext& context)
      : surface_(surface), context_(context), tolerance_(kSamePlace * bounding_box(surface.points).diagonal()) {
    made_.cell = cell_of(bounding_box(surface.points), along);
    made_.origin.resize(surface.triangles.size());
    for (std::uint32_t t = 0; t < made_.origin.size(); ++t) made_.origin[t] = t;
    fill_in(surface);
  }

  MadePeriodic run() {
    put_on_faces();
    for (int round = 0; round < kMostRounds; ++round) {
      bool changed = false;
      for (int axis = 0; axis < 3; ++axis)
        if (made_.cell.along[axis]) changed = match(axis) || changed;
      if (!changed) break;
    }
    name_faces();
    return std::move(made_);
  }

 private:
  const PeriodicCell& cell() const { return made_.cell; }

  /// Patches and sides for all triangles, where there are none.
  static void fill_in(SurfaceMesh& surface) {
    if (surface.patch.empty()) surface.patch.assign(surface.triangles.size(), 0);
    if (surface.sides.empty()) surface.sides.assign(surface.triangles.size(), {kNone, 0});
  }

  void move(Vec3& p, Vec3 to) {
    if (p == to) return;
    ++made_.moved;
    made_.largest_move = std::max(made_.largest_move, distance(p, to));
    p = to;
  }

  /// What nearly lies on a periodic face lies on it.
  void put_on_faces() {
    for (Vec3& p : surface_.points) {
      Vec3 to = p;
      for (int axis = 0; axis < 3; ++axis) {
        if (!cell().along[axis]) continue;
        if (std::abs(p[axis] - cell().box.lo[axis]) <= tolerance_) to[axis] = cell().box.lo[axis];
        if (std::abs(p[axis] - cell().box.hi[axis]) <= tolerance_) to[axis] = cell().box.hi[axis];
      }
      move(p, to);
    }
  }

  /// Makes the two faces of the axis the same. Returns whether something changed.
  bool match(int axis) {
    context_.check();
    const CellFace low = 2 * static_cast<CellFace>(axis);
    std::array faces{periods::parts_of_face(surface_, cell(), low), periods::parts_of_face(surface_, cell(), low + 1)};
    for (CellFace k = 0; k < 2; ++k)
      if (faces[k].triangles.empty())
        throw InputError(fmt::format(
            "the body has no flat face at {} = {:.9g}, the {} end of its bounding box, so it is no cell that is "
            "periodic along {}. Give bodies that cross the faces of the cell as bodies of their own, with `box`",
            kAxisNames[axis], (k == 0 ? cell().box.lo : cell().box.hi)[axis], k == 0 ? "low" : "high",
            kAxisNames[axis]));
    bring_to_copies(axis, faces);
    if (are_same(axis, faces)) return false;
    const CommonDivision common = periods::divide_alike(surface_, cell(), axis, faces, tolerance_);
    put_in(axis, faces, common);
    return true;
  }

  /// Vertices of lines on the high face that nearly have a copy on the low one get its coordinates.
  void bring_to_copies(int axis, const std::array<FaceParts, 2>& faces) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::array<std::vector<VertexIndex>, 2> ends;
    for (int k = 0; k < 2; ++k) {
      for (const auto& [edge, part] : faces[k].lines) ends[k].insert(ends[k].end(), edge.begin(), edge.end());
      ends[k].insert(ends[k].end(), faces[k].touched.begin(), faces[k].touched.end());
      std::sort(ends[k].begin(), ends[k].end(), [&](VertexIndex a, VertexIndex b) {
        const Vec3 p = surface_.points[a], q = surface_.points[b];
        return std::array{p[u], p[v]} < std::array{q[u], q[v]};
      });
    }
    for (const VertexIndex b : ends[1]) {
      Vec3& p = surface_.points[b];
      auto at = std::lower_bound(ends[0].begin(), ends[0].end(), p[u] - tolerance_,
                                 [&](VertexIndex a, double x) { return surface_.points[a][u] < x; });
      double nearest = tolerance_;
      Vec3 to = p;
      for (; at != ends[0].end() && surface_.points[*at][u] <= p[u] + tolerance_; ++at) {
        Vec3 q = surface_.points[*at];
        q[axis] = p[axis];
        if (distance(p, q) < nearest) nearest = distance(p, q), to = q;
      }
      move(p, to);
    }
  }

  std::array<Vec3, 3> corners_seen_low(std::uint32_t t, int axis) const {
    std::array<Vec3, 3> p{};
    for (int i = 0; i < 3; ++i) {
      p[i] = surface_.points[surface_.triangles[t][i]];
      p[i][axis] = cell().box.lo[axis];
    }
    std::sort(p.begin(), p.end(), [](Vec3 a, Vec3 b) { return std::array{a.x, a.y, a.z} < std::array{b.x, b.y, b.z}; });
    return p;
  }

  bool are_same(int axis, const std::array<FaceParts, 2>& faces) const {
    std::array<std::vector<std::array<Vec3, 3>>, 2> seen;
    for (int k = 0; k < 2; ++k) {
      for (const std::uint32_t t : faces[k].triangles) seen[k].push_back(corners_seen_low(t, axis));
      std::sort(seen[k].begin(), seen[k].end(), [](const auto& s, const auto& t) {
        for (int i = 0; i < 3; ++i)
          if (s[i] != t[i]) return std::array{s[i].x, s[i].y, s[i].z} < std::array{t[i].x, t[i].y, t[i].z};
        return false;
      });
    }
    return seen[0] == seen[1];
  }

  FaceKind kind_of(std::uint32_t t) const { return {surface_.patch[t], surface_.sides[t], made_.origin[t]}; }

  /// New triangles of the surface, of which nothing is read any more.
  struct Rebuilt {
    std::vector<Triangle> triangles;
    std::vector<FaceKind> kinds;
    void add(const Triangle& t, const FaceKind& kind) { triangles.push_back(t), kinds.push_back(kind); }
  };

  void put_in(int axis, const std::array<FaceParts, 2>& faces, const CommonDivision& common) {
    std::array<std::vector<VertexIndex>, 2> vertex;
    for (int k = 0; k < 2; ++k) vertex[k] = vertices_of_nodes(axis, k, faces[k], common);
    std::map<Edge, std::vector<VertexIndex>> between;
    for (int k = 0; k < 2; ++k)
      for (const auto& [edge, nodes] : common.between[k])
        for (const std::uint32_t n : nodes) between[edge].push_back(vertex[k][n]);
    Rebuilt to;
    std::vector<std::uint8_t> on_face(surface_.triangles.size(), 0);
    for (const FaceParts& face : faces)
      for (const std::uint32_t t : face.triangles) on_face[t] = 1;
    for (std::uint32_t t = 0; t < surface_.triangles.size(); ++t)
      if (!on_face[t]) add_divided(surface_.triangles[t], kind_of(t), between, to);
    for (int k = 0; k < 2; ++k) add_pieces(axis, k, faces[k], common, vertex[k], to);
    made_.imprinted += 2 * common.pieces.size();
    take(std::move(to));
  }

  /// Vertices of the surface where the nodes are on this face, new ones where there is none.
  std::vector<VertexIndex> vertices_of_nodes(int axis, int k, const FaceParts& face, const CommonDivision& common) {
    VerticesByPlace known;
    for (const auto& [edge, part] : face.lines)
      for (const VertexIndex v : edge) known.add(surface_.points[v], v);
    for (const VertexIndex v : face.touched) known.add(surface_.points[v], v);
    std::vector<VertexIndex> vertex;
    for (Vec3 p : common.nodes) {
      p[axis] = (k == 0 ? cell().box.lo : cell().box.hi)[axis];
      VertexIndex v = known.find(p);
      if (v == kNone) {
        v = static_cast<VertexIndex>(surface_.points.size());
        surface_.points.push_back(p);
        known.add(p, v);
      }
      vertex.push_back(v);
    }
    return vertex;
  }

  /// A triangle with vertices on its edges: on[i] from corner i to the next one.
  struct Divided {
    Triangle t;
    std::array<std::vector<VertexIndex>, 3> on;
  };

  /// A triangle beside the face, divided where its edges are.
  static void add_divided(const Triangle& t, const FaceKind& kind,
                          const std::map<Edge, std::vector<VertexIndex>>& between, Rebuilt& to) {
    Divided divided{t, {}};
    for (int i = 0; i < 3; ++i) {
      const VertexIndex a = t[i], b = t[(i + 1) % 3];
      const auto at = between.find({std::min(a, b), std::max(a, b)});
      if (at == between.end()) continue;
      divided.on[i] = at->second;
      if (a > b) std::reverse(divided.on[i].begin(), divided.on[i].end());
    }
    halve(divided, kind, to);
  }

  /// Two triangles on either side of the middle vertex of an edge, and so on.
  static void halve(const Divided& d, const FaceKind& kind, Rebuilt& to) {
    int i = 0;
    while (i < 3 && d.on[i].empty()) ++i;
    if (i == 3) return to.add(d.t, kind);
    const std::vector<VertexIndex>& on = d.on[i];
    const auto middle = on.begin() + static_cast<std::ptrdiff_t>(on.size() / 2);
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    halve({{d.t[i], *middle, d.t[k]}, {std::vector(on.begin(), middle), {}, d.on[k]}}, kind, to);
    halve({{*middle, d.t[j], d.t[k]}, {std::vector(middle + 1, on.end()), d.on[j], {}}}, kind, to);
  }

  void add_pieces(int axis, int k, const FaceParts& face, const CommonDivision& common,
                  const std::vector<VertexIndex>& vertex, Rebuilt& to) const {
    for (const periods::CommonPiece& piece : common.pieces) {
      const std::uint32_t model = face.first[piece.part[k]];
      Triangle t{vertex[piece.nodes[0]], vertex[piece.nodes[1]], vertex[piece.nodes[2]]};
      if (turn(surface_.triangles[model], axis) < 0) std::swap(t[1], t[2]);
      to.add(t, kind_of(model));
    }
  }

  int turn(const Triangle& t, int axis) const {
    return arrangement::orient_along(axis, {surface_.points[t[0]]}, {surface_.points[t[1]]}, {surface_.points[t[2]]});
  }

  void take(Rebuilt rebuilt) {
    std::vector<std::uint32_t> patch, origin;
    std::vector<Sides> sides;
    for (const FaceKind& kind : rebuilt.kinds) {
      patch.push_back(kind.patch), sides.push_back(kind.sides), origin.push_back(kind.origin);
    }
    surface_.triangles = std::move(rebuilt.triangles);
    surface_.patch = std::move(patch), surface_.sides = std::move(sides), made_.origin = std::move(origin);
    drop_unused_points();
  }

  void drop_unused_points() {
    std::vector<VertexIndex> number(surface_.points.size(), kNone);
    for (const Triangle& t : surface_.triangles)
      for (const VertexIndex v : t) number[v] = 0;
    VertexIndex used = 0;
    for (VertexIndex v = 0; v < number.size(); ++v)
      if (number[v] != kNone) surface_.points[used] = surface_.points[v], number[v] = used++;
    surface_.points.resize(used);
    for (Triangle& t : surface_.triangles)
      for (VertexIndex& v : t) v = number[v];
  }

  /// Each face gets patches of its own, and each of these one copy.
  void name_faces() {
    SurfaceMesh& s = surface_;
    s.patch_names.resize(*std::max_element(s.patch.begin(), s.patch.end()) + 1);
    const std::vector<std::uint8_t> lies_on_one = patches_on_one_face();
    const PeriodicFaces faces = find_periodic_faces(s, cell());
    std::map<std::array<std::uint32_t, 7>, std::uint32_t> number;
    std::map<std::string, int> names;
    std::vector<std::uint32_t> patch = s.patch;
    std::vector<std::string> added;
    const auto key_of = [&](std::uint32_t t) {
      const std::uint32_t u = faces.other[t];
      return std::array{faces.face[t], s.patch[t],    s.sides[t][0], s.sides[t][1],
                        s.patch[u],    s.sides[u][0], s.sides[u][1]};
    };
    const auto first_new = static_cast<std::uint32_t>(s.patch_names.size());
    for (std::uint32_t t = 0; t < s.triangles.size(); ++t) {
      if (faces.face[t] == kNone) continue;
      const auto [at, is_new] = number.try_emplace(key_of(t), first_new + static_cast<std::uint32_t>(added.size()));
      if (is_new) {
        const std::string& given = s.patch_names[s.patch[t]];
        added.push_back(lies_on_one[s.patch[t]] && !given.empty() && given != kClosedByRepair
                            ? given
                            : name_of_face(faces.face[t]));
      }
      patch[t] = at->second;
    }
    for (std::string& name : added)
      if (const int n = ++names[name]; n > 1) name += fmt::format("_{}", n);
    s.patch = std::move(patch);
    s.patch_names.insert(s.patch_names.end(), added.begin(), added.end());
    drop_unused_patches();
  }

  std::vector<std::uint8_t> patches_on_one_face() const {
    std::vector<CellFace> face(surface_.patch_names.size(), kNone);
    std::vector<std::uint8_t> on_one(face.size(), 1);
    for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
      const auto [a, b, c] = surface_.triangles[t];
      const CellFace f = face_of_cell(cell(), surface_.points[a], surface_.points[b], surface_.points[c]);
      const std::uint32_t p = surface_.patch[t];
      if (f == kNone || (face[p] != kNone && face[p] != f)) on_one[p] = 0;
      face[p] = f;
    }
    return on_one;
  }

  void drop_unused_patches() {
    std::vector<std::uint32_t> number(surface_.patch_names.size(), kNone);
    for (const std::uint32_t p : surface_.patch) number[p] = 0;
    std::vector<std::string> names;
    for (std::size_t p = 0; p < number.size(); ++p) {
      if (number[p] == kNone) continue;
      number[p] = static_cast<std::uint32_t>(names.size());
      names.push_back(std::move(surface_.patch_names[p]));
    }
    for (std::uint32_t& p : surface_.patch) p = number[p];
    surface_.patch_names = std::move(names);
  }

  SurfaceMesh& surface_;
  const RunContext& context_;
  const double tolerance_;
  MadePeriodic made_;
};

}  // namespace

MadePeriodic make_periodic(SurfaceMesh& surface, const std::array<bool, 3>& along, const RunContext& context) {
  std::vector<std::uint32_t> source(surface.triangles.size());
  for (std::uint32_t t = 0; t < source.size(); ++t) source[t] = surface.source_of(t);
  const bool is_plain = surface.sides.empty();
  MadePeriodic made = PeriodMaker(surface, along, context).run();
  if (is_plain) surface.sides.clear();
  surface.source.clear();
  for (const std::uint32_t t : made.origin) surface.source.push_back(source[t]);
  return made;
}

}  // namespace octafront
