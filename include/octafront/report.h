#pragma once

#include <octafront/quality.h>
#include <octafront/repair.h>
#include <octafront/second_order.h>
#include <octafront/solver_checks.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace octafront {

/// A note with what programs want to know of it.
struct Finding {
  std::string code;    ///< of its kind, the same in all versions: docs/use/command-line.md lists them
  std::string text;    ///< the note, a sentence for the user
  std::string region;  ///< that it is about; empty: none, or all
  std::vector<std::pair<std::string, double>> values = {};  ///< e.g. {"change_percent", -49.1}, in a fixed order
  std::optional<Vec3> at = {};                              ///< the place, where it is one; input units
};

/// What one stage did: its time, and counters that do not jitter between runs.
struct StageReport {
  std::string name;
  double wall_seconds = 0;
  double cpu_seconds = 0;                                ///< user and system time of the whole process during the stage
  std::vector<std::pair<std::string, double>> counters;  ///< e.g. {"candidates tried", 1.2e6}, in a fixed order
  std::vector<std::string> notes;  ///< sentences for the user; fields of Options in backquotes: "lower `max_size`"
  std::vector<Finding> findings;   ///< those of the notes that have a code

  void count(std::string key, double value) { counters.emplace_back(std::move(key), value); }
  void note(Finding finding) {
    notes.push_back(finding.text);
    findings.push_back(std::move(finding));
  }
};

/// Edge lengths made over edge lengths wanted (size field at the middle of the edge), over all edges of a mesh.
struct SizeSummary {
  std::uint64_t edges = 0;
  double mean_ratio = 0;
  double share_within = 0;  ///< part of the edges with a ratio within [0.7, 1.4]
};

/// One region of a mesh.
struct RegionSummary {
  std::string name;          ///< may be empty
  double volume = 0;         ///< input unit cubed; of curved elements as they are curved
  double layers_volume = 0;  ///< of the boundary layers in it, which are a region of their own
  double input_volume = 0;   ///< of the input's region of this name; 0: not known
  double true_volume = 0;    ///< of the CAD solid; 0: not known
  double needed = 0;         ///< regular tetrahedra of SizeOptions::size that have its volume; 0: no size was given
  QualitySummary quality;
};

/// All walls between two regions of a mesh with several.
struct WallSummary {
  std::array<std::string, 2> regions;  ///< names; "outside"
  std::uint64_t triangles = 0;
  double area = 0;    ///< input unit squared
  double needed = 0;  ///< regular triangles of SizeOptions::size that have this area
};

/// A contact that is open (TetMesh::opened_contacts).
struct ContactSummary {
  std::array<std::string, 2> patches;  ///< names
  std::array<std::uint64_t, 2> triangles = {0, 0};
  std::array<double, 2> areas = {0, 0};  ///< input unit squared
  bool conforming = true;                ///< the triangles of both are the same
};

/// The boundary layers of one wall.
struct LayerSummary {
  std::string patch;   ///< its name; may be empty
  std::string region;  ///< that they grow in; empty where there is one
  std::uint64_t faces = 0;
  double full = 0;                                        ///< part of the faces with all layers as high as asked
  double with_some = 0;                                   ///< part of the faces with at least one layer at each corner
  double mean_count = 0, asked_count = 0;                 ///< layers at a corner of a face
  double first_min = 0, first_median = 0, first_max = 0;  ///< heights of first layers at vertices, input units
  double thickness = 0;                                   ///< mean height over that asked, at corners of faces
  double min_scaled_jacobian = 0;                         ///< of whole prisms
  std::vector<std::pair<std::string, double>> stopped = {};  ///< reasons, and the part of the faces that each stopped
};

/// What a whole run did and made.
struct Report {
  std::vector<StageReport> stages;                         ///< in the order in which they ran
  std::uint64_t points = 0, tets = 0, boundary_faces = 0;  ///< points: mid-side nodes too
  std::uint32_t bodies = 0;
  double volume = 0;                   ///< of the mesh, input unit cubed
  double input_volume = 0;             ///< enclosed by the repaired input
  double true_volume = 0;              ///< of the CAD solids; 0: not known
  double expected_tets = 0;            ///< predicted by the sizes before the volume is meshed
  QualitySummary quality;              ///< of the elements with straight edges
  std::vector<RegionSummary> regions;  ///< by number; empty if the mesh has only one
  std::vector<WallSummary> walls;  ///< those with most triangles over what is needed first; empty: no size was given
  std::vector<ContactSummary> contacts;  ///< that are open, by the number of the first patch
  std::vector<LayerSummary> layers;      ///< by patch; empty: none were asked for
  SecondOrderSummary second_order;       ///< edges == 0: the mesh is linear
  SizeSummary surface_edges, volume_edges;
  double wall_seconds = 0, cpu_seconds = 0;
  std::uint64_t peak_memory_bytes = 0;  ///< of the process
  std::uint64_t hash = 0;               ///< of the mesh, bit for bit (coordinates and connectivity)
};

/// The report as indented JSON, one object; keys as the fields above, units in the names.
std::string to_json(const Report& report);

/// What checks found, as JSON with the places: an object, for findings of a solver's limits an array of them.
std::string to_json(const SurfaceDefects& defects);
std::string to_json(const JacobianSummary& found);
std::string to_json(const std::vector<SolverFinding>& findings);

/// The report as a table for a terminal, at most 100 columns wide but for notes.
std::string to_table(const Report& report);

}  // namespace octafront
