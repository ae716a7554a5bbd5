#pragma once

#include <octafront/complex.h>
#include <octafront/metric.h>
#include <octafront/named_groups.h>
#include <octafront/options.h>
#include <octafront/run_context.h>
#include <octafront/size_field.h>
#include <octafront/solver_job.h>
#include <octafront/surface_mesh.h>
#include <octafront/tet_mesh.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace octafront {

// Files are named by strings; a std::filesystem::path turns into one by itself. All readers and writers can be
// cancelled by their context (then they throw Cancelled, and nothing is written); readers tell it how far they are, as
// the stage "reading".

/// A surface as a file has it: nothing merged, nothing repaired. Polygons are divided into triangles; surface.source
/// says from which face of the file (counted from 0) each one came.
struct SurfaceFile {
  SurfaceMesh surface;
  std::string format;                    ///< e.g. "binary STL"
  std::vector<std::string> notes;        ///< what a user should know, e.g. "12 polygons divided into triangles"
  std::vector<RegionSeed> regions = {};  ///< of TetGen's .poly and .smesh, for ComplexOptions
  std::vector<Vec3> voids = {};          ///< the same: its holes
  std::vector<PlacedSet> sets = {};      ///< of nodes, edges and faces
};

/// Reads STL (binary, ASCII), OBJ, OFF, PLY (ASCII, both binary byte orders), FreeSurfer's triangles (moved into the
/// scanner's coordinates), TetGen's .poly and .smesh, and meshes of any format that read_mesh_file() knows, recognised
/// by content; the name only breaks ties. A mesh of tetrahedra gives its boundary and its interfaces with their sides.
/// Coordinates keep double precision. OBJ groups and materials, and ASCII STL solids, become patches, so do facet
/// markers, physical groups and references. The properties "front" and "back" of the faces of a PLY file are
/// SurfaceMesh::sides (-1: outside), its comments "region 0 steel" their names. Throws InputError with file, line or
/// byte offset, and the reason. Memory is bounded by a small multiple of the size of the file, whatever its header
/// claims.
SurfaceFile read_surface(const std::string& file, const RunContext& context = {});

/// Lines and points of a file.
struct LinesFile {
  std::vector<Vec3> points;
  std::vector<Edge> edges;  ///< indices into points
  std::string format;
  std::vector<std::string> notes = {};
};

/// Reads the lines of OBJ (l), PLY (edges), of meshes of any format with line elements (VTK, VTU, MSH, MEDIT, ...), or
/// a text with a point "x y z" (or "x, y, z") in each line, where lines are polygons that end at an empty line. All
/// points of the file come along. Throws InputError with file, line or byte offset.
LinesFile read_lines(const std::string& file, const RunContext& context = {});

/// Whether a file of a format for meshes holds tetrahedra; false for what read_surface() alone reads. Throws
/// InputError.
bool holds_tetrahedra(const std::string& file, const RunContext& context = {});

/// Writes by the ending of the name: .stl (binary), .obj, .off, .ply (binary; alone holds SurfaceMesh::sides). The file
/// is written beside and renamed into place: on failure an older file stays whole. Throws OutputError, and OptionError
/// for unknown endings before any work.
void write_surface(const std::string& file, const SurfaceMesh& surface, const RunContext& context = {});

/// What divides a mesh into parts.
enum class Partitioner {
  kCurve,  ///< consecutive stretches of a Hilbert curve: the same everywhere, sizes that differ by one element at most
  kMetis   ///< METIS, where it was there when this was built: fewer faces between the parts
};

/// How a mesh is written.
/// What a set of elements is made of.
struct SetMaterial {
  std::string set;
  std::string quantity;  ///< "E": Young's modulus
  double value = 0;
};

struct WriteOptions {
  std::string format = {};  ///< its name in known_formats() ("abaqus", "msh22"); empty: the ending of the file tells
  bool ascii = false;       ///< as text; formats that are always text are so anyway
  bool cells_only = false;  ///< the tetrahedra alone, with their regions and sets, and sets of nodes: no faces and
                            ///< edges, which some programs refuse beside tetrahedra
  /// The dual: a polyhedron for each vertex (poly_mesh.h), of formats that hold them. Values at vertices are those of
  /// its cells.
  bool polyhedral = false;
  /// OpenFOAM: around CASE/constant/polyMesh the rest of a case for simpleFoam, which has none yet; needs `speed`.
  bool deck = false;
  std::optional<double> speed = {};  ///< of the flow at the inlet, m/s, for `deck`
  std::string fluid = "air";         ///< viscosity_of() of octafront/options.h, for `deck`
  std::string unit = {};             ///< what coordinates count, "mm": `deck` writes metres; empty: metres
  bool cohesive = false;   ///< elements of no height (COH3D6) between the two sides of faces that were split: Abaqus
  std::string beams = {};  ///< names of curves, separated by commas, that are beams, too (B31, B32): Abaqus
  std::vector<SetMaterial> materials = {};  ///< of sets of the mesh. Abaqus: of "E" *ELASTIC and *SOLID SECTION, else a
                                            ///< comment
  double poissons_ratio = 0.3;              ///< of these materials
  std::uint32_t parts = 0;  ///< so many parts, as programs on several processes want them: formats that hold them; each
                            ///< with one layer of elements around it where the format has that. 0: the mesh as one
  Partitioner partitioner = Partitioner::kCurve;
  std::optional<SolverJob> job = {};  ///< makes the file a job: formats that hold them
  bool split_files = false;           ///< MSH: NAME_1.msh and so on, one for each part, in the place of NAME.msh
};

/// Writes a mesh in the format that the ending of the name tells, or that is asked for. Regions, patches, curves and
/// sets become the format's own; formats of surfaces get the boundary. Returns what a user should know: what the format
/// cannot hold, and names that had to change. Streamed; written beside and renamed into place, formats of several files
/// and folders too. Throws OutputError, and OptionError for an unknown format or ending, or what the format cannot do,
/// before any work.
std::vector<std::string> write_mesh(const std::string& file, const TetMesh& mesh, const RunContext& context = {},
                                    const WriteOptions& options = {});

/// Writes the background grid of a size field as .vtu: hexahedra with the size at their corners and their level.
/// A field without a grid (uniform, from a function) has nothing to show: OutputError.
void write_size_field(const std::string& file, const SizeField& sizes, const RunContext& context = {});

/// Reads such a file, edited or not: sizes are cut where they break the gradation. For SizeOptions::field. Throws
/// InputError, and OptionError for a gradation out of range.
SizeField read_size_field(const std::string& file, double gradation = kSteepestGradation,
                          const RunContext& context = {});

/// Reads regions of refinement from a JSON file,
///   [{"box": [[0, 0, 0], [1, 2, 1]], "size": 0.1}, {"sphere": [5, 0, 0], "radius": 2, "size": 0.2},
///    {"point": [1, 1, 1], "size": 0.05}]
/// boxes by their least and largest corner, boxes and points with a "radius" if wanted; or from a table of points, a
/// line "x, y, z, size" each, separated by commas, semicolons or blanks, with or without a line of titles before. For
/// SizeOptions::regions. Throws InputError with the line or entry for whatever is not exactly that.
std::vector<SizeRegion> read_size_regions(const std::string& file, const RunContext& context = {});

/// Reads sizes at points from such a table, or from the points of a VTU or VTP file with the sizes in its PointData
/// ("size", or the only array there is). For SizeOptions::point_sizes. Throws InputError.
std::vector<PointSize> read_point_sizes(const std::string& file, const RunContext& context = {});

/// Reads a mesh of tetrahedra or triangles with a field of sizes, at its points or in its elements: the PointData and
/// CellData of VTU and legacy VTK, $NodeData and $ElementData of Gmsh, the .sol beside a MEDIT mesh, the .mtr beside
/// TetGen's files, attributes of XDMF. `field`: its name; empty: the only one there is. For SizeOptions::mesh. Throws
/// InputError, which lists the fields that there are, and for sizes that are not above 0.
std::shared_ptr<const SizeMesh> read_size_mesh(const std::string& file, const std::string& field = {},
                                               const RunContext& context = {});
/// What `--size-field` names: FILE or FILE:FIELD. A background grid without a field becomes SizeOptions::field, all
/// else SizeOptions::mesh.
void read_sizes_into(SizeOptions& options, const std::string& named, const RunContext& context = {});

/// Reads a metric at the vertices of a mesh: MEDIT's .sol or .solb (tensors xx xy yy xz yz zz, or sizes; the mesh is
/// the .mesh or .meshb of the same name, else `mesh_file`), or FILE:FIELD of a VTU or VTK mesh with tensors at its
/// points (9 numbers by rows, or 6 as VTK has them: xx yy zz xy yz xz; where it is named also single numbers, which are
/// sizes). Whether they are positive definite is for adapt_to_metric() to say. Throws InputError.
MetricMesh read_metric(const std::string& named, const std::string& mesh_file = {}, const RunContext& context = {});
/// Writes it as tensors at the points of a .vtu, or as a .sol without the mesh. Throws OutputError, OptionError.
void write_metric(const std::string& file, const MetricMesh& metric, const RunContext& context = {});

/// Reads a field of single numbers at the points of a mesh that was read from `file` or has the same points; `field`:
/// its name, empty: the only one. Throws InputError.
std::vector<double> read_point_values(const std::string& file, const std::string& field, const TetMesh& mesh,
                                      const RunContext& context = {});

/// Writes text (a report) beside and renames it into place. Throws OutputError.
void write_text(const std::string& file, const std::string& text);

/// Whether writing to one would change the other: the same name, or links to one file, which need not exist yet.
bool same_file(const std::string& a, const std::string& b);

/// Throws OptionError if write_mesh (or write_surface) would for this file and these options, OutputError if its folder
/// does not exist or cannot be written: to be called before long work.
void check_mesh_target(const std::string& file, const WriteOptions& options = {});
void check_surface_target(const std::string& file);
void check_size_field_target(const std::string& file);
void check_metric_target(const std::string& file);
/// The same for files of any ending.
void check_text_target(const std::string& file);

/// A tetrahedral mesh that was read.
struct MeshFile {
  TetMesh mesh;
  std::string format;              ///< e.g. "Gmsh MSH 4.1"
  std::vector<std::string> notes;  ///< what a user should know, e.g. "12 elements of other kinds were left out"
  std::uint64_t turned = 0;        ///< tetrahedra that were inverted in the file, those of wedges and pyramids too
  std::uint64_t turned_wide = 0;   ///< wedges and pyramids that were
};

/// Reads a tetrahedral mesh, linear or of second order, with its groups, in any format of known_formats() that
/// reads_mesh; recognised by content, the name breaks ties. Inverted elements are turned, wedges and pyramids divided
/// into tetrahedra (TetMesh::wide_cells), so are hexahedra, other kinds of elements and unused vertices left out, a
/// boundary face that the file lacks is added, and faces inside that the file has become interfaces. Groups of elements
/// that overlap no earlier one become regions (of faces: patches, of edges: curves), others sets. Throws InputError;
/// memory is bounded by a small multiple of the size of the file.
MeshFile read_mesh_file(const std::string& file, const RunContext& context = {});
/// The mesh alone.
TetMesh read_mesh(const std::string& file, const RunContext& context = {});

/// A region, patch, curve or set of a mesh, for lists.
struct GroupInfo {
  std::string origin;  ///< "region", "patch", "curve", "nodes", "edges", "faces", "elements"
  std::string name;    ///< made from the number where it has none
  std::uint64_t size = 0;
};
/// All that have members.
std::vector<GroupInfo> groups_of(const TetMesh& mesh);

/// What becomes of a numbered kind of part, which may have names, in a format.
enum class Keeps { kNothing, kNumbers, kNames, kNodeSets };

/// What a format for tetrahedral meshes can hold.
struct FormatHolds {
  Keeps regions = Keeps::kNothing, patches = Keeps::kNothing, curves = Keeps::kNothing;
  bool interfaces = false;                                                             ///< patches inside
  bool node_sets = false, edge_sets = false, face_sets = false, element_sets = false;  ///< further sets, overlapping
  bool second_order = false, high_order = false, doubles = true, binary = false;       ///< high: orders 3 and 4
  bool wide_cells = false;         ///< wedges and pyramids; in others they are tetrahedra
  bool curved_wide_cells = false;  ///< the same of second order
  bool cohesive = false;           ///< WriteOptions::cohesive and beams
  bool fields = false;             ///< MeshField
  bool surfaces_alone = false;     ///< a mesh of triangles without tetrahedra
  bool parts = false;              ///< WriteOptions::parts
  bool polyhedra = false;          ///< WriteOptions::polyhedral
  bool jobs = false;               ///< WriteOptions::job
};

/// What is known of a file format, for help texts and --format.
struct FormatInfo {
  std::string_view name;     ///< for --format, e.g. "abaqus"
  std::string_view title;    ///< e.g. "Abaqus, CalculiX"
  std::string_view endings;  ///< e.g. ".bdf .nas", the first one preferred; may be empty
  bool reads_surface = false, writes_surface = false, reads_mesh = false, writes_mesh = false;
  FormatHolds holds;         ///< of meshes
  std::string_view carries;  ///< what survives in it, e.g. "double precision, no patches"
  bool one_file = true;      ///< one file holds a mesh: it can go through a pipe
  bool also_text = false;    ///< meshes are binary, or text where WriteOptions::ascii asks for it
};

/// All formats, those of surfaces first.
std::vector<FormatInfo> known_formats();

/// Whether this build has METIS, for Partitioner::kMetis.
bool has_metis();

/// The one that write_mesh() would write to this file. Throws OptionError if there is none.
const FormatInfo& format_for(const std::string& file, const WriteOptions& options = {});

}  // namespace octafront
