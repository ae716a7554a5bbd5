// One line of a table per CAD file: what octafront-cad makes of it. Run by bench/campaigns/cad-campaign.sh.
//   cad_survey DEFLECTION ANGLE SECONDS FILE ...       DEFLECTION: of the diagonal of each file
#include <octafront/vec.h>

#include "reader.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

namespace octafront::testing {

namespace {

double volume_of_triangles(const cad::CadModel& model, std::uint32_t solid) {
  double sum = 0;
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    const Sides& sides = model.faces[model.face_of[t]].sides;
    const double sign = (sides[1] == solid ? 1.0 : 0.0) - (sides[0] == solid ? 1.0 : 0.0);
    const Triangle& c = model.triangles[t];
    sum += sign * dot(model.points[c[0]], cross(model.points[c[1]], model.points[c[2]])) / 6;
  }
  return sum;
}

std::string quoted(std::string text) {
  std::replace(text.begin(), text.end(), '"', '\'');
  return '"' + text + '"';
}

void survey(const std::string& file, double deflection, double angle, double seconds) {
  const std::string cpu = std::to_string(seconds);
  const Answer first = run_reader(file, {"--cpu", cpu, "--memory", "8e9"}, "", seconds * 2);
  std::printf("%s,%.2f,", quoted(std::filesystem::path(file).filename()).c_str(), first.seconds);
  const auto end = [](const Answer& a) {
    std::string why =
        a.signal != 0 ? "signal " + std::to_string(a.signal) + " at " + (a.stages.empty() ? "start" : a.stages.back())
                      : "";
    for (const std::string& error : a.errors) why += error;
    return quoted(why);
  };
  if (!first.opened) {
    std::printf("no,,,,,,,,,,,%s\n", end(first).c_str());
    return;
  }
  const double diagonal = distance(first.opened->lo, first.opened->hi);
  char line[100];
  std::snprintf(line, sizeof line, "triangulate %.17g %.17g\nend\n", deflection * diagonal, angle);
  const Answer a = run_reader(file, {"--cpu", cpu, "--memory", "8e9"}, line, seconds * 3);
  const cad::CadModel& m = a.models.empty() ? first.opened->model : a.models[0];
  long closed = 0, unknown = 0, coarse = 0, none = 0, no_curve = 0;
  double worst = 0;
  for (std::size_t s = 0; s < m.solids.size(); ++s) {
    closed += m.solids[s].closed;
    const double volume = volume_of_triangles(m, static_cast<std::uint32_t>(s));
    worst = std::max(worst, std::abs(volume - m.solids[s].volume) / std::max(1e-300, std::abs(m.solids[s].volume)));
  }
  for (const cad::Face& face : m.faces) {
    unknown += face.surface.kind == cad::SurfaceRecord::Kind::kNone;
    coarse += face.triangles == cad::Face::Triangles::kCoarser, none += face.triangles == cad::Face::Triangles::kNone;
  }
  for (const cad::CadEdge& edge : m.edges) no_curve += edge.curve.kind == cad::CurveRecord::Kind::kNone;
  std::string notes;
  for (const std::string& note : m.notes) notes += note + ". ";
  std::printf("%s,%zu,%ld,%d,%zu,%zu,%ld,%ld,%ld,%ld,%.2e,%.2f,%s,%s\n", a.models.empty() ? "opened" : "yes",
              m.solids.size(), closed, m.fused, m.faces.size(), m.triangles.size(), coarse, none, unknown, no_curve,
              worst, a.seconds, end(a).c_str(), quoted(notes).c_str());
  std::fflush(stdout);
}

}  // namespace

}  // namespace octafront::testing

int main(int argc, char** argv) {
  if (argc < 5) return 2;
  std::puts(
      "file,seconds_open,model,solids,closed,fused,faces,triangles,coarser,no_triangles,no_surface,no_curve,volume_"
      "error,seconds,end,notes");
  for (int i = 4; i < argc; ++i)
    octafront::testing::survey(argv[i], std::atof(argv[1]), std::atof(argv[2]), std::atof(argv[3]));
}
