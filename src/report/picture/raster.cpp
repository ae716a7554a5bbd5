#include "report/picture/raster.h"

#include "base/core/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace octafront {

namespace {

constexpr int kStepsOfSample = 256;
constexpr int kBandRows = 16;  // pixels

/// A triangle on the picture, in steps of a sample.
struct Projected {
  std::array<std::int32_t, 3> x{}, y{};
  std::array<float, 3> depth{};
  std::array<float, 3> pixels{};  ///< of twice an area over an edge: how far apart they are
  float shade = 1;
  float height = 0;      ///< the least one, in pixels
  std::int8_t turn = 0;  ///< 1: seen from its front, -1: from its back, 0: not seen
};

std::int32_t in_steps(double samples) {
  // Far beyond any picture, and products of differences stay in 64 bits.
  constexpr double kMost = 1 << 29;
  return static_cast<std::int32_t>(std::clamp(std::floor(samples * kStepsOfSample + 0.5), -kMost, kMost));
}

/// Light from above the left shoulder of the viewer, and from all around.
double shade_of(Vec3 normal, const Camera& camera) {
  const Vec3 light = normalized(-0.3 * camera.right + 0.6 * camera.up + 1.0 * camera.back);
  const double facing = dot(normal, light);
  // Colours mean something: shade must not make one look like another.
  return 0.76 + 0.26 * std::max(0.0, facing);
}

/// Twice the signed area of a, b and (x, y).
std::int64_t side(const Projected& p, int a, int b, std::int64_t x, std::int64_t y) {
  return (std::int64_t{p.x[b]} - p.x[a]) * (y - p.y[a]) - (std::int64_t{p.y[b]} - p.y[a]) * (x - p.x[a]);
}

double length_of_edge(const Projected& p, int i) {
  const int k = (i + 1) % 3;
  const double dx = static_cast<double>(p.x[k]) - p.x[i], dy = static_cast<double>(p.y[k]) - p.y[i];
  return std::sqrt(dx * dx + dy * dy);
}

Projected projected(const SceneTriangle& triangle, const Camera& camera, int samples, bool is_closed) {
  Projected p;
  for (int i = 0; i < 3; ++i) {
    const Pixel at = camera.project(triangle.at[i]);
    if (!std::isfinite(at.x) || !std::isfinite(at.y)) return {};
    p.x[i] = in_steps(samples * at.x), p.y[i] = in_steps(samples * at.y);
    p.depth[i] = static_cast<float>(camera.scale * dot(triangle.at[i] - camera.target, camera.back));
  }
  const std::int64_t area = side(p, 0, 1, p.x[2], p.y[2]);
  // y goes down in pictures.
  p.turn = area < 0 ? 1 : area > 0 && !is_closed ? -1 : 0;
  if (p.turn == 0) return p;
  const Vec3 normal = normalized(cross(triangle.at[1] - triangle.at[0], triangle.at[2] - triangle.at[0]));
  p.shade = static_cast<float>(shade_of(p.turn * normal, camera));
  for (int i = 0; i < 3; ++i) p.pixels[i] = static_cast<float>(1 / (length_of_edge(p, i) * kStepsOfSample * samples));
  p.height = static_cast<float>(std::abs(static_cast<double>(area)) * *std::ranges::min_element(p.pixels));
  return p;
}

/// Rows of samples.
struct Rows {
  int first = 0, last = -1;  ///< both inside
  bool empty() const { return last < first; }
};

/// The first sample whose middle is not before a place, in samples.
int first_sample(std::int32_t steps) {
  return static_cast<int>((std::int64_t{steps} + kStepsOfSample / 2 - 1) >> 8);
}

Rows samples_between(const std::array<std::int32_t, 3>& at, int count) {
  const auto [least, most] = std::minmax_element(at.begin(), at.end());
  return {std::max(0, first_sample(*least)), std::min(count - 1, first_sample(*most + 1) - 1)};
}

/// A strong line on the picture, in samples.
struct StrongLine {
  Pixel from, to;
  double depth_from = 0, depth_to = 0;
};

/// What a picture is drawn from.
struct Drawing {
  const Scene& scene;
  const Camera& camera;
  RasterOptions options;
  int samples, width, height;  ///< of samples
  std::vector<Projected> triangles;
  std::vector<StrongLine> lines;
  std::vector<std::uint32_t> band_start, by_band;  ///< triangles of each band, in order
};

void divide_into_bands(Drawing& drawing) {
  const int rows = kBandRows * drawing.samples, bands = (drawing.height + rows - 1) / rows;
  const auto for_each_band = [&](const auto& visit) {
    for (std::uint32_t t = 0; t < drawing.triangles.size(); ++t) {
      const Projected& p = drawing.triangles[t];
      if (p.turn == 0 || samples_between(p.x, drawing.width).empty()) continue;
      const Rows at = samples_between(p.y, drawing.height);
      for (int band = at.first / rows; !at.empty() && band <= at.last / rows; ++band)
        visit(static_cast<std::size_t>(band), t);
    }
  };
  drawing.band_start.assign(static_cast<std::size_t>(bands) + 1, 0);
  for_each_band([&](std::size_t band, std::uint32_t) { ++drawing.band_start[band + 1]; });
  for (std::size_t b = 0; b < static_cast<std::size_t>(bands); ++b) drawing.band_start[b + 1] += drawing.band_start[b];
  drawing.by_band.resize(drawing.band_start.back());
  std::vector<std::uint32_t> next(drawing.band_start.begin(), drawing.band_start.end() - 1);
  for_each_band([&](std::size_t band, std::uint32_t t) { drawing.by_band[next[band]++] = t; });
}

/// The nearest triangle at each sample of a band.
class Layer {
 public:
  Layer(int width, int first_row, int rows)
      : width_(width),
        first_(first_row),
        rows_(rows),
        depth_(static_cast<std::size_t>(width) * static_cast<std::size_t>(rows),
               -std::numeric_limits<float>::infinity()),
        triangle_(depth_.size(), kNone) {}

  std::uint32_t triangle(int x, int row) const { return triangle_[place(x, row)]; }
  float depth(int x, int row) const { return depth_[place(x, row)]; }

  void draw(const Projected& p, std::uint32_t number) {
    const Rows across = samples_between(p.x, width_);
    Rows down = samples_between(p.y, first_ + rows_);
    down.first = std::max(down.first, first_);
    if (across.empty()) return;
    Edges edges(p);
    for (int y = down.first; y <= down.last; ++y) {
      edges.go_to(across.first, y);
      for (int x = across.first; x <= across.last; ++x, edges.step())
        if (edges.inside()) keep_nearest(place(x, y - first_), edges.depth(), number);
    }
  }

 private:
  /// On which sides of its edges a sample lies: the numbers are exact.
  struct Edges {
    explicit Edges(const Projected& of) : p(of) {
      for (int i = 0; i < 3; ++i) {
        const int k = (i + 1) % 3;
        const std::int64_t dx = std::int64_t{p.x[k]} - p.x[i], dy = std::int64_t{p.y[k]} - p.y[i];
        across[i] = -p.turn * -dy * kStepsOfSample;
        // Of a sample on the edge between two triangles one is the owner.
        const std::int64_t sx = p.turn * dx, sy = p.turn * dy;
        least[i] = sy > 0 || (sy == 0 && sx < 0) ? 0 : 1;
      }
      const double area = std::abs(static_cast<double>(side(p, 0, 1, p.x[2], p.y[2])));
      for (int i = 0; i < 3; ++i) weight[i] = p.depth[(i + 2) % 3] / area;
    }
    void go_to(int sx, int sy) {
      for (int i = 0; i < 3; ++i)
        value[i] = -p.turn * side(p, i, (i + 1) % 3, std::int64_t{sx} * kStepsOfSample + kStepsOfSample / 2,
                                  std::int64_t{sy} * kStepsOfSample + kStepsOfSample / 2);
    }
    void step() {
      for (int i = 0; i < 3; ++i) value[i] += across[i];
    }
    bool inside() const { return value[0] >= least[0] && value[1] >= least[1] && value[2] >= least[2]; }
    float depth() const {
      return static_cast<float>(static_cast<double>(value[0]) * weight[0] + static_cast<double>(value[1]) * weight[1] +
                                static_cast<double>(value[2]) * weight[2]);
    }
    const Projected& p;
    std::array<std::int64_t, 3> value{}, across{}, least{};
    std::array<double, 3> weight{};
  };

  void keep_nearest(std::size_t at, float depth, std::uint32_t number) {
    if (!(depth > depth_[at])) return;
    depth_[at] = depth, triangle_[at] = number;
  }
  std::size_t place(int x, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }

  int width_, first_, rows_;
  std::vector<float> depth_;
  std::vector<std::uint32_t> triangle_;
};

/// What colour a sample of a triangle has.
class Painter {
 public:
  explicit Painter(const Drawing& drawing) : drawing_(drawing) {}

  Vec3 colour(std::uint32_t t, int x, int y) const {
    const Projected& p = drawing_.triangles[t];
    const SceneFace& face = drawing_.scene.faces[drawing_.scene.triangles[t].face];
    const Rgb own = p.turn > 0 ? face.front : face.back;
    const double shade = drawing_.scene.normals.empty() ? p.shade : smooth_shade(t, x, y);
    const Vec3 lit = min(shade * Vec3{1.0 * own.r, 1.0 * own.g, 1.0 * own.b}, {255, 255, 255});
    const double ink = line_at(t, x, y);
    return (1 - ink) * lit + ink * Vec3{1.0 * kInk.r, 1.0 * kInk.g, 1.0 * kInk.b};
  }

 private:
  /// In parts of the area: how far a sample is from the edges, opposite corners 2, 0 and 1.
  std::array<double, 3> shares(const Projected& p, int x, int y) const {
    const std::int64_t sx = std::int64_t{x} * kStepsOfSample + kStepsOfSample / 2,
                       sy = std::int64_t{y} * kStepsOfSample + kStepsOfSample / 2;
    const double area = std::abs(static_cast<double>(side(p, 0, 1, p.x[2], p.y[2])));
    std::array<double, 3> share{};
    for (int i = 0; i < 3; ++i) share[i] = std::abs(static_cast<double>(side(p, i, (i + 1) % 3, sx, sy))) / area;
    return share;
  }
  double smooth_shade(std::uint32_t t, int x, int y) const {
    const Projected& p = drawing_.triangles[t];
    const std::array<double, 3> share = shares(p, x, y);
    Vec3 normal;
    for (int i = 0; i < 3; ++i) normal += share[i] * drawing_.scene.normals[t][(i + 2) % 3];
    return shade_of(p.turn * normalized(normal), drawing_.camera);
  }
  /// How much of a sample lines take, 0 to 1.
  double line_at(std::uint32_t t, int x, int y) const {
    constexpr double kHalf = 0.42, kInkOfThin = 0.62;  // pixels
    constexpr double kUnseen = 1.6, kWhole = 7;  // heights of triangles whose lines would be all that is seen of them
    const SceneTriangle& triangle = drawing_.scene.triangles[t];
    const Projected& p = drawing_.triangles[t];
    if (triangle.lines == std::array<EdgeLine, 3>{} || p.height < kUnseen) return 0;
    const std::int64_t sx = std::int64_t{x} * kStepsOfSample + kStepsOfSample / 2,
                       sy = std::int64_t{y} * kStepsOfSample + kStepsOfSample / 2;
    double ink = 0;
    for (int i = 0; i < 3; ++i) {
      if (triangle.lines[i] != EdgeLine::kThin) continue;
      const double apart = std::abs(static_cast<double>(side(p, i, (i + 1) % 3, sx, sy))) * p.pixels[i];
      if (apart < kHalf) ink = kInkOfThin * std::min(1.0, (p.height - kUnseen) / (kWhole - kUnseen));
    }
    return ink;
  }

  const Drawing& drawing_;
};

/// Where strong lines go over a band.
class LineLayer {
 public:
  LineLayer(int width, const Layer& solid, int first_row, int rows)
      : width_(width), first_(first_row), rows_(rows), solid_(solid) {}
  void draw(const Drawing& drawing) {
    constexpr double kHalf = 0.85;  // pixels
    for (const StrongLine& line : drawing.lines) draw(line, kHalf * drawing.samples);
  }
  bool is_on(int x, int row) const {
    return !is_on_.empty() &&
           is_on_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)] != 0;
  }

 private:
  /// The samples whose middles are so near, and before which nothing lies.
  void draw(const StrongLine& line, double reach) {
    const Rows down = near(line.from.y, line.to.y, reach, first_, first_ + rows_),
               across = near(line.from.x, line.to.x, reach, 0, width_);
    if (down.empty() || across.empty()) return;
    if (is_on_.empty()) is_on_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(rows_), 0);
    const double dx = line.to.x - line.from.x, dy = line.to.y - line.from.y, along = dx * dx + dy * dy;
    for (int y = down.first; y <= down.last; ++y)
      for (int x = across.first; x <= across.last; ++x) {
        const double px = x + 0.5 - line.from.x, py = y + 0.5 - line.from.y;
        const double t = along > 0 ? std::clamp((px * dx + py * dy) / along, 0.0, 1.0) : 0;
        const double ax = px - t * dx, ay = py - t * dy;
        if (ax * ax + ay * ay > reach * reach) continue;
        // What the line lies on is as far away, but for its slope over the width of the line.
        constexpr double kOnSurface = 3;  // pixels
        const double depth = line.depth_from + t * (line.depth_to - line.depth_from) + kOnSurface;
        if (depth > solid_.depth(x, y - first_))
          is_on_[static_cast<std::size_t>(y - first_) * static_cast<std::size_t>(width_) +
                 static_cast<std::size_t>(x)] = 1;
      }
  }
  static Rows near(double a, double b, double reach, int begin, int end) {
    const double low = std::min(a, b) - reach, high = std::max(a, b) + reach;
    if (!(high >= begin) || !(low < end)) return {};
    return {std::max(begin, static_cast<int>(std::max(low, 1.0 * begin))),
            std::min(end - 1, static_cast<int>(std::min(high, 1.0 * end)))};
  }

  int width_, first_, rows_;
  const Layer& solid_;
  std::vector<char> is_on_;
};

/// A band of the picture, drawn by one thread.
class Band {
 public:
  Band(const Drawing& drawing, std::size_t number)
      : drawing_(drawing),
        painter_(drawing),
        first_(static_cast<int>(number) * kBandRows * drawing.samples),
        rows_(std::min(kBandRows * drawing.samples, drawing.height - first_)),
        all_(drawing.width, first_, rows_),
        marked_(drawing.scene.marks > 0 ? drawing.width : 0, first_, rows_),
        lines_(drawing.width, all_, first_, rows_) {
    for (std::uint32_t i = drawing.band_start[number]; i < drawing.band_start[number + 1]; ++i) {
      const std::uint32_t t = drawing.by_band[i];
      all_.draw(drawing.triangles[t], t);
      if (drawing.scene.marks > 0 && face_of(t).mark != kNone) marked_.draw(drawing.triangles[t], t);
    }
    lines_.draw(drawing);
  }

  void paint(Picture& picture, std::vector<std::uint32_t>& faces) const {
    const int n = drawing_.samples;
    for (int row = 0; row < rows_; row += n)
      for (int x = 0; x < drawing_.width; x += n) {
        const std::size_t at = static_cast<std::size_t>((first_ + row) / n) * static_cast<std::size_t>(picture.width) +
                               static_cast<std::size_t>(x / n);
        if (!is_inside(x / n, (first_ + row) / n)) continue;
        paint_pixel(&picture.pixels[3 * at], x, row);
        const std::uint32_t t = all_.triangle(x + n / 2, row + n / 2);
        faces[at] = t == kNone ? kNone : drawing_.scene.triangles[t].face;
      }
  }

 private:
  bool is_inside(int x, int y) const {
    const Rectangle& clip = drawing_.options.clip;
    return x >= clip.x0 && x < clip.x1 && y >= clip.y0 && y < clip.y1;
  }
  const SceneFace& face_of(std::uint32_t t) const { return drawing_.scene.faces[drawing_.scene.triangles[t].face]; }

  void paint_pixel(std::uint8_t* pixel, int x, int row) const {
    const int n = drawing_.samples;
    constexpr double kStrongShare = 0.88;
    const Vec3 ink{1.0 * kInk.r, 1.0 * kInk.g, 1.0 * kInk.b}, ground{1.0 * pixel[0], 1.0 * pixel[1], 1.0 * pixel[2]};
    Vec3 sum;
    bool is_empty = true;
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const std::uint32_t t = all_.triangle(x + i, row + j);
        const bool is_line = lines_.is_on(x + i, row + j);
        is_empty = is_empty && t == kNone && !is_line;
        const Vec3 own = t == kNone ? ground : seen_at(t, x + i, row + j);
        sum += is_line ? kStrongShare * ink + (1 - kStrongShare) * own : own;
      }
    if (is_empty) return;
    for (int c = 0; c < 3; ++c) pixel[c] = static_cast<std::uint8_t>(sum[c] / (n * n) + 0.5);
  }
  /// What is highlighted shines through what is before it.
  Vec3 seen_at(std::uint32_t t, int x, int row) const {
    constexpr double kShine = 0.45;
    const Vec3 own = painter_.colour(t, x, first_ + row);
    if (drawing_.scene.marks == 0 || face_of(t).mark != kNone) return own;
    const std::uint32_t behind = marked_.triangle(x, row);
    if (behind == kNone) return own;
    return (1 - kShine) * own + kShine * painter_.colour(behind, x, first_ + row);
  }

  const Drawing& drawing_;
  Painter painter_;
  int first_, rows_;
  Layer all_, marked_;
  LineLayer lines_;
};

/// Each edge is there twice, of the triangles on both sides: once is enough, but an edge may have one.
std::vector<StrongLine> strong_lines(const Scene& scene, const Camera& camera, int samples) {
  std::vector<StrongLine> all;
  const auto end = [&](Vec3 p) {
    const Pixel at = camera.project(p);
    return std::pair{Pixel{samples * at.x, samples * at.y}, camera.scale * dot(p - camera.target, camera.back)};
  };
  for (const SceneTriangle& t : scene.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      if (t.lines[i] != EdgeLine::kStrong) continue;
      const auto [from, depth_from] = end(t.at[i]);
      const auto [to, depth_to] = end(t.at[(i + 1) % 3]);
      all.push_back({from, to, depth_from, depth_to});
    }
  return all;
}

}  // namespace

std::vector<std::uint32_t> rasterise(const Scene& scene, const Camera& camera, Picture& picture,
                                     const RasterOptions& options, const RunContext& context) {
  const int n = options.samples;
  Drawing drawing{scene, camera, options, n, n * picture.width, n * picture.height, {}, strong_lines(scene, camera, n),
                  {},    {}};
  drawing.triangles.resize(scene.triangles.size());
  parallel_for(scene.triangles.size(), [&](std::size_t t) {
    drawing.triangles[t] = projected(scene.triangles[t], camera, n, scene.is_closed);
  });
  divide_into_bands(drawing);
  std::vector<std::uint32_t> faces(static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height),
                                   kNone);
  parallel_for(
      drawing.band_start.size() - 1,
      [&](std::size_t band) {
        context.check();
        Band(drawing, band).paint(picture, faces);
      },
      Split::kSingly);
  return faces;
}

}  // namespace octafront
