#include <octafront/error.h>
#include <octafront/named_groups.h>
#include <octafront/split.h>

#include "base/core/disjoint_sets.h"
#include "base/core/renumber.h"
#include "base/core/wording.h"
#include "base/mesh/complex.h"
#include "base/mesh/complex_patches.h"
#include "base/mesh/edge_table.h"
#include "base/mesh/joined.h"
#include "base/places/places.h"
#include "pipeline/stages/contact_choice.h"
#include "pipeline/stages/finish.h"
#include "pipeline/stages/true_shape.h"
#include "sizing/sources/sources.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>
#include <set>
#include <utility>

#include <fmt/format.h>

namespace octafront {
namespace {

/// The regions in groups that contacts hold together, by their lowest regions.
std::vector<std::vector<std::uint32_t>> regions_together(std::uint32_t count,
                                                         const std::vector<PartContact>& contacts) {
  DisjointSets sets(count);
  for (const PartContact& contact : contacts)
    if (contact.way != ContactWay::kSeparate) sets.join(contact.regions[0], contact.regions[1]);
  std::map<std::uint32_t, std::vector<std::uint32_t>> groups;
  for (std::uint32_t r = 0; r < count; ++r) groups[sets.find(r)].push_back(r);
  std::vector<std::vector<std::uint32_t>> together;
  for (auto& [first, regions] : groups) together.push_back(std::move(regions));
  return together;
}

template <class T>
std::vector<T> those(const std::vector<T>& all, const std::vector<std::uint32_t>& regions) {
  std::vector<T> some;
  for (const std::uint32_t r : regions)
    if (r < all.size()) some.push_back(all[r]);
  return some;
}

/// Takes the walls of some regions from the whole, whose surface is divided by sides.
SurfaceMesh surface_of(const SurfaceMesh& whole, const std::vector<std::uint32_t>& regions,
                       std::vector<std::uint32_t>& from) {
  std::vector<std::uint32_t> now(region_count(whole), kNone);
  for (std::uint32_t k = 0; k < regions.size(); ++k) now[regions[k]] = k;
  SurfaceMesh part;
  part.points = whole.points, part.patch_names = whole.patch_names, part.patch_labels = whole.patch_labels;
  for (std::uint32_t t = 0; t < whole.triangles.size(); ++t) {
    Sides sides = whole.sides_of(t);
    for (std::uint32_t& side : sides) side = side == kNone ? kNone : now[side];
    if (sides == Sides{kNone, kNone}) continue;
    from.push_back(t);
    part.triangles.push_back(whole.triangles[t]);
    part.patch.push_back(whole.patch_of(t));
    part.source.push_back(whole.source_of(t));
    part.sides.push_back(sides);
  }
  for (const std::uint32_t r : regions) part.region_names.push_back(region_name(whole, r));
  part.region_labels = those(whole.region_labels, regions);
  face_lower_regions_behind(part);
  drop_unused_points(part.points, part.triangles);
  return part;
}

/// What holds parts together stays shared, or is opened.
ContactChoice contacts_within(const std::vector<PartContact>& contacts, const std::vector<std::uint32_t>& regions) {
  const auto has = [&](std::uint32_t r) { return std::ranges::binary_search(regions, r); };
  ContactChoice choice;
  // A name means its pieces too, whose own names come later.
  for (const PartContact& c : contacts)
    if (has(c.regions[0]) && has(c.regions[1]))
      choice.rules.push_back({c.name, c.way == ContactWay::kShared ? c.way : ContactWay::kSplit});
  return choice;
}

Domain domain_of(const Domain& whole, const std::vector<PartContact>& contacts,
                 const std::vector<std::uint32_t>& regions) {
  Domain part;
  std::vector<std::uint32_t> from;
  part.surface = surface_of(whole.surface, regions, from);
  if (!whole.bound.empty())
    for (const std::uint32_t t : from) part.bound.push_back(whole.bound[t]);
  part.voxel_spacing = whole.voxel_spacing, part.voxels = whole.voxels;
  part.sets = whole.sets;
  part.geometry = whole.geometry;
  part.true_volumes = those(whole.true_volumes, regions);
  part.chord_depths = those(whole.chord_depths, regions);
  part.volumes = those(whole.volumes, regions);
  part.densities = whole.densities, part.unit = whole.unit, part.frame = whole.frame, part.format = whole.format;
  part.contacts = contacts_within(contacts, regions);
  return part;
}

/// What is asked at places, where a part has them. Of what no part has the whole says what there is.
class PlacesOfParts {
 public:
  PlacesOfParts(const SurfaceMesh& whole, const std::vector<Domain>& parts) {
    for (const Domain& part : parts) parts_.push_back(std::make_unique<Known>(part.surface));
    parts_.push_back(std::make_unique<Known>(whole));
    for (const auto* list : {&parts_.back()->places.patches(), &parts_.back()->places.regions()})
      known_.insert(known_.end(), list->begin(), list->end());
  }

  /// The options for a part, which gets this share of the elements; `groups`: places of CAD that the mesh shall know.
  Options options_of(std::size_t part, Options options, double share, const std::vector<std::string>& groups) {
    const auto lacks = [&](const char* option, const std::string& place) { return !has(part, option, place); };
    std::erase_if(options.size.named, [&](const NamedSize& s) { return lacks("size_of", s.name); });
    std::erase_if(options.size.near, [&](const NearSize& s) { return !s.name.empty() && lacks("size_near", s.name); });
    take_places_in_space(options.size);
    const Box3 box = bounding_box(parts_[part]->surface.points);
    std::erase_if(options.size.regions, [&](const SizeRegion& r) {
      const Vec3 around{r.radius, r.radius, r.radius};
      return !box.overlaps({r.lo - around, r.hi + around});
    });
    const bool on_some = !options.layers.on.empty(), in_some = !options.layers.in.empty();
    options.layers.on = listed(part, "on", options.layers.on);
    options.layers.in = listed(part, "in", options.layers.in);
    if ((on_some && options.layers.on.empty()) || (in_some && options.layers.in.empty())) options.layers = {};
    options.split = split_inside(part, options.split);
    if (options.size.elements)
      options.size.elements =
          std::max<std::int64_t>(1, std::llround(share * static_cast<double>(*options.size.elements)));
    options.groups.clear();
    for (const std::string& place : groups) options.groups.push_back(place + "=" + place);
    return options;
  }

  void refuse_unknown() const {
    for (const auto& [option, place] : asked_) {
      if (found_.contains(place)) continue;
      parts_.back()->places.at(option, place_of(option, place));
      throw OptionError(
          fmt::format("`{}`: \"{}\" lies where parts come apart; name a face or a part there", option, place));
    }
  }

 private:
  struct Known {
    explicit Known(const SurfaceMesh& of)
        : surface(of), edges(make_edge_table(of.points.size(), of.triangles)), places(of, &edges) {}
    const SurfaceMesh& surface;
    EdgeTable edges;
    SurfacePlaces places;
  };

  bool has(std::size_t part, const char* option, const std::string& place) {
    asked_.insert({option, place});
    try {
      parts_[part]->places.at(option, place_of(option, place));
    } catch (const OptionError&) {
      return false;
    }
    found_.insert(place);
    return true;
  }

  std::string listed(std::size_t part, const char* option, const std::string& list) {
    std::string some;
    for (const Place& place : places_listed(option, list, ',', known_))
      if (has(part, option, place.text)) some += (some.empty() ? "" : ",") + place.text;
    return some;
  }

  /// Those that lie inside of a part: what comes apart is open already.
  std::string split_inside(std::size_t part, const std::string& list) {
    std::string some;
    for (const std::string& name : names_listed(list, known_)) {
      if (!has(part, "split", name)) continue;
      try {
        check_split(parts_[part]->surface, {name});
      } catch (const OptionError&) {
        continue;
      }
      some += (some.empty() ? "" : ",") + name;
    }
    return some;
  }

  std::vector<std::unique_ptr<Known>> parts_;  ///< and the whole
  std::vector<std::string> known_;
  std::set<std::pair<std::string, std::string>> asked_;
  std::set<std::string> found_;
};

/// Both sides of a separate contact get their names; returns the pairs.
std::set<std::pair<std::string, std::string>> name_sides(std::vector<TetMesh>& meshes,
                                                         const std::vector<std::vector<std::uint32_t>>& together,
                                                         const std::vector<PartContact>& contacts,
                                                         const SurfaceMesh& whole) {
  std::set<std::pair<std::string, std::string>> pairs;
  for (std::size_t k = 0; k < meshes.size(); ++k)
    for (const PartContact& c : contacts) {
      const auto is_here = [&](std::uint32_t r) { return std::ranges::binary_search(together[k], r); };
      const auto [a, b] = c.regions;
      if (is_here(a) == is_here(b)) continue;
      const auto sides = names_of_sides(c.name, region_name(whole, a), region_name(whole, b));
      std::ranges::replace(meshes[k].patch_names, c.name, is_here(a) ? sides[0] : sides[1]);
      pairs.insert({sides[0], sides[1]});
    }
  return pairs;
}

void list_contacts(TetMesh& mesh, const std::set<std::pair<std::string, std::string>>& pairs) {
  const auto number = [&](const std::string& name) {
    return static_cast<std::uint32_t>(std::ranges::find(mesh.patch_names, name) - mesh.patch_names.begin());
  };
  for (const auto& [first, second] : pairs)
    if (std::max(number(first), number(second)) < mesh.patch_names.size())
      mesh.opened_contacts.push_back({number(first), number(second), 0});
  std::ranges::stable_sort(mesh.opened_contacts, {}, &OpenedContact::first);
}

void add(SizeSummary& all, const SizeSummary& more) {
  if (more.edges == 0) return;
  const auto mean = [&](double a, double b) {
    return (a * static_cast<double>(all.edges) + b * static_cast<double>(more.edges)) /
           static_cast<double>(all.edges + more.edges);
  };
  all.mean_ratio = mean(all.mean_ratio, more.mean_ratio);
  all.share_within = mean(all.share_within, more.share_within);
  all.edges += more.edges;
}

/// `first_tet`: of the part in the whole.
void add(SecondOrderSummary& all, const SecondOrderSummary& more, TetIndex first_tet) {
  if (more.least_tet != kNone && (all.least_tet == kNone || more.least_scaled_jacobian < all.least_scaled_jacobian)) {
    all.least_scaled_jacobian = more.least_scaled_jacobian;
    all.least_tet = first_tet + more.least_tet;
  }
  all.edges += more.edges, all.curved += more.curved, all.eased += more.eased, all.straight += more.straight;
  all.moved += more.moved, all.held += more.held, all.eased_faces += more.eased_faces;
  all.largest_bend = std::max(all.largest_bend, more.largest_bend);
}

/// Stages of one name become one; what they say is said with the part's name.
void add_stages(std::vector<StageReport>& all, const StageReport& more, const std::string& part) {
  auto at = std::ranges::find(all, more.name, &StageReport::name);
  if (at == all.end()) at = all.insert(at, StageReport{.name = more.name, .counters = {}, .notes = {}, .findings = {}});
  at->wall_seconds += more.wall_seconds, at->cpu_seconds += more.cpu_seconds;
  for (const auto& [key, value] : more.counters) {
    const auto counter = std::ranges::find(at->counters, key, [](const auto& c) { return c.first; });
    if (counter == at->counters.end())
      at->count(key, value);
    else
      counter->second += value;
  }
  if (more.name == "groups") return;  // The whole has them.
  for (const std::string& note : more.notes) at->notes.push_back(part + ": " + note);
  for (Finding finding : more.findings) {
    finding.text = part + ": " + finding.text;
    at->findings.push_back(std::move(finding));
  }
}

void add_report(Report& all, const Report& part, const std::string& name, TetIndex first_tet) {
  for (const StageReport& stage : part.stages) add_stages(all.stages, stage, name);
  all.bodies += part.bodies;
  all.input_volume += part.input_volume, all.expected_tets += part.expected_tets;
  all.layers.insert(all.layers.end(), part.layers.begin(), part.layers.end());
  all.walls.insert(all.walls.end(), part.walls.begin(), part.walls.end());
  add(all.second_order, part.second_order, first_tet);
  add(all.surface_edges, part.surface_edges);
  add(all.volume_edges, part.volume_edges);
}

/// The volumes of regions, which the reports of parts know with what they are compared with.
void take_volumes(Report& all, const std::vector<Report>& parts, const std::vector<std::string>& names) {
  all.volume = 0;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    all.volume += parts[k].volume, all.true_volume += parts[k].true_volume;
    std::vector<RegionSummary> regions = parts[k].regions;
    if (regions.empty())
      regions.push_back({names[k], parts[k].volume, 0, parts[k].input_volume, parts[k].true_volume, 0, {}});
    for (const RegionSummary& of_part : regions) {
      const auto at = std::ranges::find(all.regions, of_part.name, &RegionSummary::name);
      if (at == all.regions.end()) continue;
      const QualitySummary quality = at->quality;
      *at = of_part;
      at->quality = quality;
    }
  }
}

/// At each place the smallest size of the parts whose boxes hold it, or of all.
SizeField sizes_of(const std::vector<SizeField>& sizes, const std::vector<Box3>& boxes) {
  double lo = HUGE_VAL, hi = 0;
  for (const SizeField& s : sizes) lo = std::min(lo, s.min_size()), hi = std::max(hi, s.max_size());
  const auto at = [sizes, boxes](Vec3 p) {
    double here = HUGE_VAL, anywhere = HUGE_VAL;
    for (std::size_t k = 0; k < sizes.size(); ++k) {
      const double size = sizes[k].at(p);
      anywhere = std::min(anywhere, size);
      if (boxes[k].contains(p)) here = std::min(here, size);
    }
    return std::isfinite(here) ? here : anywhere;
  };
  return SizeField::from_function(at, lo, hi);
}

void refuse_unfit(const Domain& domain, const Options& asked, const RunContext& context) {
  if (context.ranks != nullptr && context.ranks->size() > 1)
    throw OptionError("`contacts` separate meshes parts one by one, which ranks do not share: run it in one process");
  if (!asked.periodic.empty()) throw OptionError("`contacts` separate does not go with `periodic`: give split");
  if (!domain.wires.empty() || !domain.points.empty())
    throw OptionError("`contacts` separate does not go with lines and points inside: give split");
}

/// Parts that are meshed one by one, and what has become of them.
class PartsApart {
 public:
  PartsApart(const Domain& domain, const std::vector<PartContact>& contacts) : contacts_(contacts), whole_(domain) {
    divide_by_sides(whole_.surface);
    for (std::uint32_t r = 0; r < region_count(whole_.surface); ++r)
      named_.region_names.push_back(region_name(whole_.surface, r));
    named_.region_labels = whole_.surface.region_labels;
    together_ = regions_together(region_count(whole_.surface), contacts);
    for (const auto& regions : together_) {
      parts_.push_back(domain_of(whole_, contacts, regions));
      names_.push_back(named_.region_names[regions[0]] + (regions.size() > 1 ? " ..." : ""));
    }
  }

  /// For each part. Throws OptionError for places that no part has.
  std::vector<Options> options_by_part(const Options& asked) const {
    std::vector<std::string> groups;
    if (whole_.geometry) groups = places_without_names(*whole_.geometry, asked.groups, named_);
    PlacesOfParts places(whole_.surface, parts_);
    std::vector<Options> by_part;
    const std::vector<double> shares = shares_of_volume();
    for (std::size_t k = 0; k < parts_.size(); ++k)
      by_part.push_back(places.options_of(k, options_for(parts_[k], asked), shares[k], groups));
    places.refuse_unknown();
    return by_part;
  }

  void mesh(const std::vector<Options>& by_part, const MakePart& make) {
    TetIndex first_tet = 0;
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      Result made = make(parts_[k], by_part[k]);
      add_report(report_, made.report, names_[k], first_tet);
      first_tet += static_cast<TetIndex>(made.mesh.tets.size());
      boxes_.push_back(bounding_box(made.mesh.points)), sizes_.push_back(made.sizes);
      meshes_.push_back(std::move(made.mesh)), reports_.push_back(std::move(made.report));
    }
  }

  /// The meshes as one.
  Result joined(const Options& asked, const RunContext& context) {
    Run run(asked, context);
    run.report = std::move(report_);
    TetMesh mesh = run.stage("contacts", [&](const Stage& stage) { return join(stage); });
    check_result(mesh, nullptr, run);
    if (!asked.groups.empty()) add_groups(whole_.geometry.get(), mesh, run);
    run.stage("summary", [&](const Stage&) {
      describe(mesh, run.report);
      take_volumes(run.report, reports_, names_);
    });
    return {std::move(mesh), sizes_of(sizes_, boxes_), run.close()};
  }

 private:
  /// Places of CAD by the names that they have in a part; what is split, by those of the whole.
  Options options_for(const Domain& part, Options asked) const {
    if (!part.geometry) return asked;
    const std::string split = options_for_geometry(whole_, asked).split;
    asked.split.clear();
    asked = options_for_geometry(part, asked);
    asked.split = split;
    return asked;
  }

  std::vector<double> shares_of_volume() const {
    const std::vector<double> volumes = volumes_of_regions(whole_.surface);
    std::vector<double> shares;
    for (const auto& regions : together_) {
      shares.push_back(0);
      for (const std::uint32_t r : regions) shares.back() += volumes[r];
    }
    const double all = std::accumulate(shares.begin(), shares.end(), 0.0);
    for (double& share : shares) share /= all;
    return shares;
  }

  TetMesh join(const Stage& stage) {
    const auto pairs = name_sides(meshes_, together_, contacts_, whole_.surface);
    TetMesh mesh = joined_meshes(std::move(meshes_), std::move(named_));
    list_contacts(mesh, pairs);
    stage.note(fmt::format("{} meshed apart; {} triangles of their own on both sides",
                           counted(parts_.size(), "part is", "parts are"),
                           counted(pairs.size(), "contact has", "contacts have")));
    return mesh;
  }

  const std::vector<PartContact>& contacts_;
  Domain whole_;   ///< its surface divided by sides
  TetMesh named_;  ///< with the names of its regions
  std::vector<std::vector<std::uint32_t>> together_;
  std::vector<Domain> parts_;
  std::vector<std::string> names_;
  std::vector<TetMesh> meshes_;
  std::vector<Report> reports_;
  std::vector<SizeField> sizes_;
  std::vector<Box3> boxes_;
  Report report_;
};

}  // namespace

Result generate_apart(const Domain& domain, const std::vector<PartContact>& contacts, const Options& asked,
                      const RunContext& context, const MakePart& make) {
  refuse_unfit(domain, asked, context);
  PartsApart parts(domain, contacts);
  parts.mesh(parts.options_by_part(asked), make);
  return parts.joined(asked, context);
}

}  // namespace octafront
