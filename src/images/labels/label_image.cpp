#include <octafront/error.h>
#include <octafront/image.h>

#include "base/core/parallel.h"
#include "base/core/utf8.h"
#include "base/core/wording.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <unordered_map>

#include <fmt/core.h>

namespace octafront {

namespace {

constexpr std::size_t kMostLabels = LabelImage::kNoRegion - 1;

/// Voxels per value, of values that lie near each other.
template <class T>
std::vector<ValueCount> counted_in_table(const std::vector<T>& values, T least, T largest) {
  const auto base = static_cast<std::int64_t>(least);
  std::vector<std::uint64_t> table(static_cast<std::size_t>(static_cast<std::int64_t>(largest) - base) + 1);
  for (const T v : values) ++table[static_cast<std::size_t>(static_cast<std::int64_t>(v) - base)];
  std::vector<ValueCount> counts;
  for (std::size_t i = 0; i < table.size(); ++i)
    if (table[i] > 0) counts.push_back({base + static_cast<std::int64_t>(i), table[i]});
  return counts;
}

template <class T>
std::optional<std::vector<ValueCount>> counted_in_map(const std::vector<T>& values) {
  std::unordered_map<std::int64_t, std::uint64_t> map;
  for (const T v : values) {
    ++map[static_cast<std::int64_t>(v)];
    if (map.size() > kMostLabels) return std::nullopt;
  }
  std::vector<ValueCount> counts;
  for (const auto& [value, voxels] : map) counts.push_back({value, voxels});
  std::sort(counts.begin(), counts.end(), [](const ValueCount& a, const ValueCount& b) { return a.value < b.value; });
  return counts;
}

template <class T>
bool all_whole(const std::vector<T>& values) {
  if constexpr (std::is_integral_v<T>) return true;
  // Labels beyond 2^24 may have been rounded to single precision, which their reader says; these can be counted.
  constexpr double kMost = 0x1p53;
  return parallel_find(values.size(), [&](std::size_t i) {
           const double v = values[i];
           return v != std::floor(v) || std::abs(v) > kMost;
         }) == values.size();
}

template <class T>
std::optional<std::vector<ValueCount>> counts_of(const std::vector<T>& values) {
  if (values.empty()) return std::vector<ValueCount>{};
  if (!all_whole(values)) return std::nullopt;
  const auto [least, largest] = std::minmax_element(values.begin(), values.end());
  constexpr double kLargestTable = 1 << 22;
  if (static_cast<double>(*largest) - static_cast<double>(*least) >= kLargestTable) return counted_in_map(values);
  std::vector<ValueCount> counts = counted_in_table(values, *least, *largest);
  if (counts.size() > kMostLabels) return std::nullopt;
  return counts;
}

/// Pairs of voxels with a common face, neither of which has the value `common`, and how many are equal.
struct Pairs {
  std::uint64_t all = 0, equal = 0;
};

template <class T>
Pairs pairs_of(const std::vector<T>& values, const std::array<std::uint32_t, 3>& size, T common) {
  const std::size_t ni = size[0], nj = size[1], nk = size[2];
  const std::array<std::size_t, 3> steps{1, ni, ni * nj};
  std::vector<Pairs> slices(nk);
  parallel_for(nk, [&](std::size_t k) {
    for (std::size_t j = 0; j < nj; ++j)
      for (std::size_t i = 0; i < ni; ++i) {
        const std::size_t at = i + ni * (j + nj * k);
        if (values[at] == common) continue;
        const std::array<bool, 3> inside{i + 1 < ni, j + 1 < nj, k + 1 < nk};
        for (std::size_t axis = 0; axis < 3; ++axis) {
          if (!inside[axis] || values[at + steps[axis]] == common) continue;
          ++slices[k].all;
          slices[k].equal += values[at + steps[axis]] == values[at];
        }
      }
  });
  Pairs sum;
  for (const Pairs& p : slices) {
    sum.all += p.all;
    sum.equal += p.equal;
  }
  return sum;
}

/// Which name each value has, and which are outside.
class Naming {
 public:
  Naming(const Image& image, const LabelOptions& options, std::vector<std::string>& notes) {
    for (const LabelName& n : image.names) names_[n.value] = n.name;
    for (const LabelName& n : options.names) names_[n.value] = n.name;
    for (const LabelMerge& merge : options.merge)
      for (const std::int64_t value : merge.values) {
        if (!merged_.insert(value).second)
          throw OptionError(fmt::format("the value {} is merged twice (`merge`)", value));
        names_[value] = merge.name;
      }
    NameCleaning cleaning;
    for (auto& [value, name] : names_) cleaning.clean(name);
    cleaning.tell(notes);
    const std::vector<std::int64_t> outside = options.ignore.value_or(std::vector<std::int64_t>{0});
    ignored_.insert(outside.begin(), outside.end());
    for (const std::int64_t value : merged_) {
      if (!ignored_.contains(value)) continue;
      // 0 is ignored unless somebody says otherwise.
      if (options.ignore)
        throw OptionError(fmt::format("the value {} is both ignored and merged (`ignore`, `merge`)", value));
      ignored_.erase(value);
    }
  }

  bool is_ignored(std::int64_t value) const { return ignored_.contains(value); }
  std::string name_of(std::int64_t value) const {
    const auto found = names_.find(value);
    return found != names_.end() && !found->second.empty() ? found->second : fmt::format("label {}", value);
  }

 private:
  std::map<std::int64_t, std::string> names_;
  std::set<std::int64_t> ignored_, merged_;
};

/// The regions of values, and what is said about it.
class Regions {
 public:
  Regions(const std::vector<ValueCount>& counts, const Naming& naming, LabelImage& out) : out_(out) {
    for (const ValueCount& c : counts) {
      if (naming.is_ignored(c.value)) {
        note_ignored(c);
        region_of_[c.value] = LabelImage::kNoRegion;
      } else {
        region_of_[c.value] = region_named(naming.name_of(c.value), c.value);
      }
    }
    if (out.labels.empty()) throw InputError("every value of the image is ignored: no region is left (`ignore`)");
    if (!ignored_.empty()) out.notes.push_back(fmt::format("outside of all regions: {}", ignored_));
    for (const auto& [name, values] : values_of_)
      if (values.size() > 1) note_joined(name, values);
  }

  std::uint16_t of(std::int64_t value) const { return region_of_.find(value)->second; }

 private:
  std::uint16_t region_named(const std::string& name, std::int64_t value) {
    values_of_[name].push_back(value);
    const auto [found, is_new] = index_of_.emplace(name, static_cast<std::uint16_t>(out_.labels.size()));
    if (is_new) out_.labels.push_back({value, name});
    return found->second;
  }
  void note_ignored(const ValueCount& c) {
    ignored_ += fmt::format("{}value {} ({})", ignored_.empty() ? "" : ", ", c.value, counted(c.voxels, "voxel"));
  }
  void note_joined(const std::string& name, const std::vector<std::int64_t>& values) {
    std::string list;
    for (const std::int64_t v : values) list += fmt::format("{}{}", list.empty() ? "" : ", ", v);
    out_.notes.push_back(fmt::format("values {} are one region, \"{}\"", list, name));
  }

  LabelImage& out_;
  std::map<std::int64_t, std::uint16_t> region_of_;
  std::map<std::string, std::uint16_t> index_of_;
  std::map<std::string, std::vector<std::int64_t>> values_of_;
  std::string ignored_;
};

}  // namespace

std::optional<std::vector<ValueCount>> count_values(const Image& image) {
  return std::visit([](const auto& values) { return counts_of(values); }, image.values);
}

bool looks_like_labels(const Image& image) {
  const std::optional<std::vector<ValueCount>> counts = count_values(image);
  if (!counts || counts->empty()) return false;
  // Few values are a segmentation even if it is noise.
  constexpr std::size_t kFew = 16;
  if (counts->size() <= kFew) return true;
  const auto commonest = std::max_element(counts->begin(), counts->end(),
                                          [](const auto& a, const auto& b) { return a.voxels < b.voxels; });
  const Pairs pairs = std::visit(
      [&]<class T>(const std::vector<T>& values) {
        return pairs_of(values, image.grid.size, static_cast<T>(commonest->value));
      },
      image.values);
  return pairs.all > 0 && 2 * pairs.equal >= pairs.all;
}

std::vector<std::uint8_t> faces_reached(const LabelImage& image) {
  std::vector<std::uint8_t> reached(image.labels.size());
  const std::uint32_t ni = image.grid.size[0], nj = image.grid.size[1], nk = image.grid.size[2];
  const auto see = [&](std::size_t i, std::size_t j, std::size_t k, unsigned face) {
    const std::uint16_t r = image.regions[i + ni * (j + std::size_t{nj} * k)];
    if (r != LabelImage::kNoRegion) reached[r] = static_cast<std::uint8_t>(reached[r] | 1u << face);
  };
  for (std::size_t k = 0; k < nk; ++k)
    for (std::size_t j = 0; j < nj; ++j) {
      see(0, j, k, 0);
      see(ni - 1, j, k, 1);
    }
  for (std::size_t k = 0; k < nk; ++k)
    for (std::size_t i = 0; i < ni; ++i) {
      see(i, 0, k, 2);
      see(i, nj - 1, k, 3);
    }
  for (std::size_t j = 0; j < nj; ++j)
    for (std::size_t i = 0; i < ni; ++i) {
      see(i, j, 0, 4);
      see(i, j, nk - 1, 5);
    }
  return reached;
}

LabelImage labels_of(const Image& image, const LabelOptions& options) {
  const std::optional<std::vector<ValueCount>> counts = count_values(image);
  if (!counts)
    throw InputError(
        "its values are not labels: they are no whole numbers, or more than 65,534 different ones; a grey image is "
        "meshed by its values (`iso`, `band`)");
  LabelImage out;
  out.grid = image.grid;
  const Naming naming(image, options, out.notes);
  const Regions regions(*counts, naming, out);
  out.regions.resize(image.grid.voxels());
  std::visit(
      [&](const auto& values) {
        parallel_ranges(values.size(), Split::kAdaptive, [&](std::size_t begin, std::size_t end) {
          // Neighbours mostly have the same value.
          auto last = values[begin];
          std::uint16_t region = regions.of(static_cast<std::int64_t>(last));
          for (std::size_t i = begin; i < end; ++i) {
            if (values[i] != last) {
              last = values[i];
              region = regions.of(static_cast<std::int64_t>(last));
            }
            out.regions[i] = region;
          }
        });
      },
      image.values);
  return out;
}

}  // namespace octafront
