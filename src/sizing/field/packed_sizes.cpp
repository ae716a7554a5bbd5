#include "sizing/field/packed_sizes.h"

#include <octafront/error.h>

#include "sizing/field/octree_field.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace octafront {

namespace {

/// "ofsizes1"; tells one order of bytes from the other, too.
constexpr std::uint64_t kMark = 0x6f66'7369'7a65'7331;

/// What the bytes begin with; `leaves` keys and as many rows of eight sizes come behind.
struct Head {
  std::uint64_t mark = kMark, leaves = 0;  ///< no leaf: one size everywhere, the side
  double gradation = 0, side = 0;
  Vec3 lo;
};
using Corners = std::array<double, 8>;
constexpr std::size_t kBytesOfLeaf = sizeof(std::uint64_t) + sizeof(Corners);

template <class Value>
void append(std::string& bytes, const Value& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <class Value>
Value taken(std::string_view& bytes) {
  Value value;
  std::memcpy(&value, bytes.data(), sizeof value);
  bytes.remove_prefix(sizeof value);
  return value;
}

void require_packed(bool holds) {
  if (!holds) throw InputError("these bytes are no packed size field");
}

bool is_size(double h) {
  return std::isfinite(h) && h > 0;
}

Head taken_head(std::string_view& bytes) {
  require_packed(bytes.size() >= sizeof(Head));
  const auto head = taken<Head>(bytes);
  require_packed(head.mark == kMark && is_size(head.side) && is_size(head.gradation) && is_finite(head.lo));
  require_packed(bytes.size() % kBytesOfLeaf == 0 && bytes.size() / kBytesOfLeaf == head.leaves);
  return head;
}

}  // namespace

std::string packed_sizes(const SizeField& sizes) {
  Head head;
  head.gradation = SizeFunction::behind(sizes).gradation;
  std::string bytes;
  if (const OctreeField* grid = as_octree_field(sizes)) {
    head.leaves = grid->tree.size();
    head.side = grid->root.side;
    head.lo = grid->root.lo;
    bytes.reserve(sizeof head + head.leaves * kBytesOfLeaf);
    append(bytes, head);
    for (const OctreeKey leaf : grid->tree.leaves()) append(bytes, leaf.id());
    for (const Corners& h : grid->h) append(bytes, h);
    return bytes;
  }
  if (sizes.min_size() != sizes.max_size() || head.gradation != kDefaultGradation)
    throw OptionError("these sizes are those of a function: they have no grid that could be copied elsewhere");
  head.side = sizes.min_size();
  append(bytes, head);
  return bytes;
}

SizeField unpacked_sizes(std::string_view bytes) {
  const Head head = taken_head(bytes);
  if (head.leaves == 0) return SizeField::uniform(head.side);
  auto field = std::make_shared<OctreeField>();
  field->gradation = head.gradation;
  field->root = {head.lo, head.side};
  std::vector<OctreeKey> leaves(head.leaves);
  for (OctreeKey& leaf : leaves) leaf = OctreeKey::from_id(taken<std::uint64_t>(bytes));
  require_packed(cover_the_root(leaves));
  field->tree = Octree(std::move(leaves));
  require_packed(field->tree.is_balanced());
  field->h.resize(head.leaves);
  for (Corners& h : field->h) {
    h = taken<Corners>(bytes);
    require_packed(std::all_of(h.begin(), h.end(), is_size));
  }
  field->find_range();
  return SizeFunction::field(std::move(field));
}

}  // namespace octafront
