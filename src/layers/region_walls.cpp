#include "layers/region_walls.h"

#include "base/mesh/complex.h"
#include "base/mesh/edge_table.h"

#include <algorithm>
#include <utility>

namespace octafront::layers {

namespace {

/// Per region of a list the triangles that bound it, ascending.
std::vector<std::vector<std::uint32_t>> faces_of(const SurfaceMesh& whole, const std::vector<std::uint32_t>& regions) {
  const std::uint32_t outside = region_count(whole);
  const auto index = [&](std::uint32_t region) { return region == kNone ? outside : region; };
  std::vector<std::uint32_t> place(outside + 1, kNone);
  for (std::uint32_t i = 0; i < regions.size(); ++i) place[index(regions[i])] = i;
  std::vector<std::vector<std::uint32_t>> faces(regions.size());
  for (std::uint32_t f = 0; f < whole.triangles.size(); ++f) {
    const auto [front, behind] = whole.sides_of(f);
    if (const std::uint32_t i = place[index(behind)]; i != kNone) faces[i].push_back(f);
    if (const std::uint32_t i = place[index(front)]; i != kNone && front != behind) faces[i].push_back(f);
  }
  return faces;
}

/// The whole's vertices are numbered for one region after the other.
class WallOfRegion {
 public:
  WallOfRegion(const SurfaceMesh& whole, const std::vector<std::uint8_t>& is_wall)
      : whole_(whole), is_wall_(is_wall), number_(whole.points.size(), kNone), triangles_at_(whole.points.size(), 0) {
    for (const Triangle& t : whole.triangles)
      for (const VertexIndex v : t) ++triangles_at_[v];
  }

  RegionWall operator()(std::uint32_t region, std::vector<std::uint32_t> faces) {
    RegionWall made;
    made.region = region, made.face = std::move(faces);
    number_vertices(made);
    made.held.resize(made.vertex.size(), 0);
    made.surface.patch_names = whole_.patch_names;
    for (const std::uint32_t f : made.face) add(f, made);
    find_shared(made);
    if (!whole_.sides.empty()) hold_touching(made);
    return made;
  }

 private:
  void number_vertices(RegionWall& made) {
    for (const std::uint32_t f : made.face)
      made.vertex.insert(made.vertex.end(), whole_.triangles[f].begin(), whole_.triangles[f].end());
    std::ranges::sort(made.vertex);
    made.vertex.erase(std::unique(made.vertex.begin(), made.vertex.end()), made.vertex.end());
    for (VertexIndex v = 0; v < made.vertex.size(); ++v) {
      number_[made.vertex[v]] = v;
      made.surface.points.push_back(whole_.points[made.vertex[v]]);
    }
  }

  void add(std::uint32_t f, RegionWall& to) const {
    const auto [front, behind] = whole_.sides_of(f);
    Triangle t = whole_.triangles[f];
    if (behind != to.region) std::swap(t[1], t[2]);
    const bool is_sheet = front == behind, is_wall = is_wall_[f] && !is_sheet;
    // A triangle of the hull moves along its plane; outside, layers go on in that plane.
    const bool is_inner = front != kNone && behind != kNone;
    for (VertexIndex& v : t) {
      v = number_[v];
      if (!is_wall && is_inner) to.held[v] = 1;
    }
    to.surface.triangles.push_back(t);
    to.surface.patch.push_back(whole_.patch_of(f));
    to.is_wall.push_back(is_wall);
  }

  void find_shared(RegionWall& made) const {
    std::vector<std::uint32_t> own(made.vertex.size(), 0);
    for (const Triangle& t : made.surface.triangles)
      for (const VertexIndex v : t) ++own[v];
    for (VertexIndex v = 0; v < own.size(); ++v) made.shared.push_back(own[v] < triangles_at_[made.vertex[v]]);
  }

  /// Where the region touches itself along an edge, layers have no one side.
  static void hold_touching(RegionWall& made) {
    const EdgeTable edges = make_edge_table(made.surface.points.size(), made.surface.triangles);
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const auto uses = edges.uses(e);
      if (uses.size() == 2) continue;
      for (const std::uint32_t h : uses) {
        const Triangle& t = made.surface.triangles[h / 3];
        made.held[t[h % 3]] = made.held[t[(h + 1) % 3]] = 1;
      }
    }
  }

  const SurfaceMesh& whole_;
  const std::vector<std::uint8_t>& is_wall_;
  std::vector<VertexIndex> number_;
  std::vector<std::uint32_t> triangles_at_;  ///< per vertex of the whole
};

}  // namespace

std::vector<RegionWall> walls_of_regions(const SurfaceMesh& whole, const std::vector<std::uint8_t>& is_wall,
                                         const std::vector<std::uint32_t>& regions) {
  std::vector<std::vector<std::uint32_t>> faces = faces_of(whole, regions);
  WallOfRegion wall_of(whole, is_wall);
  std::vector<RegionWall> walls;
  for (std::size_t i = 0; i < regions.size(); ++i) walls.push_back(wall_of(regions[i], std::move(faces[i])));
  return walls;
}

std::vector<Rim> rims_of(const RegionWall& wall) {
  std::vector<Rim> rims;
  const std::vector<Triangle>& triangles = wall.surface.triangles;
  const EdgeTable edges = make_edge_table(wall.surface.points.size(), triangles);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto uses = edges.uses(e);
    if (uses.size() != 2) continue;
    for (int i = 0; i < 2; ++i) {
      const std::uint32_t h = uses[i], bare = uses[1 - i] / 3;
      if (!wall.is_wall[h / 3] || wall.is_wall[bare]) continue;
      const Triangle& t = triangles[h / 3];
      rims.push_back({t[h % 3], t[(h + 1) % 3], h / 3, bare});
    }
  }
  return rims;
}

}  // namespace octafront::layers
