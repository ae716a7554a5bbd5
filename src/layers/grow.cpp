#include "layers/grow.h"

#include "layers/bare_patches.h"
#include "layers/directions.h"
#include "layers/heights.h"
#include "layers/layered_walls.h"
#include "layers/soundness.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace octafront::layers {

namespace {

/// Sweeps that smooth directions: thin layers gain nothing by more, thick ones in corners need them.
constexpr int kFewSweeps = 10, kManySweeps = 30;
constexpr double kThin = 0.4, kThick = 1;
/// Tops are kept apart first as if layers were so much higher: the volume needs room between them.
constexpr double kAhead = 1.2;
/// Columns at fault keep this part of their height, each time; so often each.
constexpr double kCuts[] = {0.8, 0.6, 0.3};
constexpr int kTimesPerCut = 4;

int sweeps_for(double over_size) {
  const double t = std::clamp((over_size - kThin) / (kThick - kThin), 0.0, 1.0);
  return kFewSweeps + static_cast<int>(std::lround(t * (kManySweeps - kFewSweeps)));
}

class Growth {
 public:
  Growth(RegionWall& wall, const Asked& asked, const Stage& stage) : wall_(wall), walls_(wall), stage_(stage) {
    const std::size_t n = wall.surface.points.size();
    Directions directions = choose_directions(walls_, sweeps_for(asked.over_size));
    columns_ = {std::move(directions.step),
                asked.first,
                std::vector<double>(n, 0),
                std::vector<std::uint32_t>(n, 0),
                std::vector<Reason>(n, Reason::kNone),
                asked.growth,
                asked.count};
    allowed_ = {std::vector<double>(n, 1), std::vector<Reason>(n, Reason::kNone)};
    cuts_.resize(n, 0);
    for (const VertexIndex v : walls_.wall_vertices)
      if (walls_.held[v])
        allowed_.limit(v, 0, Reason::kBare);
      else if (directions.reason[v] != Reason::kNone)
        allowed_.limit(v, 0, directions.reason[v]);
  }

  Columns run() && {
    limit_by_gaps(walls_, columns_, allowed_);
    settle_heights(walls_, allowed_, columns_);
    make_room_on_bare(walls_, columns_, wall_);
    for (const double ahead : {kAhead, 1.0}) {
      do mend_shapes();
      while (cut(crossing_triangles(walls_, columns_, ahead, stage_.context()), Reason::kCrossing));
    }
    return std::move(columns_);
  }

 private:
  void mend_shapes() {
    std::vector<std::uint32_t> asked(walls_.surface.triangles.size());
    std::iota(asked.begin(), asked.end(), 0u);
    while (true) {
      const std::vector<std::uint32_t> unsound = unsound_triangles(walls_, columns_, asked);
      const std::vector<std::uint32_t> count = columns_.count;
      const std::vector<double> part = columns_.part;
      if (!cut(unsound, Reason::kShape)) return;
      asked = touched(count, part);
    }
  }

  /// Triangles at columns that are no longer as they were.
  std::vector<std::uint32_t> touched(const std::vector<std::uint32_t>& count, const std::vector<double>& part) const {
    std::vector<std::uint32_t> faces;
    for (VertexIndex v = 0; v < count.size(); ++v)
      if (columns_.count[v] != count[v] || columns_.part[v] != part[v])
        faces.insert(faces.end(), walls_.faces[v].begin(), walls_.faces[v].end());
    std::ranges::sort(faces);
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    return faces;
  }

  /// Makes the columns of these triangles lower; false if there are none to be made lower.
  bool cut(const std::vector<std::uint32_t>& triangles, Reason why) {
    stage_.check();
    std::vector<VertexIndex> vertices;
    for (const std::uint32_t f : triangles)
      for (const VertexIndex v : walls_.surface.triangles[f])
        if (columns_.count[v] > 0) vertices.push_back(v);
    if (vertices.empty()) return false;
    std::ranges::sort(vertices);
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    for (const VertexIndex v : vertices) {
      const int step = cuts_[v]++ / kTimesPerCut;
      const double kept = step < static_cast<int>(std::size(kCuts)) ? kCuts[step] : 0;
      allowed_.limit(v, kept * height_part(v), why);
    }
    settle_heights(walls_, allowed_, columns_);
    return true;
  }

  /// The height that a column has, over that asked for.
  double height_part(VertexIndex v) const {
    return columns_.part[v] * columns_.height_of(columns_.count[v]) / columns_.height_of(columns_.asked);
  }

  RegionWall& wall_;
  Walls walls_;
  const Stage& stage_;
  Columns columns_;
  Allowance allowed_;
  std::vector<int> cuts_;  ///< per vertex
};

}  // namespace

Columns grow(RegionWall& wall, const Asked& asked, const Stage& stage) {
  return Growth(wall, asked, stage).run();
}

}  // namespace octafront::layers
