#include <octafront/generate.h>

#include "base/mesh/complex.h"
#include "base/places/places.h"
#include "base/places/shape_place.h"
#include "pipeline/stages/contact_choice.h"
#include "pipeline/stages/true_shape.h"

namespace octafront {
namespace {

bool is_found(const TrueGeometry& geometry, const std::string& place) {
  const FoundShapes found = geometry.find(place);
  return !found.parts.empty() || !found.lines.empty() || !found.points.empty();
}

/// A place of CAD that says what it is like is a group of that name; where nothing is like that there is none.
void add_groups(const Domain& domain, const Options& options, std::vector<std::string>& sets) {
  for (const std::string& text : options.groups) {
    const GroupRule rule = group_rule(text);
    if (!shape_place_of(rule.name) || (domain.geometry && is_found(*domain.geometry, rule.name)))
      sets.push_back(rule.name);
  }
}

std::vector<std::string> sides_of_contacts(const Domain& domain) {
  std::vector<std::string> sides;
  for (const PartContact& contact : contacts_of(domain)) {
    if (contact.way == ContactWay::kShared) continue;
    const auto [a, b] = contact.regions;
    for (std::string& side :
         names_of_sides(contact.name, region_name(domain.surface, a), region_name(domain.surface, b)))
      sides.push_back(std::move(side));
  }
  return sides;
}

}  // namespace

PlaceNames expected_place_names(const Domain& domain, const Options& options) {
  const SurfaceMesh surface = divided(domain.surface);
  const SurfacePlaces places(surface);
  PlaceNames names{places.regions(), places.patches(), {}, {}, sides_of_contacts(domain)};
  if (domain.geometry) {
    const std::vector<std::string> parts = patches_of_parts(*domain.geometry).names;
    names.patches.insert(names.patches.begin(), parts.begin(), parts.end());
    for (const PartGroup& group : domain.geometry->groups()) names.sets.push_back(group.name);
  }
  for (const LineNet& wire : domain.wires) names.curves.push_back(wire.name);
  for (const PointSet& points : domain.points) names.sets.push_back(points.name);
  for (const PlacedSet& set : domain.sets) names.sets.push_back(set.name);
  add_groups(domain, options, names.sets);
  return names;
}

}  // namespace octafront
