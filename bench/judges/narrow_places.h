#pragma once

// What a shape forces on elements at a place: angles between faces and between edges, short edges, narrow gaps.
// Asked of OpenCASCADE alone.

#include <octafront/vec.h>

#include <TopoDS_Shape.hxx>
#include <cmath>
#include <memory>
#include <vector>

namespace octafront {

/// What is narrow within `reach` of a place. HUGE_VAL: nothing of that kind is there.
struct Narrow {
  double wedge = HUGE_VAL;   ///< degrees: the least angle, inside a solid, between faces that meet at an edge
  double corner = HUGE_VAL;  ///< degrees: the least between edges of a face that meet, or of two solids that cross
  double edge = HUGE_VAL;    ///< the shortest edge, in parts of the reach
  double gap = HUGE_VAL;     ///< the least distance of two edges of a solid that do not meet there, in the same parts

  bool forces_poor_elements() const;
};

class NarrowPlaces {
 public:
  explicit NarrowPlaces(const TopoDS_Shape& shape);
  ~NarrowPlaces();

  Narrow at(Vec3 place, double reach) const;

 private:
  struct Edge;
  struct Solid;
  struct Near;
  std::vector<Near> edges_near(Vec3 place, double reach) const;
  std::unique_ptr<std::vector<Solid>> solids_;
};

}  // namespace octafront
