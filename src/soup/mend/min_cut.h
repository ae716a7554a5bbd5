#pragma once

#include <cstdint>
#include <vector>

namespace octafront::mend {

/// A network between a source and a sink, and the cut of least capacity that divides it (E. A. Dinic, 1970).
class MinCut {
 public:
  explicit MinCut(std::size_t nodes) : arcs_at_(nodes + 2) {}

  /// What it costs to have the node on the side of the sink, and on that of the source; >= 0.
  void add_node_cost(std::uint32_t node, double if_sink, double if_source);
  /// What it costs to have the two on different sides; >= 0.
  void add_edge(std::uint32_t a, std::uint32_t b, double cost);

  /// Per node, whether it is on the side of the source in the cut nearest to the source.
  std::vector<char> on_source_side();

 private:
  struct Arc {
    std::uint32_t to;
    double left;
  };
  std::uint32_t source() const { return static_cast<std::uint32_t>(arcs_at_.size() - 2); }
  std::uint32_t sink() const { return source() + 1; }
  void add_arcs(std::uint32_t a, std::uint32_t b, double there, double back);
  bool find_levels();
  double push();

  std::vector<std::vector<std::uint32_t>> arcs_at_;
  std::vector<Arc> arcs_;  ///< an arc and its reverse side by side
  std::vector<std::uint32_t> level_, next_;
};

}  // namespace octafront::mend
