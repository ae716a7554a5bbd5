// What Netgen makes of the curved elements of a mesh file, as JSON: volumes and areas by number, by a rule of Gauss,
// and the least determinant of the Jacobian at its points.
//   netgen_judge FILE
// Built against Netgen's sources and objects, for none of its packages shows what is inside a curved element.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <meshing.hpp>
#include <string>
#include <utility>

namespace {

constexpr int kGaussPoints = 10;

/// Places from 0 to 1 and weights, by Newton's method from the cosines.
std::array<std::pair<double, double>, kGaussPoints> gauss() {
  std::array<std::pair<double, double>, kGaussPoints> rule;
  for (int i = 0; i < kGaussPoints; ++i) {
    double x = std::cos(M_PI * (i + .75) / (kGaussPoints + .5)), slope = 1;
    for (int step = 0; step < 30; ++step) {
      double before = 1, value = x;
      for (int k = 2; k <= kGaussPoints; ++k) {
        const double next = ((2 * k - 1) * x * value - (k - 1) * before) / k;
        before = value, value = next;
      }
      slope = kGaussPoints * (x * value - before) / (x * x - 1);
      x -= value / slope;
    }
    rule[i] = {(x + 1) / 2, 1 / ((1 - x * x) * slope * slope)};
  }
  return rule;
}

struct Sums {
  int count = 0;
  double measure = 0;
};

std::string json_of_sums(const std::map<int, Sums>& all) {
  std::string text;
  for (const auto& [number, sums] : all) {
    char line[120];
    std::snprintf(line, sizeof line, "%s\"%d\": {\"size\": %d, \"measure\": %.17g}", text.empty() ? "" : ", ", number,
                  sums.count, sums.measure);
    text += line;
  }
  return "{" + text + "}";
}

}  // namespace

int main(int, char** argv) {
  using namespace netgen;
  printmessage_importance = 0;
  Mesh mesh;
  mesh.Load(std::filesystem::path(argv[1]));
  CurvedElements& curves = mesh.GetCurvedElements();
  const auto rule = gauss();
  std::map<int, Sums> regions, patches;
  double least = 1e300, volume = 0;
  for (ElementIndex e = 0; e < mesh.GetNE(); e++) {
    Sums& sums = regions[mesh[e].GetIndex()];
    ++sums.count;
    for (const auto& [u, wu] : rule)
      for (const auto& [v, wv] : rule)
        for (const auto& [w, ww] : rule) {
          Point<3> place;
          Mat<3, 3> slopes;
          curves.CalcElementTransformation(Point<3>(u, v * (1 - u), w * (1 - u) * (1 - v)), e, place, slopes);
          const double share = wu * wv * ww * (1 - u) * (1 - u) * (1 - v) * Det(slopes);
          least = std::min(least, Det(slopes));
          sums.measure += share;
          volume += share;
        }
  }
  for (SurfaceElementIndex s = 0; s < mesh.GetNSE(); s++) {
    Sums& sums = patches[mesh.GetFaceDescriptor(mesh[s].GetIndex()).BCProperty()];
    ++sums.count;
    for (const auto& [u, wu] : rule)
      for (const auto& [v, wv] : rule) {
        Point<3> place;
        Mat<3, 2> slopes;
        curves.CalcSurfaceTransformation(Point<2>(u, v * (1 - u)), s, place, slopes);
        const Vec<3> a(slopes(0, 0), slopes(1, 0), slopes(2, 0)), b(slopes(0, 1), slopes(1, 1), slopes(2, 1));
        sums.measure += wu * wv * (1 - u) * Cross(a, b).Length();
      }
  }
  std::printf(
      "{\"order\": %d, \"nodes\": %d, \"elements\": %d, \"boundary\": %d, \"volume\": %.17g, \"least_jacobian\": %.9g, "
      "\"regions\": %s, \"patches\": %s}\n",
      curves.GetOrder(), int(mesh.GetNP()), int(mesh.GetNE()), int(mesh.GetNSE()), volume, least,
      json_of_sums(regions).c_str(), json_of_sums(patches).c_str());
}
