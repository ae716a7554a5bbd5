#include "sizing/size_cases.h"

#include "sizing/sources/make_size_field.h"
#include "support/named_surfaces.h"

#include <algorithm>
#include <cmath>

namespace octafront::testing {

SizeField sizes_of(const SurfaceMesh& surface, const SizeOptions& options, const Features& features) {
  StageReport report;
  return make_size_field(KnownSurface(surface, features), options, {RunContext{}, report});
}

std::function<void(std::span<const Vec3>, std::span<double>)> each(double (*size_at)(Vec3)) {
  return [size_at](std::span<const Vec3> points, std::span<double> sizes) {
    std::transform(points.begin(), points.end(), sizes.begin(), size_at);
  };
}

std::vector<SizeCase> size_cases() {
  std::vector<SizeCase> list;
  list.push_back({"automatic sphere", icosphere(3), {}});
  list.push_back({"automatic torus", torus(60, 24), {}});
  SizeOptions o;
  o.size = 0.1;
  list.push_back({"uniform cube", cube(3), o});
  o.interior = SizeOptions::Interior::kGraded;
  o.max_size = 0.5;
  list.push_back({"graded cube", cube(3), o});
  o = {};
  o.curvature = 40;
  o.gradation = 0.4;
  list.push_back({"curved torus", torus(60, 24, 1, 0.1), o});
  o = {};
  o.callback = each([](Vec3 p) { return 0.02 + 0.5 * length(p - Vec3{1, 0, 0}); });
  o.gradation = 0.15;
  list.push_back({"callback", icosphere(3), o});
  o.interior = SizeOptions::Interior::kGraded;
  list.push_back({"graded callback", icosphere(3), o});
  return list;
}

Vec3 random_point(std::mt19937& random, const Box3& box) {
  std::uniform_real_distribution<double> u(-0.1, 1.1);
  const Vec3 e = box.extent();
  return {box.lo.x + u(random) * e.x, box.lo.y + u(random) * e.y, box.lo.z + u(random) * e.z};
}

}  // namespace octafront::testing
