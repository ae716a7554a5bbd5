#include "pipeline/options/rows.h"

namespace octafront {

namespace {

using namespace options;

template <class Access>
Row<Options> row(const OptionInfo& info, Access field) {
  return row_of_field<Options>(info, field);
}

template <class Value, class Access>
Row<Options> choice(const OptionInfo& info, Access field, const Names<Value>& names) {
  return row_of_choice<Options, Value>(info, field, names);
}

/// A flag whose name says the opposite of its field.
template <class Access>
Row<Options> opposite(OptionInfo info, Access field) {
  info.kind = Kind::kFlag;
  return {info, [field](const Options& o) -> OptionValue { return !field(o); },
          [field, name = info.name](Options& o, const OptionValue& v) { field(o) = !flag_of(name, v); }};
}

OptionInfo about(std::string_view name, std::string_view field, std::string_view group, std::string_view tasks,
                 std::string_view help) {
  return {name, field, group, tasks, Kind::kNumber, {}, help};
}

std::vector<Row<Options>> size_rows() {
  const auto of = [](std::string_view name, std::string_view help) {
    return about(name, name, "Sizes", "mesh surface size adapt", help);
  };
  using Interior = SizeOptions::Interior;
  return {
      row(
          of("size", "Edge length, in units of the input"), [](auto& o) -> auto& { return o.size.size; }),
      row(
          of("elements", "Number of tetrahedra wanted, met within 15 %"),
          [](auto& o) -> auto& { return o.size.elements; }),
      row(
          of("curvature", "Elements per full turn of a curved surface, 3 at least"),
          [](auto& o) -> auto& { return o.size.curvature; }),
      row(
          of("gap", "Elements across thin walls and narrow gaps"), [](auto& o) -> auto& { return o.size.gap; }),
      row(
          of("through", "Elements across thin walls at least, whatever the gaps between them"),
          [](auto& o) -> auto& { return o.size.through; }),
      row(
          of("feature_elements", "Elements along each feature curve at least"),
          [](auto& o) -> auto& { return o.size.feature_elements; }),
      row(
          of("chord_error", "Sizes by which triangles stay this near to a curved surface, in units of the input"),
          [](auto& o) -> auto& { return o.size.chord_error; }),
      row(
          of("facets", "Sizes follow the areas of the input's facets (the paper's rule)"),
          [](auto& o) -> auto& { return o.size.facets; }),
      row(
          of("min_size", "No size falls below this, in units of the input"),
          [](auto& o) -> auto& { return o.size.min_size; }),
      row(
          of("max_size", "No size rises above this, in units of the input"),
          [](auto& o) -> auto& { return o.size.max_size; }),
      row(
          of("automatic_factor", "Automatic sizes times this: .5 makes about eight times as many elements; .1 to 10"),
          [](auto& o) -> auto& { return o.size.automatic_factor; }),
      row(
          of("gradation", "How fast sizes may change: |h(x) - h(y)| <= gradation |x - y|; .01 to 1"),
          [](auto& o) -> auto& { return o.size.gradation; }),
      choice<Interior>(of("interior", "Inside no larger than on the surface, or growing inward"),
                       [](auto& o) -> auto& { return o.size.interior; },
                       {{"uniform", Interior::kUniform}, {"graded", Interior::kGraded}}),
  };
}

std::vector<Row<Options>> surface_rows() {
  const auto of = [](std::string_view name, std::string_view help, std::string_view field = {},
                     std::string_view tasks = "mesh surface size") {
    return about(name, field.empty() ? name : field, "Surface", tasks, help);
  };
  using Strips = SurfaceOptions::Strips;
  return {
      row(
          of("keep_surface", "The input triangles become the boundary, exactly", "keep"),
          [](auto& o) -> auto& { return o.surface.keep; }),
      row(
          of("feature_angle", "Edges that bend by more degrees than this are kept; without a value 40, of images 85",
             {}, "mesh surface size improve adapt"),
          [](auto& o) -> auto& { return o.surface.feature_angle; }),
      row(
          of("max_deviation",
             "Smaller elements where the surface would stray farther from the input, in units of the input, and how "
             "far folds and needles of it give way; 0: not at all; without a value .4 % of the diagonal with automatic "
             "sizes, else none; in adaptation how far it may stray from the smooth surface",
             {}, "mesh surface size adapt"),
          [](auto& o) -> auto& { return o.surface.max_deviation; }),
      row(
          of("normal_deviation",
             "Smaller elements where triangles would turn by more degrees against the input; at most 90"),
          [](auto& o) -> auto& { return o.surface.normal_deviation; }),
      choice<Strips>(
          of("strips",
             "fine: smaller elements where two feature edges run side by side nearer than an element; off: flat ones"),
          [](auto& o) -> auto& { return o.surface.strips; }, {{"fine", Strips::kFine}, {"off", Strips::kOff}}),
      row(
          of("patches", "Each part of the surface that feature edges enclose becomes a patch", "patches_by_features"),
          [](auto& o) -> auto& { return o.surface.patches_by_features; }),
      row(
          of("keep_volumes", "Bodies and regions keep the volumes that they have in the input; images do so unasked",
             {}, "mesh surface"),
          [](auto& o) -> auto& { return o.surface.keep_volumes; }),
      row(
          of("volume_tolerance",
             "Smaller elements where chords would change the volume of a region by more percent; without a value "
             "volumes are what the sizes make them",
             {}, "mesh"),
          [](auto& o) -> auto& { return o.surface.volume_tolerance; }),
      row(
          of("periodic",
             "Axes along which the body is one cell of a periodic one, such as x or xyz: opposite faces of its "
             "bounding box get the same triangles, and their nodes are paired. Or what leads from a face to its copy: "
             "X,Y,Z (a translation), DEGREES@z or DEGREES@PX,PY,PZ,DX,DY,DZ (a rotation about an axis), several with "
             "semicolons between, each with LOW:HIGH= before it where names of patches are to say what it leads to "
             "what"),
          [](auto& o) -> auto& { return o.periodic; }),
  };
}

std::vector<Row<Options>> layer_rows() {
  const auto of = [](std::string_view name, std::string_view help, std::string_view field = {}) {
    return about(name, field.empty() ? name : field, "Boundary layers", "mesh", help);
  };
  return {
      row(
          of("layers", "Layers of thin elements along walls; 0: none", "count"),
          [](auto& o) -> auto& { return o.layers.count; }),
      row(
          of("first", "Height of the first layer, at the wall, in units of the input"),
          [](auto& o) -> auto& { return o.layers.first; }),
      row(
          of("first_part", "Height of the first layer as a part of the edge length there"),
          [](auto& o) -> auto& { return o.layers.first_part; }),
      row(
          of("growth", "Each layer over the one below, 1 to 3; without a value 1.2, or what `first` and `total` need"),
          [](auto& o) -> auto& { return o.layers.growth; }),
      row(
          of("total", "Height of all layers, in units of the input"), [](auto& o) -> auto& { return o.layers.total; }),
      row(
          of("yplus", "Height of the first layer by its y+ in a flow along a flat plate, with `Re` and `Lref`"),
          [](auto& o) -> auto& { return o.layers.yplus; }),
      row(
          of("Re", "Reynolds number of the flow, for `yplus`", "reynolds"),
          [](auto& o) -> auto& { return o.layers.reynolds; }),
      row(
          of("Lref", "Length that the Reynolds number belongs to, in units of the input", "reference_length"),
          [](auto& o) -> auto& { return o.layers.reference_length; }),
      row(
          of("on", "Names of the patches that are walls, separated by commas; without them all are"),
          [](auto& o) -> auto& { return o.layers.on; }),
      row(
          of("layers_in", "Names of the regions that they grow in, separated by commas; without them all do", "in"),
          [](auto& o) -> auto& { return o.layers.in; }),
      row(
          of("layers_outside", "Layers grow on the outside, as a shell around the mesh and a region of its own",
             "outside"),
          [](auto& o) -> auto& { return o.layers.outside; }),
      row(
          of("layers_as_tets", "Layers are tetrahedra also in formats that have wedges", "as_tets"),
          [](auto& o) -> auto& { return o.layers.as_tets; }),
      row(
          of("require_coverage", "Percent of each wall's faces that must have all layers, or the run fails"),
          [](auto& o) -> auto& { return o.layers.require_coverage; }),
  };
}

std::vector<Row<Options>> volume_rows() {
  const auto of = [](std::string_view name, std::string_view help) {
    return about(name, name, "Volume", "mesh", help);
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
          of("ideal_distance", "Ideal point above its face, as a multiple of the size there; .3 to 1.5"),
          [](auto& o) -> auto& { return o.volume.ideal_distance; }),
      choice<Core>(
          of("core", "lattice: the inside is a lattice, the front fills the shell around it; none: all by the front"),
          [](auto& o) -> auto& { return o.volume.core; }, {{"lattice", Core::kLattice}, {"none", Core::kOff}}),
      choice<Ranking>(of("ranking", "Order of candidates"), [](auto& o) -> auto& { return o.volume.ranking; },
                      {{"solid-angle", Ranking::kSolidAngle}, {"quality", Ranking::kQuality}}),
      choice<Order>(
          of("queue",
             "Order of the front's faces: layer by layer, the smallest of each layer first, or the newest first"),
          [](auto& o) -> auto& { return o.volume.order; },
          {{"layers", Order::kLayers}, {"smallest", Order::kSmallest}, {"newest", Order::kNewest}}),
      row(
          of("shell", "Layers of flat elements through walls that are thinner than elements are wide; 0: as they come"),
          [](auto& o) -> auto& { return o.volume.shell; }),
  };
}

std::vector<Row<Options>> improve_rows() {
  const auto of = [](std::string_view name, std::string_view help, std::string_view field = {}) {
    return about(name, field.empty() ? name : field, "Improvement", "mesh improve", help);
  };
  using Level = ImproveOptions::Level;
  using Objective = ImproveOptions::Objective;
  return {
      choice<Level>(of("improve", "How the finished mesh is improved", "level"),
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
          of("relaxation", "phi of the paper's weighted Laplacian, above 0 and at most 1"),
          [](auto& o) -> auto& { return o.improve.relaxation; }),
      row(
          of("sweeps", "Sweeps of the paper's weighted Laplacian"), [](auto& o) -> auto& { return o.improve.sweeps; }),
      opposite(
          about(
              "fix_boundary", "move_boundary", "Improvement", "mesh improve adapt",
              "No vertex of the boundary slides on the surface, no edge turns; adapt: its triangles stay as they are"),
          [](auto& o) -> auto& { return o.improve.move_boundary; }),
      row(
          of("improve_time", "Seconds after which no further pass begins (then not repeatable)", "seconds"),
          [](auto& o) -> auto& { return o.improve.seconds; }),
      row(
          about("order", "order", "Elements", "mesh improve",
                "2: elements of second order, with mid-side nodes; those of the boundary on the smooth surface that "
                "the input stands for, every element proven valid; 1: linear ones"),
          [](auto& o) -> auto& { return o.order; }),
      row(
          about(
              "split", "split", "Elements", "mesh",
              "Names of patches inside, sheets or walls between regions, separated by commas, along which the mesh is "
              "opened: nodes are doubled, the sides are the patches NAME_plus and NAME_minus"),
          [](auto& o) -> auto& { return o.split; }),
  };
}

std::vector<Row<Options>> require_rows() {
  const auto of = [](std::string_view name, std::string_view help, std::string_view tasks) {
    return about(name, name, "Requirements", tasks, help);
  };
  return {
      row(
          of("require_volume",
             "Percent by which the volume of each region may differ from the input's, or the run fails",
             "mesh improve adapt"),
          [](auto& o) -> auto& { return o.require.volume; }),
      row(
          of("require_angle", "Degrees that each dihedral angle has at least, or the run fails", "mesh improve adapt"),
          [](auto& o) -> auto& { return o.require.angle; }),
      row(
          of("require_size", "Times the size wanted there that no edge is longer than, or the run fails; 1 or more",
             "mesh adapt"),
          [](auto& o) -> auto& { return o.require.size; }),
  };
}

std::vector<Row<Options>> adapt_rows() {
  const auto of = [](std::string_view name, std::string_view help) {
    return about(name, name, "Adaptation", "adapt", help);
  };
  return {
      row(
          about("no_bridging", "no_bridging", "Improvement", "mesh improve adapt",
                "Elements with all corners on walls (boundary, walls between regions) get a vertex inside"),
          [](auto& o) -> auto& { return o.improve.no_bridging; }),
      row(
          of("only",
             "Places that may change, with semicolons between: box:X0,Y0,Z0,X1,Y1,Z1, sphere:X,Y,Z,R, or names of "
             "regions, patches, curves and sets; all else keeps its bits and numbers"),
          [](auto& o) -> auto& { return o.adapt.only; }),
      row(
          of("halo", "Layers of elements around the places of `only` that may change, too"),
          [](auto& o) -> auto& { return o.adapt.halo; }),
      row(
          of("keep",
             "Faces, edges and vertices that stay as they are, with semicolons between: names of patches, curves and "
             "sets, of a region the walls around it, or numbers of patches"),
          [](auto& o) -> auto& { return o.adapt.keep; }),
  };
}

const std::vector<Row<Options>>& rows() {
  static const std::vector<Row<Options>> all = [] {
    std::vector<Row<Options>> list;
    for (const auto& part :
         {size_rows(), surface_rows(), layer_rows(), volume_rows(), improve_rows(), adapt_rows(), require_rows()})
      list.insert(list.end(), part.begin(), part.end());
    return list;
  }();
  return all;
}

}  // namespace

const std::vector<OptionInfo>& option_table() {
  static const std::vector<OptionInfo> table = infos_of(rows());
  return table;
}

OptionValue option_value(const Options& options, std::string_view name) {
  return row_named(rows(), name).get(options);
}

void set_option(Options& options, std::string_view name, const OptionValue& value) {
  row_named(rows(), name).set(options, value);
}

}  // namespace octafront
