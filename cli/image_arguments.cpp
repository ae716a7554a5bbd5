#include "image_arguments.h"

#include <cmath>
#include <limits>

#include <fmt/core.h>

namespace octafront::cli {

namespace {

[[noreturn]] void refuse(const std::string& option, const std::string& typed, const std::string& why) {
  throw CLI::ValidationError(option, fmt::format("\"{}\" {}", typed, why));
}

std::int64_t whole(const std::string& option, const std::string& typed, const std::string& word) {
  std::int64_t value = 0;
  if (!CLI::detail::lexical_cast(CLI::detail::trim_copy(word), value))
    refuse(option, typed, fmt::format("has \"{}\" where a whole number should be", word));
  return value;
}

double finite(const std::string& option, const std::string& typed, const std::string& word) {
  double value = 0;
  if (!CLI::detail::lexical_cast(CLI::detail::trim_copy(word), value) || !std::isfinite(value))
    refuse(option, typed, fmt::format("has \"{}\" where a number should be", word));
  return value;
}

std::vector<std::int64_t> whole_numbers(const std::string& option, const std::string& typed, const std::string& list) {
  std::vector<std::int64_t> values;
  for (const std::string& word : CLI::detail::split(list, ',')) values.push_back(whole(option, typed, word));
  return values;
}

/// Calls `take` with what stands behind an option, each time it stands there.
template <class Take>
CLI::Option* add(CLI::App& group, const std::string& option, const std::string& type, const std::string& help,
                 const Take& take) {
  return group
      .add_option_function<std::vector<std::string>>(
          option,
          [take](const std::vector<std::string>& all) {
            for (const std::string& typed : all) take(typed);
          },
          help)
      ->type_name(type)
      ->allow_extra_args(false);
}

void declare_values(CLI::App& group, ImageIntake& a) {
  add(group, "--image", "auto|labels|grey",
      "What the voxels hold; auto: labels if they are whole numbers that neighbours mostly share [auto]",
      [&a](const std::string& typed) {
        using Kind = ImageRegions::Kind;
        a.regions.kind = typed == "labels" ? Kind::kLabels : typed == "grey" ? Kind::kGrey : Kind::kAuto;
        if (typed != "labels" && typed != "grey" && typed != "auto")
          refuse("--image", typed, "is none of auto, labels, grey");
      });
  add(group, "--iso", "V", "Grey image: what has this value or more is one region; its surface lies between voxels",
      [&a](const std::string& typed) {
        a.regions.bands.push_back({finite("--iso", typed, typed), std::numeric_limits<double>::infinity(), {}});
      });
  add(group, "--band", "[NAME=]LO:HI",
      "Grey image: values from LO up to below HI are a region; several for several materials, which share their "
      "surfaces; one end may be missing",
      [&a](const std::string& typed) { a.regions.bands.push_back(grey_band(typed)); });
  add(group, "--labels", "FILE",
      "Names of labels: lines such as \"3 liver\", JSON, label files of ITK-SNAP, colour tables of 3D Slicer [those of "
      "the file, else \"label 3\"]",
      [&a](const std::string& typed) { a.names_file = typed; });
  add(group, "--ignore", "A,B,...", "Labels outside of all regions; none: no label is [0]",
      [&a](const std::string& typed) {
        a.regions.labels.ignore =
            typed == "none" ? std::vector<std::int64_t>{} : whole_numbers("--ignore", typed, typed);
      });
  add(group, "--merge", "A,B=NAME", "These labels are one region",
      [&a](const std::string& typed) { a.regions.labels.merge.push_back(label_merge(typed)); });
}

void declare_cleaning(CLI::App& group, ImageIntake& a) {
  const auto volume = [](const std::string& option, const std::string& typed) {
    const double v = finite(option, typed, typed);
    if (v < 0) refuse(option, typed, "is below 0");
    return v;
  };
  add(group, "--islands", "V",
      "Pieces of regions below this volume go to what surrounds them; each region keeps its largest",
      [&a, volume](const std::string& typed) { a.regions.clean.islands = volume("--islands", typed); });
  add(group, "--holes", "V", "Pieces of the outside below this volume, not at the image's edge, are filled",
      [&a, volume](const std::string& typed) { a.regions.clean.holes = volume("--holes", typed); });
  add(group, "--close-voxels", "N", "Gaps of regions toward the outside close that are up to 2 N voxels wide",
      [&a](const std::string& typed) {
        const std::int64_t n = whole("--close-voxels", typed, typed);
        if (n < 0 || n > 64) refuse("--close-voxels", typed, "is not from 0 to 64");
        a.regions.clean.closing = static_cast<std::uint32_t>(n);
      });
}

void declare_grid(CLI::App& group, ImageIntake& a) {
  add(group, "--crop", "I0:I1,J0:J1,K0:K1",
      "Only these voxels along i, j and k, counted from 0, the last ones too; an end that is missing stays",
      [&a](const std::string& typed) { a.crop = voxel_ranges(typed); });
  add(group, "--resample", "S|SI,SJ,SK", "Voxels of this size, or of these along i, j and k, first",
      [&a](const std::string& typed) {
        a.resample.clear();
        for (const std::string& word : CLI::detail::split(typed, ','))
          a.resample.push_back(finite("--resample", typed, word));
        if (a.resample.size() != 1 && a.resample.size() != 3)
          refuse("--resample", typed, "is neither one size nor three");
        for (const double s : a.resample)
          if (!(s > 0)) refuse("--resample", typed, "has a size that is not above 0");
      });
  group
      .add_flag_function(
          "--closed-at-box", [&a](std::int64_t n) { a.regions.closed_at_box = n > 0; },
          "What reaches the edge of the image ends flat there, which is said [yes]; --closed-at-box=no: it is refused")
      ->type_name("");
}

}  // namespace

GreyBand grey_band(const std::string& typed) {
  const std::size_t equals = typed.rfind('=');
  const std::string range = equals == std::string::npos ? typed : typed.substr(equals + 1);
  const std::size_t colon = range.find(':');
  if (equals == 0 || colon == std::string::npos || range == ":")
    refuse("--band", typed, "is no range; write LO:HI or NAME=LO:HI, such as bone=226:3000 or bone=226:");
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::string lo = range.substr(0, colon), hi = range.substr(colon + 1);
  GreyBand band{lo.empty() ? -kInfinity : finite("--band", typed, lo),
                hi.empty() ? kInfinity : finite("--band", typed, hi),
                equals == std::string::npos ? std::string() : typed.substr(0, equals)};
  if (!(band.lo < band.hi)) refuse("--band", typed, "does not begin below its end");
  return band;
}

LabelMerge label_merge(const std::string& typed) {
  const std::size_t equals = typed.find('=');
  if (equals == 0 || equals == std::string::npos || equals + 1 == typed.size())
    refuse("--merge", typed, "has no labels or no name; write 3,4=cortex");
  return {typed.substr(equals + 1), whole_numbers("--merge", typed, typed.substr(0, equals))};
}

std::array<VoxelRange, 3> voxel_ranges(const std::string& typed) {
  const std::vector<std::string> words = CLI::detail::split(typed, ',');
  if (words.size() != 3)
    refuse("--crop", typed, "does not have three ranges; write I0:I1,J0:J1,K0:K1, such as 10:200,:,5:60");
  std::array<VoxelRange, 3> ranges;
  const auto end = [&](const std::string& word) -> std::optional<std::uint32_t> {
    if (word.empty()) return std::nullopt;
    const std::int64_t n = whole("--crop", typed, word);
    if (n < 0 || n > 0xfffffffe) refuse("--crop", typed, fmt::format("has the voxel {}, which no image has", n));
    return static_cast<std::uint32_t>(n);
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t colon = words[axis].find(':');
    if (colon == std::string::npos) refuse("--crop", typed, fmt::format("has \"{}\", which is no range", words[axis]));
    ranges[axis] = {end(words[axis].substr(0, colon)), end(words[axis].substr(colon + 1))};
  }
  return ranges;
}

void declare_image_choice(CLI::App& command, ImageIntake& a) {
  add(command, "--series", "N", "Which of several images of a folder or a file, counted from 1",
      [&a](const std::string& typed) {
        const std::int64_t n = whole("--series", typed, typed);
        if (n < 1 || n > 0xffffffff) refuse("--series", typed, "is not counted from 1");
        a.choice.series = static_cast<std::uint32_t>(n);
      });
}

void declare_image(CLI::App& command, ImageIntake& a) {
  auto* group = command.add_option_group("Images", "Voxels: a region per label, or per band of grey values");
  declare_image_choice(*group, a);
  declare_values(*group, a);
  declare_cleaning(*group, a);
  declare_grid(*group, a);
}

}  // namespace octafront::cli
