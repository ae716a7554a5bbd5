#include <octafront/error.h>
#include <octafront/picture.h>
#include <octafront/quality.h>
#include <octafront/run_context.h>

#include "base/core/thread_limit.h"
#include "base/core/wording.h"
#include "report/picture/canvas.h"
#include "report/picture/furniture.h"
#include "report/picture/raster.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

namespace octafront {

namespace {

constexpr int kLeastSide = 64, kMostSide = 8192;
constexpr Vec3 kUp{0, 0, 1};

/// From the front of what stands upright, to the right and above.
Vec3 isometric(const PictureOptions& options) {
  const Vec3 up = normalized(options.up.value_or(kUp));
  constexpr double kMostly = 0.7;
  return std::abs(up.y) > kMostly ? Vec3{1, up.y, 1} : Vec3{1, -1, 1};
}

void check_picture(const PictureOptions& options) {
  for (const int side : {options.width, options.height})
    if (side < kLeastSide || side > kMostSide)
      throw OptionError(fmt::format("a picture has {} to {} pixels each way, not {} x {}", kLeastSide, kMostSide,
                                    options.width, options.height));
  const auto is_way = [](Vec3 v) { return is_finite(v) && squared_length(v) > 0; };
  if (options.view && !is_way(*options.view)) throw OptionError("a view is a direction, not zero");
  if (options.up && !is_way(*options.up)) throw OptionError("up is a direction, not zero");
  if (options.cut && !is_way(options.cut->normal)) throw OptionError("a cut has a normal, not zero");
}

Picture blank(int width, int height) {
  constexpr std::uint8_t kGround = 255;  // white
  return {width, height,
          std::vector<std::uint8_t>(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), kGround)};
}

/// Somewhat from the side, so that a cut has depth; of both sides that nearer to where one looks from else.
Vec3 view_of_cut(const PictureOptions& options) {
  const Camera straight = looking_from(options.cut->normal, options.up.value_or(kUp));
  const auto towards = [&](Vec3 way) { return dot(way, isometric(options)) < 0 ? -way : way; };
  return straight.back + 0.45 * towards(straight.right) + 0.4 * towards(straight.up);
}

/// How much of what is highlighted is seen, of what could be.
std::uint64_t marked_pixels(const Scene& scene, Vec3 view, const RunContext& context) {
  constexpr int kWide = 240, kHigh = 180;
  Camera camera = looking_from(view);
  fit(camera, scene, {0, 0, kWide, kHigh});
  Picture small = blank(kWide, kHigh);
  std::uint64_t count = 0;
  for (const std::uint32_t face : rasterise(scene, camera, small, {1, camera.window}, context))
    count += face != kNone && scene.faces[face].mark != kNone;
  return count;
}

/// From which of eight sides most of what is highlighted is seen; where that is little better, from the usual one.
Vec3 view_of_marks(const Scene& scene, const PictureOptions& options, const RunContext& context) {
  const Vec3 usual = isometric(options);
  Vec3 best = usual;
  constexpr double kMuchBetter = 1.4;
  double most = kMuchBetter * static_cast<double>(marked_pixels(scene, usual, context));
  for (const double x : {1, -1})
    for (const double y : {-1, 1})
      for (const double z : {1, -1}) {
        const auto seen = static_cast<double>(marked_pixels(scene, {x, y, z}, context));
        if (seen > most) most = seen, best = {x, y, z};
      }
  return best;
}

Vec3 chosen_view(const PictureOptions& options, const Scene& scene, const RunContext& context) {
  if (options.view) return *options.view;
  if (options.cut) return view_of_cut(options);
  return scene.marks > 0 ? view_of_marks(scene, options, context) : isometric(options);
}

void draw_marked_lines(Canvas& canvas, const Scene& scene, const Camera& camera, double text) {
  std::vector<std::vector<std::vector<Pixel>>> by_place(scene.marks);
  for (const auto& [place, line] : scene.marked_lines) {
    std::vector<Pixel>& made = by_place[place].emplace_back();
    for (const Vec3 p : line) made.push_back(camera.project(p));
  }
  for (std::uint32_t k = 0; k < by_place.size(); ++k)
    if (!by_place[k].empty()) canvas.lines(by_place[k], {colour_of_mark(k), std::max(2.5, 0.3 * text), 1});
}

std::vector<std::string> caption_of(const Scene& scene, const PictureOptions& options) {
  std::vector<std::string> lines = scene.caption;
  if (!options.title.empty()) {
    if (lines.empty())
      lines.push_back(options.title);
    else
      lines.front() = options.title + ": " + lines.front();
  }
  return lines;
}

/// A picture, and the camera that it was taken by.
struct Taken {
  Picture picture;
  Camera camera;
  Layout layout;
};

/// `aim`: what a close-up is of, its middle and its radius.
struct Aim {
  Vec3 middle;
  double radius = 0;
};

Taken take(const Scene& scene, const PictureOptions& options, const Aim* aim, const RunContext& context) {
  context.report("drawing", -1);
  const std::vector<std::string> caption = caption_of(scene, options);
  Taken taken{blank(options.width, options.height),
              looking_from(chosen_view(options, scene, context), options.up.value_or(kUp)),
              layout_for(options.width, options.height, scene.legend, caption.size(), options.furniture)};
  constexpr double kPartOfCloseUp = 0.22;
  if (aim == nullptr)
    fit(taken.camera, scene, taken.layout.window);
  else
    fit(taken.camera, aim->middle, aim->radius, kPartOfCloseUp, taken.layout.window);
  const std::vector<std::uint32_t> faces =
      rasterise(scene, taken.camera, taken.picture, {3, taken.layout.picture}, context);
  Canvas canvas(taken.picture);
  draw_marked_lines(canvas, scene, taken.camera, taken.layout.text);
  if (options.names) {
    const std::vector<std::string> left = draw_names(canvas, taken.layout, scene, faces);
    for (const std::string& name : left)
      taken.picture.notes.push_back(fmt::format("not named in the picture, for it is hidden or small there: {}", name));
  }
  if (!options.furniture) return taken;
  draw_axes(canvas, taken.layout, taken.camera);
  draw_scale_bar(canvas, taken.layout, taken.camera, options.unit);
  draw_legend(canvas, taken.layout, scene.legend);
  draw_caption(canvas, taken.layout, caption);
  return taken;
}

/// The whole, small, with where the close-up is.
void draw_inset(Canvas& canvas, const TetMesh& mesh, const PictureOptions& options, const Layout& layout, Vec3 at,
                const RunContext& context) {
  PictureOptions whole;
  whole.color = PictureOptions::Color::kPlain, whole.edges = PictureOptions::Edges::kFeatures;
  whole.view = options.view, whole.up = options.up, whole.furniture = false;
  whole.width = std::max(kLeastSide, static_cast<int>(0.26 * layout.window.width()));
  whole.height = std::max(kLeastSide, static_cast<int>(0.26 * layout.window.height()));
  const Taken small = take(scene_of(mesh, whole, context), whole, nullptr, context);
  Picture picture = small.picture;
  Canvas inset(picture);
  const Pixel mark = small.camera.project(at);
  inset.circle(mark, 0.6 * layout.text, {colour_of_mark(0), 2, 1});
  const int left = static_cast<int>(layout.window.x0), top = static_cast<int>(layout.window.y0);
  for (int y = 0; y < picture.height && top + y < canvas.height(); ++y)
    for (int x = 0; x < picture.width && left + x < canvas.width(); ++x)
      canvas.blend(left + x, top + y, inset.at(x, y), 1);
  canvas.frame({1.0 * left, 1.0 * top, 1.0 * left + picture.width, 1.0 * top + picture.height}, {kSoftInk, 1});
}

Picture close_up(const TetMesh& mesh, PictureOptions options, const RunContext& context) {
  if (mesh.tets.empty()) throw OptionError("there is no worst element: the mesh has none at all");
  if (!options.view) options.view = isometric(options);
  const PoorElement worst = worst_elements(mesh, 1).front();
  Scene scene = scene_of(mesh, options, context);
  const std::string which =
      fmt::format("worst element: number {} at {}, β {:.4f}, dihedral angles {:.1f}° to {:.1f}°", worst.tet,
                  at_point(worst.at), worst.beta, worst.dihedral_min, worst.dihedral_max);
  scene.caption.push_back(which);
  Aim aim{worst.at};
  for (const VertexIndex v : mesh.tets[worst.tet])
    aim.radius = std::max(aim.radius, distance(mesh.points[v], worst.at));
  Taken taken = take(scene, options, &aim, context);
  Canvas canvas(taken.picture);
  std::vector<std::vector<Pixel>> edges;
  for (const auto& [i, j] : kTetEdges)
    edges.push_back({taken.camera.project(mesh.points[mesh.tets[worst.tet][i]]),
                     taken.camera.project(mesh.points[mesh.tets[worst.tet][j]])});
  canvas.lines(edges, {colour_of_mark(0), std::max(2.0, 0.22 * taken.layout.text), 1});
  if (options.furniture) draw_inset(canvas, mesh, options, taken.layout, worst.at, context);
  taken.picture.notes.push_back(which);
  return taken.picture;
}

}  // namespace

Picture draw_picture(const TetMesh& mesh, const PictureOptions& options, const RunContext& context) {
  const ThreadLimit limit(context.threads);
  check_picture(options);
  if (options.worst) return close_up(mesh, options, context);
  return take(scene_of(mesh, options, context), options, nullptr, context).picture;
}

Picture draw_picture(const SurfaceMesh& surface, const PictureOptions& options, const RunContext& context) {
  const ThreadLimit limit(context.threads);
  check_picture(options);
  if (options.worst) throw OptionError("the worst element is one of a mesh of tetrahedra, and this is a surface");
  return take(scene_of(surface, options, context), options, nullptr, context).picture;
}

}  // namespace octafront
