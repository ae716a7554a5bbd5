#include "image_info.h"

#include <octafront/image.h>

#include "mesh_in_words.h"
#include "text.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/core.h>

namespace octafront::cli {

namespace {

/// Where an axis of voxels runs, nearly: "right", by the letters of the frame, which name where x, y and z point.
std::string toward(Vec3 axis, const std::string& frame) {
  int main = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(axis[i]) > std::abs(axis[main])) main = i;
  const bool forward = axis[main] > 0;
  switch (frame[static_cast<std::size_t>(main)]) {
    case 'R':
      return forward ? "right" : "left";
    case 'L':
      return forward ? "left" : "right";
    case 'A':
      return forward ? "front" : "back";
    case 'P':
      return forward ? "back" : "front";
    default:
      return forward ? "top" : "bottom";
  }
}

Box3 box_of_grid(const ImageGrid& grid) {
  Box3 box;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const auto end = [&](unsigned axis, double last) { return (corner >> axis & 1) != 0 ? last + 0.5 : -0.5; };
    box.add(
        grid.to_world({end(0, grid.size[0] - 1.0), end(1, grid.size[1] - 1.0), end(2, grid.slice(grid.size[2] - 1))}));
  }
  return box;
}

double volume_of_voxel(const ImageGrid& grid) {
  return std::abs(dot(cross(grid.axes[0], grid.axes[1]), grid.axes[2]));
}

void tell_grid(Session& session, const Image& image) {
  const ImageGrid& grid = image.grid;
  const Box3 box = box_of_grid(grid);
  session.found({{"kind", "image"},
                 {"format", image.format},
                 {"size", grid.size},
                 {"spacing", {length(grid.axes[0]), length(grid.axes[1]), length(grid.axes[2])}},
                 {"axes", {place(grid.axes[0]), place(grid.axes[1]), place(grid.axes[2])}},
                 {"origin", place(grid.origin)},
                 {"slices", grid.slices},
                 {"frame", image.frame},
                 {"unit", image.unit},
                 {"box", {place(box.lo), place(box.hi)}}});
  session.say(fmt::format("  box ({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g}), unit: {}\n", box.lo.x, box.lo.y,
                          box.lo.z, box.hi.x, box.hi.y, box.hi.z,
                          image.unit.empty() ? "the file does not say" : image.unit));
  for (std::size_t a = 0; a < 3; ++a)
    session.say(fmt::format("  {} steps by ({:.6g}, {:.6g}, {:.6g}){}\n", "ijk"[a], grid.axes[a].x, grid.axes[a].y,
                            grid.axes[a].z,
                            image.frame.empty() ? "" : ", to the " + toward(grid.axes[a], image.frame)));
  session.say(fmt::format("  first voxel at ({:.6g}, {:.6g}, {:.6g}); coordinates {}\n", grid.origin.x, grid.origin.y,
                          grid.origin.z, image.frame.empty() ? "of no known frame" : image.frame));
  if (!grid.slices.empty()) {
    double least = grid.slices.back(), most = 0;
    for (std::size_t k = 1; k < grid.slices.size(); ++k) {
      least = std::min(least, grid.slices[k] - grid.slices[k - 1]);
      most = std::max(most, grid.slices[k] - grid.slices[k - 1]);
    }
    session.say(
        fmt::format("  slices {:.6g} to {:.6g} apart\n", least * length(grid.axes[2]), most * length(grid.axes[2])));
  }
}

void tell_labels(Session& session, const Image& image) {
  const std::vector<ValueCount> counts = *count_values(image);
  const double voxel = volume_of_voxel(image.grid);
  Json all = Json::array(), regions = Json::array();
  constexpr std::size_t kListed = 40;
  session.say(
      fmt::format("  labels: {}; label, voxels{}\n", counts.size(), image.grid.slices.empty() ? ", volume" : ""));
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const auto named = std::find_if(image.names.begin(), image.names.end(),
                                    [&](const LabelName& n) { return n.value == counts[i].value; });
    const std::string name = named == image.names.end() ? "" : named->name;
    Json entry{{"value", counts[i].value}, {"voxels", counts[i].voxels}};
    if (!name.empty()) entry["name"] = name;
    all.push_back(entry);
    if (counts[i].value != 0) regions.push_back(name.empty() ? fmt::format("label {}", counts[i].value) : name);
    if (i >= kListed) continue;
    const std::string volume =
        image.grid.slices.empty() ? fmt::format(" {:>12.6g}", voxel * static_cast<double>(counts[i].voxels)) : "";
    session.say(fmt::format("  {:>8} {:>12}{}  {}\n", counts[i].value, counts[i].voxels, volume, name));
  }
  if (counts.size() > kListed) session.say(fmt::format("  ... {} more (--json - has all)\n", counts.size() - kListed));
  session.found({{"voxels", "labels"}, {"labels", all}, {"places", {{"regions", regions}}}});
  session.say("octafront mesh makes a region of each label but 0\n");
}

/// How many voxels lie in each of `bins` equal parts from the least to the largest value.
template <class T>
std::vector<std::uint64_t> histogram(const std::vector<T>& values, double least, double step, std::size_t bins) {
  std::vector<std::uint64_t> counts(bins);
  for (const T v : values) {
    const double at = step > 0 ? (static_cast<double>(v) - least) / step : 0;
    ++counts[std::min(bins - 1, static_cast<std::size_t>(at))];
  }
  return counts;
}

void tell_values(Session& session, const Image& image) {
  constexpr std::size_t kBins = 20;
  std::visit(
      [&](const auto& values) {
        const auto [first, last] = std::minmax_element(values.begin(), values.end());
        const auto least = static_cast<double>(*first), largest = static_cast<double>(*last);
        const double step = (largest - least) / kBins;
        const std::vector<std::uint64_t> counts = histogram(values, least, step, kBins);
        const std::uint64_t most = *std::max_element(counts.begin(), counts.end());
        session.found({{"voxels", "grey"}, {"least", least}, {"largest", largest}, {"histogram", counts}});
        session.say(fmt::format("  grey values {:.6g} to {:.6g}; from, voxels\n", least, largest));
        for (std::size_t b = 0; b < kBins; ++b) {
          // Bars grow with the logarithm: background is most of nearly every image.
          constexpr double kBarWidth = 40;
          const double part = std::log1p(static_cast<double>(counts[b])) / std::log1p(static_cast<double>(most));
          session.say(fmt::format("  {:>12.6g} {:>12} {}\n", least + static_cast<double>(b) * step, counts[b],
                                  std::string(static_cast<std::size_t>(kBarWidth * part), '#')));
        }
      },
      image.values);
  session.say("octafront mesh --iso V meshes what is V and more, --band LO:HI what lies between\n");
}

}  // namespace

void tell_image_info(Session& session) {
  const Arguments& a = session.arguments();
  const Image image = read_image(in_utf8(a.bodies), a.intake.image.choice, session.context());
  session.say(fmt::format("{}: {}, {}\n", a.input.string(), image.format, in_words(image.grid)));
  session.say_notes("reading", image.notes);
  tell_grid(session, image);
  if (looks_like_labels(image)) return tell_labels(session, image);
  tell_values(session, image);
}

}  // namespace octafront::cli
