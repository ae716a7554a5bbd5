#pragma once

#include <octafront/complex.h>
#include <octafront/inside.h>

#include "soup/cells/misfit.h"

#include <optional>
#include <vector>

namespace octafront::cells {

/// As join_bodies() if of two bodies that have space in common, slivers apart, one always lies within the other; else
/// nullopt.
std::optional<Complex> nested_bodies(const std::vector<Body>& bodies, const ComplexOptions& options,
                                     const ElementsToCome& elements, const RunContext& context);

/// As complex_of_walls(), join_bodies() and embed_sheets(), for a mesh of which something is known.
std::optional<Complex> complex_of_walls(const SurfaceMesh& surface, const ComplexOptions& options,
                                        const ElementsToCome& elements, const RunContext& context);
Complex join_bodies(const std::vector<Body>& bodies, const ComplexOptions& options, const ElementsToCome& elements,
                    const RunContext& context);
Complex embed_sheets(const SurfaceMesh& surface, const std::vector<Sheet>& sheets, const ComplexOptions& options,
                     const ElementsToCome& elements, const RunContext& context);

/// The complex of solids that one surface holds under names of their own, each closed and facing outward, where some of
/// them touch or lie in others: a region each, the inner ones cut out of the outer ones. nullopt if it is none, or if
/// solids overlap; solids apart are one only where the options ask for regions.
std::optional<Complex> complex_of_solids(const SurfaceMesh& surface, const ComplexOptions& options,
                                         const ElementsToCome& elements, const RunContext& context);

/// The same of shells without names, told apart by the vertices that they do not share: where walls of several nearly
/// touch, which as cells would be regions with slivers between them.
std::optional<Complex> complex_of_shells(const SurfaceMesh& surface, const ComplexOptions& options,
                                         const ElementsToCome& elements, const RunContext& context);

}  // namespace octafront::cells
