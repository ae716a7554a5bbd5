#pragma once

#include "surface/edits/working_mesh.h"
#include "surface/lines/curves.h"

#include <map>
#include <optional>

namespace octafront::surface {

/// Moves division points along their curves, and adds some, where that makes the triangles on both sides better: lines
/// that run side by side or meet at a small angle are divided each by itself, and their points face each other badly. A
/// point never leaves its curve.
class CurvePoints {
 public:
  CurvePoints(WorkingMesh& mesh, const InputSurface& input, const std::vector<Curve>& curves, const SizeField& sizes);

  /// Moves v, a point of a curve, if the mean of its triangles rises; bends are not cut deeper than before.
  bool slide(VertexIndex v);
  /// Moves v if that lifts the 2r/R of the worst of its triangles by `gain`, and out of what is bad.
  bool relieve(VertexIndex v, double gain);
  /// Divides the feature edge of h where it lies nearest to its apex, if that lifts the worst of the triangles on both
  /// sides by `gain`.
  bool split(HalfEdge h, double gain);
  /// Divides the feature edge of h in its middle, if no triangle turns too far by that.
  bool halve(HalfEdge h);

 private:
  struct Corner {
    VertexIndex a, b;  ///< the far edge of a triangle of the star
    Vec3 star;         ///< area vector of its side of the curve
  };
  struct Quality {
    double sum = 0, worst = 1;
  };
  struct Neighbours {
    VertexIndex before = kNone, after = kNone;
    double from = 0, to = 0;  ///< their places along the curve, around that of v
  };
  struct Division {
    CurvePlace place;
    CurvePoint point;
  };

  bool gather(VertexIndex v);
  bool find_neighbours(VertexIndex v);
  double step_wanted(VertexIndex v) const;
  bool judge(VertexIndex v, Vec3 p, Quality& quality) const;
  double worst_shape(VertexIndex v, Vec3 p, double enough) const;
  double sagitta(const Curve& curve, double from, double to, Vec3 a, Vec3 b) const;
  double deviation(const Curve& curve, double along, Vec3 p) const;
  bool lengths_within(Vec3 p, double least, double most) const;
  void move(VertexIndex v, const CurvePoint& x);
  bool ends_at_start(const Curve& curve, double along, VertexIndex inside, VertexIndex corner) const;
  std::optional<CurvePlace> place_between(HalfEdge h, double part) const;
  std::optional<Division> division(HalfEdge h, double part) const;
  double shape_beside(HalfEdge h) const;
  double shape_after_split(HalfEdge h, Vec3 x) const;
  void split_at(HalfEdge h, const Division& at);

  WorkingMesh& mesh_;
  const InputSurface& input_;
  const std::vector<Curve>& curves_;
  const SizeField& sizes_;
  std::vector<HalfEdge> features_;
  std::vector<Corner> ring_;
  Neighbours neighbours_;
  std::map<Edge, std::uint32_t> undivided_;  ///< curves of one segment, by their ends
};

}  // namespace octafront::surface
