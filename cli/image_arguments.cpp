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

std::vector<double> spacing_of(const std::string& typed) {
  std::vector<double> spacing;
  for (const std::string& word : CLI::detail::split(typed, ',')) spacing.push_back(finite("--resample", typed, word));
  if (spacing.size() != 1 && spacing.size() != 3) refuse("--resample", typed, "is neither one size nor three");
  for (const double s : spacing)
    if (!(s > 0)) refuse("--resample", typed, "has a size that is not above 0");
  return spacing;
}

Electrode electrode_of(const std::string& typed) {
  const std::vector<std::string> words = CLI::detail::split(typed, ':');
  std::vector<double> numbers;
  if (words.size() == 3)
    for (const std::string& word : CLI::detail::split(words[0], ','))
      numbers.push_back(finite("--electrode", typed, word));
  if (numbers.size() != 3) refuse("--electrode", typed, "is no disc; write X,Y,Z:RADIUS:HEIGHT, such as 0,90,30:12:4");
  const Electrode made{{numbers[0], numbers[1], numbers[2]},
                       finite("--electrode", typed, words[1]),
                       finite("--electrode", typed, words[2])};
  if (!(made.radius > 0 && made.height > 0)) refuse("--electrode", typed, "has a radius or height that is not above 0");
  return made;
}

FileOfLabel surface_of_label(const std::string& typed) {
  const std::size_t equals = typed.find('=');
  if (equals == 0 || equals == std::string::npos || equals + 1 == typed.size())
    refuse("--surface-of", typed, "has no label or no file; write LABEL=FILE, such as 2=pial.stl");
  return {typed.substr(0, equals), typed.substr(equals + 1)};
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

std::vector<LineOption> image_line_options() {
  constexpr std::string_view kCommands = "mesh surface size check picture", kGroup = "Images";
  const auto to_image = [](auto take) {
    return each([take](Arguments& a, const std::string& typed) { take(a.intake.image, typed); });
  };
  return {
      {kCommands, kGroup, "--iso", "V",
       "Grey image: what has this value or more is one region; its surface lies between voxels",
       to_image([](ImageIntake& image, const std::string& typed) {
         image.regions.bands.push_back({finite("--iso", typed, typed), std::numeric_limits<double>::infinity(), {}});
       })},
      {kCommands, kGroup, "--band", "[NAME=]LO:HI",
       "Grey image: values from LO up to below HI are a region; several for several materials, which share their "
       "surfaces; one end may be missing",
       to_image([](ImageIntake& image, const std::string& typed) { image.regions.bands.push_back(grey_band(typed)); })},
      {kCommands, kGroup, "--labels", "FILE",
       "Names of labels: lines such as \"3 liver\", JSON, label files of ITK-SNAP, colour tables of 3D Slicer [those "
       "of the file, else \"label 3\"]",
       to_image([](ImageIntake& image, const std::string& typed) { image.names_file = typed; })},
      {kCommands, kGroup, "--ignore", "A,B,...", "Labels outside of all regions; none: no label is [0]",
       to_image([](ImageIntake& image, const std::string& typed) {
         image.regions.labels.ignore =
             typed == "none" ? std::vector<std::int64_t>{} : whole_numbers("--ignore", typed, typed);
       })},
      {kCommands, kGroup, "--merge", "A,B=NAME", "These labels are one region",
       to_image([](ImageIntake& image, const std::string& typed) {
         image.regions.labels.merge.push_back(label_merge(typed));
       })},
      {kCommands, kGroup, "--electrode", "X,Y,Z:RADIUS:HEIGHT",
       "A disc on the skin at this point, a region of its own; may be repeated",
       to_image([](ImageIntake& image, const std::string& typed) {
         image.regions.electrodes.push_back(electrode_of(typed));
       })},
      {kCommands, kGroup, "--surface-of", "LABEL=FILE",
       "A closed surface of a label, by its name or number: near it voxels follow it, and vertices lie on it; may be "
       "repeated",
       to_image([](ImageIntake& image, const std::string& typed) {
         image.surface_files.push_back(surface_of_label(typed));
       })},
      {kCommands, kGroup, "--crop", "I0:I1,J0:J1,K0:K1",
       "Only these voxels along i, j and k, counted from 0, the last ones too; an end that is missing stays",
       to_image([](ImageIntake& image, const std::string& typed) { image.crop = voxel_ranges(typed); })},
      {kCommands, kGroup, "--resample", "S|SI,SJ,SK", "Voxels of this size, or of these along i, j and k, first",
       to_image([](ImageIntake& image, const std::string& typed) { image.resample = spacing_of(typed); })},
  };
}

}  // namespace octafront::cli
