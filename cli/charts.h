#pragma once

#include "canvas.h"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace octafront::cli {

/// What one method, or one stage, contributes to a chart.
struct Series {
  std::string name;
  Colour colour = 0;
  std::vector<double> values;                     ///< of bars: one per group
  std::vector<std::pair<double, double>> points;  ///< of a scatter chart
};

/// y = factor * x^exponent, fitted to points by least squares of the logarithms.
struct PowerLaw {
  double factor = 0, exponent = 0;
};
/// An exponent of 0 where the points do not span a factor of 8 in x.
PowerLaw fit_power_law(const std::vector<std::pair<double, double>>& points);

struct BarChart {
  std::string title, y_label;
  std::vector<std::string> groups;
  std::vector<Series> series;
  bool stacked = false;  ///< bars of a group on each other, not beside
  bool write_values;     ///< above the bars
};
void draw_bars(const std::filesystem::path& stem, const BarChart& chart);

/// Both axes logarithmic; each series with its fitted power law.
struct ScatterChart {
  std::string title, x_label, y_label;
  std::vector<Series> series;
};
void draw_scatter(const std::filesystem::path& stem, const ScatterChart& chart);

}  // namespace octafront::cli
