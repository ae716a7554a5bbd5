#pragma once

// What steers a run. Every struct is usable as it is: the defaults mesh any clean surface at an automatic size.
//
// "The paper", here and elsewhere, is "3D Mesh Generation Based on Improved Advancing Front Method", from which the
// octree background grid (its section III.A), the surface front (III.B), the volume front with its queues Qc, Qn and Qh
// (IV) and the weighted Laplacian (V) come.

#include <octafront/ids.h>
#include <octafront/size_field.h>
#include <octafront/vec.h>

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace octafront {

/// A place with a size of its own: the points within `radius` of a box, which may be a point. The size holds there and
/// grows at the gradation away from it. A sphere is a point with a radius.
struct SizeRegion {
  Vec3 lo, hi;        ///< opposite corners of the box, input units, lo <= hi
  double radius = 0;  ///< >= 0
  double size = 0;    ///< > 0
};

/// A size at a place; input units.
struct PointSize {
  Vec3 p;
  double size = 0;  ///< > 0
};

/// A size for a region (its boundary and its inside), a patch or a curve, by its name.
struct NamedSize {
  std::string name;
  double size = 0;  ///< > 0, input units
  /// > 0: of a region this part of its thickness, from `size` to `most`: how far it is from a place of its boundary
  /// through the region, along the normal, to the wall that faces it. 0: `size` everywhere.
  double of_thickness = 0;
  double most = 0;  ///< >= size; inside of the region sizes rise no higher
};

/// A size near a place. Within the place it is `size`; at a distance s from it size / (1 - s / distance), which rises
/// from there to no wish at all at `distance`. At half the distance it is twice the size, at nine tenths ten times. The
/// gradation holds as everywhere.
struct NearSize {
  std::string name;  ///< of a region (all of its inside is within it), a patch or a curve; empty: `point` is the place
  Vec3 point = {};   ///< input units
  double size = 0;   ///< > 0, input units
  double distance = 0;  ///< > 0, input units
};

/// Sizes on a mesh: of tetrahedra, or of triangles in space. Linear in the element that holds a place where they are
/// given at points; elsewhere those of the nearest point of the mesh.
struct SizeMesh {
  std::vector<Vec3> points;                      ///< input units
  std::vector<std::array<VertexIndex, 4>> tets;  ///< indices into `points`
  std::vector<Triangle> triangles;               ///< counted only where there are no tetrahedra
  std::vector<double> point_sizes;               ///< > 0, one per point; or empty
  std::vector<double> element_sizes;  ///< > 0, one per tetrahedron, else per triangle; asked where point_sizes is empty
  std::string name;                   ///< for messages: the file and its field
};

/// How fast sizes change where nobody says otherwise, and at most where their spread decides.
inline constexpr double kDefaultGradation = 0.12, kSteepestGradation = 0.4;

/// Where element sizes come from. Every source is optional; the smallest size wins. With none the size is automatic
/// (make_size_field); `size`, `point_sizes`, `mesh` and `callback` switch that off: they decide alone, up to limits,
/// gradation.
struct SizeOptions {
  std::optional<double> size;            ///< uniform edge length, input units, > 0
  std::optional<std::int64_t> elements;  ///< target number of tetrahedra, > 0; the sizes are scaled to meet it
  std::optional<double> curvature;       ///< elements per full turn of a curved surface, >= 3
  std::optional<double> gap;             ///< elements across thin walls and narrow gaps, > 0
  std::optional<double> through;         ///< elements across thin walls alone, whatever the gaps between them, > 0
  std::optional<double>
      feature_elements;  ///< elements along each feature curve at least (closed curves: twice that), > 0
  /// Sizes by which triangles stay within this distance of a curved surface; input units, > 0. generate() sets it from
  /// SurfaceOptions::max_deviation, so that the prediction of elements knows of it.
  std::optional<double> chord_error;
  bool facets = false;             ///< the paper's rule (III.A): grid leaves follow the areas of the input's facets
  std::optional<double> min_size;  ///< no size falls below this, input units
  std::optional<double> max_size;  ///< no size rises above this, input units
  /// The automatic sizes times this: 0.5 makes about eight times as many elements. Has no say where another source
  /// chooses the sizes. In [0.1, 10].
  double automatic_factor = 1;
  /// |h(x) - h(y)| <= gradation |x - y|; in [0.01, 1]. Without a value it follows from how sizes are spread: the least
  /// from kDefaultGradation to kSteepestGradation (second order: 0.8) that leaves at most 30 % of the elements where
  /// sizes only rise. Of kept surfaces, and of first order with `elements`, it is kDefaultGradation.
  std::optional<double> gradation;
  enum class Interior { kUniform, kGraded };
  /// kUniform: sizes inside stay at most the largest size on the surface (the paper's Cmax).
  /// kGraded: sizes grow inward at the gradation, up to max_size.
  Interior interior = Interior::kUniform;
  /// Further sources, on top of the others or of the automatic choice. --elements does not scale them.
  std::vector<SizeRegion> regions;
  /// Sizes given at the vertices of the surface, linear on its triangles. Where some vertex has no point of its own,
  /// the nearest point speaks for each place. A source like the others: the smallest wins, gradation holds.
  std::vector<PointSize> point_sizes;
  std::vector<NamedSize> named;  ///< sizes of regions, patches and curves by their names
  std::vector<NearSize> near;    ///< sizes near regions, patches, curves and points
  /// Sizes on a mesh, on the surface and inside of it, as read_size_mesh() returns them. May be null.
  std::shared_ptr<const SizeMesh> mesh;
  /// All sizes, as read_size_field() returns them: no other source may be given with it, nor limits.
  std::optional<SizeField> field;
  /// A source on the whole surface, asked at many points at once: fills in a size > 0 for each. May be empty.
  std::function<void(std::span<const Vec3> points, std::span<double> sizes)> callback;
};

/// Degrees from which an edge is a feature, where nothing else is said.
inline constexpr double kDefaultFeatureAngle = 40;

/// How the surface is triangulated anew.
struct SurfaceOptions {
  bool keep = false;  ///< the input triangles become the boundary, exactly
  /// Degrees between face normals from which an edge is kept as a feature; (0, 180). Without a value
  /// kDefaultFeatureAngle, of images 85.
  std::optional<double> feature_angle;
  double angle_of_features() const { return feature_angle.value_or(kDefaultFeatureAngle); }
  /// How far the new surface may stray from the input (input units, >= 0): where it strays farther, sizes are made
  /// smaller, for a few rounds. Folds, spikes and lines too near to each other for an element are smoothed over within
  /// this distance. 0: no such detail is touched, and the sizes alone decide. Without a value automatic sizes may stray
  /// by .4 % of the diagonal. Other sizes then have no bound, and details give way: folds by a tenth of the size (at
  /// most .4 % of the diagonal), lines by a quarter of the size.
  std::optional<double> max_deviation;
  /// What `max_deviation`, strips and corners of complexes ask for is no smaller than this, but at regions that would
  /// be lost among such elements; input units. 0: they ask for what they need. generate() sets it for images.
  double finest = 0;
  /// By how many degrees new triangles may turn against the input's surface at their corners and centroid: where they
  /// turn farther, sizes are made smaller, too; (0, 90].
  std::optional<double> normal_deviation;
  enum class Strips { kOff, kFine };
  /// kFine: where two feature edges run side by side nearer than an element, sizes are smaller, down to .3 of what they
  /// are (.1 of a complex), for triangles between them have a good shape only then; of SizeOptions::size not where they
  /// are narrower than a third of it. kOff: they are as they come.
  Strips strips = Strips::kFine;
  /// Each part of the surface that feature edges enclose becomes a patch of its own; parts of a named patch keep its
  /// name, with a number behind it where there are several.
  bool patches_by_features = false;
  /// Bodies and regions of a complex get the volumes that they have in the input: vertices inside patches move off the
  /// surface by what chords cut off, at most a fifth of an edge; what they do not get is said by region.
  bool keep_volumes = false;
  /// Percent by which chords may change the volume of each region, of second order curved edges: where one is off by
  /// more, elements are made smaller, for a few rounds. > 0. Without a value volumes are what the sizes make them.
  std::optional<double> volume_tolerance;
};

/// Boundary layers: thin elements along walls, which grow from them.
struct LayersOptions {
  int count = 0;  ///< layers; 0: none
  /// Height of the first layer, at the wall: input units, or a part of the local edge length; one of the two, `yplus`,
  /// or `total` alone.
  std::optional<double> first, first_part;
  std::optional<double> growth;  ///< each layer over the one below, in [1, 3]; without a value 1.2, or what `first` and
                                 ///< `total` make it
  std::optional<double> total;   ///< height of all layers, input units
  /// The first height by the wall distance y+ that it shall have in a turbulent flow along a flat plate, whose Reynolds
  /// number belongs to a length: skin friction of .026 Re^(-1/7) (F. White, Fluid Mechanics).
  std::optional<double> yplus, reynolds, reference_length;
  /// Or by a speed, m/s, of a fluid, viscosity_of(), and `reference_length`; without that the body's in a wind tunnel,
  /// else the input's longest side. Coordinates count Domain::unit, metres where that is not known.
  std::optional<double> speed;
  std::string fluid = "air";
  std::string on;  ///< names of the patches that are walls, separated by commas; empty: all patches
  std::string in;  ///< names of the regions that they grow in, separated by commas; empty: all regions
  /// They grow on the outside instead, where they make a shell around the mesh: a region of its own.
  bool outside = false;
  /// Layers are tetrahedra in every file, also where a format has wedges and pyramids (TetMesh::wide_cells).
  bool as_tets = false;
  /// Percent of the faces of each wall that must have all layers, as high as asked; MeshingError otherwise.
  std::optional<double> require_coverage;
};

/// Kinematic viscosity, m2/s, of "air" (1.5e-5) or "water" (1e-6) at 20 degrees, or the number that the text is. Throws
/// OptionError.
double viscosity_of(const std::string& fluid);

/// How the volume is filled.
struct VolumeOptions {
  /// Distance of the ideal point from the face, as a multiple of the size there (the paper says 1; a regular
  /// tetrahedron wants 0.816; a little less leaves better elements, see docs/how/volume-front.md). In [0.3, 1.5].
  double ideal_distance = 0.75;
  enum class Core { kOff, kLattice };
  /// kLattice: deep inside, the graded body-centred cubic lattice is the mesh, and the front fills the shell around it.
  Core core = Core::kLattice;
  enum class Ranking { kQuality, kSolidAngle };
  /// Order of the candidates: by the solid angle at the apex, as in the paper, or by beta of the new tetrahedron.
  Ranking ranking = Ranking::kSolidAngle;
  enum class Order { kLayers, kSmallest, kNewest };
  /// Order of the queue in a block: layer by layer as the faces come; each layer's smallest faces first; or always the
  /// newest face.
  Order order = Order::kLayers;
  /// Walls that are thinner than so many elements are wide have so many layers of flat elements through them: 2 and
  /// more; 0: as many as sizes make.
  std::uint32_t shell = 0;
};

/// How the mesh is improved after it is complete.
struct ImproveOptions {
  enum class Level { kOff, kPaper, kFast, kDefault, kBest };
  Level level = Level::kDefault;
  /// What an element is worth, to the passes that mend the worst ones. Whatever it is, no pass lowers the worst beta or
  /// smallest, or raises the largest dihedral angle of the mesh; and passes for the mean serve beta.
  enum class Objective {
    kBalanced,     ///< beta and both dihedral angles
    kBeta,         ///< 3 r / R
    kMinDihedral,  ///< the smallest dihedral angle
    kMaxDihedral,  ///< the largest dihedral angle
    kMeanRatio,    ///< 12 (3 V)^(2/3) / (sum of squared edges)
    kSolver,       ///< what the element checks of Abaqus, Ansys and CalculiX look at: docs/how/improve.md
  };
  Objective objective = Objective::kBalanced;
  double relaxation = 0.7;  ///< phi of the paper's weighted Laplacian, (0, 1]
  int sweeps = 4;           ///< sweeps of the Laplacian, >= 0
  /// Vertices of the boundary may slide along the input surface, and edges inside its patches turn. Off wherever the
  /// surface is kept. adapt_existing(): off, the triangles of the outer boundary stay as they are.
  bool move_boundary = true;
  /// Elements with all four corners on walls (boundary, interfaces) get a vertex inside at the end, for a problem with
  /// its values given there would know nothing of them. generate(), adapt_existing(), adapt_to_metric().
  bool no_bridging = false;
  /// Wall time, >= 0: the pass that is under way when it is over is finished, the rest left out. A run that it cuts
  /// short is valid, but no longer the same on every machine; the report says so. Without a value the schedule runs to
  /// its end.
  std::optional<double> seconds;
  /// What is looked at now and then; see after_pass.
  struct Worst {
    double beta = 0, dihedral_min = 0, dihedral_max = 0;  ///< degrees; over all elements, from their coordinates
    bool positive = false;                                ///< every element, by exact sign
  };
  /// Called at the start, and each time when passes have been over all pieces of the mesh (pieces), or over the places
  /// around elements that are still poor (places), with that name; costs about a microsecond per element each time.
  std::function<void(const std::string& pass, const Worst&)> after_pass;
};

/// How the volume gets its tetrahedra.
enum class Method {
  kOctreeAft,  ///< the volume front, localised by the octree, around a lattice core
  kAft,        ///< the classical front: sizes from the surface alone, no octree, no lattice; for comparison
  kOctree,   ///< isosurface stuffing of the octree's lattice: fast, also on surfaces with defects; the boundary is its
             ///< own
  kRecover,  ///< the input's triangles kept and filled with as few inner points as possible: coarse, exact, of no size
};

/// How a mesh that is there is changed (octafront/adapt.h).
struct AdaptOptions {
  /// The places that may change, with semicolons between: "box:X0,Y0,Z0,X1,Y1,Z1", "sphere:X,Y,Z,R" (elements whose own
  /// boxes reach into it), or a name: of a region or set of elements, or of a patch, curve or other set, which stands
  /// for the elements that touch it. Empty: all may change.
  std::string only;
  int halo = 2;  ///< layers of elements around these places that may change, too; 0 to 100
  /// What stays as it is, with semicolons between: names of patches, curves and sets of nodes, edges and
  /// faces; of a region or a set of elements the walls around it; a patch also by its number, from 1. Vertices keep
  /// their places; of sets RequiredVertices, RequiredEdges, RequiredTriangles, RequiredTetrahedra and Corners, as MEDIT
  /// has them, in any case. Lengths grow from what stays.
  std::string keep;
  /// Of a mesh that is cut along level sets (octafront/level_set.h): LevelSetOptions::least_piece; >= 0.
  double least_piece = 0;
};

/// How fields go from one mesh to another (octafront/carry.h).
struct CarryOptions {
  /// Values of elements vary linearly inside the old elements, by least squares of what is around, limited such that no
  /// new extremes come: of second order where they are smooth. Else they are constant there: of first order.
  bool linear_elements = false;
  /// Where the bodies differ, what the integral over a region lacks is spread over it. Else values stay the means over
  /// what is shared, and the integral changes with the volume: for what is no density, such as a modulus.
  bool keep_integrals = true;
  /// Fields at nodes vary quadratically inside the old elements: by the values at mid-side nodes of a mesh of second
  /// order, else by second derivatives fitted to what is around. No value leaves the range of the field.
  bool quadratic_nodes = false;
  /// Fields of elements, by name, with commas between, that have values at the four integration points of
  /// quadratic tetrahedra (barycentric coordinates .585, .138, .138, .138; point i is the one near corner i): all
  /// components of the first point, then those of the second, ...
  std::string integration_points = {};
};

/// How a mesh is moved (octafront/move.h).
struct MoveOptions {
  double least_quality = 0.2;  ///< beta (3 r / R) below which elements are mended between steps, in (0, 0.6]
  /// Only the displacements of the boundary count; those inside follow them, harmonic.
  bool boundary_alone = false;
  /// Where elements are poor, the walls of the mesh as they have moved become the input of generate(), at the lengths
  /// that edges had, instead of the mesh being adapted.
  bool remesh = false;
};

/// What a mesh must keep: one that does not is not handed out, RequirementError says what it is like. Looked at last,
/// on all elements that there are.
struct RequireOptions {
  /// Percent by which the volume of each region may differ from what it is in the input, >= 0: relative to the region
  /// itself; of a CAD solid its true volume; of curved elements as they are curved.
  std::optional<double> volume;
  std::optional<double> angle;  ///< degrees that each dihedral angle of each element has at least, in (0, 70]
  /// Times the size wanted at its middle that each edge may be long, >= 1.
  std::optional<double> size;
};

/// Everything that steers generate().
struct Options {
  Method method = Method::kOctreeAft;  ///< kRecover implies surface.keep
  SizeOptions size;
  SurfaceOptions surface;
  LayersOptions layers;
  VolumeOptions volume;
  ImproveOptions improve;
  AdaptOptions adapt;
  CarryOptions carry;
  MoveOptions move;
  RequireOptions require;
  /// Names of patches inside (sheets, walls between regions), separated by commas, along which the mesh is opened:
  /// split_patches() of octafront/split.h.
  std::string split;
  /// Sets that the mesh gets: NAME=PLACE each, as group_rule() of octafront/named_groups.h reads them. Of CAD a place
  /// may also say what it is like, "holes=cylinders of radius 3": faces, edges or nodes (docs/use/places.md).
  std::vector<std::string> groups;
  /// Axes along which the body is one cell of a periodic one, of "x", "y" and "z": "xyz", "z", ...; empty: none. The
  /// faces of its bounding box at both ends of such an axis are the same triangles, bit for bit, and
  /// TetMesh::periodic_nodes pairs their nodes. What lies on opposite faces must be the same; where only triangles
  /// differ, both faces get new ones.
  ///
  /// Or maps, with semicolons between: "1,0,0" (a translation), "30@z" or "360/7@PX,PY,PZ,DX,DY,DZ" (a rotation by
  /// degrees about an axis of space, or about that through a point along a direction; it goes with no other map). Each
  /// leads part of the surface to another part that looks the other way; with "LOW:HIGH=" before it the patch LOW to
  /// the patch HIGH, which may be curved and triangulated in another way inside.
  std::string periodic;
  /// 1: linear elements. 2: elements of second order, curved to the surface that the input stands for; see
  /// make_second_order(). Straight where the input's triangles are kept.
  int order = 1;
};

}  // namespace octafront
