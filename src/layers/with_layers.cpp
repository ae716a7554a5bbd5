#include "layers/with_layers.h"

#include "base/mesh/complex.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <string>
#include <utility>

namespace octafront::layers {

namespace {

constexpr const char* kRegionName = "layers";
/// What the rest is called where it has no name.
constexpr const char* kRestName = "volume";

/// What grows on the two sides of the triangles of a surface.
class SidesOfFaces {
 public:
  SidesOfFaces(const SurfaceMesh& whole, const std::vector<LayeredRegion>& grown)
      : whole_(whole), grown_(grown), place_(whole.triangles.size(), {Place{}, Place{}}) {
    for (std::uint32_t i = 0; i < grown.size(); ++i) {
      const RegionWall& wall = grown[i].wall;
      for (std::uint32_t t = 0; t < wall.face.size(); ++t) {
        const Sides sides = whole.sides_of(wall.face[t]);
        if (sides[0] == sides[1]) continue;  // nothing grows on a sheet
        place_[wall.face[t]][sides[0] == wall.region ? 0 : 1] = {i, t};
      }
    }
  }

  /// Of the layered region on a side; kNone if that is none.
  std::uint32_t region(std::size_t f, int side) const { return place_[f][side].region; }

  /// Whether elements of layers lie on this side.
  bool has_layers(std::size_t f, int side) const {
    const Place at = place_[f][side];
    if (at.region == kNone || !grown_[at.region].wall.is_wall[at.triangle]) return false;
    const auto [a, b, c] = grown_[at.region].wall.surface.triangles[at.triangle];
    const std::vector<std::uint32_t>& count = grown_[at.region].columns.count;
    return count[a] + count[b] + count[c] > 0;
  }

  /// Layers at the corner that has least; kNone if it is no wall.
  std::uint32_t layers(std::size_t f, int side) const {
    const auto [i, t] = place_[f][side];
    if (i == kNone || !grown_[i].wall.is_wall[t]) return kNone;
    const auto& [a, b, c] = grown_[i].wall.surface.triangles[t];
    const std::vector<std::uint32_t>& count = grown_[i].columns.count;
    return std::min({count[a], count[b], count[c]});
  }

  /// The triangle as the region on this side has it, in the order of the whole's corners; `top`: number of the top of a
  /// column, by region and vertex.
  template <class Top>
  Triangle on_top(std::size_t f, int side, const Top& top) const {
    const auto [i, t] = place_[f][side];
    if (i == kNone) return whole_.triangles[f];
    Triangle local = grown_[i].wall.surface.triangles[t];
    if (side == 0) std::swap(local[1], local[2]);
    return {top(i, local[0]), top(i, local[1]), top(i, local[2])};
  }

 private:
  struct Place {
    std::uint32_t region = kNone, triangle = kNone;
  };

  const SurfaceMesh& whole_;
  const std::vector<LayeredRegion>& grown_;
  std::vector<std::array<Place, 2>> place_;  ///< per triangle
};

class Opening {
 public:
  Opening(const SurfaceMesh& whole, const std::vector<LayeredRegion>& grown)
      : whole_(whole), grown_(grown), sides_(whole, grown) {}

  Opened run() && {
    number_tops();
    for (std::uint32_t f = 0; f < whole_.triangles.size(); ++f) add(f);
    SurfaceMesh& surface = made_.surface;
    surface.patch_names = whole_.patch_names, surface.region_names = whole_.region_names;
    surface.patch_labels = whole_.patch_labels;
    if (whole_.sides.empty())
      surface.sides.clear();
    else
      face_lower_regions_behind(surface);
    return std::move(made_);
  }

 private:
  /// Vertices that a triangle needs where they are.
  std::vector<std::uint8_t> needed_below() const {
    const auto low_if_stays = [&](std::uint32_t i, VertexIndex v) {
      return grown_[i].columns.count[v] == 0 ? grown_[i].wall.vertex[v] : kNone;
    };
    std::vector<std::uint8_t> is_needed(whole_.points.size(), 0);
    for (std::size_t f = 0; f < whole_.triangles.size(); ++f) {
      const Sides sides = whole_.sides_of(f);
      for (int side = 0; side < 2; ++side) {
        if (sides[side] == kNone) continue;
        for (const VertexIndex v : sides_.on_top(f, side, low_if_stays))
          if (v != kNone) is_needed[v] = 1;
      }
    }
    return is_needed;
  }

  void number_tops() {
    std::vector<std::uint8_t> is_taken = needed_below();
    made_.surface.points = whole_.points;
    for (const LayeredRegion& region : grown_) {
      made_.top.push_back(region.wall.vertex);
      if (region.is_outside()) continue;
      for (VertexIndex v = 0; v < region.wall.vertex.size(); ++v) {
        if (region.columns.count[v] == 0) continue;
        VertexIndex& top = made_.top.back()[v];
        const Vec3 place = region.columns.top(region.wall.surface, v);
        if (is_taken[top]) {
          top = static_cast<VertexIndex>(made_.surface.points.size());
          made_.surface.points.push_back(place);
        } else {
          is_taken[top] = 1, made_.surface.points[top] = place;
        }
      }
    }
  }

  void add(std::uint32_t f) {
    const auto [front, behind] = whole_.sides_of(f);
    const auto top = [&](std::uint32_t i, VertexIndex v) { return made_.top[i][v]; };
    const Triangle in_front = sides_.on_top(f, 0, top), at_back = sides_.on_top(f, 1, top);
    if (front == kNone || behind == kNone || in_front == at_back)
      return put(front == kNone ? at_back : in_front, f, {front, behind});
    put(at_back, f, {kNone, behind});
    put(in_front, f, {front, kNone});
  }

  void put(const Triangle& t, std::uint32_t like, const Sides& sides) {
    made_.surface.triangles.push_back(t);
    made_.surface.patch.push_back(whole_.patch_of(like));
    made_.surface.sides.push_back(sides);
  }

  const SurfaceMesh& whole_;
  const std::vector<LayeredRegion>& grown_;
  SidesOfFaces sides_;
  Opened made_;
};

/// Numbers of nodes: those of the whole surface as they are, behind them those of columns, region by region in their
/// order: then the node with the smallest number of a quad is on the column with the smaller number, and divides it.
class NodeNumbers {
 public:
  NodeNumbers(std::size_t points, const std::vector<LayeredRegion>& grown)
      : grown_(grown), end_(static_cast<VertexIndex>(points)) {
    for (const LayeredRegion& region : grown) {
      std::vector<VertexIndex>& first = first_.emplace_back();
      for (const std::uint32_t count : region.columns.count) {
        first.push_back(end_);
        end_ += count;
      }
    }
  }

  VertexIndex operator()(std::uint32_t i, Node node) const {
    return node.level == 0 ? grown_[i].wall.vertex[node.column] : first_[i][node.column] + node.level - 1;
  }
  VertexIndex top(std::uint32_t i, VertexIndex v) const { return (*this)(i, {v, grown_[i].columns.count[v]}); }
  VertexIndex end() const { return end_; }

 private:
  const std::vector<LayeredRegion>& grown_;
  std::vector<std::vector<VertexIndex>> first_;
  VertexIndex end_;
};

class Assembly {
 public:
  Assembly(const SurfaceMesh& whole, const std::vector<LayeredRegion>& grown, const Opened& opened)
      : whole_(whole),
        grown_(grown),
        opened_(opened),
        sides_(whole, grown),
        number_(whole.points.size(), grown),
        regions_(region_count(whole)) {}

  Layered run(TetMesh inner) && {
    place_nodes(inner);
    renumber(inner);
    grow_tets(inner);
    name(inner);
    boundary_.points.assign(points_.begin(), points_.begin() + number_.end());
    inner.points = std::move(points_);
    std::vector<VertexIndex> below = vertices_below(inner.points.size());
    make_boundary();
    list(inner);
    SurfaceMesh ground = ground_of_layers();
    return {std::move(inner), std::move(boundary_), std::move(ground), std::move(below)};
  }

 private:
  bool is_complex() const { return !whole_.sides.empty(); }
  std::uint32_t layers_of(std::uint32_t i) const { return regions_ + i; }

  void place_nodes(const TetMesh& inner) {
    points_ = whole_.points;
    points_.resize(number_.end());
    for (std::uint32_t i = 0; i < grown_.size(); ++i) {
      const auto& [wall, columns] = grown_[i];
      for (VertexIndex v = 0; v < wall.vertex.size(); ++v)
        for (std::uint32_t k = 1; k <= columns.count[v]; ++k)
          points_[number_(i, {v, k})] = columns.place(wall.surface, {v, k});
    }
    const auto own = static_cast<std::ptrdiff_t>(opened_.surface.points.size());
    points_.insert(points_.end(), inner.points.begin() + own, inner.points.end());
  }

  void renumber(TetMesh& inner) const {
    const auto own = static_cast<VertexIndex>(opened_.surface.points.size());
    std::vector<VertexIndex> number(own);
    std::iota(number.begin(), number.end(), 0u);
    for (std::uint32_t i = 0; i < grown_.size(); ++i)
      if (!grown_[i].is_outside())
        for (VertexIndex v = 0; v < grown_[i].wall.vertex.size(); ++v) number[opened_.top[i][v]] = number_.top(i, v);
    for (Tet& tet : inner.tets)
      for (VertexIndex& v : tet) v = v < own ? number[v] : v - own + number_.end();
  }

  void grow_tets(TetMesh& inner) const {
    inner.region.resize(inner.tets.size(), 0);
    for (std::uint32_t i = 0; i < grown_.size(); ++i) {
      const auto& [wall, columns] = grown_[i];
      for (std::size_t t = 0; t < wall.is_wall.size(); ++t)
        for (std::uint32_t k = 0; wall.is_wall[t] && k < columns.asked; ++k) grow_layer(i, t, k, inner);
      inner.region.resize(inner.tets.size(), layers_of(i));
    }
  }

  void grow_layer(std::uint32_t i, std::size_t t, std::uint32_t k, TetMesh& to) const {
    const Triangle& triangle = grown_[i].wall.surface.triangles[t];
    const TetsOfLayer made = tets_of_layer(grown_[i].columns, triangle, k);
    if (made.count > 1) to.wide_cells.push_back(wide_cell(static_cast<TetIndex>(to.tets.size()), i, triangle, k));
    for (int j = 0; j < made.count; ++j) {
      const auto& [a, b, c, d] = made.tets[j];
      to.tets.push_back({number_(i, a), number_(i, b), number_(i, c), number_(i, d)});
    }
  }

  /// The wedge of a layer over a triangle, or the pyramid where one of the columns has ended.
  WideCell wide_cell(TetIndex first, std::uint32_t i, const Triangle& triangle, std::uint32_t k) const {
    const auto [a, b, c] = triangle;
    const std::vector<std::uint32_t>& count = grown_[i].columns.count;
    const auto at = [&](VertexIndex v, std::uint32_t level) { return number_(i, {v, std::min(level, count[v])}); };
    // The triangle's normal points away from its layers.
    for (const auto& [end, p, q] : {std::array{a, b, c}, {b, c, a}, {c, a, b}})
      if (count[end] <= k) return {first, 2, {at(q, k), at(q, k + 1), at(p, k + 1), at(p, k), at(end, k), kNone}};
    return {first, 3, {at(a, k), at(c, k), at(b, k), at(a, k + 1), at(c, k + 1), at(b, k + 1)}};
  }

  std::vector<VertexIndex> vertices_below(std::size_t points) const {
    std::vector<VertexIndex> below(points);
    std::iota(below.begin(), below.end(), 0u);
    for (std::uint32_t i = 0; i < grown_.size(); ++i)
      for (VertexIndex v = 0; v < grown_[i].wall.vertex.size(); ++v)
        for (std::uint32_t k = 1; k <= grown_[i].columns.count[v]; ++k)
          below[number_(i, {v, k})] = grown_[i].wall.vertex[v];
    return below;
  }

  void make_boundary() {
    boundary_.patch_names = whole_.patch_names;
    boundary_.patch_labels = whole_.patch_labels;
    for (std::uint32_t f = 0; f < whole_.triangles.size(); ++f) add_face(f);
    for (std::uint32_t i = 0; i < grown_.size(); ++i) {
      for (const Rim& rim : rims_of(grown_[i].wall))
        for (std::uint32_t k = 0; k < grown_[i].columns.asked; ++k) add_strip(i, rim, k);
    }
    without_tops_ = boundary_.triangles.size();
    for (std::uint32_t i = 0; is_complex() && i < grown_.size(); ++i) add_tops(i);
  }

  bool is_outside() const { return std::ranges::any_of(grown_, &LayeredRegion::is_outside); }

  SurfaceMesh ground_of_layers() const {
    if (is_outside()) return whole_;
    SurfaceMesh ground = boundary_;
    ground.triangles.resize(without_tops_), ground.patch.resize(without_tops_), ground.source.resize(without_tops_);
    if (is_complex()) ground.sides.resize(without_tops_);
    return ground;
  }

  /// A wall stays where it is, for what grows on it; what has none moves with the tops beside it.
  void add_face(std::uint32_t f) {
    Sides sides = whole_.sides_of(f);
    Triangle t = whole_.triangles[f];
    const auto top = [&](std::uint32_t i, VertexIndex v) { return number_.top(i, v); };
    bool is_covered = false;
    for (int side = 0; side < 2; ++side) {
      if (!sides_.has_layers(f, side)) continue;
      const std::uint32_t i = sides_.region(f, side);
      is_covered = true;
      if (sides[side] == kNone) {
        add(sides_.on_top(f, side, top), f, {kNone, layers_of(i)});
        layers_.back() = layers_over(f);
      }
      sides[side] = layers_of(i);
    }
    if (!is_covered)
      for (int side = 0; side < 2; ++side)
        if (sides[side] != kNone) t = sides_.on_top(f, side, top);
    const bool is_inside = sides[0] != kNone && sides[1] != kNone;
    if (is_inside && !is_complex()) return;
    add(t, f, sides);
    layers_.back() = layers_over(f);
  }

  /// Between the layers of a region and the rest of it.
  void add_tops(std::uint32_t i) {
    const auto& [wall, columns] = grown_[i];
    if (grown_[i].is_outside()) return;
    const auto patch = static_cast<std::uint32_t>(boundary_.patch_names.size());
    boundary_.patch_names.push_back(region_names_[wall.region] + "|" + region_names_[layers_of(i)]);
    for (std::size_t t = 0; t < wall.is_wall.size(); ++t) {
      Triangle top = wall.surface.triangles[t];
      if (!wall.is_wall[t] || columns.count[top[0]] + columns.count[top[1]] + columns.count[top[2]] == 0) continue;
      for (VertexIndex& v : top) v = number_.top(i, v);
      add(top, wall.face[t], {layers_of(i), wall.region});
      boundary_.patch.back() = patch;
    }
  }

  void add(const Triangle& t, std::uint32_t like, const Sides& sides) {
    boundary_.triangles.push_back(t);
    boundary_.patch.push_back(whole_.patch_of(like));
    boundary_.source.push_back(whole_.source_of(like));
    boundary_.sides.push_back(sides);
    layers_.push_back(kNone);
  }

  /// Of what lies over a triangle of the whole, at the corner that has least; kNone if it is no wall.
  std::uint32_t layers_over(std::size_t f) const {
    std::uint32_t least = kNone;
    for (int side = 0; side < 2; ++side) least = std::min(least, sides_.layers(f, side));
    return least;
  }

  /// The side of a layer beside a bare triangle, which runs from b to a: in its place, or outside going on from it.
  void add_strip(std::uint32_t i, const Rim& rim, std::uint32_t k) {
    const VertexIndex x = std::min(rim.a, rim.b), y = std::max(rim.a, rim.b);
    const auto first = static_cast<std::uint32_t>(boundary_.triangles.size());
    const std::vector<std::uint32_t>& count = grown_[i].columns.count;
    const auto low = [&](VertexIndex v) { return number_(i, {v, std::min(k, count[v])}); };
    const auto high = [&](VertexIndex v) { return number_(i, {v, std::min(k + 1, count[v])}); };
    const auto add_facing = [&](VertexIndex p, VertexIndex q, VertexIndex r) {
      if (p == q || q == r || r == p) return;
      add(x == rim.b ? Triangle{p, q, r} : Triangle{q, p, r}, grown_[i].wall.face[rim.bare], {kNone, layers_of(i)});
    };
    add_facing(low(x), low(y), high(y));
    add_facing(low(x), high(y), high(x));
    if (boundary_.triangles.size() == first + 2)
      strips_.push_back({first, {low(rim.b), low(rim.a), high(rim.a), high(rim.b)}});
  }

  /// Makes the boundary that of the mesh.
  void list(TetMesh& mesh) {
    if (!is_complex()) {
      boundary_.sides.clear();
      mesh.source = boundary_.source;
      mesh.wide_faces = std::move(strips_);
      mesh.face_layers = std::move(layers_);
    } else {
      face_lower_regions_behind(boundary_);
      mesh.source.clear();
      std::vector<std::uint32_t> number;
      for (std::size_t t = 0; t < boundary_.triangles.size(); ++t) {
        number.push_back(static_cast<std::uint32_t>(mesh.source.size()));
        if (boundary_.sides[t][0] != kNone) continue;
        mesh.source.push_back(boundary_.source[t]);
        mesh.face_layers.push_back(layers_[t]);
      }
      for (std::size_t t = 0; t < boundary_.triangles.size(); ++t)
        if (boundary_.sides[t][0] != kNone) mesh.face_layers.push_back(layers_[t]);
      for (const WideFace& strip : strips_) mesh.wide_faces.push_back({number[strip.first], strip.nodes});
    }
    list_faces(boundary_, mesh);
  }

  void name(TetMesh& mesh) {
    const std::uint32_t named = regions_;
    mesh.region_names.resize(named);
    if (named == 1 && mesh.region_names.front().empty()) mesh.region_names.front() = kRestName;
    for (const auto& [wall, columns] : grown_) {
      const bool is_only = named == 1 || wall.region == kNone;
      mesh.region_names.push_back(is_only ? kRegionName : region_name(whole_, wall.region) + " " + kRegionName);
      if (!mesh.region_labels.empty())
        mesh.region_labels.push_back(wall.region == kNone ? 0 : mesh.region_labels[wall.region]);
    }
    for (std::uint32_t r = 0; r < named; ++r)
      region_names_.push_back(named == 1 ? mesh.region_names[r] : region_name(whole_, r));
    region_names_.insert(region_names_.end(), mesh.region_names.begin() + named, mesh.region_names.end());
    boundary_.region_names = mesh.region_names;
  }

  const SurfaceMesh& whole_;
  const std::vector<LayeredRegion>& grown_;
  const Opened& opened_;
  SidesOfFaces sides_;
  NodeNumbers number_;
  std::uint32_t regions_;
  std::vector<Vec3> points_;
  SurfaceMesh boundary_;
  std::vector<WideFace> strips_;
  std::vector<std::uint32_t> layers_;  ///< per triangle of the boundary
  std::size_t without_tops_ = 0;       ///< triangles of the boundary
  std::vector<std::string> region_names_;
};

}  // namespace

Opened without_layers(const SurfaceMesh& whole, const std::vector<LayeredRegion>& grown) {
  return Opening(whole, grown).run();
}

Layered with_layers(const SurfaceMesh& whole, const std::vector<LayeredRegion>& grown, const Opened& opened,
                    TetMesh inner) {
  return Assembly(whole, grown, opened).run(std::move(inner));
}

}  // namespace octafront::layers
