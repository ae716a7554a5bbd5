#include "base/options/rows.h"

namespace octafront::options {

namespace {

template <class Access>
Row<Options> row(const OptionInfo& info, Access field) {
  return row_of_field<Options>(info, field);
}

template <class Value, class Access>
Row<Options> choice(const OptionInfo& info, Access field, const Names<Value>& names) {
  return row_of_choice<Options, Value>(info, field, names);
}

template <class Access>
Row<Options> opposite(const OptionInfo& info, Access field) {
  return row_of_opposite<Options>(info, field);
}

/// Those of the paper that this program began with, which few need.
constexpr std::string_view kPaper = "Paper";

std::vector<Row<Options>> size_rows() {
  const auto of = [](std::string_view name, std::string_view help, std::string_view group = "Sizes",
                     std::string_view tasks = "mesh surface size adapt") { return About(name, group, tasks, help); };
  using Interior = SizeOptions::Interior;
  return {
      row(
          of("size", "Edge length, in units of the input", "Sizes", "mesh surface size adapt move")
              .length("H")
              .above(0)
              .common("Edge length"),
          [](auto& o) -> auto& { return o.size.size; }),
      row(
          of("elements", "Number of tetrahedra wanted, met within 15 %")
              .takes("N")
              .from(1)
              .common("Number of tetrahedra, met within 15 %"),
          [](auto& o) -> auto& { return o.size.elements; }),
      row(
          of("curvature", "Elements per full turn of a curved surface")
              .takes("K")
              .from(3)
              .common("Elements per full turn of a curved surface"),
          [](auto& o) -> auto& { return o.size.curvature; }),
      row(
          of("gap", "Elements across thin walls and narrow gaps")
              .takes("K")
              .above(0)
              .without("images with `size` or `elements`: 1")
              .common("Elements across thin walls and narrow gaps"),
          [](auto& o) -> auto& { return o.size.gap; }),
      row(
          of("through", "Elements across thin walls at least, whatever the gaps between them").takes("K").above(0),
          [](auto& o) -> auto& { return o.size.through; }),
      row(
          of("feature_elements", "Elements along each feature curve at least").takes("K").above(0),
          [](auto& o) -> auto& { return o.size.feature_elements; }),
      row(
          of("chord_error", "Sizes by which triangles stay this near to a curved surface, in units of the input")
              .called("max_deviation")
              .takes("D")
              .above(0)
              .also("-"),
          [](auto& o) -> auto& { return o.size.chord_error; }),
      row(
          of("facets", "Sizes follow the areas of the input's facets (the paper's rule)", kPaper),
          [](auto& o) -> auto& { return o.size.facets; }),
      row(
          of("min_size", "No size falls below this")
              .length("H")
              .above(0)
              .without("images with `size` or `elements`: a voxel")
              .common("No size falls below this"),
          [](auto& o) -> auto& { return o.size.min_size; }),
      row(
          of("max_size", "No size rises above this").length("H").above(0),
          [](auto& o) -> auto& { return o.size.max_size; }),
      row(
          of("automatic_factor", "Automatic sizes times this: .5 makes about eight times as many elements")
              .takes("F")
              .from(0.1)
              .to(10),
          [](auto& o) -> auto& { return o.size.automatic_factor; }),
      row(
          of("gradation", "How fast sizes may change: |h(x) - h(y)| <= G |x - y|; slow growth to fast")
              .takes("G")
              .from(0.01)
              .to(1)
              .without("by the spread of sizes, .12 to .4, order 2: .8")
              .written("gradation,grading"),
          [](auto& o) -> auto& { return o.size.gradation; }),
      choice<Interior>(of("interior", "Inside no larger than on the surface, or growing inward"),
                       [](auto& o) -> auto& { return o.size.interior; },
                       {{"uniform", Interior::kUniform}, {"graded", Interior::kGraded}}),
  };
}

std::vector<Row<Options>> surface_rows() {
  const auto of = [](std::string_view name, std::string_view help, std::string_view tasks = "mesh surface size") {
    return About(name, "Surface", tasks, help);
  };
  using Strips = SurfaceOptions::Strips;
  return {
      row(
          of("keep_surface", "The input triangles become the boundary, exactly")
              .called("keep")
              .common("The input triangles become the boundary, exactly"),
          [](auto& o) -> auto& { return o.surface.keep; }),
      row(
          of("feature_angle", "Edges that bend by more degrees than this are kept", "mesh surface size improve adapt")
              .takes("DEG")
              .above(0)
              .below(180)
              .without("40; images: 85"),
          [](auto& o) -> auto& { return o.surface.feature_angle; }),
      row(
          of("max_deviation",
             "Smaller elements where the surface would stray farther from the input, and how far folds and needles of "
             "it give way; 0: not at all. In adaptation how far the boundary may stray from what it stands for",
             "mesh surface size adapt")
              .length("D")
              .from(0)
              .without("images: 0.16 voxels, but not with `elements`; what repair moved: its tolerance; with automatic "
                       "sizes and in adaptation 0.4 % of the diagonal"),
          [](auto& o) -> auto& { return o.surface.max_deviation; }),
      row(
          of("normal_deviation", "Smaller elements where triangles would turn by more degrees against the input")
              .takes("DEG")
              .above(0)
              .to(90)
              .without("none"),
          [](auto& o) -> auto& { return o.surface.normal_deviation; }),
      choice<Strips>(
          of("strips",
             "fine: smaller elements where two feature edges run side by side nearer than an element; off: flat ones"),
          [](auto& o) -> auto& { return o.surface.strips; }, {{"fine", Strips::kFine}, {"off", Strips::kOff}}),
      row(
          of("patches", "Each part of the surface that feature edges enclose becomes a patch")
              .called("patches_by_features")
              .common("Each part between sharp edges becomes a patch: patch_1, ..."),
          [](auto& o) -> auto& { return o.surface.patches_by_features; }),
      row(
          of("keep_volumes", "Bodies and regions keep the volumes that they have in the input; images do so unasked",
             "mesh surface"),
          [](auto& o) -> auto& { return o.surface.keep_volumes; }),
      row(
          of("volume_tolerance", "Smaller elements where chords would change the volume of a region by more percent",
             "mesh")
              .takes("P")
              .above(0)
              .without("volumes are what the sizes make them"),
          [](auto& o) -> auto& { return o.surface.volume_tolerance; }),
      row(
          About("periodic", "Periodic cell", "mesh surface size",
                "Axes along which the body is one cell of a periodic one, such as x or xyz: opposite faces of its "
                "bounding box get the same triangles, and their nodes are paired; bodies and images are repeated. Or "
                "what leads from a face to its copy: X,Y,Z (a translation), DEGREES@z or DEGREES@PX,PY,PZ,DX,DY,DZ (a "
                "rotation about an axis), several with semicolons between, each with LOW:HIGH= before it where names "
                "of patches are to say what it leads to what")
              .takes("AXES|MAP"),
          [](auto& o) -> auto& { return o.periodic; }),
  };
}

std::vector<Row<Options>> layer_rows() {
  const auto of = [](std::string_view name, std::string_view help) {
    return About(name, "Boundary layers", "mesh", help);
  };
  return {
      row(
          of("layers", "Layers of thin elements along walls, as high as the options below say; 0: none")
              .called("count")
              .takes("N")
              .from(0)
              .to(100)
              .common("Layers of thin elements along walls"),
          [](auto& o) -> auto& { return o.layers.count; }),
      row(
          of("first", "Height of the first layer, at the wall")
              .length("H")
              .above(0)
              .common("Height of the first layer, at the wall"),
          [](auto& o) -> auto& { return o.layers.first; }),
      row(
          of("first_part", "Height of the first layer as a part of the edge length there").takes("F").above(0),
          [](auto& o) -> auto& { return o.layers.first_part; }),
      row(
          of("growth", "Each layer over the one below")
              .takes("G")
              .from(1)
              .to(3)
              .without("1.2, or what `first` and `total` need"),
          [](auto& o) -> auto& { return o.layers.growth; }),
      row(
          of("total", "Height of all layers").length("T").above(0), [](auto& o) -> auto& { return o.layers.total; }),
      row(
          of("yplus",
             "Height of the first layer by its y+ in a turbulent flow along a flat plate, with `Re` and "
             "`Lref`, or `speed` and `fluid`")
              .takes("Y")
              .above(0),
          [](auto& o) -> auto& { return o.layers.yplus; }),
      row(
          of("Re", "Reynolds number of the flow, for `yplus`").called("reynolds").takes("RE").above(0),
          [](auto& o) -> auto& { return o.layers.reynolds; }),
      row(
          of("Lref",
             "Length that the Reynolds number belongs to, or `speed`: then without it the body's, or the input's")
              .called("reference_length")
              .length("L")
              .above(0),
          [](auto& o) -> auto& { return o.layers.reference_length; }),
      row(
          of("speed", "Speed of the flow, m/s: for `yplus`, and at the inlet of an OpenFOAM `deck`")
              .takes("U")
              .above(0),
          [](auto& o) -> auto& { return o.layers.speed; }),
      row(
          of("fluid", "air, water, or a kinematic viscosity in m2/s: what flows").takes("NAME|NU"),
          [](auto& o) -> auto& { return o.layers.fluid; }),
      row(
          of("on", "Walls that get layers, places with commas between: patches, or regions for the walls around them")
              .takes("PLACES")
              .without("all")
              .common("Walls that get layers: patches by name or number, commas between"),
          [](auto& o) -> auto& { return o.layers.on; }),
      row(
          of("layers_in", "Regions that layers grow in, with commas between")
              .called("in")
              .takes("PLACES")
              .without("all"),
          [](auto& o) -> auto& { return o.layers.in; }),
      row(
          of("layers_outside", "Layers grow on the outside, as a shell around the mesh and a region of its own")
              .called("outside"),
          [](auto& o) -> auto& { return o.layers.outside; }),
      row(
          of("layers_as_tets", "Layers are tetrahedra also in formats that have wedges").called("as_tets"),
          [](auto& o) -> auto& { return o.layers.as_tets; }),
      row(
          of("require_coverage", "Percent of each wall's faces that must have all layers, or the run fails")
              .takes("P")
              .from(0)
              .to(100),
          [](auto& o) -> auto& { return o.layers.require_coverage; }),
  };
}

std::vector<Row<Options>> volume_rows() {
  const auto of = [](std::string_view name, std::string_view help, std::string_view group = "Volume") {
    return About(name, group, "mesh", help);
  };
  using Core = VolumeOptions::Core;
  using Ranking = VolumeOptions::Ranking;
  using Order = VolumeOptions::Order;
  return {
      choice<Method>(
          of("method",
             "octree-aft: the volume front; aft: the classical front, slow, for comparison; octree: a lattice cut at "
             "the surface, fast, also with defects, but not on the input's triangles; recover: the input's triangles "
             "kept, with as few points inside as possible"),
          [](auto& o) -> auto& { return o.method; },
          {{"octree-aft", Method::kOctreeAft},
           {"aft", Method::kAft},
           {"octree", Method::kOctree},
           {"recover", Method::kRecover}}),
      row(
          of("ideal_distance", "Ideal point above its face, as a multiple of the size there", kPaper)
              .takes("X")
              .from(0.3)
              .to(1.5),
          [](auto& o) -> auto& { return o.volume.ideal_distance; }),
      choice<Core>(
          of("core", "lattice: the inside is a lattice, the front fills the shell around it; none: all by the front",
             kPaper),
          [](auto& o) -> auto& { return o.volume.core; }, {{"lattice", Core::kLattice}, {"none", Core::kOff}}),
      choice<Ranking>(of("ranking", "Order of candidates", kPaper), [](auto& o) -> auto& { return o.volume.ranking; },
                      {{"solid-angle", Ranking::kSolidAngle}, {"quality", Ranking::kQuality}}),
      choice<Order>(
          of("queue",
             "Order of the front's faces: layer by layer, the smallest of each layer first, or the newest first",
             kPaper),
          [](auto& o) -> auto& { return o.volume.order; },
          {{"layers", Order::kLayers}, {"smallest", Order::kSmallest}, {"newest", Order::kNewest}}),
      row(
          of("shell",
             "Layers of flat elements through walls that are thinner than elements are wide, 2 or more; 0: as they "
             "come")
              .takes("N")
              .from(0),
          [](auto& o) -> auto& { return o.volume.shell; }),
  };
}

std::vector<Row<Options>> improve_rows() {
  const auto of = [](std::string_view name, std::string_view help, std::string_view group = "Improvement",
                     std::string_view tasks = "mesh improve") { return About(name, group, tasks, help); };
  using Level = ImproveOptions::Level;
  using Objective = ImproveOptions::Objective;
  return {
      choice<Level>(
          of("improve", "How the finished mesh is improved; paper: as in the paper, by its weighted Laplacian")
              .called("level")
              .common("How the finished mesh is improved"),
          [](auto& o) -> auto& { return o.improve.level; },
          {{"none", Level::kOff},
           {"paper", Level::kPaper},
           {"fast", Level::kFast},
           {"default", Level::kDefault},
           {"best", Level::kBest}}),
      choice<Objective>(
          of("objective",
             "What is improved at the worst elements: beta and dihedral angles, one of them alone, the mean ratio, or "
             "what the checks of structural solvers look at"),
          [](auto& o) -> auto& { return o.improve.objective; },
          {{"balanced", Objective::kBalanced},
           {"beta", Objective::kBeta},
           {"min-dihedral", Objective::kMinDihedral},
           {"max-dihedral", Objective::kMaxDihedral},
           {"mean-ratio", Objective::kMeanRatio},
           {"solver", Objective::kSolver}}),
      row(
          of("relaxation", "phi of the paper's weighted Laplacian", kPaper).takes("PHI").above(0).to(1),
          [](auto& o) -> auto& { return o.improve.relaxation; }),
      row(
          of("sweeps", "Sweeps of the paper's weighted Laplacian", kPaper).takes("N").from(0),
          [](auto& o) -> auto& { return o.improve.sweeps; }),
      opposite(
          of("fix_boundary",
             "No vertex of the boundary slides on the surface, no edge turns; adapt: its triangles stay as they "
             "are",
             "Improvement", "mesh improve adapt")
              .called("move_boundary"),
          [](auto& o) -> auto& { return o.improve.move_boundary; }),
      row(
          of("improve_time", "Seconds after which no further pass begins (then not repeatable)")
              .called("seconds")
              .takes("S")
              .from(0),
          [](auto& o) -> auto& { return o.improve.seconds; }),
      row(
          [&] {
            About order =
                of("order",
                   "2, 3, 4: elements of this order, with nodes on their edges, faces and inside; those of the "
                   "boundary on the smooth surface that the input stands for, every element proven valid; "
                   "1: linear ones",
                   "Elements");
            order.choices = {"1", "2", "3", "4"};
            return order.common("2: elements of second order, curved to the surface");
          }(),
          [](auto& o) -> auto& { return o.order; }),
      row(
          of("split",
             "Open the mesh along these patches inside, sheets or walls between regions, with commas between: nodes "
             "are doubled, the sides are the patches NAME_plus and NAME_minus",
             "Elements", "mesh")
              .takes("PLACES"),
          [](auto& o) -> auto& { return o.split; }),
  };
}

std::vector<Row<Options>> adapt_rows() {
  const auto of = [](std::string_view name, std::string_view help) { return About(name, "Adaptation", "adapt", help); };
  return {
      row(
          About("no_bridging", "Improvement", "mesh improve adapt",
                "Elements with all corners on walls (boundary, walls between regions) get a vertex inside"),
          [](auto& o) -> auto& { return o.improve.no_bridging; }),
      row(
          of("only",
             "Places that may change, with semicolons between: box:X0,Y0,Z0,X1,Y1,Z1, sphere:X,Y,Z,R, or regions, "
             "patches, curves and sets; all else keeps its bits and numbers")
              .takes("PLACE"),
          [](auto& o) -> auto& { return o.adapt.only; }),
      row(
          of("halo", "Layers of elements around the places of `only` that may change, too").takes("N").from(0).to(100),
          [](auto& o) -> auto& { return o.adapt.halo; }),
      row(
          of("keep",
             "Faces, edges and vertices that stay as they are: places with semicolons between; of regions the walls "
             "around them")
              .takes("PLACE"),
          [](auto& o) -> auto& { return o.adapt.keep; }),
      row(
          of("least_piece",
             "Pieces of regions that a level set cuts off go to what is around if their volume is smaller, in cubed "
             "units of the input")
              .takes("V")
              .from(0),
          [](auto& o) -> auto& { return o.adapt.least_piece; }),
  };
}

std::vector<Row<Options>> carry_rows() {
  const auto of = [](std::string_view name, std::string_view help) {
    return About(name, "Fields", "improve adapt carry move", help);
  };
  return {
      row(
          of("linear_elements",
             "Fields of elements vary linearly inside old elements, limited such that no new extremes come: of second "
             "order where they are smooth"),
          [](auto& o) -> auto& { return o.carry.linear_elements; }),
      opposite(
          of("free_integrals",
             "Where the bodies differ, nothing is spread: fields of elements keep their values, and integrals change "
             "with the volume (a modulus, a temperature)")
              .called("keep_integrals"),
          [](auto& o) -> auto& { return o.carry.keep_integrals; }),
      row(
          of("quadratic_nodes",
             "Fields at nodes vary quadratically inside old elements: by mid-side nodes, or second derivatives fitted "
             "to what is around"),
          [](auto& o) -> auto& { return o.carry.quadratic_nodes; }),
      row(
          of("integration_points",
             "Fields of elements, names with commas between, that have values at the four integration points of "
             "quadratic tetrahedra, point by point")
              .takes("FIELD"),
          [](auto& o) -> auto& { return o.carry.integration_points; }),
  };
}

std::vector<Row<Options>> move_rows() {
  const auto of = [](std::string_view name, std::string_view help) { return About(name, "Motion", "move", help); };
  return {
      row(
          of("least_quality", "Quality (3 r / R) below which elements are mended between steps")
              .takes("BETA")
              .above(0)
              .to(0.6),
          [](auto& o) -> auto& { return o.move.least_quality; }),
      row(
          of("boundary_alone", "Only the displacements of the boundary count; those inside follow them, harmonic"),
          [](auto& o) -> auto& { return o.move.boundary_alone; }),
      row(
          of("remesh",
             "Where elements are poor, the moved walls are meshed anew, at the lengths that edges had, instead of the "
             "mesh being adapted"),
          [](auto& o) -> auto& { return o.move.remesh; }),
  };
}

std::vector<Row<Options>> require_rows() {
  const auto of = [](std::string_view name, std::string_view help, std::string_view tasks) {
    return About(name, "Requirements", tasks, help);
  };
  return {
      row(
          of("require_volume",
             "Percent by which the volume of each region may differ from the input's, or the run fails",
             "mesh improve adapt")
              .takes("P")
              .from(0),
          [](auto& o) -> auto& { return o.require.volume; }),
      // No tetrahedron has all its angles above 70.53.
      row(
          of("require_angle", "Degrees that each dihedral angle has at least, or the run fails", "mesh improve adapt")
              .takes("DEG")
              .above(0)
              .to(70),
          [](auto& o) -> auto& { return o.require.angle; }),
      row(
          of("require_size", "Times the size wanted there that no edge is longer than, or the run fails", "mesh adapt")
              .takes("F")
              .from(1),
          [](auto& o) -> auto& { return o.require.size; }),
  };
}

const std::vector<Row<Options>>& rows() {
  static const auto all = all_of<Options>({size_rows(), surface_rows(), layer_rows(), volume_rows(), improve_rows(),
                                           adapt_rows(), carry_rows(), move_rows(), require_rows()});
  return all;
}

}  // namespace

}  // namespace octafront::options

namespace octafront {

const std::vector<OptionInfo>& option_table() {
  static const std::vector<OptionInfo> table = options::infos_of(options::rows());
  return table;
}

OptionValue option_value(const Options& options, std::string_view name) {
  return options::row_named(options::rows(), name).get(options);
}

void set_option(Options& options, std::string_view name, const OptionValue& value) {
  options::row_named(options::rows(), name).set(options, value);
}

void check_ranges(const Options& options) {
  options::check_rows(options::rows(), options);
}

}  // namespace octafront
