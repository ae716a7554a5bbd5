#include "fill/front/front_index.h"

#include "base/core/validate.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace octafront {

namespace {

/// Largest extent of a face's box that a level takes, as a share of its cell. The box searched is grown by half of it,
/// so smaller is less to search in uniform regions; 0.7 with cells of 1.8 h takes almost every face of size h.
constexpr double kExtentShare = 0.7;
constexpr int kBrickBits = 2;
constexpr int kBrickSide = 1 << kBrickBits;
constexpr int kCellBits = 20;  // cells along an axis at level 0

std::uint64_t key_of(int level, const std::array<int, 3>& brick) {
  return (static_cast<std::uint64_t>(level) << 54) | (static_cast<std::uint64_t>(brick[0]) << 36) |
         (static_cast<std::uint64_t>(brick[1]) << 18) | static_cast<std::uint64_t>(brick[2]);
}

/// Number of a cell in its brick.
int cell_number(const std::array<int, 3>& cell) {
  constexpr int kMask = kBrickSide - 1;
  return (cell[0] & kMask) + kBrickSide * ((cell[1] & kMask) + kBrickSide * (cell[2] & kMask));
}

/// Bits of a brick's cells with x, y or z coordinate from l to h.
std::uint64_t range_x(int l, int h) {
  return 0x1111111111111111ull * (((2u << h) - 1) & ~((1u << l) - 1));
}
std::uint64_t range_y(int l, int h) {
  return 0x0001000100010001ull * (((std::uint64_t{16} << 4 * h) - 1) & ~((std::uint64_t{1} << 4 * l) - 1));
}
std::uint64_t range_z(int l, int h) {
  return (~std::uint64_t{0} >> 16 * (kBrickSide - 1 - h)) & ~((std::uint64_t{1} << 16 * l) - 1);
}

/// A search region in single precision, relative to a brick.
CullingRegion local_region(const SearchRegion& region, Vec3 origin) {
  constexpr double kSlackPerExtent = 4e-6;
  const Vec3 l = region.box.lo - origin, h = region.box.hi - origin, c = region.center - origin;
  // The sphere and the plane are computed with, so they get room for the rounding; the box is only compared.
  const double extent = std::max(
      {std::abs(l.x), std::abs(l.y), std::abs(l.z), std::abs(h.x), std::abs(h.y), std::abs(h.z), region.radius});
  const double slack = kSlackPerExtent * extent;
  CullingRegion local;
  for (int axis = 0; axis < 3; ++axis) {
    local.lo[axis] = static_cast<float>(l[axis]);
    local.hi[axis] = static_cast<float>(h[axis]);
    local.center[axis] = static_cast<float>(c[axis]);
    local.normal[axis] = static_cast<float>(region.normal[axis]);
  }
  const double r = region.radius + slack;
  local.squared_radius = static_cast<float>(r * r);
  local.behind = static_cast<float>(region.offset - dot(region.normal, origin) - slack);
  return local;
}

}  // namespace

FrontIndex::FrontIndex(const Box3& domain, double finest_cell) {
  const Vec3 e = domain.extent();
  const double widest = std::max({e.x, e.y, e.z});
  finest_cell = std::max(finest_cell, widest / ((1 << kCellBits) - 16));
  // Two cells of margin: boxes that are searched may reach beyond the domain.
  origin_ = domain.lo - Vec3{2 * finest_cell, 2 * finest_cell, 2 * finest_cell};
  for (int l = 0; l < kLevels; ++l) {
    cell_[l] = std::ldexp(finest_cell, l);
    per_cell_[l] = 1 / cell_[l];
  }
}

std::uint32_t FrontIndex::brick_at(int level, const Cell& brick) const {
  const std::uint32_t* id = brick_of_key_.find(key_of(level, brick));
  return id == nullptr ? kNone : *id;
}

std::uint32_t FrontIndex::make_brick(int level, const Cell& brick) {
  const auto id = static_cast<std::uint32_t>(bricks_.size());
  Brick& b = bricks_.emplace_back();
  b.level = level;
  b.at = brick;
  b.head.fill(kNone);
  const double side = cell_[level] * kBrickSide;
  b.origin = origin_ + Vec3{brick[0] * side, brick[1] * side, brick[2] * side};
  brick_of_key_.find_or_add(key_of(level, brick)) = id;
  return id;
}

std::uint32_t FrontIndex::new_block(std::uint32_t cell, std::uint32_t next) {
  std::uint32_t id = free_block_;
  if (id != kNone) {
    free_block_ = blocks_[id].next;
  } else {
    id = static_cast<std::uint32_t>(blocks_.size());
    blocks_.emplace_back();
    // Unused slots overlap nothing.
    for (int axis = 0; axis < 3; ++axis)
      for (int s = 0; s < kWidth; ++s) blocks_[id].boxes.lo[axis][s] = 1e30f, blocks_[id].boxes.hi[axis][s] = -1e30f;
  }
  blocks_[id].cell = cell;
  blocks_[id].next = next;
  blocks_[id].count = 0;
  return id;
}

void FrontIndex::insert(FaceIndex face, const Triangle& corners, const Box3& box, std::uint32_t region) {
  const Vec3 extent = box.extent(), middle = box.center() - origin_;
  const double widest = std::max({extent.x, extent.y, extent.z});
  int level = 0;
  while (level + 1 < kLevels && widest > kExtentShare * cell_[level]) ++level;
  const int limit = std::max(1, (1 << kCellBits) >> level) - 1;
  Cell cell, brick;
  for (int axis = 0; axis < 3; ++axis) {
    cell[axis] = std::clamp(static_cast<int>(middle[axis] * per_cell_[level]), 0, limit);
    brick[axis] = cell[axis] >> kBrickBits;
  }
  std::uint32_t b = brick_at(level, brick);
  if (b == kNone) b = make_brick(level, brick);
  const int c = cell_number(cell);
  std::uint32_t head = bricks_[b].head[c];
  if (head == kNone || blocks_[head].count == kWidth) {
    head = new_block(b * 64 + c, head);
    bricks_[b].head[c] = head;
    const bool was_empty = (bricks_[b].occupied | bricks_[b].below) == 0;
    bricks_[b].occupied |= std::uint64_t{1} << c;
    if (was_empty) mark_above(b, false);
  }
  Block& block = blocks_[head];
  const std::uint32_t slot = block.count++;
  const Vec3 lo = box.lo - bricks_[b].origin, hi = box.hi - bricks_[b].origin;
  for (int axis = 0; axis < 3; ++axis) {
    // Rounding to float keeps order, so boxes that overlap still overlap after it.
    block.boxes.lo[axis][slot] = static_cast<float>(lo[axis]);
    block.boxes.hi[axis][slot] = static_cast<float>(hi[axis]);
    block.corner[axis][slot] = corners[axis];
  }
  block.face[slot] = face;
  block.region[slot] = region;
  if (face >= place_.size()) place_.resize(std::max<std::size_t>(face + 1, 2 * place_.size()), kNone);
  place_[face] = head * kWidth + slot;
  if (faces_at_level_[level]++ == 0) levels_ |= 1u << level;
  validate(*this, face);
}

void FrontIndex::remove(FaceIndex face) {
  const std::uint32_t place = place_[face];
  Block& hole = blocks_[place / kWidth];
  const std::uint32_t slot = place % kWidth;
  Brick& brick = bricks_[hole.cell / 64];
  const std::uint32_t c = hole.cell % 64, head = brick.head[c];
  Block& first = blocks_[head];
  const std::uint32_t last = --first.count;
  for (int axis = 0; axis < 3; ++axis) {
    hole.boxes.lo[axis][slot] = first.boxes.lo[axis][last];
    hole.boxes.hi[axis][slot] = first.boxes.hi[axis][last];
    hole.corner[axis][slot] = first.corner[axis][last];
    first.boxes.lo[axis][last] = 1e30f;
    first.boxes.hi[axis][last] = -1e30f;
  }
  hole.face[slot] = first.face[last];
  hole.region[slot] = first.region[last];
  place_[hole.face[slot]] = place;
  place_[face] = kNone;
  if (last == 0) {
    brick.head[c] = first.next;
    const bool cell_is_empty = first.next == kNone;
    first.next = free_block_;
    free_block_ = head;
    if (cell_is_empty) {
      brick.occupied &= ~(std::uint64_t{1} << c);
      if ((brick.occupied | brick.below) == 0) mark_above(static_cast<std::uint32_t>(&brick - bricks_.data()), true);
    }
  }
  if (--faces_at_level_[brick.level] == 0) levels_ &= ~(1u << brick.level);
  validate(*this, hole.face[slot]);
}

void FrontIndex::mark_above(std::uint32_t brick, bool empty) {
  for (;;) {
    const int level = bricks_[brick].level + 2;
    if (level >= kLevels) return;
    const Cell cell = bricks_[brick].at;
    const Cell above{cell[0] >> kBrickBits, cell[1] >> kBrickBits, cell[2] >> kBrickBits};
    std::uint32_t parent = brick_at(level, above);
    if (parent == kNone) parent = make_brick(level, above);
    const int c = cell_number(cell);
    Brick& p = bricks_[parent];
    const bool was_empty = (p.occupied | p.below) == 0;
    if (empty)
      p.below &= ~(std::uint64_t{1} << c);
    else
      p.below |= std::uint64_t{1} << c;
    if (was_empty == ((p.occupied | p.below) == 0)) return;
    brick = parent;
  }
}

void FrontIndex::find(const SearchRegion& region, std::vector<Found>& out) const {
  // From this level up the region overlaps a few bricks; the levels below are reached from it and the one above it.
  const Vec3 e = region.box.extent();
  const double widest = std::max({e.x, e.y, e.z});
  int start = 0;
  while (start + 2 < kLevels && widest > kBrickSide * cell_[start]) ++start;
  const bool finer = (levels_ & ((1u << start) - 1)) != 0;
  for (int level = start; level < kLevels; ++level) {
    const bool descend = finer && level < start + 2;
    if (descend || (levels_ >> level & 1) != 0) find_in_level(level, descend, region, out);
  }
}

std::array<FrontIndex::Cell, 2> FrontIndex::cells_in_reach(int level, const Box3& box) const {
  const double reach = 0.5 * kExtentShare * cell_[level] * 1.0001;
  const double limit = std::max(1, (1 << kCellBits) >> level) - 1;
  std::array<Cell, 2> range;
  for (int axis = 0; axis < 3; ++axis) {
    const double lo = (box.lo[axis] - origin_[axis] - reach) * per_cell_[level];
    const double hi = (box.hi[axis] - origin_[axis] + reach) * per_cell_[level];
    range[0][axis] = static_cast<int>(std::clamp(lo, 0.0, limit));
    range[1][axis] = static_cast<int>(std::clamp(hi, 0.0, limit));
  }
  return range;
}

void FrontIndex::find_in_level(int level, bool descend, const SearchRegion& region, std::vector<Found>& out) const {
  const std::array<Cell, 2> range = cells_in_reach(level, region.box);
  const auto& [lo, hi] = range;
  for (int z = lo[2] >> kBrickBits; z <= hi[2] >> kBrickBits; ++z)
    for (int y = lo[1] >> kBrickBits; y <= hi[1] >> kBrickBits; ++y)
      for (int x = lo[0] >> kBrickBits; x <= hi[0] >> kBrickBits; ++x) {
        const std::uint32_t b = brick_at(level, {x, y, z});
        if (b != kNone) find_in_brick(b, range, descend, region, out);
      }
}

void FrontIndex::find_in_brick(std::uint32_t id, const std::array<Cell, 2>& range, bool descend,
                               const SearchRegion& region, std::vector<Found>& out) const {
  const Brick& brick = bricks_[id];
  const auto first = [&](int axis) { return std::max(range[0][axis] - brick.at[axis] * kBrickSide, 0); };
  const auto last = [&](int axis) { return std::min(range[1][axis] - brick.at[axis] * kBrickSide, kBrickSide - 1); };
  const std::uint64_t in_range = range_x(first(0), last(0)) & range_y(first(1), last(1)) & range_z(first(2), last(2));
  if ((brick.occupied & in_range) != 0) find_in_cells(brick, brick.occupied & in_range, region, out);
  if (!descend || (brick.below & in_range) == 0) return;
  const std::array<Cell, 2> range_below = cells_in_reach(brick.level - 2, region.box);
  for (std::uint64_t cells = brick.below & in_range; cells != 0; cells &= cells - 1) {
    const int c = std::countr_zero(cells);
    const Cell at{brick.at[0] * kBrickSide + (c & 3), brick.at[1] * kBrickSide + (c >> 2 & 3),
                  brick.at[2] * kBrickSide + (c >> 4)};
    const bool reaches = at[0] <= range_below[1][0] >> kBrickBits && at[0] >= range_below[0][0] >> kBrickBits &&
                         at[1] <= range_below[1][1] >> kBrickBits && at[1] >= range_below[0][1] >> kBrickBits &&
                         at[2] <= range_below[1][2] >> kBrickBits && at[2] >= range_below[0][2] >> kBrickBits;
    if (reaches) find_in_brick(brick_at(brick.level - 2, at), range_below, true, region, out);
  }
}

void FrontIndex::find_in_cells(const Brick& brick, std::uint64_t cells, const SearchRegion& region,
                               std::vector<Found>& out) const {
  const CullingRegion local = local_region(region, brick.origin);
  for (; cells != 0; cells &= cells - 1) {
    for (std::uint32_t id = brick.head[std::countr_zero(cells)]; id != kNone; id = blocks_[id].next) {
      const Block& block = blocks_[id];
      for (unsigned hits = cull_boxes(block.boxes, local); hits != 0; hits &= hits - 1) {
        const int s = std::countr_zero(hits);
        if (block.region[s] != region.of && block.region[s] != kNone && region.of != kNone) continue;
        out.push_back({block.face[s], {block.corner[0][s], block.corner[1][s], block.corner[2][s]}});
      }
    }
  }
}

std::size_t FrontIndex::size() const {
  return std::accumulate(faces_at_level_.begin(), faces_at_level_.end(), std::size_t{0});
}

std::optional<std::string> FrontIndex::check_cell(std::uint32_t brick, std::uint32_t cell, std::size_t& faces) const {
  const std::uint32_t head = bricks_[brick].head[cell];
  if ((head != kNone) != ((bricks_[brick].occupied >> cell & 1) != 0)) return "a cell of the index hides its faces";
  for (std::uint32_t id = head; id != kNone; id = blocks_[id].next) {
    const Block& block = blocks_[id];
    if (block.cell != brick * 64 + cell) return "a block of the index hangs in a cell that is not its own";
    if (block.count == 0 || (id != head && block.count < kWidth)) return "a block of the index has room behind others";
    for (std::uint32_t s = 0; s < block.count; ++s)
      if (place_[block.face[s]] != id * kWidth + s)
        return "face " + std::to_string(block.face[s]) + " is not where the index looks for it";
    faces += block.count;
  }
  return std::nullopt;
}

std::optional<std::string> FrontIndex::first_inconsistency(FaceIndex face) const {
  if (!contains(face)) return std::nullopt;
  const Block& block = blocks_[place_[face] / kWidth];
  if (place_[face] % kWidth >= block.count || block.face[place_[face] % kWidth] != face)
    return "face " + std::to_string(face) + " is not where the index looks for it";
  std::size_t unused = 0;
  return check_cell(block.cell / 64, block.cell % 64, unused);
}

std::optional<std::string> FrontIndex::first_inconsistency() const {
  std::array<std::size_t, kLevels> faces{};
  for (std::uint32_t b = 0; b < bricks_.size(); ++b) {
    const Brick& brick = bricks_[b];
    if (brick_at(brick.level, brick.at) != b) return "a brick of the index cannot be found";
    for (std::uint32_t c = 0; c < 64; ++c) {
      if (auto wrong = check_cell(b, c, faces[brick.level])) return wrong;
      if (brick.level < 2) continue;
      const auto in_cell = [&](int axis) { return brick.at[axis] * kBrickSide + static_cast<int>(c >> 2 * axis & 3); };
      const std::uint32_t below = brick_at(brick.level - 2, {in_cell(0), in_cell(1), in_cell(2)});
      const bool filled = below != kNone && (bricks_[below].occupied | bricks_[below].below) != 0;
      if (filled != ((brick.below >> c & 1) != 0)) return "a brick of the index hides those below it";
    }
  }
  for (int level = 0; level < kLevels; ++level)
    if (faces[level] != faces_at_level_[level] || (faces[level] != 0) != ((levels_ >> level & 1) != 0))
      return "the index has not as many faces at level " + std::to_string(level) + " as it says";
  return std::nullopt;
}

}  // namespace octafront
