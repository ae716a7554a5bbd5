#include <octafront/error.h>
#include <octafront/image.h>
#include <octafront/run_context.h>

#include "base/core/parallel.h"
#include "base/core/thread_limit.h"
#include "base/core/wording.h"
#include "images/labels/label_steps.h"
#include "images/labels/runs.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/core.h>

namespace octafront {

namespace {

using image::Runs;

/// Of a region, what specks may take from it or add to it.
constexpr double kMostInSpecks = 0.01;
/// So many are named in a note; others are counted.
constexpr std::size_t kMostListed = 3;

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
    for (std::uint32_t p = 0; p < all_.size(); ++p) given_[p] = is_hole(p, below);
  }

  /// The smallest first, while no region loses or gets more than a small part.
  void choose_specks(double below) {
    std::vector<std::uint32_t> specks;
    std::vector<double> most(image_.labels.size(), 0.0);
    for (const Piece& piece : all_)
      if (piece.region != LabelImage::kNoRegion) most[piece.region] += kMostInSpecks * piece.volume;
    choose_islands(below);
    for (std::uint32_t p = 0; p < all_.size(); ++p) {
      given_[p] = given_[p] || is_hole(p, below);
      if (given_[p]) specks.push_back(p);
    }
    heir_ = heirs();
    std::ranges::stable_sort(specks, {}, [&](std::uint32_t p) { return all_[p].volume; });
    std::vector<double> lost(most.size(), 0.0), got(most.size(), 0.0);
    for (const std::uint32_t p : specks) {
      const double volume = all_[p].volume;
      const std::uint16_t from = all_[p].region, to = heir_[p];
      given_[p] = (from == LabelImage::kNoRegion || lost[from] + volume <= most[from]) &&
                  (to == LabelImage::kNoRegion || got[to] + volume <= most[to]);
      if (!given_[p]) continue;
      if (from != LabelImage::kNoRegion) lost[from] += volume;
      if (to != LabelImage::kNoRegion) got[to] += volume;
    }
  }

  /// Gives what was chosen to neighbours: of those that stay the one with most faces, the first of equals; where none
  /// stays, of all. Returns what was given, in order.
  std::vector<Piece> give(std::vector<std::uint16_t>& regions) {
    std::vector<Piece> given;
    if (heir_.empty()) heir_ = heirs();
    for (std::uint32_t p = 0; p < all_.size(); ++p)
      if (given_[p]) given.push_back(all_[p]);
    const std::size_t ni = image_.grid.size[0];
    parallel_for(runs_.rows(), [&](std::size_t row) {
      for (std::size_t r = runs_.first(row); r < runs_.first(row + 1); ++r) {
        const std::uint32_t p = runs_.piece()[r];
        if (!given_[p]) continue;
        const auto begin = regions.begin() + static_cast<std::ptrdiff_t>(row * ni);
        std::fill(begin + runs_.run(r).begin, begin + runs_.run(r).end, heir_[p]);
      }
    });
    return given;
  }

 private:
  bool is_hole(std::uint32_t p, double below) const {
    return all_[p].region == LabelImage::kNoRegion && !all_[p].at_edge && all_[p].volume < below;
  }

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
  std::vector<std::uint16_t> heir_;  ///< of each piece; empty: not looked for yet
  static constexpr std::uint32_t kNone = 0xffffffff;
};

std::string name_of(const LabelImage& image, std::uint16_t region) {
  return region < image.labels.size() ? fmt::format("\"{}\"", image.labels[region].name) : std::string("the outside");
}

/// What the first ones are, and how many others there are.
std::string listed(const std::vector<std::string>& all, const char* others) {
  std::string list;
  for (std::size_t i = 0; i < std::min(kMostListed, all.size()); ++i) list += (i == 0 ? "" : ", ") + all[i];
  if (all.size() > kMostListed) list += fmt::format(", {} {}", all.size() - kMostListed, others);
  return list;
}

/// Counts by what they are of, most first.
template <class Of, class Count>
std::vector<std::pair<Of, Count>> most_first(const std::map<Of, Count>& counts) {
  std::vector<std::pair<Of, Count>> sorted(counts.begin(), counts.end());
  std::ranges::stable_sort(sorted, std::ranges::greater{}, &std::pair<Of, Count>::second);
  return sorted;
}

/// ""liver" 3 (17 voxels)".
std::string islands_among(const std::vector<Pieces::Piece>& given, const LabelImage& image) {
  std::map<std::uint16_t, std::pair<std::uint64_t, std::uint64_t>> of_region;
  for (const Pieces::Piece& p : given) {
    if (p.region == LabelImage::kNoRegion) continue;
    ++of_region[p.region].first;
    of_region[p.region].second += p.voxels;
  }
  std::vector<std::string> all;
  for (const auto& [region, n] : most_first(of_region))
    all.push_back(fmt::format("{} {} ({})", name_of(image, region), n.first, counted(n.second, "voxel")));
  return all.empty() ? "none" : listed(all, "other regions");
}

/// "7 filled (9 voxels)".
std::string holes_among(const std::vector<Pieces::Piece>& given) {
  std::uint64_t voxels = 0, holes = 0;
  for (const Pieces::Piece& p : given)
    if (p.region == LabelImage::kNoRegion) {
      ++holes;
      voxels += p.voxels;
    }
  return fmt::format("{} filled ({})", holes, counted(voxels, "voxel"));
}

void note_islands(const std::vector<Pieces::Piece>& given, double below, LabelImage& image) {
  image.notes.push_back(fmt::format("islands below {:.6g}: {}", below, islands_among(given, image)));
}

void note_holes(const std::vector<Pieces::Piece>& given, double below, LabelImage& image) {
  image.notes.push_back(fmt::format("holes below {:.6g}: {}", below, holes_among(given)));
}

void note_specks(const std::vector<Pieces::Piece>& given, double below, LabelImage& image) {
  if (given.empty()) return;
  image.notes.push_back(
      fmt::format("specks below {:.4g} go to what is around them: of {}; holes: {}; `specks` 0 keeps them", below,
                  islands_among(given, image), holes_among(given)));
}

/// "219 spots (342 voxels): "gray" and "skull" 120, ...".
void note_contacts(const image::ClearedContacts& cleared, double below, LabelImage& image) {
  if (cleared.spots.empty()) return;
  std::uint64_t all = 0;
  std::vector<std::string> pairs;
  for (const auto& [pair, n] : most_first(cleared.spots)) {
    all += n;
    pairs.push_back(fmt::format("{} and {} {}", name_of(image, pair.first), name_of(image, pair.second), n));
  }
  image.notes.push_back(fmt::format("contacts below {:.4g}: {} cleared, by {}: {}; `contacts` keep leaves them", below,
                                    counted(all, "spot"), counted(cleared.voxels, "voxel"),
                                    listed(pairs, "other pairs")));
}

void check(const CleanOptions& options) {
  if (!(options.islands >= 0) || !(options.holes >= 0) || !(options.contacts >= 0) || !(options.specks >= 0))
    throw OptionError(
        "volumes of islands, holes and specks, areas of contacts are at least 0 (`islands`, `holes`, `specks`, "
        "`contacts`)");
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
  give(options.specks, &Pieces::choose_specks, note_specks);
  if (options.contacts > 0)
    note_contacts(image::clear_small_contacts(out, std::sqrt(options.contacts), context), options.contacts, out);
  return out;
}

}  // namespace octafront
