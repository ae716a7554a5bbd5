#include "support/convex_cells.h"

#include <algorithm>
#include <map>

namespace octafront::testing {
namespace {

/// The edges of a polygon, from vertex to vertex.
using Outline = std::map<std::uint32_t, std::uint32_t>;

std::vector<std::uint32_t> chained(const Outline& outline) {
  std::vector<std::uint32_t> corners;
  for (std::uint32_t v = outline.begin()->first; corners.empty() || v != corners.front(); v = outline.at(v))
    corners.push_back(v);
  return corners;
}

/// Unites the outline with a polygon beside it.
void add_outline(Outline& outline, const std::vector<std::uint32_t>& corners) {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const std::uint32_t a = corners[i], b = corners[(i + 1) % corners.size()];
    if (const auto back = outline.find(b); back != outline.end() && back->second == a) {
      outline.erase(back);
    } else {
      outline[a] = b;
    }
  }
}

}  // namespace

ConvexCells::ConvexCells(Vec3 size) {
  for (const int z : {0, 1})
    for (const int y : {0, 1})
      for (const int x : {0, 1}) points_.push_back({x * size.x, y * size.y, z * size.z});
  site_of_.resize(points_.size());
  const std::vector<std::vector<std::uint32_t>> sides{{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                                      {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (std::uint32_t s = 0; s < 6; ++s) faces_.push_back({sides[s], {kNone, 0}, s});
}

std::uint32_t ConvexCells::crossing(std::uint32_t a, std::uint32_t b, const Heights& height) {
  const Edge key{std::min(a, b), std::max(a, b)};
  const auto [at, is_new] = crossing_.try_emplace(key, static_cast<std::uint32_t>(points_.size()));
  if (!is_new) return at->second;
  const double t = height[key[0]] / (height[key[0]] - height[key[1]]);
  points_.push_back(points_[key[0]] + t * (points_[key[1]] - points_[key[0]]));
  // On the border of the cell that comes.
  site_of_.push_back(sites_.empty() ? Vec3{} : sites_.back());
  return at->second;
}

void ConvexCells::split(const Heights& height, bool merge) {
  crossing_.clear();
  const std::uint32_t merged = cells_;
  if (merge) ++cells_;
  std::map<std::uint32_t, std::uint32_t> above;  // cell: the cell that its upper part becomes
  std::map<std::uint32_t, Outline> rim;          // cell: its cut
  const auto upper = [&](std::uint32_t cell) {
    if (cell == kNone) return kNone;
    if (merge) return merged;
    const auto [at, is_new] = above.try_emplace(cell, cells_);
    cells_ += is_new;
    return at->second;
  };
  std::vector<Face> faces;
  std::map<std::uint32_t, Outline> outlines;  // of the merged cell, per side of the box
  // A cell all above its cut keeps its number, so cells that are cut are found first.
  std::map<std::uint32_t, bool> has_low;
  for (const Face& f : faces_)
    for (const std::uint32_t c : f.cells)
      for (const std::uint32_t v : f.corners) has_low[c] = has_low[c] || height[v] < 0;
  const auto part_above = [&](std::uint32_t cell) { return cell != kNone && has_low[cell] ? upper(cell) : cell; };
  for (const Face& f : faces_) {
    std::vector<std::uint32_t> low, high;
    std::uint32_t rising = kNone, falling = kNone;
    for (std::size_t i = 0; i < f.corners.size(); ++i) {
      const std::uint32_t a = f.corners[i], b = f.corners[(i + 1) % f.corners.size()];
      (height[a] < 0 ? low : high).push_back(a);
      if ((height[a] < 0) == (height[b] < 0)) continue;
      const std::uint32_t x = crossing(a, b, height);
      low.push_back(x);
      high.push_back(x);
      (height[a] < 0 ? rising : falling) = x;
    }
    if (rising != kNone) {
      // The lower part runs from `rising` to `falling`; the cut's face, which looks up, runs against it behind the
      // face.
      if (f.cells[1] != kNone) rim[f.cells[1]][falling] = rising;
      if (f.cells[0] != kNone) rim[f.cells[0]][rising] = falling;
    }
    if (low.size() > 2) faces.push_back({low, f.cells, f.patch});
    if (high.size() < 3) continue;
    const Sides parts{part_above(f.cells[0]), part_above(f.cells[1])};
    if (merge && parts[0] == kNone) {
      add_outline(outlines[f.patch], high);
    } else if (parts[0] != parts[1]) {
      faces.push_back({high, parts, f.patch});
    }
  }
  constexpr std::uint32_t kWalls = 6;
  for (const auto& [cell, outline] : rim) faces.push_back({chained(outline), {upper(cell), cell}, kWalls});
  for (const auto& [patch, outline] : outlines) faces.push_back({chained(outline), {kNone, merged}, patch});
  faces_ = std::move(faces);
}

void ConvexCells::drop_loose_vertices() {
  std::vector<int> uses(points_.size(), 0);
  for (const Face& f : faces_)
    for (const std::uint32_t v : f.corners) ++uses[v];
  for (Face& f : faces_) std::erase_if(f.corners, [&](std::uint32_t v) { return uses[v] < 3; });
}

void ConvexCells::cut(Vec3 n, double c) {
  Heights height;
  for (const Vec3 p : points_) height.push_back(dot(n, p) - c);
  split(height, false);
}

void ConvexCells::insert_site(Vec3 site) {
  if (sites_.empty()) std::fill(site_of_.begin(), site_of_.end(), site);
  sites_.push_back(site);
  if (sites_.size() == 1) return;
  Heights height;
  for (std::size_t v = 0; v < points_.size(); ++v)
    height.push_back(squared_length(points_[v] - site_of_[v]) - squared_length(points_[v] - site));
  split(height, true);
  for (std::size_t v = 0; v < height.size(); ++v)
    if (height[v] >= 0) site_of_[v] = site;
  drop_loose_vertices();
}

SurfaceMesh ConvexCells::complex() const {
  SurfaceMesh mesh;
  mesh.patch_names = {"x_low", "x_high", "y_low", "y_high", "z_low", "z_high", "walls"};
  std::vector<std::uint32_t> number(points_.size(), kNone);
  const auto vertex = [&](std::uint32_t v) {
    if (number[v] == kNone) {
      number[v] = static_cast<std::uint32_t>(mesh.points.size());
      mesh.points.push_back(points_[v]);
    }
    return number[v];
  };
  for (const Face& f : faces_)
    for (std::size_t i = 2; i < f.corners.size(); ++i) {
      mesh.triangles.push_back({vertex(f.corners[0]), vertex(f.corners[i - 1]), vertex(f.corners[i])});
      mesh.sides.push_back(f.cells);
      mesh.patch.push_back(f.patch);
    }
  for (std::uint32_t c = 0; c < cells_; ++c) mesh.region_names.push_back("cell_" + std::to_string(c));
  return mesh;
}

}  // namespace octafront::testing
