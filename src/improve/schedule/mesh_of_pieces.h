#pragma once

// A mesh that is worked on piece by piece. The whole is kept in flat arrays; what edits need beside
// them lives as long as a piece is worked on. In each stage a piece is what lies wholly in one cell of space
// (base/shared); what lies at its rim is held fast, and lies inside a cell of a later stage. What the cells of all
// stages cut is one piece at the end. Pieces are pure: what comes of one hangs on it alone, so who works on which, and
// when, never matters. Takes a valid TetMesh and leaves one.
//
// Several ranks hold the tetrahedra in shares: those of a piece go to the rank that works on it, and stay there.
// All else is the same on all of them, and calls are made by all.

#include <octafront/tet_mesh.h>

#include "base/core/function_ref.h"
#include "base/geometry/blocks.h"
#include "base/mesh/features.h"
#include "base/shared/comm.h"
#include "base/shared/shared_tets.h"
#include "base/shared/shares.h"
#include "improve/shape/boundary_guide.h"
#include "improve/shape/edit_mesh.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace octafront::improve {

/// A part of a mesh, which one worker may change.
struct MeshPiece {
  std::optional<EditMesh> mesh;         ///< of the part; the k-th vertex taken is vertices[k] of the whole
  std::vector<VertexIndex> vertices;    ///< ascending
  std::vector<std::uint32_t> boundary;  ///< the numbers in the whole of its boundary triangles, ascending
  /// In the numbers of the vertices taken: those that have elements elsewhere, and of what is known of the boundary.
  std::vector<VertexIndex> at_rim, pinned, frozen;
  Features features;  ///< whoever changes the boundary leaves those of what he made
};

class MeshOfPieces {
 public:
  /// Fewer vertices would have more elements at rims; more would not fit the cache, and share less well among threads.
  static constexpr std::size_t kMostVertices = 16384;

  /// `input`: what the boundary was made from, null if it stays; it must outlive this. With it, what changes is written
  /// down, for rewind(). `tets`: what of the tetrahedra each rank gives, and gets back. Pieces have `most` vertices or
  /// fewer as they begin. Throws MeshingError if there are more tets than kMostTetsToImprove.
  MeshOfPieces(TetMesh&& mesh, ImproveOptions::Objective objective, const BoundaryInput* input,
               const Comm& comm = Comm(nullptr), Tets tets = Tets::kAll, std::size_t most = kMostVertices);

  /// Called from several threads, on some rank, for a piece each; may change it. Returns what is to be known of it.
  using Work = FunctionRef<Bytes(MeshPiece& piece)>;
  /// Called after each stage with what was returned, piece by piece.
  using Notes = FunctionRef<void(std::span<const Bytes>)>;
  /// Called now and then by the caller's thread: the part of the pieces of a stage that are done.
  using Progress = FunctionRef<void(double)>;

  /// Called before each stage: for tests, which may change where elements are kept.
  using BeforeStage = std::function<void(MeshOfPieces&)>;
  void call_before_stages(BeforeStage call) { before_stage_ = std::move(call); }

  /// Has pieces worked on, stage by stage, until no vertex waits: one waits (`waiting` has a mark for each) until it
  /// was in a piece with all elements around it. Pieces hold what lies within `rings` rings of those that wait.
  void work(std::vector<std::uint8_t> waiting, int rings, const Work& work, const Notes& notes,
            const Progress& progress);
  /// The same in one piece, for few vertices that must be seen together. All ranks get what work() returns.
  Bytes work_on_one(const std::vector<std::uint8_t>& waiting, int rings, const Work& work);

  std::vector<std::uint8_t> all() const { return std::vector<std::uint8_t>(points_.size(), 1); }
  /// Marks the corners of elements with a lower score; empty if there are none.
  std::vector<std::uint8_t> corners_below(float score) const;
  /// The same of elements with this beta or less, or a lower score.
  std::vector<std::uint8_t> corners_to_improve(float beta, float score) const;
  /// Marks the vertices of triangles of the boundary that cross; empty if none do.
  std::vector<std::uint8_t> corners_of_crossings() const;

  std::size_t tets() const { return live_; }  ///< of all ranks
  const Comm& comm() const { return comm_; }
  /// CPU seconds that this process's threads have spent on pieces.
  double piece_seconds() const { return piece_seconds_; }
  std::span<const Vec3> points() const { return points_; }
  /// Where the vertices were that the mesh came with; only with an input.
  std::span<const Vec3> home() const { return home_; }
  /// Calls visit(corners) for each element of this rank.
  template <class Visit>
  void for_each_tet(const Visit& visit) const {
    for (const Tet& t : tets_)
      if (t[0] != kNone) visit(t);
  }

  /// These vertices that came, and edges around them, stay from now on.
  void freeze(std::span<const VertexIndex> vertices);
  /// Whether the boundary is another one than it came with; only with an input.
  bool moved_boundary() const;
  /// The mesh as it came; only with an input.
  void rewind();

  /// The mesh, compacted: vertices in the order they came in, without unused ones, new ones behind; tets in order of
  /// space; boundary triangles by their numbers, the last ones in the place of those that went. Features, if asked for,
  /// get the numbers of this mesh, and `numbers` says where each vertex went, kNone: nowhere. A share is a stretch of
  /// the tets, those of rank 0 first.
  TetMesh release(Features* features, std::vector<VertexIndex>* numbers = nullptr);

 private:
  friend class SlotShuffle;  ///< of the tests

  struct Division;
  struct Change;
  struct Traveller;

  /// Of some elements of this rank, or of all.
  using Among = const std::vector<TetIndex>*;
  template <class IsWanted>
  std::vector<std::uint8_t> corners_where(const IsWanted& is_wanted) const;
  std::vector<TetIndex> touching(const std::vector<std::uint8_t>& marks, Among among) const;
  std::vector<std::uint8_t> spread(std::vector<std::uint8_t> marks, int rings, Among among) const;
  Division divide(const std::vector<std::uint8_t>& near, std::vector<TetIndex>& tets, int stage);
  Cells cells_of_points(std::span<const VertexIndex> held, int stage) const;
  Shares shared_cells(const Cells& cells, std::span<const TetIndex> tets) const;
  void deal(const Cells& cells, const Shares& shares, std::vector<TetIndex>& tets);
  Traveller traveller(TetIndex t) const;
  void take_in(const Traveller& tet, TetIndex slot);
  TetIndex add_slot();
  std::vector<Change> work_on(const Division& division, const Work& work, const Progress& progress);
  MeshPiece extract(const Division& division, std::uint32_t cell);
  Change change_of(const MeshPiece& piece, std::span<const TetIndex> tets, const std::vector<Edge>& edges) const;
  std::vector<Bytes> apply(std::vector<Change>& changes, const Shares& shares);
  std::vector<VertexIndex> number_new(std::span<const Change> changes);
  void apply_edges(std::vector<Edge> gone, const std::vector<Edge>& made);
  void put(const Change& change);
  void note_gone(TetIndex t);
  void sort_among_ranks(std::size_t vertices);
  Features renumbered(const std::vector<VertexIndex>& number) const;

  ImproveOptions::Objective objective_;
  const BoundaryInput* input_;
  Comm comm_;
  Tets shares_;
  std::size_t most_;
  bool has_regions_ = false;
  std::vector<Vec3> points_;
  std::vector<Tet> tets_;  ///< [0] == kNone: none
  std::vector<std::uint32_t> region_;
  std::size_t live_ = 0, came_ = 0;  ///< elements now and at first, of all ranks
  double piece_seconds_ = 0;
  Box3 box_;                                               ///< of the vertices as they came
  TetMesh rest_;                                           ///< all else
  std::vector<Edge> edges_;                                ///< features, sorted
  std::vector<std::uint8_t> pinned_, frozen_, is_corner_;  ///< per vertex that came
  std::vector<std::uint32_t> number_in_piece_;             ///< per vertex, while its piece is made; kNone

  /// What rewind() needs: elements that came and are gone, and what of the others came.
  struct Origin {
    TetMesh rest;
    std::vector<Edge> edges;
    std::vector<std::uint8_t> came;  ///< per slot
    std::vector<Tet> gone;
    std::vector<std::uint32_t> region_of_gone;
  };
  std::vector<Vec3> home_;
  Origin origin_;
  bool remembers_ = false;
  BeforeStage before_stage_;
};

}  // namespace octafront::improve
