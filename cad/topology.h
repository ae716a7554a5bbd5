#pragma once

#include "part.h"

#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <cstdint>
#include <vector>

namespace octafront::cad {

/// Faces and edges of a part, each once and in the order in which the solids name them.
struct Topology {
  struct OfFace {
    TopoDS_Face face;  ///< as its first solid has it: behind its front lies that solid
    Sides sides = {kNone, kNone};
  };
  /// An edge as a face has it that is turned forward.
  struct Use {
    TopoDS_Edge edge;
    std::uint32_t face;
  };
  struct OfEdge {
    TopoDS_Edge edge;
    std::vector<std::uint32_t> faces;  ///< each once
    std::vector<Use> uses;             ///< a seam is used twice by its face
  };
  std::vector<OfFace> faces;
  std::vector<OfEdge> edges;  ///< without degenerate ones
  TopTools_IndexedMapOfShape face_map, edge_map;

  std::uint32_t index_of(const TopoDS_Shape& face) const {
    return static_cast<std::uint32_t>(face_map.FindIndex(face) - 1);
  }
};

Topology topology_of(const Part& part);

/// What is known of `before` is known of all faces of `after` that nothing is known of yet.
void pass_labels(const TopoDS_Shape& before, const TopoDS_Shape& after, FaceLabels& labels);

/// "solid 3", "solid 'bolt'"; "face 12 (fillet)", numbered from 1.
std::string in_words(const Part& part, std::size_t solid);
std::string face_in_words(const Part& part, const Topology& topology, std::size_t face);

}  // namespace octafront::cad
