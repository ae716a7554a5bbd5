#pragma once

#include <octafront/quality.h>
#include <octafront/tet_mesh.h>

#include "session.h"

#include <string>

namespace octafront::cli {

/// [x, y, z]
Json place(Vec3 p);

/// "12 tetrahedra; least beta ..."
std::string quality_in_words(const QualitySummary& quality);

/// The worst element in words, the worst twenty for programs.
void tell_worst(Session& session, const std::vector<PoorElement>& worst);
inline constexpr std::size_t kWorstListed = 20;

/// Counts, quality, worst elements and groups of a mesh that was read; `what` it is, such as "a valid mesh".
void tell_mesh(Session& session, const TetMesh& mesh, const std::string& what);

}  // namespace octafront::cli
