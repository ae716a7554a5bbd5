// The number of elements that sizes will make, and the lattice that makes just so many.
//
// The inside is filled by a lattice whose cells have powers of two of one edge length, the shell around it by a front
// that follows the sizes. A cell is divided while its edges are more than kLatticeTooLong times the wanted ones, so
// they lie between .75 and 1.5 of these: where most of the inside wants one size, an unlucky choice of the powers makes
// up to 2.4 times as many elements as were asked for, or .3 times. Over an octave of choices the mean of the numbers
// made is the number asked for; there is always a choice that makes it (nearly).

#include "sizing/field/expected_tets.h"

#include "base/core/elementary.h"
#include "base/core/parallel.h"
#include "base/mesh/complex.h"
#include "sizing/field/affordable.h"
#include "sizing/field/background_grid.h"
#include "sizing/field/inside_fraction.h"
#include "sizing/field/thin_walls.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

namespace octafront {

namespace {

/// Where the lattice steps from one cell size to the next it has more elements; how often it does grows with the slope.
/// Measured over 21 models at automatic size, where it brings the mean of expected over made elements to 1.
constexpr double kTetsPerSlope = 1.1;
/// Sizes inside are told apart in steps of this part of an octave; so are the choices of the lattice.
constexpr int kStepsPerOctave = 48;
/// There are steps for sizes from 2^-32 to 2^8 of the root's side: more than octrees have levels.
constexpr int kStepsBelow = 32 * kStepsPerOctave, kSteps = kStepsBelow + 8 * kStepsPerOctave;
/// What a lattice that misses the number by e-fold is worth in octaves of distance to the surface's own size.
constexpr double kMissPerOctave = 0.15;
/// What a lattice that misses the number by e-fold is worth in parts of the volume that are not in cells of the
/// commonest size. Sizes that differ little then get cells of one size, without the poorer elements in between.
constexpr double kMissPerMixed = 0.2;

/// A thin wall or two that change the number by less than this part are lost in the spread of kTetsPerCube.
constexpr double kWorthCounting = 0.05;

double size_of_step(int step) {
  return elementary::exp2((step - kStepsBelow + 0.5) / kStepsPerOctave);
}
/// The logarithm of a normal h > 0 to base 2 but for 1e-7: of a mantissa between the roots of 1/2 and 2 by the series
/// of log((1 + t) / (1 - t)).
double rough_log2(double h) {
  const auto bits = std::bit_cast<std::uint64_t>(h);
  const auto exponent = static_cast<double>(static_cast<std::int64_t>(bits >> 52) - 1023);
  const double m = std::bit_cast<double>((bits & 0x000f'ffff'ffff'ffffu) | 0x3ff0'0000'0000'0000u);
  const bool is_upper = m > std::numbers::sqrt2;
  const double t = ((is_upper ? 0.5 * m : m) - 1) / ((is_upper ? 0.5 * m : m) + 1), t2 = t * t;
  const double log = 2 * std::numbers::log2e * t * (1 + t2 * (1.0 / 3 + t2 * (1.0 / 5 + t2 * (1.0 / 7))));
  return exponent + (is_upper ? 1 : 0) + log;
}

/// Where a rough logarithm leaves no doubt it decides.
double floor_of_log2(double h) {
  constexpr double kInDoubt = 1e-4;
  const double rough = rough_log2(h) * kStepsPerOctave, down = std::floor(rough);
  if (h >= 0x1p-1000 && rough - down > kInDoubt && rough - down < 1 - kInDoubt) [[likely]]
    return down;
  return std::floor(elementary::log2(h) * kStepsPerOctave);
}

std::size_t step_of_size(double h) {
  const auto step = static_cast<int>(floor_of_log2(h));
  return static_cast<std::size_t>(std::clamp(step + kStepsBelow, 0, kSteps - 1));
}

/// What the sizes ask for, in parts: lengths in units of the root's side, elements in units of kTetsPerCube.
struct Demand {
  double shell = 0;  ///< elements of the front, in the leaves that the surface runs through
  /// Volume of the leaves inside by step of size, more where sizes change.
  std::vector<double> volume = std::vector<double>(kSteps);
  double surface_size = 0;  ///< half of the surface's triangles will be smaller

  Demand& operator+=(const Demand& other) {
    shell += other.shell;
    for (int s = 0; s < kSteps; ++s) volume[s] += other.volume[s];
    return *this;
  }
  /// Calls visit(size, volume), from small to large sizes.
  template <class Visit>
  void for_each_size(Visit&& visit) const {
    for (int s = 0; s < kSteps; ++s)
      if (volume[s] != 0) visit(size_of_step(s), volume[s]);
  }
};

double lattice_size(double h, double cell) {
  return cell * elementary::exp2(std::floor(elementary::log2(kLatticeTooLong * h / cell)));
}

double elements_inside(const Demand& demand, double cell) {
  double sum = 0;
  demand.for_each_size([&](double h, double volume) { sum += volume / elementary::pow(lattice_size(h, cell), 3); });
  return sum;
}

/// Part of the volume that lies in cells of the commonest size.
double largest_share(const Demand& demand, double cell) {
  std::map<double, double> volume_of;
  double all = 0, most = 0;
  demand.for_each_size([&](double h, double volume) {
    double& sum = volume_of[lattice_size(h, cell)];
    sum += volume;
    all += volume;
    most = std::max(most, sum);
  });
  return all > 0 ? most / all : 1;
}

double elements_asked_inside(const Demand& demand) {
  double sum = 0;
  demand.for_each_size([&](double h, double volume) { sum += volume / elementary::pow(h, 3); });
  return sum;
}

/// The cell of the lattice by three costs: it should make the number of elements asked for, be near the size of the
/// surface, where the front meets the lattice, and give most of the volume cells of one size.
double choose_cell(const Demand& demand) {
  const double asked = elements_asked_inside(demand);
  struct Choice {
    double cell = 0, cost = 0;
  };
  std::array<Choice, kStepsPerOctave + 1> choices;
  parallel_for(
      choices.size(),
      [&](std::size_t i) {
        const double octaves = (static_cast<double>(i) - kStepsPerOctave / 2) / kStepsPerOctave;
        const double cell = demand.surface_size * elementary::exp2(octaves);
        const double miss = asked > 0 ? std::abs(elementary::log(elements_inside(demand, cell) / asked)) : 0;
        choices[i] = {cell,
                      miss + kMissPerOctave * std::abs(octaves) + kMissPerMixed * (1 - largest_share(demand, cell))};
      },
      Split::kSingly);
  double best = demand.surface_size, least = HUGE_VAL;
  for (const Choice& choice : choices)
    if (choice.cost < least) least = choice.cost, best = choice.cell;
  return best;
}

/// The surface in pieces by the leaves that they lie in, and the part of each leaf inside.
struct DividedSurface {
  RawVector<SurfacePiece> pieces;
  RawVector<double> fraction;

  DividedSurface(const OctreeField& field, const SurfaceMesh& surface)
      : pieces(surface_pieces(field.root, field.tree, surface)),
        fraction(inside_fractions(field.root, field.tree, pieces)) {}
};

/// The size at each piece, input units.
RawVector<double> sizes_at(std::span<const SurfacePiece> pieces, const OctreeField& field) {
  RawVector<double> sizes(pieces.size());
  parallel_for(pieces.size(), [&](std::size_t i) { sizes[i] = field.at(pieces[i].p, pieces[i].leaf); });
  return sizes;
}

/// In units of the root's side.
double median_on_surface(const OctreeField& field, std::span<const SurfacePiece> pieces,
                         std::span<const double> sizes) {
  struct Count {
    double h, count;
    auto operator<=>(const Count&) const = default;
  };
  RawVector<Count> counts(pieces.size());
  parallel_for(pieces.size(), [&](std::size_t i) {
    const double h = sizes[i] / field.root.side;
    counts[i] = {h, length(pieces[i].n) / (h * h)};
  });
  parallel_sort(counts);
  double all = 0, below = 0;
  for (const auto& [h, count] : counts) all += count;
  for (const auto& [h, count] : counts) {
    below += count;
    if (below >= 0.5 * all) return h;
  }
  return field.high;
}

/// How fast the size changes in a leaf of the given side: the gradient at its centre.
double slope_in(const std::array<double, 8>& h, double side) {
  double sum = 0;
  for (int axis = 1; axis < 8; axis *= 2) {
    double rise = 0;
    for (int k = 0; k < 8; ++k) rise += (k & axis) ? h[k] : -h[k];
    sum += rise * rise / 16;
  }
  return std::sqrt(sum) / side;
}

/// Calls visit(h) at the eight points of the two-point Gauss rule along each axis.
template <class Visit>
void for_each_gauss_point(const std::array<double, 8>& h, Visit&& visit) {
  constexpr double kAt[2] = {0.21132486540518713, 0.78867513459481287};
  for (int i = 0; i < 8; ++i) visit(trilinear(h, kAt[i & 1], kAt[i >> 1 & 1], kAt[i >> 2]));
}

/// What the sizes in a leaf ask for.
void add_demand(const OctreeField& field, std::size_t leaf, double fraction, Demand& demand) {
  const double side = 1.0 / (1u << field.tree.leaf(leaf).level()), part = side * side * side / 8;
  const double steps = 1 + kTetsPerSlope * slope_in(field.h[leaf], side);
  for_each_gauss_point(field.h[leaf], [&](double h) {
    if (fraction == 1)
      demand.volume[step_of_size(h)] += steps * part;
    else
      demand.shell += fraction * part / (h * h * h);
  });
}

Demand demand_of(const OctreeField& field, const DividedSurface& surface, std::span<const double> sizes) {
  const RawVector<double>& fraction = surface.fraction;
  Demand demand = parallel_sum(field.tree.size(), [&](std::size_t begin, std::size_t end) {
    Demand part;
    for (std::size_t l = begin; l < end; ++l)
      if (fraction[l] > 0) add_demand(field, l, fraction[l], part);
    return part;
  });
  demand.surface_size = median_on_surface(field, surface.pieces, sizes);
  return demand;
}

/// A field that is no background grid, sampled onto one.
std::shared_ptr<const OctreeField> sampled_grid(const SizeField& sizes, const SurfaceMesh& surface) {
  constexpr int kLevel = 5;  // 32^3 leaves
  auto field = std::make_shared<OctreeField>();
  field->root = root_around(surface);
  std::vector<OctreeKey> leaves;
  for (OctreeKey k = OctreeKey::containing(0, 0, 0, kLevel); leaves.size() < 1u << (3 * kLevel);
       k = OctreeKey::from_id(k.range_max() + (k.id() - k.range_min()) + 2)) {
    leaves.push_back(k);
  }
  field->tree = Octree(std::move(leaves));
  field->h = sizes_at_leaves(sizes, field->root, field->tree);
  field->find_range();
  return field;
}

/// The background grid behind the sizes, or one sampled from them.
std::shared_ptr<const OctreeField> grid_of(const SizeField& sizes, const SurfaceMesh& surface) {
  if (const OctreeField* grid = as_octree_field(sizes)) return {std::shared_ptr<const void>(), grid};
  return sampled_grid(sizes, surface);
}

double elements_by_volume(const OctreeField& grid, const SurfaceMesh& surface, const DividedSurface& divided,
                          std::span<const double> sizes) {
  if (grid.low == grid.high) {
    const double h = grid.min_size();
    return kTetsPerCube * std::abs(enclosed_volume(surface)) / (h * h * h);
  }
  const Demand demand = demand_of(grid, divided, sizes);
  return kTetsPerCube * (demand.shell + elements_inside(demand, choose_cell(demand)));
}

double count_by(const OctreeField& grid, const SurfaceMesh& surface, const DividedSurface& divided,
                const ThinWalls& walls, std::optional<std::size_t> triangles) {
  const RawVector<double> sizes = sizes_at(divided.pieces, grid);
  const double by_volume = elements_by_volume(grid, surface, divided, sizes);
  const double excess = walls.excess_tets(divided.pieces, sizes, triangles);
  return std::max(1.0, std::abs(excess) < kWorthCounting * by_volume ? by_volume : by_volume + excess);
}

}  // namespace

// What lies between regions bounds nothing that is to be counted.
TetPrediction::TetPrediction(const SurfaceMesh& surface)
    : hull_(surface.sides.empty() ? SurfaceMesh{} : hull_of(surface)),
      surface_(surface.sides.empty() ? surface : hull_),
      walls_(new ThinWalls(surface_)) {}
TetPrediction::~TetPrediction() = default;

double TetPrediction::operator()(const SizeField& sizes, std::optional<std::size_t> triangles) const {
  const auto grid = grid_of(sizes, surface_);
  return count_by(*grid, surface_, DividedSurface(*grid, surface_), *walls_, triangles);
}

double TetPrediction::through_walls(const SizeField& sizes, std::optional<std::size_t> triangles) const {
  const auto grid = grid_of(sizes, surface_);
  const DividedSurface divided(*grid, surface_);
  return walls_->tets_through(divided.pieces, sizes_at(divided.pieces, *grid), triangles);
}

std::function<double(const OctreeField&)> TetPrediction::on_leaves_of(const OctreeField& grid) const {
  return [this, divided = DividedSurface(grid, surface_)](const OctreeField& other) {
    return count_by(other, surface_, divided, *walls_, {});
  };
}

double expected_tets(const SizeField& sizes, const SurfaceMesh& surface) {
  return TetPrediction(surface)(sizes, {});
}

double expected_tets_within(const SizeField& sizes, const SurfaceMesh& made) {
  const TetPrediction predicted(made);
  return predicted(sizes, predicted.triangles());
}

double expected_tets_through_walls(const SizeField& sizes, const SurfaceMesh& made) {
  const TetPrediction predicted(made);
  return predicted.through_walls(sizes, predicted.triangles());
}

double lattice_cell_size(const SizeField& sizes, const SurfaceMesh& surface) {
  if (sizes.min_size() == sizes.max_size()) return sizes.min_size();
  const auto grid = grid_of(sizes, surface);
  const SurfaceMesh hull = surface.sides.empty() ? SurfaceMesh{} : hull_of(surface);
  const DividedSurface divided(*grid, surface.sides.empty() ? surface : hull);
  return choose_cell(demand_of(*grid, divided, sizes_at(divided.pieces, *grid))) * grid->root.side;
}

}  // namespace octafront
