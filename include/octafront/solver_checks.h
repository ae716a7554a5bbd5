#pragma once

#include <octafront/no_context.h>
#include <octafront/tet_mesh.h>
#include <octafront/vec.h>

#include <cstdint>
#include <string>
#include <vector>

namespace octafront {

enum class Solver { kAbaqus, kAnsys, kNastran, kCalculix };

/// One documented limit of a solver, and the elements beyond it. Limits and their sources: docs/use/solver-checks.md.
struct SolverFinding {
  std::string measure;   ///< e.g. "aspect ratio"
  bool refused = false;  ///< the solver stops; else it warns
  bool above = false;    ///< elements above `limit` are listed; else those below (or at it, where the limit is 0)
  double limit = 0;
  struct Element {
    TetIndex tet = kNone;
    Vec3 at;  ///< its centre
    double value = 0;
  };
  std::uint64_t count = 0;
  std::vector<Element> worst;  ///< the ten worst of them, the worst one first
};

/// What a solver would warn of or refuse, by its documented default limits: every limit that it has for tetrahedra of
/// the mesh's order, also those that no element breaks (count 0). REQUIRES indices in range. In parallel, about a
/// second per million elements and thread.
std::vector<SolverFinding> check_for_solver(const TetMesh& mesh, Solver solver,
                                            const RunContext& context = no_context());

}  // namespace octafront
