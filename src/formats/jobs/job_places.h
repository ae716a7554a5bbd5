#pragma once

#include <octafront/solver_job.h>
#include <octafront/tet_mesh.h>

#include "base/places/places.h"
#include "formats/jobs/job_plan.h"
#include "formats/parts/mesh_parts.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace octafront::io {

/// What a place is as one set: faces where they are wanted; else of the one kind that there is, or nodes.
struct PlaceSet {
  NamedSet::Kind kind;
  std::vector<std::uint32_t> members;  ///< ascending
};

/// The places of a job in a mesh. `option` is who asks, in messages; all throw OptionError where there is no such
/// place, or nothing of what is wanted. Refers to all that it is given.
class JobPlaces {
 public:
  JobPlaces(const TetMesh& mesh, const MeshParts& parts, const SolverJob& job)
      : mesh_(mesh), parts_(parts), job_(job) {}

  PlaceSet faces(std::string_view option, const std::string& place) const;
  PlaceSet anything(std::string_view option, const std::string& place) const;
  std::vector<std::uint32_t> regions(std::string_view option, const std::string& place) const;
  /// What the mesh calls it; its number among the parts.
  std::optional<std::size_t> part(const PlaceSet& set) const;
  /// The coupling of this name.
  std::optional<std::size_t> point(const std::string& name) const;
  /// visit(place, what it is) for each that is no reference point.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (const JobFix& fix : job_.fixes)
      if (!point(fix.place))
        visit(fix.place, fix.of_cylinder.empty() ? anything("fix", fix.place) : faces("fix", fix.place));
    for (const JobLoad& load : job_.loads)
      if (!point(load.place)) visit(load.place, faces("load", load.place));
    for (const JobPressure& p : job_.pressures) visit(p.place, faces("pressure", p.place));
    for (const JobCoupling& c : job_.couplings) visit(c.place, faces("couple", c.place));
  }

 private:
  MeshItems items(std::string_view option, const std::string& place) const;
  PlaceSet nodes_of(const MeshItems& all) const;

  const TetMesh& mesh_;
  const MeshParts& parts_;
  const SolverJob& job_;
};

class MeshOutput;

/// Young's modulus where nothing is said: of steel in N, mm and t.
inline constexpr double kSteelYoung = 210000;

/// Plans the materials of a job and which of them each region is of, with a density for each that the input knows one
/// of; regions that have none get steel, with a note. Throws OptionError for a place that there is not.
void plan_materials(MeshOutput& out, const MeshParts& mesh, const SolverJob& job, const JobPlaces& places,
                    JobPlan& plan);

}  // namespace octafront::io
