#include "cad/model/stream.h"

#include <octafront/error.h>

#include <array>
#include <bit>
#include <cstring>
#include <type_traits>

namespace octafront::cad {

namespace {

static_assert(std::endian::native == std::endian::little, "both ends of the pipe are of one machine");

template <class T>
concept Plain = std::is_trivially_copyable_v<T>;

/// Writes and reads by the same list of members: see fields() below.
class Writer {
 public:
  template <Plain T>
  void operator()(const T& value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void operator()(const std::string& text) {
    (*this)(static_cast<std::uint64_t>(text.size()));
    bytes_.append(text);
  }
  template <class T>
  void operator()(const std::vector<T>& items) {
    (*this)(static_cast<std::uint64_t>(items.size()));
    if constexpr (Plain<T>)
      bytes_.append(reinterpret_cast<const char*>(items.data()), items.size() * sizeof(T));
    else
      for (const T& item : items) (*this)(item);
  }
  template <class T>
  requires(!Plain<T>) void operator()(const T& object) { fields(*this, object); }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}

  template <Plain T>
  void operator()(T& value) {
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
  }
  void operator()(std::string& text) { text = take(count(1)); }
  template <class T>
  void operator()(std::vector<T>& items) {
    if constexpr (Plain<T>) {
      items.resize(count(sizeof(T)));
      const std::string_view from = take(items.size() * sizeof(T));
      if (!items.empty()) std::memcpy(items.data(), from.data(), from.size());
    } else {
      items.resize(count(1));
      for (T& item : items) (*this)(item);
    }
  }
  template <class T>
  requires(!Plain<T>) void operator()(T& object) { fields(*this, object); }
  void end() const {
    if (!bytes_.empty()) fail();
  }

 private:
  [[noreturn]] static void fail() {
    throw InputError("the CAD reader sent something else than a model: it is of another version");
  }
  std::uint64_t count(std::size_t least_bytes) {
    std::uint64_t n = 0;
    (*this)(n);
    if (n > bytes_.size() / least_bytes) fail();
    return n;
  }
  std::string_view take(std::size_t n) {
    if (n > bytes_.size()) fail();
    const std::string_view taken = bytes_.substr(0, n);
    bytes_.remove_prefix(n);
    return taken;
  }

  std::string_view bytes_;
};

template <class T, class Record>
concept Of = std::is_same_v<std::remove_const_t<T>, Record>;

// One list of members for both ways.
template <class Ar, Of<Knots> T>
void fields(Ar& ar, T& it) {
  ar(it.degree), ar(it.knots);
}
template <class Ar, Of<CurveRecord> T>
void fields(Ar& ar, T& it) {
  ar(it.kind), ar(it.frame), ar(it.radius), ar(it.minor), ar(it.knots), ar(it.poles), ar(it.weights);
}
template <class Ar, Of<SurfaceRecord> T>
void fields(Ar& ar, T& it) {
  ar(it.kind), ar(it.frame), ar(it.radius), ar(it.minor), ar(it.u_knots), ar(it.v_knots), ar(it.poles);
  ar(it.weights), ar(it.u_period), ar(it.v_period);
}
template <class Ar, Of<Labels> T>
void fields(Ar& ar, T& it) {
  ar(it.name), ar(it.layer), ar(it.colour);
}
template <class Ar, Of<Face> T>
void fields(Ar& ar, T& it) {
  ar(it.labels), ar(it.surface), ar(it.is_turned), ar(it.low), ar(it.high), ar(it.sides), ar(it.piece), ar(it.area);
  ar(it.tolerance), ar(it.triangles);
}
template <class Ar, Of<CadEdge> T>
void fields(Ar& ar, T& it) {
  ar(it.curve), ar(it.vertices), ar(it.parameters), ar(it.faces), ar(it.length), ar(it.tolerance), ar(it.is_seam);
  ar(it.is_smooth);
}
template <class Ar, Of<Solid> T>
void fields(Ar& ar, T& it) {
  ar(it.labels), ar(it.product), ar(it.material), ar(it.density), ar(it.volume), ar(it.area), ar(it.closed);
}
template <class Ar, Of<CadModel> T>
void fields(Ar& ar, T& it) {
  ar(it.points), ar(it.triangles), ar(it.face_of), ar(it.corners), ar(it.faces), ar(it.edges), ar(it.solids);
  ar(it.vertices), ar(it.tolerance), ar(it.shared), ar(it.fused), ar(it.format), ar(it.unit);
  ar(it.to_millimetres), ar(it.per_millimetre), ar(it.notes);
}
template <class Ar, Of<Where> T>
void fields(Ar& ar, T& it) {
  ar(it.stage), ar(it.what), ar(it.done), ar(it.lo), ar(it.hi);
}
template <class Ar, Of<Opened> T>
void fields(Ar& ar, T& it) {
  ar(it.lo), ar(it.hi), ar(it.model);
}

template <class T>
std::string bytes_of(const T& object) {
  Writer writer;
  writer(object);
  return writer.take();
}

template <class T>
T object_of(std::string_view bytes) {
  Reader reader(bytes);
  T object;
  reader(object);
  reader.end();
  return object;
}

void require(bool ok) {
  if (!ok) throw InputError("the CAD reader sent a model whose numbers do not fit together");
}

void check_knots(const Knots& knots, bool wanted) {
  if (!wanted) return;
  require(knots.degree >= 1 && knots.knots.size() >= 2 * (knots.degree + std::size_t{1}));
}

/// Later stages index without asking.
void check(const CadModel& model) {
  require(model.face_of.size() == model.triangles.size() && model.corners.size() == model.triangles.size());
  for (const Triangle& t : model.triangles)
    for (const VertexIndex v : t) require(v < model.points.size());
  for (const std::uint32_t f : model.face_of) require(f < model.faces.size());
  for (const VertexIndex v : model.vertices) require(v < model.points.size());
  for (const Face& face : model.faces) {
    for (const std::uint32_t s : face.sides) require(s == kNone || s < model.solids.size());
    require(face.piece == kNone || face.piece < model.faces.size());
    const SurfaceRecord& s = face.surface;
    const bool nurbs = s.kind == SurfaceRecord::Kind::kNurbs;
    check_knots(s.u_knots, nurbs), check_knots(s.v_knots, nurbs);
    if (nurbs) require(s.poles.size() == s.u_knots.poles() * s.v_knots.poles());
    require(s.weights.empty() || s.weights.size() == s.poles.size());
  }
  for (const CadEdge& edge : model.edges) {
    require(edge.vertices.size() >= 2 && edge.parameters.size() == edge.vertices.size());
    for (const VertexIndex v : edge.vertices) require(v < model.points.size());
    for (const std::uint32_t f : edge.faces) require(f < model.faces.size());
    const bool nurbs = edge.curve.kind == CurveRecord::Kind::kNurbs;
    check_knots(edge.curve.knots, nurbs);
    if (nurbs) require(edge.curve.poles.size() == edge.curve.knots.poles());
    require(edge.curve.weights.empty() || edge.curve.weights.size() == edge.curve.poles.size());
  }
}

/// In the order of Overlap.
constexpr std::array<const char*, 5> kOverlapWords{"refuse", "tell", "first", "later", "new"};

}  // namespace

std::string word_of(Overlap overlap) {
  return kOverlapWords[static_cast<std::size_t>(overlap)];
}
std::optional<Overlap> overlap_of(std::string_view word) {
  for (std::size_t i = 0; i < kOverlapWords.size(); ++i)
    if (word == kOverlapWords[i]) return static_cast<Overlap>(i);
  return std::nullopt;
}

std::string to_bytes(const Where& where) {
  return bytes_of(where);
}
std::string to_bytes(const Opened& opened) {
  return bytes_of(opened);
}
std::string to_bytes(const CadModel& model) {
  return bytes_of(model);
}

Where where_of(std::string_view bytes) {
  return object_of<Where>(bytes);
}
Opened opened_of(std::string_view bytes) {
  return object_of<Opened>(bytes);
}
CadModel model_of(std::string_view bytes) {
  CadModel model = object_of<CadModel>(bytes);
  check(model);
  return model;
}

std::string frame_head(FrameKind kind, std::uint64_t length) {
  std::string head(1, static_cast<char>(kind));
  head.append(reinterpret_cast<const char*>(&length), sizeof length);
  return head;
}

std::optional<Head> head_of(std::string_view bytes) {
  Head head{static_cast<FrameKind>(bytes[0]), 0};
  std::memcpy(&head.length, bytes.data() + 1, sizeof head.length);
  switch (head.kind) {
    case FrameKind::kProgress:
    case FrameKind::kNote:
    case FrameKind::kOpened:
    case FrameKind::kModel:
    case FrameKind::kError:
      return head;
  }
  return std::nullopt;
}

}  // namespace octafront::cad
