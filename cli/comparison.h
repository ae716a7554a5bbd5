#pragma once

#include <octafront/report.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace octafront::cli {

/// One run of `octafront compare`.
struct Comparison {
  std::string model, method;
  std::uint64_t faces = 0;           ///< of the input
  std::int64_t elements_wanted = 0;  ///< 0: not asked for
  std::string failure;               ///< empty: there is a valid mesh, and `report` tells of it
  Report report;

  /// CPU seconds of the stage that fills the volume, and of all stages of the last try for a number of elements.
  double filling_seconds() const;
  double total_seconds() const;
};

std::string table_head();
std::string table_row(const Comparison& c);

/// What the runs say together: for each method its share of poor and good elements and its speed, the fitted exponents,
/// and where the files are.
std::string summary_of(const std::vector<Comparison>& all, const std::filesystem::path& folder);

/// What write_comparison() writes into a folder: compare.csv, compare.json, and the charts beta_classes, time_elements,
/// stages, each as SVG and PNG (none if the program was built without cairo).
std::vector<std::filesystem::path> comparison_files(const std::filesystem::path& folder);

/// Throws OutputError.
void write_comparison(const std::filesystem::path& folder, const std::vector<Comparison>& all);

}  // namespace octafront::cli
