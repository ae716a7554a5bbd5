#include "charts.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

namespace octafront::cli {

namespace {

using Align = Canvas::Align;

constexpr double kWidth = 640, kHeight = 400, kLeft = 64, kRight = 24, kTop = 78, kBottom = 54;
/// An exponent means nothing unless the points span this factor.
constexpr double kLeastSpan = 8;
constexpr Colour kGrid = 0xdddddd, kInk = 0x222222;

struct Frame {
  double x0 = kLeft, x1 = kWidth - kRight, y0 = kHeight - kBottom, y1 = kTop;
};

void title_and_legend(Canvas& canvas, const std::string& title, const std::vector<Series>& series) {
  canvas.text({kLeft, 22}, title, {14});
  double x = kLeft, y = 44;
  for (const Series& s : series) {
    const double width = 32 + canvas.width_of(s.name, 11);
    if (x + width > kWidth) x = kLeft, y += 18;
    canvas.rectangle(x, y - 9, 10, 10, s.colour);
    canvas.text({x + 14, y}, s.name, {11});
    x += width;
  }
}

/// A round step that divides [0, most] in about five.
double round_step(double most) {
  const double raw = most / 5, ten = std::pow(10, std::floor(std::log10(raw)));
  for (const double m : {1.0, 2.0, 2.5, 5.0})
    if (raw <= m * ten) return m * ten;
  return 10 * ten;
}

double bar_maximum(const BarChart& chart) {
  double most = 0;
  for (std::size_t g = 0; g < chart.groups.size(); ++g) {
    double sum = 0;
    for (const Series& s : chart.series) {
      sum = chart.stacked ? sum + s.values[g] : std::max(sum, s.values[g]);
    }
    most = std::max(most, sum);
  }
  return most > 0 ? most : 1;
}

void y_axis(Canvas& canvas, const Frame& f, double most, const std::string& label) {
  const double step = round_step(most);
  for (int i = 0; i * step <= most * 1.0001; ++i) {
    const double y = f.y0 - (f.y0 - f.y1) * i * step / most;
    canvas.line({f.x0, y}, {f.x1, y}, {kGrid});
    canvas.text({f.x0 - 6, y + 4}, fmt::format("{:g}", i * step), {10, Align::kRight});
  }
  canvas.text({16, 0.5 * (f.y0 + f.y1)}, label, {11, Align::kMiddle, kInk, true});
}

/// Names that do not fit side by side are written in two rows, by turns.
void group_label(Canvas& canvas, const Frame& f, std::size_t g, const BarChart& chart) {
  const double width = (f.x1 - f.x0) / static_cast<double>(chart.groups.size());
  double widest = 0;
  for (const std::string& name : chart.groups) widest = std::max(widest, canvas.width_of(name, 10));
  const double down = widest > width - 4 && g % 2 == 1 ? 13 : 0;
  canvas.text({f.x0 + width * (static_cast<double>(g) + 0.5), f.y0 + 15 + down}, chart.groups[g], {10, Align::kMiddle});
}

void bars_of_group(Canvas& canvas, const Frame& f, const BarChart& chart, std::size_t g, double most) {
  const double width = (f.x1 - f.x0) / static_cast<double>(chart.groups.size());
  const double bar = 0.8 * width / (chart.stacked ? 1.0 : static_cast<double>(chart.series.size()));
  double x = f.x0 + width * (static_cast<double>(g) + 0.1), base = f.y0;
  for (const Series& s : chart.series) {
    const double height = (f.y0 - f.y1) * s.values[g] / most;
    canvas.rectangle(x, base - height, bar * 0.94, height, s.colour);
    if (chart.write_values)  // in as few characters as say something: small values stand close together
      canvas.text({x + 0.47 * bar, base - height - 3}, fmt::format("{:.{}g}", s.values[g], s.values[g] < 1 ? 2 : 3),
                  {8.5, Align::kMiddle});
    if (chart.stacked)
      base -= height;
    else
      x += bar;
  }
}

/// A logarithmic axis over whole powers of ten.
struct LogAxis {
  double lo, hi;  ///< powers
  LogAxis(double least, double most) : lo(std::floor(std::log10(least))), hi(std::ceil(std::log10(most))) {
    if (hi <= lo) hi = lo + 1;
  }
  double at(double value) const { return (std::log10(value) - lo) / (hi - lo); }
};

std::string power_label(double power) {
  const double value = std::pow(10, power);
  if (power >= 6) return fmt::format("{:g} M", value / 1e6);
  if (power >= 3) return fmt::format("{:g} k", value / 1e3);
  return fmt::format("{:g}", value);
}

void log_grid(Canvas& canvas, const Frame& f, const LogAxis& x, const LogAxis& y, const ScatterChart& chart) {
  for (double p = x.lo; p <= x.hi; ++p) {
    const double at = f.x0 + (f.x1 - f.x0) * (p - x.lo) / (x.hi - x.lo);
    canvas.line({at, f.y0}, {at, f.y1}, {kGrid});
    canvas.text({at, f.y0 + 15}, power_label(p), {10, Align::kMiddle});
  }
  for (double p = y.lo; p <= y.hi; ++p) {
    const double at = f.y0 - (f.y0 - f.y1) * (p - y.lo) / (y.hi - y.lo);
    canvas.line({f.x0, at}, {f.x1, at}, {kGrid});
    canvas.text({f.x0 - 6, at + 4}, power_label(p), {10, Align::kRight});
  }
  canvas.text({0.5 * (f.x0 + f.x1), kHeight - 14}, chart.x_label, {11, Align::kMiddle});
  canvas.text({16, 0.5 * (f.y0 + f.y1)}, chart.y_label, {11, Align::kMiddle, kInk, true});
}

void scatter_series(Canvas& canvas, const Frame& f, const LogAxis& x, const LogAxis& y, const Series& s) {
  const auto px = [&](double v) { return f.x0 + (f.x1 - f.x0) * x.at(v); };
  const auto py = [&](double v) { return f.y0 - (f.y0 - f.y1) * y.at(v); };
  const PowerLaw law = fit_power_law(s.points);
  if (law.exponent != 0) {
    const auto [least, most] = std::minmax_element(s.points.begin(), s.points.end());
    const auto value = [&](double v) { return law.factor * std::pow(v, law.exponent); };
    canvas.line({px(least->first), py(value(least->first))}, {px(most->first), py(value(most->first))},
                {s.colour, 1.2, true});
  }
  for (const auto& [u, v] : s.points) canvas.dot(px(u), py(v), 3.2, s.colour);
}

}  // namespace

PowerLaw fit_power_law(const std::vector<std::pair<double, double>>& points) {
  if (points.empty()) return {};
  const auto [least, most] = std::minmax_element(points.begin(), points.end());
  if (most->first < kLeastSpan * least->first) return {};
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (const auto& [x, y] : points) {
    if (x <= 0 || y <= 0) continue;
    const double u = std::log(x), v = std::log(y);
    n += 1, sx += u, sy += v, sxx += u * u, sxy += u * v;
  }
  const double spread = n * sxx - sx * sx;
  if (n < 2 || spread < 1e-9 * n * n) return {};
  const double exponent = (n * sxy - sx * sy) / spread;
  return {std::exp((sy - exponent * sx) / n), exponent};
}

void draw_bars(const std::filesystem::path& stem, const BarChart& chart) {
  if (chart.groups.empty() || chart.series.empty()) return;
  draw(stem, kWidth, kHeight, [&](Canvas& canvas) {
    const Frame f;
    const double most = bar_maximum(chart) * 1.06;
    title_and_legend(canvas, chart.title, chart.series);
    y_axis(canvas, f, most, chart.y_label);
    for (std::size_t g = 0; g < chart.groups.size(); ++g) {
      bars_of_group(canvas, f, chart, g, most);
      group_label(canvas, f, g, chart);
    }
    canvas.line({f.x0, f.y0}, {f.x1, f.y0}, {kInk});
  });
}

void draw_scatter(const std::filesystem::path& stem, const ScatterChart& chart) {
  std::vector<std::pair<double, double>> all;
  for (const Series& s : chart.series) all.insert(all.end(), s.points.begin(), s.points.end());
  std::erase_if(all, [](const auto& p) { return p.first <= 0 || p.second <= 0; });
  if (all.empty()) return;
  const auto by_y = [](const auto& a, const auto& b) { return a.second < b.second; };
  const auto [x_least, x_most] = std::minmax_element(all.begin(), all.end());
  const auto [y_least, y_most] = std::minmax_element(all.begin(), all.end(), by_y);
  const LogAxis x(x_least->first, x_most->first), y(y_least->second, y_most->second);
  std::vector<Series> named = chart.series;
  for (Series& s : named) {
    std::erase_if(s.points, [](const auto& p) { return p.first <= 0 || p.second <= 0; });
    if (const PowerLaw law = fit_power_law(s.points); law.exponent != 0)
      s.name += fmt::format(": time ~ n^{:.2f}", law.exponent);
  }
  draw(stem, kWidth, kHeight, [&](Canvas& canvas) {
    const Frame f;
    title_and_legend(canvas, chart.title, named);
    log_grid(canvas, f, x, y, chart);
    for (const Series& s : named) scatter_series(canvas, f, x, y, s);
  });
}

}  // namespace octafront::cli
