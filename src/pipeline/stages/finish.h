#pragma once

// What follows improvement, as a list: each feature that does something to a mesh that is filled is one row of the
// table in finish.cpp, and stands there in the order in which they may follow each other.

#include "pipeline/stages/stages.h"

namespace octafront {

class Fins;

/// A mesh that is improved, and what it was made of.
struct Finishing {
  const Domain& domain;
  const Prepared& input;
  Filled& filled;
  Fins* fins;  ///< of the domain's lines and points, which it has as sheets; null: it has none
  Run& run;
};

/// Does to the mesh all that the run asks for. Where a part of that looks at elements of all ranks together, each gets
/// them all. Throws OptionError for names that are not there, MeshingError for what is too far from the input.
void finish(const Finishing& made);

/// Adds the sets that Options::groups asks for, in the place of those that name_parts() made of what has no name.
/// `geometry`: null, if it is not known.
void add_groups(const TrueGeometry* geometry, TetMesh& mesh, Run& run);

/// What the report says of the mesh when it is finished.
void describe(const Finishing& made);

}  // namespace octafront
