#include "formats/files/formats.h"

#include "formats/containers/scanner.h"
#include "formats/read/readers.h"
#include "formats/write/writers.h"

#include <array>

namespace octafront::io {
namespace {

constexpr bool kYes = true, kNo = false;

#ifdef OCTAFRONT_WITH_HDF5
constexpr auto kWriteMed = write_med, kWriteXdmf = write_xdmf, kWriteCgns = write_cgns, kWriteVtkHdf = write_vtkhdf;
constexpr void (*kWriteVtkHdfParts)(MeshOutput&, Pieces&) = write_vtkhdf_parts;
constexpr void (*kWriteCgnsPolyhedra)(MeshOutput&, const MeshParts&, const PolyMesh&) = write_cgns_polyhedra;
constexpr auto kReadMed = read_med, kReadXdmf = read_xdmf;
#else
constexpr void (*kWriteMed)(MeshOutput&, const MeshParts&) = nullptr;
constexpr auto kWriteXdmf = kWriteMed, kWriteCgns = kWriteMed, kWriteVtkHdf = kWriteMed;
constexpr void (*kWriteVtkHdfParts)(MeshOutput&, Pieces&) = nullptr;
constexpr void (*kWriteCgnsPolyhedra)(MeshOutput&, const MeshParts&, const PolyMesh&) = nullptr;
RawMesh refuse_hdf5(const Input& input) {
  input.fail(
      "needs HDF5, which this octafront was built without: build it with libhdf5-dev installed, or convert the file");
}
constexpr auto kReadMed = refuse_hdf5, kReadXdmf = refuse_hdf5;
#endif

constexpr FormatHolds kBoundary{.surfaces_alone = true};
/// A format of surfaces; of a mesh it takes the boundary.
constexpr Format surface(std::string_view name, std::string_view title, std::string_view endings,
                         std::string_view carries, void (*write)(AtomicFile&, const SurfaceMesh&),
                         Told (*told)(const FileHead&), SurfaceFile (*read)(const Input&)) {
  Format format{{name, title, endings, kYes, kYes, kNo, kYes, kBoundary, carries, true}, write};
  format.told = told;
  format.read_surface = read;
  return format;
}
constexpr Format with_lines(Format format, LinesFile (*read)(const Input&)) {
  format.read_lines = read;
  return format;
}

constexpr Format mesh(std::string_view name, std::string_view title, std::string_view endings, FormatHolds holds,
                      std::string_view carries, void (*write)(MeshOutput&, const MeshParts&)) {
  return {{name, title, endings, kNo, kNo, kNo, write != nullptr, holds, carries, true}, nullptr, write};
}
constexpr Format read(Format format, Told (*told)(const FileHead&), RawMesh (*read_mesh)(const Input&)) {
  format.info.reads_mesh = true;
  format.told = told;
  format.read_mesh = read_mesh;
  return format;
}
Told told_xdmf(const FileHead& head) {
  return head.kind == "an XDMF mesh" ? Told::kMagic : Told::kNot;
}
Told told_hdf5(const FileHead& head) {
  return head.kind == "an HDF5 file" ? Told::kMagic : Told::kNot;
}

constexpr FormatHolds kAll{.regions = Keeps::kNames,
                           .patches = Keeps::kNames,
                           .curves = Keeps::kNames,
                           .interfaces = true,
                           .node_sets = true,
                           .edge_sets = true,
                           .face_sets = true,
                           .element_sets = true,
                           .second_order = true};

/// Names and sets of most solvers: all but edges, which become sets of their nodes.
constexpr FormatHolds kSolver = [] {
  FormatHolds holds = kAll;
  holds.curves = Keeps::kNodeSets;
  holds.edge_sets = false;
  return holds;
}();

constexpr FormatHolds kNumbersOnly{.regions = Keeps::kNumbers,
                                   .patches = Keeps::kNumbers,
                                   .curves = Keeps::kNumbers,
                                   .interfaces = true,
                                   .second_order = true};

constexpr FormatHolds all_orders(FormatHolds holds) {
  holds.high_order = true;
  return holds;
}
constexpr FormatHolds binary(FormatHolds holds) {
  holds.binary = true;
  return holds;
}
constexpr FormatHolds without_edges(FormatHolds holds) {
  holds.curves = Keeps::kNodeSets;
  holds.edge_sets = false;
  return holds;
}
constexpr FormatHolds without_sets(FormatHolds holds) {
  holds.node_sets = holds.edge_sets = holds.face_sets = holds.element_sets = false;
  return holds;
}
constexpr FormatHolds kAnsys = [] {
  FormatHolds holds = kSolver;
  holds.patches = Keeps::kNodeSets;
  holds.face_sets = false;
  return holds;
}();
constexpr Format read_only(Format format) {
  format.info.writes_surface = format.info.writes_mesh = false;
  format.info.holds = {};
  return format;
}
constexpr Format with_surfaces_alone(Format format) {
  format.info.holds.surfaces_alone = true;
  return format;
}
constexpr Format with_fields(Format format, bool surfaces_alone = true) {
  format.info.holds.surfaces_alone = surfaces_alone && format.write_mesh != nullptr;  // parts are of volumes
  format.info.holds.fields = true;
  return format;
}
constexpr Format or_text(Format format) {
  format.info.also_text = true;
  return format;
}
constexpr Format with_linear_wedges(Format format) {
  format.info.holds.wide_cells = true;
  return format;
}
constexpr Format with_wedges(Format format) {
  format = with_linear_wedges(format);
  format.info.holds.curved_wide_cells = format.info.holds.second_order;
  return format;
}
constexpr Format with_cohesive(Format format) {
  format.info.holds.cohesive = true;
  return format;
}
constexpr Format with_jobs(Format format) {
  format.info.holds.jobs = true;
  return format;
}
constexpr Format with_parts(Format format, void (*write)(MeshOutput&, Pieces&),
                            void (*check)(const std::filesystem::path&, std::uint32_t) = nullptr) {
  format.info.holds.parts = write != nullptr;
  format.info.writes_mesh = format.info.writes_mesh || write != nullptr;
  format.write_parts = write;
  format.check_parts = check;
  return format;
}
constexpr Format with_polyhedra(Format format, void (*write)(MeshOutput&, const MeshParts&, const PolyMesh&)) {
  format.info.holds.polyhedra = write != nullptr;
  format.write_polyhedra = write;
  return format;
}
constexpr Format of_several_files(Format format) {
  format.info.one_file = false;
  return format;
}
constexpr FormatHolds kMfem{
    .regions = Keeps::kNames, .patches = Keeps::kNames, .interfaces = true, .second_order = true};
constexpr FormatHolds kTissues{.regions = Keeps::kNumbers, .interfaces = true};
constexpr FormatHolds kSu2{.patches = Keeps::kNames};
constexpr FormatHolds kOpenFoam{.regions = Keeps::kNames, .patches = Keeps::kNames, .interfaces = true};

constexpr std::array kFormats{
    surface("stl", "STL", ".stl",
            "read as text or binary, written binary: single precision, no shared vertices, no patches (read: named "
            "solids)",
            write_stl, told_stl, read_stl),
    with_lines(
        surface("obj", "OBJ", ".obj", "double precision, patches by name as groups", write_obj, told_obj, read_obj),
        read_obj_lines),
    surface("off", "OFF", ".off", "double precision, no patches", write_off, told_off, read_off),
    with_lines(surface("ply", "PLY", ".ply",
                       "read as text or binary, written binary: double precision, patches, and regions on "
                       "both sides, with names",
                       write_ply, told_ply, read_ply),
               read_ply_lines),
    read_only(surface("freesurfer", "FreeSurfer", ".pial .white",
                      "triangles of lh.pial and others, in the scanner's coordinates; read only", nullptr,
                      told_freesurfer, read_freesurfer)),
    read_only(surface("poly", "TetGen PLC", ".poly .smesh",
                      "facets, with markers as patches, regions and holes; read only", nullptr, told_poly, read_poly)),
    with_polyhedra(read(with_fields(with_wedges(or_text(mesh("vtu", "VTU", ".vtu", all_orders(binary(kAll)),
                                                             "VTK unstructured grid, compressed or text: numbers, "
                                                             "names and sets as arrays; beta per element",
                                                             write_vtu)))),
                        told_vtu, read_vtu),
                   write_vtu_polyhedra),
    read(with_parts(with_fields(with_wedges(or_text(mesh("msh", "Gmsh MSH 4.1", ".msh", all_orders(binary(kAll)),
                                                         "binary or text: all as physical groups", write_msh)))),
                    write_msh_parts),
         told_msh, read_msh),
    read(with_fields(
             with_wedges(or_text(mesh("msh22", "Gmsh MSH 2.2", "", all_orders(binary(without_sets(kAll))),
                                      "binary or text: regions, patches, curves as physical groups", write_msh2)))),
         nullptr, read_msh),
    with_fields(or_text(mesh("simnibs", "SimNIBS (MSH 2.2)", "", binary(kTissues),
                             "labels as tags of tetrahedra, 1000 more of triangles; binary or text", write_simnibs)),
                false),
    read(with_jobs(
             with_cohesive(with_wedges(mesh("abaqus", "Abaqus, CalculiX", ".inp", kSolver,
                                            "ELSET, NSET, SURFACE; numbers of at most 20 characters", write_abaqus)))),
         told_abaqus, read_abaqus),
    read(with_jobs(with_wedges(mesh("nastran", "Nastran", ".bdf .nas", kSolver,
                                    "PSOLID, PSHELL, SET; numbers of at most 16 characters (9 to 15 digits)",
                                    write_nastran))),
         told_nastran, read_nastran),
    read(with_wedges(mesh("unv", "I-deas universal", ".unv", kAll, "groups (dataset 2477); 17 digits", write_unv)),
         told_unv, read_unv),
    read(with_jobs(with_fields(
             with_wedges(mesh("med", "MED 4", ".med", binary(kAll), "families and groups; needs HDF5", kWriteMed)),
             false)),
         told_hdf5, kReadMed),
    read(with_fields(with_wedges(of_several_files(mesh("xdmf", "XDMF", ".xdmf", binary(kAll),
                                                       "with values in files .h5 beside; needs HDF5", kWriteXdmf))),
                     false),
         told_xdmf, kReadXdmf),
    with_fields(with_wedges(mesh("exodus", "Exodus II", ".exo .e .ex2", binary(kSolver),
                                 "blocks, node, side and element sets", write_exodus)),
                false),
    with_jobs(with_wedges(mesh("ansys", "Ansys archive", ".cdb", kAnsys, "components; 17 digits", write_ansys))),
    with_linear_wedges(mesh("lsdyna", "LS-DYNA", ".k .key", kSolver,
                            "parts and sets; numbers of at most 16 characters (9 to 15 digits)", write_lsdyna)),
    with_wedges(mesh("febio", "FEBio 4", ".feb", kAll, "Elements, Surface, Edge, NodeSet, ElementSet", write_febio)),
    with_wedges(mesh("su2", "SU2", ".su2", kSu2, "markers", write_su2)),
    [] {
      Format format = of_several_files(mesh("openfoam", "OpenFOAM polyMesh", "", kOpenFoam,
                                            "a folder, named polyMesh: patches, cellZones, faceZones", write_openfoam));
      format.is_folder = true;
      return with_polyhedra(with_parts(with_linear_wedges(format), write_openfoam_parts, check_openfoam_parts),
                            write_openfoam_polyhedra);
    }(),
    with_polyhedra(with_fields(with_wedges(mesh("cgns", "CGNS", ".cgns", binary(without_edges(without_sets(kAll))),
                                                "sections and boundary conditions; needs HDF5", kWriteCgns)),
                               false),
                   kWriteCgnsPolyhedra),
    read(with_fields(with_wedges(or_text(mesh("vtk", "legacy VTK", ".vtk", all_orders(binary(kAll)),
                                              "as VTU, binary or text, uncompressed", write_vtk)))),
         told_vtk, read_vtk),
    with_parts(of_several_files(with_fields(with_wedges(or_text(mesh(
                   "pvtu", "parallel VTU", ".pvtu", all_orders(binary(kAll)),
                   "as VTU, a piece for each part in a folder beside, with ghosts and global numbers", nullptr))))),
               write_pvtu, check_pvtu_target),
    with_parts(with_fields(with_wedges(mesh("vtkhdf", "VTKHDF", ".vtkhdf", all_orders(binary(kAll)),
                                            "as VTU, in one file also in parts; needs HDF5", kWriteVtkHdf))),
               kWriteVtkHdfParts),
    read(with_surfaces_alone(
             with_linear_wedges(mesh("medit", "MEDIT", ".mesh", kNumbersOnly, "text: references", write_medit))),
         told_medit, read_medit),
    read(with_surfaces_alone(with_linear_wedges(
             mesh("meditb", "MEDIT binary", ".meshb", binary(kNumbersOnly), "references", write_medit_binary))),
         told_medit_binary, read_medit_binary),
    read(with_linear_wedges(mesh("mfem", "MFEM", "", all_orders(kMfem),
                                 "text: attributes, names as sets of them; curved nodes of orders 2 to 4", write_mfem)),
         told_mfem, read_mfem),
    read(mesh("netgen", "Netgen", ".vol", all_orders(without_sets(kAll)),
              "materials, bcnames, cd2names; orders 3 and 4 for Netgen from April 2026 on", write_netgen),
         told_netgen, read_netgen),
    read(of_several_files(mesh("tetgen", "TetGen", ".ele .node", kNumbersOnly,
                               "NAME.node, .ele, .face, .edge with markers", write_tetgen)),
         told_tetgen, read_tetgen),
};

bool lists_ending(std::string_view endings, std::string_view ending) {
  while (!endings.empty()) {
    const std::size_t end = std::min(endings.find(' '), endings.size());
    if (equal_ignoring_case(ending, endings.substr(0, end))) return true;
    endings.remove_prefix(std::min(end + 1, endings.size()));
  }
  return false;
}

}  // namespace

std::span<const Format> formats() {
  return kFormats;
}

const Format* format_of(const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  for (const Format& format : kFormats)
    if (!ending.empty() && lists_ending(format.info.endings, ending)) return &format;
  return file.filename() == "polyMesh" ? format_named("openfoam") : nullptr;
}

const Format* format_named(std::string_view name) {
  for (const Format& format : kFormats)
    if (equal_ignoring_case(name, format.info.name)) return &format;
  return nullptr;
}

std::string endings_that(bool FormatInfo::*can) {
  std::string endings;
  for (const Format& format : kFormats) {
    if (!(format.info.*can) || format.info.endings.empty()) continue;
    if (!endings.empty()) endings += ", ";
    endings += format.info.endings.substr(0, format.info.endings.find(' '));
  }
  return endings;
}

}  // namespace octafront::io

namespace octafront {

std::vector<FormatInfo> known_formats() {
  std::vector<FormatInfo> all;
  for (const io::Format& format : io::formats()) all.push_back(format.info);
  return all;
}

}  // namespace octafront
