#pragma once

// The job behind a mesh, as each solver is told it.

#include <octafront/vec.h>

#include "formats/containers/text_writer.h"
#include "formats/jobs/job_plan.h"
#include "formats/parts/mesh_output.h"
#include "formats/parts/mesh_parts.h"
#include "formats/parts/mixed_cells.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace octafront::io {

/// What the lines of a job call what is in the file.
struct AbaqusNames {
  std::vector<std::string> parts;                       ///< as MeshParts has them
  std::function<std::string(const std::string&)> more;  ///< a legal name that nothing else has
  std::uint64_t first_node = 0;                         ///< that nothing has
};

/// Sections, supports, contacts and steps behind a mesh.
void write_abaqus_job(TextWriter& text, const MeshParts& mesh, const JobPlan& plan, const AbaqusNames& names,
                      bool has_sections);

/// Materials, contacts, supports and loads of a static analysis behind a mesh, then its solution and reactions.
/// `names`: of the components, as MeshParts has the parts. Throws OptionError for what is not written.
void write_ansys_job(TextWriter& text, const MeshParts& mesh, const MixedCells& cells, const JobPlan& plan,
                     const std::vector<std::string>& names);

/// What groups of a MED file are called that a job names, no two alike.
struct AsterNames {
  struct Point {
    std::string name;
    Vec3 at;
  };
  std::vector<std::string> parts;  ///< as MeshParts has them
  std::vector<Point> points;       ///< reference points: nodes behind the others, each a group
  std::vector<std::string> ties;   ///< of JobPlan::contacts: for nodes of the slave that nothing else holds
};
AsterNames aster_names(MeshOutput& out, const MeshParts& mesh, const JobPlan& plan);

/// Commands of code_aster for linear statics beside a MED file, and the .export that says which file is which. Throws
/// OptionError for what they do not say.
void write_aster_job(MeshOutput& out, const MeshParts& mesh, const JobPlan& plan, const AsterNames& names);

/// Of linear statics: what stands before the bulk data. Throws OptionError for what no bulk data of all Nastrans says.
void write_nastran_control(TextWriter& text, const MeshParts& mesh, const JobPlan& plan);
/// Materials, supports and loads as bulk data. `next_element`: a number that no element has.
void write_nastran_job(TextWriter& text, const MeshParts& mesh, const JobPlan& plan, std::uint64_t next_element);
/// The coordinate system of a node's displacements: 0 or that of a cylinder.
std::uint64_t nastran_system_of(const JobPlan& plan, VertexIndex node);

}  // namespace octafront::io
