#include <octafront/quality.h>
#include <octafront/run_context.h>

#include "base/core/flat_map.h"
#include "base/core/parallel.h"
#include "base/core/wording.h"
#include "base/geometry/curved_tet.h"
#include "base/mesh/adjacency.h"
#include "base/mesh/face_table.h"
#include "base/mesh/quadratic_nodes.h"
#include "base/places/places.h"
#include "report/picture/scales.h"
#include "report/picture/scene.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

namespace octafront {

namespace {

using Color = PictureOptions::Color;

std::uint32_t numbers_in(const std::vector<std::uint32_t>& parts) {
  return parts.empty() ? 1 : 1 + *std::ranges::max_element(parts);
}

/// What of a mesh is highlighted.
struct MeshMarks {
  std::vector<std::uint32_t> faces;  ///< per boundary face and interface its place; kNone: none; empty: none has any
  std::vector<std::uint32_t> tets;   ///< the same of elements
  std::vector<std::pair<std::uint32_t, std::vector<Vec3>>> lines;
};

void add_marked_lines(const TetMesh& mesh, const MeshItems& items, std::uint32_t place, MeshMarks& marks) {
  for (const std::uint32_t e : items.edges) {
    const Edge& edge = mesh.curve_edges[e];
    marks.lines.push_back({place, {mesh.points[edge[0]], mesh.points[edge[1]]}});
  }
  constexpr std::size_t kMostDots = 20'000;
  if (items.nodes.size() <= kMostDots)
    for (const std::uint32_t v : items.nodes) marks.lines.push_back({place, {mesh.points[v]}});
}

MeshMarks marks_in(const TetMesh& mesh, const std::vector<std::string>& places) {
  MeshMarks marks;
  for (std::uint32_t k = 0; k < places.size(); ++k) {
    const MeshItems items = items_at(mesh, "--highlight", place_of("--highlight", places[k]));
    // A box has all kinds of things in it: elements, else faces.
    const bool has_solid = !items.tets.empty() || !items.faces.empty();
    if (!items.tets.empty()) marks.tets.resize(mesh.tets.size(), kNone);
    if (!items.faces.empty()) marks.faces.resize(mesh.boundary.size() + mesh.interfaces.size(), kNone);
    for (const std::uint32_t t : items.tets) marks.tets[t] = k;
    for (const std::uint32_t f : items.faces) marks.faces[f] = k;
    if (!has_solid) add_marked_lines(mesh, items, k, marks);
  }
  return marks;
}

/// The scene of a mesh, face by face.
class MeshScene {
 public:
  MeshScene(const TetMesh& mesh, const PictureOptions& options, const RunContext& context)
      : mesh_(mesh),
        options_(options),
        context_(context),
        color_(chosen_color()),
        marks_(marks_in(mesh, options.highlight)) {
    if (color_ == Color::kSize) sizes_ = size_range(mesh);
    if (options.cut) find_beyond(CutPlane(*options.cut, mesh.points));
    scene_.marks = options.highlight.size();
    scene_.marked_lines = marks_.lines;
    scene_.is_closed = true;
  }

  Scene made() {
    if (options_.worst)
      add_around_worst();
    else
      add_faces();
    if (!options_.worst) add_marked_faces();
    finish();
    return std::move(scene_);
  }

 private:
  void find_beyond(const CutPlane& plane) {
    beyond_.resize(mesh_.points.size());
    parallel_for(beyond_.size(), [&](std::size_t v) { beyond_[v] = plane.beyond(mesh_.points[v]); });
  }
  bool is_shown(std::size_t t) const {
    return beyond_.empty() || std::ranges::any_of(mesh_.tets[t], [&](VertexIndex v) { return !beyond_[v]; });
  }
  Color chosen_color() const {
    if (options_.color != Color::kAuto) return options_.color;
    if (!options_.highlight.empty()) return Color::kPlain;
    return numbers_in(mesh_.region) > 1 && !options_.worst ? Color::kRegion : Color::kQuality;
  }
  std::uint32_t region_of(std::size_t t) const { return mesh_.region.empty() ? 0 : mesh_.region[t]; }
  std::uint32_t patch_of(std::size_t face) const {
    if (face == kNone) return kNone;
    if (face < mesh_.boundary.size()) return mesh_.patch.empty() ? 0 : mesh_.patch[face];
    return mesh_.interface_patch.empty() ? 0 : mesh_.interface_patch[face - mesh_.boundary.size()];
  }
  std::array<Vec3, 4> corners(std::size_t t) const {
    const Tet& v = mesh_.tets[t];
    return {mesh_.points[v[0]], mesh_.points[v[1]], mesh_.points[v[2]], mesh_.points[v[3]]};
  }

  Rgb colour_of(std::size_t t, std::size_t face) const {
    switch (color_) {
      case Color::kQuality: {
        const auto [a, b, c, d] = corners(t);
        return on_scale(kPoorToGood, radius_ratio(a, b, c, d));
      }
      case Color::kSize:
        return on_scale(kSmallToLarge, sizes_.share(mean_edge(mesh_, t)));
      case Color::kRegion:
        return colour_of_part(region_of(t));
      case Color::kPatch:
        return face == kNone ? kGrey : colour_of_part(patch_of(face));
      default:
        return kGrey;
    }
  }
  std::uint32_t mark_of(std::size_t t, std::size_t face) const {
    if (face != kNone && !marks_.faces.empty() && marks_.faces[face] != kNone) return marks_.faces[face];
    return marks_.tets.empty() ? kNone : marks_.tets[t];
  }

  /// Face i of element t; `face`: its number among boundary faces and interfaces, or kNone.
  void add(std::size_t t, int i, std::uint32_t face) {
    SceneFace& made = scene_.faces.emplace_back();
    made.mark = mark_of(t, face);
    made.front = made.back = made.mark != kNone ? colour_of_mark(made.mark) : colour_of(t, face);
    const bool is_outer = face != kNone && face < mesh_.boundary.size();
    made.part = color_ == Color::kRegion ? region_of(t) : patch_of(face);
    const Triangle v = face_of(mesh_.tets[t], i);
    scene_.triangles.push_back({{mesh_.points[v[0]], mesh_.points[v[1]], mesh_.points[v[2]]},
                                static_cast<std::uint32_t>(scene_.faces.size() - 1),
                                {line(), line(), line()}});
    corners_.push_back(v);
    tets_.push_back(static_cast<TetIndex>(t));
    is_outer_.push_back(is_outer);
    parts_.push_back(is_outer ? patch_of(face) : color_ == Color::kRegion ? made.part : 0);
  }
  EdgeLine line() const {
    using Edges = PictureOptions::Edges;
    return options_.edges == Edges::kAuto || options_.edges == Edges::kElements ? EdgeLine::kThin : EdgeLine::kAbsent;
  }

  void add_faces() {
    const std::vector<char>& beyond = beyond_;
    const FlatMap<Triangle, std::uint32_t> outer = boundary_by_corners();
    std::vector<char> is_outer(mesh_.points.size(), 0);
    for (const Triangle& f : mesh_.boundary)
      for (const VertexIndex v : f) is_outer[v] = 1;
    struct Seen {
      std::uint32_t tet, face;
      int side;
    };
    // An element is shown if one of its corners is not beyond: inside the faces between shown ones and others are those
    // of three corners beyond.
    const std::vector<Seen> seen = parallel_collect<Seen>(
        mesh_.tets.size(), 65536, [&](std::size_t begin, std::size_t end, std::vector<Seen>& out) {
          context_.check();
          for (std::size_t t = begin; t < end; ++t) {
            const Tet& v = mesh_.tets[t];
            const int gone = beyond.empty() ? 0 : beyond[v[0]] + beyond[v[1]] + beyond[v[2]] + beyond[v[3]];
            if (gone == 4) continue;
            const int outside = is_outer[v[0]] + is_outer[v[1]] + is_outer[v[2]] + is_outer[v[3]];
            for (int i = 0; i < 4; ++i) {
              const bool may_be_outer = outside - is_outer[v[i]] == 3, is_cut = gone == 3 && !beyond[v[i]];
              if (!may_be_outer && !is_cut) continue;
              const std::uint32_t* face = may_be_outer ? outer.find(face_key(face_of(v, i))) : nullptr;
              if (face != nullptr || is_cut)
                out.push_back({static_cast<std::uint32_t>(t), face == nullptr ? kNone : *face, i});
            }
          }
        });
    for (const Seen& s : seen) add(s.tet, s.side, s.face);
  }
  FlatMap<Triangle, std::uint32_t> boundary_by_corners() const {
    FlatMap<Triangle, std::uint32_t> outer(mesh_.boundary.size());
    for (std::uint32_t f = 0; f < mesh_.boundary.size(); ++f) outer.find_or_add(face_key(mesh_.boundary[f]), f);
    return outer;
  }

  /// What is highlighted inside: interfaces, and faces between elements that are and others.
  void add_marked_faces() {
    const bool has_interfaces =
        !marks_.faces.empty() && std::any_of(marks_.faces.begin() + static_cast<std::ptrdiff_t>(mesh_.boundary.size()),
                                             marks_.faces.end(), [](std::uint32_t m) { return m != kNone; });
    if (!has_interfaces && marks_.tets.empty()) return;
    FlatMap<Triangle, std::uint32_t> interfaces(mesh_.interfaces.size());
    for (std::uint32_t f = 0; has_interfaces && f < mesh_.interfaces.size(); ++f)
      interfaces.find_or_add(face_key(mesh_.interfaces[f]), static_cast<std::uint32_t>(mesh_.boundary.size()) + f);
    const std::vector<HalfFace> across = half_face_neighbors(mesh_.tets, mesh_.points.size());
    for (HalfFace h = 0; h < across.size(); ++h) {
      if (across[h] == kNone || !is_shown(h / 4)) continue;
      const std::uint32_t* face = has_interfaces ? interfaces.find(face_key(corners_of(mesh_.tets, h))) : nullptr;
      const bool is_interface = face != nullptr && marks_.faces[*face] != kNone;
      const bool is_wall =
          !marks_.tets.empty() && marks_.tets[h / 4] != kNone && marks_.tets[across[h] / 4] != marks_.tets[h / 4];
      if (is_interface || is_wall) add(h / 4, static_cast<int>(h % 4), is_interface ? *face : kNone);
    }
  }

  /// Elements near the worst one, but for those before it.
  void add_around_worst() {
    const PoorElement worst = worst_elements(mesh_, 1).front();
    const Vec3 back = normalized(*options_.view);
    double reach = 0;
    for (const Vec3 p : corners(worst.tet)) reach = std::max(reach, distance(p, worst.at));
    constexpr double kShown = 16;  // its size, around it; the picture shows somewhat less
    const auto depth = [&](Vec3 p) { return dot(p - worst.at, back); };
    std::vector<std::uint32_t> shown;
    for (std::uint32_t t = 0; t < mesh_.tets.size(); ++t) {
      const auto c = corners(t);
      Box3 box;
      for (const Vec3 p : c) box.add(p);
      const Vec3 nearest = max(box.lo, min(box.hi, worst.at));
      if (distance(nearest, worst.at) > kShown * reach) continue;
      if (t == worst.tet || depth(0.25 * (c[0] + c[1] + c[2] + c[3])) <= 0) shown.push_back(t);
    }
    std::vector<Tet> tets;
    for (const std::uint32_t t : shown) tets.push_back(mesh_.tets[t]);
    const FlatMap<Triangle, std::uint32_t> outer = boundary_by_corners();
    const std::vector<HalfFace> across = half_face_neighbors(tets, mesh_.points.size());
    for (HalfFace h = 0; h < across.size(); ++h) {
      if (across[h] != kNone) continue;
      const std::uint32_t* face = outer.find(face_key(corners_of(tets, h)));
      add(shown[h / 4], static_cast<int>(h % 4), face == nullptr ? kNone : *face);
    }
  }

  void finish() {
    using Edges = PictureOptions::Edges;
    if (options_.edges != Edges::kOff) find_features(scene_, corners_, parts_, is_outer_);
    if (mesh_.order() > 1)
      bend();
    else if (options_.edges == Edges::kFeatures)
      smooth_normals(scene_, corners_);
    name_parts();
    make_legend();
    make_caption();
  }
  void name_parts() {
    const bool is_of_regions = color_ == Color::kRegion;
    const auto& names = is_of_regions ? mesh_.region_names : mesh_.patch_names;
    const std::uint32_t count =
        is_of_regions ? numbers_in(mesh_.region) : std::max(numbers_in(mesh_.patch), numbers_in(mesh_.interface_patch));
    for (std::uint32_t p = 0; p < count; ++p)
      scene_.part_names.push_back(is_of_regions ? region_label(p < names.size() ? names[p] : "", p, count)
                                                : patch_label(names, p));
  }

  /// Faces that bend become sixteen flat triangles.
  void bend() {
    std::vector<SceneTriangle> flat;
    flat.swap(scene_.triangles);
    for (std::size_t k = 0; k < flat.size(); ++k) add_bent(k, flat[k]);
  }
  /// The places of face k whose barycentric coordinates are quarters: [a][b] of the second corner and the third.
  using Quarters = std::array<std::array<Vec3, 5>, 5>;
  Quarters places_of(std::size_t k) const {
    std::array<Vec3, 35> room;
    const std::span<const Vec3> nodes = nodes_of_tet(mesh_, static_cast<TetIndex>(tets_[k]), room);
    const Tet& tet = mesh_.tets[tets_[k]];
    std::array<std::size_t, 3> corner{};
    for (std::size_t i = 0; i < 3; ++i)
      corner[i] = static_cast<std::size_t>(std::ranges::find(tet, corners_[k][i]) - tet.begin());
    Quarters places;
    for (std::size_t a = 0; a <= 4; ++a)
      for (std::size_t b = 0; a + b <= 4; ++b) {
        std::array<double, 4> at{};
        const double quarter = 0.25 * mesh_.order();
        at[corner[0]] = static_cast<double>(4 - a - b) * quarter;
        at[corner[1]] = static_cast<double>(a) * quarter;
        at[corner[2]] = static_cast<double>(b) * quarter;
        places[a][b] = place_in_tet(mesh_.order(), nodes, at);
      }
    return places;
  }
  static bool is_flat(const SceneTriangle& flat, const Quarters& places) {
    constexpr double kStraight = 1e-3;  // of an edge: nobody sees it
    double most = 0;
    for (std::size_t a = 0; a <= 4; ++a)
      for (std::size_t b = 0; a + b <= 4; ++b) {
        const Vec3 p = (static_cast<double>(4 - a - b) * flat.at[0] + static_cast<double>(a) * flat.at[1] +
                        static_cast<double>(b) * flat.at[2]) *
                       0.25;
        most = std::max(most, distance(places[a][b], p));
      }
    return most < kStraight * distance(flat.at[0], flat.at[1]);
  }
  void add_bent(std::size_t k, const SceneTriangle& flat) {
    const Quarters places = places_of(k);
    if (is_flat(flat, places)) {
      scene_.triangles.push_back(flat);
      return;
    }
    const auto point = [&](int a, int b) { return places[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)]; };
    // Only what lies on an edge of the face has its line.
    const auto on = [&](bool is_on, std::size_t edge) { return is_on ? flat.lines[edge] : EdgeLine::kAbsent; };
    for (int a = 0; a < 4; ++a)
      for (int b = 0; a + b < 4; ++b) {
        scene_.triangles.push_back({{point(a, b), point(a + 1, b), point(a, b + 1)},
                                    flat.face,
                                    {on(b == 0, 0), on(a + b == 3, 1), on(a == 0, 2)}});
        if (a + b < 3)
          scene_.triangles.push_back({{point(a + 1, b), point(a + 1, b + 1), point(a, b + 1)}, flat.face, {}});
      }
  }

  void make_legend() {
    Legend& legend = scene_.legend;
    list_marks(legend, options_.highlight);
    if (color_ == Color::kQuality) return quality_legend(legend, beta_counts());
    if (color_ == Color::kSize) return size_legend(legend, sizes_, options_.unit);
    if (color_ != Color::kPlain) list_parts(scene_, color_);
  }
  std::vector<std::uint64_t> beta_counts() const {
    std::vector<double> beta(mesh_.tets.size());
    parallel_for(beta.size(), [&](std::size_t t) {
      const auto [a, b, c, d] = corners(t);
      beta[t] = radius_ratio(a, b, c, d);
    });
    return counts_in_parts(beta);
  }
  void make_caption() {
    const QualitySummary q = summarize_quality(mesh_);
    scene_.caption.push_back(fmt::format(
        "{} tetrahedra{}, β from {:.3f}, mean {:.3f}, dihedral angles {:.1f}° to {:.1f}°", in_groups(mesh_.tets.size()),
        mesh_.is_second_order() ? " of second order" : "", q.beta_min, q.beta_mean, q.dihedral_min, q.dihedral_max));
  }

  const TetMesh& mesh_;
  const PictureOptions& options_;
  const RunContext& context_;
  Color color_;
  MeshMarks marks_;
  SizeRange sizes_;
  std::vector<char> beyond_;  ///< per point: the cut takes it away; empty: there is none
  Scene scene_;
  std::vector<Triangle> corners_;     ///< of the triangles of the scene, before they are bent
  std::vector<TetIndex> tets_;        ///< the same: whose they are
  std::vector<std::uint32_t> parts_;  ///< the same: where one meets another, a line is drawn
  std::vector<char> is_outer_;        ///< the same: of the boundary
};

}  // namespace

Scene scene_of(const TetMesh& mesh, const PictureOptions& options, const RunContext& context) {
  return MeshScene(mesh, options, context).made();
}

}  // namespace octafront
