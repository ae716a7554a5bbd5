#include <octafront/named_groups.h>

#include "base/geometry/measures.h"

#include <algorithm>
#include <numeric>
#include <string>

#include <fmt/core.h>

namespace octafront {
namespace {

double volume_of(const TetMesh& mesh, std::size_t t) {
  const auto& [a, b, c, d] = mesh.tets[t];
  return signed_volume(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]);
}

void add_element(FieldBin& bin, double value, double volume) {
  bin.least = bin.elements == 0 ? value : std::min(bin.least, value);
  bin.most = bin.elements == 0 ? value : std::max(bin.most, value);
  bin.mean += value * volume;
  bin.volume += volume;
  ++bin.elements;
}

}  // namespace

std::vector<FieldBin> add_bins(TetMesh& mesh, const MeshField& field, std::uint32_t count) {
  if (field.values.empty()) return {};
  const auto [least, most] = std::ranges::minmax(field.values);
  const double width = (most - least) / count;
  std::vector<FieldBin> bins(count);
  std::vector<TetIndex> speaker(field.values.size());  // of a wedge its first tetrahedron
  std::iota(speaker.begin(), speaker.end(), 0);
  for (const WideCell& cell : mesh.wide_cells) std::fill_n(speaker.begin() + cell.first, cell.tet_count, cell.first);
  std::vector<NamedSet> sets(count, {"", NamedSet::Kind::kElements, {}});
  for (std::size_t t = 0; t < field.values.size(); ++t) {
    const double at = width > 0 ? (field.values[speaker[t]] - least) / width : 0;
    const std::size_t b = std::min<std::size_t>(static_cast<std::size_t>(at), count - 1);
    add_element(bins[b], field.values[t], volume_of(mesh, t));
    sets[b].members.push_back(static_cast<std::uint32_t>(t));
  }
  const std::size_t digits = std::to_string(count).size();
  for (std::size_t b = 0; b < bins.size(); ++b) {
    if (bins[b].elements == 0) continue;
    bins[b].mean /= bins[b].volume;
    bins[b].set = sets[b].name = fmt::format("{}_{:0{}}", field.name, b + 1, digits);
    mesh.sets.push_back(std::move(sets[b]));
  }
  std::erase_if(bins, [](const FieldBin& bin) { return bin.elements == 0; });
  return bins;
}

}  // namespace octafront
