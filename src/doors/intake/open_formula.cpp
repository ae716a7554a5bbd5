#include <octafront/error.h>
#include <octafront/formula.h>

#include "base/core/parallel.h"
#include "base/core/thread_limit.h"
#include "base/core/wording.h"
#include "doors/intake/cell.h"
#include "doors/intake/intake.h"
#include "images/formulas/geometry.h"
#include "images/nets/function_surface.h"
#include "periodic/periodic_cell.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include <fmt/core.h>

namespace octafront {

namespace {

using formulas::FunctionGeometry;
using formulas::SpaceFunction;

/// Cells along the longest side where nothing else is said, and along each period at least.
constexpr std::uint32_t kCells = 64, kCellsOfPeriod = 32, kLeastCells = 4;
constexpr double kMostCells = 4e8;
/// Gradients are differences over this part of a cell: the error of the one falls with its square, that of rounding
/// rises with its inverse.
constexpr double kStepOfCell = 1e-4;
/// Corners on the faces of the box come to lie there up to rounding, in cells; then exactly.
constexpr double kOnFace = 1e-6;

/// A box in equal cells.
struct Cells {
  Box3 box;
  std::array<std::uint32_t, 3> size = {0, 0, 0};

  double side(int axis) const { return box.extent()[axis] / size[static_cast<std::size_t>(axis)]; }
  double largest() const { return std::max({side(0), side(1), side(2)}); }
  Vec3 middle(std::size_t number) const {
    const std::size_t i = number % size[0], j = number / size[0] % size[1], k = number / size[0] / size[1];
    return box.lo + Vec3{(static_cast<double>(i) + 0.5) * side(0), (static_cast<double>(j) + 0.5) * side(1),
                         (static_cast<double>(k) + 0.5) * side(2)};
  }
  std::size_t count() const { return std::size_t{size[0]} * size[1] * size[2]; }
};

void check_box(const Box3& box) {
  const Vec3 e = box.extent();
  if (is_finite(box.lo) && is_finite(box.hi) && e.x > 0 && e.y > 0 && e.z > 0) return;
  throw OptionError(
      fmt::format("`box` from ({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g}) is no box: give its least and its "
                  "largest corner",
                  box.lo.x, box.lo.y, box.lo.z, box.hi.x, box.hi.y, box.hi.z));
}

Cells cells_of(const IntakeOptions& options, bool is_periodic, double period) {
  const FormulaIntake& asked = options.formula;
  if (options.box.empty() && !is_periodic)
    throw OptionError(
        "a formula needs the box that the body lies in or is cut by: `box` with the coordinates of its least and its "
        "largest corner; only surfaces that repeat themselves (gyroid, schwarz_p, ...) have one of their own");
  Cells cells{options.box.empty() ? Box3{{0, 0, 0}, {period, period, period}} : intake::box_of_option(options.box)};
  check_box(cells.box);
  const Vec3 e = cells.box.extent();
  const double longest = std::max({e.x, e.y, e.z});
  double along = std::max<double>(kCells, is_periodic ? std::ceil(kCellsOfPeriod * longest / period) : 0);
  if (asked.resolution) along = *asked.resolution;
  if (along < kLeastCells)
    throw OptionError(fmt::format("`resolution` is {}: at least {} cells along the box", along, kLeastCells));
  const double side = longest / along;
  if (e.x / side * (e.y / side) * (e.z / side) > kMostCells)
    throw OptionError(fmt::format(
        "the box would be {:.3g} x {:.3g} x {:.3g} cells, more than can be looked at; give a smaller box, a lower "
        "`resolution`{}",
        std::ceil(e.x / side), std::ceil(e.y / side), std::ceil(e.z / side),
        is_periodic ? fmt::format(", or a larger `cell` than {:g}, the period of the surface", period) : ""));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double cells_along = std::max<double>(kLeastCells, std::round(e[static_cast<int>(axis)] / side));
    cells.size[axis] = static_cast<std::uint32_t>(cells_along);
  }
  return cells;
}

/// Single precision without a change of sign: values say where the body is, and the function where its surface.
float rounded(double value) {
  constexpr double kMost = 1e30, kLeast = 1e-30;
  if (value >= 0) return static_cast<float>(std::min(value, kMost));
  return static_cast<float>(std::clamp(value, -kMost, -kLeast));
}

/// Its values at the middles of the cells, moved by `shift`.
Image image_of_function(const SpaceFunction& function, const Cells& cells, Vec3 shift = {}) {
  Image image;
  image.grid.size = cells.size;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3& step = image.grid.axes[static_cast<std::size_t>(axis)];
    step = {};
    step[axis] = cells.side(axis);
  }
  image.grid.origin = cells.middle(0) + shift;
  std::vector<float> values(cells.count());
  parallel_for(values.size(), [&](std::size_t i) {
    const double value = function.at(cells.middle(i) + shift);
    values[i] = std::isnan(value) ? std::numeric_limits<float>::quiet_NaN() : rounded(value);
  });
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isnan(values[i])) continue;
    const Vec3 p = cells.middle(i);
    throw InputError(
        fmt::format("the formula has no value at ({:.6g}, {:.6g}, {:.6g}): a root or logarithm below 0, or 0 over 0",
                    p.x, p.y, p.z));
  }
  const auto [least, largest] = std::minmax_element(values.begin(), values.end());
  if (!(*least < 0))
    throw InputError(fmt::format(
        "the function is nowhere below 0 in the box, its values are {:.4g} to {:.4g}: there is no body. Turn its sign, "
        "or look where it lies",
        *least, *largest));
  image.values = std::move(values);
  return image;
}

/// Puts what lies on the faces of the box up to rounding exactly there.
void lay_on_faces(SurfaceMesh& surface, const Cells& cells) {
  const Vec3 within{kOnFace * cells.side(0), kOnFace * cells.side(1), kOnFace * cells.side(2)};
  for (Vec3& p : surface.points) p = put_on_faces(p, cells.box, {true, true, true}, within);
}

/// Throws InputError unless the values at both ends of the box are the same along these axes.
void check_periods(const SpaceFunction& function, const Cells& cells, const std::array<bool, 3>& along) {
  constexpr double kSame = 1e-6;  // of the largest value: sums of sines agree to about 1e-13
  for (int axis = 0; axis < 3; ++axis) {
    if (!along[static_cast<std::size_t>(axis)]) continue;
    double largest = 0, off = 0;
    Vec3 worst;
    for (std::size_t i = 0; i < cells.count(); ++i) {
      Vec3 p = cells.middle(i);
      if (p[axis] - cells.box.lo[axis] > cells.side(axis)) continue;
      p[axis] = cells.box.lo[axis];
      Vec3 q = p;
      q[axis] = cells.box.hi[axis];
      const double a = function.at(p), b = function.at(q);
      largest = std::max({largest, std::abs(a), std::abs(b)});
      if (std::abs(a - b) > off) off = std::abs(a - b), worst = p;
    }
    if (off > kSame * largest)
      throw InputError(fmt::format(
          "the function does not repeat itself along {} by the length of the box, {:.6g}: at {} and that far "
          "on its values differ by {:.3g}. Choose a box of whole periods, or no period along {}",
          "xyz"[axis], cells.box.extent()[axis], at_point(worst), off, "xyz"[axis]));
  }
}

/// One cell of a body that goes on along these axes. Values are taken at places that no symmetry of the surface knows:
/// at others they are 0 up to rounding, which would choose one side here and the other one at copies.
Complex periodic_body(const SpaceFunction& function, const Cells& cells, const std::array<bool, 3>& along,
                      const RunContext& context) {
  check_periods(function, cells, along);
  constexpr std::array<double, 3> kApart{0.137, 0.291, 0.373};  // of a cell
  Vec3 shift{};
  for (int axis = 0; axis < 3; ++axis)
    if (along[static_cast<std::size_t>(axis)])
      shift[axis] = (kApart[static_cast<std::size_t>(axis)] - 0.5) * cells.side(axis);
  const Image image = image_of_function(function, cells, shift);
  // Vertices spread along the surface: what a sweep does reaches a voxel farther, and there are twelve.
  constexpr std::uint32_t kMargin = 16;
  const intake::PeriodicSurfaces surfaces{
      [&](const Image& wrapped) { return complex_of_function(wrapped, function, context, cells.box); }, kMargin,
      cells.box};
  return intake::complex_of_periodic_values(image, surfaces, along, context);
}

Domain opened(const std::shared_ptr<const SpaceFunction>& function, const Cells& cells, std::string format,
              const IntakeOptions& options, const RunContext& context) {
  const ThreadLimit limit(context.threads);
  context.report("reading", -1);
  const std::array<bool, 3> along = axes_named("repeat", options.repeat.value_or(""));
  const bool repeats = along[0] || along[1] || along[2];
  Domain domain;
  domain.format = std::move(format);
  domain.voxels = cells.size;
  intake::take_complex(domain, options,
                       repeats ? periodic_body(*function, cells, along, context)
                               : complex_of_function(image_of_function(*function, cells), *function, context));
  lay_on_faces(domain.surface, cells);
  auto geometry = std::make_shared<const FunctionGeometry>(function, cells.box, 2 * cells.largest());
  SurfaceMesh& surface = domain.surface;
  surface.patch_names = geometry->patch_names();
  surface.patch.resize(surface.triangles.size());
  parallel_for(surface.triangles.size(), [&](std::size_t t) {
    const auto& [a, b, c] = surface.triangles[t];
    surface.patch[t] = geometry->patch_of({surface.points[a], surface.points[b], surface.points[c]});
  });
  // Copies of nodes on the faces stay copies, bit for bit, where nothing moves them.
  if (!repeats) domain.geometry = std::move(geometry);
  return domain;
}

}  // namespace

namespace intake {

void refuse_formula_options(const FormulaIntake& formula, const std::string& name) {
  const std::pair<bool, const char*> given[] = {{formula.cell.has_value(), "cell"},
                                                {formula.resolution.has_value(), "resolution"}};
  for (const auto& [is_given, option] : given)
    if (is_given)
      throw OptionError(fmt::format("`{}` is for formulas, and {} is none (no coordinate, no named surface, or a file)",
                                    option, name));
}

}  // namespace intake

Domain open_formula(const std::string& formula, const IntakeOptions& options, const RunContext& context) {
  const double period = options.formula.cell.value_or(1);
  Formula read(formula, period);
  const Cells cells = cells_of(options, read.is_periodic(), period);
  intake::refuse_image_options(options, "a formula");
  return opened(std::make_shared<formulas::FormulaFunction>(std::move(read), kStepOfCell * cells.largest()), cells,
                "a formula", options, context);
}

Domain open_samples(const SampledFunction& samples, const IntakeOptions& options, const RunContext& context) {
  check_box(samples.box);
  std::size_t count = 1;
  for (const std::uint32_t n : samples.size) {
    if (n < kLeastCells)
      throw OptionError(fmt::format("samples along {} cells: at least {} are needed", n, kLeastCells));
    count *= std::size_t{n} + 2;
  }
  if (samples.values.size() != count)
    throw OptionError(
        fmt::format("{} samples, but the cells and a layer around them have {}", samples.values.size(), count));
  for (const double value : samples.values)
    if (!std::isfinite(value)) throw InputError(fmt::format("a sample is {}: all must be finite", value));
  intake::refuse_image_options(options, "a function");
  const Cells cells{samples.box, samples.size};
  return opened(std::make_shared<formulas::SampledSpace>(samples), cells, "samples of a function", options, context);
}

}  // namespace octafront
