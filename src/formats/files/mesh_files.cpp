#include <octafront/error.h>
#include <octafront/field_files.h>
#include <octafront/io.h>
#include <octafront/poly_mesh.h>

#include "base/core/renumber.h"
#include "base/core/thread_limit.h"
#include "formats/files/formats.h"
#include "formats/jobs/job_plan.h"
#include "formats/parts/division.h"
#include "formats/parts/mixed_cells.h"
#include "formats/parts/pieces.h"
#include "formats/parts/raw_mesh.h"
#include "formats/write/foam_files.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/core.h>

namespace octafront {

namespace {

template <class Can>
std::string names_that(const Can& can) {
  std::string names;
  for (const io::Format& format : io::formats())
    if (can(format)) names += (names.empty() ? "" : ", ") + std::string(format.info.name);
  return names;
}

std::string all_names() {
  return names_that([](const io::Format& format) { return format.info.writes_mesh; });
}

std::string names_with_text() {
  return names_that([](const io::Format& format) {
    return format.info.also_text || (format.info.writes_mesh && !format.info.holds.binary);
  });
}

std::string names_with_parts() {
  return names_that([](const io::Format& format) { return format.write_parts != nullptr; });
}

std::string names_with_polyhedra() {
  return names_that([](const io::Format& format) { return format.write_polyhedra != nullptr; });
}

/// Whether the mesh is written in parts, by options or because the format knows nothing else.
bool goes_in_parts(const io::Format& format, const WriteOptions& options) {
  return options.parts > 0 || (format.write_mesh == nullptr && format.write_parts != nullptr);
}

/// Throws OptionError for what the format cannot do in parts, or this build.
void check_parts(const io::Format& format, const WriteOptions& options) {
  if (options.parts > 0 && format.write_parts == nullptr)
    throw OptionError(
        fmt::format("{} is not written in parts; `parts` is for {}", format.info.title, names_with_parts()));
  if (options.split_files && (format.info.name != "msh" || options.parts == 0))
    throw OptionError("`split_files` is for MSH 4.1 in parts: a file for each");
  if (options.parts > 0 && options.partitioner == Partitioner::kMetis && !has_metis())
    throw OptionError(
        "this octafront was built without METIS; build it with libmetis-dev installed, or divide along the curve");
}

/// Throws OptionError for what the format cannot do of polyhedra, and what they cannot be.
void check_polyhedral(const io::Format& format, const WriteOptions& options) {
  if (!options.polyhedral) return;
  if (format.write_polyhedra == nullptr)
    throw OptionError(
        fmt::format("{} has no polyhedra here; `polyhedral` is for {}", format.info.title, names_with_polyhedra()));
  if (options.parts > 0)
    throw OptionError("polyhedra are not written in parts; let the solver's own program divide them");
  if (options.cells_only) throw OptionError("polyhedra are made of faces, which `cells_only` leaves out");
}

/// Throws OptionError for what the format cannot do.
void check_options(const io::Format& format, const WriteOptions& options) {
  check_parts(format, options);
  check_polyhedral(format, options);
  if (options.deck && format.info.name != "openfoam")
    throw OptionError(fmt::format("{} has no decks here; `deck` is for OpenFOAM", format.info.title));
  if (options.job && !format.info.holds.jobs)
    throw OptionError(fmt::format("{} is no job of a solver here; `job` is for {}", format.info.title,
                                  names_that([](const io::Format& f) { return f.info.holds.jobs; })));
  if (options.job && !options.job->pretensions.empty() && options.cohesive)
    throw OptionError("`pretension` opens sections that are no cracks: it does not go with `cohesive`");
  if (options.job && !options.materials.empty() && !format.info.holds.cohesive)
    throw OptionError(
        fmt::format("materials by bins are for Abaqus: a job for {} has one of each part", format.info.title));
  if (options.job && (options.cells_only || options.parts > 0))
    throw OptionError("a job needs the faces, and the mesh as one: `job` goes with no `cells_only` and `parts`");
  const bool is_of_surfaces = format.write_mesh == nullptr && format.write_parts == nullptr;
  if (options.ascii && (is_of_surfaces || format.info.holds.binary) && !format.info.also_text)
    throw OptionError(
        fmt::format("{} is not written as text; `ascii` is for {}", format.info.title, names_with_text()));
  if (options.cells_only && (is_of_surfaces || format.is_folder))
    throw OptionError(
        fmt::format("{} needs the faces of the boundary, which `cells_only` leaves out", format.info.title));
}

const io::Format& mesh_format(const std::filesystem::path& file, const std::string& name) {
  const io::Format* format = name.empty() ? io::format_of(file) : io::format_named(name);
  if (format == nullptr && !name.empty())
    throw OptionError(fmt::format("there is no format \"{}\"; `format` is one of {}", name, all_names()));
  if (format == nullptr)
    throw OptionError(fmt::format("{}: the ending \"{}\" names no mesh format; use one of {}, or `format`",
                                  file.string(), file.extension().string(),
                                  io::endings_that(&FormatInfo::writes_mesh)));
  if (format->write_mesh == nullptr && format->write_surface == nullptr && format->write_parts == nullptr)
    throw OptionError(
        fmt::format("{}: this octafront was built without HDF5, which {} needs; build it with libhdf5-dev "
                    "installed, or write another format",
                    file.string(), format->info.title));
  return *format;
}

void require_fitting(const std::string& file, const TetMesh& mesh, std::span<const MeshField> fields) {
  for (const MeshField& field : fields) {
    const std::size_t items = field.of_elements ? mesh.tets.size() : mesh.points.size();
    if (field.values.size() != items * field.components)
      throw OutputError(fmt::format("{}: the field {} has {} values, not {} for each of {} {}", file,
                                    io::in_quotes(field.name), field.values.size(), field.components, items,
                                    field.of_elements ? "elements" : "points"));
  }
}

/// Those of points that keep their numbers, and of elements that stay what they are.
std::vector<MeshField> fields_that_fit(std::span<const MeshField> fields, bool points_move, bool elements_change) {
  std::vector<MeshField> fitting;
  for (const MeshField& field : fields)
    if (field.of_elements ? !elements_change : !points_move) fitting.push_back(field);
  return fitting;
}

/// What a format holds of a mesh that becomes polyhedra: regions, patches, and values at vertices.
FormatInfo info_for(const FormatInfo& info, const WriteOptions& options, std::string& title) {
  if (!options.polyhedral) return info;
  FormatInfo left = info;
  title = fmt::format("{} of polyhedra", info.title);
  left.title = title;
  left.holds.curves = Keeps::kNothing;
  left.holds.node_sets = left.holds.edge_sets = left.holds.face_sets = left.holds.element_sets = false;
  left.holds.second_order = false;
  return left;
}

/// Of a format of surfaces only.
SurfaceMesh boundary_surface(const TetMesh& mesh) {
  SurfaceMesh surface;
  surface.patch = mesh.patch;
  surface.patch_names = mesh.patch_names;
  surface.points = mesh.points;
  surface.triangles = mesh.boundary;
  drop_unused_points(surface.points, surface.triangles);
  return surface;
}

}  // namespace

MeshFile read_mesh_file(const std::string& file, const RunContext& context) {
  return io::read_mesh_bytes(io::LoadedFile(file, context).input());
}

TetMesh read_mesh(const std::string& file, const RunContext& context) {
  return read_mesh_file(file, context).mesh;
}

void check_mesh_target(const std::string& file, const WriteOptions& options) {
  const io::Format& format = mesh_format(file, options.format);
  check_options(format, options);
  io::check_foam_case(file, options);
  if (goes_in_parts(format, options) && format.check_parts != nullptr)
    return format.check_parts(file, std::max(options.parts, 1U));
  format.is_folder ? io::check_folder_writable(file) : io::check_writable(file);
}

const FormatInfo& format_for(const std::string& file, const WriteOptions& options) {
  return mesh_format(file, options.format).info;
}

std::vector<std::string> write_mesh(const std::string& file, const TetMesh& mesh, const RunContext& context,
                                    const WriteOptions& options) {
  return write_mesh(file, mesh, {}, context, options);
}

std::vector<std::string> write_mesh(const std::string& file, const TetMesh& given_mesh,
                                    std::span<const MeshField> fields, const RunContext& context,
                                    const WriteOptions& options) {
  check_mesh_target(file, options);
  require_fitting(file, given_mesh, fields);
  const ThreadLimit limit(context.threads);
  const io::Format& format = mesh_format(file, options.format);
  std::string title;
  const FormatInfo info = info_for(format.info, options, title);
  const FormatHolds& holds = info.holds;
  // Of orders 3 and 4 there are tetrahedra only.
  const bool is_high = holds.high_order && given_mesh.high_order > 0;
  const bool is_wide =
      !is_high && (holds.second_order && given_mesh.is_second_order() ? holds.curved_wide_cells : holds.wide_cells);
  const bool is_curved = is_wide && holds.second_order;
  const io::JobMesh for_job = options.job ? io::mesh_for_job(given_mesh, *options.job) : io::JobMesh{};
  const TetMesh& mesh = for_job.changed ? *for_job.changed : given_mesh;
  const io::WithoutDiagonals without = is_curved ? io::without_diagonals(mesh) : io::WithoutDiagonals{};
  const io::MeshParts parts(without.mesh ? *without.mesh : mesh,
                            {.mid_nodes = mesh.high_order > 0 ? !holds.high_order : !holds.second_order,
                             .faces = options.cells_only,
                             .wide_cells = !is_wide,
                             .last_points = without.diagonals});
  if (goes_in_parts(format, options) && mesh.tets.empty())
    throw OptionError(fmt::format("{}: a mesh without volume elements is not written in parts", file));
  if (options.polyhedral && mesh.tets.empty())
    throw OptionError(fmt::format("{}: a mesh without volume elements has no polyhedra", file));
  const bool wedges_in_parts = goes_in_parts(format, options) && !parts.wide_cells().empty();
  const std::size_t given = fields.size();
  std::vector<MeshField> fitting;
  if (without.mesh || wedges_in_parts || options.polyhedral) {
    fitting = fields_that_fit(fields, without.mesh.has_value(), wedges_in_parts || options.polyhedral);
    fields = fitting;
  }
  io::MeshOutput out(file, context, options, fields);
  if (fields.size() < given)
    out.note(options.polyhedral
                 ? "polyhedra are written without the values of elements: a cell is made of many"
                 : "wedges of second order, or in parts, are written without the fields that do not fit them");
  out.note(io::loss_of_fields(info, fields));
  if (format.write_surface != nullptr) {
    format.write_surface(out.file(), boundary_surface(mesh));
    if (!mesh.tets.empty())
      out.note(
          fmt::format("{} holds the boundary alone: {} tetrahedra are left out", format.info.title, mesh.tets.size()));
  } else {
    out.note(parts.note_on_names());
    for (std::string& note : io::losses(info, parts)) out.note(std::move(note));
    if ((options.cohesive || !options.beams.empty()) && !holds.cohesive)
      out.note(fmt::format("{} is given no cohesive elements and beams: they are for Abaqus", format.info.title));
    if (options.polyhedral) {
      format.write_polyhedra(out, parts, dual_mesh(parts.mesh(), context));
    } else if (goes_in_parts(format, options)) {
      io::Pieces pieces(parts, io::divide(parts.mesh(), std::max(options.parts, 1U), options.partitioner), fields);
      format.write_parts(out, pieces);
    } else {
      std::optional<io::JobPlan> plan;
      if (options.job) plan = io::plan_job(out, parts, *options.job, for_job.sections);
      out.set_job(plan ? &*plan : nullptr);
      format.write_mesh(out, parts);
    }
  }
  out.commit();
  return std::move(out.notes());
}

}  // namespace octafront
