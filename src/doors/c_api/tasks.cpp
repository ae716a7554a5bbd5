// What jobs do: each task is one call of the library.

#include <octafront/adapt.h>
#include <octafront/cad.h>
#include <octafront/carry.h>
#include <octafront/complex.h>
#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/improve_existing.h>
#include <octafront/io.h>
#include <octafront/level_set.h>
#include <octafront/move.h>
#include <octafront/option_table.h>
#include <octafront/repair.h>
#include <octafront/report_page.h>
#include <octafront/second_order.h>
#include <octafront/solver_checks.h>
#include <octafront/validity.h>

#include "doors/c_api/job.h"
#include "doors/c_api/json_keys.h"
#include "formats/parts/raw_mesh.h"

#include <map>
#include <optional>
#include <utility>

#include <fmt/core.h>

namespace octafront::c_api {

namespace {

using Json = nlohmann::ordered_json;

thread_local std::string last_error, last_text;

Json json_of_repair(const RepairedSurface& r) {
  return {{"merged_vertices", r.merged_vertices},
          {"unused_vertices", r.unused_vertices},
          {"duplicate_faces", r.duplicate_faces},
          {"degenerate_faces", r.degenerate_faces},
          {"divided_faces", r.divided_faces},
          {"turned_faces", r.turned_faces},
          {"turned_shells", r.turned_shells},
          {"shells", r.shells},
          {"cavities", r.cavities},
          {"bodies", r.bodies},
          {"notes", r.notes}};
}

/// Other keys of `json` are for the task itself.
WriteOptions write_options_from(const Json& json) {
  WriteOptions options;
  for (const OptionInfo& info : write_table()) {
    const std::string name(info.name);
    with(json, name.c_str(), [&](const Json& value) { set_option(options, name, value_of(name, value)); });
  }
  with(json, "job", [&](const Json& value) {
    options.job.emplace();
    if (value.is_string()) return add_file_to_job(*options.job, value.get<std::string>());
    add_to_job(*options.job, value.dump());
  });
  check_ranges(options);
  return options;
}

/// Runs a generator, by the options with their events; if it refuses the surface, the evidence goes along.
template <class Generator>
auto made_of(octafront_job& job, const octafront_surface& surface, const octafront_options* options,
             const RunContext& context, const Generator& generator) {
  const Domain& domain = surface.domain;
  require_indices(domain.surface);
  try {
    auto result = generator(domain, job.options_of(options), context);
    job.report = Json::parse(to_json(result.report));
    return result;
  } catch (const InputError&) {
    const SurfaceDefects d = find_defects(repair_surface(domain.surface, job.context()), job.context());
    if (!d.clean()) job.report["defects"] = Json::parse(to_json(d));
    throw;
  }
}

void repair(octafront_job& job, const SurfaceMesh& surface) {
  require_indices(surface);
  RepairedSurface repaired = repair_surface(surface, job.context());
  const SurfaceDefects defects = find_defects(repaired, job.context());
  job.report = json_of_repair(repaired);
  job.report["clean"] = defects.clean();
  job.report["defects"] = Json::parse(to_json(defects));
  job.report["described"] = defects.describe();
  if (defects.clean()) job.report["volume"] = enclosed_volume(repaired.surface);
  if (defects.clean() && !repaired.surface.sides.empty())
    job.report["cavities"] = bounded_spaces(repaired.surface, job.context()).cavities;
  give(job, std::move(repaired.surface));
}

Solver solver_named(const std::string& name) {
  return one_of<Solver>({{"abaqus", Solver::kAbaqus},
                         {"ansys", Solver::kAnsys},
                         {"nastran", Solver::kNastran},
                         {"calculix", Solver::kCalculix}},
                        name, "solver");
}

void check(octafront_job& job, const TetMesh& mesh, const std::string& solver) {
  require_indices(mesh);
  const auto defect = first_defect(mesh, job.context());
  job.report["valid"] = !defect;
  job.report["defect"] = defect ? Json(*defect) : Json(nullptr);
  if (mesh.order() > 1) job.report["second_order"] = Json::parse(to_json(check_jacobians(mesh, job.context())));
  Json groups = Json::array();
  for (const GroupInfo& g : groups_of(mesh))
    groups.push_back({{"origin", g.origin}, {"name", g.name}, {"size", g.size}});
  job.report["groups"] = groups;
  if (solver.empty()) return;
  job.report["solver"] = Json::parse(to_json(check_for_solver(mesh, solver_named(solver), job.context())));
}

std::vector<std::int64_t> references(const std::vector<std::uint32_t>& numbers, std::size_t count) {
  std::vector<std::int64_t> refs(count, 1);
  for (std::size_t i = 0; i < numbers.size(); ++i) refs[i] = std::int64_t{numbers[i]} + 1;
  return refs;
}

std::map<std::int64_t, std::string> named(const std::vector<std::string>& names) {
  std::map<std::int64_t, std::string> by_reference;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (!names[i].empty()) by_reference.emplace(i + 1, names[i]);
  return by_reference;
}

void order_mesh(octafront_job& job, const TetMesh& mesh) {
  require_indices(mesh);
  io::RawMesh raw;
  raw.format = "arrays";
  raw.points = mesh.points;
  raw.tets = mesh.tets;
  raw.mid_nodes = mesh.mid_nodes;
  raw.tet_ref = references(mesh.region, mesh.tets.size());
  raw.triangles = mesh.boundary;
  raw.triangle_ref = references(mesh.patch, mesh.boundary.size());
  raw.region_names = named(mesh.region_names);
  raw.surface_names = named(mesh.patch_names);
  MeshFile ordered = io::ordered_mesh(std::move(raw), {"the arrays of the mesh", {}, job.context()});
  job.report["notes"] = ordered.notes;
  give(job, std::move(ordered.mesh));
}

/// What is told of a mesh or a surface that was adapted.
template <class Adapted>
Json report_of(const Adapted& adapted) {
  Json report = Json::parse(to_json(adapted.report));
  report["fit"] = Json::parse(to_json(adapted.after)), report["fit_before"] = Json::parse(to_json(adapted.before));
  report["deviation"] = Json::parse(to_json(adapted.deviation));
  return report;
}

}  // namespace

const Domain* domain_of(const octafront_surface* ground) {
  if (ground == nullptr) return nullptr;
  require_indices(ground->domain.surface);
  return &ground->domain;
}

void give_adapted(octafront_job& job, AdaptedMesh adapted) {
  job.report = report_of(adapted);
  give(job, std::move(adapted.mesh));
  job.mesh->old_of_new = std::move(adapted.old_of_new);
  job.mesh->old_tet_of_new = std::move(adapted.old_tet_of_new);
}

void give_adapted(octafront_job& job, AdaptedSurface adapted) {
  job.report = report_of(adapted);
  give(job, std::move(adapted.surface));
}

octafront_job* started(const octafront_job::Work& work, int threads) {
  octafront_job* job = nullptr;
  guarded([&] { job = new octafront_job(work, threads); });
  return job;
}

void remember_error(std::string message) {
  last_error = std::move(message);
}

const char* kept(std::string text) {
  last_text = std::move(text);
  return last_text.c_str();
}

}  // namespace octafront::c_api

using namespace octafront;
using namespace octafront::c_api;

const char* octafront_version() {
  return OCTAFRONT_VERSION;
}

const char* octafront_last_error() {
  return last_error.c_str();
}

octafront_job* octafront_read_surface(const char* file) {
  return started([file = std::string(file)](octafront_job& job) {
    if (is_cad(file)) {
      Domain domain = open_domain(file, {}, job.context());
      job.report = {{"format", domain.format}, {"notes", Json::array()}};
      for (const IntakeNote& note : domain.notes) job.report["notes"].push_back(note.text);
      return give(job, std::move(domain));
    }
    SurfaceFile read = read_surface(file, job.context());
    job.report = {{"format", read.format}, {"notes", read.notes}};
    give(job, std::move(read.surface));
  });
}

octafront_job* octafront_write_surface(const octafront_surface* surface, const char* file) {
  return started([surface, file = std::string(file)](octafront_job& job) {
    require_indices(surface->domain.surface);
    write_surface(file, surface->domain.surface, job.context());
  });
}

octafront_job* octafront_read_mesh(const char* file) {
  return started([file = std::string(file)](octafront_job& job) {
    MeshFile read = read_mesh_file(file, job.context());
    job.report = {{"format", read.format}, {"notes", read.notes}};
    give(job, std::move(read.mesh));
  });
}

octafront_job* octafront_write_mesh(const octafront_mesh* mesh, const char* file, const char* options) {
  return started([mesh, file = std::string(file), text = std::string(options ? options : "{}")](octafront_job& job) {
    const WriteOptions asked = write_options_from(Json::parse(text));
    check_mesh_target(file, asked);
    require_indices(mesh->mesh);
    job.report["notes"] = write_mesh(file, mesh->mesh, job.context(), asked);
  });
}

octafront_job* octafront_read_sizes(const char* file, double gradation) {
  return started([file = std::string(file), gradation](octafront_job& job) {
    give(job, read_size_field(file, gradation, job.context()));
  });
}

octafront_job* octafront_write_sizes(const octafront_sizes* sizes, const char* file) {
  return started([sizes, file = std::string(file)](octafront_job& job) {
    check_size_field_target(file);
    write_size_field(file, sizes->field, job.context());
  });
}

octafront_job* octafront_generate(const octafront_surface* surface, const octafront_options* options, int threads) {
  return started(
      [surface, options](octafront_job& job) {
        std::optional<Result> result;
        job.on_ranks(options, "mesh",
                     [&](const RunContext& context) { result = made_of(job, *surface, options, context, generate); });
        give(job, std::move(result->mesh));
        give(job, result->sizes);
      },
      threads);
}

octafront_job* octafront_generate_surface(const octafront_surface* surface, const octafront_options* options,
                                          int threads) {
  return started(
      [surface, options](octafront_job& job) {
        SurfaceResult result = made_of(job, *surface, options, job.context(), generate_surface);
        give(job, std::move(result.surface));
        give(job, result.sizes);
      },
      threads);
}

octafront_job* octafront_generate_sizes(const octafront_surface* surface, const octafront_options* options,
                                        int threads) {
  return started(
      [surface, options](octafront_job& job) {
        give(job, made_of(job, *surface, options, job.context(), generate_sizes).sizes);
      },
      threads);
}

octafront_job* octafront_improve(const octafront_mesh* mesh, const octafront_surface* ground,
                                 const octafront_options* options, int threads) {
  return started(
      [mesh, ground, options](octafront_job& job) {
        require_indices(mesh->mesh);
        if (ground != nullptr) require_indices(ground->domain.surface);
        Improved improved = improve_existing(mesh->mesh, job.options_of(options),
                                             ground != nullptr ? &ground->domain.surface : nullptr, job.context());
        Report before;
        before.tets = mesh->mesh.tets.size();
        before.quality = improved.before;
        job.report = Json::parse(to_json(improved.report));
        job.report["before"] = Json::parse(to_json(before))["quality"];
        give(job, std::move(improved.mesh));
      },
      threads);
}

octafront_job* octafront_adapt(const octafront_mesh* mesh, const octafront_surface* ground,
                               const octafront_options* options, int threads) {
  return started(
      [mesh, ground, options](octafront_job& job) {
        require_indices(mesh->mesh);
        give_adapted(job, adapt_existing(mesh->mesh, job.options_of(options), job.context(), domain_of(ground)));
      },
      threads);
}

namespace {

std::vector<MeshField> fields_from(const octafront_field* fields, std::size_t count, const TetMesh& mesh) {
  std::vector<MeshField> all;
  for (const octafront_field* f = fields; f != fields + count; ++f) {
    const std::size_t items = f->of_elements != 0 ? mesh.tets.size() : mesh.points.size();
    all.push_back({f->name, f->of_elements != 0, f->components, {f->values, f->values + items * f->components}});
  }
  return all;
}

}  // namespace

octafront_job* octafront_cut(const octafront_mesh* mesh, const octafront_level_set* level_sets, size_t count,
                             const octafront_options* options, int threads) {
  return started(
      [=](octafront_job& job) {
        require_indices(mesh->mesh);
        std::vector<LevelSet> sets;
        for (const octafront_level_set* s = level_sets; s != level_sets + count; ++s)
          sets.push_back({s->name, {s->values, s->values + mesh->mesh.points.size()}, s->level});
        CutMesh made = cut_along(mesh->mesh, sets, {job.options_of(options).adapt.least_piece}, job.context());
        job.report["level_sets"] = Json::parse(to_json(made.level_sets));
        give(job, std::move(made.mesh));
      },
      threads);
}

octafront_job* octafront_carry(const octafront_mesh* before, const octafront_mesh* now, int adapted,
                               const octafront_field* fields, size_t count, const octafront_options* options,
                               int threads) {
  return started(
      [=](octafront_job& job) {
        require_indices(before->mesh), require_indices(now->mesh);
        const std::vector<MeshField> old = fields_from(fields, count, before->mesh);
        const KnownItems same{now->old_of_new, now->old_tet_of_new};
        const bool is_known = adapted != 0 && same.old_of_new.size() == now->mesh.points.size() &&
                              same.old_tet_of_new.size() == now->mesh.tets.size();
        const CarriedFields made =
            carry_fields(old, before->mesh, now->mesh, job.options_of(options).carry, job.context(),
                         adapted != 0 ? OutsideNodes::kOnwards : OutsideNodes::kNearest, is_known ? &same : nullptr);
        job.report["carry"] = Json::parse(to_json(made.report));
        job.report["carried"] = Json::parse(to_json(made.report.fields));
        for (std::size_t f = 0; f < count; ++f)
          std::copy(made.fields[f].values.begin(), made.fields[f].values.end(), fields[f].out);
      },
      threads);
}

octafront_job* octafront_move(const octafront_mesh* mesh, const double* displacement, const octafront_field* fields,
                              size_t count, const octafront_options* options, int threads) {
  return started(
      [=](octafront_job& job) {
        require_indices(mesh->mesh);
        std::vector<Vec3> by;
        for (std::size_t v = 0; v < mesh->mesh.points.size(); ++v)
          by.push_back({displacement[3 * v], displacement[3 * v + 1], displacement[3 * v + 2]});
        MovedMesh moved =
            move_mesh(mesh->mesh, by, fields_from(fields, count, mesh->mesh), job.options_of(options), job.context());
        job.report["history"] = Json::parse(to_json(moved.history));
        job.report["notes"] = moved.notes;
        job.report["carried"] = Json::parse(to_json(moved.carried));
        give(job, std::move(moved.mesh));
        job.mesh->fields = std::move(moved.fields);
      },
      threads);
}

int octafront_mesh_field(const octafront_mesh* mesh, size_t i, octafront_array* values) {
  return guarded([&] {
    const MeshField& field = mesh->fields.at(i);
    *values = {field.values.data(), field.values.size() / field.components,
               static_cast<std::uint32_t>(field.components), OCTAFRONT_F64};
  });
}

octafront_job* octafront_repair(const octafront_surface* surface) {
  return started([surface](octafront_job& job) { repair(job, surface->domain.surface); });
}

octafront_job* octafront_check(const octafront_mesh* mesh, const char* solver) {
  return started([mesh, solver = std::string(solver != nullptr ? solver : "")](octafront_job& job) {
    check(job, mesh->mesh, solver);
  });
}

octafront_job* octafront_write_page(const octafront_mesh* mesh, const octafront_sizes* sizes, const char* report,
                                    const char* file) {
  return started([mesh, sizes, report = std::string(report), file = std::string(file)](octafront_job& job) {
    check_text_target(file);
    require_indices(mesh->mesh);
    write_text(file, report_page(mesh->mesh, sizes != nullptr ? &sizes->field : nullptr, report, job.context()));
  });
}

octafront_job* octafront_order_mesh(const octafront_mesh* mesh) {
  return started([mesh](octafront_job& job) { order_mesh(job, mesh->mesh); });
}
