#pragma once

#include <octafront/mesh_field.h>
#include <octafront/options.h>
#include <octafront/run_context.h>
#include <octafront/tet_mesh.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace octafront {

/// What a node of the new mesh gets that lies outside the old one.
enum class OutsideNodes {
  kNearest,  ///< the value at the nearest place of the old boundary: no new extremes
  kOnwards,  ///< the linear function of the nearest old element, at most as far out as that is high: exact for linear
             ///< functions; for meshes that stand for the same curved body
};

/// Of the numbers of a field, one each for its components.
struct FieldExtent {
  /// Of elements the sum of value times volume; of nodes the integral of the linear interpolant.
  std::vector<double> integral;
  std::vector<double> least, greatest;
};

/// What became of a field.
struct FieldReport {
  std::string name;
  bool of_elements = false;
  std::size_t components = 1;
  FieldExtent before, after;
  /// Of elements the greatest change of the integral over a region, over the integral of the absolute value there.
  double integral_error = 0;
  /// How far values of elements had to leave the range of their region: only where the region's volume changed such
  /// that no values within the range have the old integral; then all are shifted by the same.
  double beyond = 0;
};

/// What became of all fields, and how the meshes lie to each other.
struct CarryReport {
  std::uint64_t nodes = 0, elements = 0;                ///< of the new mesh
  std::uint64_t copied_nodes = 0, copied_elements = 0;  ///< those that the old mesh has, too
  double volume_before = 0, volume_after = 0;
  /// Of the new mesh what no old element of the region covers, and the other way round; of no fields of elements 0.
  double uncovered = 0, lost = 0;
  std::uint64_t outside_nodes = 0;  ///< by exact sign; of no fields at nodes 0
  double farthest = 0;              ///< how far they are from the old boundary; input units
  Vec3 farthest_at;
  bool by_region = true;  ///< false: the regions of both meshes do not match, and both are taken as one body each
  std::vector<FieldReport> fields;
  std::vector<std::string> notes;
};

/// As JSON, keys as the members above: how the meshes lie to each other, and the list of the fields.
std::string to_json(const CarryReport& report);
std::string to_json(const std::vector<FieldReport>& fields);

/// What became of a field that went from one mesh to the other: what carry_fields() tells of those that it carries.
FieldReport report_of_field(const MeshField& old, const TetMesh& before, const MeshField& made, const TetMesh& now,
                            const CarryOptions& options = {});

struct CarriedFields {
  std::vector<MeshField> fields;
  CarryReport report;
};

/// Which items of the new mesh are those of the old one, where that is known: as AdaptedMesh has them.
struct KnownItems {
  std::span<const VertexIndex> old_of_new;
  std::span<const TetIndex> old_tet_of_new;
};

/// Fields of one mesh on another, of the same body or of one that differs.
///
/// At nodes linear in the old element that holds the node, by exact signs; a node that is where one was has its bits.
/// Of elements conservative: an element gets the mean of what old ones of its region have where both are, by
/// intersection; one that is the same gets its bits. The sum of value times volume in each region stays, to rounding,
/// and no value is outside of the range that the region had, as long as the volumes of the region allow that: where the
/// bodies differ, what a region lacks is spread over its elements that changed, first within that range. Components go
/// by themselves.
///
/// With options.quadratic_nodes fields at nodes are quadratic in old elements, which bend where they are of second
/// order; options.integration_points names fields that have four values in each element: linear there, carried as their
/// mean and the differences at the new points.
///
/// Regions are those of the same name, or without names of the same number. Otherwise meshes of second order are taken
/// as linear ones: mid-side nodes of the new one get values like others, those of the old one have no say. `same`:
/// which items stayed, and both meshes are valid where others are; null: found by their coordinates. The values are the
/// same for any number of threads.
///
/// Example: carry_fields(read_fields("old.vtu", old).fields, old, read_mesh("new.msh")).fields.
///
/// Throws InputError for a mesh that is not valid, a field of another length or with values that are not finite;
/// Cancelled. Cost: about as docs/measured/carry.md says; memory of some 200 bytes an element.
CarriedFields carry_fields(std::span<const MeshField> fields, const TetMesh& before, const TetMesh& now,
                           const CarryOptions& options = {}, const RunContext& context = {},
                           OutsideNodes outside = OutsideNodes::kNearest, const KnownItems* same = nullptr);

}  // namespace octafront
