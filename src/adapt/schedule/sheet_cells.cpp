#include "adapt/schedule/sheet_cells.h"

#include "base/core/parallel.h"
#include "base/core/validate.h"
#include "base/geometry/blocks.h"

#include <utility>

namespace octafront::adapt {
namespace {

constexpr std::size_t kMostVerticesOfSheetCell = 4096;

/// Triangles of a sheet that one worker changes, as a sheet of their own. Vertices that have other triangles, too, are
/// its rim: they stay as they are.
class SheetPiece {
 public:
  /// `here` has kNone for each vertex of the whole, and has it again afterwards.
  SheetPiece(const Sheet& whole, std::span<const std::uint32_t> triangles, std::vector<VertexIndex>& here)
      : triangles_(triangles.begin(), triangles.end()), piece_(taken(whole, here)) {
    for (const Face& f : before_)
      for (std::size_t i = 0; i < 3; ++i) {
        const VertexIndex a = f.corners[i], b = f.corners[(i + 1) % 3];
        if (const std::uint32_t* path = whole.line(number_[a], number_[b])) piece_.line_edges.set(a, b, *path);
      }
    for (VertexIndex v = 0; v < number_.size(); ++v) {
      Vertex& vertex = piece_.vertices[v];
      vertex.rim = piece_.star(v).size() != whole.star(number_[v]).size();
      vertex.frozen |= vertex.rim;
    }
  }

  Counts work(const SheetGuide& guide) {
    Counts now;
    now.split = split_long_edges(piece_, guide);
    now.swap = swap_edges(piece_, guide);
    now.collapse = collapse_short_edges(piece_, guide);
    now.swap += swap_edges(piece_, guide);
    now.move = smooth_vertices(piece_, guide);
    validate(piece_);
    return now;
  }

  /// Puts what has changed in the place of what was. Vertices at the rim and beside it stay active if they were.
  void put_back(Sheet& whole) {
    const std::vector<std::uint8_t> is_held = beside_rim();
    for (VertexIndex v = 0; v < piece_.vertices.size(); ++v) {
      Vertex vertex = piece_.vertices[v];
      if (v >= number_.size()) {
        vertex.active = vertex.touched || is_held[v];
        number_.push_back(whole.add(vertex));
        continue;
      }
      Vertex& old = whole.vertices[number_[v]];
      const bool stays_active = is_held[v] && old.active;
      if (vertex.rim)
        old.touched |= vertex.touched;
      else
        old = vertex;
      old.active = old.touched || stays_active;
    }
    replace_lines(whole);
    replace_triangles(whole);
  }

 private:
  using Face = Sheet::Face;

  Sheet taken(const Sheet& whole, std::vector<VertexIndex>& here) {
    std::vector<Vertex> vertices;
    std::vector<Triangle> corners;
    std::vector<std::uint32_t> parts;
    for (const std::uint32_t t : triangles_) {
      Triangle c = whole.corners(t);
      for (VertexIndex& v : c) {
        if (here[v] == kNone) {
          here[v] = static_cast<VertexIndex>(number_.size());
          number_.push_back(v), vertices.push_back(whole.vertices[v]);
        }
        v = here[v];
      }
      corners.push_back(c), parts.push_back(whole.part(t));
      before_.push_back({c, whole.part(t)});
    }
    for (const VertexIndex v : number_) here[v] = kNone;
    return {std::move(vertices), corners, parts};
  }

  std::vector<std::uint8_t> beside_rim() const {
    std::vector<std::uint8_t> beside(piece_.vertices.size(), 0);
    for (VertexIndex v = 0; v < beside.size(); ++v) {
      if (!piece_.vertices[v].rim) continue;
      beside[v] = 1;
      for (const VertexIndex u : piece_.neighbours(v)) beside[u] = 1;
    }
    return beside;
  }

  bool is_as_before(std::uint32_t t) const {
    return t < before_.size() && piece_.alive(t) && piece_.corners(t) == before_[t].corners &&
           piece_.part(t) == before_[t].part;
  }

  void replace_lines(Sheet& whole) const {
    const auto in_whole = [&](const Triangle& c, std::size_t i) {
      return std::pair{number_[c[i]], number_[c[(i + 1) % 3]]};
    };
    // First what has gone, of all triangles: one that stays may have a line that another one loses.
    for (std::uint32_t t = 0; t < before_.size(); ++t)
      for (std::size_t i = 0; i < 3 && !is_as_before(t); ++i) {
        const auto [a, b] = in_whole(before_[t].corners, i);
        const VertexIndex u = before_[t].corners[i], v = before_[t].corners[(i + 1) % 3];
        if (whole.line(a, b) && !piece_.line(u, v)) whole.line_edges.drop(a, b);
      }
    for (std::uint32_t t = 0; t < piece_.slots(); ++t)
      for (std::size_t i = 0; i < 3 && piece_.alive(t) && !is_as_before(t); ++i) {
        const Triangle& c = piece_.corners(t);
        const auto [a, b] = in_whole(c, i);
        if (const std::uint32_t* path = piece_.line(c[i], c[(i + 1) % 3])) whole.line_edges.set(a, b, *path);
      }
  }

  void replace_triangles(Sheet& whole) const {
    std::vector<std::uint32_t> old;
    std::vector<Face> fresh;
    for (std::uint32_t t = 0; t < piece_.slots(); ++t) {
      if (is_as_before(t)) continue;
      if (t < before_.size()) old.push_back(triangles_[t]);
      if (!piece_.alive(t)) continue;
      Triangle c = piece_.corners(t);
      for (VertexIndex& v : c) v = number_[v];
      fresh.push_back({c, piece_.part(t)});
    }
    // That touches all around, whose activity is known already.
    std::vector<std::pair<VertexIndex, std::pair<bool, bool>>> known;
    for (const VertexIndex v : number_) known.push_back({v, {whole.vertices[v].active, whole.vertices[v].touched}});
    if (!old.empty() || !fresh.empty()) whole.replace(old, fresh);
    for (const auto& [v, state] : known)
      whole.vertices[v].active = state.first, whole.vertices[v].touched = state.second;
  }

  std::vector<std::uint32_t> triangles_;
  std::vector<VertexIndex> number_;  ///< in the whole, per vertex
  std::vector<Face> before_;         ///< per slot, as the piece numbers vertices
  Sheet piece_;
};

}  // namespace

Counts cycle_in_cells(Sheet& sheet, const SheetGuide& guide, int stage) {
  std::vector<Vec3> points;
  Box3 box;
  for (const Vertex& v : sheet.vertices) points.push_back(v.at), box.add(v.at);
  const Cells cells = cells_of(points, cube_of_stage(box, stage % kCellStages), kMostVerticesOfSheetCell);
  std::vector<std::uint32_t> all;
  for (std::uint32_t t = 0; t < sheet.slots(); ++t)
    if (sheet.alive(t)) all.push_back(t);
  const ItemsByCell<std::uint32_t> triangles(std::span<const std::uint32_t>(all), cells.count,
                                             [&](std::uint32_t t) { return cells.holding(sheet.corners(t)); });
  for (Vertex& v : sheet.vertices) v.touched = false;
  std::vector<std::optional<SheetPiece>> pieces(cells.count);
  std::vector<Counts> counts(cells.count);
  PerThread<std::vector<VertexIndex>> scratch;
  parallel_for(
      cells.count,
      [&](std::size_t c) {
        const auto mine = triangles[static_cast<std::uint32_t>(c)];
        if (mine.empty()) return;
        std::vector<VertexIndex>& here =
            scratch.local([&] { return std::vector<VertexIndex>(sheet.vertices.size(), kNone); });
        pieces[c].emplace(sheet, mine, here);
        counts[c] = pieces[c]->work(guide);
      },
      Split::kSingly);
  Counts sum;
  for (std::size_t c = 0; c < pieces.size(); ++c) {
    if (pieces[c]) pieces[c]->put_back(sheet);
    pieces[c].reset();
    sum += counts[c];
  }
  return sum;
}

}  // namespace octafront::adapt
