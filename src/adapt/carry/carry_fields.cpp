#include <octafront/error.h>
#include <octafront/validity.h>

#include "adapt/carry/carry.h"
#include "adapt/carry/same_items.h"
#include "adapt/carry/sums.h"
#include "base/core/parallel.h"
#include "base/core/thread_limit.h"
#include "base/core/wording.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/core.h>

namespace octafront {
namespace {

using adapt::CarefulSum;
using adapt::CarefulSums;
using adapt::MatchedRegions;

void require_valid_for_fields(const TetMesh& mesh, const char* which, const RunContext& context) {
  if (const auto defect = first_defect(mesh, context))
    throw InputError(fmt::format("the {} mesh is not valid: {}", which, *defect));
}

void require_field_of(const MeshField& field, const TetMesh& mesh) {
  const std::size_t count = field.of_elements ? mesh.tets.size() : mesh.points.size();
  const char* what = field.of_elements ? "elements" : "vertices";
  if (field.components == 0 || field.values.size() != count * field.components)
    throw InputError(fmt::format("the field \"{}\" has {} values of {} components, and the mesh {} {}", field.name,
                                 field.values.size(), field.components, count, what));
  for (std::size_t i = 0; i < field.values.size(); ++i)
    if (!std::isfinite(field.values[i]))
      throw InputError(fmt::format("the field \"{}\" has the value {} at number {} of the {}", field.name,
                                   field.values[i], i / field.components, what));
}

/// Where values are.
enum class Kind { kNodes, kElements, kPoints };

/// Whether CarryOptions::integration_points names it.
bool is_at_points(const MeshField& field, const CarryOptions& options) {
  const std::vector<std::string> names = names_listed(options.integration_points, {&field.name, 1});
  return field.of_elements && std::find(names.begin(), names.end(), field.name) != names.end();
}

/// Throws InputError for a name that no field of elements has, or that has not four points.
void require_four_points(std::span<const MeshField> fields, const CarryOptions& options) {
  std::vector<std::string> known;
  for (const MeshField& field : fields)
    if (field.of_elements) known.push_back(field.name);
  for (const std::string& name : names_listed(options.integration_points, known)) {
    const auto field =
        std::find_if(fields.begin(), fields.end(), [&](const MeshField& f) { return f.of_elements && f.name == name; });
    if (field == fields.end())
      throw InputError(fmt::format("integration_points: no field of elements is called \"{}\"", name));
    if (field->components % 4 != 0)
      throw InputError(
          fmt::format("integration_points: the field \"{}\" has {} numbers in an element, not those of four points",
                      name, field->components));
  }
}

/// Which each is.
std::vector<Kind> kinds_of(std::span<const MeshField> fields, const CarryOptions& options) {
  require_four_points(fields, options);
  std::vector<Kind> kinds;
  for (const MeshField& field : fields) {
    const Kind of_elements = is_at_points(field, options) ? Kind::kPoints : Kind::kElements;
    kinds.push_back(field.of_elements ? of_elements : Kind::kNodes);
  }
  return kinds;
}

/// All fields of one kind as one with all their components.
class JoinedFields {
 public:
  JoinedFields(std::span<const MeshField> fields, std::span<const Kind> kinds, Kind kind, std::size_t count) {
    for (std::size_t f = 0; f < fields.size(); ++f)
      if (kinds[f] == kind) members_.push_back(f), components += fields[f].components;
    values.resize(count * components);
    std::size_t first = 0;
    for (const std::size_t f : members_) {
      for (std::size_t i = 0; i < count; ++i)
        std::copy_n(fields[f].values.begin() + static_cast<std::ptrdiff_t>(i * fields[f].components),
                    fields[f].components, values.begin() + static_cast<std::ptrdiff_t>(i * components + first));
      first += fields[f].components;
    }
  }

  adapt::OldValues old() const { return {values, components}; }

  /// Takes them apart again.
  void give(const std::vector<double>& made, std::span<MeshField> fields) const {
    std::size_t first = 0;
    for (const std::size_t f : members_) {
      MeshField& field = fields[f];
      field.values.resize(made.size() / components * field.components);
      for (std::size_t i = 0; i < made.size() / components; ++i)
        std::copy_n(made.begin() + static_cast<std::ptrdiff_t>(i * components + first), field.components,
                    field.values.begin() + static_cast<std::ptrdiff_t>(i * field.components));
      first += field.components;
    }
  }
  /// visit(field, its component, that of all)
  template <class Visit>
  void for_each_component(std::span<const MeshField> fields, const Visit& visit) const {
    std::size_t all = 0;
    for (const std::size_t f : members_)
      for (std::size_t k = 0; k < fields[f].components; ++k) visit(f, k, all++);
  }

  std::size_t components = 0;
  std::vector<double> values;

 private:
  std::vector<std::size_t> members_;
};

/// What one side of a component comes to, of elements by region.
struct ComponentSums {
  std::vector<double> integral, magnitude;
};

/// `region_of(t)`: of `regions`.
template <class RegionOf>
ComponentSums component_sums(const TetMesh& mesh, const MeshField& field, std::size_t k, std::uint32_t regions,
                             const RegionOf& region_of) {
  CarefulSums sums = parallel_sum(mesh.tets.size(), [&](std::size_t begin, std::size_t end) {
    CarefulSums part(2 * std::size_t{regions});
    for (std::size_t t = begin; t < end; ++t) {
      double value = 0;
      if (field.of_elements) value = field.values[t * field.components + k];
      for (std::size_t i = 0; i < 4 && !field.of_elements; ++i)
        value += 0.25 * field.values[mesh.tets[t][i] * field.components + k];
      const double all = value * adapt::volume_in(mesh, static_cast<TetIndex>(t));
      const std::size_t r = region_of(static_cast<TetIndex>(t));
      part[2 * r].add(all), part[2 * r + 1].add(std::abs(all));
    }
    return part;
  });
  ComponentSums made;
  for (std::size_t r = 0; r < regions; ++r)
    made.integral.push_back(sums[2 * r].value()), made.magnitude.push_back(sums[2 * r + 1].value());
  return made;
}

void add_component(const MeshField& field, std::size_t k, const ComponentSums& sums, FieldExtent& extent) {
  double least = std::numeric_limits<double>::infinity(), greatest = -least;
  for (std::size_t i = k; i < field.values.size(); i += field.components)
    least = std::min(least, field.values[i]), greatest = std::max(greatest, field.values[i]);
  CarefulSum all;
  for (const double integral : sums.integral) all.add(integral);
  extent.integral.push_back(all.value()), extent.least.push_back(least), extent.greatest.push_back(greatest);
}

/// Of values at points the means of the elements, which integrals are of.
MeshField means_of_points(const MeshField& field) {
  MeshField means{field.name, true, field.components / 4, {}};
  for (std::size_t t = 0; t < field.values.size() / field.components; ++t)
    for (std::size_t k = 0; k < means.components; ++k) {
      double sum = 0;
      for (std::size_t i = 0; i < 4; ++i) sum += field.values[t * field.components + i * means.components + k];
      means.values.push_back(sum / 4);
    }
  return means;
}

void widen_to_points(const MeshField& field, FieldExtent& extent) {
  const std::size_t n = extent.least.size();
  for (std::size_t i = 0; i < field.values.size(); ++i) {
    extent.least[i % n] = std::min(extent.least[i % n], field.values[i]);
    extent.greatest[i % n] = std::max(extent.greatest[i % n], field.values[i]);
  }
}

FieldReport report_of(const MeshField& old, const TetMesh& was, const MeshField& made, const TetMesh& now,
                      const MatchedRegions& regions) {
  FieldReport report{old.name, old.of_elements, old.components, {}, {}, 0, 0};
  for (std::size_t k = 0; k < old.components; ++k) {
    const ComponentSums before =
        component_sums(was, old, k, regions.count(), [&](TetIndex t) { return regions.of_old(t); });
    const ComponentSums after =
        component_sums(now, made, k, regions.count(), [&](TetIndex t) { return regions.of_new(t); });
    add_component(old, k, before, report.before), add_component(made, k, after, report.after);
    for (std::size_t r = 0; r < regions.count() && old.of_elements; ++r)
      if (before.magnitude[r] > 0)
        report.integral_error =
            std::max(report.integral_error, std::abs(after.integral[r] - before.integral[r]) / before.magnitude[r]);
  }
  return report;
}

/// `at_points`: fields of four values in each tet.
FieldReport report_of_either(const MeshField& old, const TetMesh& was, const MeshField& made, const TetMesh& now,
                             const MatchedRegions& regions, bool at_points) {
  if (!at_points) return report_of(old, was, made, now, regions);
  FieldReport report = report_of(means_of_points(old), was, means_of_points(made), now, regions);
  widen_to_points(old, report.before), widen_to_points(made, report.after);
  return report;
}

double volume_of_mesh(const TetMesh& mesh) {
  return parallel_sum(mesh.tets.size(),
                      [&](std::size_t begin, std::size_t end) {
                        CarefulSum part;
                        for (std::size_t t = begin; t < end; ++t)
                          part.add(adapt::volume_in(mesh, static_cast<TetIndex>(t)));
                        return part;
                      })
      .value();
}

std::uint64_t known_in(std::span<const std::uint32_t> old_of_new) {
  return static_cast<std::uint64_t>(
      std::count_if(old_of_new.begin(), old_of_new.end(), [](std::uint32_t old) { return old != kNone; }));
}

CarryReport report_of_meshes(const adapt::MeshPair& meshes, std::uint64_t several) {
  CarryReport report;
  report.nodes = meshes.now.points.size(), report.elements = meshes.now.tets.size();
  report.copied_nodes = known_in(meshes.same.old_of_new), report.copied_elements = known_in(meshes.same.old_tet_of_new);
  report.volume_before = volume_of_mesh(meshes.before), report.volume_after = volume_of_mesh(meshes.now);
  report.by_region = meshes.regions.is_matched;
  if (!meshes.regions.note.empty()) report.notes.push_back(meshes.regions.note);
  if (several > 0)
    report.notes.push_back(
        fmt::format("{} where the old mesh has several at one place: each has the value of the first",
                    several == 1 ? "1 node lies" : fmt::format("{} nodes lie", several)));
  return report;
}

void note_what_differs(CarryReport& report, const CarryOptions& options) {
  if (report.outside_nodes > 0)
    report.notes.push_back(fmt::format("{} outside of the old one, at most {:.3g} from it, at {}",
                                       report.outside_nodes == 1
                                           ? "1 node of the new mesh lies"
                                           : fmt::format("{} nodes of the new mesh lie", report.outside_nodes),
                                       report.farthest, at_point(report.farthest_at)));
  // Below that the volumes differ by rounding.
  constexpr double kToldOf = 1e-12;
  if (std::max(report.uncovered, report.lost) > kToldOf * report.volume_before)
    report.notes.push_back(fmt::format(
        "the bodies differ: {:.3g} of the new volume {:.6g} has no old element of its region, {:.3g} of the old volume "
        "{:.6g} no new one; {}",
        report.uncovered, report.volume_after, report.lost, report.volume_before,
        options.keep_integrals ? "what integrals lack is spread over the elements that changed"
                               : "integrals of elements change by that"));
  for (const FieldReport& field : report.fields)
    if (field.beyond > 0)
      report.notes.push_back(fmt::format(
          "the field \"{}\" leaves the range that it had by {:.3g}: in no other way could its integral stay where the "
          "volume of a region changed (see `keep_integrals`)",
          field.name, field.beyond));
}

class FieldCarrier {
 public:
  FieldCarrier(const adapt::MeshPair& meshes, const CarryOptions& options, OutsideNodes outside,
               const RunContext& context)
      : meshes_(meshes), options_(options), outside_(outside), context_(context), gone_(meshes) {}

  void carry(std::span<const MeshField> fields, CarriedFields& made) {
    kinds_ = kinds_of(fields, options_);
    for (const MeshField& field : fields) made.fields.push_back({field.name, field.of_elements, field.components, {}});
    carry_nodes(fields, made), carry_points(fields, made);
    std::vector<double> beyond = carry_elements(fields, made);
    for (std::size_t f = 0; f < fields.size(); ++f)
      made.report.fields.push_back(report_of_either(fields[f], meshes_.before, made.fields[f], meshes_.now,
                                                    meshes_.regions, kinds_[f] == Kind::kPoints));
    const JoinedFields all(fields, kinds_, Kind::kElements, 0);
    if (!beyond.empty())
      all.for_each_component(fields, [&](std::size_t f, std::size_t, std::size_t k) {
        made.report.fields[f].beyond = std::max(made.report.fields[f].beyond, beyond[k]);
      });
  }

 private:
  void carry_nodes(std::span<const MeshField> fields, CarriedFields& made) const {
    const JoinedFields all(fields, kinds_, Kind::kNodes, meshes_.before.points.size());
    if (all.components == 0) return;
    all.give(carried_at_nodes(meshes_, gone_, all.old(), outside_, options_, context_, made.report), made.fields);
  }

  void carry_points(std::span<const MeshField> fields, CarriedFields& made) const {
    for (std::size_t f = 0; f < fields.size(); ++f)
      if (kinds_[f] == Kind::kPoints)
        made.fields[f].values = carried_at_points(meshes_, gone_, {fields[f].values, fields[f].components}, options_,
                                                  context_, made.report);
  }

  std::vector<double> carry_elements(std::span<const MeshField> fields, CarriedFields& made) const {
    const JoinedFields all(fields, kinds_, Kind::kElements, meshes_.before.tets.size());
    if (all.components == 0) return {};
    std::vector<double> values = carried_of_elements(meshes_, gone_, all.old(), options_, context_, made.report);
    std::vector<double> beyond;
    if (options_.keep_integrals) beyond = spread_rest(meshes_, gone_, all.old(), values);
    all.give(values, made.fields);
    return beyond;
  }

  const adapt::MeshPair& meshes_;
  const CarryOptions& options_;
  OutsideNodes outside_;
  const RunContext& context_;
  adapt::GoneTets gone_;
  std::vector<Kind> kinds_;
};

}  // namespace

FieldReport report_of_field(const MeshField& old, const TetMesh& before, const MeshField& made, const TetMesh& now,
                            const CarryOptions& options) {
  return report_of_either(old, before, made, now, MatchedRegions(before, now), is_at_points(old, options));
}

CarriedFields carry_fields(std::span<const MeshField> fields, const TetMesh& before, const TetMesh& now,
                           const CarryOptions& options, const RunContext& context, OutsideNodes outside,
                           const KnownItems* same) {
  const ThreadLimit limit(context.threads);
  context.report("fields", -1);
  // Of a mesh that was adapted in part, the rest need not be valid.
  if (same == nullptr) require_valid_for_fields(before, "old", context), require_valid_for_fields(now, "new", context);
  for (const MeshField& field : fields) require_field_of(field, before);
  const MatchedRegions regions(before, now);
  adapt::SameItems found;
  if (same == nullptr) found = adapt::same_items(before, now, regions);
  const KnownItems items = same != nullptr ? *same : KnownItems{found.old_of_new, found.old_tet_of_new};
  const adapt::MeshPair meshes{before, now, regions, items};
  CarriedFields made{{}, report_of_meshes(meshes, found.several)};
  if (!fields.empty()) FieldCarrier(meshes, options, outside, context).carry(fields, made);
  note_what_differs(made.report, options);
  return made;
}

}  // namespace octafront
