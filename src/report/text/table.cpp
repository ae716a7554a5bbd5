#include <octafront/report.h>

#include "base/core/wording.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/core.h>

namespace octafront {

namespace {

// 1234567 -> "1 234 567"
std::string grouped(std::uint64_t n) {
  std::string digits = std::to_string(n);
  for (int at = static_cast<int>(digits.size()) - 3; at > 0; at -= 3)
    digits.insert(static_cast<std::size_t>(at), 1, ' ');
  return digits;
}

std::string bar(double share) {
  constexpr int kWidth = 40;
  return std::string(static_cast<std::size_t>(std::lround(share * kWidth)), '#');
}

std::string counted_in_groups(std::uint64_t n, const std::string& one, const std::string& many = "") {
  return grouped(n) + " " + noun(n, one, many);
}

std::string count_line(const Report& report) {
  const std::string vertices = counted_in_groups(report.points, "vertex", "vertices");
  if (report.tets == 0) {
    if (report.boundary_faces == 0) return "";
    return counted_in_groups(report.boundary_faces, "triangle") + ", " + vertices + "\n";
  }
  std::string line = counted_in_groups(report.tets, "tetrahedron", "tetrahedra") + ", " + vertices + ", " +
                     counted_in_groups(report.boundary_faces, "boundary triangle");
  // Nobody counts the bodies of a mesh that was there before, and an open surface has none.
  if (report.bodies > 0) line += ", " + counted(report.bodies, "body", "bodies");
  return line + "\n";
}

double percent_off(double volume, double of) {
  return 100 * (volume / of - 1);
}

std::string volume_line(const Report& report) {
  // An open surface encloses nothing to compare with.
  if (report.true_volume > 0)
    return fmt::format("volume {:.6g} (CAD {:.6g}, {:+.3f} %)\n", report.volume, report.true_volume,
                       percent_off(report.volume, report.true_volume));
  if (report.input_volume == 0) return fmt::format("volume {:.6g}\n", report.volume);
  return fmt::format("volume {:.6g} (input {:.6g}, {:+.3f} %)\n", report.volume, report.input_volume,
                     percent_off(report.volume, report.input_volume));
}

std::string stage_lines(const Report& report) {
  std::string out = fmt::format("{:<34}{:>10}{:>10}\n", "stage", "wall s", "cpu s");
  for (const StageReport& s : report.stages)
    out += fmt::format("  {:<32}{:>10.3f}{:>10.3f}\n", s.name, s.wall_seconds, s.cpu_seconds);
  out += fmt::format("  {:<32}{:>10.3f}{:>10.3f}\n", "total", report.wall_seconds, report.cpu_seconds);
  return out;
}

std::string note_lines(const Report& report) {
  std::string out;
  for (const StageReport& s : report.stages)
    for (const std::string& note : s.notes) out += fmt::format("note ({}): {}\n", s.name, note);
  return out;
}

/// No angle above 0 is told as 0.
std::string small_degrees(double angle) {
  return angle < 1 ? fmt::format("{:.2g}", angle) : fmt::format("{:.1f}", angle);
}

std::string quality_lines(const QualitySummary& q) {
  constexpr const char* kClasses[5] = {"0.0 - 0.2", "0.2 - 0.4", "0.4 - 0.6", "0.6 - 0.8", "0.8 - 1.0"};
  std::string out = "quality, beta = 3 r / R\n";
  for (int c = 0; c < 5; ++c) {
    const double share =
        static_cast<double>(q.beta_classes[c]) / static_cast<double>(std::max<std::uint64_t>(1, q.elements));
    out += fmt::format("  {}{:>16}{:>9.3f} %  {}\n", kClasses[c], grouped(q.beta_classes[c]), 100 * share, bar(share));
  }
  out += fmt::format("  mean {:.4f}, least {:.4f} (tet {} at {})\n", q.beta_mean, q.beta_min, q.beta_min_tet,
                     at_point(q.beta_min_at));
  out += fmt::format("  dihedral angles from {} to {:.1f} degrees\n", small_degrees(q.dihedral_min), q.dihedral_max);
  return out +
         fmt::format("  the least angle is one of tet {} at {}\n", q.dihedral_min_tet, at_point(q.dihedral_min_at));
}

std::string layered_wall(const LayerSummary& w) {
  const std::string patch = w.patch.empty() ? "(no name)" : w.patch;
  return w.region.empty() ? patch : patch + " in " + w.region;
}

std::string layer_lines(const std::vector<LayerSummary>& walls) {
  std::string out = fmt::format("{:<22} {:>9} {:>7} {:>7} {:>10} {:>10} {:>7} {:>6}\n", "boundary layers on", "faces",
                                "full", "layers", "first min", "median", "height", "SJ");
  for (const LayerSummary& w : walls) {
    out += fmt::format("{:<22} {:>9} {:>5.1f} % {:>7.2f} {:>10.4g} {:>10.4g} {:>5.1f} % {:>6.3f}\n", layered_wall(w),
                       grouped(w.faces), 100 * w.full, w.mean_count, w.first_min, w.first_median, 100 * w.thickness,
                       w.min_scaled_jacobian);
    std::string stopped;
    for (const auto& [reason, part] : w.stopped)
      stopped += fmt::format("{}{} {:.2g} %", stopped.empty() ? "" : ", ", reason, 100 * part);
    if (!stopped.empty()) out += fmt::format("  stopped by: {}\n", stopped);
  }
  return out;
}

std::string second_order_lines(const SecondOrderSummary& s) {
  std::string out = fmt::format("curved, every element proven valid\n  edges {}: {} curved, {} eased, {} straight\n",
                                grouped(s.edges), grouped(s.curved), grouped(s.eased), grouped(s.straight));
  if (s.moved + s.held > 0)
    out += fmt::format("  corners moved to the smooth surface: {}; held back: {}\n", grouped(s.moved), grouped(s.held));
  if (s.eased_faces > 0) out += fmt::format("  faces eased: {}\n", grouped(s.eased_faces));
  return out + fmt::format("  least scaled Jacobian {:.4f} (tet {}), largest bend {:.3f} of an edge\n",
                           s.least_scaled_jacobian, s.least_tet, s.largest_bend);
}

constexpr std::size_t kMostRegionLines = 24;

std::string region_lines(const std::vector<RegionSummary>& regions) {
  const bool has_size = std::ranges::any_of(regions, [](const RegionSummary& r) { return r.needed > 0; });
  std::string out = fmt::format("{:<32}{:>12}{:>14}{:>12}{:>12}{}\n", "region", "tetrahedra", "volume", "mean beta",
                                "least beta", has_size ? "   by size" : "");
  for (std::size_t r = 0; r < std::min(regions.size(), kMostRegionLines); ++r) {
    const RegionSummary& region = regions[r];
    out += fmt::format("  {:<30.30}{:>12}{:>14.6g}{:>12.4f}{:>12.4f}{}\n", region_label(region.name, r, regions.size()),
                       grouped(region.quality.elements), region.volume, region.quality.beta_mean,
                       region.quality.beta_min, has_size ? fmt::format("{:>10.0f}", region.needed) : "");
    if (region.true_volume > 0)
      out += fmt::format("  {:<30}{:>12}{:>14.6g} ({:+.3f} %)\n", "  of the CAD solid", "", region.true_volume,
                         percent_off(region.volume + region.layers_volume, region.true_volume));
  }
  if (regions.size() > kMostRegionLines)
    out += fmt::format("  ... and {} more: all of them are in the JSON report\n", regions.size() - kMostRegionLines);
  return out;
}

/// The walls that have many more triangles than the size needs; none where that is little of all.
std::string wall_lines(const std::vector<WallSummary>& walls) {
  constexpr std::size_t kMost = 5;
  constexpr double kMany = 1.3, kPart = 0.02;  // times what is needed; of the triangles of all walls
  double all = 0;
  for (const WallSummary& w : walls) all += static_cast<double>(w.triangles);
  std::string out;
  for (const WallSummary& w : std::span(walls).first(std::min(walls.size(), kMost))) {
    const auto made = static_cast<double>(w.triangles);
    if (made < kMany * w.needed || made - w.needed < kPart * all) continue;
    out += fmt::format("  {:<60.60}{:>12}{:>12.0f}\n", fmt::format("{} | {}", w.regions[0], w.regions[1]),
                       grouped(w.triangles), w.needed);
  }
  return out.empty()
             ? out
             : fmt::format("{:<62}{:>12}{:>12}\n", "walls with most over the size", "triangles", "by size") + out;
}

std::string contact_lines(const std::vector<ContactSummary>& contacts) {
  std::string out = fmt::format("{:<62}{:>12}{:>12}\n", "opened contacts", "triangles", "other side");
  for (const ContactSummary& c : std::span(contacts).first(std::min(contacts.size(), kMostRegionLines)))
    out += fmt::format("  {:<60.60}{:>12}{:>12}\n", c.patches[0], grouped(c.triangles[0]), grouped(c.triangles[1]));
  if (contacts.size() > kMostRegionLines)
    out += fmt::format("  ... and {} more: all of them are in the JSON report\n", contacts.size() - kMostRegionLines);
  return out;
}

std::string size_line(const char* what, const SizeSummary& s) {
  return fmt::format("  {:<16}mean {:.3f} of the length wanted, {:.1f} % within 0.7 - 1.4\n", what, s.mean_ratio,
                     100 * s.share_within);
}

}  // namespace

std::string to_table(const Report& report) {
  std::string out;
  out += count_line(report);
  if (report.expected_tets > 0)
    out += counted_in_groups(static_cast<std::uint64_t>(report.expected_tets), "tetrahedron", "tetrahedra") +
           " expected from the sizes\n";
  if (report.boundary_faces > 0) out += volume_line(report);
  if (report.tets > 0) out.append("\n").append(quality_lines(report.quality));
  if (report.regions.size() > 1) out += region_lines(report.regions) + wall_lines(report.walls);
  if (!report.contacts.empty()) out += contact_lines(report.contacts);
  if (!report.layers.empty()) out += layer_lines(report.layers);
  if (report.second_order.edges > 0) out += second_order_lines(report.second_order);
  if (report.surface_edges.edges > 0) out += "edge lengths\n" + size_line("surface", report.surface_edges);
  if (report.volume_edges.edges > 0) out += size_line("volume", report.volume_edges);
  out.append("\n").append(stage_lines(report));
  out += fmt::format("peak memory {:.0f} MB\n", static_cast<double>(report.peak_memory_bytes) / 1e6);
  out += note_lines(report);
  return out;
}

}  // namespace octafront
