#include "base/core/groups.h"
#include "soup/cells/cell_steps.h"
#include "soup/tidy/steps.h"

#include <cstdlib>
#include <optional>
#include <queue>
#include <utility>

namespace octafront::cells {
namespace {

using Nested = ComplexOptions::Nested;

/// Of all triangles, those that disagree with most of their neighbours: where they are more, nobody saw to the way that
/// they face.
constexpr double kMostSlips = 0.1;

/// A triangle between two cells.
struct Wall {
  std::uint32_t front, back;
  int net;         ///< how often more it lies there forward than backward
  bool is_odd;     ///< it lies there an odd number of times
  int turned_net;  ///< `net` once neighbours are made to agree
};

class Filling {
 public:
  Filling(const Arrangement& arranged, const Cells& cells, Nested nested, const RunContext& context)
      : arranged_(arranged), cells_(cells), nested_(nested), context_(context), is_known_(cells.count(), 0) {
    result_.times.assign(cells.count(), 0);
    for (std::uint32_t t = 0; t < arranged.triangles.size(); ++t) add_wall(t);
    walls_of_ = Groups<>(cells.pieces(), [&](const auto& add) {
      for (std::uint32_t w = 0; w < walls_.size(); ++w) add(cells.piece()[triangle_[w]], w);
    });
  }

  FilledCells result() {
    if (nested_ == Nested::kByDirection) find_slips();
    const Groups<> pieces_at = pieces_by_cell();
    std::vector<char> is_done(cells_.pieces(), 0);
    std::queue<std::uint32_t> queue({0});
    is_known_[0] = 1;
    while (!queue.empty()) {
      const std::uint32_t outer = queue.front();
      queue.pop();
      for (const std::uint32_t piece : pieces_at[outer]) {
        if (std::exchange(is_done[piece], 1) != 0) continue;
        context_.check();
        for (const std::uint32_t cell : fill(piece, outer)) queue.push(cell);
      }
    }
    return std::move(result_);
  }

 private:
  void add_wall(std::uint32_t t) {
    const auto [front, back] = cells_.sides_of(t);
    if (front == back) return;
    const auto origins = arranged_.origins_of(t);
    int net = 0;
    for (const Origin& o : origins) net += o.reversed ? -1 : 1;
    walls_.push_back({front, back, net, origins.size() % 2 == 1, net});
    triangle_.push_back(t);
  }

  Groups<> pieces_by_cell() const {
    return {cells_.count(), [&](const auto& add) {
              for (std::uint32_t w = 0; w < walls_.size(); ++w)
                for (const std::uint32_t cell : {walls_[w].front, walls_[w].back})
                  add(cell, cells_.piece()[triangle_[w]]);
            }};
  }

  /// The cells of one piece, as a graph of its walls, from the one around it on.
  class Piece {
   public:
    Piece(const std::vector<Wall>& walls, std::span<const std::uint32_t> of_piece, std::uint32_t outer)
        : walls_(walls), of_piece_(of_piece) {
      for (const std::uint32_t w : of_piece)
        for (const std::uint32_t cell : {walls[w].front, walls[w].back}) cells_.push_back(cell);
      std::sort(cells_.begin(), cells_.end());
      cells_.erase(std::unique(cells_.begin(), cells_.end()), cells_.end());
      outer_ = place(outer);
      at_ = Groups<>(cells_.size(), [&](const auto& add) {
        for (const std::uint32_t w : of_piece)
          for (const std::uint32_t cell : {walls[w].front, walls[w].back}) add(place(cell), w);
      });
    }

    const std::vector<std::uint32_t>& cells() const { return cells_; }
    std::size_t outer() const { return outer_; }

    /// Values of the cells, 0 outside and step(value, wall, whether it is crossed from its front) behind a wall;
    /// nullopt if two ways to a cell give it two.
    template <class Step>
    std::optional<std::vector<int>> values(const Step& step) const {
      std::vector<int> value(cells_.size(), 0);
      std::vector<char> is_known(cells_.size(), 0);
      std::vector<std::size_t> stack{outer_};
      is_known[outer_] = 1;
      while (!stack.empty()) {
        const std::size_t here = stack.back();
        stack.pop_back();
        for (const std::uint32_t w : at_[here]) {
          const bool forward = walls_[w].front == cells_[here];
          const std::size_t there = place(forward ? walls_[w].back : walls_[w].front);
          if (std::exchange(is_known[there], 1) != 0) continue;
          value[there] = step(value[here], walls_[w], forward);
          stack.push_back(there);
        }
      }
      const bool agree = std::all_of(of_piece_.begin(), of_piece_.end(), [&](std::uint32_t w) {
        return value[place(walls_[w].back)] == step(value[place(walls_[w].front)], walls_[w], true);
      });
      return agree ? std::optional(std::move(value)) : std::nullopt;
    }

   private:
    std::size_t place(std::uint32_t cell) const {
      return static_cast<std::size_t>(std::lower_bound(cells_.begin(), cells_.end(), cell) - cells_.begin());
    }

    const std::vector<Wall>& walls_;
    std::span<const std::uint32_t> of_piece_;
    std::vector<std::uint32_t> cells_;
    Groups<> at_;
    std::size_t outer_ = 0;
  };

  /// Enters the cells that a piece encloses, and returns them.
  std::vector<std::uint32_t> fill(std::uint32_t number, std::uint32_t outer) {
    const Piece piece(walls_, walls_of_[number], outer);
    const int around = result_.times[outer];
    bool by_nesting = false;
    std::vector<int> times = times_of(piece, around, by_nesting);
    std::vector<std::uint32_t> entered;
    bool fills = false;
    for (std::size_t k = 0; k < times.size(); ++k) {
      const std::uint32_t cell = piece.cells()[k];
      if (std::exchange(is_known_[cell], 1) != 0) continue;
      result_.times[cell] = times[k];
      fills = fills || times[k] != 0;
      if (times[k] == 0) ++(by_nesting ? result_.cavities_by_nesting : result_.cavities_by_winding);
      entered.push_back(cell);
    }
    if (around != 0 && fills) ++result_.filled_shells;
    return entered;
  }

  std::vector<int> times_of(const Piece& piece, int around, bool& by_nesting) {
    if (nested_ == Nested::kByDirection && sees_to_sides_) {
      std::optional<std::vector<int>> windings = piece.values(
          [](int value, const Wall& wall, bool forward) { return forward ? value + wall.net : value - wall.net; });
      if (!windings)
        windings = piece.values([](int value, const Wall& wall, bool forward) {
          return forward ? value + wall.turned_net : value - wall.turned_net;
        });
      if (windings) {
        for (int& w : *windings) w += around;
        return std::move(*windings);
      }
    }
    if (nested_ != Nested::kRegion) {
      by_nesting = true;
      std::optional<std::vector<int>> parity =
          piece.values([](int value, const Wall& wall, bool) { return wall.is_odd ? 1 - value : value; });
      if (parity) {
        for (int& p : *parity) p = (std::abs(around) + p) % 2;
        return std::move(*parity);
      }
    }
    by_nesting = false;
    std::vector<int> all(piece.cells().size(), around < 0 ? around - 1 : around + 1);
    all[piece.outer()] = around;
    return all;
  }

  void find_slips() {
    std::size_t slips = 0;
    SurfaceMesh walls;
    walls.points = arranged_.points;
    std::vector<std::uint32_t> number;
    for (std::uint32_t w = 0; w < walls_.size(); ++w) {
      if (walls_[w].net == 0) continue;
      const auto [a, b, c] = arranged_.triangles[triangle_[w]];
      walls.triangles.push_back(walls_[w].net > 0 ? Triangle{a, b, c} : Triangle{a, c, b});
      number.push_back(w);
    }
    const std::vector<Triangle> before = walls.triangles;
    tidy::Draft draft{std::move(walls), std::move(number), context_};
    tidy::orient_pieces(draft);
    for (std::size_t k = 0; k < before.size(); ++k) {
      if (draft.mesh.triangles[k] == before[k]) continue;
      Wall& wall = walls_[draft.face[k]];
      wall.turned_net = -wall.net;
      ++slips;
    }
    sees_to_sides_ = static_cast<double>(slips) <= kMostSlips * static_cast<double>(before.size());
  }

  const Arrangement& arranged_;
  const Cells& cells_;
  Nested nested_;
  const RunContext& context_;
  std::vector<Wall> walls_;
  std::vector<std::uint32_t> triangle_;  ///< of each wall
  Groups<> walls_of_;                    ///< a piece
  bool sees_to_sides_ = true;            ///< nearly all triangles agree with their neighbours
  std::vector<char> is_known_;           ///< per cell
  FilledCells result_;
};

}  // namespace

FilledCells filled_cells(const Arrangement& arranged, const Cells& cells, Nested nested, const RunContext& context) {
  return Filling(arranged, cells, nested, context).result();
}

}  // namespace octafront::cells
