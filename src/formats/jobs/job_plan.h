#pragma once

#include <octafront/solver_job.h>
#include <octafront/vec.h>

#include "formats/parts/mesh_output.h"
#include "formats/parts/mesh_parts.h"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace octafront::io {

/// The axis of a cylinder, a point on it in its middle, its radius, and how far it reaches to both sides.
struct Cylinder {
  Vec3 middle, axis;
  double radius = 0, half_length = 0;
};

/// The cylinder that triangles lie on; none where they lie on no cylinder, within a fiftieth of the radius.
std::optional<Cylinder> cylinder_of(std::span<const std::array<Vec3, 3>> triangles);

/// Parts of a vector at a point: radial, tangential, axial.
Vec3 in_system_of(const Cylinder& cylinder, Vec3 at, Vec3 vector);
/// Whether two have the same axis, as closely as facets tell.
bool share_axis(const Cylinder& a, const Cylinder& b);

// formats/jobs: a job of a solver (octafront/solver_job.h) as it meets a mesh: places become parts, forces shares of
// nodes, bolts sections. Writers put it into the words of their solvers.

/// Of an evenly spread force the share of each node, by shape functions: of all together 1. Ascending.
using NodeShares = std::vector<std::pair<VertexIndex, double>>;

/// Parts are indices into MeshParts::parts().
struct JobPlan {
  struct Fix {
    std::size_t part = 0;
    std::array<bool, 3> holds{};  ///< x, y, z; of a cylinder: radial, tangential, axial
    std::optional<Cylinder> cylinder;
    /// Nodes that another's cylinder has, and what is held of them in its directions.
    std::vector<std::pair<VertexIndex, std::array<bool, 3>>> turned = {};
  };
  struct Load {
    std::size_t part = 0;
    Vec3 force;
  };
  struct Pressure {
    std::size_t part = 0;
    double value = 0;
  };
  struct Contact {
    std::size_t slave = 0, master = 0;
    std::optional<double> friction;
    double edge = 0, young = 0;  ///< mean length of edges of the slave; the softer of the two materials
    double apart = 0;            ///< how far the slave's nodes may be from the master
  };
  struct Pretension {
    std::size_t region = 0;
    double force = 0;
    Vec3 middle, axis;
    std::vector<std::pair<VertexIndex, VertexIndex>>
        nodes;  ///< in front of the section, as its axis points, and behind
  };
  struct Coupling {
    std::string name;
    std::size_t part = 0;
    Vec3 at = {};
    bool is_rigid = true;
    std::array<bool, 6> holds{};
    std::optional<Vec3> force = {};
  };

  std::vector<JobMaterial> materials;
  std::vector<std::size_t> material_of;  ///< per region among MeshParts::parts(Origin::kRegion)
  std::vector<Fix> fixes;
  std::map<VertexIndex, std::size_t> systems;  ///< nodes whose directions are those of a cylinder: of which fix
  std::vector<Load> loads;
  std::map<VertexIndex, Vec3> forces;  ///< of all loads together
  std::vector<Pressure> pressures;
  std::vector<Contact> contacts;
  std::vector<Pretension> pretensions;
  std::vector<Coupling> couplings;
  std::optional<Vec3> gravity;

  bool has_loads() const;
  bool slides() const;  ///< some contact has friction
};

/// Where a bolt is open: a patch of the boundary in front, as its axis points, and one behind.
struct BoltSection {
  std::uint32_t region = 0;
  double force = 0;
  Vec3 middle, axis;
  std::uint32_t in_front = 0;
};

/// A mesh as a job needs it: with bolts open in their sections, and the sets that places need.
struct JobMesh {
  std::optional<TetMesh> changed;  ///< none: it lacks nothing
  std::vector<BoltSection> sections;
};
/// Throws OptionError for a place that there is not.
JobMesh mesh_for_job(const TetMesh& mesh, const SolverJob& job);

/// `sections`: of mesh_for_job(). Notes what a user must know. Throws OptionError for what cannot be.
JobPlan plan_job(MeshOutput& out, const MeshParts& mesh, const SolverJob& job,
                 const std::vector<BoltSection>& sections);

/// The regions that neither nodes nor contacts, couplings or bolts join to what is held: "\"lid\", \"pin\""; empty if
/// nothing is held.
std::string loose_parts(const MeshParts& mesh, const JobPlan& plan);

/// The shares of nodes in a force on faces.
NodeShares shares_of(const MeshParts& mesh, const Part& part);
/// The area of faces, as these shares have it.
double area_of(const MeshParts& mesh, const Part& part);
/// A force as a node has it, where a cylinder turns its directions.
Vec3 as_node_has_it(const JobPlan& plan, const MeshParts& mesh, VertexIndex node, Vec3 force);
/// Where pressures are written on tetrahedra alone, by this `card`. Throws OptionError.
void refuse_pressure_on_wedges(const MeshParts& mesh, const JobPlan& plan, std::string_view card);

/// Opens a bolt, as near to the middle of its largest cylinder as a section leaves nodes of these patches and of other
/// regions alone. Throws OptionError.
BoltSection open_bolt(TetMesh& mesh, std::uint32_t region, const std::vector<std::uint32_t>& tied);
/// The triangles of a part of faces.
std::vector<std::array<Vec3, 3>> triangles_of(const MeshParts& mesh, const Part& part);

}  // namespace octafront::io
