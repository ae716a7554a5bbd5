#include "answer.h"
#include "measure.h"
#include "outline.h"
#include "pipe.h"
#include "read.h"
#include "steps.h"
#include "topology.h"

#include <Standard_Failure.hxx>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <new>
#include <optional>
#include <sstream>

#include <fmt/format.h>

namespace octafront::cad {

namespace {

constexpr const char* kUsage =
    "octafront-cad FILE [--memory BYTES] [--cpu SECONDS] [--no-fuse] [--no-heal] [--keep-going]\n"
    "              [--overlap refuse|tell|first|later|new] [--tolerance MM]\n"
    "Reads a STEP, IGES or BREP file for octafront, which starts it; speaks as src/cad/model/stream.h says.\n";

std::optional<double> positive_number(const char* text) {
  char* end = nullptr;
  const double value = std::strtod(text, &end);
  if (end == text || *end != '\0' || !(value > 0) || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// The file, or an option without a value; false: it is neither.
bool take_word(const std::string& word, Arguments& a) {
  if (word == "--no-fuse")
    a.fuse = false;
  else if (word == "--no-heal")
    a.heal = false;
  else if (word == "--keep-going")
    a.keep_going = true;
  else if (word.starts_with("--") || !a.file.empty())
    return false;
  else
    a.file = word;
  return true;
}

std::optional<Arguments> arguments_of(int argc, char** argv) {
  Arguments a;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    double* number = word == "--memory"      ? &a.memory
                     : word == "--cpu"       ? &a.cpu_seconds
                     : word == "--tolerance" ? &a.tolerance
                                             : nullptr;
    if (number != nullptr) {
      const std::optional<double> value = i + 1 < argc ? positive_number(argv[++i]) : std::nullopt;
      if (!value) return std::nullopt;
      *number = *value;
    } else if (word == "--overlap") {
      const std::optional<Overlap> overlap = overlap_of(i + 1 < argc ? argv[++i] : "");
      if (!overlap) return std::nullopt;
      a.overlap = *overlap;
    } else if (!take_word(word, a)) {
      return std::nullopt;
    }
  }
  if (a.file.empty()) return std::nullopt;
  return a;
}

/// How much of all area the loose faces have.
double part_of_area(const std::vector<TopoDS_Shape>& loose, const std::vector<Body>& solids) {
  double area = 0, all = 0;
  for (const TopoDS_Shape& face : loose) area += area_of(face);
  for (const Body& body : solids) all += area_of(body.solid);
  return area / (area + all);
}

Part opened_part(const Arguments& arguments) {
  Part part = read_part(arguments);
  scale_up(part);
  sew(part);
  if (arguments.heal) take_other_parts(part);
  turn_outward(part);
  if (arguments.heal) heal(part);
  if (part.solids.size() > 1) {
    if (arguments.fuse)
      fuse(part, arguments);
    else
      part.fused = false;
  }
  if (!part.solids.empty() && !part.loose.empty())
    part.notes.push_back(fmt::format("{} faces, {:.0f} % of the area, belong to no solid", part.loose.size(),
                                     100 * part_of_area(part.loose, part.solids)));
  return part;
}

Box3 box_of_faces(const Topology& topology) {
  Box3 box;
  for (std::size_t f = 0; f < topology.faces.size(); ++f) box.add(close_box(topology.faces[f].face));
  return box;
}

/// A line `triangulate DEFLECTION ANGLE`.
std::optional<Fineness> fineness_of(std::istringstream& words) {
  Fineness fineness;
  std::string deflection, angle;
  if (!(words >> deflection >> angle)) return std::nullopt;
  const std::optional<double> d = positive_number(deflection.c_str()), a = positive_number(angle.c_str());
  if (!d || !a) return std::nullopt;
  return Fineness{*d, *a};
}

void serve(const Arguments& arguments) {
  const Part part = opened_part(arguments);
  const Topology topology = topology_of(part);
  send_progress("measuring", "volumes and areas");
  Opened opened{{}, {}, model_without_triangles(part, topology)};
  const Box3 box = box_of_faces(topology);
  if (!box.empty()) opened.lo = box.lo, opened.hi = box.hi;
  send(FrameKind::kOpened, to_bytes(opened));
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream words(line);
    std::string command;
    words >> command;
    if (command == "end") return;
    const std::optional<Fineness> fineness = command == "triangulate" ? fineness_of(words) : std::nullopt;
    if (fineness)
      answer(part, topology, opened.model, *fineness, arguments);
    else
      send_error(fmt::format("octafront-cad does not know what to do with \"{}\"", line));
  }
}

}  // namespace

}  // namespace octafront::cad

int main(int argc, char** argv) {
  using namespace octafront::cad;
  const std::optional<Arguments> arguments = arguments_of(argc, argv);
  if (!arguments) {
    std::fputs(kUsage, stderr);
    return 2;
  }
  take_standard_output();
  end_with_parent();
  limit_memory(arguments->memory);
  limit_cpu(arguments->cpu_seconds);
  try {
    serve(*arguments);
    return 0;
  } catch (const Standard_Failure& failure) {
    send_error(fmt::format("{} cannot be read: OpenCASCADE says {} {}", arguments->file, failure.DynamicType()->Name(),
                           failure.GetMessageString()));
  } catch (const std::bad_alloc&) {
    send_error(fmt::format("{} needs more memory than it may take", arguments->file));
  } catch (const std::exception& failure) {
    send_error(failure.what());
  }
  return 1;
}
