#include <octafront/error.h>
#include <octafront/image.h>
#include <octafront/run_context.h>

#include "base/core/parallel.h"
#include "base/core/thread_limit.h"
#include "base/core/wording.h"
#include "images/labels/closing.h"
#include "images/labels/runs.h"
#include "images/labels/small_contacts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/core.h>

namespace octafront {

namespace {

using image::Runs;

/// The volume of a voxel in each slice: slices reach to the middle between them and their neighbours.
std::vector<double> volumes_of_voxels(const ImageGrid& grid) {
  const double step = std::abs(dot(cross(grid.axes[0], grid.axes[1]), grid.axes[2]));
  std::vector<double> volumes(grid.size[2], step);
  if (grid.slices.size() < 2) return volumes;
  for (std::uint32_t k = 0; k < grid.size[2]; ++k) {
    const std::uint32_t below = k == 0 ? 0 : k - 1, above = std::min(k + 1, grid.size[2] - 1);
    volumes[k] = step * (grid.slices[above] - grid.slices[below]) / (above - below);
  }
  return volumes;
}

/// Pieces of an image, and those that are to be given away.
class Pieces {
 public:
  explicit Pieces(const LabelImage& image)
      : image_(image), runs_(image.grid.size, image.regions), all_(runs_.pieces()), given_(runs_.pieces(), false) {
    const std::vector<double> volumes = volumes_of_voxels(image.grid);
    const std::uint32_t ni = image.grid.size[0], nj = image.grid.size[1], nk = image.grid.size[2];
    for (std::size_t row = 0; row < runs_.rows(); ++row) {
      const std::size_t j = row % nj, k = row / nj;
      const bool at_edge = j == 0 || j + 1 == nj || k == 0 || k + 1 == nk;
      for (std::size_t r = runs_.first(row); r < runs_.first(row + 1); ++r) {
        const image::Run& run = runs_.run(r);
        Piece& piece = all_[runs_.piece()[r]];
        piece.region = run.region;
        piece.voxels += run.end - run.begin;
        piece.volume += volumes[k] * (run.end - run.begin);
        piece.at_edge = piece.at_edge || at_edge || run.begin == 0 || run.end == ni;
      }
    }
  }

  struct Piece {
    std::uint16_t region = 0;
    std::uint64_t voxels = 0;
    double volume = 0;
    bool at_edge = false;
  };

  void choose_islands(double below) {
    std::vector<std::uint32_t> largest(image_.labels.size(), kNone);
    for (std::uint32_t p = 0; p < all_.size(); ++p) {
      if (all_[p].region == LabelImage::kNoRegion) continue;
      std::uint32_t& best = largest[all_[p].region];
      if (best == kNone || all_[p].voxels > all_[best].voxels) best = p;
    }
    for (std::uint32_t p = 0; p < all_.size(); ++p) {
      const std::uint16_t region = all_[p].region;
      given_[p] = region != LabelImage::kNoRegion && all_[p].volume < below && largest[region] != p;
    }
  }

  void choose_holes(double below) {
    for (std::uint32_t p = 0; p < all_.size(); ++p)
      given_[p] = all_[p].region == LabelImage::kNoRegion && !all_[p].at_edge && all_[p].volume < below;
  }

  /// Gives what was chosen to neighbours: of those that stay the one with most faces, the first of equals; where none
  /// stays, of all. Returns what was given, in order.
  std::vector<Piece> give(std::vector<std::uint16_t>& regions) const {
    std::vector<Piece> given;
    const std::vector<std::uint16_t> heir = heirs();
    for (std::uint32_t p = 0; p < all_.size(); ++p)
      if (given_[p]) given.push_back(all_[p]);
    const std::size_t ni = image_.grid.size[0];
    parallel_for(runs_.rows(), [&](std::size_t row) {
      for (std::size_t r = runs_.first(row); r < runs_.first(row + 1); ++r) {
        const std::uint32_t p = runs_.piece()[r];
        if (!given_[p]) continue;
        const auto begin = regions.begin() + static_cast<std::ptrdiff_t>(row * ni);
        std::fill(begin + runs_.run(r).begin, begin + runs_.run(r).end, heir[p]);
      }
    });
    return given;
  }

 private:
  /// Per piece: the faces that it has with each region, those of neighbours that stay counted apart.
  using Faces = std::map<std::uint16_t, std::pair<std::uint64_t, std::uint64_t>>;

  std::vector<std::uint16_t> heirs() const {
    std::map<std::uint32_t, Faces> faces;
    const auto meet = [&](std::uint32_t p, std::uint32_t q, std::uint32_t n) {
      if (!given_[p] || p == q) return;
      auto& [staying, all] = faces[p][all_[q].region];
      all += n;
      if (!given_[q]) staying += n;
    };
    const auto& piece = runs_.piece();
    runs_.for_each_contact([&](std::size_t r, std::size_t s, std::uint32_t n) {
      meet(piece[r], piece[s], n);
      meet(piece[s], piece[r], n);
    });
    for (std::size_t row = 0; row < runs_.rows(); ++row)
      for (std::size_t r = runs_.first(row); r + 1 < runs_.first(row + 1); ++r) {
        meet(piece[r], piece[r + 1], 1);
        meet(piece[r + 1], piece[r], 1);
      }
    std::vector<std::uint16_t> heir(all_.size());
    for (std::uint32_t p = 0; p < all_.size(); ++p) heir[p] = all_[p].region;
    for (const auto& [p, of_regions] : faces) {
      std::pair<std::uint64_t, std::uint64_t> most{0, 0};
      for (const auto& [region, n] : of_regions)
        if (n > most) {
          most = n;
          heir[p] = region;
        }
    }
    return heir;
  }

  const LabelImage& image_;
  Runs runs_;
  std::vector<Piece> all_;
  std::vector<bool> given_;
  static constexpr std::uint32_t kNone = 0xffffffff;
};

/// "3 islands (17 voxels) of "liver"".
void note_islands(const std::vector<Pieces::Piece>& given, double below, LabelImage& image) {
  std::map<std::uint16_t, std::pair<std::uint64_t, std::uint64_t>> of_region;
  for (const Pieces::Piece& p : given) {
    ++of_region[p.region].first;
    of_region[p.region].second += p.voxels;
  }
  std::string list;
  for (const auto& [region, n] : of_region)
    list += fmt::format("{}\"{}\" {} ({})", list.empty() ? "" : ", ", image.labels[region].name, n.first,
                        counted(n.second, "voxel"));
  image.notes.push_back(fmt::format("islands below {:.6g}: {}", below, list.empty() ? "none" : list));
}

void note_holes(const std::vector<Pieces::Piece>& given, double below, LabelImage& image) {
  std::uint64_t voxels = 0;
  for (const Pieces::Piece& p : given) voxels += p.voxels;
  image.notes.push_back(
      fmt::format("holes below {:.6g}: {} filled ({})", below, given.size(), counted(voxels, "voxel")));
}

/// "219 spots (342 voxels): "gray" and "skull" 120, ...".
void note_contacts(const image::ClearedContacts& cleared, double below, LabelImage& image) {
  std::vector<std::pair<std::uint64_t, std::pair<std::uint16_t, std::uint16_t>>> pairs;
  std::uint64_t all = 0;
  for (const auto& [pair, n] : cleared.spots) {
    pairs.emplace_back(n, pair);
    all += n;
  }
  if (all == 0) return;
  std::stable_sort(pairs.begin(), pairs.end(), [](const auto& p, const auto& q) { return p.first > q.first; });
  const auto name = [&](std::uint16_t r) {
    return r < image.labels.size() ? fmt::format("\"{}\"", image.labels[r].name) : std::string("the outside");
  };
  constexpr std::size_t kMostNamed = 3;
  std::string list;
  for (std::size_t p = 0; p < std::min(kMostNamed, pairs.size()); ++p)
    list += fmt::format("{}{} and {} {}", p == 0 ? "" : ", ", name(pairs[p].second.first), name(pairs[p].second.second),
                        pairs[p].first);
  if (pairs.size() > kMostNamed) list += fmt::format(", {} other pairs", pairs.size() - kMostNamed);
  image.notes.push_back(fmt::format("contacts below {:.4g}: {} cleared, by {}: {}; `contacts` keep leaves them", below,
                                    counted(all, "spot"), counted(cleared.voxels, "voxel"), list));
}

void check(const CleanOptions& options) {
  if (!(options.islands >= 0) || !(options.holes >= 0) || !(options.contacts >= 0))
    throw OptionError(
        "volumes of islands and holes, areas of contacts are at least 0 (`islands`, `holes`, `contacts`)");
  constexpr std::uint32_t kMostClosing = 64;
  if (options.closing > kMostClosing)
    throw OptionError(fmt::format("`close_voxels` is {}; at most {} can be closed", options.closing, kMostClosing));
}

}  // namespace

LabelImage cleaned(const LabelImage& image, const CleanOptions& options, const RunContext& context) {
  check(options);
  const ThreadLimit limit(context.threads);
  LabelImage out = image;
  if (options.closing > 0) {
    const std::uint64_t voxels = image::close_gaps(out, options.closing, context);
    out.notes.push_back(
        fmt::format("closing by {}: {} added", counted(options.closing, "voxel"), counted(voxels, "voxel")));
  }
  const auto give = [&](double below, auto choose, auto note) {
    if (!(below > 0)) return;
    context.check();
    Pieces pieces(out);
    (pieces.*choose)(below);
    std::vector<std::uint16_t> regions = out.regions;
    note(pieces.give(regions), below, out);
    out.regions = std::move(regions);
  };
  give(options.islands, &Pieces::choose_islands, note_islands);
  give(options.holes, &Pieces::choose_holes, note_holes);
  if (options.contacts > 0)
    note_contacts(image::clear_small_contacts(out, std::sqrt(options.contacts), context), options.contacts, out);
  return out;
}

}  // namespace octafront
