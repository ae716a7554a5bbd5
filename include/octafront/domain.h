#pragma once

#include <octafront/complex.h>
#include <octafront/image.h>
#include <octafront/image_surface.h>
#include <octafront/inside.h>
#include <octafront/mend.h>
#include <octafront/named_groups.h>
#include <octafront/no_context.h>
#include <octafront/split.h>
#include <octafront/surface_mesh.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace octafront {

struct Options;
class TrueGeometry;

// One way in: files, several bodies, arrays and images become a Domain, and generate() (octafront/generate.h) makes a
// mesh of it. The command line, C and Python go this way too, so all of them make the same mesh of the same input.

/// A sentence about what was found or done on the way in.
struct IntakeNote {
  std::string stage;  ///< "reading", "resampling", "regions", "repair"; empty: what an input is, not what was done
  std::string text;
};

/// The first and the last voxel along an axis, counted from 0, both inside; without a value to the end.
struct VoxelRange {
  std::optional<std::uint32_t> first = {}, last = {};
};

/// A file and the label that it is of, by name or number.
struct FileOfLabel {
  std::string label, file;
};

/// How an image becomes a domain.
struct ImageIntake {
  ImageChoice choice;                 ///< of several images in a file, a folder or a project
  ImageRegions regions;               ///< labels, or bands of grey values, and what is cleaned
  std::string names_file;             ///< for read_label_names(): go before the names in `regions`; empty: none
  std::array<VoxelRange, 3> crop;     ///< only these voxels along i, j and k
  std::vector<double> resample = {};  ///< spacing of the voxels to work with, > 0, the unit of the file: one, or three
  /// Without `resample`: bands of grey values are taken from coarser voxels, if much of them is a voxel thick and their
  /// surfaces alone make so many elements, or three times those of `size`: then no other triangles follow them.
  double most_elements = HUGE_VAL;
  /// Specks of labels and bands are removed (CleanOptions::specks): those below this volume, >= 0. Without a value
  /// below an element of `size`, if that is given and the image is not repeated.
  std::optional<double> specks = {};
  std::optional<double> size = {};  ///< the edge length that elements will have, in the unit of the file, > 0
  /// Closed surfaces that read_surface() knows, behind those in `regions`: ImageRegions::surfaces.
  std::vector<FileOfLabel> surface_files = {};
};

/// How a CAD file becomes a domain.
struct CadIntake {
  /// The edge length that elements will have, in `unit`, > 0: triangles are made fine enough for it, and no line is
  /// kept where narrow faces meet smoothly. Without a value that of `elements`; without either a fortieth of the
  /// diagonal, and all lines are kept.
  std::optional<double> size = {};
  std::optional<std::int64_t> elements = {};  ///< the number of tetrahedra that the mesh will have, > 0
  /// Faces, colours and layers by name: their faces are not meshed as one with others, as those need that have a size
  /// of their own.
  std::vector<std::string> apart = {};
  /// What lengths count, those that are given here and those of the domain: a unit of octafront/units.h by its name.
  std::string unit = "mm";
  bool keep_edges = false;      ///< all lines between faces are kept, whatever the size
  bool keep_going = false;      ///< a file of which a part cannot be read is meshed without it
  bool heal = true;             ///< what is not valid is healed, where that changes no volume
  double seconds = 300;         ///< CPU time for reading, healing, fusing and triangles, > 0
  double memory_gigabytes = 8;  ///< for the same, > 0
};

/// What lies inside of the input, from files or arrays. A file is FILE, whose stem is the name, or NAME=FILE.
struct InsideIntake {
  std::vector<std::string> sheet_files;  ///< surfaces that read_surface() knows
  std::vector<std::string> wire_files;   ///< lines of read_lines(): octafront/io.h
  std::vector<std::string> point_files;  ///< its points
  std::vector<Sheet> sheets;             ///< these come behind those of files
  std::vector<LineNet> wires;
  std::vector<PointSet> points;
};

/// How a formula, or samples of a function, become a domain (octafront/formula.h).
struct FormulaIntake {
  std::optional<double> cell = {};               ///< the period of the named surfaces, > 0; without a value 1
  std::optional<std::uint32_t> resolution = {};  ///< cells along the longest side of the box, >= 4
};

/// What is done with an input that cannot be meshed as it is, and how its parts become regions.
struct IntakeOptions {
  /// Seeds, voids, cells, nested shells and overlaps: with anything but Overlap::kAuto each name of a patch of one
  /// surface is a body. `tolerance` is that of several bodies, and what repair keeps to: see
  /// ComplexOptions and MendOptions, which have defaults of their own.
  ComplexOptions complex;
  /// Surfaces that cannot be meshed as they are. kOff: they stay as they are, and generate() refuses them. kAuto:
  /// holes are closed, crossings resolved, what bounds nothing dropped, the rest stays. kWrap: a closed skin around
  /// all.
  enum class Repair { kOff, kAuto, kWrap };
  Repair repair = Repair::kAuto;
  std::optional<double> wrap_distance = {};  ///< MendOptions::distance
  /// Walls of a clean complex that lie inside of one region: cracks to keep, or debris.
  enum class Sheets { kKeep, kDrop };
  Sheets sheets = Sheets::kKeep;
  /// Off: a surface that only has doubled or turned faces stays as it is, because generate() puts them in order itself
  /// and says so. On: open_domain() puts them in order, for a surface that something else than generate() will take.
  bool tidies = false;
  /// Axes along which bodies in a `box`, or an image, are repeated, as of Options::periodic: what crosses a face of the
  /// cell comes in again at the opposite one. Without a value as Options::periodic says, by intake_for().
  std::optional<std::string> repeat = {};
  /// The cell that bodies lie in, "X0,Y0,Z0,X1,Y1,Z1": they are cut by it, and what they leave of it is a region,
  /// "matrix". "first": the first body is the cell, and repeated by its bounding box. Empty: there is none. A body by a
  /// formula ends flat at its faces; empty: one cell of the named surfaces, from the origin on.
  std::string box = {};
  /// How parts meet: "shared", "split", "separate" (ContactChoice::all; empty: shared). Of an image also, with a comma
  /// between, how small contacts of labels are cleared (CleanOptions::contacts): those below an area, or "keep";
  /// without either below the square of the size, if that is given and the image is not repeated.
  std::string contacts = {};
  /// Rules with semicolons between (ContactChoice::Rule), "A|B=split", or files with one in each line.
  std::string contact = {};
  /// A flow around what comes in: "X0,Y0,Z0:X1,Y1,Z1" is a box whose faces are the patches inlet (least x), outlet,
  /// side_right (least y), side_left, ground (least z) and top; what is meshed is the box without the bodies. "auto":
  /// by the body's length L along x, 5 L before, 10 L behind, 5 L to all sides; "ground": the same, but the body stands
  /// on the ground. Empty: none.
  std::string wind_tunnel = {};
  ImageIntake image;
  CadIntake cad;
  InsideIntake inside;
  FormulaIntake formula;
  /// Called with each note as soon as there is one, so that notes are known even where open_domain() throws later.
  std::function<void(const IntakeNote&)> tell = {};
};

/// What mend_surface() did to an input, or a part of one.
struct IntakeRepair {
  std::string of;  ///< the file, or "FILE (NAME)" of one part; empty: the whole input
  MendReport report;
};

/// The way in to a mesh by these options: where `intake` does not say it, a CAD file is triangulated for the size or
/// the number of elements that they ask for, and faces with a size of their own stay apart; an image has the budget of
/// automatic sizes if they are.
///
/// Example: generate(open_domain("part.step", intake_for(options)), options) is what `octafront mesh` does.
IntakeOptions intake_for(const Options& options, IntakeOptions intake = {});

/// What generate() takes: a surface or a complex, and what is known of where it came from. A SurfaceMesh, and what
/// mend_surface() returns, are domains as they stand; their triangles are copied unless they are moved.
struct Domain {
  Domain() = default;
  Domain(SurfaceMesh as_it_is) : surface(std::move(as_it_is)) {}  // NOLINT(google-explicit-constructor)
  Domain(Mended mended)                                           // NOLINT(google-explicit-constructor)
      : surface(std::move(mended.surface)), bound(std::move(mended.bound)) {}

  /// With SurfaceMesh::sides and names where there are several regions. `source` refers to the faces of the input.
  SurfaceMesh surface;
  /// Mended::bound: where repair moved something a mesh of automatic sizes stays nearer to the surface.
  std::vector<double> bound = {};
  /// The smallest distance of the voxels of an image: generate() works by options that suit them, as
  /// options_for_voxels() says. 0: it is not from an image.
  double voxel_spacing = 0;

  /// fingerprint() of a surface that an exact search found clean, as open_domain() leaves it: generate() does not
  /// search this very surface again. 0: of none.
  std::uint64_t found_clean = 0;

  /// Edges and nodes that the mesh will have inside: generate() makes them.
  std::vector<LineNet> wires = {};
  std::vector<PointSet> points = {};

  /// Of files: sets of nodes, edges and faces, which the mesh gets as far as its walls have them.
  std::vector<PlacedSet> sets = {};

  /// Of CAD: what the triangles stand for; the patches of the surface are its patches. Vertices of the mesh lie on it.
  std::shared_ptr<const TrueGeometry> geometry = {};
  /// Of CAD: the volumes of the regions by it, which those of the mesh must meet. Empty: not known.
  std::vector<double> true_volumes = {};
  /// Of CAD, per region: chords no deeper than this keep its volume within a percent, about. Empty: not known.
  std::vector<double> chord_depths = {};

  /// Of a wind tunnel: how many of the first patches are the body's, and its length along the flow. generate() chooses
  /// sizes and layers by them. 0: there is none.
  std::size_t body_patches = 0;
  double body_length = 0;

  /// Voxels of the image along i, j and k, as they were taken.
  std::array<std::uint32_t, 3> voxels = {0, 0, 0};

  /// Of CAD: the regions that the file gives a density, by name, in kg/m3.
  std::vector<std::pair<std::string, double>> densities = {};

  ContactChoice contacts = {};  ///< how parts meet: generate() opens contacts, or meshes parts one by one

  std::string unit = {};                   ///< that coordinates count, as far as that is known: of CAD
  std::string frame = {};                  ///< of an image: where x, y and z point, Image::frame
  std::string format = {};                 ///< of the input: "binary STL", "several files", ...
  std::vector<double> volumes = {};        ///< of the regions of a complex, as they are; empty: a plain surface
  std::vector<IntakeNote> notes = {};      ///< in the order in which they were told
  std::vector<IntakeRepair> repairs = {};  ///< of each surface that was looked at, clean ones too
  std::uint64_t dropped_sheet_faces = 0;   ///< by IntakeOptions::Sheets::kDrop
};

/// What is known of a domain but for its triangles, as one JSON object with the keys of the command line's report:
/// "repair" (of one part: "repair PART"), "input_regions", "input_notes", "dropped_sheet_faces", each where there is
/// something to say.
std::string to_json(const Domain& domain);

/// Opens a file, or several, a body each, whose regions get the names of the files. What read_surface() or read_image()
/// knows, told by content; of images several files are the slices of one. What is_formula() of octafront/formula.h
/// knows is the body that open_formula() makes of it.
///
/// A surface with walls or parts inside becomes a complex of regions (complex_of_walls()); a plain one that is clean
/// stays as it is, bit for bit; what has defects is mended as the options say (mend_surface()). Several bodies are
/// mended one by one, then joined (join_bodies()). An image is cropped, resampled, and becomes the complex of its
/// labels or bands (complex_of_image()).
///
/// Example: generate(open_domain("scan.stl")) meshes whatever the file holds.
///
/// The result depends on nothing but the files and the options, not on the number of threads. Throws InputError, which
/// names the file; LeakError; OptionError, also for options of images beside a file that is none; Cancelled.
Domain open_domain(const std::vector<std::string>& files, const IntakeOptions& options = {},
                   const RunContext& context = no_context());
Domain open_domain(const std::string& file, const IntakeOptions& options = {},
                   const RunContext& context = no_context());

/// The same of arrays: a surface or soup. What is known of it already stays known; that of a CAD file stays as it is.
Domain open_domain(Domain input, const IntakeOptions& options = {}, const RunContext& context = no_context());

/// The same of several bodies, any soups, whose regions get their names.
Domain open_domain(std::vector<Body> bodies, const IntakeOptions& options = {},
                   const RunContext& context = no_context());

/// The same of an image in memory; `options.image.choice` is not asked.
Domain open_domain(const Image& image, const IntakeOptions& options = {}, const RunContext& context = no_context());

}  // namespace octafront
